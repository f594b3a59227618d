"""What all sections of a report share: the table, its statistics, and words for its runs."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from railquake.errors import InputError
from railquake.findings import Evidence, finished, gather
from railquake.messages import shell_word
from railquake.plots.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY
from railquake.report.older import completed

if TYPE_CHECKING:
    import pandas as pd

    from railquake.inputs.vehicle import Vehicle
    from railquake.study import StudyResults

__all__ = ["LOOKS", "Context", "Look", "ReportSection", "Table", "Text"]

REPLICATES = 500
COLOURS = (BLUE, RED, GREEN, ORANGE, PURPLE, SKY, BLACK, GREY)
SYMBOLS = ("circle", "square", "triangle-up", "diamond", "cross")
KMH = 3.6
SHOWN_CELL = 60  # characters


@dataclass(frozen=True)
class Look:
    """How a model is drawn and called."""

    label: str
    colour: str
    symbol: str
    open: bool = False


LOOKS: Mapping[str, Look] = {
    "coupled-elastic": Look("coupled, elastic", BLUE, "circle"),
    "coupled-nonlinear": Look("coupled, nonlinear", RED, "square"),
    "decoupled-elastic": Look("decoupled, elastic", BLUE, "circle", open=True),
    "decoupled-nonlinear": Look("decoupled, nonlinear", RED, "square", open=True),
    "at-grade": Look("at grade", GREEN, "triangle-up"),
}
"""The models of the paper."""


@dataclass(frozen=True)
class Text:
    """A paragraph of plain text; ``kind`` is ``note`` for a remark."""

    text: str
    kind: str = ""


@dataclass(frozen=True)
class Table:
    """A table of plain texts."""

    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    caption: str = ""


@dataclass(frozen=True)
class ReportSection:
    """A part of the report.

    Parameters
    ----------
    key : str
        Anchor.
    title : str
    blocks : tuple
        Of `Text`, `Table`, `chart.Chart`, and of what else `page` knows.
    """

    key: str
    title: str
    blocks: tuple[Any, ...]


class Context:
    """A study and what is found from it, each worked out when first asked for.

    Parameters
    ----------
    results : StudyResults
    shown_folder : str
        The folder as it stands in commands.
    notify : callable
        Called with a line before something that takes long.
    records : str, optional
        The folder of the records, where commands must name it.
    """

    def __init__(
        self,
        results: StudyResults,
        shown_folder: str,
        notify: Callable[[str], None],
        records: str | None = None,
    ) -> None:
        self.records = records
        self.results = results
        self.shown_folder = shown_folder
        self.notify = notify

    @cached_property
    def table(self) -> pd.DataFrame:
        """All rows, whole."""
        return completed(self.results)

    @cached_property
    def done(self) -> pd.DataFrame:
        """The runs that came to an end."""
        return finished(self.table)

    @cached_property
    def models(self) -> list[str]:
        """Models with finished runs, those of the paper first; one without a name if none has."""
        if "model" not in self.done:
            return [""]
        present = [str(name) for name in self.done["model"].dropna().unique()]
        return [name for name in LOOKS if name in present] + [
            name for name in present if name not in LOOKS
        ]

    def of(self, model: str) -> pd.DataFrame:
        """Finished runs of a model."""
        return self.done[self.done["model"] == model] if model else self.done

    def look(self, model: str) -> Look:
        """How to draw a model."""
        if model in LOOKS:
            return LOOKS[model]
        others = [name for name in self.models if name not in LOOKS]
        k = others.index(model) if model in others else 0
        return Look(model or "all runs", COLOURS[k % 8], SYMBOLS[k % 5])

    @cached_property
    def evidence(self) -> Evidence:
        """Statistics of all runs."""
        self.notify("working out statistics ...")
        return gather(self.table, replicates=REPLICATES)

    @cached_property
    def first_vehicle(self) -> Vehicle | None:
        """The vehicle of the first row for which one can be made."""
        design = self.results.design
        for row in self.table["row"].iloc[:20]:
            try:
                return design.vehicle(design.point(int(row)))
            except InputError:
                continue
        return None

    @cached_property
    def time_step_facts(self) -> Mapping[str, Any]:
        """How the time step was chosen, if the study left that open."""
        try:
            found = json.loads((self.results.folder / "time_step.json").read_text("utf-8"))
        except (OSError, ValueError):
            return {}
        return found if isinstance(found, dict) else {}

    def command(self, row: int) -> str:
        """The command that runs a row again."""
        return f"{self.command_head} {row} {self.command_tail}"

    @property
    def command_head(self) -> str:
        """What stands before the row's number."""
        return f"railquake rerun {shell_word(self.shown_folder)}"

    @property
    def command_tail(self) -> str:
        """What stands behind the row's number."""
        where = "" if self.records is None else f" --records {shell_word(self.records)}"
        return f"--out result{where}"

    def words(self, rows: pd.DataFrame) -> list[str]:
        """What to say of each run on hover."""
        axes = [axis.column for axis in self.results.study.axes]
        said = []
        for row in rows.to_dict("records"):
            parts = [str(row["record"])]
            if row.get("level") not in (None, "", "1"):
                parts.append(str(row["level"]))
            for name in axes:
                value = row.get(name)
                if name == "vehicle.speed" and isinstance(value, int | float):
                    parts.append(f"{KMH * value:.3g} km/h")
                elif name == "model":
                    parts.append(self.look(str(value)).label)
                elif isinstance(value, float):
                    parts.append(f"{name.split('.')[-1]} {value:.4g}")
                else:
                    parts.append(f"{name.split('.')[-1]} {value}"[:SHOWN_CELL])
            if row["status"] != "safe":
                mode = row.get("derailment_mode")
                parts.append(str(mode) if isinstance(mode, str) else str(row["status"]))
            said.append(", ".join(parts))
        return said
