"""What is measured during a run, from a history that holds every step."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, lfilter, lfilter_zi

import railquake as rq
from independent_car import FiniteCar
from jolts import pushed
from railquake.march import climb, peaks
from railquake.march.compiler import PYTHON
from railquake.march.order import kernel_order
from railquake.march.rows import constant, size, state
from railquake.physics.derailment import OVERTURNED
from railquake.physics.sliding_mean import window_of
from stages import stage

DT = 2e-5
SHORT = {"seed": 3, "duration": "1 s", "dt": "0.01 s", "highpass_frequency": "1 Hz"}


@pytest.fixture(scope="module")
def every_step():
    return rq.simulate(pushed("to the right", DT, frame=DT), target=PYTHON)


@pytest.mark.parametrize(
    ("key", "channels"),
    [
        ("pbd_m", ["bridge_displacement_m"]),
        ("pbv_m_s", ["bridge_velocity_m_s"]),
        ("pba_m_s2", ["bridge_acceleration_m_s2"]),
        ("hinge_rotation_peak_rad", ["hinge_rotation_rad"]),
        ("base_moment_peak_n_m", ["base_moment_n_m"]),
        ("top_rotation_peak_rad", ["top_rotation_rad"]),
        ("relative_roll_peak_rad", ["relative_roll_rad"]),
        ("lateral_shift_peak_m", ["lateral_shift_m"]),
        ("wheel_load_peak_n", ["wheel_load_left_n", "wheel_load_right_n"]),
        ("lateral_force_peak_n", ["lateral_force_n"]),
        ("lateral_force_filtered_peak_n", ["lateral_force_filtered_n"]),
    ],
)
def test_peaks_are_the_largest_of_all_steps(every_step, key, channels):
    history = np.array([every_step.channel(name)[1:] for name in channels])
    assert rq.assess(every_step)[key] == pytest.approx(np.abs(history).max(), rel=1e-12)


def test_time_off_the_rail_counts_the_steps_without_contact(every_step):
    off = {
        side: np.maximum(
            every_step.channel(f"penetration_{side}_tread_m"),
            every_step.channel(f"penetration_{side}_flange_m"),
        )[1:]
        <= 0.0
        for side in ("left", "right")
    }
    row = rq.assess(every_step)
    either, both = off["left"] | off["right"], off["left"] & off["right"]
    assert 0 < both.sum() < either.sum() < len(either)
    assert row["off_rail_time_s"] == pytest.approx(DT * either.sum(), rel=1e-9)
    assert row["detached_time_s"] == pytest.approx(DT * both.sum(), rel=1e-9)


def test_loads_and_lateral_force_add_up_to_what_the_contact_does(every_step):
    lateral = every_step.channel("lateral_force_n")[-1]
    end = every_step.end[:, 0]
    assert end[state.LATERAL_LEFT] + end[state.LATERAL_RIGHT] == pytest.approx(lateral)
    loads = sum(every_step.channel(f"wheel_load_{side}_n")[-1] for side in ("left", "right"))
    assert loads == pytest.approx(-end[state.FORCE_Z])


@pytest.mark.parametrize("steps", [1, 5])
def test_filtered_forces_are_a_butterworth_of_the_frames_means(every_step, steps):
    """scipy's filter, started from the steady state of the start."""
    frame = steps * DT
    found = (
        every_step
        if steps == 1
        else rq.simulate(pushed("to the right", DT, frame=frame), target=PYTHON)
    )
    b, a = butter(2, 20.0, fs=1.0 / frame)
    for name in ("lateral_force", "wheel_load_left", "wheel_load_right"):
        raw = every_step.channel(f"{name}_n")
        means = raw[1:].reshape(-1, steps).mean(axis=1)
        number = {"lateral_force": 0, "wheel_load_left": 1, "wheel_load_right": 2}[name]
        first = found.system.start[state.FILTER_Y1 + number, 0]  # at rest, before the push
        expected, _ = lfilter(b, a, means, zi=lfilter_zi(b, a) * first)
        size = np.abs(raw).max()
        assert found.channel(f"{name}_filtered_n")[1:] == pytest.approx(
            expected, rel=1e-9, abs=1e-9 * size
        )


BLOCKS = (state.FILTER_X1, state.FILTER_X2, state.FILTER_Y1, state.FILTER_Y2)
FILTERS = np.array(BLOCKS) + np.arange(6)[:, None]  # a row for each filter
COEFFICIENTS = slice(constant.FILTER_B0, constant.FILTER_A2 + 1)


def frame_state():
    """State and constants for stages that need a frame's sums or the wheelset's place only."""
    system = pushed("to the right", DT)
    s, q = system.start.copy(), system.constants.copy()
    s[FILTERS] = 0.0
    q[COEFFICIENTS, 0] = (1.0, 0.0, 0.0, 0.0, 0.0)  # lets all pass
    q[constant.STATIC_WHEEL_LOAD] = 100.0
    s[LOWEST] = 100.0
    return s, q


SUMS = state.SUM_LATERAL + np.arange(5)
LOWEST = [state.LOWEST_LOAD_LEFT, state.LOWEST_LOAD_RIGHT]


@pytest.mark.parametrize(
    ("loads", "lateral", "expected"),
    [
        ((80.0, 120.0), (24.0, -12.0), 0.3),  # left
        ((80.0, 120.0), (-8.0, 60.0), 0.5),  # right
        ((11.0, 120.0), (-22.0, 12.0), 2.0),
        ((9.0, 120.0), (45.0, 12.0), 0.1),  # left hardly bears, below a tenth of the static load
        ((10.0, 9.0), (45.0, 12.0), 0.0),
    ],
)
def test_derailment_coefficient_is_lateral_over_vertical_where_a_wheel_bears(
    loads, lateral, expected
):
    s, q = frame_state()
    s[SUMS, 0] = 4.0 * np.array([sum(lateral), *loads, *lateral])  # of a frame of four steps
    q[constant.FRAME_STEPS] = 4.0
    peaks.filter_forces(s, q, 0)
    assert s[state.PEAK_DERAILMENT_COEFFICIENT, 0] == pytest.approx(expected)
    assert s[state.PEAK_LATERAL_FILTERED, 0] == pytest.approx(abs(sum(lateral)))
    assert s[LOWEST, 0] == pytest.approx(np.minimum(loads, 100.0))
    assert not s[SUMS, 0].any()  # the next frame begins


def test_forces_of_a_train_that_has_left_count_no_more():
    s, q = frame_state()
    s[state.ON_TRACK] = 0.0
    s[SUMS, 0] = (50.0, 40.0, 60.0, 20.0, 30.0)
    q[constant.FRAME_STEPS] = 1.0
    peaks.filter_forces(s, q, 0)
    assert s[state.PEAK_DERAILMENT_COEFFICIENT, 0] == s[state.PEAK_LATERAL_FILTERED, 0] == 0.0
    assert s[LOWEST, 0].tolist() == [100.0, 100.0]


def test_a_filter_remembers_two_inputs_and_two_outputs():
    s, q = frame_state()
    coefficients = (0.2, 0.3, 0.1, -0.5, 0.25)
    q[COEFFICIENTS, 0] = coefficients
    drawn = np.random.default_rng(3).normal(size=12)
    found = []
    for x in drawn:
        s[SUMS[3]] = x
        found.append(peaks.filtered(s, q, 3, 1.0, 0))
    assert found == pytest.approx(lfilter(coefficients[:3], (1.0, *coefficients[3:]), drawn))
    assert not s[FILTERS[[0, 1, 2, 4, 5]]].any()  # the others were left alone


def test_every_force_has_a_filter_of_its_own():
    """Y/Q and the lowest load from filtered forces, each with its own past."""
    s, q = frame_state()
    coefficients = (0.2, 0.3, 0.1, -0.5, 0.25)
    q[COEFFICIENTS, 0] = coefficients
    q[constant.FRAME_STEPS] = 2.0
    drawn = np.random.default_rng(11).uniform(30.0, 90.0, size=(8, 5))
    for sums in drawn:
        s[SUMS, 0] = 2.0 * sums
        peaks.filter_forces(s, q, 0)
    out = lfilter(coefficients[:3], (1.0, *coefficients[3:]), drawn, axis=0)
    loads, lateral = out[:, 1:3], out[:, 3:]
    bears = loads > 10.0  # a tenth of the static load
    ratios = np.where(bears, np.abs(lateral) / np.maximum(loads, 10.0), 0.0)
    assert s[state.PEAK_DERAILMENT_COEFFICIENT, 0] == pytest.approx(ratios.max())
    assert s[state.PEAK_LATERAL_FILTERED, 0] == pytest.approx(np.abs(out[:, 0]).max())
    assert s[LOWEST, 0] == pytest.approx(np.minimum(100.0, loads.min(axis=0)))


@pytest.mark.parametrize("bearing", range(16))
def test_a_wheel_is_off_its_rail_when_neither_tread_nor_flange_bears(bearing):
    s = np.zeros((size.STATE_ROWS, 1))
    # the neighbours' are none of its business
    s[state.PATCH_HYSTERESIS - 4 : state.FORCE_Y + 4] = 7.0
    touches = [bool(bearing >> patch & 1) for patch in range(4)]
    for patch, touch in enumerate(touches):
        s[state.PATCH_PENETRATION + patch] = 1e-5 if touch else -1e-5
    expected = (float(not any(touches[:2])), float(not any(touches[2:])))
    assert peaks.wheels_off(s, 0) == expected


def test_structure_runs_on_alone_after_the_train_has_left():
    system = pushed("to the right", DT)
    start = system.start.copy()
    constants = system.constants.copy()
    # off its rails at once, and overturned before: it is followed no further
    constants[constant.SLIDE_LIMIT] = 0.0
    start[state.FIRST_TIME + OVERTURNED], start[state.FIRST_SIDE + OVERTURNED] = 0.0, 1.0
    changed = replace(system, start=start, constants=constants)
    response = rq.simulate(changed, target=PYTHON)
    row = rq.assess(response)
    assert (row["status"], row["derailment_mode"]) == ("derailed", "overturned right")
    assert row["derailed_s"] == pytest.approx(1e-4)
    # one frame is all that counts of the train: off its rails, then out of the model
    assert row["off_rail_time_s"] <= 1e-4 + 1e-12
    assert row["lateral_shift_peak_m"] < 0.22
    assert response.channel("wheel_load_right_n")[2:] == pytest.approx(0.0)
    bridge = response.channel("bridge_displacement_m")
    assert np.all(np.abs(np.diff(bridge[-20:])) > 0.0)  # it is still moving
    assert np.isnan(response.channel("lateral_shift_m")[-1])


# --- flange climb -------------------------------------------------------------------------------

SIDES = (("LEFT", -1.0), ("RIGHT", 1.0))


def frames_of(s, q, forces):
    """Frames of one step each, with means of lateral force and load of each side."""
    q[constant.FRAME_STEPS] = 1.0
    found = []
    for y_left, y_right, load_left, load_right in forces:
        s[SUMS, 0] = (y_left + y_right, load_left, load_right, y_left, y_right)
        peaks.filter_forces(s, q, 0)
        climb.measure_climb(s, q, 1)
        found.append(s[:, 0].copy())
    return np.array(found)


@pytest.mark.parametrize(("frames", "every"), [(6, 1), (30, 3), (40, 4)])
def test_flange_climb_is_the_largest_mean_of_y_over_q_towards_the_flange(frames, every):
    """Each side by its own forces, outward ones, and zero where it hardly bears.

    A side's sign turned, or magnitudes in the place of values with a sign, would show here, and so
    would a window that begins at nothing before the run.
    """
    s, q = frame_state()
    q[constant.CLIMB_WINDOW + np.arange(2), 0] = window_of(frames * 1e-3, 1e-3)
    drawn = np.random.default_rng(8)
    swing = np.sin(2.0 * np.pi * np.arange(400)[:, None] / (170.0, 130.0))
    lateral = 40.0 * swing + drawn.normal(scale=6.0, size=(400, 2))
    loads = drawn.uniform(5.0, 60.0, size=(400, 2))
    found = frames_of(s, q, np.hstack([lateral, loads]))
    for side, (name, outward) in enumerate(SIDES):
        ratios = np.where(loads[:, side] > 10.0, outward * lateral[:, side] / loads[:, side], 0.0)
        means = np.convolve(ratios, np.full(frames, 1.0 / frames), "valid")[::every]
        assert means.max() > 0.5 and means.min() < -0.5
        peak = found[:, getattr(state, f"PEAK_CLIMB_{name}")]
        assert peak[-1] == pytest.approx(means.max())
        assert not peak[: frames - 1].any()
        halfway = (200 - frames) // every + 1  # windows that have ended by frame 200
        assert peak[199] == pytest.approx(max(means[:halfway].max(), 0.0))


def test_flange_climb_of_a_standing_train_is_the_low_passed_value():
    """0.01 km/h and 80 km/h: 2 m would take twelve minutes."""
    frame = 1e-4
    for speed, blocks, per_frame in (("0.01 km/h", 1.0, 1.0), ("80 km/h", 10.0, 10.0 / 900.0)):
        system = rq.assemble(rq.scenario(synthetic=SHORT, speed=speed, history_step=frame))
        window = system.constants[constant.CLIMB_WINDOW + np.arange(2), 0]
        assert window == pytest.approx((per_frame, blocks))
        sustained = system.constants[constant.SUSTAINED_WINDOW + np.arange(2), 0]
        assert sustained == pytest.approx((10.0 / 3000.0, 10.0))


def test_least_load_of_each_side_is_its_own():
    s, q = frame_state()
    found = frames_of(s, q, [(0.0, 0.0, 90.0, 120.0), (0.0, 0.0, 60.0, 95.0), (0, 0, 70.0, 130.0)])
    assert found[:, state.LOWEST_LOAD_LEFT].tolist() == [90.0, 60.0, 60.0]
    assert found[:, state.LOWEST_LOAD_RIGHT].tolist() == [100.0, 95.0, 95.0]


def steps_of(s, q, steps):
    """Steps with these lateral forces and loads of each side, and flanges' penetrations."""
    q[constant.DT] = 0.5e-3
    for y_left, y_right, load_left, load_right, *flanges in steps:
        s[[state.LATERAL_LEFT, state.LATERAL_RIGHT], 0] = y_left, y_right
        s[[state.LOAD_LEFT, state.LOAD_RIGHT], 0] = load_left, load_right
        s[[state.PENETRATION_LEFT_FLANGE, state.PENETRATION_RIGHT_FLANGE], 0] = flanges or (-1, -1)
        peaks.measure_contact(s, q, 0)


def test_time_of_climb_is_the_longest_without_interruption():
    """Y/Q above 0.8 towards the flange, of single steps: a gap of one step begins anew."""
    s, q = frame_state()
    over, under, inward, light = (81.0, 100.0), (79.0, 100.0), (-90.0, 100.0), (60.0, 9.0)
    left = [over] * 7 + [under] + [over] * 5 + [inward] * 20 + [light] * 20 + [over] * 4
    right = [under] * 3 + [over] * 3 + [light] + [over] * 2 + [under] * 48
    steps_of(s, q, [(-a[0], b[0], a[1], b[1]) for a, b in zip(left, right, strict=True)])
    assert s[state.LONGEST_CLIMB_LEFT, 0] == pytest.approx(7 * 0.5e-3)
    assert s[state.LONGEST_CLIMB_RIGHT, 0] == pytest.approx(3 * 0.5e-3)
    assert s[state.CLIMB_TIME_LEFT, 0] == pytest.approx(4 * 0.5e-3)


# --- what the treads bear -----------------------------------------------------------------------


@pytest.mark.parametrize("flange", [(1e-6, -1.0), (-1.0, 1e-6)])
def test_a_flange_that_bears_in_one_step_is_remembered_for_its_frame(flange):
    s, q = frame_state()
    steps_of(s, q, [(0, 0, 50, 50), (0, 0, 50, 50, *flange), (0, 0, 50, 50)])
    assert s[state.FLANGE_BORE, 0] == 1e-6
    climb.measure_climb(s, q, 1)
    assert s[state.FLANGE_BORE, 0] == 0.0
    steps_of(s, q, [(0, 0, 50, 50)])
    assert s[state.FLANGE_BORE, 0] == 0.0


def borne(s, q, frames):
    """Frames of one step: lateral force, and whether a flange bears."""
    q[constant.FRAME_STEPS] = 1.0
    for lateral, bears in frames:
        s[state.SUM_LATERAL] = lateral
        s[state.FLANGE_BORE] = 1e-4 if bears else 0.0
        peaks.filter_forces(s, q, 0)
        climb.measure_climb(s, q, 1)


def test_a_flange_s_force_does_not_ring_on_in_what_the_treads_bear():
    """A filter that had seen it would go on with 0.5 of it in the frame after."""
    s, q = frame_state()
    q[COEFFICIENTS, 0] = (0.5, 0.0, 0.0, -0.5, 0.0)
    borne(s, q, [(40.0, False)] * 3 + [(1000.0, True)] * 5 + [(-20.0, False)])
    # 20, 30, 35; then out of sight, 35/2, 35/4 ...
    assert s[state.PEAK_LATERAL_TREADS, 0] == pytest.approx(35.0)
    assert s[state.PEAK_LATERAL_FILTERED, 0] > 900.0


def test_sustained_force_is_of_whole_windows_without_a_flange():
    """A window that a flange interrupts begins anew; a mean of what is left would be 400 here."""
    s, q = frame_state()
    q[constant.SUSTAINED_WINDOW + np.arange(2), 0] = window_of(20e-3, 1e-3)
    borne(s, q, [(400.0, False)] * 19 + [(900.0, True)])
    assert s[state.PEAK_LATERAL_SUSTAINED, 0] == 0.0
    borne(s, q, [(-30.0, False)] * 10 + [(-50.0, False)] * 10)
    assert s[state.PEAK_LATERAL_SUSTAINED, 0] == pytest.approx(40.0)
    borne(s, q, [(-50.0, False)] * 3)  # a tenth of the window is two frames
    assert s[state.PEAK_LATERAL_SUSTAINED, 0] == pytest.approx(42.0)
    borne(s, q, [(400.0, True)] + [(400.0, False)] * 19)
    assert s[state.PEAK_LATERAL_SUSTAINED, 0] == pytest.approx(42.0)
    s[state.ON_TRACK] = 0.0
    borne(s, q, [(400.0, False)] * 40)
    assert s[state.PEAK_LATERAL_SUSTAINED, 0] == pytest.approx(42.0)


# --- the car --------------------------------------------------------------------------------------


def placed(name, x):
    """State and constants of a car whose bodies are displaced by x (y, z, phi of each)."""
    system = pushed(name, DT)
    s = system.start.copy()
    s[state.VEHICLE_X + np.arange(9), 0] = x[kernel_order(9)]
    turned = np.array([state.VEHICLE_X + 2 * k + 1 for k in range(3)])
    layout = system.layout
    if system.vehicle.is_finite:
        s[layout.state_blocks["BODY_SIN"], 0] = np.sin(s[turned, 0])
        s[layout.state_blocks["BODY_COS"], 0] = np.cos(s[turned, 0])
    s[layout.state.TRACK_PHI], s[layout.state.GROUND] = 0.03, -2.0
    s[layout.state.VEHICLE_A + np.arange(9), 0] = np.arange(9.0)
    return system, s


@pytest.mark.parametrize("name", ["to the right", "turned, under gravity"])
def test_travel_is_that_of_the_lateral_springs(name):
    """The elongation by which the springs themselves pull, linear or from coordinates alone."""
    x = np.array([0.25, 0.02, 0.12, 0.04, -0.01, -0.05, -0.01, 0.004, 0.02])
    system, s = placed(name, x)
    stage(system, peaks.measure_bodies)(s, system.constants, 0)
    rows = system.layout.state
    case = system.scenario.vehicle
    expected = {}
    if name == "to the right":
        for spring in case.springs:
            if spring.direction == "lateral":
                upper, lower = (system.vehicle.bodies.index(body) for body in spring.bodies)
                rise = [spring.height - body.height for body in case.bodies]
                # y and roll (right side down) of a point so high above a centre of gravity
                expected[spring.name] = (x[3 * upper] + rise[upper] * x[3 * upper + 2]) - (
                    x[3 * lower] + rise[lower] * x[3 * lower + 2]
                )
    else:
        car = FiniteCar(case)
        for spring, travel in zip(
            [s for s in case.springs for _ in range(2)], car.coordinates(x)[0], strict=False
        ):
            # a point off the middle travels as the middle does, but for the roll between the bodies
            expected.setdefault(spring.name, []).append(travel)
        expected = {key: np.mean(both) for key, both in expected.items()}
    for stage_name in ("primary", "secondary"):
        peak = s[getattr(rows, f"PEAK_{stage_name.upper()}_TRAVEL"), 0]
        assert peak == pytest.approx(abs(expected[f"{stage_name}-lateral"]), rel=1e-9)
    assert s[rows.PEAK_BODY_ROLL, 0] == pytest.approx(0.12 - 0.03)
    assert s[rows.PEAK_BODY_A, 0] == pytest.approx(2.0)  # the car's is 0 against the ground
    s[rows.ON_TRACK] = 0.0
    s[rows.VEHICLE_X : rows.VEHICLE_X + 9] *= 3.0
    before = s.copy()
    stage(system, peaks.measure_bodies)(s, system.constants, 0)
    assert np.array_equal(s, before)
