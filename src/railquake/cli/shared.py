"""What several commands need: their common options, progress, and how they print and write."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railquake.errors import InputError, printable
from railquake.files import read_file, whole_file
from railquake.messages import reason, unreadable

if TYPE_CHECKING:
    from rich.progress import Progress, ProgressColumn

__all__ = [
    "Case",
    "Changes",
    "Json",
    "Out",
    "Picture",
    "echo",
    "print_facts",
    "print_json",
    "progress_bar",
    "read_column",
    "say_on_stderr",
    "terminal_bar",
    "write_file",
    "write_text",
]

Case = Annotated[Path, typer.Argument(metavar="CASE.toml", help="Case file.", show_default=False)]
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Change a value, with its unit: --set motion.scale=1.5 --set vehicle.speed='80 km/h'; "
        "files start from the case file's folder.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, for programs.")]
Out = Annotated[Path, typer.Option("--out", help="Folder for the results.")]
Picture = Annotated[Path | None, typer.Option("--picture", help="Picture (PNG) to write.")]


def echo(text: str, *, err: bool = False) -> None:
    """Print a text, its lines apart: names from files may hold what a terminal would obey."""
    shown = "\n".join(map(printable, text.replace("\t", "    ").split("\n")))
    encoding = getattr(sys.stderr if err else sys.stdout, "encoding", None) or "utf-8"
    # a terminal that knows no umlauts shows what stands for them
    typer.echo(shown.encode(encoding, "backslashreplace").decode(encoding), err=err)


def say_on_stderr(text: str) -> None:
    """Say something that is no result; where it cannot be said, nothing is lost."""
    with suppress(OSError):
        echo(f"railquake: {text}", err=True)


@contextmanager
def terminal_bar(
    columns: Callable[[], Sequence[str | ProgressColumn]],
) -> Iterator[tuple[Progress | None, Callable[[str], None]]]:
    """A progress bar on a terminal's standard error, None elsewhere, and a way to say something.

    ``columns`` makes the bar's columns; called on a terminal only, since rich takes long to import.
    """
    say = say_on_stderr
    if sys.stderr is None or not sys.stderr.isatty():
        yield None, say
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(*columns(), console=Console(stderr=True), transient=True) as bar:
        yield bar, lambda text: bar.console.print(f"railquake: {printable(text)}", markup=False)


@contextmanager
def progress_bar() -> Iterator[tuple[Callable[[int, int], None] | None, Callable[[str], None]]]:
    """A bar that is told the parts done and all parts, and a way to say something."""

    def columns() -> Sequence[str | ProgressColumn]:
        from rich.progress import BarColumn, TimeRemainingColumn

        return "{task.percentage:3.0f} %", BarColumn(), TimeRemainingColumn()

    with terminal_bar(columns) as (bar, say):
        if bar is None:
            yield None, say
            return
        task = bar.add_task("run", total=None)
        yield lambda done, total: bar.update(task, completed=done, total=total), say


def print_facts(facts: dict[str, Any]) -> None:
    """A line for each; lists, such as warnings, a line for each item."""
    for key, value in facts.items():
        if isinstance(value, list):
            for text in value:
                echo(f"{key.removesuffix('s')}: {text}")
        elif value is not None:
            shown = f"{value:.6g}" if isinstance(value, float) else value
            echo(f"{key:22} {shown}")


def read_column(path: Path, name: str) -> Any:
    """One column of a CSV file, by name, or the first where there is no header."""
    import numpy as np

    from railquake.inputs.units import number_of

    try:
        lines = read_file(path).decode("utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise unreadable(path, error) from None
    column, values = 0, []
    started = False
    for number, line in enumerate(lines, 1):
        cells = [cell.strip() for cell in line.split(",")]
        if not line.strip() or line.startswith("#"):
            continue
        if not started and number_of(cells[0]) is None:
            if name not in cells:
                raise InputError(f'{path}, line {number}: no column "{name}" among {line!r}')
            column, started = cells.index(name), True
            continue
        started = True
        text = cells[column] if column < len(cells) else ""
        value = number_of(text)
        if value is None or not np.isfinite(value):
            raise InputError(f'{path}, line {number}: "{text[:40]}" is no finite number')
        values.append(value)
    if not values:
        raise InputError(f"{path}: holds no rows; write a column {name}, one value a line")
    return np.array(values)


def write_file(path: Path, write: Callable[[Path], Any]) -> None:
    """Write a file, whole or not at all."""
    try:
        with whole_file(path) as part:
            write(part)
    except OSError as error:
        raise InputError(f"{path}: cannot be written: {reason(error)}") from None


def write_text(path: Path, text: str) -> None:
    """`write_file` for a text."""
    write_file(path, lambda part: part.write_text(text, encoding="utf-8"))


def print_json(value: Any) -> None:
    """Print JSON to standard output."""
    from railquake.report.run_folder import json_text

    echo(json_text(value))
