"""Figure 10: the lateral force of the train on the track."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from railquake.findings import force_ratio
from railquake.findings.lateral import LevelOff
from railquake.measures import named
from railquake.report.chart import Chart, Layer, Line, Panel, Rule
from railquake.report.context import Look, ReportSection, Text
from railquake.report.layers import points

if TYPE_CHECKING:
    from railquake.report.context import Context

__all__ = ["section"]

TITLE = "Lateral force of the train on the track (Figure 10)"


def section(context: Context) -> ReportSection:
    """Filtered lateral force over friction times weight, coupled and decoupled."""
    ratio = dict(zip(context.table["row"], force_ratio(context.table), strict=True))
    groups = [
        ("Coupled", [m for m in context.models if m.startswith("coupled")]),
        ("Decoupled", [m for m in context.models if m.startswith("decoupled")]),
        ("At grade", [m for m in context.models if m == "at-grade"]),
    ]
    grouped = {name for _, names in groups for name in names}
    groups.append(("Runs", [m for m in context.models if m not in grouped]))
    panels = []
    every: list[float] = []
    for title, models in groups:
        layers: list[Layer] = []
        for model in models:
            rows = context.of(model)
            x = rows["pba_m_s2"].to_numpy(dtype=float)
            y = np.array([ratio[row] for row in rows["row"]], dtype=float)
            drawn = points(context, rows, x, y, context.look(model))
            if len(drawn.x):
                layers.append(drawn)
                every += drawn.y.tolist()
                fit = context.evidence.level_offs.get(model)
                if fit is not None and fit.slope_beyond.known:
                    layers.append(_two_lines(fit, drawn.x, drawn.y, context.look(model)))
        if layers:
            panels.append((title, layers))
    if not panels:
        return ReportSection(
            "lateral", TITLE, (Text("No run has a lateral force to show.", "note"),)
        )
    span = (min(every) / 1.15, max(every) * 1.15)
    drawn_panels = tuple(
        Panel(title, named("pba_m_s2").named_axis,
              "peak lateral force / (μ × weight)", (Rule("friction × weight", y=1.0), *layers),
              log_x=True, log_y=True, y_range=span)
        for title, layers in panels
    )  # fmt: skip
    corners = [
        f"{value:g} Hz" for value in context.done["lateral_force_filter_hz"].dropna().unique()
    ]
    at = f" at {' or '.join(corners)}" if corners else ""
    caption = (
        "Largest lateral force of all wheels on the track, over friction times the train’s weight. "
        f"Short impacts are left out by a low-pass{at}. Lines are two joined power "
        "laws fitted to each model’s runs: a cap would be a level second piece."
    )
    chart = Chart(
        "figure-10-lateral-force", "Lateral force, impacts filtered", caption, drawn_panels, 3
    )
    return ReportSection("lateral", TITLE, (chart,))


def _two_lines(fit: LevelOff, x: np.ndarray, y: np.ndarray, look: Look) -> Line:
    """The two joined lines, through the data in the mean."""
    u = np.log(np.geomspace(x.min(), x.max(), 60))
    knee = math.log(fit.knee.value)

    def rise(at: np.ndarray) -> np.ndarray:
        before = fit.slope_before.value * np.minimum(at - knee, 0.0)
        return before + fit.slope_beyond.value * np.maximum(at - knee, 0.0)

    offset = float(np.mean(np.log(y) - rise(np.log(x))))
    return Line(
        f"two power laws, {look.label}", look.colour, np.exp(u), np.exp(offset + rise(u)),
        width=1.6, in_legend=False,
    )  # fmt: skip
