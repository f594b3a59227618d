"""Hinge loops of a few telling runs, run again."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.errors import InputError
from railquake.inputs.support import Pier
from railquake.plots.style import BLACK, RED
from railquake.report.chart import Chart, Line, Panel, Points, Rule
from railquake.report.context import ReportSection, Text

if TYPE_CHECKING:
    import pandas as pd

    from railquake.report.context import Context

__all__ = ["section"]

TITLE = "The plastic hinge: moment against rotation"
MOST_POINTS = 2500  # of a loop in the page


def section(context: Context) -> ReportSection:
    """Loops of the largest rotation, of medians, and of the run whose uplift gained most."""
    chosen = _telling(context)
    panels = []
    for row, what in chosen:
        try:
            panels.append(_loop(context, row, what))
        except InputError as error:
            text = f"The runs cannot be made again: {error}."
            return ReportSection("hinges", TITLE, (Text(text, "note"),))
    if not panels:
        text = "No finished run has a plastic (Bouc-Wen) hinge: there are no loops to show."
        return ReportSection("hinges", TITLE, (Text(text, "note"),))
    caption = (
        "Moment of the plastic hinge at the pier’s foot against its rotation, in runs made again "
        "for this picture; the dotted line is its initial stiffness. Wide loops dissipate energy, "
        "which is why a nonlinear pier as a rule moves more slowly than an elastic one; loops that "
        "lean over are a pier that has softened."
    )
    chart = Chart("hinge-loops", "Hinge loops of telling runs", caption, tuple(panels))
    return ReportSection("hinges", TITLE, (chart,))


def _telling(context: Context) -> list[tuple[int, str]]:
    """Rows with a plastic hinge that say most, and why each was chosen."""
    rows = context.done
    if "model" in rows and (rows["model"] == "coupled-nonlinear").any():
        rows = rows[rows["model"] == "coupled-nonlinear"]
    # whether it is plastic an older version's row may not know: the run itself tells
    rows = rows[(rows["hinge_rotation_peak_rad"] > 0.0) & (rows["hinge_law"] != "elastic")]
    rows = rows.sort_values("hinge_rotation_peak_rad", ascending=False, kind="stable")
    if not len(rows):
        return []
    found: dict[int, str] = {int(rows["row"].iloc[0]): "largest rotation"}
    gained = _gained_most(context, rows)
    if gained is not None:
        found.setdefault(gained, "uplift grew most over the elastic pier’s")
    level = rows["level"].fillna("").astype(str)
    strongest = rows[level == level.iloc[0]]
    found.setdefault(int(strongest["row"].iloc[len(strongest) // 2]), "median of its level")
    found.setdefault(int(rows["row"].iloc[len(rows) // 2]), "median of all")
    return list(found.items())[:4]


def _gained_most(context: Context, rows: pd.DataFrame) -> int | None:
    from railquake.findings.comparison import pairs_of

    if "model" not in context.done:
        return None
    pairs = pairs_of(context.done, "uplift_ratio", "coupled-nonlinear", "coupled-elastic")
    pairs = pairs[(pairs["x"] > 0.0) & pairs["row_y"].isin(rows["row"])]
    if not len(pairs):
        return None
    return int(pairs["row_y"].iloc[int(np.argmax(pairs["y"] / pairs["x"]))])


def _loop(context: Context, row: int, what: str) -> Panel:
    from railquake.run.simulate import simulate

    context.notify(f"running row {row} again for its hinge ...")
    scenario = context.results.scenario(row)
    response = simulate(scenario, notify=context.notify)
    assert isinstance(scenario.support, Pier)
    rotation = 1e3 * response.channel("hinge_rotation_rad")
    moment = 1e-6 * response.channel("base_moment_n_m")
    keep = _corners(rotation, moment)
    k0 = 1e-9 * scenario.support.bouc_wen.k0  # MN m per mrad
    reach = min(float(np.abs(rotation).max()), float(np.abs(moment).max()) / k0)
    (words,) = context.words(context.table[context.table["row"] == row])
    peak = int(np.argmax(np.abs(rotation)))
    return Panel(
        f"{what}\n{words}",
        "hinge rotation, mrad",
        "moment, MN m",
        (
            Rule(x=0.0),
            Rule(y=0.0),
            Line("path", RED, rotation[keep], moment[keep], width=1.0),
            Line("initial stiffness", BLACK, np.array([-reach, reach]),
                 k0 * np.array([-reach, reach]), dash="dotted", width=1.4),
            Points("largest rotation", BLACK, rotation[[peak]], moment[[peak]], np.array([row]),
                   [words]),
        ),
    )  # fmt: skip


def _corners(x: Any, y: Any) -> Any:
    """Places of a path that a picture needs: evenly along its drawn length."""
    steps = np.hypot(np.diff(x) / (np.ptp(x) or 1.0), np.diff(y) / (np.ptp(y) or 1.0))
    length = np.concatenate([[0.0], np.cumsum(steps)])
    wanted = np.linspace(0.0, length[-1], MOST_POINTS)
    return np.unique(np.append(np.searchsorted(length, wanted), 0)).clip(0, len(x) - 1)
