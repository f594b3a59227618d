"""Spectra of the suite against the hazard."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from railquake.errors import InputError
from railquake.inputs.ground_motion import STANDARD_GRAVITY
from railquake.plots.style import BLUE, GREY, RED
from railquake.report.chart import Band, Chart, Layer, Line, Panel
from railquake.report.context import ReportSection, Text

if TYPE_CHECKING:
    from railquake.report.context import Context

__all__ = ["section"]

TITLE = "Ground motions: suite spectra against targets"
BUILT_IN_HAZARD = "berkeley"
MOST_LEVELS = 8
PERIODS = np.geomspace(0.03, 4.0, 40)


def section(context: Context, hazard: str | None = None) -> ReportSection:
    """Spectra of each level, their mean and the target of that probability."""
    from railquake.suite import SUITES, Suite, read_hazard, suite_spectra

    study = context.results.study
    suite = study.suite
    if not isinstance(suite, Suite):
        text = (
            "The study has no suite of ground motions; its base case’s own motion shakes all runs."
        )
        return ReportSection("spectra", TITLE, (Text(text, "note"),))
    try:
        spectra = suite_spectra(suite, PERIODS)
    except InputError as error:
        return ReportSection(
            "spectra", TITLE, (Text(f"The suite cannot be read: {error}.", "note"),)
        )
    name = hazard or (BUILT_IN_HAZARD if suite.name in SUITES else None)
    known = read_hazard(name) if name else None
    levels = dict(study.levels) or {"": 1.0}
    panels = []
    for level, factor in list(levels.items())[:MOST_LEVELS]:
        scaled = float(factor) * spectra["spectra"] / STANDARD_GRAVITY
        mean = float(factor) * spectra["mean"] / STANDARD_GRAVITY
        spread = np.exp(spectra["scatter"])
        layers: list[Layer] = [
            Line("motions of the suite", GREY, spectra["periods"], one, width=0.7,
                 in_legend=k == 0, opacity=0.55)
            for k, one in enumerate(scaled)
        ]  # fmt: skip
        layers += [
            Band("one standard deviation", BLUE, spectra["periods"], mean / spread, mean * spread),
            Line("their geometric mean", BLUE, spectra["periods"], mean, width=2.4),
        ]
        poe = _probability(level)
        if known is not None and poe is not None and poe in known.curves:
            target = known.target(poe)
            layers.append(
                Line("target: uniform hazard spectrum", RED, target.periods,
                     target.ordinates / STANDARD_GRAVITY, dash="dashed", width=2.0)
            )  # fmt: skip
        title = (
            f"{level} in 50 years, suite × {factor:g}" if poe else f"{level} × {factor:g}".strip()
        )
        panels.append(
            Panel(title, "period, s", "Sa (5 % damping), g", tuple(layers), log_x=True, log_y=True,
                  x_range=(float(PERIODS[0]), float(PERIODS[-1])))
        )  # fmt: skip
    period = context.table["t1_s"].dropna()
    if len(period):
        from dataclasses import replace

        from railquake.report.chart import Rule

        t1 = float(period.iloc[0])
        panels = [
            replace(panel, layers=(*panel.layers, Rule("T₁ of the pier", x=t1))) for panel in panels
        ]
    caption = (
        f"Response spectra of the {len(suite.members)} motions of the suite “{suite.name}” at "
        "each level (grey), their geometric mean with one standard deviation (blue)"
    )
    if known is not None:
        caption += f", and the uniform hazard spectrum “{known.name}” of that level (red, dashed)"
    else:
        caption += ". No target is known for this suite; name one with --hazard"
    caption = caption.rstrip(".") + "."
    title = "Spectra of the suite against the hazard"
    chart = Chart("suite-spectra", title, caption, tuple(panels))
    if known is None:
        return ReportSection("spectra", TITLE, (chart,))
    source = Text(f"The target’s source: {known.source}. {known.note}", "note")
    return ReportSection("spectra", TITLE, (chart, source))


def _probability(level: str) -> float | None:
    match = re.fullmatch(r"\s*([0-9.]+)\s*%\s*", level)
    return None if match is None else round(0.01 * float(match[1]), 12)
