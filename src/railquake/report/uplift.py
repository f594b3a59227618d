"""Figure 7: uplift against the bridge's velocity and acceleration."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from railquake.findings import correlate
from railquake.findings.questions import interval
from railquake.report.chart import Chart, Line, Panel, Rule
from railquake.report.context import REPLICATES, Section, Table, Text
from railquake.report.layers import runs

if TYPE_CHECKING:
    from railquake.report.context import Context

__all__ = ["section"]

TITLE = "Uplift against the bridge’s motion (Figure 7)"
NAMES = {
    "pbv_m_s": "PBV", "pba_m_s2": "PBA", "pgv_m_s": "PGV", "pga_m_s2": "PGA",
    "sa_t1_m_s2": "Sa(T₁)",
}  # fmt: skip


def section(context: Context) -> Section:
    """Normalised uplift of each run, and which measure it goes with."""
    models = [m for m in context.models if not m.startswith("decoupled")] or context.models
    velocity = runs(context, models, "pbv_m_s", "uplift_ratio")
    acceleration = runs(context, models, "pba_m_s2", "uplift_ratio")
    if not acceleration and not velocity:
        return Section("uplift", TITLE, (Text("No run has finished: nothing to show.", "note"),))
    level = Rule("onset of slide-off", y=1.0)
    panels = []
    for layers, measure, label, title in (
        (velocity, "pbv_m_s", "PBV: peak velocity of the bridge, m/s", "Against the bridge’s peak velocity"),
        (acceleration, "pba_m_s2", "PBA: peak acceleration of the track, m/s²", "Against its peak acceleration"),
    ):  # fmt: skip
        if layers:
            fits = _fits(context, models, measure)
            panels.append(
                Panel(
                    title,
                    label,
                    "normalised uplift",
                    (level, *layers, *fits),
                    log_x=True,
                    log_y=True,
                )
            )
    caption = (
        "Peak roll of the wheelset against the track, over the roll at which slide-off begins, for "
        "every run; lines are power laws fitted to all runs of a model. The closer the points lie to "
        "their line, the better the measure. "
        + (
            "At grade there is no bridge velocity, and PBA is the ground’s. "
            if "at-grade" in models
            else ""
        )
        + "A derailed run shows what was reached until the train left the track."
    )
    chart = Chart("figure-7-uplift", "Uplift against PBV and PBA", caption, tuple(panels))
    blocks: list[object] = [chart]
    table = _correlations(context, models)
    if table is not None:
        blocks.append(table)
    return Section("uplift", TITLE, tuple(blocks))


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


def _correlations(context: Context, models: list[str]) -> Table | None:
    rows = []
    for model in models[:6]:
        found = context.evidence.correlations.get(model) or correlate(
            context.of(model), replicates=REPLICATES
        )
        within = context.evidence.within_level.get(model)
        for item in found.items:
            inside = within.of(item.measure) if within is not None else None
            rows.append(
                (
                    context.look(model).label,
                    NAMES.get(item.measure, item.measure),
                    interval(item.spearman),
                    interval(inside.spearman) if inside is not None else "–",
                    interval(item.dispersion),
                    interval(item.exponent),
                    str(found.runs),
                )
            )
    if not rows:
        return None
    caption = (
        "How uplift goes with each measure: Spearman’s rank correlation over all runs and within a "
        "level (each level’s mean taken away first), the standard deviation β of ln uplift about the "
        "power law, and its exponent; 95 % intervals, records drawn."
    )
    head = ("model", "measure", "ρ", "ρ within a level", "scatter β", "exponent", "runs")
    return Table(head, tuple(rows), caption)
