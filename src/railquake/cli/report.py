"""Command for the report of a study."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from railquake.cli.application import app
from railquake.cli.shared import echo, say_on_stderr

__all__ = ["report_with_notes"]


@app.command()
def report(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder of a study.", show_default=False)
    ],
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="FILE", help="The page; DIR/report.html by default."),
    ] = None,
    hazard: Annotated[
        str | None,
        typer.Option(
            "--hazard", help="Uniform hazard spectra to draw the suite against: a name or a CSV."
        ),
    ] = None,
    records: Annotated[
        Path | None,
        typer.Option("--records", help="Folder of the records, if they were moved since."),
    ] = None,
) -> None:
    """Write the report of a study: one HTML page that needs nothing else.

    The folder figures beside it gets each figure as PNG and CSV.  A few runs are made again
    for it.

    Example: railquake report study
    """
    report_with_notes(folder, out, hazard, records)


def report_with_notes(
    folder: Path,
    out: Path | None = None,
    hazard: str | None = None,
    records: Path | None = None,
) -> None:
    """Write a report, and say on standard error what takes long."""
    from railquake.report import write_report

    page = write_report(folder, out, hazard=hazard, records=records, notify=say_on_stderr)
    echo(f"report                   {page.resolve()}")
