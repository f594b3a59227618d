"""Plots that several comparisons share: ours as a line over theirs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from railquake.plots.style import (
    BLACK,
    BLUE,
    ORANGE,
    RED,
    figure,
    label,
    legend,
    save,
    thinned,
)

__all__ = ["write_histories", "write_loops"]

Array = np.ndarray[Any, np.dtype[np.float64]]


def write_loops(
    loops: Sequence[tuple[str, Array, Array, Array]],
    labels: Sequence[tuple[str, str]],
    path: Path,
) -> Path:
    """Draw hysteresis loops side by side: their moments as dots, ours as a line.

    Parameters
    ----------
    loops : sequence of (str, array, array, array)
        Title, rotations, their moments and ours.
    labels : sequence of (str, str)
        Axis labels of each.
    path : Path
        PNG to write.
    """
    made, axes = figure(4.6 * len(loops), 4.0, 1, len(loops), squeeze=False)
    for ax, (title, x, theirs, ours), (x_label, y_label) in zip(
        axes[0], loops, labels, strict=True
    ):
        ax.plot(x[::5], theirs[::5], "o", color=ORANGE, markersize=3.2, label="OpenSees")
        ax.plot(x, ours, color=BLUE, linewidth=0.9, label="railquake")
        label(ax, x_label, y_label, title)
    legend(axes[0][0], loc="lower right")
    return save(made, path)


def write_histories(
    time: Array,
    histories: Sequence[tuple[str, Array, Array]],
    path: Path,
    *,
    reference: str = "OpenSees",
    window: tuple[float, float] | None = None,
) -> Path:
    """Draw histories one above the other, ours over theirs, and the difference in a last row.

    Parameters
    ----------
    time : array, shape (n,)
        s.
    histories : sequence of (str, array, array)
        Label with the unit, theirs and ours.
    path : Path
        PNG to write.
    reference : str
        Who theirs are.
    window : (float, float), optional
        Times that are drawn.
    """
    made, axes = figure(8.5, 1.75 * (len(histories) + 1), len(histories) + 1, 1, sharex=True)
    for k, (ax, (name, theirs, ours)) in enumerate(zip(axes, histories, strict=False)):
        ax.plot(*thinned(time, theirs), color=ORANGE, linewidth=2.6, label=reference)
        ax.plot(*thinned(time, ours), color=BLUE, linewidth=0.9, label="railquake")
        label(ax, "", name)
        if k == 0:
            legend(ax)
    for (name, theirs, ours), colour in zip(histories, (BLACK, RED, BLUE, ORANGE), strict=False):
        share = np.abs(ours - theirs) / np.abs(theirs).max()
        coarse = max(1, len(time) // 600)
        count = len(time) // coarse
        envelope = share[: count * coarse].reshape(count, coarse).max(axis=1)
        at = time[: count * coarse : coarse]
        axes[-1].plot(
            at, np.maximum(envelope, 1e-16), color=colour, linewidth=0.8, label=name.split(",")[0]
        )
    axes[-1].set_yscale("log")
    legend(axes[-1])
    label(axes[-1], "time, s", "difference / peak")
    if window is not None:
        axes[-1].set_xlim(*window)
    return save(made, path)
