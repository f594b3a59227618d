"""Layers that several sections draw: the runs of each model against some quantity."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.report.chart import Points

if TYPE_CHECKING:
    import pandas as pd

    from railquake.report.context import Context, Look

__all__ = ["points", "runs"]


def runs(
    context: Context, models: list[str], x: str, y: str, *, fx: float = 1.0, fy: float = 1.0
) -> tuple[Points, ...]:
    """Each finished run of some models as a point; those without both values are left out."""
    layers = []
    for model in models:
        rows = context.of(model)
        drawn = points(
            context, rows, fx * rows[x].to_numpy(dtype=float), fy * rows[y].to_numpy(dtype=float),
            context.look(model),
        )  # fmt: skip
        if len(drawn.x):
            layers.append(drawn)
    return tuple(layers)


def points(context: Context, rows: pd.DataFrame, x: Any, y: Any, look: Look) -> Points:
    """Points with the run's number and words; where both are positive."""
    kept = np.isfinite(x) & np.isfinite(y) & (x > 0.0) & (y > 0.0)
    chosen = rows[kept]
    return Points(
        look.label, look.colour, x[kept], y[kept], chosen["row"].to_numpy(),
        context.words(chosen), look.symbol, look.open,
    )  # fmt: skip
