"""Many abreast: the lockstep's shortcuts against the single run, uncompiled."""

from dataclasses import replace

import numpy as np
import pytest

import railquake as rq
from jolts import FRAME, pushed
from railquake.assembly.statics import UNKNOWN_DEGRADATION
from railquake.assembly.system import hinge_parameters
from railquake.physics import boucwen, constant, march, pier, state
from railquake.physics.kernel import PYTHON, Target

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
    done = np.array([0, 0, late], dtype=np.int64)
    first.kernel(THREE).call(
        s, q, first.geometry, drive, starts, np.ones(3, dtype=np.int64), done, frames, 3, refresh
    )
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
    state.U, state.THETA1, state.THETA2, state.U_V, state.Z, state.EPS, state.X_MAX, state.MOMENT,
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
    chosen = bouc_wen if substeps == 1 else (*bouc_wen[:2], bouc_wen[1])
    systems = [replace(system, drive=system.drive[:23]) for system in chosen]
    longer = [system.with_substeps(substeps) for system in systems]
    assert {system.substeps for system in longer} == {substeps}
    together = abreast(longer, refresh)
    for lane, system in enumerate(systems):
        alone = rq.simulate(system, target=PYTHON).end[:, 0]
        for row in COMPARED:
            size = max(abs(alone[row]), 1e-9)
            assert together[row, lane] == pytest.approx(alone[row], abs=tolerance * size), (
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
    start[state.VEHICLE + 4] += 0.2  # the wheelset, beyond its shift's limit
    s = abreast((replace(one, start=start), two, three), 5, frames=2)
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
    """`boucwen` by its own functions at the hinge's state."""
    system = bouc_wen[0]
    s, q = system.start.copy(), system.constants
    s[state.THETA1], s[state.EPS], s[state.X_MAX] = 3e-4, 1.5e-4, 5e-4
    pier.refresh_hinge(s, q, 0)
    h = system.scenario.support.bouc_wen
    d = h.rho_eps * h.m * 1.5e-4 / (h.Fy * h.xu) + h.rho_x * 5e-4 / h.xu
    a = np.exp(-h.delta_k * d * np.exp(-h.phi * d))
    assert s[state.DAMAGE, 0] == pytest.approx(d)
    assert s[state.DEGRADED_A, 0] == pytest.approx(a)
    assert s[state.DEGRADED_BETA, 0] == pytest.approx(h.beta0 * a * np.exp(h.n * h.delta_f * d))
    step = 1e-7
    later = np.exp(-h.delta_k * (d + step) * np.exp(-h.phi * (d + step)))
    assert s[state.DEGRADED_LOG, 0] == pytest.approx(np.log(later / a) / step, rel=1e-4)
    pinched = np.exp(-0.5 * (3e-4 / h.sigma) ** h.u) * (1 - np.exp(-0.5 * (1.5e-4 / h.eps_p) ** 8))
    assert s[state.PINCHED, 0] == pytest.approx(h.k0 * (1 - h.rho_p * pinched))


def test_extrapolated_degradation_is_its_tangent():
    law = (1.6, 15.0, 0.5, 1.28, 17000.0)
    d, step = 0.02, 1e-4
    known = boucwen.degradation(d, *law)
    exact = boucwen.degradation(d + step, *law)
    found = boucwen.degradation_extrapolated(d + step, d, *known, *law)
    for value, wanted, before in zip(found[:2], exact[:2], known[:2], strict=True):
        # the rest is of second order: (15 x 1e-4)^2
        assert value == pytest.approx(wanted, rel=3e-6)
        assert value != before
    assert found[2] == known[2]
    assert boucwen.degradation_extrapolated(d, d, *known, *law) == pytest.approx(known)


def test_kept_pinching_is_the_last_one():
    assert boucwen.pinched_stiffness_kept(7.0, 1e-3, 1e-3, 1.0, 0.4, 1e3, 2.0, 1e3) == 7.0


@pytest.mark.parametrize(
    "law", [boucwen.advance, boucwen.advance_linearised, boucwen.advance_elastic]
)
def test_within_a_structure_each_law_answers_what_structure_and_hinge_want(bouc_wen, law):
    """dx = free - f M holds for what they return, at a step small enough for one solve."""
    h = bouc_wen[0].scenario.support.bouc_wen
    parameters = hinge_parameters(h, 1e-12, 50)
    state_now = (2e-4, 1.5e-4, 1.5e-4, 1e-4, 4e-4)
    flexibility = 3e-11
    moment = law(*state_now, *UNKNOWN_DEGRADATION, 0.0, 0.0, *parameters)[4]
    free = flexibility * moment + 2e-7
    dx, _, _, largest, found, tangent, *_ = law(
        *state_now, *UNKNOWN_DEGRADATION, free, flexibility, *parameters
    )
    assert dx == pytest.approx(free - flexibility * found, rel=1e-9)
    # and so, to the first order, by its tangent
    assert dx == pytest.approx(
        (free - flexibility * moment) / (1.0 + flexibility * tangent), rel=0.02
    )
    assert largest == 4e-4
    assert law(*state_now, *UNKNOWN_DEGRADATION, 1e-3, 0.0, *parameters)[3] == pytest.approx(1.2e-3)


def flanges_near(system, shift, speed=0.0, on=1.0):
    """What is noted of the flanges of a wheelset at this shift that moves at this speed."""
    s, q = system.start.copy(), system.constants
    s[state.VEHICLE + 4] += shift
    s[state.VEHICLE + 9 + 4] = speed
    s[state.ON_TRACK] = on
    march.find_contact_forces(s, q, system.geometry)
    march.look_again(s, q, system.geometry, 0)
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
    s = np.zeros((state.VEHICLE, 3))
    assert not march.comes_near(s, 0, 3)
    s[state.NEAR, 1] = 1.0
    assert march.comes_near(s, 0, 3)
    assert not march.comes_near(s, 1, 3)


def test_a_flange_that_waits_bears_nothing_whatever_the_other_lanes_do(bouc_wen):
    system = bouc_wen[0]
    s, q = system.start.copy(), system.constants
    s[state.VEHICLE + 4] += 9e-3 - 6.5e-3  # the right flange on its rail
    march.find_contact_forces(s, q, system.geometry)
    for near, bears in ((1.0, True), (0.0, False)):
        s[state.NEAR + 1] = near
        march.clear_forces(s, 0)
        march.press(s, q, system.geometry, 1, 1, 0)
        assert bool(s[state.LOAD_RIGHT, 0] != 0.0) is bears
        patch = state.PATCH + 3 * state.PATCH_ROWS
        assert bool(s[patch + state.PATCH_PENETRATION, 0] > 0.0) is bears
        assert bool(s[patch + state.PATCH_HYSTERESIS, 0] > 0.0) is bears


def test_an_idle_lane_stands_still(bouc_wen):
    one, two, three = bouc_wen
    idle = one.start.copy()
    idle[state.ON_TRACK] = 0.0
    idle[state.VEHICLE + 9 :] = 0.0
    q = one.constants.copy()
    q[constant.PIER_LOAD] = q[constant.REACTION] = 0.0
    s = abreast((replace(one, start=idle, constants=q), two, three), 5, 3)
    assert np.all(
        s[state.VEHICLE : state.VEHICLE + 9, 0] == idle[state.VEHICLE : state.VEHICLE + 9, 0]
    )
