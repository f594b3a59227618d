"""Eq. 1 of any car: against matrices by hand, energies of single springs, rigid motion."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.assembly import vehicle_matrices
from railquake.inputs.vehicle import Body, Dashpot, Spring, Vehicle
from railquake.march.order import kernel_order, lateral_block
from railquake.physics.suspension import element_row
from railquake.physics.vehicle import fixed_wheelset_modes

numbers = st.floats(-2.0, 2.0, allow_subnormal=False)


def car(*bodies, springs, dashpots=()):
    return Vehicle(
        name="test", bodies=bodies, springs=springs, dashpots=dashpots, axles=2, speed=20.0,
        kinematics="linear",
    )  # fmt: skip


def two_bodies(**changes):
    """A box 1.5 m above its wheelset on one level of springs 0.5 m below its centre."""
    level = {"bodies": ("box", "wheelset"), "lateral": 0.9, "height": 1.5, **changes}
    return car(
        Body(name="box", mass=1000.0, roll_inertia=400.0, height=2.0),
        Body(name="wheelset", mass=300.0, roll_inertia=100.0, height=0.5),
        springs=(
            Spring(name="y", direction="lateral", stiffness=1e5, **level),
            Spring(name="z", direction="vertical", stiffness=3e5, **level),
        ),
        dashpots=(Dashpot(name="z", direction="vertical", damping=2e3, **level),),
    )


def test_two_bodies_are_those_written_by_hand():
    """Sway k (y1 - y2 - 0.5 phi1 - 1.0 phi2), bounce, and roll by the springs' lever of 0.9 m."""
    matrices = vehicle_matrices(two_bodies())
    # z is down: the springs are 0.5 m below the box (p_z = +0.5) and 1.0 m above the wheelset
    sway = np.array([1.0, 0.0, -0.5, -1.0, 0.0, -1.0])
    bounce = np.array([0.0, 1.0, 0.0, 0.0, -1.0, 0.0])
    rock = np.array([0.0, 0.0, 0.9, 0.0, 0.0, -0.9])
    by_hand = (
        2e5 * np.outer(sway, sway) + 6e5 * np.outer(bounce, bounce) + 6e5 * np.outer(rock, rock)
    )
    assert matrices.stiffness == pytest.approx(by_hand)
    assert matrices.damping == pytest.approx(
        4e3 * (np.outer(bounce, bounce) + np.outer(rock, rock))
    )
    assert matrices.mass.tolist() == [1000.0, 1000.0, 400.0, 300.0, 300.0, 100.0]


def test_bounce_on_the_springs_is_that_of_an_oscillator():
    matrices = vehicle_matrices(two_bodies())
    frequencies, _ = fixed_wheelset_modes(matrices.mass, matrices.stiffness)
    bounce = math.sqrt(6e5 / 1000.0) / (2.0 * math.pi)
    # sway and roll: the roots of (2e5 - m w)(2e5 0.5^2 + 6e5 0.9^2 - J w) = (2e5 0.5)^2
    a, b, c = 2e5, 2e5 * 0.25 + 6e5 * 0.81, 2e5 * 0.5
    coefficients = [1000.0 * 400.0, -(1000.0 * b + 400.0 * a), a * b - c * c]
    sways = np.sqrt(np.roots(coefficients)) / (2.0 * math.pi)
    assert frequencies == pytest.approx(sorted([bounce, *sways]))


def test_wheelset_stands_last_wherever_it_is_listed():
    listed = two_bodies()
    turned = listed.model_copy(update={"bodies": listed.bodies[::-1]})
    assert vehicle_matrices(turned).bodies == ("box", "wheelset")
    assert vehicle_matrices(turned).stiffness == pytest.approx(vehicle_matrices(listed).stiffness)


@given(st.lists(numbers, min_size=14, max_size=14), st.floats(0.0, 2.0 * math.pi))
def test_elongation_is_the_distance_that_two_points_part(values, angle):
    """Rows by a rotation about +x that takes y to z (right side down)."""
    (py, pz, ry, rz), motion = values[:4], 1e-3 * np.array(values[4:10])
    direction = (math.cos(angle), math.sin(angle))
    row = element_row(2, 0, 1, direction, (py, pz), (ry, rz))

    def moved(y, z, body):
        dy, dz, phi = motion[3 * body : 3 * body + 3]
        c, s = math.cos(phi), math.sin(phi)
        return np.array([dy + c * y - s * z - y, dz + s * y + c * z - z])

    parted = (moved(py, pz, 0) - moved(ry, rz, 1)) @ direction
    assert row @ motion == pytest.approx(parted, abs=3e-5)  # of second order in the rotations


def chain(count):
    """As many bodies as wanted, one above the other, the wheelset lowest."""
    names = ["wheelset", *(f"floor {k}" for k in range(1, count))]
    bodies = [
        Body(name=n, mass=2000.0 + 500.0 * k, roll_inertia=900.0, height=0.4 + 0.6 * k)
        for k, n in enumerate(names)
    ]
    springs, dashpots = [], []
    for k, pair in enumerate(itertools.pairwise(names)):
        for direction, factor in (("lateral", 1.0), ("vertical", 3.0)):
            common = {
                "name": f"{direction} {k}",
                "bodies": pair,
                "direction": direction,
                "lateral": 0.8 + 0.1 * k,
                "height": 0.6 + 0.6 * k,
            }
            springs.append(Spring(stiffness=4e5 * factor, **common))
            dashpots.append(Dashpot(damping=3e4, **common))
    return car(*bodies, springs=tuple(springs), dashpots=tuple(dashpots))


@pytest.mark.parametrize("count", [2, 3, 4, 6])
def test_any_number_of_bodies_moves_freely_as_a_whole_and_in_no_other_way(count):
    vehicle = chain(count)
    matrices = vehicle_matrices(vehicle)
    height = {body.name: body.height for body in vehicle.bodies}
    free = np.zeros((3, 3 * count))
    for i, name in enumerate(matrices.bodies):
        free[0, 3 * i] = free[1, 3 * i + 1] = free[2, 3 * i + 2] = 1.0
        free[2, 3 * i] = height[name]
    values = np.linalg.eigvalsh(matrices.stiffness)
    assert np.abs(free @ matrices.stiffness).max() < 1e-9 * values[-1]
    assert np.abs(free @ matrices.damping).max() < 1e-9 * values[-1]
    assert np.all(np.abs(values[:3]) < 1e-9 * values[-1])
    assert values[3] > 1e-6 * values[-1]


@pytest.mark.parametrize("bodies", [1, 2, 3, 5])
def test_kernel_keeps_lateral_and_roll_first_then_vertical(bodies):
    order = kernel_order(3 * bodies)
    assert sorted(order) == list(range(3 * bodies))
    assert np.all(order[: 2 * bodies] % 3 != 1)
    assert np.all(order[2 * bodies :] % 3 == 1)


def test_a_car_with_springs_on_one_side_only_is_one_block():
    lopsided = vehicle_matrices(two_bodies(pair=False))
    even = vehicle_matrices(two_bodies())
    assert lateral_block(lopsided.stiffness, lopsided.damping) == 6
    assert lateral_block(even.stiffness, even.damping) == 4


def test_how_a_car_splits_does_not_depend_on_its_units():
    for pair, rows in ((True, 4), (False, 6)):
        matrices = vehicle_matrices(two_bodies(pair=pair))
        for scale in (1e-14, 1.0, 1e14):
            found = lateral_block(scale * matrices.stiffness, scale * matrices.damping)
            assert found == rows
    assert lateral_block(np.zeros((3, 3)), np.zeros((3, 3))) == 2  # one body, no springs


def test_a_body_on_no_springs_swings_at_no_frequency():
    frequencies, _ = fixed_wheelset_modes(np.ones(6), np.zeros((6, 6)))
    assert frequencies.tolist() == [0.0, 0.0, 0.0]


def test_a_body_alone_has_no_joints_whatever_its_kinematics():
    block = Body(name="wheelset", mass=1000.0, roll_inertia=400.0, height=2.0)
    alone = Vehicle(name="block", bodies=(block,), axles=1, speed=0.0)
    matrices = vehicle_matrices(alone)
    assert alone.kinematics == "finite"
    assert (matrices.kinematics, matrices.stiffness.any()) == ("linear", False)
