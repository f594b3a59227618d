"""Charts described once: drawn by Plotly in the page, by matplotlib as PNG, and written as CSV.

A chart is a row of panels; a panel holds layers (points, lines, bands, reference lines).  What is
drawn and what is written is therefore the same by construction.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

__all__ = ["Band", "Chart", "Layer", "Line", "Panel", "Points", "Rule"]

Array = np.ndarray[Any, np.dtype[np.float64]]

MOST_POINTS = 6000  # of a chart that are drawn; the CSV has all


@dataclass(frozen=True, eq=False)
class Points:
    """Runs, each a point.

    Parameters
    ----------
    label : str
        In the legend.
    colour, symbol : str
        Colour ``#rrggbb``; ``circle``, ``square``, ``diamond``, ``cross`` or ``triangle-up``.
    x, y : array, shape (n,)
    rows : array of int, shape (n,)
        Numbers of the runs, for the command that reruns them; -1 for none.
    texts : sequence of str
        What else to show on hover, plain text.
    open : bool
        Whether only the outline is drawn.
    """

    label: str
    colour: str
    x: Array
    y: Array
    rows: Any
    texts: list[str]
    symbol: str = "circle"
    open: bool = False
    size: float = 5.0


@dataclass(frozen=True, eq=False)
class Line:
    """A curve; NaN makes a gap."""

    label: str
    colour: str
    x: Array
    y: Array
    dash: str = "solid"
    width: float = 1.8
    in_legend: bool = True
    opacity: float = 1.0


@dataclass(frozen=True, eq=False)
class Band:
    """The area between two curves."""

    label: str
    colour: str
    x: Array
    low: Array
    high: Array


@dataclass(frozen=True)
class Rule:
    """A straight reference: ``y`` or ``x`` constant, or the diagonal y = factor x."""

    text: str = ""
    x: float | None = None
    y: float | None = None
    diagonal: float | None = None


Layer = Points | Line | Band | Rule


@dataclass(frozen=True, eq=False)
class Panel:
    """One pair of axes.

    Parameters
    ----------
    title, x_label, y_label : str
    layers : tuple of Layer
    log_x, log_y : bool
    x_range, y_range : (float, float), optional
        In the units of the axes, also where they are logarithmic.
    square : bool
        Whether both axes have the same range (for one quantity against itself).
    y_ticks : tuple of (float, str)
        Names instead of numbers along y.

    Notes
    -----
    A title may have a second line, after a line feed.
    """

    title: str
    x_label: str
    y_label: str
    layers: tuple[Layer, ...]
    log_x: bool = False
    log_y: bool = False
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    square: bool = False
    y_ticks: tuple[tuple[float, str], ...] = ()


@dataclass(frozen=True, eq=False)
class Chart:
    """A figure of the report.

    Parameters
    ----------
    name : str
        Of its files.
    title : str
    caption : str
        What one sees; plain text.
    panels : tuple of Panel
    columns : int
        Panels side by side where there is room.
    """

    name: str
    title: str
    caption: str
    panels: tuple[Panel, ...]
    columns: int = 2
    notes: tuple[str, ...] = field(default=())

    @property
    def points(self) -> int:
        """Number of points."""
        return sum(
            len(layer.x) for panel in self.panels for layer in panel.layers
            if isinstance(layer, Points)
        )  # fmt: skip


def limits(panel: Panel) -> tuple[tuple[float, float], tuple[float, float]]:
    """Ranges of x and y that hold all points, lines and bands, with a margin."""
    xs: list[Array] = []
    ys: list[Array] = []
    for layer in panel.layers:
        if isinstance(layer, Rule):
            xs.append(np.array([] if layer.x is None else [layer.x], dtype=float))
            ys.append(np.array([] if layer.y is None else [layer.y], dtype=float))
        elif isinstance(layer, Band):
            xs.append(np.asarray(layer.x, dtype=float))
            ys += [np.asarray(layer.low, dtype=float), np.asarray(layer.high, dtype=float)]
        else:
            xs.append(np.asarray(layer.x, dtype=float))
            ys.append(np.asarray(layer.y, dtype=float))
    if panel.square:
        xs = ys = xs + ys
    x = panel.x_range or _reach(np.concatenate([*xs, []]), panel.log_x)
    y = panel.y_range or _reach(np.concatenate([*ys, []]), panel.log_y)
    return x, y


def _reach(values: Array, log: bool) -> tuple[float, float]:
    known = values[np.isfinite(values) & ((values > 0.0) | (not log))]
    if not known.size:
        return (0.1, 10.0) if log else (0.0, 1.0)
    low, high = float(known.min()), float(known.max())
    if log:
        margin = max((high / low) ** 0.06, 1.15)
        return low / margin, high * margin
    if low >= 0.0 and low < 0.4 * high:
        return 0.0 if low > 0.0 else -0.03 * high, high * 1.06 or 1.0
    span = (high - low) or abs(high) or 1.0
    return low - 0.06 * span, high + 0.06 * span
