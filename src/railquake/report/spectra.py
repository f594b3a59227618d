"""Spectra of the suite against the hazard."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from railquake.errors import InputError
from railquake.inputs.ground_motion import STANDARD_GRAVITY
from railquake.plots.style import BLUE, GREY, RED
from railquake.report.chart import Band, Chart, Layer, Line, Panel, Rule
from railquake.report.context import ReportSection, Text

if TYPE_CHECKING:
    from railquake.report.context import Context
    from railquake.suite import Suite
    from railquake.suite.hazard import Hazard
    from railquake.suite.spectra import SuiteSpectra

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
    period = context.table["t1_s"].dropna()
    rules = (Rule("T₁ of the pier", x=float(period.iloc[0])),) if len(period) else ()
    panels = tuple(
        _panel(spectra, level, float(factor), known, rules)
        for level, factor in list(levels.items())[:MOST_LEVELS]
    )
    chart = Chart(
        "suite-spectra", "Spectra of the suite against the hazard", _caption(suite, known), panels
    )
    if known is None:
        return ReportSection("spectra", TITLE, (chart,))
    source = Text(f"The target’s source: {known.source}. {known.note}", "note")
    return ReportSection("spectra", TITLE, (chart, source))


def _panel(
    spectra: SuiteSpectra, level: str, factor: float, known: Hazard | None, rules: tuple[Rule, ...]
) -> Panel:
    """Spectra of one level, with its target if there is one."""
    periods = spectra["periods"]
    mean = factor * spectra["mean"] / STANDARD_GRAVITY
    spread = np.exp(spectra["scatter"])
    layers: list[Layer] = [
        Line("motions of the suite", GREY, periods, one, width=0.7, in_legend=k == 0, opacity=0.55)
        for k, one in enumerate(factor * spectra["spectra"] / STANDARD_GRAVITY)
    ]
    layers += [
        Band("one standard deviation", BLUE, periods, mean / spread, mean * spread),
        Line("their geometric mean", BLUE, periods, mean, width=2.4),
    ]
    poe = _probability(level)
    if known is not None and poe is not None and poe in known.curves:
        target = known.target(poe)
        layers.append(
            Line("target: uniform hazard spectrum", RED, target.periods,
                 target.ordinates / STANDARD_GRAVITY, dash="dashed", width=2.0)
        )  # fmt: skip
    title = f"{level} in 50 years, suite × {factor:g}" if poe else f"{level} × {factor:g}".strip()
    return Panel(
        title, "period, s", "Sa (5 % damping), g", (*layers, *rules), log_x=True, log_y=True,
        x_range=(float(PERIODS[0]), float(PERIODS[-1])),
    )  # fmt: skip


def _caption(suite: Suite, known: Hazard | None) -> str:
    caption = (
        f"Response spectra of the {len(suite.members)} motions of the suite “{suite.name}” at "
        "each level (grey), their geometric mean with one standard deviation (blue)"
    )
    if known is None:
        return f"{caption}. No target is known for this suite; name one with --hazard."
    target = f"the uniform hazard spectrum “{known.name}” of that level (red, dashed)"
    return f"{caption}, and {target}."


def _probability(level: str) -> float | None:
    match = re.fullmatch(r"\s*([0-9.]+)\s*%\s*", level)
    return None if match is None else round(0.01 * float(match[1]), 12)
