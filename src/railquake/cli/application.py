"""The application that the commands register with, and the group of probes."""

from __future__ import annotations

from typing import Annotated

import typer

from railquake.version import __version__

__all__ = ["app", "probe_app"]

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # plain help is quicker, and its paragraphs are filled
    help="How safely a train runs over a bridge in an earthquake.",
)
probe_app = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    help="One component of the model by itself.",
)
app.add_typer(probe_app, name="probe")


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"railquake {__version__}")
        raise typer.Exit


@app.callback(
    epilog="Exit status: 0 when the command did its work (a derailment is a result), 2 after a "
    "wrong input, 130 when stopped."
)
def _root(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """How safely a train runs over a bridge in an earthquake."""
