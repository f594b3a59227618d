"""One look for all pictures: figures, palette, labels, thinned lines.

Everything is set figure by figure; matplotlib's global settings are neither read for the layout
nor changed, so that pictures can be drawn in any thread.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = np.ndarray[Any, np.dtype[np.float64]]

# Okabe and Ito's palette, told apart by colour-blind readers too
BLUE, ORANGE, GREEN, RED, PURPLE, SKY = (
    "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9",
)  # fmt: skip
BLACK, FAINT, GREY, PALE = "#1a1a1a", "#4d4d4d", "#7f7f7f", "#e5e5e5"
COLUMNS = 1000  # a line is thinned to its extremes in so many columns
DPI = 110
LONGEST = 70  # characters of a text from a file that are shown


def blank(width: float, height: float) -> Figure:
    """A figure without axes, inches."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), dpi=DPI, facecolor="white")


def figure(width: float, height: float, rows: int = 1, columns: int = 1, **options: Any) -> Any:
    """A figure and its axes in rows and columns, laid out by matplotlib (slow but easy)."""
    made = blank(width, height)
    made.set_layout_engine("constrained")
    axes = made.subplots(rows, columns, **options)
    for ax in np.ravel(axes):
        dress(ax)
    return made, axes


def dress(ax: Axes, *, grid: bool = True) -> Axes:
    """Give axes the common look."""
    ax.spines[["top", "right"]].set_visible(False)
    if grid:
        ax.grid(visible=True, color=PALE, linewidth=0.6)
        ax.set_axisbelow(True)
    ax.tick_params(labelsize=8)
    return ax


def stack(
    heights: list[float], width: float = 8.5, *, left: float = 0.95, right: float = 0.2,
    top: float = 0.78, gaps: float | Sequence[float] = 0.3, share: bool = True,
) -> tuple[Figure, list[Axes]]:  # fmt: skip
    """A figure with axes one above the other; all lengths in inches.

    Margins are given instead of found: finding them takes longer than drawing.
    """
    bottom = 0.5
    between = [gaps] * (len(heights) - 1) if isinstance(gaps, float) else list(gaps)
    total = sum(heights) + sum(between) + top + bottom
    made = blank(width, total)
    axes: list[Axes] = []
    upper = total - top
    for height, gap in zip(heights, [*between, 0.0], strict=True):
        place = (left / width, (upper - height) / total, 1 - (left + right) / width, height / total)
        ax = made.add_axes(place, sharex=axes[0] if share and axes else None)
        axes.append(dress(ax))
        upper -= height + gap
    if share:
        for ax in axes[:-1]:
            ax.tick_params(labelbottom=False)
    for ax in axes:
        ax.yaxis.set_label_coords((0.08 - left) / (width - left - right), 0.5)
        ax.yaxis.label.set_verticalalignment("top")  # further lines grow towards the axes
    return made, axes


def plain(text: str) -> str:
    """Text from a file: no character of it is read as a formula, none is missing from the font."""
    shown = text if len(text) <= LONGEST else f"{text[: LONGEST - 1]}…"
    known = _characters()
    shown = "".join(c if ord(c) in known else "?" for c in shown)
    return shown.replace("$", r"\$")


@lru_cache(maxsize=1)
def _characters() -> frozenset[int]:
    from matplotlib.font_manager import FontProperties, findfont, get_font

    return frozenset(get_font(findfont(FontProperties())).get_charmap()) - {10, 13}


def heading(made: Figure, text: str, *lines: str) -> None:
    """The figure's title, to the left, and smaller lines below; texts are `plain` already."""
    width, height = made.get_figwidth(), made.get_figheight()
    left = 0.1 / width
    made.text(left, 1.0 - 0.08 / height, text, fontsize=11, va="top", color=BLACK)
    for k, line in enumerate(lines):
        top = 1.0 - (0.3 + 0.165 * k) / height
        made.text(left, top, line, fontsize=8.5, va="top", color=FAINT)


def label(ax: Axes, x: str = "", y: str = "", title: str = "") -> None:
    """Axis labels and a title to the left."""
    if x:
        ax.set_xlabel(x, fontsize=9)
    if y:
        ax.set_ylabel(y, fontsize=9)
    if title:
        ax.set_title(title, fontsize=9, loc="left", pad=4.0)


def legend(ax: Axes, **options: Any) -> None:
    """A legend above the axes, to the right, where it covers nothing; or at ``loc`` within."""
    above = {"loc": "lower right", "bbox_to_anchor": (1.0, 0.98), "borderaxespad": 0.0, "ncols": 6}
    place = options if "loc" in options else above | options
    ax.legend(fontsize=8, frameon=False, handlelength=1.6, columnspacing=1.4, **place)


def thinned(time: Array, values: Array) -> tuple[Array, Array]:
    """The line's lowest and highest value in each of `COLUMNS` columns, in their order.

    Values that are not finite make a gap in the line: a train that has left the track has no place.
    """
    if len(time) <= 4 * COLUMNS:
        return time, values
    size = len(time) // COLUMNS
    count = len(time) // size
    body = values[: count * size].reshape(count, size)
    known = np.isfinite(body)
    first = size * np.arange(count)
    low = first + np.argmin(np.where(known, body, np.inf), axis=1)
    high = first + np.argmax(np.where(known, body, -np.inf), axis=1)
    rest = np.arange(count * size, len(time))
    gaps = np.flatnonzero(np.diff(np.isfinite(values)))
    keep = np.unique(np.concatenate([[0], low, high, gaps, gaps + 1, rest]))
    return time[keep], values[keep]


def note_peak(ax: Axes, time: Array, values: Array, unit: str) -> None:
    """Mark the largest absolute value and write it above the axes, to the right."""
    if not np.isfinite(values).any():
        return
    at = int(np.nanargmax(np.abs(values)))
    ax.plot(time[at], values[at], "o", color=BLACK, markersize=3.0, zorder=5)
    remark(ax, f"peak {signed(values[at])} {unit} at {time[at]:.2f} s", right=True)


def remark(ax: Axes, text: str, *, right: bool = False) -> None:
    """A remark above the axes."""
    ax.text(
        1.0 if right else 0.0, 1.02, text, fontsize=8, ha="right" if right else "left",
        va="bottom", color=FAINT, transform=ax.transAxes,
    )  # fmt: skip


def signed(value: float, digits: int = 3) -> str:
    """A number with a true minus sign, without an exponent where it is large."""
    value += 0.0  # no negative zero
    large = abs(value) >= 10.0 ** (digits - 1)
    text = f"{value:.0f}" if large else f"{value:#.{digits}g}"
    return text.replace("-", "\u2212")


def filled(ax: Axes, y: Array, z: Array, **style: Any) -> None:
    """A filled outline, where the axes' limits are set anyway (finding them is slow)."""
    from matplotlib.collections import PolyCollection

    shown: dict[str, Any] = {"edgecolor": "none", "linewidth": 0.0} | style
    ax.add_collection(PolyCollection([np.column_stack([y, z])], **shown), autolim=False)


def save(made: Figure, path: Path) -> Path:
    """Write the figure as PNG."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    FigureCanvasAgg(made)
    made.savefig(path, format="png")
    return path
