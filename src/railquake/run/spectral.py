"""First period of a structure, and spectral ordinates of a motion."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.inputs.ground_motion import spectrum
from railquake.march.compiler import SCALAR, bind
from railquake.measures import housner
from railquake.physics.oscillator import RampStep, largest_swings, pseudo_velocity
from railquake.physics.pier import natural_frequencies, stiffness_matrix

if TYPE_CHECKING:
    from railquake.inputs.ground_motion import GroundMotion
    from railquake.inputs.support import Pier

__all__ = ["DAMPING", "first_period", "spectral_acceleration", "spectral_intensity"]

Array = np.ndarray[Any, Any]

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
    return _pseudo_velocities(samples, dt, (period,), DAMPING)[0]


@lru_cache(maxsize=REMEMBERED)
def _intensity(samples: bytes, dt: float) -> float:
    return housner.spectral_intensity(
        _pseudo_velocities(samples, dt, housner.PERIODS, housner.DAMPING)
    )


def _pseudo_velocities(
    samples: bytes, dt: float, periods: tuple[float, ...], damping: float
) -> list[float]:
    """Ordinates of the pseudo-velocity spectrum, m/s; ``samples`` of float, in m/s2.

    The oscillators are followed by compiled code, and not by a filter of scipy.signal, whose
    import takes longer than many a run.
    """
    substeps, steps = _steps(dt, periods, damping)
    largest = np.empty(len(periods))
    bind(largest_swings, SCALAR).call(np.frombuffer(samples), substeps, steps, largest)
    return [pseudo_velocity(im, damping) for im in largest.tolist()]


@lru_cache(maxsize=REMEMBERED)
def _steps(dt: float, periods: tuple[float, ...], damping: float) -> tuple[Array, Array]:
    """Steps from one sample to the next, and what each takes: the same for many motions."""
    substeps = np.empty(len(periods), dtype=np.int64)
    steps = np.empty((len(periods), len(RampStep._fields)))
    for m, period in enumerate(periods):
        substeps[m] = spectrum.substeps(dt, period)
        h = dt / substeps[m]
        eigenvalue = spectrum._eigenvalue(2.0 * math.pi / period, damping)
        parts = np.array([np.exp(eigenvalue * h), *spectrum._load_weights(eigenvalue, h)])
        steps[m] = RampStep(*np.column_stack((parts.real, parts.imag)).ravel())
    return substeps, steps
