"""One look for all pictures."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = np.ndarray[Any, np.dtype[np.float64]]

# Okabe and Ito's palette, told apart by colour-blind readers too
BLUE, ORANGE, GREEN, RED, PURPLE, GREY = (
    "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#7f7f7f",
)  # fmt: skip
COLUMNS = 1500  # a line is thinned to its extremes in so many columns


def figure(
    width: float,
    height: float,
    rows: int = 1,
    columns: int = 1,
    *,
    right: float = 0.15,
    wspace: float = 0.25,
    **options: Any,
) -> Any:
    """A figure and its axes, with fixed margins: to find them takes longer than to draw.

    ``right`` is the right margin in inches, wider where an axis or a colour bar stands there.
    """
    from matplotlib.figure import Figure

    made: Figure = Figure(figsize=(width, height), dpi=110)
    axes = made.subplots(rows, columns, **options)
    made.subplots_adjust(
        left=(0.98 if rows > 1 else 0.7) / width,
        bottom=0.5 / height,
        right=1.0 - right / width,
        top=1.0 - 0.6 / height,
        hspace=0.22 if columns == 1 and options.get("sharex") else 0.35,
        wspace=wspace,
    )
    for ax in np.ravel(axes):
        ax.spines[["top", "right"]].set_visible(False)
        ax.grid(visible=True, color="#e5e5e5", linewidth=0.6)
        ax.set_axisbelow(True)
        ax.tick_params(labelsize=8)
    return made, axes


def plain(text: str) -> str:
    """Text from a file, so that no character of it is read as a formula."""
    return text.replace("$", r"\$")


def label(ax: Axes, x: str = "", y: str = "", title: str = "") -> None:
    """Axis labels and a title to the left."""
    if x:
        ax.set_xlabel(x, fontsize=9)
    if y:
        ax.set_ylabel(y, fontsize=9)
    if title:
        ax.set_title(title, fontsize=9, loc="left")


def legend(ax: Axes, **options: Any) -> None:
    """A legend that stays out of the way."""
    ax.legend(fontsize=8, frameon=False, **options)


def thinned(time: Array, values: Array) -> tuple[Array, Array]:
    """The line's lowest and highest value in each of `COLUMNS` columns, in their order."""
    if len(time) <= 4 * COLUMNS:
        return time, values
    edges = np.linspace(0, len(time), COLUMNS + 1).astype(int)
    parts = list(pairwise(edges))
    known = np.isfinite(values)  # a train that has left the track has no place
    lower, upper = np.where(known, values, np.inf), np.where(known, values, -np.inf)
    low = [a + int(np.argmin(lower[a:b])) for a, b in parts]
    high = [a + int(np.argmax(upper[a:b])) for a, b in parts]
    keep = np.unique(np.concatenate([[0], low, high, [len(time) - 1]]))
    return time[keep], values[keep]


def save(made: Figure, path: Path) -> Path:
    """Write the figure as PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(made)
    made.savefig(path, format="png")
    return path
