"""Which measure goes with uplift: rank correlation, and scatter about a power law."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.findings.resampling import REPLICATES, Estimate, estimates, finished
from railquake.measures import correlated

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["Correlation", "Correlations", "Difference", "correlate"]

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Correlation:
    """How a response goes with one measure.

    Attributes
    ----------
    measure : str
        Column of the table.
    spearman : Estimate
        Rank correlation; ties have their mean rank.
    dispersion : Estimate
        beta, the standard deviation of ln y about ``ln y = a + b ln x``.
    exponent : Estimate
        b.
    """

    measure: str
    spearman: Estimate
    dispersion: Estimate
    exponent: Estimate


@dataclass(frozen=True)
class Difference:
    """One measure against another, on the same samples.

    Attributes
    ----------
    measure, other : str
    spearman : Estimate
        That of the measure less that of the other; positive: the measure goes better with it.
    dispersion : Estimate
        Likewise; negative: the measure leaves less scatter.
    """

    measure: str
    other: str
    spearman: Estimate
    dispersion: Estimate


@dataclass(frozen=True)
class Correlations:
    """How a response goes with several measures, on the same runs.

    Attributes
    ----------
    response : str
    runs, records : int
        What it rests on.
    left_out : int
        Runs where response or a measure is not positive: a power law has no place for them.
    items : tuple of Correlation
        One for each measure that varies.
    differences : tuple of Difference
        The first measure against each other.
    missing : tuple of str
        Measures that the table lacks, or that do not vary.
    """

    response: str
    runs: int
    records: int
    left_out: int
    items: tuple[Correlation, ...]
    differences: tuple[Difference, ...]
    missing: tuple[str, ...]

    def of(self, measure: str) -> Correlation | None:
        """That of a measure, if there is one."""
        return next((item for item in self.items if item.measure == measure), None)

    def against(self, other: str) -> Difference | None:
        """The first measure against another, if there is such."""
        return next((item for item in self.differences if item.other == other), None)


def correlate(
    table: pd.DataFrame,
    response: str = "uplift_ratio",
    measures: Iterable[str] | None = None,
    *,
    within: str | None = None,
    replicates: int = REPLICATES,
    seed: int = 0,
) -> Correlations:
    """Rank correlation and scatter of a response against several measures.

    Parameters
    ----------
    table : DataFrame
        Rows of a study; runs that did not come to an end are left aside.
    response : str
        Column.
    measures : iterable of str, optional
        Columns, by default those that uplift is held against (`measures.correlated`); one that is
        missing, or the same everywhere, is named in ``missing``.
    within : str, optional
        Column, such as ``level``: of the logarithms the mean over all runs with the same value is
        taken away first, so that what varies between levels does not count.
    replicates, seed : int
        Of the bootstrap, which draws records.

    Returns
    -------
    Correlations
        All measures on the same runs: those where every one and the response are positive.
    """
    rows = finished(table)
    names = correlated() if measures is None else tuple(measures)
    varying = [name for name in names if _varies(rows, name)]
    values = _positive_columns(rows, [response, *varying])
    kept = np.all(np.isfinite(values), axis=1)
    logs = np.log(values[kept])
    records = rows["record"].to_numpy()[kept]
    if within is not None and within in rows:
        groups = np.unique(rows[within].to_numpy()[kept].astype(str), return_inverse=True)[1]
        for k in range(int(groups.max()) + 1 if groups.size else 0):
            logs[groups == k] -= logs[groups == k].mean(axis=0)
    if len(logs) < 3:
        return Correlations(
            response, len(logs), len(set(records)), int((~kept).sum()), (), (), names
        )
    count = len(varying)

    def statistic(at: Any) -> Array:
        found = _numbers(logs[at])
        return np.concatenate([found.ravel(), (found[:1] - found[1:]).ravel()])

    flat = estimates(statistic, records, replicates, seed) if count else []
    triples = [flat[3 * k : 3 * k + 3] for k in range(len(flat) // 3)]
    items = tuple(
        Correlation(name, *triple) for name, triple in zip(varying, triples[:count], strict=True)
    )
    differences: tuple[Difference, ...] = ()
    if varying and varying[0] == names[0]:
        differences = tuple(
            Difference(names[0], name, triple[0], triple[1])
            for name, triple in zip(varying[1:], triples[count:], strict=True)
        )
    missing = tuple(name for name in names if name not in varying)
    left_out = int((~kept).sum())
    return Correlations(
        response, len(logs), len(set(records)), left_out, items, differences, missing
    )


def _varies(rows: pd.DataFrame, name: str) -> bool:
    if name not in rows:
        return False
    values = _positive_columns(rows, [name])[:, 0]
    known = values[np.isfinite(values)]
    return bool(known.size >= 3 and np.unique(known).size >= 2)


def _positive_columns(rows: pd.DataFrame, names: list[str]) -> Array:
    """Columns as floats, NaN where they are not positive."""
    import pandas as pd

    values = np.column_stack(
        [pd.to_numeric(rows[name], errors="coerce").to_numpy(dtype=float) for name in names]
    )
    return np.where(np.isfinite(values) & (values > 0.0), values, np.nan)


def _numbers(logs: Array) -> Array:
    """Spearman's rho, dispersion and exponent of the first column against each other one.

    NaN where one does not vary.
    """
    from scipy.stats import rankdata

    ranks = rankdata(logs, axis=0)
    ranks -= ranks.mean(axis=0)
    centred = logs - logs.mean(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        size = np.sqrt(np.einsum("nk,nk->k", ranks, ranks))
        rho = (ranks[:, 0] @ ranks[:, 1:]) / (size[0] * size[1:])
        exponent = (centred[:, 0] @ centred[:, 1:]) / np.einsum(
            "nk,nk->k", centred[:, 1:], centred[:, 1:]
        )
    residual = centred[:, :1] - exponent * centred[:, 1:]
    dispersion = np.sqrt(np.einsum("nk,nk->k", residual, residual) / max(len(logs) - 2, 1))
    flat = ~np.isfinite(rho)
    found = np.column_stack([rho, dispersion, exponent])
    found[flat] = math.nan
    return found
