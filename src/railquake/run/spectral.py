"""First period of a structure, and spectral ordinates of a motion."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.inputs.ground_motion import spectrum
from railquake.measures import housner
from railquake.physics.pier import natural_frequencies, stiffness_matrix

if TYPE_CHECKING:
    from railquake.inputs.ground_motion import GroundMotion
    from railquake.inputs.support import Pier

__all__ = ["DAMPING", "first_period", "spectral_acceleration", "spectral_intensity"]

DAMPING = 0.05
REMEMBERED = 64  # motions


def first_period(pier: Pier) -> float:
    """First natural period of a pier with its initial stiffness, without the train, s.

    Parameters
    ----------
    pier : Pier

    Returns
    -------
    float
        Eq. 10 with the hinge's initial stiffness.
    """
    mass = np.array([pier.mass, pier.base_rotational_inertia, pier.rotational_inertia])
    stiffness = stiffness_matrix(
        pier.youngs_modulus, pier.second_moment_of_area, pier.length, pier.bouc_wen.k0
    )
    return float(2.0 * math.pi / natural_frequencies(mass, stiffness)[0])


def spectral_acceleration(ground: GroundMotion, period: float) -> float:
    """Pseudo-spectral acceleration Sa(T) of a motion, 5 % damping, m/s2.

    Parameters
    ----------
    ground : GroundMotion
    period : float
        Natural period T, s, positive.

    Returns
    -------
    float
        What `response_spectrum` gives, to rounding; remembered for runs that share a motion.
    """
    return 2.0 * math.pi / period * _ordinate(ground.acceleration.tobytes(), ground.dt, period)


def spectral_intensity(ground: GroundMotion) -> float:
    """Housner's spectral intensity of a motion, m/s.

    Parameters
    ----------
    ground : GroundMotion

    Returns
    -------
    float
        What `ground_motion.spectral_intensity` gives, to rounding; remembered likewise.
    """
    return _intensity(ground.acceleration.tobytes(), ground.dt)


# The content of the motion is the key: what was run, not the file that it came from.


@lru_cache(maxsize=REMEMBERED)
def _ordinate(samples: bytes, dt: float, period: float) -> float:
    return _pseudo_velocity(np.frombuffer(samples), dt, period, DAMPING)


@lru_cache(maxsize=REMEMBERED)
def _intensity(samples: bytes, dt: float) -> float:
    ground = np.frombuffer(samples)
    found = [_pseudo_velocity(ground, dt, T, housner.DAMPING) for T in housner.PERIODS]
    return housner.spectral_intensity(found)


def _pseudo_velocity(
    ground: np.ndarray[Any, Any], dt: float, period: float, damping: float
) -> float:
    """Ordinate of the pseudo-velocity spectrum, m/s; ``ground`` in m/s2."""
    frequency = 2.0 * math.pi / period
    eigenvalue = spectrum._eigenvalue(frequency, damping)
    old, new = spectrum._load_weights(eigenvalue, dt)
    loads = np.zeros(ground.size, dtype=np.complex128)  # at rest at the first sample
    loads[1:] = -(old * ground[:-1] + new * ground[1:])
    state = recursion(np.exp(eigenvalue * dt), loads)
    largest = float(np.max(np.abs(state.imag)))
    substeps = min(math.ceil(spectrum.POINTS_PER_PERIOD * dt / period), spectrum.MAX_SUBSTEPS)
    for substep in range(1, substeps):  # between samples, where the load is linear too
        share = substep / substeps
        between = ground[:-1] + share * (ground[1:] - ground[:-1])
        old, new = spectrum._load_weights(eigenvalue, share * dt)
        grown = np.exp(eigenvalue * share * dt) * state[:-1]
        there = grown - old * ground[:-1] - new * between
        largest = max(largest, float(np.max(np.abs(there.imag))))
    return largest / math.sqrt(1.0 - damping**2)


def recursion(growth: complex, loads: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """States ``s[i] = growth s[i-1] + loads[i]``, from nothing before the first.

    By doubling: once each state holds the loads of ``span`` samples, it takes that of the state
    ``span`` before it.  No loop over samples, no library of matrices, whose threads get into each
    other's way where many rows are made at once, and no scipy.signal, whose import takes longer
    than many a run.

    Parameters
    ----------
    growth : complex
        Of size 1 at most.
    loads : array of complex, shape (n,)

    Returns
    -------
    array of complex, shape (n,)
    """
    states = loads.copy()
    span = 1
    while span < states.size:
        states[span:] += growth**span * states[:-span]
        span *= 2
    return states
