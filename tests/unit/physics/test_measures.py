"""What is measured during a run, from a history that holds every step."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, lfilter, lfilter_zi

import railquake as rq
from jolts import pushed
from railquake.march import peaks
from railquake.march.compiler import PYTHON
from railquake.march.rows import constant, size, state

DT = 2e-5


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
FILTERS = np.array(BLOCKS) + np.arange(5)[:, None]  # a row for each filter
COEFFICIENTS = slice(constant.FILTER_B0, constant.FILTER_A2 + 1)


def frame_state():
    """State and constants for stages that need a frame's sums or the wheelset's place only."""
    system = pushed("to the right", DT)
    s, q = system.start.copy(), system.constants.copy()
    s[FILTERS] = 0.0
    q[COEFFICIENTS, 0] = (1.0, 0.0, 0.0, 0.0, 0.0)  # lets all pass
    q[constant.STATIC_WHEEL_LOAD] = 100.0
    s[state.LOWEST_LOAD] = 100.0
    return s, q


SUMS = state.SUM_LATERAL + np.arange(5)


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
    assert s[state.LOWEST_LOAD, 0] == pytest.approx(min(loads))
    assert not s[SUMS, 0].any()  # the next frame begins


def test_forces_of_a_train_that_has_left_count_no_more():
    s, q = frame_state()
    s[state.ON_TRACK] = 0.0
    s[SUMS, 0] = (50.0, 40.0, 60.0, 20.0, 30.0)
    q[constant.FRAME_STEPS] = 1.0
    peaks.filter_forces(s, q, 0)
    assert s[state.PEAK_DERAILMENT_COEFFICIENT, 0] == s[state.PEAK_LATERAL_FILTERED, 0] == 0.0
    assert s[state.LOWEST_LOAD, 0] == 100.0


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
    assert not s[FILTERS[[0, 1, 2, 4]]].any()  # the others were left alone


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
    assert s[state.LOWEST_LOAD, 0] == pytest.approx(min(100.0, loads.min()))


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
    start[state.VEHICLE_X + size.WHEELSET_Y] += 0.2  # the wheelset's y, beyond its shift's limit
    response = rq.simulate(replace(system, start=start), target=PYTHON)
    row = rq.assess(response)
    assert (row["status"], row["derailment_mode"]) == ("derailed", "slide-off right")
    assert row["derailed_s"] == pytest.approx(1e-4)
    # one frame is all that counts of the train: off its rails, then out of the model
    assert row["off_rail_time_s"] <= 1e-4 + 1e-12
    assert row["lateral_shift_peak_m"] < 0.22
    assert response.channel("wheel_load_right_n")[2:] == pytest.approx(0.0)
    bridge = response.channel("bridge_displacement_m")
    assert np.all(np.abs(np.diff(bridge[-20:])) > 0.0)  # it is still moving
    assert np.isnan(response.channel("lateral_shift_m")[-1])
