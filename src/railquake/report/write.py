"""Make a report of a study's folder and write it, whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

from railquake.errors import InputError
from railquake.files import prepare_folder, whole_file, whole_folder
from railquake.fragility import OUTCOMES, write_csv
from railquake.messages import reason
from railquake.report import (
    curves,
    decoupled,
    failures,
    hinges,
    lateral,
    spectra,
    summary,
    trust,
    uplift,
    vehicle,
)
from railquake.report.context import Context, ReportSection
from railquake.report.page import charts_of, page_html
from railquake.report.pictures import csv_text, write_png

__all__ = ["write_report"]

PAGE = "report.html"
FIGURES = "figures"


def _silent(_: str) -> None:
    pass


def write_report(
    folder: str | Path,
    out: str | Path | None = None,
    *,
    hazard: str | None = None,
    records: str | Path | None = None,
    notify: Callable[[str], None] = _silent,
) -> Path:
    """Write the report of a study.

    Parameters
    ----------
    folder : str or Path
        As `railquake study` left it; it may be unfinished.
    out : str or Path, optional
        The page; ``report.html`` in the folder by default.  The folder ``figures`` beside it gets
        each figure as PNG and CSV, and the fragility curves for pelicun.
    hazard : str, optional
        Uniform hazard spectra to hold the suite against: a built-in name or a CSV file.  Berkeley's
        for the built-in suites by default.
    records : str or Path, optional
        The folder in which the records are now, if they are not where they were.
    notify : callable
        Called with a line before something that takes long.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    InputError
        In one line: if the folder is no study's, its table cannot be read, or the report cannot
        be written.
    """
    from railquake.study import open_results

    context = Context(
        open_results(folder, records=records),
        os.fspath(folder),
        notify,
        None if records is None else os.fspath(records),
    )
    page = Path(out) if out is not None else Path(folder) / PAGE
    if page.is_dir():
        raise InputError(f"--out {page}: is a folder; name a file, such as {page / PAGE}")
    prepare_folder(page.parent)
    if not len(context.results.table):
        raise InputError(f"{folder}: its table holds no rows; run the study first")
    if hazard is not None:
        from railquake.suite import read_hazard

        read_hazard(hazard)  # a wrong name is told before the work begins
    sections = _sections(context, hazard)
    notify("drawing ...")
    text = page_html(
        sections,
        title=f"Running safety study: {context.results.folder.resolve().name}",
        subtitle=_subtitle(context),
        footer=_footer(),
        command=(context.command_head, context.command_tail),
    )
    _write(page, text, sections, context)
    return page


def _sections(context: Context, hazard: str | None) -> list[ReportSection]:
    return [
        summary.section(context),
        vehicle.section(context),
        spectra.section(context, hazard),
        hinges.section(context),
        uplift.section(context),
        decoupled.section(context),
        lateral.section(context),
        curves.section(context),
        failures.section(context),
        trust.section(context),
    ]


def _subtitle(context: Context) -> str:
    study = context.results.study
    suite = getattr(study.suite, "name", None)
    axes = ", ".join(axis.column for axis in study.axes)
    levels = ", ".join(study.levels)
    parts = [
        f"suite {suite}" if suite else "",
        f"levels {levels}" if levels else "",
        f"axes {axes}" if axes else "",
    ]
    said = "; ".join(part for part in parts if part)
    said = f"{said[0].upper()}{said[1:]}. " if said else ""
    return f"{said}Point at a run for the command that reruns it, click to copy it."


def _footer() -> str:
    from railquake.version import __version__

    return (
        f"Made by railquake {__version__} on {datetime.now(UTC):%Y-%m-%d}. The model is that of "
        "Gomez and DeJong (2023), “Analytical parametric investigation of nonlinear "
        "train-structure interaction under earthquake excitation”; what it cannot tell is in the "
        "documentation under limits."
    )


def _write(page: Path, text: str, sections: list[ReportSection], context: Context) -> None:
    """Write all, then move it; the page last."""
    try:
        page.parent.mkdir(parents=True, exist_ok=True)
        with whole_file(page) as part:
            part.write_text(text, encoding="utf-8")
            with whole_folder(page.parent / FIGURES) as fresh:
                for chart in charts_of(sections):
                    write_png(chart, fresh / f"{chart.name}.png")
                    (fresh / f"{chart.name}.csv").write_text(csv_text(chart), encoding="utf-8")
                _write_pelicun(fresh, context)
    except OSError as error:
        raise InputError(f"{page}: the report cannot be written: {reason(error)}") from None


def _write_pelicun(folder: Path, context: Context) -> None:
    known = curves.curves_of(context)
    components = {}
    for model in context.models:
        limits = [known[model, event] for event in OUTCOMES if (model, event) in known]
        if limits:
            components[f"train-{model or 'all'}"] = limits
    if components:
        write_csv(folder / "fragility-pelicun.csv", components)
