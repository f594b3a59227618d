"""The momentum audit: its laws, what its stages add up, by hand, and the sentences that follow."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import railquake as rq
from jolts import pushed
from railquake.inputs.vehicle import Vehicle
from railquake.march import frames, momentum
from railquake.march.compiler import PYTHON, bind
from railquake.march.order import kernel_order
from railquake.march.slots import chosen
from railquake.physics.energy import EnergyAudit
from railquake.physics.momentum import (
    MomentumAudit,
    Pair,
    moment,
    moment_undeformed,
    patch_moment,
    place_undeformed,
    true_moment,
    true_place,
)
from railquake.physics.patch import Contact, WheelMotion, patch_forces
from railquake.physics.profiles import Patch
from railquake.physics.vehicle import GRAVITY
from railquake.run.doubts import doubts
from stages import stage

DT = 2e-5
CARS = {"linear": "to the right", "finite": "turned, under gravity"}


@pytest.fixture(scope="module", params=CARS)
def car(request):
    """Kinematics and a system, its bodies displaced and moving."""
    system = pushed(CARS[request.param], DT)
    drawn = np.random.default_rng(5)
    s, q = system.start.copy(), system.constants.copy()
    for block in ("VEHICLE_X", "VEHICLE_V", "VEHICLE_A", "VEHICLE_A_OLD"):
        rows = system.layout.state_blocks[block]
        s[rows] = 0.1 * drawn.normal(size=s[rows].shape)
    s[system.layout.state.GROUND], s[system.layout.state.GROUND_SLOPE] = 3.0, 0.5
    s[system.layout.state.GROUND_Z], s[system.layout.state.GROUND_Z_SLOPE] = -2.0, 0.25
    q[system.layout.constant.SUBSTEPS] = 4.0
    return request.param, replace(system, start=s, constants=q)


def bodies(system, block):
    """Rows of the bodies, shape (3 bodies, y z phi)."""
    values = np.empty(9)
    values[kernel_order(9)] = system.start[system.layout.state_blocks[block], 0]
    return values.reshape(3, 3)


def inputs(system):
    """Masses, inertias and heights from the scenario's vehicle; the wheelset stands on its wheels.

    All from the inputs.
    """
    found = sorted(system.scenario.vehicle.bodies, key=lambda b: b.name == "wheelset")
    raised = system.scenario.wheelrail.rolling_radius - found[-1].height
    return (
        np.array([b.mass for b in found]),
        np.array([b.roll_inertia for b in found]),
        np.array([b.height for b in found]) + raised,
    )


def places(kinematics, system, x):
    heights = inputs(system)[2]
    drawn = np.column_stack([np.zeros(3), -heights])
    return drawn if kinematics == "linear" else drawn + x[:, :2]


# --- laws ---------------------------------------------------------------------------------------


def test_a_moment_turns_the_right_side_down():
    assert moment(Pair(2.0, 0.0), Pair(0.0, 3.0)) == 6.0  # down, on the right
    assert moment(Pair(0.0, -2.0), Pair(3.0, 0.0)) == 6.0  # to the right, above


def test_a_linear_car_s_bodies_stay_where_they_were_drawn():
    assert true_place(0.1, 0.2, 1.5) == (0.1, 0.2 - 1.5)
    assert place_undeformed(0.1, 0.2, 1.5) == (0.0, -1.5)


def test_a_patch_s_moment_about_its_rail_is_what_turns_the_wheelset():
    """About the wheelset's centre it is the force along psi, found by the gap's derivative."""
    forces = bind(patch_forces, PYTHON, chosen(
        {"creep law": "she", "flange creep law": "she", "restitution law": "hunt-crossley"}
    )).call  # fmt: skip
    shift, height = 0.006, -0.39
    found = Patch(height - 1e-4, 0.9, -0.6, 0.011, 9e10, 7e10, 6e10, 1.6e11, 0.3)
    at = forces(
        1e-4, found, WheelMotion(height, 0.1, -0.05, 0.2, 0.03, 0.9995, 55.0), 0.3,
        Contact(0.45, 0.1, 0.3, 1.0 / 22.0, 22.0), 0, np.zeros(1),
    )  # fmt: skip
    force = Pair(at.y, at.z)
    about_track = patch_moment(found, shift, height, force)
    assert about_track - moment(Pair(shift, height), force) == pytest.approx(at.psi)


def test_a_moment_is_counted_where_the_equations_have_the_wheelset():
    track, force, arm = Pair(0.02, 0.01), Pair(3.0, -5.0), Pair(0.01, -0.41)
    about_origin = 7.0 + moment(track, force)
    assert true_moment(7.0, force, track, arm, 0.392) == pytest.approx(about_origin)
    about_centre = about_origin - moment(Pair(track.y + arm.y, track.z + arm.z), force)
    expected = about_centre + moment(Pair(0.0, -0.392), force)
    assert moment_undeformed(7.0, force, track, arm, 0.392) == pytest.approx(expected)


# --- stages -------------------------------------------------------------------------------------


def test_ground_and_gravity_push_on_all_bodies(car):
    kinematics, system = car
    s, rows = system.start.copy(), system.layout.state
    mass, _, _ = inputs(system)
    step = 4.0 * DT
    at = bodies(system, "VEHICLE_X") - 0.5 * step * bodies(system, "VEHICLE_V")  # halfway
    place = places(kinematics, system, at)
    ground = np.array([3.0 - 0.25, -2.0 - 0.125])  # its mean
    before = s.copy()
    stage(system, momentum.push_on_bodies)(s, system.constants, 0)
    gained = (s - before)[:, 0]
    shaken = -step * mass[:, None] * ground
    turned = place[:, 0] * shaken[:, 1] - place[:, 1] * shaken[:, 0]
    np.testing.assert_allclose(
        gained[rows.SHAKEN_Y : rows.SHAKEN_Y + 3], (*shaken.sum(axis=0), turned.sum()), rtol=1e-12
    )
    fall = step * GRAVITY
    assert gained[rows.WEIGHED_Z] == pytest.approx(fall * mass.sum())
    assert gained[rows.WEIGHED_PHI] == pytest.approx(fall * mass @ place[:, 0], abs=1e-12)
    omitted = fall * mass @ (at[:, 0] - place[:, 0])
    assert gained[rows.OMITTED] == pytest.approx(omitted, abs=1e-12)
    assert gained[rows.COUPLED_PHI] == 0.0  # all of its ends stand at one height


def test_a_frame_leaves_what_no_impulse_explains(car):
    """Momentum with the velocity that a trapezoid gives, less the impulses, over a frame."""
    kinematics, system = car
    s, rows, blocks = system.start.copy(), system.layout.state, system.layout.state_blocks
    mass, inertia, _ = inputs(system)
    steps = np.array([[4.0 * DT], [4.0 * DT], [DT]])  # the wheelset's own
    v = bodies(system, "VEHICLE_V") + 0.5 * steps * (
        bodies(system, "VEHICLE_A") - bodies(system, "VEHICLE_A_OLD")
    )
    place = places(kinematics, system, bodies(system, "VEHICLE_X"))
    along = mass[:, None] * v[:, :2]
    roll = (place[:, 0] * along[:, 1] - place[:, 1] * along[:, 0] + inertia * v[:, 2]).sum()
    s[blocks["RAILS"]] = 2.0 / (0.5 * DT)  # of the last force, half is too much
    names = ("RAILS_IMPULSE", "SHAKEN", "WEIGHED", "COUPLED_PHI")
    for value, name in zip((72.0, 11.0, 5.0, 2.0), names, strict=True):
        s[blocks[name]] += value
    expected = np.array(
        [
            along[:, 0].sum() - 70.0 - 11.0,
            along[:, 1].sum() - 70.0 - 11.0 - 5.0,
            roll - 70.0 - 11.0 - 5.0 - 2.0,
        ]
    )
    before = np.array([1.0, 2.0, 3.0])
    s[rows.UNEXPLAINED : rows.UNEXPLAINED + 3, 0] = before
    stage(system, momentum.close_momentum)(s, system.constants, 0)
    left = s[rows.MOMENTUM_LEFT : rows.MOMENTUM_LEFT + 3, 0]
    np.testing.assert_allclose(left, expected - before, rtol=1e-10)
    assert s[rows.PEAK_LINEAR_LEFT, 0] == np.abs(left[:2]).max()
    assert s[rows.PEAK_ANGULAR_LEFT, 0] == abs(left[2])
    assert s[rows.PEAK_IMPULSE, 0] == 77.0  # the rails' with the weight's
    assert s[rows.PEAK_TURNING, 0] == 72.0
    stage(system, momentum.open_momentum)(s, system.constants, 0)
    np.testing.assert_allclose(s[rows.UNEXPLAINED : rows.UNEXPLAINED + 3, 0], expected, rtol=1e-10)


def test_a_train_that_left_gains_nothing_more(car):
    _, system = car
    s, blocks = system.start.copy(), system.layout.state_blocks
    s[system.layout.state.ON_TRACK] = 0.0
    before = s.copy()
    for name in (momentum.gather_rails, momentum.push_on_bodies, momentum.close_momentum):
        stage(system, name)(s, system.constants, 0)
    for name in ("RAILS", "SHAKEN", "WEIGHED", "OMITTED", "MOMENTUM_LEFT"):
        assert (s[blocks[name]] == (0.0 if name == "RAILS" else before[blocks[name]])).all()


def test_springs_with_ends_at_two_heights_make_a_couple_in_a_linear_car():
    """Sum of the rows of K and C over a rigid turn: what no turn should cost."""
    raised = {"heights": ["0.9 m", "0.8 m"], "height": None}
    vehicle = Vehicle.from_preset(
        "bart",
        {"springs": {"secondary-lateral": raised}, "dashpots": {"secondary-lateral": raised}},
    )
    jolted = pushed("to the right", DT).ground
    system = rq.assemble(rq.scenario(vehicle=vehicle, motion=jolted, allow_high_pga=True))
    blocks, order = system.layout.constant_blocks, kernel_order(9)
    heights = [body.height for body in sorted(vehicle.bodies, key=lambda b: b.name == "wheelset")]
    turn = np.ravel([(height, 0.0, 1.0) for height in heights])
    for block, matrix in (
        ("STIFFNESS", system.vehicle.stiffness),
        ("DAMPING", system.vehicle.damping),
    ):
        found = system.constants[blocks[f"COUPLE_{block}"], 0]
        expected = (matrix @ turn)[order]
        assert np.abs(expected).max() > 0.0
        np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(matrix).max())


def test_the_audit_takes_nothing_from_the_rows_that_move_the_car(car):
    """Masses, heights and axles come from the inputs by themselves."""
    _, system = car
    q, blocks = system.constants, system.layout.constant_blocks
    mass, inertia, height = inputs(system)
    np.testing.assert_array_equal(q[blocks["AUDIT_MASS"], 0], mass)
    np.testing.assert_array_equal(q[blocks["AUDIT_INERTIA"], 0], inertia)
    np.testing.assert_array_equal(q[blocks["AUDIT_HEIGHT"], 0], height)
    assert q[system.layout.constant.AUDIT_AXLES, 0] == system.scenario.vehicle.axles


# --- what is said -------------------------------------------------------------------------------


def test_residuals_are_over_the_largest_impulse():
    audit = MomentumAudit(2.0, 3.0, 400.0, 900.0, 450.0, mass=4e4)
    assert (audit.linear_relative, audit.angular_relative) == (2.0 / 400.0, 3.0 / 900.0)
    assert audit.omitted_relative == 0.5
    # a car that hardly moves: as if it had been given 1 mm/s
    still = MomentumAudit(2.0, 3.0, 1e-6, 1e-6, 0.0, mass=4e4)
    assert (still.linear_relative, still.angular_relative) == (2.0 / 40.0, 3.0 / 40.0)


SOUND = dict.fromkeys(EnergyAudit.__dataclass_fields__, 0.0) | {"creep": 100.0, "impact": 20.0}
MOVED = MomentumAudit(0.0, 0.0, 1.0, 1.0, 0.0, mass=1.0)


@pytest.mark.parametrize(
    ("energy", "moved", "said"),
    [
        ({}, {}, ()),
        ({"spin": -2.0, "forward": 2.9}, {}, ()),
        (
            {"spin": -2.0, "forward": 4.0}, {},
            ("spin and the train's forward motion bring in 6 % of what creep loses, beyond 5 %: no "
             "balance sees an error in them",),
        ),
        ({"contact_residual": 3.5}, {}, ()),
        (
            {"contact_residual": 4.2}, {},
            ("contact_energy_residual is 3.5 % of what impact and creep lose, beyond 3 %",),
        ),
        (
            {"contact_residual": -1.8}, {},
            ("the contact gains 1.5 % of what is dissipated, beyond 1 %",),
        ),
        ({"contact_residual": -1.8, "hinge": 80.0}, {}, ()),
        (
            {"contact_residual": -4.2, "hinge": 80.0}, {},
            ("contact_energy_residual is -3.5 % of what impact and creep lose, beyond 3 %",
             "the contact gains 2.1 % of what is dissipated, beyond 1 %"),
        ),
        (
            {"whole_residual": -0.24}, {},
            ("energy_residual is -0.2 % of what is dissipated, beyond 0.1 %",),
        ),
        (
            {"gravity": 3.0, "fallen": 2.4}, {},
            ("gravity_work_residual is 0.5 % of what is dissipated, beyond 0.1 %",),
        ),
        (
            {}, {"linear_residual": 2e-4},
            ("linear_momentum_residual is 0.02 % of the largest impulse, beyond 0.01 %",),
        ),
        (
            {}, {"angular_residual": float("nan")},
            ("angular_momentum_residual is nan % of the largest impulse, beyond 0.01 %",),
        ),
    ],
)  # fmt: skip
def test_each_bar_that_is_crossed_is_a_sentence(energy, moved, said):
    response = SimpleNamespace(
        audit=EnergyAudit(**{**SOUND, **energy}), momentum=replace(MOVED, **moved)
    )
    assert doubts(response) == said


def test_a_run_that_leaves_the_rails_is_audited_up_to_then():
    """A vehicle that is released in the midst: its momentum leaves, and nothing is missed."""
    system = pushed("turned, under gravity", DT)
    s = system.start.copy()
    march = system.kernel(PYTHON).call
    rows, history = np.arange(0), np.empty((len(system.drive), 0))
    march(s, system.constants, system.geometry, system.drive, 20, rows, history)
    s[system.layout.state.LEAVING] = 1.0
    stage(system, frames.release_trains)(s, system.constants, 1)
    kept = s[[system.layout.state.PEAK_LINEAR_LEFT, system.layout.state.PEAK_IMPULSE], 0].copy()
    assert kept[1] > 1e3
    march(s, system.constants, system.geometry, system.drive, 20, rows, history)
    after = s[[system.layout.state.PEAK_LINEAR_LEFT, system.layout.state.PEAK_IMPULSE], 0]
    np.testing.assert_array_equal(after, kept)
