"""The lognormal curve and what is known about its certainty."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.errors import InputError
from railquake.fragility.fits import UNBOUNDED, Fits, bootstrap, quantile
from railquake.fragility.outcomes import FINISHED, outcome
from railquake.fragility.pelicun import write_csv
from railquake.fragility.probit import Array
from railquake.measures import intensities
from railquake.messages import shown

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["CONFIDENCE", "REPLICATES", "Fragility", "compare_measures"]

CONFIDENCE = 0.95
REPLICATES = 500  # of the bootstrap


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
        Runs without a positive measure, or of which nobody knows the outcome.
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
            Whether the outcome was reached: booleans, or 0 and 1.  Missing ones (None, NaN, NA)
            are left out and counted.
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
            If there are fewer than two different values to fit to, the lengths differ, or an
            outcome is neither true nor false.
        """
        x, y, groups = _checked(values, reached, records, confidence)
        known = np.isfinite(x) & (x > 0.0) & np.isfinite(y)
        x, y = x[known], y[known] == 1.0
        labels = np.arange(x.size) if groups is None else _numbered(groups[known])
        if np.unique(x).size < 2:
            raise InputError(
                f"fragility against {measure}: needs runs with at least two different positive "
                f"values, found {np.unique(x).size}"
            )
        clusters = int(labels.max()) + 1
        dependent = groups is not None and 2 <= clusters < x.size
        weights = np.ones((1, x.size))
        fits, drawn = Fits.of(x, y, weights), np.empty((0, 2))
        low, high, bounded = fits.penalised().intervals(
            quantile(confidence, clusters if dependent else 0), labels if dependent else None
        )
        if replicates:
            drawn = bootstrap(x, y, labels, replicates, seed)
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


def _curve(x: Array, ln_theta: Any, beta: Any) -> Array:
    from scipy.special import ndtr

    with np.errstate(divide="ignore"):
        return np.asarray(ndtr((np.log(x) - ln_theta) / beta))


def _checked(values: Any, reached: Any, records: Any, confidence: float) -> tuple[Any, Any, Any]:
    """Arrays of the same length."""
    x = _measures(values)
    y = _outcomes(reached)
    groups = None if records is None else _records(records)
    if x.ndim != 1 or y.shape != x.shape or (groups is not None and groups.shape != x.shape):
        raise InputError(
            f"fragility: values, outcomes and records must be as many, found {x.size}, "
            f"{y.size}" + ("" if groups is None else f" and {groups.size}")
        )
    if not 0.0 < confidence < 1.0:
        raise InputError(f"fragility: confidence must lie between 0 and 1, found {confidence}")
    return x, y, groups


def _array(values: Any, what: str) -> Any:
    try:
        return np.asarray(values)
    except ValueError:
        raise InputError(f"fragility: {what} are no plain list, one for each run") from None


def _records(records: Any) -> Any:
    groups = _array(records, "records")
    if any(map(_is_missing, groups.flat)):
        raise InputError(
            "fragility: some runs have no record; name one for each, or give no records at all"
        )
    try:
        np.unique(groups)
    except TypeError:
        raise InputError("fragility: records must all be texts or all be numbers") from None
    return groups


def _measures(values: Any) -> Array:
    """Measures as numbers; NaN where they are missing."""
    items = _array(values, "measures")
    if items.dtype.kind in "fiu":
        return items.astype(float)
    found = np.full(items.shape, np.nan)
    for at, item in np.ndenumerate(items):
        if _is_missing(item):
            continue
        if isinstance(item, bool | np.bool_) or not _is_plain(item):
            raise InputError(f"fragility: the measure must be a number, found {shown(item)}")
        found[at] = float(item)
    return found


def _outcomes(reached: Any) -> Array:
    """1 where the outcome was reached, 0 where not, NaN where nobody knows."""
    items = _array(reached, "outcomes")
    if items.dtype.kind == "b":
        return items.astype(float)
    found = np.full(items.shape, np.nan)
    for at, item in np.ndenumerate(items):
        if _is_missing(item):
            continue
        # a text is none: "False" would be true
        if not _is_plain(item) or float(item) not in (0.0, 1.0):
            raise InputError(
                "fragility: an outcome must be true or false, or 1 or 0, found "
                f"{shown(item)}; compare first, such as status == 'derailed'"
            )
        found[at] = float(item)
    return found


def _is_plain(item: Any) -> bool:
    """Whether it is a real number or a boolean; numpy takes its times for whole numbers."""
    return isinstance(item, bool | np.bool_ | Real) and not isinstance(item, np.timedelta64)


def _is_missing(item: Any) -> bool:
    """None, NaN, and pandas' NA and NaT: what is not equal to itself."""
    if item is None:
        return True
    try:
        return bool(item != item)
    except (TypeError, ValueError):  # of NA, nobody knows
        return True


def _numbered(labels: Any) -> Any:
    return np.unique(labels, return_inverse=True)[1]
