"""A chart as Plotly's traces and layouts: plain dictionaries, numbers rounded, texts escaped."""

from __future__ import annotations

import html
import math
from typing import Any

import numpy as np

from railquake.report.chart import MOST_POINTS, Band, Chart, Line, Panel, Points, Rule, limits

__all__ = ["figures_of"]

DIGITS = 4  # significant digits of a number in the page
DASHES = {"solid": "solid", "dashed": "dash", "dotted": "dot"}
FONT = {"family": "system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif", "size": 12}
INK, FAINT, PALE = "#1a1a1a", "#4d4d4d", "#e5e5e5"


def figures_of(chart: Chart) -> list[dict[str, Any]]:
    """One dictionary of ``data`` and ``layout`` for each panel."""
    share = max(1, math.ceil(chart.points / MOST_POINTS))
    return [_figure(panel, share) for panel in chart.panels]


def _figure(panel: Panel, share: int) -> dict[str, Any]:
    data: list[dict[str, Any]] = []
    shapes: list[dict[str, Any]] = []
    notes: list[dict[str, Any]] = []
    x_range, y_range = limits(panel)
    for layer in panel.layers:
        if isinstance(layer, Points):
            data.append(_points(layer, panel, share))
        elif isinstance(layer, Line):
            data.append(_line(layer))
        elif isinstance(layer, Band):
            data.append(_band(layer))
        else:
            shapes.append(_rule(layer, x_range, y_range))
            if layer.text:
                notes.append(_rule_text(layer, panel, x_range, y_range))
    layout = {
        "font": {**FONT, "color": FAINT},
        "margin": {"l": 62, "r": 14, "t": 56 if "\n" in panel.title else 34, "b": 50},
        "height": 380,
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "showlegend": False,
        "hovermode": "closest",
        "hoverlabel": {"align": "left", "bgcolor": "white", "font": {**FONT, "color": INK}},
        "title": {
            "text": _title(panel.title), "x": 0.0, "xref": "paper", "xanchor": "left", "y": 1.0,
            "yref": "paper", "yanchor": "bottom", "pad": {"b": 24 if "\n" in panel.title else 8},
            "font": {"size": 13, "color": INK},
        },
        "xaxis": _axis(panel.x_label, panel.log_x, x_range),
        "yaxis": _axis(panel.y_label, panel.log_y, y_range) | _names(panel),
        "shapes": shapes,
        "annotations": notes,
    }  # fmt: skip
    return {"data": data, "layout": layout}


def _names(panel: Panel) -> dict[str, Any]:
    if not panel.y_ticks:
        return {}
    return {
        "tickvals": [value for value, _ in panel.y_ticks],
        "ticktext": [_text(name) for _, name in panel.y_ticks],
    }


def _title(text: str) -> str:
    first, _, second = text.partition("\n")
    small = f'<br><span style="font-size:10px">{_text(second)}</span>' if second else ""
    return _text(first) + small


def _axis(label: str, log: bool, span: tuple[float, float]) -> dict[str, Any]:
    low, high = (math.log10(value) for value in span) if log else span
    axis = {
        "title": {"text": _text(label), "standoff": 6, "font": {"size": 12}},
        "range": [_round(low), _round(high)],
        "gridcolor": PALE,
        "zeroline": False,
        "linecolor": "#7f7f7f",
        "ticks": "outside",
        "ticklen": 4,
        "tickcolor": "#7f7f7f",
        "automargin": True,
        "tickfont": {"size": 11},
    }
    if log:
        axis["type"] = "log"
        decades = high - low
        axis["dtick"] = 1 if decades > 2.2 else "D2" if decades > 0.9 else "D1"
        axis["minor"] = {"showgrid": False, "ticks": "outside", "ticklen": 2, "dtick": "D1"}
        axis["tickformat"] = "~g"
    return axis


def _points(layer: Points, panel: Panel, share: int) -> dict[str, Any]:
    at = slice(None, None, share)
    rows = [int(row) for row in np.asarray(layer.rows)[at]]
    marker = {
        "color": layer.colour, "size": layer.size, "symbol": layer.symbol, "opacity": 0.75,
        "line": {"width": 0},
    }  # fmt: skip
    if layer.open:
        marker["symbol"] = f"{layer.symbol}-open"
        marker["line"] = {"width": 1.2, "color": layer.colour}
    template = (
        "<b>%{text}</b><extra></extra>"
        if max(rows, default=-1) < 0
        else (
            "<b>%{text}</b><br>x %{x:.4~g}, y %{y:.4~g}"
            "<br>%{meta[0]} %{customdata} %{meta[1]}<extra></extra>"
        )
    )
    return {
        "type": "scatter", "mode": "markers", "name": _text(layer.label),
        "x": _numbers(layer.x[at]), "y": _numbers(layer.y[at]), "customdata": rows,
        "text": [_text(text) for text in layer.texts[at]], "marker": marker,
        "hovertemplate": template,
    }  # fmt: skip


def _line(layer: Line) -> dict[str, Any]:
    return {
        "type": "scatter", "mode": "lines", "name": _text(layer.label), "x": _numbers(layer.x),
        "y": _numbers(layer.y), "opacity": layer.opacity,
        "line": {"color": layer.colour, "width": layer.width, "dash": DASHES[layer.dash]},
        "hovertemplate": "%{fullData.name}<br>x %{x:.4~g}, y %{y:.4~g}<extra></extra>",
    }  # fmt: skip


def _band(layer: Band) -> dict[str, Any]:
    x, low, high = (np.asarray(v, dtype=float) for v in (layer.x, layer.low, layer.high))
    red, green, blue = (int(layer.colour[k : k + 2], 16) for k in (1, 3, 5))
    return {
        "type": "scatter", "mode": "lines", "name": _text(layer.label),
        "x": _numbers(np.concatenate([x, x[::-1]])),
        "y": _numbers(np.concatenate([high, low[::-1]])), "fill": "toself",
        "fillcolor": f"rgba({red},{green},{blue},0.16)", "line": {"width": 0}, "hoverinfo": "skip",
    }  # fmt: skip


def _rule(
    layer: Rule, x_range: tuple[float, float], y_range: tuple[float, float]
) -> dict[str, Any]:
    if layer.diagonal is not None:
        low = max(x_range[0], y_range[0] / layer.diagonal)
        high = min(x_range[1], y_range[1] / layer.diagonal)
        ends: dict[str, Any] = {
            "x0": low, "x1": high, "y0": layer.diagonal * low, "y1": layer.diagonal * high,
        }  # fmt: skip
    elif layer.y is not None:
        ends = {"xref": "paper", "x0": 0, "x1": 1, "y0": layer.y, "y1": layer.y}
    else:
        ends = {"yref": "paper", "y0": 0, "y1": 1, "x0": layer.x, "x1": layer.x}
    style = {"color": INK, "width": 1, "dash": "dot"}
    return {"type": "line", "layer": "below", "line": style, **ends}


def _rule_text(
    layer: Rule, panel: Panel, x_range: tuple[float, float], y_range: tuple[float, float]
) -> dict[str, Any]:
    note = {
        "text": _text(layer.text), "showarrow": False, "font": {"size": 11, "color": FAINT},
        "bgcolor": "rgba(255,255,255,0.8)",
    }  # fmt: skip

    def at(value: float, log: bool) -> float:
        return _round(math.log10(value) if log else value)

    if layer.diagonal is not None:
        place = (
            x_range[0] * (x_range[1] / x_range[0]) ** 0.8
            if panel.log_x
            else (x_range[0] + 0.8 * (x_range[1] - x_range[0]))
        )
        return note | {
            "x": at(place, panel.log_x), "y": at(place * layer.diagonal, panel.log_y),
            "xanchor": "left", "yanchor": "top",
        }  # fmt: skip
    if layer.y is not None:
        return note | {
            "xref": "paper", "x": 0.01, "y": at(layer.y, panel.log_y), "xanchor": "left",
            "yanchor": "bottom",
        }  # fmt: skip
    assert layer.x is not None
    low, here, high = (at(value, panel.log_x) for value in (x_range[0], layer.x, x_range[1]))
    side = "right" if here > low + 0.6 * (high - low) else "left"
    return note | {"yref": "paper", "y": 0.99, "x": here, "xanchor": side, "yanchor": "top"}


def _numbers(values: Any) -> list[float | None]:
    return [_round(value) for value in np.asarray(values, dtype=float).tolist()]


def _round(value: float) -> Any:
    """A number with few digits; None where there is none, for JSON knows no NaN."""
    if not math.isfinite(value):
        return None
    rounded = float(f"{value:.{DIGITS}g}")
    return int(rounded) if rounded.is_integer() and abs(rounded) < 1e6 else rounded


def _text(text: str) -> str:
    """Plain text for Plotly, which reads some HTML in its labels."""
    return html.escape(text, quote=False)
