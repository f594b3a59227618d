"""Pier, vehicle and the two integrators against closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.assembly import vehicle_matrices
from railquake.assembly.stability import critical_time_step
from railquake.inputs.vehicle import Vehicle
from railquake.march.order import kernel_order, lateral_block
from railquake.march.packed import packed
from railquake.physics import newmark, pier, zhai
from railquake.physics.vehicle import fixed_wheelset_modes

E, SECOND, L, M, J = 44.8e9, 0.9 * 0.1825, 6.0, 262914.0, 2075226.0  # bart-berkeley
K0 = 3.8432e10


def frequencies(preset):
    matrices = vehicle_matrices(Vehicle.from_preset(preset))
    return fixed_wheelset_modes(matrices.mass, matrices.stiffness)[0]


def test_modes_of_the_car_are_those_of_table_1():
    """Table 1 of the paper (three digits: physics.md, section 4)."""
    assert frequencies("bart")[:3] == pytest.approx([0.292, 1.009, 1.034], rel=2e-3)
    assert frequencies("bart")[3:] == pytest.approx([2.578, 4.453, 4.791], rel=2e-3)


def test_modes_of_the_authors_runs():
    """physics.md, section 4."""
    expected = [0.316, 1.142, 1.252, 2.649, 5.390, 7.356]
    assert frequencies("bart-2023-runs") == pytest.approx(expected, rel=3e-3)


def test_suspension_resists_no_rigid_motion():
    car = Vehicle.from_preset("bart")
    matrices = vehicle_matrices(car)
    bodies = sorted(car.bodies, key=lambda body: body.name == car.wheelset)
    moves = (
        [value for _ in bodies for value in (1.0, 0.0, 0.0)],
        [value for _ in bodies for value in (0.0, 1.0, 0.0)],
        # a roll about the rails takes a body at height h by h to the right
        [value for body in bodies for value in (body.height, 0.0, 1.0)],
    )
    for matrix in (matrices.stiffness, matrices.damping):
        assert np.allclose(matrix, matrix.T)
        for move in moves:
            assert np.abs(matrix @ np.array(move)).max() < 1e-9 * np.abs(matrix).max()


def test_symmetric_car_splits_into_two_blocks():
    matrices = vehicle_matrices(Vehicle.from_preset("bart"))
    assert lateral_block(matrices.stiffness, matrices.damping) == 6
    assert kernel_order(9).tolist() == [0, 2, 3, 5, 6, 8, 1, 4, 7]


@pytest.mark.parametrize("n", [3, 6, 9, 12])
def test_packed_places_are_those_of_the_upper_triangle(n):
    rows, columns = np.triu_indices(n)
    for place, (i, j) in enumerate(zip(rows, columns, strict=True)):
        assert packed(int(i), int(j), n) == packed(int(j), int(i), n) == place


def test_rigid_rotation_of_the_column_costs_nothing():
    matrix = pier.stiffness_matrix(E, SECOND, L, 0.0)
    # physics.md, section 1: u = -L theta
    assert np.abs(matrix @ np.array([-L, 1.0, 1.0])).max() < 1e-6 * np.abs(matrix).max()
    assert matrix[0, 0] == pytest.approx(12.0 * E * SECOND / L**3)


def test_periods_of_the_pier_with_an_elastic_hinge():
    """physics.md, section 4: 0.411 and 0.106 s."""
    mass = np.array([M, 1.0, J])
    omega = pier.natural_frequencies(mass, pier.stiffness_matrix(E, SECOND, L, K0))
    assert 2.0 * math.pi / omega[:2] == pytest.approx([0.411, 0.106], abs=6e-4)


@given(ratio=st.floats(0.001, 0.2))
def test_rayleigh_damping_has_its_ratio_in_both_modes(ratio):
    mass = np.array([M, 1.0, J])
    stiffness = pier.stiffness_matrix(E, SECOND, L, K0)
    coefficients = pier.rayleigh_coefficients(mass, stiffness, ratio)
    damping = pier.rayleigh_damping(mass, stiffness, *coefficients)
    root = 1.0 / np.sqrt(mass)
    values, vectors = np.linalg.eigh(stiffness * np.outer(root, root))
    for k in range(2):
        shape = root * vectors[:, k]
        found = shape @ damping @ shape / (2.0 * math.sqrt(values[k]))
        assert found == pytest.approx(ratio, rel=1e-6)


def test_column_buckles_at_eulers_load():
    """Fixed foot, free top: P = pi^2 EI / (4 L^2), to the 0.8 % of one cubic element."""
    euler = math.pi**2 * E * SECOND / (4.0 * L**2)
    free = np.ix_([0, 2], [0, 2])
    stiffness = pier.stiffness_matrix(E, SECOND, L, 0.0)[free]
    unit = -pier.geometric_stiffness(1.0, L)[free]
    lowest = np.linalg.eigvals(np.linalg.solve(unit, stiffness)).real.min()
    assert lowest == pytest.approx(euler, rel=0.008)


def test_a_dashpot_beside_the_hinge_takes_its_share_of_the_step():
    """dx = free - f (M + c (2 rate dx - v)), by hand; without a dashpot nothing changes."""
    free, soft, rate, v, c, moment = 2e-4, 3e-9, 1e4, 0.7, 40.0, 5e4
    assert newmark.beside_dashpot(free, soft, 0.0, v, rate) == (free, soft)
    held, softness = newmark.beside_dashpot(free, soft, c, v, rate)
    dx = held - softness * moment
    velocity = newmark.new_velocity(dx, v, rate)
    assert dx == pytest.approx(free - soft * (moment + c * velocity), rel=1e-12)


def newmark_error(dt):
    omega, x, v = 2.0, 1.0, 0.0
    a = -(omega**2) * x
    effective = float(
        newmark.effective_matrix(np.eye(1), np.zeros((1, 1)), omega**2 * np.eye(1), dt)[0, 0]
    )
    for _ in range(round(5.0 / dt)):
        dx = (-(omega**2) * x + 4.0 / dt * v + a) / effective
        x, v, a = (
            x + dx,
            newmark.new_velocity(dx, v, 1.0 / dt),
            newmark.new_acceleration(dx, v, a, 1.0 / dt),
        )
    return abs(x - math.cos(omega * 5.0))


def test_newmark_is_of_second_order():
    assert newmark_error(0.01) / newmark_error(0.005) == pytest.approx(4.0, rel=0.05)


def zhai_run(omega, damping, dt, end):
    x, v = 1.0, 0.0
    a = before = -(omega**2) * x - damping * v
    for _ in range(round(end / dt)):
        x += zhai.predict_displacement(v, a, before, dt, 0.5)
        v += zhai.predict_velocity(a, before, dt, 0.5)
        before, a = a, -(omega**2) * x - damping * v
    return x


def test_zhai_is_of_second_order():
    errors = [abs(zhai_run(2.0, 0.0, dt, 5.0) - math.cos(10.0)) for dt in (0.01, 0.005)]
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize(
    ("omega", "ratio", "limit"), [(1e3, 0.0, 2e-3), (1e3, 1.0, 0.48e-3), (1e-6, None, 1e-3)]
)
def test_critical_time_step_is_zhais(omega, ratio, limit):
    """physics.md, section 2: omega dt < 2, 0.48 at critical damping, c dt/m < 1 for a damper."""
    damping = 1e3 if ratio is None else 2.0 * ratio * omega
    found = critical_time_step(np.ones(1), omega**2 * np.eye(1), damping * np.eye(1), 0.5, 0.5)
    assert found == pytest.approx(limit, rel=0.02)


def test_a_step_above_the_critical_one_blows_up_and_one_below_does_not():
    assert abs(zhai_run(1.0, 2.0, 0.47, 200.0)) < 1.0
    assert abs(zhai_run(1.0, 2.0, 0.52, 200.0)) > 1e3
