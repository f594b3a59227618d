"""The same record, level and speed under two models: ratios in pairs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.findings.resampling import REPLICATES, UNKNOWN, Estimate, estimates, finished

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["PairedComparison", "compare_models", "pairs_of"]

Array = np.ndarray[Any, np.dtype[np.float64]]

TIE = 1e-9  # of ln ratio
FEWEST_PAIRS = 5
SIGNIFICANT = 0.05
CLOSE = (0.95, 1.05)  # a median ratio that an engineer would call equal


@dataclass(frozen=True)
class PairedComparison:
    """Ratio of a quantity under one model to that under another, over all pairs.

    Attributes
    ----------
    quantity : str
        Column of the table.
    model, reference : str
        Numerator and denominator.
    pairs, records : int
        What it rests on.
    left_out : int
        Pairs without a ratio: one of the two is zero or not known.
    median, geometric_mean : Estimate
        Of the ratio; intervals draw records.
    scatter : float
        Standard deviation of ln ratio over the pairs: how far a single pair may be off.
    above, below, ties : int
        Pairs with a ratio above, below and equal to 1.
    p_value : float
        Sign test over the records (each counts by the median of its ratios, so that its runs are
        not counted as independent): how likely so uneven a split is if up and down are as likely.
        NaN without any record off 1.
    records_above, records_below : int
        What it rests on.
    p_value_pairs : float
        The same over all pairs as if they were independent: too small, for comparison only.
    missing : str
        Why there is no ratio; empty if there is.
    """

    quantity: str
    model: str
    reference: str
    pairs: int = 0
    records: int = 0
    left_out: int = 0
    median: Estimate = UNKNOWN
    geometric_mean: Estimate = UNKNOWN
    scatter: float = math.nan
    above: int = 0
    below: int = 0
    ties: int = 0
    p_value: float = math.nan
    records_above: int = 0
    records_below: int = 0
    p_value_pairs: float = math.nan
    missing: str = ""

    @property
    def direction(self) -> int:
        """1 up, -1 down, 0 not to be told: by the interval of the median, and the sign test."""
        if self.missing or not math.isfinite(self.p_value) or self.p_value >= SIGNIFICANT:
            return 0
        if self.median.above(1.0):
            return 1
        return -1 if self.median.below(1.0) else 0

    @property
    def close(self) -> bool:
        """Whether the median is what an engineer would call equal."""
        return CLOSE[0] <= self.median.value <= CLOSE[1]


def pairs_of(table: pd.DataFrame, quantity: str, model: str, reference: str) -> pd.DataFrame:
    """Runs of two models that differ in nothing else.

    Parameters
    ----------
    table : DataFrame
        Rows of a study with a column ``model``; what else the design has (all columns before
        ``scenario_hash``, row and scale apart) must agree within a pair.
    quantity : str
        Column.
    model, reference : str
        Values of ``model``.

    Returns
    -------
    DataFrame
        The design's columns, ``x`` (reference), ``y`` (model), ``row_x``, ``row_y``.
    """
    import pandas as pd

    keys = _keys(table)
    rows = finished(table)
    sides = {}
    for side, name in (("x", reference), ("y", model)):
        part = rows.loc[rows["model"] == name, [*keys, "row", quantity]]
        part = part.rename(columns={"row": f"row_{side}", quantity: side})
        part[side] = pd.to_numeric(part[side], errors="coerce")
        sides[side] = part.drop_duplicates(keys)
    return sides["x"].merge(sides["y"], on=keys, how="inner")


def _keys(table: pd.DataFrame) -> list[str]:
    names = list(table.columns)
    end = names.index("scenario_hash") if "scenario_hash" in names else 0
    design = names[:end] or [n for n in ("record", "level", "vehicle.speed") if n in names]
    return [name for name in design if name not in ("row", "scale", "model")]


def compare_models(
    table: pd.DataFrame,
    quantity: str,
    model: str,
    reference: str,
    *,
    replicates: int = REPLICATES,
    seed: int = 0,
) -> PairedComparison:
    """Ratio of a quantity under a model to that under a reference, in pairs.

    Parameters
    ----------
    table : DataFrame
        Rows of a study; runs that did not come to an end are left aside.
    quantity : str
        Column.
    model, reference : str
        Values of the column ``model``.
    replicates, seed : int
        Of the bootstrap.

    Returns
    -------
    PairedComparison
        With ``missing`` told where there is nothing to compare.
    """
    from scipy.stats import binomtest

    nothing = PairedComparison(quantity, model, reference)
    if "model" not in table:
        return _because(nothing, "the study has no axis of models")
    for name in (model, reference):
        if not (table["model"] == name).any():
            return _because(nothing, f"the study has no model {name}")
    if quantity not in table:
        return _because(nothing, f"the table has no {quantity}")
    pairs = pairs_of(table, quantity, model, reference)
    x, y = pairs["x"].to_numpy(dtype=float), pairs["y"].to_numpy(dtype=float)
    kept = (x > 0.0) & (y > 0.0) & np.isfinite(x) & np.isfinite(y)
    ratio = np.log(y[kept] / x[kept])
    left_out = int((~kept).sum())
    if ratio.size < FEWEST_PAIRS:
        return _because(nothing, f"only {ratio.size} pairs of runs have a ratio")
    records = pairs["record"].to_numpy()[kept]

    def statistic(at: Any) -> Array:
        return np.exp(np.array([np.median(ratio[at]), np.mean(ratio[at])]))

    median, mean = estimates(statistic, records, replicates, seed)
    names = sorted(set(records))
    of_record = np.array([np.median(ratio[records == name]) for name in names])
    up, down = int((of_record > TIE).sum()), int((of_record < -TIE).sum())
    above, below = int((ratio > TIE).sum()), int((ratio < -TIE).sum())

    def test(one: int, other: int) -> float:
        return float(binomtest(one, one + other).pvalue) if one + other else math.nan

    return PairedComparison(
        quantity, model, reference, ratio.size, len(names), left_out, median, mean,
        float(np.std(ratio, ddof=1)), above, below, ratio.size - above - below,
        test(up, down), up, down, test(above, below),
    )  # fmt: skip


def _because(nothing: PairedComparison, reason: str) -> PairedComparison:
    from dataclasses import replace

    return replace(nothing, missing=reason)
