"""From the arguments to an exit status: errors as one line, clean stops."""

from __future__ import annotations

import errno
import gc
import os
import sys
from collections.abc import Sequence
from contextlib import suppress
from typing import Any, TextIO

import typer

from railquake.cli.application import app
from railquake.cli.stopping import STOPPED, STOPPED_TEXT
from railquake.errors import InputError, printable
from railquake.messages import reason

__all__ = ["Stopped", "main"]

# Base of all errors in the use of a command, from the click that typer itself uses.
USAGE_ERROR: type[Exception] = next(
    kind for kind in typer.BadParameter.__mro__ if kind.__name__ == "ClickException"
)

# What keeps an output from being written.  Of files the commands themselves say which.
FULL = {errno.ENOSPC, errno.EDQUOT, errno.EFBIG, errno.EIO, errno.EBADF, errno.EPIPE}


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
    try:
        status = _status(arguments)
        if sys.stdout is not None and not sys.stdout.closed:
            sys.stdout.flush()
    except OSError as error:
        if error.errno not in FULL:
            raise
        status = _not_printed(error)
    except SystemExit as end:  # typer's, when the reader of a pipe has left
        if not isinstance(end.__context__, BrokenPipeError):
            raise
        status = _not_printed(end.__context__)
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
    except typer.Abort as error:
        if isinstance(error.__cause__, EOFError):  # a fault of the program, and no wish to stop
            raise error.__cause__ from None
        status = STOPPED
    except KeyboardInterrupt:
        status = STOPPED
    except USAGE_ERROR as error:
        if type(error).__name__ == "NoArgsIsHelpError":
            typer.echo(error.ctx.get_help())  # type: ignore[attr-defined]
            return 0
        return _complain(_usage(error), 2)
    except OSError:
        raise
    except Exception:
        fault = _compiler_fault()
        if fault is None:
            raise
        return _complain(fault, 2)
    if status == STOPPED:  # typer turns Ctrl-C into this
        return _complain(STOPPED_TEXT, STOPPED)
    return status if isinstance(status, int) else 0


def _compiler_fault() -> str | None:
    """What of the environment keeps the compiler from working: the cause of any other error."""
    from railquake.march.compiler.cache import compiler_fault

    return compiler_fault()


def _not_printed(error: OSError) -> int:
    """End without what could not be printed; a reader of a pipe may leave when he likes."""
    _silence(sys.stdout)
    if isinstance(error, BrokenPipeError):
        return 0
    return _complain(f"standard output cannot be written: {reason(error)}", 2)


def _silence(stream: TextIO | None) -> None:
    """Let what is left in a stream vanish: the interpreter's end would complain of it."""
    with suppress(OSError, ValueError, AttributeError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())  # type: ignore[union-attr]


def _usage(error: Any) -> str:
    """What was wrong with the command, on one line, and where its help is."""
    message = " ".join(error.format_message().split())
    context = getattr(error, "ctx", None)
    if context is None:
        return message
    return f"{message.removesuffix('.')} (see {context.command_path} --help)"


def _complain(message: str, status: int) -> int:
    try:
        print(f"railquake: {printable(message)}", file=sys.stderr, flush=True)
    except (OSError, ValueError):
        _silence(sys.stderr)  # the status says it
    return status
