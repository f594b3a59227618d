"""Least squares of the Bouc-Wen hinge to a measured loop, and how well each parameter is known.

The law has more parameters than a loop can tell apart.  Fitted are thirteen numbers, each scaled
onto the interval from 0 to 1 between its bounds, in the logarithm where it is a matter of orders:

- the moment capacity ``k0 [beta0 (1 + eta0)]^(-1/n)`` in the place of ``beta0``, which depends on
  ``n`` so strongly that neither could be found;
- one share of ``rho_eps`` against ``rho_x``: multiplying all damage by a number and dividing
  ``phi``, ``delta_k`` and ``delta_f`` by it changes nothing, so the damage index at the loop's end
  is set to 1 (``rho_x`` is one minus the share; ``rho_eps`` counts the loop's own energy).

``Fy`` and ``xu`` only normalise; they are set to the largest moment and rotation of the loop.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from scipy.optimize import least_squares
from scipy.stats import qmc

from railquake.calibration.cyclic import Loop
from railquake.calibration.loop import drive_hinge
from railquake.calibration.misfit import LoopMisfit, dissipated, loop_misfit
from railquake.errors import InputError
from railquake.inputs.hinge import BoucWenHinge

__all__ = ["Fit", "FittedParameter", "Variable", "fit_hinge"]

Array = np.ndarray[Any, np.dtype[np.float64]]

STARTS = 6  # the guess and five others
SEED = 20230
FIRST_EVALUATIONS, LAST_EVALUATIONS = 25, 150
POLISHED = 2  # of the starts, the best
LEAST_FLEXIBILITY = 0.1  # of the hinge over that of the whole: for the guess
NEAR_BOUND = 1e-3  # of the scaled interval
SUBSTEPS_PER_PEAK = 200  # hinge steps over the largest rotation, at least
# A parameter is called undetermined where its standard error is this share of its whole range.
UNDETERMINED = 0.25
CORRELATED = 0.95
HOPELESS = 0.4  # misfit over the peak: the moment is hardly a hinge's


@dataclass(frozen=True)
class Variable:
    """One fitted number and its bounds.

    Attributes
    ----------
    name : str
    low, high : float
    scale : {"log", "linear"}
    unit : str
    """

    name: str
    low: float
    high: float
    scale: Literal["log", "linear"]
    unit: str = ""

    def value(self, scaled: float) -> float:
        """The number at a place of the interval from 0 to 1."""
        if self.scale == "log":
            return float(self.low * (self.high / self.low) ** scaled)
        return float(self.low + (self.high - self.low) * scaled)

    def scaled(self, value: float) -> float:
        """The place of a number in the interval; the nearest one where it is outside."""
        if self.scale == "log":
            place = np.log(max(value, 1e-300) / self.low) / np.log(self.high / self.low)
        else:
            place = (value - self.low) / (self.high - self.low)
        return float(np.clip(place, 0.0, 1.0))


@dataclass(frozen=True)
class FittedParameter:
    """What the fit found for one variable.

    Attributes
    ----------
    name, unit : str
    value, low, high : float
    scaled, scaled_error : float
        Place in the interval from 0 to 1 and its standard error there; infinite where the loop
        does not depend on it.
    interval : (float, float)
        Values at one standard error below and above, within the bounds.
    at_bound : {"", "low", "high"}
    determined : bool
        Whether the standard error is below a quarter of the whole range.
    """

    name: str
    unit: str
    value: float
    low: float
    high: float
    scaled: float
    scaled_error: float
    interval: tuple[float, float]
    at_bound: Literal["", "low", "high"]
    determined: bool


@dataclass(frozen=True)
class Fit:
    """A fitted hinge.

    Attributes
    ----------
    hinge : BoucWenHinge
    moment : array, shape (n,)
        Of the hinge along the loop's path, N m.
    misfit : LoopMisfit
    parameters : tuple of FittedParameter
    correlated : tuple of (str, str, float)
        Pairs whose correlation is above 0.95 in absolute value.
    starts : tuple of float
        Misfit (over the peak) that each start came to, the best first.
    evaluations : int
        Of the hinge along the loop.
    """

    hinge: BoucWenHinge
    moment: Array
    misfit: LoopMisfit
    parameters: tuple[FittedParameter, ...]
    correlated: tuple[tuple[str, str, float], ...]
    starts: tuple[float, ...]
    evaluations: int


def fit_hinge(
    loop: Loop,
    *,
    mass: float,
    starts: int = STARTS,
    seed: int = SEED,
    progress: Callable[[int, int], None] | None = None,
) -> Fit:
    """Fit the hinge to a loop.

    Parameters
    ----------
    loop : Loop
        Chord rotation and moment, with the flexibility of the elastic column between them.
    mass : float
        By which the hinge's energy is divided, kg; it is written into the hinge and changes
        nothing else.
    starts : int
        Local searches: one from a guess, the others from a seeded Latin hypercube.
    seed : int
    progress : callable, optional
        Called with the starts done and all starts.

    Returns
    -------
    Fit

    Raises
    ------
    InputError
        If no start leads anywhere.
    """
    task = _Task(loop, mass)
    rng = np.random.default_rng(seed)
    places = [task.guess()]
    if starts > 1:
        sampler = qmc.LatinHypercube(len(task.variables), rng=rng)
        # the inner part of the box: the law's extremes rarely lead anywhere
        others = 0.1 + 0.8 * sampler.random(starts - 1)
        # what the loop shows directly is not guessed at again
        others[:, :2] = np.clip(places[0][:2] + 0.2 * (others[:, :2] - 0.5), 0.02, 0.98)
        places += list(others)
    found: list[tuple[float, Array]] = []
    for k, place in enumerate(places):
        found.append(task.search(place, FIRST_EVALUATIONS))
        if progress is not None:
            progress(k + 1, len(places) + POLISHED)
    found.sort(key=lambda pair: pair[0])
    for k in range(min(POLISHED, len(found))):
        found[k] = task.search(found[k][1], LAST_EVALUATIONS)
        if progress is not None:
            progress(len(places) + k + 1, len(places) + POLISHED)
    found.sort(key=lambda pair: pair[0])
    cost, best = found[0]
    if not cost < HOPELESS:
        raise InputError(
            f"{loop.name}: no hinge follows this loop (misfit {cost:.0%} of the peak moment); "
            "look at its picture, its units and the column's stiffness"
        )
    return task.report(best, tuple(c for c, _ in found))


class _Task:
    """The loop, the variables and a count of evaluations."""

    def __init__(self, loop: Loop, mass: float) -> None:
        self.loop = loop
        self.mass = mass
        self.evaluations = 0
        self.peak_moment = float(np.abs(loop.moment).max())
        self.peak_rotation = float(np.abs(loop.hinge_rotation).max())
        self.energy = dissipated(loop.chord, loop.moment)
        # the hinge's stiffness on the first branch: what that leaves beside the column
        flexibility = 1.0 / loop.effective_stiffness - loop.flexibility
        self.k0 = 1.0 / max(flexibility, LEAST_FLEXIBILITY / loop.effective_stiffness)
        step = float(np.median(np.abs(np.diff(loop.chord, prepend=0.0))))
        self.substeps = max(1, int(np.ceil(step * SUBSTEPS_PER_PEAK / self.peak_rotation)))
        energy = self.energy / mass
        rotation = self.peak_rotation
        self.variables = (
            Variable("k0", 0.1 * self.k0, 100.0 * self.k0, "log", "N m/rad"),
            Variable("capacity", 0.3 * self.peak_moment, 3.0 * self.peak_moment, "log", "N m"),
            Variable("alpha", 1e-4, 0.5, "log"),
            Variable("n", 1.0, 8.0, "log"),
            Variable("eta0", -0.9, 1.0, "linear"),
            Variable("energy_share", 0.0, 1.0, "linear"),
            Variable("phi", 0.0, 4.0, "linear"),
            Variable("delta_k", 0.0, 30.0, "linear"),
            Variable("delta_f", 0.0, 2.0, "linear"),
            Variable("sigma", 0.02 * rotation, 2.0 * rotation, "log", "rad"),
            Variable("u", 0.5, 8.0, "log"),
            Variable("eps_p", 0.005 * energy, energy, "log", "J/kg"),
            Variable("rho_p", 0.0, 0.95, "linear"),
        )

    def guess(self) -> Array:
        """Where the first search starts."""
        values = {
            "k0": self.k0,
            "capacity": 0.95 * self.peak_moment,
            "alpha": 0.02,
            "n": 1.5,
            "eta0": 0.5,
            "energy_share": 0.3,
            "phi": 0.2,
            "delta_k": 0.5,
            "delta_f": 0.05,
            "sigma": 0.3 * self.peak_rotation,
            "u": 2.0,
            "eps_p": 0.05 * self.energy / self.mass,
            "rho_p": 0.2,
        }
        return np.array([variable.scaled(values[variable.name]) for variable in self.variables])

    def hinge(self, scaled: Array) -> BoucWenHinge:
        """The hinge at a place of the unit cube."""
        v = {
            variable.name: variable.value(float(place))
            for variable, place in zip(self.variables, scaled, strict=True)
        }
        yielded = v["capacity"] / v["k0"]
        return BoucWenHinge(
            Fy=self.peak_moment,
            xu=self.peak_rotation,
            alpha=v["alpha"],
            k0=v["k0"],
            n=v["n"],
            eta0=v["eta0"],
            beta0=yielded ** -v["n"] / (1.0 + v["eta0"]),
            rho_eps=v["energy_share"] * self.peak_moment * self.peak_rotation / self.energy,
            rho_x=1.0 - v["energy_share"],
            phi=v["phi"],
            delta_k=v["delta_k"],
            delta_f=v["delta_f"],
            sigma=v["sigma"],
            u=v["u"],
            eps_p=v["eps_p"],
            rho_p=v["rho_p"],
            m=self.mass,
        )

    def moment(self, scaled: Array) -> Array:
        self.evaluations += 1
        return drive_hinge(
            self.hinge(scaled), self.loop.chord, self.loop.flexibility, substeps=self.substeps
        )

    def residual(self, scaled: Array) -> Array:
        """Difference of the moments over the peak."""
        difference = (self.moment(scaled) - self.loop.moment) / self.peak_moment
        # where the law does not converge: worse than any loop
        lost: Array = np.nan_to_num(difference, nan=10.0, posinf=10.0, neginf=-10.0)
        return np.clip(lost, -10.0, 10.0)

    def search(self, start: Array, evaluations: int) -> tuple[float, Array]:
        """Local least squares; the misfit over the peak and its place."""
        inner = np.clip(start, 1e-6, 1.0 - 1e-6)
        result = least_squares(
            self.residual,
            inner,
            bounds=(0.0, 1.0),
            diff_step=1e-5,
            x_scale=1.0,
            max_nfev=evaluations,
            ftol=1e-7,
            xtol=1e-7,
        )
        return float(np.sqrt(2.0 * result.cost / len(self.loop.chord))), result.x

    def report(self, best: Array, starts: tuple[float, ...]) -> Fit:
        moment = self.moment(best)
        errors, correlation = self.uncertainty(best)
        parameters = []
        for variable, place, error in zip(self.variables, best, errors, strict=True):
            low, high = max(place - error, 0.0), min(place + error, 1.0)
            bound: Literal["", "low", "high"] = ""
            if place < NEAR_BOUND:
                bound = "low"
            elif place > 1.0 - NEAR_BOUND:
                bound = "high"
            parameters.append(
                FittedParameter(
                    name=variable.name,
                    unit=variable.unit,
                    value=variable.value(float(place)),
                    low=variable.low,
                    high=variable.high,
                    scaled=float(place),
                    scaled_error=float(error),
                    interval=(variable.value(float(low)), variable.value(float(high))),
                    at_bound=bound,
                    determined=bool(error < UNDETERMINED),
                )
            )
        names = [variable.name for variable in self.variables]
        pairs = tuple(
            (names[i], names[j], float(correlation[i, j]))
            for i in range(len(names))
            for j in range(i)
            if abs(correlation[i, j]) > CORRELATED
        )
        return Fit(
            hinge=self.hinge(best),
            moment=moment,
            misfit=loop_misfit(self.loop.chord, self.loop.moment, moment),
            parameters=tuple(parameters),
            correlated=pairs,
            starts=starts,
            evaluations=self.evaluations,
        )

    def uncertainty(self, best: Array) -> tuple[Array, Array]:
        """Standard errors in the scaled variables and their correlations.

        From the Jacobian J, s^2 (J' J)^-1.  Neighbouring residuals of a loop are alike, so that the
        n of them count as n / T, with T the integral of their correlation over the distance (up to
        its first zero); less the number of parameters, but as one at least.
        """
        residual = self.residual(best)
        count = len(best)
        step = 1e-4
        jacobian = np.empty((len(residual), count))
        for k in range(count):
            up, down = best.copy(), best.copy()
            up[k], down[k] = min(best[k] + step, 1.0), max(best[k] - step, 0.0)
            jacobian[:, k] = (self.residual(up) - self.residual(down)) / (up[k] - down[k])
        square = float(residual @ residual)
        independent = len(residual) / _correlation_length(residual)
        variance = square / max(independent - count, 1.0)
        values, vectors = np.linalg.eigh(jacobian.T @ jacobian)
        # directions in which the loop does not change at all
        floor = 1e-12 * max(float(values[-1]), 1e-300)
        spread = variance / np.maximum(values, floor)
        covariance = (vectors * spread) @ vectors.T
        errors = np.sqrt(np.maximum(np.diag(covariance), 0.0))
        safe = np.where(errors > 0.0, errors, 1.0)
        return errors, covariance / np.outer(safe, safe)


def _correlation_length(residual: Array) -> float:
    """1 + 2 sum of the correlations of samples k apart, up to the first that is not positive."""
    size = len(residual)
    spectrum = np.fft.rfft(residual, 2 * size)
    correlation = np.fft.irfft(np.abs(spectrum) ** 2)[:size]
    if not correlation[0] > 0.0:
        return 1.0
    correlation = correlation / correlation[0]
    negative = np.flatnonzero(correlation <= 0.0)
    end = int(negative[0]) if len(negative) else size
    return float(1.0 + 2.0 * correlation[1:end].sum())
