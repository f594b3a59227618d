r"""A linear oscillator on a support whose motion is known step by step.

With lambda = w (-zeta + i sqrt(1 - zeta^2)) the complex state s = u' - conj(lambda) u turns
u'' + 2 zeta w u' + w^2 u = -a into s' = lambda s - a, and for a constant acceleration during a
step h, which changes the support's velocity by dv = a h ::

    s(n+1) = e^(lambda h) s(n) - (e^(lambda h) - 1)/(lambda h) dv

and for one that changes linearly from a(n) to a(n+1), z = lambda h ::

    s(n+1) = e^z s(n) - h [(phi1 - phi2) a(n) + phi2 a(n+1)]
    phi1 = (e^z - 1)/z,  phi2 = (e^z - 1 - z)/z^2

The displacement relative to the support is u = Im s/(w sqrt(1 - zeta^2)).

Source: Nigam and Jennings (1969), Bulletin of the Seismological Society of America 59(2), 909-922,
in one complex number instead of a 2 x 2 matrix.
"""

import cmath
import math
from typing import Any, NamedTuple

import numpy as np

__all__ = [
    "RampStep",
    "Step",
    "largest_swing",
    "largest_swings",
    "oscillator_step",
    "pseudo_velocity",
    "swing",
    "swing_on_ramp",
]

Array = np.ndarray[Any, Any]


class Step(NamedTuple):
    """What a step of an oscillator takes: growth e^z and weight (e^z - 1)/z, z = lambda h."""

    growth_re: float
    growth_im: float
    weight_re: float
    weight_im: float


class RampStep(NamedTuple):
    """What a step under an acceleration takes that is linear in it: growth, and weights in s."""

    growth_re: float
    growth_im: float
    start_re: float
    start_im: float
    end_re: float
    end_im: float


def swing(re: float, im: float, push: float, by: Step) -> tuple[float, float]:
    """State s after a step, m/s, of an oscillator whose support's velocity changes by ``push``."""
    return (
        by.growth_re * re - by.growth_im * im - by.weight_re * push,
        by.growth_re * im + by.growth_im * re - by.weight_im * push,
    )


def swing_on_ramp(
    re: float, im: float, start: float, end: float, by: RampStep
) -> tuple[float, float]:
    """State s after a step, m/s, under an acceleration from ``start`` to ``end``, m/s2."""
    at_start = Step(by.growth_re, by.growth_im, by.start_re, by.start_im)
    moved_re, moved_im = swing(re, im, start, at_start)
    return moved_re - by.end_re * end, moved_im - by.end_im * end


def largest_swing(ground: Array, substeps: int, by: RampStep) -> float:
    """Largest imaginary part of the state under a ground motion, from rest, m/s.

    Parameters
    ----------
    ground : array, shape (n,)
        Acceleration, linear between its samples, m/s2.
    substeps : int
        Equal steps from one sample to the next.
    by : RampStep
        Of such a step.
    """
    re = im = largest = 0.0
    for n in range(len(ground) - 1):
        change = (ground[n + 1] - ground[n]) / substeps
        for k in range(substeps):
            start = ground[n] + k * change
            re, im = swing_on_ramp(re, im, start, start + change, by)
            largest = max(largest, abs(im))
    return largest


def largest_swings(ground: Array, substeps: Array, by: Array, largest: Array) -> None:
    """Fill ``largest`` with `largest_swing` of many oscillators, shape (m,).

    Parameters
    ----------
    ground : array, shape (n,)
    substeps : array of int, shape (m,)
    by : array, shape (m, 6)
        Fields of each one's `RampStep`.
    largest : array, shape (m,)
    """
    for m in range(len(substeps)):
        step = RampStep(by[m, 0], by[m, 1], by[m, 2], by[m, 3], by[m, 4], by[m, 5])
        largest[m] = largest_swing(ground, substeps[m], step)


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
