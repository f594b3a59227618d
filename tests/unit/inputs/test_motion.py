"""GroundMotion: what is measured on a motion and what is done to it."""

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.inputs.ground_motion import STANDARD_GRAVITY, GroundMotion


def sine(frequency: float = 1.0, cycles: int = 10, dt: float = 0.001) -> GroundMotion:
    time = np.arange(round(cycles / frequency / dt) + 1) * dt
    return GroundMotion("sine", dt, np.cos(2.0 * np.pi * frequency * time))


def test_the_acceleration_is_a_read_only_copy() -> None:
    values = np.array([0.0, 1.0, 0.0])
    motion = GroundMotion("m", 0.01, values)
    values[1] = 9.0
    assert motion.acceleration[1] == 1.0
    with pytest.raises(ValueError, match=r"read-only"):
        motion.acceleration[0] = 1.0


@pytest.mark.parametrize("dt", [0.0, -0.01, np.nan, np.inf, "fast"])
def test_a_bad_time_step_is_refused(dt: float) -> None:
    with pytest.raises(InputError, match=r"dt"):
        GroundMotion("m", dt, np.zeros(3))


@pytest.mark.parametrize(
    "values", [[], [1.0], [[1.0, 2.0], [3.0, 4.0]], [0.0, np.nan], [0.0, np.inf], ["a", "b"]]
)
def test_bad_samples_are_refused(values: list[float]) -> None:
    with pytest.raises(InputError):
        GroundMotion("m", 0.01, np.array(values))


def test_measures_of_a_cosine() -> None:
    motion = sine(cycles=100, dt=0.002)
    assert motion.npts == 50001
    assert motion.duration == pytest.approx(100.0)
    assert motion.pga == 1.0
    # The velocity is sin(2 pi t) / (2 pi).  Its least-squares line over N cycles is not zero: it
    # reaches 6 / (2 pi N) of the peak at the ends.
    assert motion.pgv == pytest.approx(1.0 / (2.0 * np.pi), rel=6.0 / (2.0 * np.pi * 100))
    # The integral of cos^2 over whole cycles is half the duration.
    assert motion.arias_intensity == pytest.approx(np.pi / (2 * STANDARD_GRAVITY) * 50.0)
    assert motion.significant_duration() == pytest.approx(90.0, abs=0.02)


def test_pgv_takes_the_least_squares_line_off_the_velocity() -> None:
    motion = sine()
    offset = GroundMotion("offset", motion.dt, motion.acceleration + 0.3)
    assert offset.pgv == pytest.approx(motion.pgv, rel=1e-9)
    velocity = motion.velocity()
    line = np.polyval(np.polyfit(motion.time, velocity, 1), motion.time)
    assert motion.pgv == pytest.approx(np.max(np.abs(velocity - line)), rel=1e-9)


def test_a_motion_of_zeros_has_zero_measures() -> None:
    still = GroundMotion("still", 0.01, np.zeros(100))
    assert (still.pga, still.pgv, still.arias_intensity) == (0.0, 0.0, 0.0)
    assert still.significant_duration() == 0.0
    assert still.baseline_check() == ()


def test_scaling_and_mirroring_are_noted() -> None:
    motion = sine()
    double = motion.scaled(2.0)
    assert double.pga == 2.0
    assert double.notes == ("scaled by 2",)
    np.testing.assert_array_equal(motion.mirrored().acceleration, -motion.acceleration)
    assert motion.scaled(1.0) is motion


@pytest.mark.parametrize("factor", [0.0, -1.0, np.nan, np.inf])
def test_a_bad_scale_factor_is_refused(factor: float) -> None:
    with pytest.raises(InputError, match=r"scale factor"):
        sine().scaled(factor)


def test_resampling_interpolates_linearly() -> None:
    motion = GroundMotion("m", 0.02, np.array([0.0, 1.0, -1.0]))
    fine = motion.resampled(0.01)
    np.testing.assert_allclose(fine.acceleration, [0.0, 0.5, 1.0, 0.0, -1.0], atol=1e-12)
    assert fine.notes[-1] == "resampled from dt = 0.02 s to 0.01 s (linear)"
    coarse = motion.resampled(0.03)
    np.testing.assert_allclose(coarse.acceleration, [0.0, 0.0], atol=1e-12)
    assert "PGA lowered by 100.0 %" in coarse.notes[-1]
    assert motion.resampled(0.02) is motion


@pytest.mark.parametrize("dt", [0.0, -1.0, np.nan, 1.0, 1e-12])
def test_an_impossible_new_time_step_is_refused(dt: float) -> None:
    with pytest.raises(InputError, match=r"dt"):
        sine(cycles=1, dt=0.01).scaled(2.0).resampled(2.0 * dt)


def test_baseline_drift_is_reported() -> None:
    motion = sine(dt=0.01)
    assert motion.baseline_check() == ()
    drifting = GroundMotion("drifting", 0.01, motion.acceleration + 0.05)
    assert any("velocity" in text for text in drifting.baseline_check())
    assert any("displacement" in text for text in drifting.baseline_check())
