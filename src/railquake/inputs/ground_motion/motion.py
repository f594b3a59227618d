"""A ground motion: evenly sampled ground acceleration and what is measured on it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railquake.errors import InputError
from railquake.measures import STANDARD_GRAVITY as STANDARD_GRAVITY

"""Standard gravity, m/s2: the only meaning of the unit "g" in this package."""

MAX_SAMPLES = 50_000_000
"""More samples than this (0.4 GB) are taken for a slip of the pen, not for a record."""


DOUBTS = ("unit ", "the unit ", "the header gives a peak", "the agency flags")
"""How the notes begin that `GroundMotion.doubts` passes on."""


@dataclass(frozen=True, eq=False)
class GroundMotion:
    """One component of ground acceleration at a constant time step.

    Parameters
    ----------
    name : str
        Short name for tables and figures.
    dt : float
        Time step, s.
    acceleration : array_like, shape (n,)
        Ground acceleration, m/s2, n >= 2.  It is copied, and the copy is read-only.
    source : str
        Path of the file, or how the motion was made.
    notes : tuple of str
        What was done to the numbers on the way in, one remark each.

    Raises
    ------
    InputError
        If `dt` is not positive and finite, or the acceleration is not a one-dimensional array of
        at least two finite numbers.
    """

    name: str
    dt: float
    acceleration: NDArray[np.float64]
    source: str = ""
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "dt", _positive(self.dt, f"motion '{self.name}': dt", "s"))
        object.__setattr__(self, "acceleration", _read_only(self.name, self.acceleration))
        object.__setattr__(self, "notes", tuple(self.notes))

    @property
    def npts(self) -> int:
        """Number of samples."""
        return int(self.acceleration.size)

    @property
    def duration(self) -> float:
        """Time from the first sample to the last, s."""
        return (self.npts - 1) * self.dt

    @property
    def time(self) -> NDArray[np.float64]:
        """Time of each sample from the first one, s, shape (n,)."""
        return np.arange(self.npts, dtype=np.float64) * self.dt

    @cached_property
    def pga(self) -> float:
        """Peak ground acceleration (absolute value), m/s2."""
        return float(np.max(np.abs(self.acceleration)))

    @cached_property
    def pgv(self) -> float:
        """Peak ground velocity (absolute value), m/s.

        Acceleration integrated by the trapezoid rule, with the least-squares straight line
        removed from the velocity.
        """
        return float(np.max(np.abs(without_line(self.velocity()))))

    @cached_property
    def arias_intensity(self) -> float:
        """Arias intensity, m/s: pi / (2 g) times the integral of a^2 dt (trapezoid rule).

        Arias, A. (1970), "A measure of earthquake intensity", in Seismic Design for Nuclear
        Power Plants, MIT Press.
        """
        integral = float(np.trapezoid(self.acceleration**2, dx=self.dt))
        return np.pi / (2.0 * STANDARD_GRAVITY) * integral

    def velocity(self) -> NDArray[np.float64]:
        """Ground velocity from rest by the trapezoid rule, uncorrected, m/s, shape (n,)."""
        return cumulative_trapezoid(self.acceleration, self.dt)

    def displacement(self) -> NDArray[np.float64]:
        """Ground displacement, the velocity integrated once more, uncorrected, m, shape (n,)."""
        return cumulative_trapezoid(self.velocity(), self.dt)

    def significant_duration(self, start: float = 0.05, end: float = 0.95) -> float:
        """Time between two fractions of the Arias intensity, s (0 for a motion of zeros)."""
        if not 0.0 <= start < end <= 1.0:
            raise InputError(
                f"significant duration: 0 <= start < end <= 1 is needed, found {start}, {end}"
            )
        growth = cumulative_trapezoid(self.acceleration**2, self.dt)
        if growth[-1] == 0.0:
            return 0.0
        first, last = np.searchsorted(growth, [start * growth[-1], end * growth[-1]])
        return float(last - first) * self.dt

    def scaled(self, factor: float) -> GroundMotion:
        """The same motion with every sample multiplied by a positive factor."""
        factor = _positive(factor, f"motion '{self.name}': scale factor", "")
        if factor == 1.0:
            return self
        return replace(
            self,
            acceleration=self.acceleration * factor,
            notes=(*self.notes, f"scaled by {factor:g}"),
        )

    def mirrored(self) -> GroundMotion:
        """The same motion towards the other side (every sample negated)."""
        return replace(
            self, acceleration=-self.acceleration, notes=(*self.notes, "mirrored (sign changed)")
        )

    def resampled(self, dt: float) -> GroundMotion:
        """The motion at another time step, by linear interpolation between the samples.

        The first sample stays at time zero; the last one is the last multiple of `dt` within the
        record.  A longer step does not filter: what lies above its Nyquist frequency is aliased,
        and the loss of PGA is noted.
        """
        dt = _positive(dt, f"motion '{self.name}': new dt", "s")
        if dt == self.dt:
            return self
        ratio = self.duration / dt
        if ratio > MAX_SAMPLES:
            raise InputError(
                f"motion '{self.name}': dt = {dt:g} s would make over {MAX_SAMPLES} samples; "
                "choose a longer time step"
            )
        count = int(np.floor(ratio * (1.0 + 1e-12) + 1e-9)) + 1
        if count < 2:
            raise InputError(
                f"motion '{self.name}': dt = {dt:g} s is longer than the record "
                f"({self.duration:g} s); choose a shorter time step"
            )
        new = np.interp(np.arange(count) * dt, self.time, self.acceleration)
        remark = f"resampled from dt = {self.dt:g} s to {dt:g} s (linear)"
        peak = float(np.max(np.abs(new)))
        if self.pga > 0.0 and peak < 0.999 * self.pga:
            remark += f", PGA lowered by {100.0 * (1.0 - peak / self.pga):.1f} %"
        return replace(self, dt=dt, acceleration=new, notes=(*self.notes, remark))

    def doubts(self) -> tuple[str, ...]:
        """The notes that tell of something to look into, before the record is trusted.

        A unit taken from a column's name, a peak that is not the header's, an agency's flag.
        """
        return tuple(note for note in self.notes if note.startswith(DOUBTS))

    def baseline_check(self) -> tuple[str, ...]:
        """Warnings about a drifting baseline; empty when there is nothing to say.

        Velocity and displacement are integrated from rest.  A warning is given when the mean
        velocity over the last tenth of the record exceeds a fifth of the largest velocity *and*
        1 cm/s, or the displacement at the end exceeds twice the largest displacement left once
        its least-squares parabola is removed *and* 5 cm.  (Near-fault records do end with a real
        permanent displacement, of the order of the displacement peak: hence "twice".)  The
        simulator itself integrates no ground displacement; a drift tells that the
        long-period content cannot be trusted.
        """
        warnings: list[str] = []
        velocity = self.velocity()
        displacement = cumulative_trapezoid(velocity, self.dt)
        tail = velocity[-max(2, self.npts // 10) :]
        residual = float(np.mean(tail))
        if abs(residual) > max(0.01, 0.2 * float(np.max(np.abs(velocity)))):
            warnings.append(
                f"velocity does not return to zero: {residual:.3g} m/s at the end "
                f"(PGV {self.pgv:.3g} m/s); correct the baseline"
            )
        final = float(displacement[-1])
        wobble = float(np.max(np.abs(_without_polynomial(displacement, 2))))
        if abs(final) > max(0.05, 2.0 * wobble):
            warnings.append(
                f"displacement drifts to {final:.3g} m at the end; correct the baseline or cut "
                "the record where its velocity is zero"
            )
        return tuple(warnings)


def cumulative_trapezoid(values: NDArray[np.float64], dt: float) -> NDArray[np.float64]:
    """Running integral by the trapezoid rule, starting from zero, same shape as `values`."""
    result = np.zeros_like(values)
    np.cumsum((values[1:] + values[:-1]) * (0.5 * dt), out=result[1:])
    return result


def without_line(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """`values` minus their least-squares straight line."""
    # Centred and scaled to [-1, 1], so that the slope and the mean decouple.
    place = np.linspace(-1.0, 1.0, values.size)
    slope = float(place @ values) / float(place @ place)
    return np.asarray(values - values.mean() - slope * place)


def _without_polynomial(values: NDArray[np.float64], degree: int) -> NDArray[np.float64]:
    """`values` minus their least-squares polynomial."""
    if values.size <= degree:
        return np.zeros_like(values)
    place = np.linspace(-1.0, 1.0, values.size)
    fit = np.polynomial.legendre.legfit(place, values, degree)
    return np.asarray(values - np.polynomial.legendre.legval(place, fit))


def _positive(value: float, what: str, unit: str) -> float:
    """A finite number over zero, or an `InputError` that names it."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{what}: a number is needed, found {value!r}") from None
    if not (np.isfinite(number) and number > 0.0):
        raise InputError(
            f"{what}: a finite number over zero is needed, found {number:g} {unit}".rstrip()
        )
    return number


def _read_only(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """A checked, read-only copy of the samples."""
    try:
        array = np.array(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"motion '{name}': the acceleration is not an array of numbers") from None
    if array.ndim != 1 or array.size < 2:
        raise InputError(
            f"motion '{name}': at least two samples in one dimension are needed, "
            f"found shape {array.shape}"
        )
    wrong = np.flatnonzero(~np.isfinite(array))
    if wrong.size:
        raise InputError(
            f"motion '{name}': sample {int(wrong[0]) + 1} is not a finite number; "
            "repair or cut the record"
        )
    array.setflags(write=False)
    return array
