"""Oscillators on the track and on the ground: exact for what each step takes."""

import math

import numpy as np
import pytest

from railquake.physics.oscillator import (
    RampStep,
    largest_swing,
    largest_swings,
    oscillator_step,
    pseudo_velocity,
    swing,
    swing_on_ramp,
)


@pytest.mark.parametrize("ratio", [0.0, 0.05, 0.2])
@pytest.mark.parametrize("step", [1e-3, 0.07])
def test_an_even_push_from_rest_has_a_closed_form(ratio, step):
    """Under u'' + 2 zeta w u' + w^2 u = -a from rest; the steps may be as long as they like."""
    period, a = 0.6, 1.7
    w = 2.0 * math.pi / period
    wd = w * math.sqrt(1.0 - ratio**2)
    by = oscillator_step(period, ratio, step)
    re = im = 0.0
    for n in range(1, 40):
        re, im = swing(re, im, a * step, by)
        t = n * step
        decay = math.exp(-ratio * w * t)
        still = decay * (math.cos(wd * t) + ratio * w / wd * math.sin(wd * t))
        displacement = -a / w**2 * (1.0 - still)
        assert im / wd == pytest.approx(displacement, rel=1e-9, abs=1e-12)
        velocity = re - ratio * w * im / wd
        assert velocity == pytest.approx(-a * decay * math.sin(wd * t) / wd, rel=1e-9, abs=1e-9)


def test_a_jump_of_velocity_swings_an_undamped_one_by_that_velocity():
    by = oscillator_step(1.0, 0.0, 1e-4)
    re, im, largest = 0.0, 0.0, 0.0
    for n in range(10_000):
        re, im = swing(re, im, 0.3 if n == 0 else 0.0, by)
        largest = max(largest, abs(im))
    assert pseudo_velocity(largest, 0.0) == pytest.approx(0.3, rel=1e-6)
    assert np.hypot(re, im) == pytest.approx(0.3, rel=1e-6)


def ramp_step(period: float, ratio: float, step: float) -> RampStep:
    """By the closed forms, for steps that are not short."""
    z = step * 2.0 * math.pi / period * complex(-ratio, math.sqrt(1.0 - ratio**2))
    phi1 = (np.exp(z) - 1.0) / z
    phi2 = (phi1 - 1.0) / z
    parts = (np.exp(z), step * (phi1 - phi2), step * phi2)
    return RampStep(*(float(x) for part in parts for x in (part.real, part.imag)))


def test_an_even_acceleration_is_a_ramp_without_rise():
    even, ramp = oscillator_step(0.6, 0.2, 0.07), ramp_step(0.6, 0.2, 0.07)
    assert swing_on_ramp(0.3, -0.1, 1.7, 1.7, ramp) == pytest.approx(
        swing(0.3, -0.1, 1.7 * 0.07, even), rel=1e-12
    )


@pytest.mark.parametrize("ratio", [0.0, 0.05, 0.2])
def test_an_acceleration_that_grows_evenly_has_a_closed_form(ratio):
    """Under u'' + 2 zeta w u' + w^2 u = -b t from rest: a ramp and a free vibration."""
    period, b, step = 0.6, 1.7, 0.07
    w = 2.0 * math.pi / period
    wd = w * math.sqrt(1.0 - ratio**2)
    by = ramp_step(period, ratio, step)
    re = im = 0.0
    for n in range(1, 40):
        re, im = swing_on_ramp(re, im, b * (n - 1) * step, b * n * step, by)
        t = n * step
        free = (1.0 - 2.0 * ratio**2) / wd * math.sin(wd * t) - 2.0 * ratio / w * math.cos(wd * t)
        displacement = -b / w**2 * (t - 2.0 * ratio / w - math.exp(-ratio * w * t) * free)
        assert im / wd == pytest.approx(displacement, rel=1e-9)


def test_substeps_find_the_peak_between_samples():
    ground = np.random.default_rng(6).standard_normal(40)
    coarse = largest_swing(ground, 1, ramp_step(1.0, 0.0, 0.3))
    fine = largest_swing(ground, 30, ramp_step(1.0, 0.0, 0.01))
    finer = largest_swing(ground, 300, ramp_step(1.0, 0.0, 0.001))
    assert 0.98 * fine > coarse > 0.8 * fine
    assert fine == pytest.approx(finer, rel=1e-3)


def test_many_oscillators_swing_as_each_alone():
    ground = np.random.default_rng(5).standard_normal(200)
    substeps = np.array([1, 3])
    steps = [ramp_step(0.6, 0.2, 0.06), ramp_step(0.1, 0.05, 0.02)]
    found = np.empty(2)
    largest_swings(ground, substeps, np.array(steps), found)
    for n, step, swung in zip(substeps, steps, found, strict=True):
        assert swung == largest_swing(ground, n, step) > 0.0
