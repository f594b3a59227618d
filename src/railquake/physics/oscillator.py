r"""A linear oscillator on a support whose velocity is known step by step.

With lambda = w (-zeta + i sqrt(1 - zeta^2)) the complex state s = u' - conj(lambda) u turns
u'' + 2 zeta w u' + w^2 u = -a into s' = lambda s - a, and for a constant acceleration during a
step h, which changes the support's velocity by dv = a h ::

    s(n+1) = e^(lambda h) s(n) - (e^(lambda h) - 1)/(lambda h) dv

The displacement relative to the support is u = Im s/(w sqrt(1 - zeta^2)).

Source: Nigam and Jennings (1969), Bulletin of the Seismological Society of America 59(2), 909-922,
in one complex number instead of a 2 x 2 matrix.
"""

import cmath
import math
from typing import NamedTuple

__all__ = ["Step", "oscillator_step", "pseudo_velocity", "swing"]


class Step(NamedTuple):
    """What a step of an oscillator takes: growth e^z and weight (e^z - 1)/z, z = lambda h."""

    growth_re: float
    growth_im: float
    weight_re: float
    weight_im: float


def swing(re: float, im: float, push: float, by: Step) -> tuple[float, float]:
    """State s after a step, m/s, of an oscillator whose support's velocity changes by ``push``."""
    return (
        by.growth_re * re - by.growth_im * im - by.weight_re * push,
        by.growth_re * im + by.growth_im * re - by.weight_im * push,
    )


def oscillator_step(period: float, damping_ratio: float, step: float) -> Step:
    """Growth and weight of a step.

    Parameters
    ----------
    period : float
        Undamped, s.
    damping_ratio : float
        Below 1.
    step : float
        s.
    """
    frequency = 2.0 * math.pi / period
    z = step * frequency * complex(-damping_ratio, math.sqrt(1.0 - damping_ratio**2))
    growth = cmath.exp(z)
    weight = (growth - 1.0) / z
    return Step(growth.real, growth.imag, weight.real, weight.imag)


def pseudo_velocity(im: float, damping_ratio: float) -> float:
    """Pseudo-velocity w max|u|, m/s, from the largest imaginary part of the state."""
    return im / math.sqrt(1.0 - damping_ratio**2)
