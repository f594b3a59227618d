"""Response spectra against closed forms and against the printed 2 x 2 recursion."""

import math

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.inputs.ground_motion import (
    GroundMotion,
    oscillator_response,
    response_spectrum,
    spectral_intensity,
    synthetic_motion,
)


def nigam_jennings(
    motion: GroundMotion, period: float, damping: float
) -> tuple[np.ndarray, np.ndarray]:
    """The recursion as Nigam & Jennings (1969) print it: A and B of their equation (2.7)."""
    w, b, h = 2.0 * np.pi / period, damping, motion.dt
    wd = w * np.sqrt(1.0 - b * b)
    e, s, c, r = np.exp(-b * w * h), np.sin(wd * h), np.cos(wd * h), np.sqrt(1.0 - b * b)
    a11, a12 = e * (b / r * s + c), e / wd * s
    a21, a22 = -w / r * e * s, e * (c - b / r * s)
    k1, k2 = (2 * b * b - 1) / (w * w * h), 2 * b / (w**3 * h)
    b11 = e * ((k1 + b / w) * s / wd + (k2 + 1 / w**2) * c) - k2
    b12 = -e * (k1 * s / wd + k2 * c) - 1 / w**2 + k2
    b21 = e * ((k1 + b / w) * (c - b / r * s) - (k2 + 1 / w**2) * (wd * s + b * w * c))
    b21 += 1 / (w * w * h)
    b22 = -e * (k1 * (c - b / r * s) - k2 * (wd * s + b * w * c)) - 1 / (w * w * h)
    x, v = np.zeros(motion.npts), np.zeros(motion.npts)
    a = motion.acceleration
    for i in range(motion.npts - 1):
        x[i + 1] = a11 * x[i] + a12 * v[i] + b11 * a[i] + b12 * a[i + 1]
        v[i + 1] = a21 * x[i] + a22 * v[i] + b21 * a[i] + b22 * a[i + 1]
    return x, v


@pytest.mark.parametrize("damping", [0.0, 0.05, 0.5])
@pytest.mark.parametrize("period", [0.05, 0.5, 3.0])
def test_response_equals_the_printed_recursion(period: float, damping: float) -> None:
    motion = synthetic_motion({"seed": 2, "duration": 10.0, "dt": 0.01})
    displacement, velocity = oscillator_response(motion, period, damping)
    x, v = nigam_jennings(motion, period, damping)
    np.testing.assert_allclose(displacement, x, atol=1e-10 * np.max(np.abs(x)))
    np.testing.assert_allclose(velocity, v, atol=1e-10 * np.max(np.abs(v)))


def test_free_vibration_after_a_step() -> None:
    """Constant ground acceleration from t = 0: u = -(1 - cos w t) a / w^2 without damping."""
    motion = GroundMotion("step", 0.01, np.ones(1001))
    displacement, velocity = oscillator_response(motion, 1.0, 0.0)
    w = 2.0 * np.pi
    np.testing.assert_allclose(displacement, -(1 - np.cos(w * motion.time)) / w**2, atol=1e-14)
    np.testing.assert_allclose(velocity, -np.sin(w * motion.time) / w, atol=1e-13)
    spectrum = response_spectrum(motion, 1.0, 0.0)
    assert spectrum.sd[0] == pytest.approx(2.0 / w**2, rel=1e-12)
    assert spectrum.sa[0] == pytest.approx(2.0, rel=1e-12)


@pytest.mark.parametrize("damping", [0.02, 0.05, 0.2])
def test_free_vibration_decays_by_the_logarithmic_decrement(damping: float) -> None:
    values = np.zeros(2001)
    values[1] = 1.0
    displacement, _ = oscillator_response(GroundMotion("kick", 0.005, values), 1.0, damping)
    # One damped period later the displacement is smaller by exp(-2 pi xi / sqrt(1 - xi^2)).
    time = np.arange(2001) * 0.005
    w, wd = 2.0 * np.pi, 2.0 * np.pi * np.sqrt(1.0 - damping**2)
    shape = np.exp(-damping * w * time)
    basis = np.column_stack((shape * np.cos(wd * time), shape * np.sin(wd * time)))[2:]
    fit, *_ = np.linalg.lstsq(basis, displacement[2:], rcond=None)
    np.testing.assert_allclose(basis @ fit, displacement[2:], atol=1e-12 * abs(fit).max())


@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_harmonic_steady_state(ratio: float) -> None:
    """Peak of the steady state: a / w^2 / sqrt((1 - r^2)^2 + (2 xi r)^2)."""
    damping, period, dt = 0.1, 1.0, 0.002
    w = 2.0 * np.pi / period
    time = np.arange(30001) * dt
    motion = GroundMotion("harmonic", dt, np.sin(ratio * w * time))
    displacement, _ = oscillator_response(motion, period, damping)
    steady = np.max(np.abs(displacement[-5000:]))
    gain = 1.0 / np.sqrt((1 - ratio**2) ** 2 + (2 * damping * ratio) ** 2)
    assert steady == pytest.approx(gain / w**2, rel=1e-4)


def test_rigid_and_soft_limits() -> None:
    motion = synthetic_motion({"seed": 3})
    spectrum = response_spectrum(motion, [0.0, 1e-3, 5e-3, 100.0])
    assert spectrum.sa[0] == motion.pga
    assert spectrum.psa[0] == motion.pga
    assert spectrum.sd[0] == 0.0
    np.testing.assert_allclose(spectrum.sa[1:3], motion.pga, rtol=2e-2)
    # A very soft oscillator stands still in space: Sd is the peak ground displacement.
    assert spectrum.sd[3] == pytest.approx(np.max(np.abs(motion.displacement())), rel=0.2)


def test_pseudo_spectra_and_peaks_between_samples() -> None:
    motion = synthetic_motion({"seed": 4, "dt": 0.02, "duration": 20.0})
    fine = motion.resampled(0.0005)
    periods = np.array([0.04, 0.1, 1.0])
    coarse, exact = response_spectrum(motion, periods), response_spectrum(fine, periods)
    for name in ("sd", "sv", "sa", "psa", "psv"):
        np.testing.assert_allclose(getattr(coarse, name), getattr(exact, name), rtol=5e-3)
    np.testing.assert_allclose(coarse.psv, 2 * np.pi / periods * coarse.sd)
    np.testing.assert_allclose(coarse.psa, (2 * np.pi / periods) ** 2 * coarse.sd)


def test_tiny_steps_lose_no_digits() -> None:
    """At w dt = 6e-6 the closed forms of the load weights would have lost ten digits."""
    time = np.arange(200_001) * 1e-5
    motion = GroundMotion("ramp", 1e-5, np.ones_like(time))
    displacement, _ = oscillator_response(motion, 10.0, 0.0)
    w = 2.0 * np.pi / 10.0
    np.testing.assert_allclose(displacement[-1], -(1 - np.cos(w * 2.0)) / w**2, rtol=1e-9)


@pytest.mark.parametrize("periods", [[-1.0], [np.nan], [np.inf], [], [[1.0]]])
def test_bad_periods_are_refused(periods: list[float]) -> None:
    with pytest.raises(InputError, match="periods"):
        response_spectrum(GroundMotion("m", 0.01, np.ones(5)), periods)


@pytest.mark.parametrize("damping", [-0.1, 1.0, np.nan])
def test_bad_damping_is_refused(damping: float) -> None:
    with pytest.raises(InputError, match="damping"):
        response_spectrum(GroundMotion("m", 0.01, np.ones(5)), [1.0], damping)


def test_spectral_intensity_of_a_jump_of_velocity_has_a_closed_form():
    """The pseudo-velocity is the same at all periods: that of a free swing with that velocity."""
    dt, jump, ratio = 1e-3, 0.4, 0.2
    pulse = np.zeros(3000)
    pulse[1] = jump / dt
    expected = jump * math.exp(-ratio / math.sqrt(1.0 - ratio**2) * math.acos(ratio))
    assert spectral_intensity(GroundMotion("jump", dt, pulse)) == pytest.approx(expected, rel=1e-3)
