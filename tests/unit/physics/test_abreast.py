"""Many abreast: the lockstep's shortcuts against the single run, uncompiled."""

from dataclasses import replace

import numpy as np
import pytest

import railquake as rq
from jolts import FRAME, pushed
from railquake.laws import HINGE_LAWS
from railquake.march import contact
from railquake.march.compiler import PYTHON, Target
from railquake.march.rows import constant, size, state
from railquake.march.slots import chosen
from railquake.march.step import find_contact_forces
from railquake.march.structure import refresh_hinge
from railquake.physics.derailment import OVERTURNED
from railquake.physics.hinge.bouc_wen import (
    LAW,
    Parameters,
    degradation,
    degradation_extrapolated,
    pinched_stiffness,
    pinched_stiffness_kept,
)
from stages import stage

DT = 2e-5
THREE = Target("three in python", compiled=False, lanes=3)


def abreast(systems, refresh, frames=None, late=0):
    """States at the end of systems that start together; the last one ``late`` frames behind."""
    first = systems[0]
    frames = first.frames if frames is None else frames
    s = np.hstack([system.start for system in systems])
    q = np.hstack([system.constants for system in systems])
    rows = len(first.drive)
    drive = np.vstack([system.drive for system in systems] + [np.zeros((2, first.drive.shape[1]))])
    starts = np.array([0, rows, 2 * rows + late], dtype=np.int64)
    s[state.FRAMES] = 0.0, 0.0, late
    lane_rows = starts, np.ones(3, dtype=np.int64)
    first.kernel(THREE).call(s, q, first.geometry, drive, lane_rows, frames, 3, refresh)
    return s


@pytest.fixture(scope="module")
def bouc_wen():
    """Three scenarios of one kind: to the right, turned round, and decoupled."""
    return (
        pushed("to the right", DT),
        pushed("to the right", DT, sign=-0.9),
        pushed("decoupled, creeping", DT),
    )


COMPARED = (
    state.U, state.THETA1, state.THETA2, state.U_V, state.HINGE_Z, state.HINGE_EPS,
    state.HINGE_X_MAX, state.MOMENT,
    state.SHIFT, state.HEIGHT, state.ROLL, state.FORCE_Y, state.LOAD_LEFT, state.LOAD_RIGHT,
    state.WORK_GROUND, state.WORK_GRAVITY, state.LOST_DASHPOTS, state.LOST_CREEP,
    state.HINGE_ENERGY,
    state.PEAK_U, state.PEAK_ROLL, state.PEAK_LATERAL, state.TIME, state.FLAGS,
)  # fmt: skip


@pytest.mark.parametrize(
    ("refresh", "substeps", "tolerance"), [(1, 1, 2e-3), (10, 1, 1e-2), (1, 5, 3e-2)]
)
def test_each_lane_gives_what_its_single_run_gives(bouc_wen, refresh, substeps, tolerance):
    """But for one linearised solve of the hinge a step, pinching kept for some steps, or the longer
    step of structure and sprung bodies.
    """
    # into the flange; a train that stands has not the longer step of the others
    ones = bouc_wen if substeps == 1 else (*bouc_wen[:2], bouc_wen[1])
    systems = [replace(system, drive=system.drive[:23]) for system in ones]
    longer = [system.with_substeps(substeps) for system in systems]
    assert {system.substeps for system in longer} == {substeps}
    together = abreast(longer, refresh)
    for lane, system in enumerate(systems):
        alone = rq.simulate(system, target=PYTHON).end[:, 0]
        for row in COMPARED:
            scale = max(abs(alone[row]), 1e-9)
            assert together[row, lane] == pytest.approx(alone[row], abs=tolerance * scale), (
                lane,
                row,
            )


def test_a_lane_does_not_feel_its_neighbours(bouc_wen):
    one, two, three = bouc_wen
    there, back = abreast((one, two, three), 5, 20), abreast((one, three, two), 5, 20)
    assert np.all(there[:, 0] == back[:, 0])
    assert np.all(there[:, 1] == back[:, 2])


def test_a_lane_that_began_earlier_has_its_own_time_and_ground(bouc_wen):
    one, two, three = bouc_wen
    s = abreast((one, two, three), 5, frames=3, late=4)
    assert s[state.TIME, 0] == pytest.approx(3 * FRAME)
    assert s[state.TIME, 2] == pytest.approx(7 * FRAME)
    assert s[state.GROUND, 0] == pytest.approx(one.drive[3, 0])
    assert s[state.GROUND, 2] == pytest.approx(three.drive[7, 0])


def test_a_train_that_leaves_is_released_in_its_lane_alone(bouc_wen):
    one, two, three = bouc_wen
    start = one.start.copy()
    constants = one.constants.copy()
    # off its rails at once, and overturned before: it is followed no further
    constants[constant.SLIDE_LIMIT] = start[state.FIRST_TIME + OVERTURNED] = 0.0
    leaving = replace(one, start=start, constants=constants)
    s = abreast((leaving, two, three), 5, frames=2)
    assert s[state.ON_TRACK].tolist() == [0.0, 1.0, 1.0]


def test_all_lanes_stop_at_the_frame_in_which_one_diverges(bouc_wen):
    one, two, three = bouc_wen
    start = two.start.copy()
    start[state.U_V] = 4e4  # m/s: soon beyond the bound
    s = abreast((one, replace(two, start=start), three), 5, frames=6)
    assert s[state.DIVERGED].tolist() == [0.0, 1.0, 0.0]
    ended = round(float(s[state.TIME, 1]) / FRAME)
    assert 0 < ended < 6
    undisturbed = abreast((one, two, three), 5, ended)
    for lane in (0, 2):
        assert np.array_equal(undisturbed[COMPARED, lane], s[COMPARED, lane])


def test_refreshed_hinge_knows_its_degradation_and_pinching(bouc_wen):
    """The law by its own functions at the hinge's state."""
    system = bouc_wen[0]
    s, q = system.start.copy(), system.constants
    s[state.THETA1], s[state.HINGE_EPS], s[state.HINGE_X_MAX] = 3e-4, 1.5e-4, 5e-4
    stage(system, refresh_hinge, "abreast")(s, q, 0)
    h = system.scenario.support.bouc_wen
    d = h.rho_eps * h.m * 1.5e-4 / (h.Fy * h.xu) + h.rho_x * 5e-4 / h.xu
    a = np.exp(-h.delta_k * d * np.exp(-h.phi * d))
    assert s[state.HINGE_D, 0] == pytest.approx(d)
    assert s[state.HINGE_A, 0] == pytest.approx(a)
    assert s[state.HINGE_BETA, 0] == pytest.approx(h.beta0 * a * np.exp(h.n * h.delta_f * d))
    step = 1e-7
    later = np.exp(-h.delta_k * (d + step) * np.exp(-h.phi * (d + step)))
    assert s[state.HINGE_LOG_A, 0] == pytest.approx(np.log(later / a) / step, rel=1e-4)
    pinched = np.exp(-0.5 * (3e-4 / h.sigma) ** h.u) * (1 - np.exp(-0.5 * (1.5e-4 / h.eps_p) ** 8))
    assert s[state.HINGE_KP, 0] == pytest.approx(h.k0 * (1 - h.rho_p * pinched))


def test_lanes_refresh_their_hinges_as_they_go(bouc_wen):
    """Pinching is that of a state at most some steps ago, and no longer that of the start."""
    s = abreast(bouc_wen, 5)
    for lane, system in enumerate(bouc_wen):
        law = Parameters(*system.constants[constant.HINGE :, 0])
        now = pinched_stiffness(s[state.THETA1, lane], s[state.HINGE_EPS, lane], law)
        begun = system.start[state.HINGE_KP, 0]
        assert s[state.HINGE_KP, lane] == pytest.approx(now, rel=0.02)
        assert abs(now - begun) > 0.05 * law.k0


def numbers(**named):
    """Parameters of the Bouc-Wen law of which a test needs some."""
    nothing = Parameters(*(0.0 for _ in Parameters._fields))
    return nothing._replace(**named)


def test_extrapolated_degradation_is_its_tangent():
    law = numbers(phi=1.6, delta_k=15.0, delta_f=0.5, n=1.28, beta0=17000.0)
    d, step = 0.02, 1e-4
    known = degradation(d, law)
    exact = degradation(d + step, law)
    found = degradation_extrapolated(d + step, known, law)
    for value, wanted, before in (
        (found.a, exact.a, known.a),
        (found.beta, exact.beta, known.beta),
    ):
        # the rest is of second order: (15 x 1e-4)^2
        assert value == pytest.approx(wanted, rel=3e-6)
        assert value != before
    assert found.log_a == known.log_a
    assert degradation_extrapolated(d, known, law) == pytest.approx(known)


def test_kept_pinching_is_the_last_one():
    law = numbers(k0=1.0, rho_p=0.4, per_sigma=1e3, u=2.0, per_eps_p=1e3)
    begun = LAW.virgin._replace(eps=1e-3, kp=7.0)
    assert pinched_stiffness_kept(1e-3, begun, law) == 7.0


@pytest.mark.parametrize(
    ("name", "solve"), [("bouc-wen", "advance"), ("bouc-wen", "linearised"), ("elastic", "advance")]
)
def test_within_a_structure_each_law_answers_what_structure_and_hinge_want(bouc_wen, name, solve):
    """dx = free - f M holds for what they return, at a step small enough for one solve."""
    h = bouc_wen[0].scenario.support.bouc_wen
    parameters = HINGE_LAWS[name].parameters(h, 1e-12, 50)
    law = getattr(HINGE_LAWS[name], solve)
    x, begun = 2e-4, HINGE_LAWS[name].virgin._replace(z=1.5e-4, eps=1e-4, x_max=4e-4)
    flexibility = 3e-11
    moment = law(x, begun, parameters, 0.0, 0.0).moment
    free = flexibility * moment + 2e-7
    found = law(x, begun, parameters, free, flexibility)
    assert found.step == pytest.approx(free - flexibility * found.moment, rel=1e-9)
    # and so, to the first order, by its tangent
    assert found.step == pytest.approx(
        (free - flexibility * moment) / (1.0 + flexibility * found.tangent), rel=0.02
    )
    assert found.state.x_max == 4e-4
    assert law(x, begun, parameters, 1e-3, 0.0).state.x_max == pytest.approx(1.2e-3)


def flanges_near(system, shift, speed=0.0, on=1.0):
    """What is noted of the flanges of a wheelset at this shift that moves at this speed."""
    s, q, state = system.start.copy(), system.constants, system.layout.state
    s[state.VEHICLE_X + 4] += shift
    s[state.VEHICLE_V + 4] = speed
    s[state.ON_TRACK] = on
    stage(system, find_contact_forces, "abreast")(s, q, system.geometry)
    stage(system, contact.look_at_flanges, "abreast")(s, q, system.geometry, 0)
    return s[state.NEAR : state.NEAR + 2, 0].tolist()


def test_far_flanges_wait_until_they_are_looked_at_again():
    """The right flange meets its rail at a shift of 7.96 mm (physics.md, section 4)."""
    motion = {"seed": 1, "duration": "2 s", "highpass_frequency": "0.6 Hz"}
    system = rq.assemble(rq.scenario(synthetic=motion, support="at-grade"))
    assert flanges_near(system, 0.0) == [0.0, 0.0]
    assert flanges_near(system, 7.5e-3) == [0.0, 0.0]  # a third of a millimetre above the rail
    assert flanges_near(system, 7.95e-3) == [0.0, 1.0]
    assert flanges_near(system, 8.5e-3) == [0.0, 1.0]
    assert flanges_near(system, -7.95e-3) == [1.0, 0.0]
    assert flanges_near(system, 7.95e-3, on=0.0) == [0.0, 0.0]
    # what it would reach within twice the time between two looks counts, too
    assert flanges_near(system, 7.5e-3, speed=3.0) == [0.0, 1.0]
    assert flanges_near(system, 7.5e-3, speed=-3.0) == [0.0, 0.0]


def test_a_flange_is_near_if_it_is_in_any_lane():
    near = chosen({"engine": "abreast"})[contact.flange_near]
    s = np.zeros((size.STATE_ROWS, 3))
    assert not near(s, 0, 3)
    s[state.NEAR, 1] = 1.0
    assert near(s, 0, 3)
    assert not near(s, 1, 3)


def test_a_flange_that_waits_bears_nothing_whatever_the_other_lanes_do(bouc_wen):
    system = bouc_wen[0]
    s, q = system.start.copy(), system.constants
    s[state.VEHICLE_X + 4] += 9e-3 - 6.5e-3  # the right flange on its rail
    stage(system, find_contact_forces, "abreast")(s, q, system.geometry)
    press_patch = stage(system, contact.press_patch, "abreast")
    for near, bears in ((1.0, True), (0.0, False)):
        s[state.NEAR + 1] = near
        contact.clear_forces(s, 0)
        press_patch(s, q, system.geometry, 1, 1, 0)
        assert bool(s[state.LOAD_RIGHT, 0] != 0.0) is bears
        assert bool(s[state.PATCH_PENETRATION + 3, 0] > 0.0) is bears
        assert bool(s[state.PATCH_HYSTERESIS + 3, 0] > 0.0) is bears


def test_an_idle_lane_stands_still(bouc_wen):
    one, two, three = bouc_wen
    idle = one.start.copy()
    idle[state.ON_TRACK] = 0.0
    idle[state.VEHICLE_V : state.VEHICLE_STEP + 9] = 0.0
    q = one.constants.copy()
    q[constant.GROUND_LOAD] = q[constant.REACTION] = 0.0
    s = abreast((replace(one, start=idle, constants=q), two, three), 5, 3)
    place = slice(state.VEHICLE_X, state.VEHICLE_X + 9)
    assert np.all(s[place, 0] == idle[place, 0])
