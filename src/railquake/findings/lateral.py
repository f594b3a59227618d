"""Where the lateral force of the train on the track levels off (the paper's Figure 10)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.findings.resampling import REPLICATES, UNKNOWN, Estimate, estimates, finished

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["LevelOff", "force_ratio", "level_off"]

Array = np.ndarray[Any, np.dtype[np.float64]]

FEWEST_RUNS = 12
FEWEST_BEYOND = 5  # runs on either side of the knee
KNEES = 25  # tried along the measure
SLOWER = 0.8
ANY_LEVEL = 0.25  # of the slope before the knee: flatter than that it has levelled off


def force_ratio(table: pd.DataFrame, friction: Any = None) -> Any:
    """Peak filtered lateral force over friction times the train's weight.

    Parameters
    ----------
    table : DataFrame
        Rows of a study.
    friction : float or array_like, optional
        mu, of all runs or of each; by default the rows' own.

    Returns
    -------
    array, shape (runs,)
        NaN where mu is not known.
    """
    if friction is None:
        friction = table.get("friction", math.nan)
    weight = 2.0 * table["wheel_load_static_n"].to_numpy(dtype=float)
    force = table["lateral_force_filtered_peak_n"].to_numpy(dtype=float)
    return force / (np.asarray(friction, dtype=float) * weight)


@dataclass(frozen=True)
class LevelOff:
    """Two straight lines in ln force ratio against ln measure, joined at a knee.

    Attributes
    ----------
    measure : str
        Column that the force is held against.
    runs, records : int
    knee : Estimate
        Of the measure, in its unit.
    level : Estimate
        Median force ratio beyond the knee.
    slope_before, slope_beyond : Estimate
        Exponents; 1 means in proportion, 0 that the force is capped.
    scatter : Estimate
        Standard deviation of the ln force ratio about the lines.
    highest : float
        Largest force ratio of all runs.
    missing : str
        Why there is none of this; empty if there is.
    """

    measure: str
    runs: int = 0
    records: int = 0
    knee: Estimate = UNKNOWN
    level: Estimate = UNKNOWN
    slope_before: Estimate = UNKNOWN
    slope_beyond: Estimate = UNKNOWN
    scatter: Estimate = UNKNOWN
    highest: float = math.nan
    missing: str = ""

    @property
    def levels_off(self) -> bool:
        """Whether the force grows, beyond the knee, at less than a quarter of the rate before."""
        return (
            self.slope_beyond.known
            and self.slope_beyond.value < ANY_LEVEL * self.slope_before.value
        )

    @property
    def slows(self) -> bool:
        """Whether it grows clearly more slowly beyond: by a fifth, and the intervals are apart."""
        return (
            self.slope_beyond.value < SLOWER * self.slope_before.value
            and self.slope_beyond.high < self.slope_before.low
        )


def level_off(
    table: pd.DataFrame,
    ratio: Any,
    measure: str = "pba_m_s2",
    *,
    replicates: int = REPLICATES // 2,
    seed: int = 0,
) -> LevelOff:
    """Fit two joined lines to the force ratio against a measure.

    Parameters
    ----------
    table : DataFrame
        Rows of a study; runs that did not come to an end are left aside.
    ratio : array_like, shape (runs,)
        See `force_ratio`.
    measure : str
        Column.
    replicates, seed : int
        Of the bootstrap.

    Returns
    -------
    LevelOff
        With ``missing`` told where the runs are too few or too much alike.

    Notes
    -----
    ``ln y = a + b1 min(u - k, 0) + b2 max(u - k, 0)``, u = ln x: least squares for each of 25 knees
    k between the runs' 10 and 90 % quantiles, and the best of them.  What levels off grows more
    slowly beyond: where a knee asks for b2 > b1, a single straight line stands in its place.
    """
    rows = table["status"].isin(("safe", "onset", "derailed")).to_numpy()
    x = table[measure].to_numpy(dtype=float)[rows]
    y = np.asarray(ratio, dtype=float)[rows]
    records = finished(table)["record"].to_numpy()
    kept = (x > 0.0) & (y > 0.0) & np.isfinite(x) & np.isfinite(y)
    u, v, records = np.log(x[kept]), np.log(y[kept]), records[kept]
    nothing = LevelOff(measure, len(u), len(set(records)))
    if len(u) < FEWEST_RUNS or np.unique(u).size < FEWEST_RUNS:
        return LevelOff(measure, len(u), nothing.records, missing=f"only {len(u)} runs")

    def statistic(at: Any) -> Array:
        return _two_lines(u[at], v[at])

    knee, level, before, beyond, scatter = estimates(statistic, records, replicates, seed)
    return LevelOff(
        measure, len(u), nothing.records, knee, level, before, beyond, scatter,
        float(np.exp(v.max())),
    )  # fmt: skip


def _two_lines(u: Array, v: Array) -> Array:
    """Knee, level, slopes, scatter; NaN where the runs do not spread."""
    low, high = np.quantile(u, [0.1, 0.9])
    if not high > low:
        return np.full(5, math.nan)
    knees = np.linspace(low, high, KNEES)
    below = np.minimum(u[None, :] - knees[:, None], 0.0)
    above = np.maximum(u[None, :] - knees[:, None], 0.0)
    design = np.stack([np.ones_like(below), below, above], axis=-1)
    normal = np.einsum("kni,knj->kij", design, design) + 1e-12 * np.eye(3)
    found = np.linalg.solve(normal, np.einsum("kni,n->ki", design, v)[..., None])[..., 0]
    steeper = found[:, 2] > found[:, 1]
    if steeper.any():
        slope, offset = np.polyfit(u, v, 1)
        found[steeper] = np.column_stack(
            [offset + slope * knees, np.full(KNEES, slope), np.full(KNEES, slope)]
        )[steeper]
    left = v - np.einsum("kni,ki->kn", design, found)
    squares = np.einsum("kn,kn->k", left, left)
    enough = ((above > 0.0).sum(axis=1) >= FEWEST_BEYOND) & (
        (below < 0.0).sum(axis=1) >= FEWEST_BEYOND
    )
    if not enough.any():
        return np.full(5, math.nan)
    k = int(np.argmin(np.where(enough, squares, np.inf)))
    level = math.exp(float(np.median(v[u > knees[k]])))
    scatter = math.sqrt(float(squares[k]) / max(len(u) - 4, 1))
    return np.array([math.exp(knees[k]), level, found[k, 1], found[k, 2], scatter])
