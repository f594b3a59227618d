"""Figure 7: uplift against the bridge's velocity and acceleration."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from railquake.findings import correlate
from railquake.findings.questions import interval
from railquake.measures import correlated, named, short_name
from railquake.report.chart import Chart, Layer, Line, Panel, Points, Rule
from railquake.report.context import REPLICATES, ReportSection, Text
from railquake.report.layers import runs

if TYPE_CHECKING:
    from railquake.report.context import Context

__all__ = ["section"]

TITLE = "Uplift against the bridge’s motion (Figure 7)"


def section(context: Context) -> ReportSection:
    """Normalised uplift of each run, and which measure it goes with."""
    models = [m for m in context.models if not m.startswith("decoupled")] or context.models
    velocity = runs(context, models, "pbv_m_s", "uplift_ratio")
    acceleration = runs(context, models, "pba_m_s2", "uplift_ratio")
    if not acceleration and not velocity:
        return ReportSection(
            "uplift", TITLE, (Text("No run has finished: nothing to show.", "note"),)
        )
    level = Rule("onset of slide-off", y=1.0)
    panels = []
    for layers, measure, title in (
        (velocity, "pbv_m_s", "Against the bridge’s peak velocity"),
        (acceleration, "pba_m_s2", "Against its peak acceleration"),
    ):
        if layers:
            fits = _fits(context, models, measure)
            panels.append(
                Panel(
                    title,
                    named(measure).named_axis,
                    named("uplift_ratio").axis,
                    (level, *layers, *fits),
                    log_x=True,
                    log_y=True,
                )
            )
    caption = (
        "Peak roll of the wheelset against the track, over the roll at which slide-off begins, for "
        "every run; lines are power laws fitted to all runs of a model. The closer the points lie "
        "to their line, the better the measure. "
        + (
            "At grade there is no bridge velocity, and PBA is the ground’s. "
            if "at-grade" in models
            else ""
        )
        + "A derailed run shows what was reached until the train left the track."
    )
    chart = Chart("figure-7-uplift", "Uplift against PBV and PBA", caption, tuple(panels))
    blocks: list[object] = [chart]
    forest = _correlations(context, models)
    if forest is not None:
        blocks.append(forest)
    return ReportSection("uplift", TITLE, tuple(blocks))


def _fits(context: Context, models: list[str], measure: str) -> tuple[Line, ...]:
    lines = []
    for model in models:
        rows = context.of(model)
        x, y = (rows[name].to_numpy(dtype=float) for name in (measure, "uplift_ratio"))
        kept = (x > 0.0) & (y > 0.0) & np.isfinite(x * y)
        if kept.sum() < 5 or np.unique(x[kept]).size < 3:
            continue
        b, a = np.polyfit(np.log(x[kept]), np.log(y[kept]), 1)
        ends = np.geomspace(x[kept].min(), x[kept].max(), 20)
        look = context.look(model)
        lines.append(
            Line(f"power law, {look.label}", look.colour, ends, math.exp(a) * ends**b, width=1.4,
                 in_legend=False)
        )  # fmt: skip
    return tuple(lines)


def _correlations(context: Context, models: list[str]) -> Chart | None:
    """How well uplift goes with each measure: values and intervals, one above another."""
    shown = models[:6]
    found = {
        model: context.evidence.correlations.get(model)
        or correlate(context.of(model), replicates=REPLICATES)
        for model in shown
    }
    names = [name for name in correlated() if any(item.of(name) for item in found.values())]
    if not names:
        return None
    places = {name: float(len(names) - k) for k, name in enumerate(names)}
    ticks = tuple((place, short_name(name)) for name, place in places.items())
    panels = []
    for title, label, source, quantity in (
        ("Rank correlation over all runs", "Spearman’s ρ (1: perfect)", found, "spearman"),
        ("Rank correlation within a level", "Spearman’s ρ, the levels’ means taken away",
         context.evidence.within_level, "spearman"),
        ("Scatter about a power law", "β, standard deviation of ln uplift (0: perfect)", found,
         "dispersion"),
    ):  # fmt: skip
        layers: list[Layer] = []
        for k, model in enumerate(shown):
            known = source.get(model)
            if known is None:
                continue
            look = context.look(model)
            shift = 0.16 * (0.5 * (len(shown) - 1) - k)
            items = [item for item in known.items if item.measure in places]
            values = [getattr(item, quantity) for item in items]
            y = np.array([places[item.measure] + shift for item in items])
            gap = math.nan
            ends = [end for value in values for end in (value.low, value.high, gap)]
            layers.append(
                Line(f"intervals, {look.label}", look.colour, np.array(ends),
                     np.repeat(y, 3), width=1.6, in_legend=False)
            )  # fmt: skip
            said = [f"{short_name(i.measure)}, {look.label}: {interval(v)}"
                    for i, v in zip(items, values, strict=True)]  # fmt: skip
            layers.append(
                Points(look.label, look.colour, np.array([v.value for v in values]), y,
                       np.full(len(y), -1), said, look.symbol, look.open, 7.0)
            )  # fmt: skip
        if layers:
            panels.append(
                Panel(title, label, "", tuple(layers), y_range=(0.4, len(names) + 0.6),
                      y_ticks=ticks)
            )  # fmt: skip
    caption = (
        "How well uplift goes with each measure, with 95 % intervals of a bootstrap that draws "
        "records. Over all runs every measure grows with the level and looks good; within a level "
        "only what tells one record from another counts. Where intervals overlap widely, these "
        "records cannot tell the measures apart."
    )
    return Chart("measures", "Which measure goes with uplift", caption, tuple(panels), columns=3)
