"""The command that holds the model against its references."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from railquake.cli.application import app
from railquake.cli.shared import Json, echo, print_json

NOT_GREEN = 1  # exit status


@app.command(
    epilog="Exit status: 0 when everything ran and agrees, 1 when something is outside, skipped or "
    "failed, 2 after a wrong input."
)
def validate(
    data: Annotated[
        Path | None,
        typer.Option(
            help="Folder of reference data (records, oracles). Without it, the one that "
            "RAILQUAKE_SHARED names, or shared beside a checkout."
        ),
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="Only this comparison; repeatable.")
    ] = None,
    page: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="Markdown page to write; pictures go to images/validation beside."
        ),
    ] = None,
    as_json: Json = False,
) -> None:
    """Hold every part of the model against references that it did not write.

    Published numbers, OpenSees, CONTACT, closed forms.  Prints each quantity with its reference,
    the difference, the tolerance and a verdict.  What cannot run here is skipped, and the reason
    said; then the whole is not green.

    Example: railquake validate --page docs/validation.md
    """
    from railquake.validation.page import check_page, summary, text_table, write_page
    from railquake.validation.reference import data_folder
    from railquake.validation.runner import Report, chosen, is_green, run

    names = chosen(only or ())
    folder = data_folder(data)
    if page is not None:
        check_page(page)

    def show(report: Report) -> None:
        if not as_json:
            echo(f"{text_table([report])}\n")

    def begin(name: str) -> None:
        if sys.stderr.isatty():
            echo(f"railquake: {name} ...", err=True)

    reports = run(names, folder, show, begin)
    undrawn = write_page(reports, page) if page is not None else []
    green = is_green(reports) and not undrawn
    if as_json:
        print_json({"green": green, "comparisons": [report.as_dict() for report in reports]})
    else:
        echo(summary(reports))
        if page is not None:
            echo(f"page and plots: {page}")
    for complaint in undrawn:
        echo(f"railquake: {complaint}", err=True)
    if not green:
        raise typer.Exit(NOT_GREEN)
