r"""Fragility: how likely an outcome is, given a measure of the shaking or of the response.

The lognormal curve :math:`P(x) = \Phi(\ln(x / \theta) / \beta)` by maximum likelihood on runs that
either reached the outcome or did not (Baker 2015, "Efficient analytical fragility function fitting
using dynamic structural analysis", Earthquake Spectra 31(1), 579-599).  It is a probit regression
on :math:`\ln x`: :math:`\Phi(a + b \ln x)` with :math:`\beta = 1/b, \theta = e^{-a/b}`.  What
is done where the data do not determine it, and how intervals are found: docs/theory/fragility.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.errors import InputError
from railquake.measures import intensities

if TYPE_CHECKING:
    import pandas as pd

__all__ = [
    "OUTCOMES",
    "Fragility",
    "compare_measures",
    "outcome",
    "write_csv",
]

Array = np.ndarray[Any, np.dtype[np.float64]]
Flags = np.ndarray[Any, np.dtype[np.bool_]]

LARGEST_BETA = 10.0  # a curve that flat says nothing; beyond, the measure does not matter
REACH = 1e3  # theta's interval ends at the smallest and largest measure over and times this
CONFIDENCE = 0.95
REPLICATES = 500  # of the bootstrap
ITERATIONS = 100
LINE_ITERATIONS = 40
LINE_TOLERANCE = 1e-4  # a profile errs by its square
ROOT_TOLERANCE = 1e-4  # of the end of an interval, in standard deviations
TOLERANCE = 1e-9  # of the last step of Newton's iteration, in standard deviations of ln x

SEPARATED = "separated"
NO_EVENTS = "no events"
ALL_EVENTS = "all events"
NO_RISE = "no rise"
UNBOUNDED = "interval not bounded by the data"


OUTCOMES = ("onset", "derailed")
FINISHED = ("safe", "onset", "derailed")


def outcome(table: pd.DataFrame, event: str) -> Flags:
    """Whether each run reached the outcome.

    Parameters
    ----------
    table : DataFrame
        Rows of a study.
    event : {"onset", "derailed"}
        The onset of slide-off was reached (then or before a derailment), or the train left the
        track.

    Returns
    -------
    array of bool, shape (runs,)

    Raises
    ------
    InputError
        If the outcome is not known.
    """
    if event not in OUTCOMES:
        raise InputError(f'outcome "{event}": is not known; write {" or ".join(OUTCOMES)}')
    reached = (table["status"] == "derailed").to_numpy(dtype=bool)
    if event == "onset":
        reached = reached | (table["status"] == "onset").to_numpy(dtype=bool)
        if "onset_first_s" in table:
            reached = reached | table["onset_first_s"].notna().to_numpy(dtype=bool)
    return reached


@dataclass(frozen=True)
class Fragility:
    """A lognormal fragility curve with what is known about its certainty.

    Attributes
    ----------
    event : str
        What may happen.
    measure : str
        Name of the measure (`measures.intensities`), or what the caller calls it.
    theta : float
        Median: the measure at which the probability is one half, in the measure's unit.
    beta : float
        Dispersion, the standard deviation of ln x.
    theta_interval, beta_interval : (float, float)
        With the `confidence`, by the profile likelihood; see the notes.
    runs, events, records : int
        That the fit rests on; records is 0 if runs are taken as independent.
    left_out : int
        Runs without a positive measure.
    log_likelihood : float
        At the fit, without penalty.
    flags : tuple of str
        Empty if the data determine the curve; else ``separated``, ``no events``, ``all events``
        (the fit is then the penalised one), ``no rise`` (the probability does not grow with the
        measure, beta is at its bound) and ``interval not bounded by the data``.
    confidence : float
    span : (float, float)
        Smallest and largest measure among the runs.
    replicates : array, shape (replicates, 2)
        ln theta and beta of the bootstrap.

    Notes
    -----
    Where the outcome is perfectly separated by the measure, the likelihood has no maximum (beta
    tends to zero), and without any or with nothing but events neither has it.  The fit is then that
    of the likelihood penalised with Jeffreys' prior, which is finite always (Kosmidis & Firth 2021,
    "Jeffreys-prior penalty, finiteness and shrinkage in binomial-response generalized linear
    models", Biometrika 108(1), 71-82), and is flagged.

    Intervals are ends of the profile of that penalised likelihood in all cases (Heinze & Schemper
    2002, "A solution to the problem of separation in logistic regression", Statistics in Medicine
    21(16), 2409-2419): its bias is smaller, and with few events they cover better than those of the
    likelihood itself.  With `records`, runs of a record count as dependent: the profile's bound is
    widened by the ratio of the sandwich variance to the model's (never narrowed) and taken from
    Student's t with as many degrees of freedom as there are records less one; and the bootstrap
    draws records.
    """

    event: str
    measure: str
    theta: float
    beta: float
    theta_interval: tuple[float, float]
    beta_interval: tuple[float, float]
    runs: int
    events: int
    records: int
    left_out: int
    log_likelihood: float
    flags: tuple[str, ...]
    confidence: float
    span: tuple[float, float]
    replicates: Array = field(repr=False, compare=False)

    @classmethod
    def fit(
        cls,
        values: Any,
        reached: Any,
        records: Any = None,
        *,
        event: str = "event",
        measure: str = "x",
        confidence: float = CONFIDENCE,
        replicates: int = REPLICATES,
        seed: int = 0,
    ) -> Fragility:
        """Fit a curve to runs.

        Parameters
        ----------
        values : array_like, shape (n,)
            The measure; runs where it is not positive and finite are left out.
        reached : array_like of bool, shape (n,)
            Whether the outcome was reached.
        records : array_like, shape (n,), optional
            Which runs belong together, such as the records' names.
        event, measure : str
            What to call them.
        confidence : float
        replicates : int
            Of the bootstrap; 0 for none.
        seed : int
            Of the bootstrap.

        Returns
        -------
        Fragility

        Raises
        ------
        InputError
            If there are fewer than two different values to fit to, or the lengths differ.
        """
        x = np.asarray(values, dtype=float)
        y = np.asarray(reached, dtype=bool)
        groups = None if records is None else np.asarray(records)
        if x.ndim != 1 or y.shape != x.shape or (groups is not None and groups.shape != x.shape):
            raise InputError(
                f"fragility: values, outcomes and records must be as many, found {x.size}, "
                f"{y.size}" + ("" if groups is None else f" and {groups.size}")
            )
        if not 0.0 < confidence < 1.0:
            raise InputError(f"fragility: confidence must lie between 0 and 1, found {confidence}")
        known = np.isfinite(x) & (x > 0.0)
        x, y = x[known], y[known]
        labels = np.arange(x.size) if groups is None else _numbered(groups[known])
        if np.unique(x).size < 2:
            raise InputError(
                f"fragility against {measure}: needs runs with at least two different positive "
                f"values, found {np.unique(x).size}"
            )
        clusters = int(labels.max()) + 1
        dependent = groups is not None and 2 <= clusters < x.size
        weights = np.ones((1, x.size))
        fits, drawn = _Fits.of(x, y, weights), np.empty((0, 2))
        quantile = _quantile(confidence, clusters if dependent else 0)
        low, high, bounded = fits.penalised().intervals(quantile, labels if dependent else None)
        if replicates:
            drawn = _bootstrap(x, y, labels, replicates, seed)
        flags = fits.flags(0) + (() if bounded[0] else (UNBOUNDED,))
        return cls(
            event=event,
            measure=measure,
            theta=float(fits.theta[0]),
            beta=float(fits.beta[0]),
            theta_interval=(float(low[0, 0]), float(high[0, 0])),
            beta_interval=(float(low[0, 1]), float(high[0, 1])),
            runs=x.size,
            events=int(y.sum()),
            records=clusters if dependent else 0,
            left_out=int((~known).sum()),
            log_likelihood=float(fits.log_likelihood[0]),
            flags=flags,
            confidence=confidence,
            span=(float(x.min()), float(x.max())),
            replicates=drawn,
        )

    @classmethod
    def from_table(cls, table: pd.DataFrame, event: str, measure: str, **options: Any) -> Fragility:
        """Fit a curve to the rows of a study, runs of a record taken as dependent.

        Parameters
        ----------
        table : DataFrame
            Rows of a study; those that diverged, failed or did not converge are left aside.
        event : {"onset", "derailed"}
        measure : str
            Name (`measures.intensities`) or a column's name.
        **options
            See `fit`.

        Returns
        -------
        Fragility

        Raises
        ------
        InputError
            If outcome or measure is not known, or there is too little to fit to.
        """
        declared = intensities()
        column = declared[measure].key if measure in declared else measure
        if column not in table:
            known = [name for name, item in declared.items() if item.key in table]
            raise InputError(
                f'fragility: the table has no measure "{measure}"; known are {", ".join(known)}'
            )
        rows = table[table["status"].isin(FINISHED)]
        names = {item.key: name for name, item in declared.items()}
        return cls.fit(
            rows[column].to_numpy(dtype=float),
            outcome(rows, event),
            rows["record"].to_numpy() if "record" in rows else None,
            event=event,
            measure=names.get(column, measure),
            **options,
        )

    @property
    def aic(self) -> float:
        """Akaike's criterion, to compare measures on the same runs; lower is better."""
        return 4.0 - 2.0 * self.log_likelihood

    def probability(self, value: Any = None, /, **measure: Any) -> Any:
        """Probability of the outcome.

        Parameters
        ----------
        value : array_like, optional
            The measure; or by its name: ``probability(pbv=1.2)``, m/s.
        **measure

        Returns
        -------
        float or array
            0 where the measure is 0.

        Raises
        ------
        InputError
            If it is asked for another measure than the fragility's, or a value is negative.

        Examples
        --------
        >>> Fragility.from_table(table, "derailed", "pbv").probability(pbv=1.2)  # doctest: +SKIP
        0.31
        """
        x = self._asked(value, measure)
        found = _curve(x, math.log(self.theta), self.beta)
        return float(found) if found.ndim == 0 else found

    def band(self, value: Any = None, /, **measure: Any) -> tuple[Any, Any]:
        """Bootstrap band of the probability, pointwise with the `confidence`.

        Parameters
        ----------
        value, **measure
            See `probability`.

        Returns
        -------
        low, high : array

        Raises
        ------
        InputError
            See `probability`; and if it was fitted without a bootstrap.
        """
        x = self._asked(value, measure)
        if not len(self.replicates):
            raise InputError("fragility: was fitted without a bootstrap; give replicates")
        curves = _curve(x[..., None], self.replicates[:, 0], self.replicates[:, 1])
        tail = 50.0 * (1.0 - self.confidence)
        low, high = np.percentile(curves, [tail, 100.0 - tail], axis=-1)
        return low, high

    def _asked(self, value: Any, measure: Mapping[str, Any]) -> Array:
        names = {self.measure}
        declared = intensities()
        if self.measure in declared:
            names.add(declared[self.measure].key)
        if (value is None) == (not measure) or len(measure) > 1 or not set(measure) <= names:
            found = ", ".join(measure) if measure else "nothing" if value is None else "a number"
            raise InputError(
                f"fragility: is against {self.measure}; write e.g. probability("
                f"{self.measure}=1.2), found {found}"
            )
        x = np.asarray(next(iter(measure.values())) if measure else value, dtype=float)
        if np.any(x < 0.0) or np.isnan(x).any():
            raise InputError(f"fragility: {self.measure} must be 0 or more")
        return x

    def to_csv(self, path: str | Path, identifier: str | None = None) -> None:
        """Write the curve as a table of pelicun's; see `write_csv`."""
        write_csv(path, {identifier or f"railquake.{self.event}.{self.measure}": [self]})


def compare_measures(
    table: pd.DataFrame, event: str, measures: Iterable[str] | None = None, **options: Any
) -> list[Fragility]:
    """Curves against several measures on the same runs, the best by AIC first.

    Parameters
    ----------
    table : DataFrame
        Rows of a study.
    event : {"onset", "derailed"}
    measures : iterable of str, optional
        Names, all by default; those that the table lacks, or that have no two different positive
        values, are left out.
    **options
        See `Fragility.fit`.

    Returns
    -------
    list of Fragility

    Notes
    -----
    Only runs with a positive value of every measure that is compared are taken.
    """
    import pandas as pd

    rows = table[table["status"].isin(FINISHED)]
    columns = {}
    declared = intensities()
    for name in declared if measures is None else measures:
        column = declared[name].key
        if column in rows:
            values = pd.to_numeric(rows[column], errors="coerce")
            if values[values > 0.0].nunique() >= 2:
                columns[name] = column
    for column in columns.values():
        rows = rows[pd.to_numeric(rows[column], errors="coerce") > 0.0]
    found = [
        Fragility.from_table(rows, event, name, **options)
        for name, column in columns.items()
        if rows[column].nunique() >= 2
    ]
    return sorted(found, key=lambda curve: curve.aic)


def write_csv(
    path: str | Path,
    curves: Mapping[str, list[Fragility]],
    *,
    first_period_s: float | None = None,
) -> None:
    """Write curves in the layout of pelicun's damage model parameters.

    A row a component, the limit states in columns (tried with pelicun 3.10).

    Parameters
    ----------
    path : str or Path
    curves : mapping of str to list of Fragility
        By the component's identifier (a dash in it becomes a point): its limit states in order of
        severity (onset, then derailed), all against one measure.
    first_period_s : float, optional
        Period of the spectral acceleration, where a curve is against that.

    Raises
    ------
    InputError
        If the curves of a component are against different measures or one that pelicun has no
        name for, if the period is missing, or the file cannot be written.
    """
    import pandas as pd

    declared = intensities()
    states = max((len(limits) for limits in curves.values()), default=0)
    rows = {}
    for identifier, limits in curves.items():
        names = {curve.measure for curve in limits}
        if len(names) != 1 or not names <= set(declared):
            raise InputError(
                f"{path}: {identifier}: its curves must be against one measure of "
                f"{', '.join(declared)}, found {', '.join(sorted(names)) or 'none'}"
            )
        name = next(iter(names))
        of = declared[name].intensity
        assert of is not None  # by `intensities`
        demand = of.demand_type
        if of.has_period:
            if first_period_s is None:
                raise InputError(f"{path}: {identifier}: {name} needs its period, first_period_s")
            demand = f"{demand}|{first_period_s:.3g}"
        row: dict[str, Any] = {
            "Incomplete": 0,
            "Demand-Type": demand,
            "Demand-Unit": of.demand_unit,
            "Demand-Offset": 0,
            "Demand-Directional": 1,
        }
        for k in range(states):
            curve = limits[k] if k < len(limits) else None
            row[f"LS{k + 1}-Family"] = "" if curve is None else "lognormal"
            row[f"LS{k + 1}-Theta_0"] = "" if curve is None else f"{curve.theta:.6g}"
            row[f"LS{k + 1}-Theta_1"] = "" if curve is None else f"{curve.beta:.6g}"
            row[f"LS{k + 1}-DamageStateWeights"] = ""
        rows[identifier.replace("-", ".")] = row  # pelicun splits names at the dash
    table = pd.DataFrame.from_dict(rows, orient="index")
    table.index.name = "ID"
    try:
        table.to_csv(path)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {error.strerror or error}") from None


def _curve(x: Array, ln_theta: Any, beta: Any) -> Array:
    from scipy.special import ndtr

    with np.errstate(divide="ignore"):
        return np.asarray(ndtr((np.log(x) - ln_theta) / beta))


def _numbered(labels: Any) -> Any:
    return np.unique(labels, return_inverse=True)[1]


def _quantile(confidence: float, clusters: int) -> float:
    from scipy.stats import norm, t

    if clusters:
        return float(t.ppf(0.5 + 0.5 * confidence, clusters - 1))
    return float(norm.ppf(0.5 + 0.5 * confidence))


def _bootstrap(x: Array, y: Flags, labels: Any, replicates: int, seed: int) -> Array:
    """Fits to data drawn again, whole records at a time; ln theta and beta."""
    rng = np.random.default_rng(seed)
    clusters = int(labels.max()) + 1
    found = []
    size = max(1, 400_000 // x.size)  # so that memory stays small
    for first in range(0, replicates, size):
        count = min(size, replicates - first)
        drawn = rng.multinomial(clusters, np.full(clusters, 1.0 / clusters), size=count)
        fits = _Fits.of(x, y, drawn[:, labels].astype(float))
        found.append(np.column_stack([np.log(fits.theta), fits.beta]))
    return np.concatenate(found)


# --- probit regression, many sets of weights at once -----------------------------------------


@dataclass(frozen=True)
class _Fits:
    """Fits of the same kind to several sets of data, shape (sets, n).

    The regression is on ``z``, ln x centred and scaled: eta = a + b z.
    """

    z: Array
    y: Array
    weights: Array
    centre: Array
    scale: Array
    point: Array  # (sets, 2): a, b
    penalty: Array  # (sets,): 1 where Jeffreys' prior is added
    separated: Flags
    flat: Flags
    reach: Array  # (sets, 2): outermost ln theta, in z

    @classmethod
    def of(cls, x: Array, y: Any, weights: Array) -> _Fits:
        shape = weights.shape
        ln_x = np.broadcast_to(np.log(x), shape)
        happened = np.broadcast_to(np.asarray(y, dtype=float), shape)
        total = weights.sum(axis=1)
        centre = (weights * ln_x).sum(axis=1) / total
        spread = np.sqrt((weights * (ln_x - centre[:, None]) ** 2).sum(axis=1) / total)
        scale = np.where(spread > 1e-12, spread, 1.0)
        z = (ln_x - centre[:, None]) / scale[:, None]
        there = weights > 0.0
        most = np.where(there & (happened < 0.5), z, -np.inf).max(axis=1)
        least = np.where(there & (happened > 0.5), z, np.inf).min(axis=1)
        # no overlap: also without any, or with nothing but events
        separated = most <= least
        penalty = separated.astype(float)
        point, flat = _rising(z, happened, weights, penalty, scale / LARGEST_BETA)
        edge = math.log(REACH)
        low = np.where(there, z, np.inf).min(axis=1) - edge / scale
        high = np.where(there, z, -np.inf).max(axis=1) + edge / scale
        return cls(
            z, happened, weights, centre, scale, point, penalty, separated, flat,
            np.column_stack([low, high]),
        )  # fmt: skip

    def penalised(self) -> _Fits:
        """The same with Jeffreys' prior everywhere."""
        penalty = np.ones_like(self.penalty)
        point, _ = _rising(self.z, self.y, self.weights, penalty, self.scale / LARGEST_BETA)
        return replace(self, penalty=penalty, point=point)

    @property
    def beta(self) -> Array:
        return self.scale / self.point[:, 1]

    @property
    def theta(self) -> Array:
        theta: Array = np.exp(self.centre - self.scale * self.point[:, 0] / self.point[:, 1])
        return theta

    @property
    def log_likelihood(self) -> Array:
        return _log_likelihood(self.z, self.y, self.weights, self.point)

    def flags(self, k: int) -> tuple[str, ...]:
        events = (self.weights[k] * self.y[k]).sum()
        found = []
        if events == 0.0:
            found.append(NO_EVENTS)
        elif events == self.weights[k].sum():
            found.append(ALL_EVENTS)
        elif self.separated[k]:
            found.append(SEPARATED)
        if self.flat[k]:
            found.append(NO_RISE)
        return tuple(found)

    def intervals(self, quantile: float, labels: Any = None) -> tuple[Array, Array, Flags]:
        """Profile intervals of theta and beta, (sets, 2) each, and whether the data bound them."""
        _, information, _ = _slopes(self.z, self.y, self.weights, self.penalty, self.point)
        variance = _inverse(information)
        robust = variance if labels is None else self._sandwich(variance, labels)
        a, b = self.point.T
        # ln theta is -a/b, beta 1/b: gradients for the delta method
        gradients = (
            np.column_stack([-1.0 / b, a / b**2]),
            np.column_stack([0.0 * b, 1.0 + 0.0 * b]),
        )
        best = _objective(self.z, self.y, self.weights, self.penalty, self.point)
        low, high = np.empty((len(a), 2)), np.empty((len(a), 2))
        bounded = np.ones(len(a), dtype=bool)
        for k, gradient in enumerate(gradients):
            spread = np.sqrt(np.einsum("si,sij,sj->s", gradient, variance, gradient))
            wide = np.sqrt(np.einsum("si,sij,sj->s", gradient, robust, gradient))
            # never narrower than for independent runs
            bound = quantile * np.maximum(wide / spread, 1.0)
            centre = -a / b if k == 0 else b
            limits = (
                (np.minimum(self.reach[:, 0], centre), np.maximum(self.reach[:, 1], centre))
                if k == 0
                else (self.scale / LARGEST_BETA, np.full(len(b), np.inf))
            )
            for sign, limit, target in zip((-1.0, 1.0), limits, (low, high), strict=True):
                target[:, k], found = self._profile_end(
                    k, centre, sign * spread, bound, limit, best
                )
                bounded &= found
        theta = [np.exp(self.centre + self.scale * side[:, 0]) for side in (low, high)]
        beta = [self.scale / side[:, 1] for side in (high, low)]
        return np.column_stack([theta[0], beta[0]]), np.column_stack([theta[1], beta[1]]), bounded

    def _profile_end(
        self, which: int, centre: Array, step: Array, bound: Array, limit: Array, best: Array
    ) -> tuple[Array, Flags]:
        """Where the root of twice the profile's fall reaches ``bound``; whether before ``limit``.

        The root is nearly a straight line in the parameter, so false position converges quickly
        from the end of Wald's interval; the bracket keeps it safe.
        """
        up = step[0] > 0.0
        cut = np.minimum if up else np.maximum
        inner, at_inner = centre.copy(), -bound
        nuisance = self.point[:, 1 - which].copy()
        reach = 0.4 * step * bound
        outer = cut(centre + step * bound, limit)
        at_outer, nuisance = self._root(which, outer, nuisance, best)
        at_outer -= bound
        for _ in range(60):  # until it brackets
            k = np.flatnonzero((at_outer < 0.0) & (outer != limit))
            if not k.size:
                break
            inner[k], at_inner[k] = outer[k], at_outer[k]
            reach[k] *= 1.5
            outer[k] = cut(outer[k] + reach[k], limit[k])
            value, nuisance[k] = self._only(k)._root(which, outer[k], nuisance[k], best[k])
            at_outer[k] = value - bound[k]
        found = at_outer >= 0.0
        end = np.where(found, outer, limit)
        k = np.flatnonzero(found & (at_outer > ROOT_TOLERANCE))
        for _ in range(60):  # false position, Illinois
            if not k.size:
                break
            share = at_outer[k] / (at_outer[k] - at_inner[k])
            end[k] = outer[k] - share * (outer[k] - inner[k])
            value, nuisance[k] = self._only(k)._root(which, end[k], nuisance[k], best[k])
            value -= bound[k]
            beyond = value >= 0.0
            out, within = k[beyond], k[~beyond]
            outer[out], at_outer[out] = end[out], value[beyond]
            at_inner[out] *= 0.5
            inner[within], at_inner[within] = end[within], value[~beyond]
            at_outer[within] *= 0.5
            k = k[np.abs(value) > ROOT_TOLERANCE]
        return end, found

    def _only(self, k: Any) -> _Fits:
        """Some of the fits."""
        return _Fits(**{item.name: getattr(self, item.name)[k] for item in fields(self)})

    def _root(self, which: int, at: Array, start: Array, best: Array) -> tuple[Array, Array]:
        """Root of twice the fall of the profile where theta (0) or the slope (1) is held."""
        zero, one = np.zeros(len(at)), np.ones(len(at))
        if which == 0:  # eta = b (z - place)
            base, direction = np.column_stack([zero, zero]), np.column_stack([-at, one])
        else:
            base, direction = np.column_stack([zero, at]), np.column_stack([one, zero])
        s = _along(self.z, self.y, self.weights, self.penalty, base, direction, start)
        if which == 0:
            s = np.maximum(s, 0.0)  # the probability does not fall
        point = base + s[:, None] * direction
        value = _objective(self.z, self.y, self.weights, self.penalty, point)
        return np.sqrt(np.maximum(2.0 * (best - value), 0.0)), s

    def _sandwich(self, variance: Array, labels: Any) -> Array:
        """Covariance for runs that depend on each other within a record (Liang & Zeger 1986)."""
        clusters = int(labels.max()) + 1
        residual = self.weights * _terms(self.z, self.y, self.point)[0]
        belongs = (labels[:, None] == np.arange(clusters)).astype(float)
        sums = np.stack([residual @ belongs, (residual * self.z) @ belongs], axis=-1)
        meat = np.einsum("sci,scj->sij", sums, sums) * clusters / (clusters - 1)
        return variance @ meat @ variance


def _terms(z: Array, y: Array, point: Array) -> tuple[Array, Array, Array]:
    """Of each run: score and expected information for eta, and the slope of ln information."""
    from scipy.special import erfcx

    eta = np.clip(point[:, :1] + point[:, 1:] * z, -35.0, 35.0)
    size = np.abs(eta)
    density = np.exp(-0.5 * eta * eta) / math.sqrt(2.0 * math.pi)
    tail = math.sqrt(2.0 / math.pi) / erfcx(size / math.sqrt(2.0))  # density over Phi(-size)
    body = density / (1.0 - density / tail)  # over Phi(size)
    up, down = np.where(eta > 0.0, body, tail), np.where(eta > 0.0, tail, body)
    return y * up - (1.0 - y) * down, up * down, -2.0 * eta - up + down


def _slopes(
    z: Array, y: Array, weights: Array, penalty: Array, point: Array
) -> tuple[Array, Array, Array]:
    """Gradient of the (penalised) log-likelihood, expected information, its determinant."""
    score, information, slope = _terms(z, y, point)
    w = weights * information
    matrix = np.empty((len(point), 2, 2))
    matrix[:, 0, 0] = w.sum(axis=1)
    matrix[:, 0, 1] = matrix[:, 1, 0] = (w * z).sum(axis=1)
    matrix[:, 1, 1] = (w * z * z).sum(axis=1)
    determinant = matrix[:, 0, 0] * matrix[:, 1, 1] - matrix[:, 0, 1] ** 2
    pull = weights * score
    if penalty.any():
        inverse = _inverse(matrix)
        leverage = w * (
            inverse[:, 0, 0, None]
            + 2.0 * inverse[:, 0, 1, None] * z
            + inverse[:, 1, 1, None] * z * z
        )
        pull = pull + 0.5 * penalty[:, None] * leverage * slope
    gradient = np.column_stack([pull.sum(axis=1), (pull * z).sum(axis=1)])
    return gradient, matrix, determinant


def _inverse(matrix: Array) -> Array:
    determinant = matrix[:, 0, 0] * matrix[:, 1, 1] - matrix[:, 0, 1] ** 2
    out = np.empty_like(matrix)
    out[:, 0, 0], out[:, 1, 1] = matrix[:, 1, 1], matrix[:, 0, 0]
    out[:, 0, 1] = out[:, 1, 0] = -matrix[:, 0, 1]
    out /= np.maximum(determinant, 1e-300)[:, None, None]
    return out


def _log_likelihood(z: Array, y: Array, weights: Array, point: Array) -> Array:
    from scipy.special import log_ndtr

    eta = np.clip(point[:, :1] + point[:, 1:] * z, -35.0, 35.0)
    total: Array = (weights * log_ndtr((2.0 * y - 1.0) * eta)).sum(axis=1)
    return total


def _objective(z: Array, y: Array, weights: Array, penalty: Array, point: Array) -> Array:
    value = _log_likelihood(z, y, weights, point)
    if penalty.any():
        _, _, determinant = _slopes(z, y, weights, 0.0 * penalty, point)
        value = value + 0.5 * penalty * np.log(np.maximum(determinant, 1e-300))
    return value


def _maximum(z: Array, y: Array, weights: Array, penalty: Array) -> Array:
    """Maximum of the (penalised) likelihood by Fisher's scoring with halved steps."""
    from scipy.special import ndtri

    total = weights.sum(axis=1)
    share = ((weights * y).sum(axis=1) + 0.5) / (total + 1.0)
    point = np.column_stack([ndtri(share), np.full(len(z), 0.1)])
    active = np.ones(len(z), dtype=bool)
    value = _objective(z, y, weights, penalty, point)
    for _ in range(ITERATIONS):
        k = np.flatnonzero(active)
        if not k.size:
            break
        data = z[k], y[k], weights[k], penalty[k]
        gradient, information, _ = _slopes(*data, point[k])
        step = np.einsum("sij,sj->si", _inverse(information), gradient)
        step *= np.minimum(1.0, 5.0 / np.maximum(np.abs(step).max(axis=1), 1e-300))[:, None]
        moved = point[k] + step
        new = _objective(*data, moved)
        for _ in range(30):
            worse = new < value[k] - 1e-12 * np.abs(value[k])
            if not worse.any():
                break
            step[worse] *= 0.5
            moved = point[k] + step
            new = _objective(*data, moved)
        point[k], value[k] = moved, new
        active[k] = np.abs(step).max(axis=1) > TOLERANCE * np.maximum(
            1.0, np.abs(moved).max(axis=1)
        )
    return point


def _rising(
    z: Array, y: Array, weights: Array, penalty: Array, smallest: Array
) -> tuple[Array, Flags]:
    """The maximum among slopes of at least ``smallest``, and where that bound holds it."""
    point = _maximum(z, y, weights, penalty)
    flat = ~(point[:, 1] > smallest)
    if flat.any():
        zero = np.zeros(int(flat.sum()))
        held = np.column_stack([zero, smallest[flat]])
        direction = np.column_stack([zero + 1.0, zero])
        data = z[flat], y[flat], weights[flat], penalty[flat]
        point[flat, 0] = _along(*data, held, direction, point[flat, 0])
        point[flat, 1] = smallest[flat]
    return point, flat


def _along(
    z: Array, y: Array, weights: Array, penalty: Array, base: Array, direction: Array, start: Array
) -> Array:
    """Maximum along a line of (a, b), from ``start``."""
    s, last = start.copy(), np.zeros_like(start)
    k = np.arange(len(s))
    for _ in range(LINE_ITERATIONS):
        point = base[k] + s[k, None] * direction[k]
        gradient, information, _ = _slopes(z[k], y[k], weights[k], penalty[k], point)
        slope = np.einsum("si,si->s", gradient, direction[k])
        curvature = np.einsum("si,sij,sj->s", direction[k], information, direction[k])
        step = slope / np.maximum(curvature, 1e-300)
        # where it turned round the maximum lies between: half the last step at most
        turned = step * last[k] < 0.0
        reach = np.where(turned, 0.5 * np.abs(last[k]), 0.5 * np.abs(s[k]) + 1.0)
        step = np.clip(step, -reach, reach)
        s[k] += step
        last[k] = step
        k = k[np.abs(step) > LINE_TOLERANCE * np.maximum(np.abs(s[k]), 1.0)]
        if not k.size:
            break
    return s
