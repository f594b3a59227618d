"""Response spectra of suites and of single motions."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railquake.errors import InputError
from railquake.inputs.ground_motion import GroundMotion, response_spectrum
from railquake.suite.model import Suite

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario

__all__ = ["SuiteSpectra", "log_mean", "log_scatter", "spectral_acceleration", "suite_spectra"]

Array = NDArray[np.float64]

PERIODS = np.geomspace(0.02, 5.0, 60)
"""Periods of a suite's spectra where none are asked for, s."""


class SuiteSpectra(TypedDict):
    """Spectra of a suite: pseudo-acceleration in m/s2, 5 % damping unless asked otherwise."""

    names: tuple[str, ...]
    periods: Array
    spectra: Array
    mean: Array
    scatter: Array


def suite_spectra(
    suite: Suite, periods: ArrayLike | None = None, damping_ratio: float = 0.05
) -> SuiteSpectra:
    """Response spectra of all motions of a suite, scaled by their factors.

    Parameters
    ----------
    suite : Suite
        Its records are read.
    periods : array_like, shape (m,), optional
        Periods, s; 60 from 0.02 to 5 s by default.
    damping_ratio : float
        Fraction of critical damping.

    Returns
    -------
    dict
        names : tuple of str, of length n; periods : shape (m,), s; spectra : shape (n, m),
        pseudo-acceleration, m/s2; mean : shape (m,), their geometric mean; scatter : shape (m,),
        the standard deviation of their natural logarithms (zeros for a single motion).

    Raises
    ------
    InputError
        If a record cannot be read or is zero throughout, or a period is negative.
    """
    wanted = np.atleast_1d(np.array(PERIODS if periods is None else periods, dtype=np.float64))
    rows = []
    for member in suite.members:
        motion = member.ground_motion()
        if motion.pga == 0.0:
            raise InputError(f"motion {member.name}: is zero throughout; leave it out of the suite")
        rows.append(response_spectrum(motion, wanted, damping_ratio).psa)
    spectra = np.array(rows)
    return {
        "names": tuple(member.name for member in suite.members),
        "periods": wanted,
        "spectra": spectra,
        "mean": log_mean(spectra),
        "scatter": log_scatter(spectra),
    }


def log_mean(spectra: Array) -> Array:
    """Geometric mean over the first axis."""
    return np.asarray(np.exp(np.mean(np.log(spectra), axis=0)))


def log_scatter(spectra: Array) -> Array:
    """Standard deviation of the natural logarithms over the first axis (n - 1)."""
    if len(spectra) < 2:
        return np.zeros(spectra.shape[1:])
    return np.asarray(np.std(np.log(spectra), axis=0, ddof=1))


def spectral_acceleration(
    motion: GroundMotion | Scenario, period: float, damping_ratio: float = 0.05
) -> float:
    """Pseudo-spectral acceleration Sa(T) of a motion, m/s2.

    Parameters
    ----------
    motion : GroundMotion or Scenario
        Of a scenario its lateral motion as it is scaled there.
    period : float
        Natural period T, s; zero gives the PGA.
    damping_ratio : float
        Fraction of critical damping.

    Raises
    ------
    InputError
        If the period or the damping ratio is out of range, or a record cannot be read.
    """
    ground = motion if isinstance(motion, GroundMotion) else motion.ground_motion()
    return float(response_spectrum(ground, [period], damping_ratio).psa[0])
