"""From the arguments to an exit status: errors as one line, clean stops."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Sequence
from typing import Any

import typer

from railquake.cli.application import app
from railquake.cli.stopping import STOPPED, STOPPED_TEXT
from railquake.errors import InputError, printable

__all__ = ["Stopped", "main"]

# Base of all errors in the use of a command, from the click that typer itself uses.
USAGE_ERROR: type[Exception] = next(
    kind for kind in typer.BadParameter.__mro__ if kind.__name__ == "ClickException"
)


class Stopped(Exception):
    """Ctrl-C in a command that says by itself what is left of its work."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; its exit status.

    Parameters
    ----------
    arguments : sequence of str, optional
        Instead of the command line's.

    Returns
    -------
    int
        0; 2 after a wrong input, with one line on standard error; 130 after Ctrl-C, or a request to
        terminate where `stopping` hears it.
    """
    status = _status(arguments)
    if arguments is None:
        gc.freeze()  # the process ends: looking for garbage once more takes half a second
    return status


def _status(arguments: Sequence[str] | None) -> int:
    try:
        status = app(
            args=None if arguments is None else list(arguments),
            prog_name="railquake",
            standalone_mode=False,
        )
    except InputError as error:
        return _complain(str(error), 2)
    except Stopped as stop:
        return _complain(str(stop), STOPPED)
    except (KeyboardInterrupt, typer.Abort):
        status = STOPPED
    except USAGE_ERROR as error:
        if type(error).__name__ == "NoArgsIsHelpError":
            typer.echo(error.ctx.get_help())  # type: ignore[attr-defined]
            return 0
        return _complain(_usage(error), 2)
    except BrokenPipeError:
        # the reader of a pipe has left: nothing more can be said, not even at the interpreter's end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    if status == STOPPED:  # typer turns Ctrl-C into this
        return _complain(STOPPED_TEXT, STOPPED)
    return status if isinstance(status, int) else 0


def _usage(error: Any) -> str:
    """What was wrong with the command, on one line, and where its help is."""
    message = " ".join(error.format_message().split())
    context = getattr(error, "ctx", None)
    if context is None:
        return message
    return f"{message.removesuffix('.')} (see {context.command_path} --help)"


def _complain(message: str, status: int) -> int:
    print(f"railquake: {printable(message)}", file=sys.stderr)
    return status
