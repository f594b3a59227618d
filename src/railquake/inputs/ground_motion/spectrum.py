"""Elastic response spectra, exact for a ground acceleration that is linear between samples."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railquake.errors import InputError
from railquake.inputs.ground_motion.motion import GroundMotion
from railquake.measures import housner

POINTS_PER_PERIOD = 40
"""Peaks are looked for at least this often in each period (0.3 % below the true peak at most)."""
MAX_SUBSTEPS = 200
"""Below a 200th of the step times `POINTS_PER_PERIOD`, a period is followed this finely only."""


@dataclass(frozen=True, eq=False)
class ResponseSpectrum:
    """Peak responses of linear oscillators, all arrays of shape (n,) and read-only.

    Parameters
    ----------
    periods : ndarray
        Undamped periods T, s.
    damping_ratio : float
        Fraction of critical damping.
    sd : ndarray
        Peak relative displacement, m.
    psv : ndarray
        Pseudo-velocity, (2 pi / T) sd, m/s.
    psa : ndarray
        Pseudo-acceleration, (2 pi / T)^2 sd, m/s2.
    sv : ndarray
        Peak relative velocity, m/s.
    sa : ndarray
        Peak absolute acceleration of the mass, m/s2.
    """

    periods: NDArray[np.float64]
    damping_ratio: float
    sd: NDArray[np.float64]
    psv: NDArray[np.float64]
    psa: NDArray[np.float64]
    sv: NDArray[np.float64]
    sa: NDArray[np.float64]

    def __post_init__(self) -> None:
        for name in ("periods", "sd", "psv", "psa", "sv", "sa"):
            getattr(self, name).setflags(write=False)


def response_spectrum(
    motion: GroundMotion, periods: ArrayLike, damping_ratio: float = 0.05
) -> ResponseSpectrum:
    """Response spectrum of a motion, each oscillator at rest at the first sample.

    Parameters
    ----------
    motion : GroundMotion
        The ground motion; nothing is added behind its end.
    periods : array_like, shape (n,)
        Undamped periods, s; zero stands for the rigid oscillator (sa = psa = PGA).
    damping_ratio : float
        Fraction of critical damping, 0 <= damping_ratio < 1.

    Raises
    ------
    InputError
        If a period is negative or not finite, or the damping ratio outside its range.
    """
    wanted = np.atleast_1d(np.array(periods, dtype=np.float64))
    if wanted.ndim != 1 or wanted.size == 0 or not np.all(np.isfinite(wanted) & (wanted >= 0.0)):
        raise InputError("response spectrum: periods must be finite numbers of seconds, 0 or more")
    if not 0.0 <= damping_ratio < 1.0:
        raise InputError(
            f"response spectrum: the damping ratio must be from 0 to below 1, found {damping_ratio}"
        )
    sd, sv, sa = (np.zeros_like(wanted) for _ in range(3))
    frequency = np.zeros_like(wanted)
    for place, period in enumerate(wanted):
        if period == 0.0:
            sa[place] = motion.pga
            continue
        frequency[place] = 2.0 * np.pi / period
        sd[place], sv[place], sa[place] = _peaks(
            motion, frequency[place], damping_ratio, substeps(motion.dt, float(period))
        )
    psa = frequency**2 * sd
    psa[wanted == 0.0] = motion.pga
    return ResponseSpectrum(wanted, float(damping_ratio), sd, frequency * sd, psa, sv, sa)


def spectral_intensity(motion: GroundMotion) -> float:
    """Housner's spectral intensity SI, 20 % damping, 0.1 to 2.5 s, m/s; see `measures.housner`."""
    spectrum = response_spectrum(motion, housner.PERIODS, housner.DAMPING)
    return housner.spectral_intensity(spectrum.psv.tolist())


def substeps(dt: float, period: float) -> int:
    """Steps from one sample to the next in which peaks are looked for; both in s."""
    wanted = int(np.ceil(POINTS_PER_PERIOD * dt / period))
    return min(max(wanted, 1), MAX_SUBSTEPS)


def oscillator_response(
    motion: GroundMotion, period: float, damping_ratio: float = 0.05
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Relative displacement, m, and velocity, m/s, of one oscillator at the motion's samples."""
    frequency = 2.0 * np.pi / period
    state = _states(motion, _eigenvalue(frequency, damping_ratio))
    return _displacement_velocity(state, frequency, damping_ratio)


def _eigenvalue(frequency: float, damping_ratio: float) -> complex:
    return frequency * complex(-damping_ratio, np.sqrt(1.0 - damping_ratio**2))


def _states(motion: GroundMotion, eigenvalue: complex) -> NDArray[np.complex128]:
    r"""Complex state of the oscillator at each sample.

    With :math:`\lambda = -\xi\omega + i\omega_d`, the state :math:`s = \dot u - \bar\lambda u`
    turns :math:`\ddot u + 2\xi\omega\dot u + \omega^2 u = -a_g` into
    :math:`\dot s = \lambda s - a_g`, and for :math:`a_g` linear over a step h

    .. math:: s_{i+1} = e^{\lambda h} s_i
              - h\,[(\varphi_1 - \varphi_2)\,a_i + \varphi_2\,a_{i+1}],
              \qquad \varphi_1 = \frac{e^z - 1}{z},\quad
              \varphi_2 = \frac{e^z - 1 - z}{z^2},\quad z = \lambda h.

    This is the recursion of Nigam & Jennings (1969), "Calculation of response spectra from
    strong-motion earthquake records", Bull. Seism. Soc. Am. 59(2), 909-922, in one complex number
    instead of a 2 x 2 matrix.
    """
    from scipy.signal import lfilter  # imported late: it takes long, and most runs need no spectra

    old, new = _load_weights(eigenvalue, motion.dt)
    load = -motion.acceleration
    growth = np.exp(eigenvalue * motion.dt)
    # The initial condition of the filter cancels the first load: at rest at the first sample.
    state, _ = lfilter([new, old], [1.0, -growth], load, zi=np.array([-new * load[0]]))
    return np.asarray(state, dtype=np.complex128)


def _load_weights(eigenvalue: complex, step: float) -> tuple[complex, complex]:
    """Weights of the load at the start and at the end of a step."""
    z = eigenvalue * step
    if abs(z) < 0.1:
        # Series: the closed forms lose digits as z tends to zero.
        phi1 = phi2 = 0.0j
        term1, term2 = 1.0 + 0.0j, 0.5 + 0.0j
        for order in range(1, 12):
            phi1, phi2 = phi1 + term1, phi2 + term2
            term1, term2 = term1 * z / (order + 1), term2 * z / (order + 2)
    else:
        phi1 = (np.exp(z) - 1.0) / z
        phi2 = (phi1 - 1.0) / z
    return step * (phi1 - phi2), step * phi2


def _displacement_velocity(
    state: NDArray[np.complex128], frequency: float, damping_ratio: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    displacement = state.imag / (frequency * np.sqrt(1.0 - damping_ratio**2))
    velocity = state.real - damping_ratio * frequency * displacement
    return displacement, velocity


def _peaks(
    motion: GroundMotion, frequency: float, damping_ratio: float, substeps: int
) -> tuple[float, float, float]:
    """Peak relative displacement, relative velocity and absolute acceleration."""
    eigenvalue = _eigenvalue(frequency, damping_ratio)
    state = _states(motion, eigenvalue)
    ground = motion.acceleration
    peaks = np.zeros(3)

    def look(at: NDArray[np.complex128]) -> None:
        displacement, velocity = _displacement_velocity(at, frequency, damping_ratio)
        # From the equation of motion: u'' + a_g = -(2 xi w u' + w^2 u).
        absolute = 2.0 * damping_ratio * frequency * velocity + frequency**2 * displacement
        found = [float(np.max(np.abs(values))) for values in (displacement, velocity, absolute)]
        np.maximum(peaks, found, out=peaks)

    look(state)
    for substep in range(1, substeps):
        # Between samples, exactly: the load is linear there too.
        step = motion.dt * substep / substeps
        there = ground[:-1] + (ground[1:] - ground[:-1]) * (substep / substeps)
        old, new = _load_weights(eigenvalue, step)
        look(np.exp(eigenvalue * step) * state[:-1] - old * ground[:-1] - new * there)
    return float(peaks[0]), float(peaks[1]), float(peaks[2])
