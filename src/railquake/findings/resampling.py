"""The bootstrap that draws records, and quantities with intervals.

Runs of one record are not independent of each other: the same motion shakes the same bridge at
several levels and speeds.  Records are what was sampled, so records are drawn, with all their runs
(the cluster bootstrap; Davison & Hinkley 1997, *Bootstrap Methods and their Application*, 3.8).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import pandas as pd

__all__ = [
    "CONFIDENCE", "FEWEST_RECORDS", "FINISHED", "REPLICATES", "UNKNOWN", "Estimate",
    "drawn_records", "estimates", "finished",
]  # fmt: skip

Array = np.ndarray[Any, np.dtype[np.float64]]

CONFIDENCE = 0.95
REPLICATES = 1000
FEWEST_RECORDS = 5  # with fewer there is nothing to draw from
FINISHED = ("safe", "onset", "derailed")


@dataclass(frozen=True)
class Estimate:
    """A number with its 95 % interval; NaN where it is not known.

    Parameters
    ----------
    value : float
    low, high : float
        Percentiles of the bootstrap; NaN where there are too few records.
    """

    value: float
    low: float = math.nan
    high: float = math.nan

    @property
    def known(self) -> bool:
        """Whether there is a number."""
        return math.isfinite(self.value)

    @property
    def certain(self) -> bool:
        """Whether there is an interval as well."""
        return math.isfinite(self.low) and math.isfinite(self.high)

    def above(self, bound: float) -> bool:
        """Whether the whole interval lies above."""
        return self.certain and self.low > bound

    def below(self, bound: float) -> bool:
        """Whether the whole interval lies below."""
        return self.certain and self.high < bound


UNKNOWN = Estimate(math.nan)


def finished(table: pd.DataFrame) -> pd.DataFrame:
    """The runs that came to an end: neither diverged, nor failed, nor not converged."""
    return table[table["status"].isin(FINISHED)]


def drawn_records(records: Any, replicates: int = REPLICATES, seed: int = 0) -> list[Any]:
    """Rows of each bootstrap sample.

    Parameters
    ----------
    records : array_like, shape (n,)
        Which record each row has.
    replicates : int
    seed : int

    Returns
    -------
    list of array of int
        Empty if there are fewer than `FEWEST_RECORDS`.
    """
    labels = np.unique(np.asarray(records).astype(str), return_inverse=True)[1]
    count = int(labels.max()) + 1 if labels.size else 0
    if count < FEWEST_RECORDS:
        return []
    rows = [np.flatnonzero(labels == k) for k in range(count)]
    rng = np.random.default_rng(seed)
    chosen = rng.integers(0, count, size=(replicates, count))
    return [np.concatenate([rows[k] for k in sample]) for sample in chosen]


def estimates(
    statistic: Callable[[Any], Array], records: Any, replicates: int = REPLICATES, seed: int = 0
) -> list[Estimate]:
    """Several statistics of the same samples, with intervals.

    Parameters
    ----------
    statistic : callable
        Rows (array of int) -> values, shape (m,).
    records : array_like, shape (n,)
    replicates : int
    seed : int

    Returns
    -------
    list of Estimate
        Of length m.
    """
    values = statistic(np.arange(len(np.asarray(records))))
    samples = drawn_records(records, replicates, seed)
    if not samples:
        return [Estimate(float(value)) for value in values]
    found = np.array([statistic(rows) for rows in samples])
    tail = 50.0 * (1.0 - CONFIDENCE)
    result = []
    for value, column in zip(values, found.T, strict=True):
        known = column[np.isfinite(column)]
        # where many samples give no number, neither is the interval to be trusted
        if not math.isfinite(value) or known.size < 0.9 * column.size:
            result.append(Estimate(float(value)))
            continue
        low, high = np.percentile(known, [tail, 100.0 - tail])
        result.append(Estimate(float(value), float(low), float(high)))
    return result
