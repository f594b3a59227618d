"""A chart as a PNG file (matplotlib, the project's style) and as a CSV file."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.messages import csv_cell
from railquake.plots.style import BLACK, FAINT, blank, dress, heading, plain, save
from railquake.report.chart import Band, Chart, Layer, Line, Panel, Points, Rule, limits

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["csv_text", "write_png"]

MARKERS = {"circle": "o", "square": "s", "diamond": "D", "cross": "X", "triangle-up": "^"}
STYLES = {"solid": "-", "dashed": "--", "dotted": ":"}
WIDTH, HEIGHT = 4.9, 4.0  # of a panel, inches
LEFT, RIGHT, BOTTOM, TOP = 0.72, 0.18, 0.55, 0.42
HEAD, LEGEND = 0.36, 0.24


def write_png(chart: Chart, path: Path) -> Path:
    """Draw the chart."""
    columns = min(chart.columns, len(chart.panels))
    rows = math.ceil(len(chart.panels) / columns)
    entries = _legend_entries(chart)
    legend_rows = math.ceil(len(entries) / max(1, int(2.1 * columns)))
    head = HEAD + LEGEND * legend_rows
    width, height = columns * WIDTH, rows * HEIGHT + head
    made = blank(width, height)
    handles: dict[str, Any] = {}
    for k, panel in enumerate(chart.panels):
        row, column = divmod(k, columns)
        place = (
            (column * WIDTH + LEFT) / width,
            (height - head - (row + 1) * HEIGHT + BOTTOM) / height,
            (WIDTH - LEFT - RIGHT) / width,
            (HEIGHT - BOTTOM - TOP) / height,
        )
        ax = dress(made.add_axes(place))
        _draw(ax, panel, handles)
    heading(made, plain(chart.title))
    shown = [handles[name] for name in entries if name in handles]
    if shown:
        made.legend(
            shown, [plain(name) for name in entries if name in handles], loc="upper left",
            bbox_to_anchor=(0.06 / width, 1.0 - 0.27 / height), ncols=max(1, int(2.1 * columns)),
            fontsize=8, frameon=False, handlelength=1.6, columnspacing=1.6, borderaxespad=0.0,
        )  # fmt: skip
    return save(made, path)


def _legend_entries(chart: Chart) -> list[str]:
    names: dict[str, None] = {}
    for panel in chart.panels:
        for layer in panel.layers:
            if isinstance(layer, Points) or (isinstance(layer, Line) and layer.in_legend):
                names[layer.label] = None
    return list(names)


def _draw(ax: Axes, panel: Panel, handles: dict[str, Any]) -> None:
    if panel.log_x:
        ax.set_xscale("log")
    if panel.log_y:
        ax.set_yscale("log")
    x_range, y_range = limits(panel)
    ax.set_xlim(*x_range)
    ax.set_ylim(*y_range)
    for layer in panel.layers:
        drawn = _layer(ax, layer, panel)
        if drawn is not None and not isinstance(layer, Rule | Band):
            handles.setdefault(layer.label, drawn)
    _plain_decades(ax, panel)
    if panel.y_ticks:
        ax.set_yticks([value for value, _ in panel.y_ticks], [plain(n) for _, n in panel.y_ticks])
    ax.set_xlabel(plain(panel.x_label), fontsize=9)
    ax.set_ylabel(plain(panel.y_label), fontsize=9)
    title = "\n".join(plain(line) for line in panel.title.split("\n"))
    ax.set_title(title, fontsize=9, loc="left", pad=5.0)


def _plain_decades(ax: Axes, panel: Panel) -> None:
    """Numbers such as 0.02 instead of powers where a logarithmic axis spans few decades."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

    for axis, log, span in (
        (ax.xaxis, panel.log_x, ax.get_xlim()),
        (ax.yaxis, panel.log_y, ax.get_ylim()),
    ):
        if not log:
            continue
        decades = math.log10(span[1] / span[0])
        if decades <= 2.2:
            digits = (1.0, 2.0, 5.0) if decades > 0.9 else tuple(float(k) for k in range(1, 10))
            axis.set_major_locator(LogLocator(subs=digits))
        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        axis.set_minor_locator(LogLocator(subs=tuple(float(k) for k in range(1, 10))))
        axis.set_minor_formatter(NullFormatter())


def _layer(ax: Axes, layer: Layer, panel: Panel) -> Any:
    if isinstance(layer, Points):
        face = "none" if layer.open else layer.colour
        return ax.scatter(
            layer.x, layer.y, s=0.75 * layer.size**2, c=face, edgecolors=layer.colour,
            linewidths=0.8 if layer.open else 0.0, alpha=0.75, marker=MARKERS[layer.symbol],
            zorder=3,
        )  # fmt: skip
    if isinstance(layer, Line):
        (drawn,) = ax.plot(
            layer.x, layer.y, color=layer.colour, linewidth=0.8 * layer.width,
            linestyle=STYLES[layer.dash], alpha=layer.opacity, zorder=2.5,
        )  # fmt: skip
        return drawn
    if isinstance(layer, Band):
        return ax.fill_between(
            layer.x, layer.low, layer.high, color=layer.colour, alpha=0.16, linewidth=0.0
        )
    _rule(ax, layer, panel)
    return None


def _rule(ax: Axes, layer: Rule, panel: Panel) -> None:
    style: dict[str, Any] = {"color": BLACK, "linewidth": 0.9, "linestyle": ":", "zorder": 1.5}
    text: dict[str, Any] = {"fontsize": 8, "color": FAINT, "zorder": 4}
    label = plain(layer.text)
    if layer.diagonal is not None:
        low, high = ax.get_xlim()
        x = np.array([max(low, 1e-300) if panel.log_x else low, high])
        ax.plot(x, layer.diagonal * x, **style)
        at = low * (high / low) ** 0.8 if panel.log_x else low + 0.8 * (high - low)
        ax.text(at, layer.diagonal * at, f" {label}", va="top", ha="left", clip_on=True, **text)
    elif layer.y is not None:
        ax.axhline(layer.y, **style)
        ax.text(0.01, layer.y, label, va="bottom", transform=ax.get_yaxis_transform(), **text)
    elif layer.x is not None:
        ax.axvline(layer.x, **style)
        far = ax.transAxes.inverted().transform(
            ax.transData.transform((layer.x, ax.get_ylim()[1]))
        )[0]
        side = "right" if far > 0.6 else "left"
        ax.text(
            layer.x,
            0.99,
            f" {label} ",
            va="top",
            ha=side,
            transform=ax.get_xaxis_transform(),
            **text,
        )


def csv_text(chart: Chart) -> str:
    """All that the chart shows, a line a point."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["panel", "series", "kind", "x_label", "y_label", "x", "y", "y_high", "row",
                     "remark"])  # fmt: skip
    for panel in chart.panels:
        for layer in panel.layers:
            if isinstance(layer, Rule):
                continue
            name = [csv_cell(panel.title), csv_cell(layer.label)]
            labels = [csv_cell(panel.x_label), csv_cell(panel.y_label)]
            if isinstance(layer, Band):
                for x, low, high in zip(layer.x, layer.low, layer.high, strict=True):
                    writer.writerow([*name, "band", *labels, _g(x), _g(low), _g(high), "", ""])
            elif isinstance(layer, Line):
                for x, y in zip(layer.x, layer.y, strict=True):
                    writer.writerow([*name, "line", *labels, _g(x), _g(y), "", "", ""])
            else:
                for x, y, row, text in zip(
                    layer.x, layer.y, np.asarray(layer.rows), layer.texts, strict=True
                ):
                    writer.writerow(
                        [*name, "point", *labels, _g(x), _g(y), "", int(row), csv_cell(text)]
                    )
    return out.getvalue()


def _g(value: float) -> str:
    return f"{value:.7g}" if math.isfinite(value) else ""
