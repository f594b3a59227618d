"""Instrumental intensity of the Japan Meteorological Agency (JMA).

The components are filtered by their Fourier transforms and taken together as a vector; ``a`` is the
size that the vector reaches or exceeds for 0.3 s in all, and I = 2 log10(a) + 0.94, a in gal.

Source: JMA, "How instrumental seismic intensity is calculated" (in Japanese, with the record of
Yonago of 2000-10-06 worked out), after JMA's notice no. 4 of 1996.  JMA rounds I to two decimals
and cuts off the second: its intensity 5.1 is 5.10 to 5.19 here.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from railquake.errors import InputError
from railquake.inputs.ground_motion.motion import GroundMotion

__all__ = ["jma_acceleration", "jma_intensity"]

EXCEEDED_TIME = 0.3  # s
GAL = 0.01  # m/s2


def jma_intensity(*components: GroundMotion) -> float | None:
    """Instrumental intensity of a ground motion.

    Parameters
    ----------
    components : GroundMotion
        As in `jma_acceleration`; JMA takes all three.  Fewer give less: one horizontal component
        of JMA's own example alone 0.17 or 0.22.

    Returns
    -------
    float or None
        None for a ground that is at rest, or shakes for less than 0.3 s.
    """
    acceleration = jma_acceleration(*components)
    return 2.0 * math.log10(acceleration / GAL) + 0.94 if acceleration > 0.0 else None


def jma_acceleration(*components: GroundMotion) -> float:
    """Size of the filtered acceleration that is reached or exceeded for 0.3 s in all, m/s2.

    Parameters
    ----------
    components : GroundMotion
        Up to three at right angles that begin together, in any order; shorter ones are followed
        by rest, other time steps are brought to that of the first.

    Raises
    ------
    InputError
        If there is no component, or more than three.
    """
    if not 1 <= len(components) <= 3:
        raise InputError(f"JMA's intensity takes one to three components, found {len(components)}")
    dt = components[0].dt
    sampled = [one.resampled(dt).acceleration for one in components]
    count = max(len(values) for values in sampled)
    weights = _weights(count, dt)
    filtered = [np.fft.irfft(np.fft.rfft(v, count) * weights, count) for v in sampled]
    falling = np.sort(np.sqrt(np.sum(np.square(filtered), axis=0)))[::-1]
    # the n-th largest sample is reached or exceeded during n steps
    time = dt * np.arange(1, count + 1)
    return float(np.interp(EXCEEDED_TIME, time, falling, right=0.0))


@lru_cache(maxsize=8)
def _weights(count: int, dt: float) -> NDArray[np.float64]:
    """`filter_weights` of a transform: motions of one study are mostly as long as each other."""
    weights = filter_weights(np.fft.rfftfreq(count, dt).astype(np.float64))
    weights.setflags(write=False)
    return weights


def filter_weights(frequencies: NDArray[np.float64]) -> NDArray[np.float64]:
    """JMA's filter: that of the period's influence, the high-cut and the low-cut one together.

    Parameters
    ----------
    frequencies : ndarray
        Hz, 0 or more.
    """
    weights = np.zeros_like(frequencies)
    moving = frequencies > 0.0  # the mean is taken out
    f = frequencies[moving]
    x2 = (f / 10.0) ** 2
    high_cut = (0.000155, 0.00134, 0.009664, 0.0557, 0.241, 0.694, 1.0)  # from x^12 down to 1
    low_cut = 1.0 - np.exp(-((f / 0.5) ** 3))
    weights[moving] = np.sqrt(low_cut / f / np.polyval(high_cut, x2))
    return weights
