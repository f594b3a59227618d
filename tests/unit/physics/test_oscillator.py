"""The oscillator that rides on the track: exact for a constant acceleration in each step."""

import math

import numpy as np
import pytest

from railquake.physics.oscillator import oscillator_step, pseudo_velocity, swing


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
