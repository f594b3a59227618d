"""Figures 8 and 9: coupled against decoupled, run by run."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from railquake.findings.comparison import pairs_of
from railquake.findings.questions import DECOUPLED, ELASTIC, NONLINEAR, interval
from railquake.measures import named
from railquake.report.chart import Chart, Panel, Rule
from railquake.report.context import ReportSection, Text
from railquake.report.layers import points

if TYPE_CHECKING:
    from railquake.report.context import Context

__all__ = ["section"]

TITLE = "Coupled against decoupled analyses (Figures 8 and 9)"
LABELS = {ELASTIC: "elastic pier", NONLINEAR: "nonlinear pier"}
SHOWN = ("pbd_m", "pba_m_s2", "top_rotation_peak_rad", "uplift_ratio")


def section(context: Context) -> ReportSection:
    """Each pair of runs that differ in the coupling alone."""
    models = set(context.models)
    present = [name for name, other in DECOUPLED.items() if {name, other} <= models]
    if not present:
        text = (
            "Does not apply: it compares runs of the models coupled-elastic with "
            "decoupled-elastic, or coupled-nonlinear with decoupled-nonlinear, and this study does "
            "not have both."
        )
        return ReportSection("decoupled", TITLE, (Text(text, "note"),))
    panels = []
    for measure in map(named, SHOWN):
        quantity, factor = measure.key, measure.factor
        layers = []
        for name in present:
            pairs = pairs_of(context.done, quantity, DECOUPLED[name], name)
            rows = context.done.set_index("row").loc[pairs["row_y"]].reset_index()
            layers.append(
                points(
                    context, rows, factor * pairs["x"].to_numpy(dtype=float),
                    factor * pairs["y"].to_numpy(dtype=float),
                    replace(context.look(name), label=LABELS[name]),
                )
            )  # fmt: skip
        layers = [layer for layer in layers if len(layer.x)]
        if layers:
            said = ", ".join(
                f"{'elastic' if name == ELASTIC else 'nonlinear'} "
                f"{interval(context.evidence.ratio(quantity, DECOUPLED[name], name).median)}"
                for name in present
            )
            panels.append(
                Panel(f"{measure.title}\n{said}", f"coupled: {measure.axis}",
                      f"decoupled: {measure.axis}",
                      (Rule("equal", diagonal=1.0), *layers), log_x=True, log_y=True, square=True)
            )  # fmt: skip
    caption = (
        "Each point is a pair of runs with the same record, level, speed and pier: what the "
        "coupled model gives (across) and what the decoupled one does (up); above the dotted line "
        "the decoupled model gives more. Above each panel stands the median ratio with its 95 % "
        "interval. A point’s command reruns the decoupled run."
    )
    chart = Chart("figures-8-9-decoupled", "Coupled against decoupled", caption, tuple(panels))
    return ReportSection("decoupled", TITLE, (chart,) if panels else (Text("No pairs.", "note"),))
