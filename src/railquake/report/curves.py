"""Fragility curves with bands."""

from __future__ import annotations

from typing import Any

import numpy as np

from railquake.errors import InputError
from railquake.fragility import (
    LARGEST_BETA,
    OUTCOMES,
    Fragility,
    compare_measures,
    outcome,
)
from railquake.measures import intensities, named
from railquake.report.chart import Band, Chart, Layer, Line, Panel, Points
from railquake.report.context import Context, ReportSection, Table, Text

__all__ = ["curves_of", "section"]

TITLE = "Fragility"
TITLES = {"onset": "Onset of slide-off reached", "derailed": "Derailed"}
FEWEST_EVENTS = 1
REPLICATES = 300
FAR = 5.0  # times the largest measure of all runs


def curves_of(context: Context) -> dict[tuple[str, str], Fragility]:
    """Curves against PBV (at grade PGV) by model and outcome, where there is an event."""
    found = {}
    for model in context.models:
        measure = "pgv" if model == "at-grade" else "pbv"
        rows = context.of(model)
        for event in OUTCOMES:
            if outcome(rows, event).sum() < FEWEST_EVENTS:
                continue
            try:
                found[model, event] = Fragility.from_table(
                    rows, event, measure, replicates=REPLICATES
                )
            except InputError:
                continue  # at grade there is no PBV, say
    return found


def section(context: Context) -> ReportSection:
    """Curves with bands, their parameters, and which measure fits best."""
    curves = curves_of(context)
    blocks: list[Any] = []
    panels = []
    for event in OUTCOMES:
        drawn = [
            (model, curves[model, event])
            for model in context.models
            if (model, event) in curves and curves[model, event].measure == "pbv"
        ]
        # bands lie below all lines, and those of decoupled models are left out
        main = [(m, c) for m, c in drawn if not m.startswith("decoupled")] or drawn
        layers: list[Layer] = [_band(context, model, curve) for model, curve in main]
        layers += [_line(context, model, curve) for model, curve in drawn]
        layers += [_outcomes(context, model, curve) for model, curve in main]
        if layers:
            panels.append(
                Panel(TITLES[event], named("pbv_m_s").named_axis, "probability",
                      tuple(layers), y_range=(-0.04, 1.04))
            )  # fmt: skip
    if panels:
        caption = (
            "Probability of the outcome given the bridge’s peak velocity: lognormal curves by "
            "maximum likelihood; dashed where the model is decoupled. Bands hold 95 % of a "
            "bootstrap that draws records. Each coupled run is a point at 0 or 1. Where events are "
            "few the band is wide and the curve’s upper part lies beyond the runs; do not read it "
            "there."
        )
        blocks.append(Chart("fragility", "Fragility against PBV", caption, tuple(panels)))
    if curves:
        blocks.append(_table(context, curves))
    none = [
        f"{context.look(model).label}: {TITLES[event].lower()} in none of {len(context.of(model))} "
        f"runs (probability below {3.0 / max(len(context.of(model)), 3):.2g} with 95 % confidence "
        "if they were independent)"
        for event in OUTCOMES
        for model in context.models
        if len(context.of(model)) and not outcome(context.of(model), event).any()
    ]
    if none:
        blocks.append(Text("No curve for " + "; ".join(none) + ".", "note"))
    if not blocks:
        blocks.append(Text("No run has finished: there is nothing to fit.", "note"))
    if curves:
        blocks.append(
            Text(
                "figures/fragility-pelicun.csv holds these curves in the layout of pelicun’s "
                "damage model parameters.",
                "note",
            )
        )
    return ReportSection("fragility", TITLE, tuple(blocks))


def _grid(curve: Fragility) -> np.ndarray:
    return np.linspace(0.0, 1.1 * curve.span[1], 80)


def _band(context: Context, model: str, curve: Fragility) -> Layer:
    look, at = context.look(model), _grid(curve)
    return Band(f"95 % band, {look.label}", look.colour, at, *curve.band(at))


def _line(context: Context, model: str, curve: Fragility) -> Layer:
    look, at = context.look(model), _grid(curve)
    dash = "dashed" if look.open else "solid"
    return Line(look.label, look.colour, at, curve.probability(at), dash=dash, width=2.2)


def _outcomes(context: Context, model: str, curve: Fragility) -> Layer:
    look, rows = context.look(model), context.of(model)
    kept = rows["pbv_m_s"].to_numpy(dtype=float) > 0.0
    rows = rows[kept]
    return Points(
        f"runs, {look.label}", look.colour, rows["pbv_m_s"].to_numpy(dtype=float),
        outcome(rows, curve.event).astype(float), rows["row"].to_numpy(), context.words(rows),
        look.symbol, look.open, 4.5,
    )  # fmt: skip


def _table(context: Context, curves: dict[tuple[str, str], Fragility]) -> Table:
    rows = []
    known = intensities()
    for (model, event), curve in curves.items():
        best = compare_measures(context.of(model), event, replicates=0)
        ranking = ", ".join(
            f"{known[item.measure].short} {item.aic - best[0].aic:.0f}" for item in best
        )
        rows.append(
            (
                context.look(model).label,
                TITLES[event].lower(),
                f"{curve.events} of {curve.runs}",
                known[curve.measure].short,
                f"{_number(curve.theta)} ({_ends(curve.theta_interval, curve)}) "
                f"{known[curve.measure].unit}",
                f"{_number(curve.beta)} ({_betas(curve)})",
                "; ".join(curve.flags) or "–",
                ranking or "–",
            )
        )
    caption = (
        "Median θ and dispersion β with 95 % intervals (profile of the penalised likelihood, "
        "widened for runs of the same record), flags, and ΔAIC of each measure on the same "
        "runs: the "
        "measure with 0 describes the outcome best, and 10 more is far worse."
    )
    head = ("model", "outcome", "events", "against", "θ", "β", "flags", "ΔAIC")
    return Table(head, tuple(rows), caption)


def _number(value: float) -> str:
    return f"{value:.3g}" if 1e-3 <= value < 1e4 else "beyond the runs"


def _ends(ends: tuple[float, float], curve: Fragility) -> str:
    low, high = ends
    last = f"{high:.3g}" if high < FAR * curve.span[1] else "far beyond the runs"
    return f"{low:.3g} to {last}"


def _betas(curve: Fragility) -> str:
    low, high = curve.beta_interval
    return f"{low:.2g} to " + (f"{high:.2g}" if high < 0.999 * LARGEST_BETA else "unbounded")
