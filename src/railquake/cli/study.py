"""Commands for many runs: demo, study, merge, rerun."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from railquake.cli.application import app
from railquake.cli.shared import Json, Out, echo, say_on_stderr, terminal_bar
from railquake.cli.status import Stopped

if TYPE_CHECKING:
    import pandas as pd
    from rich.progress import ProgressColumn

    from railquake.study import Study, StudyProgress

__all__ = ["run_with_progress"]

Jobs = Annotated[int | None, typer.Option("--jobs", help="Threads; all processors by default.")]
Device = Annotated[str, typer.Option("--device", help="cpu; or cuda for an NVIDIA GPU.")]


@app.command()
def demo(
    out: Out = Path("demo-out"),
    jobs: Jobs = None,
) -> None:
    """Run the built-in study and write its report.

    The paper's investigation with 20 synthetic motions for its records: a BART car on a Berkeley
    pier at four hazard levels and three speeds, coupled and decoupled, elastic and nonlinear, and
    at grade; 1,200 runs in a minute or two.  Needs no file.

    Example: railquake demo --out demo-out
    """
    from railquake.cli.report import report_with_notes
    from railquake.study import DEMO_FILE, load_study

    run_with_progress(load_study(DEMO_FILE), out, jobs=jobs)
    report_with_notes(out)


@app.command()
def study(
    file: Annotated[
        Path, typer.Argument(metavar="STUDY.toml", help="Study file.", show_default=False)
    ],
    out: Out,
    jobs: Jobs = None,
    records: Annotated[
        Path | None, typer.Option("--records", help="Folder that holds the suite's records.")
    ] = None,
    shard: Annotated[
        str | None, typer.Option("--shard", metavar="I/N", help="Only part I of N, as 3/8.")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option("--scheduler", help="Dask scheduler whose workers run it: tcp://HOST:PORT."),
    ] = None,
    device: Device = "cpu",
    changes: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE",
            help="Change a value of the file: --set base.solver.dt=auto",
        ),
    ] = None,
) -> None:
    """Run a study: a base case, a suite of motions and axes.

    Every combination is a row of runs.parquet in the folder, diverged and failed runs too.
    Stopped or killed and started again with the same folder, it goes on where it was.

    Example: railquake study study.toml --out study --records records
    """
    from railquake.study import load_study

    run_with_progress(
        load_study(file, changes or ()),
        out,
        jobs=jobs,
        records=records,
        shard=shard,
        scheduler=scheduler,
        device=device,
    )


def run_with_progress(study: Study, out: Path, **options: Any) -> pd.DataFrame:
    """Run a study with a progress bar on a terminal; say at the end how its runs ended.

    Parameters
    ----------
    study : Study
    out : Path
        Folder for the results.
    **options
        Of `Study.run`.

    Returns
    -------
    pandas.DataFrame
    """
    try:
        with _progress() as (progress, say):
            table = study.run(out, progress=progress, notify=say, **options)
    except KeyboardInterrupt:
        raise Stopped(
            f"stopped; finished runs are kept in {out}: run the same command again to go on"
        ) from None
    counts = table["status"].value_counts()
    listed = ", ".join(f"{count} {status}" for status, count in counts.items())
    echo(f"{len(table)} runs: {listed}")
    failed = table[table["status"] == "failed"]
    for text, rows in list(failed.groupby("error")["row"])[:5]:
        echo(f"failed: {text} (rows {_listed(list(rows))})")
    echo(f"table: {out / 'runs.parquet'}")
    return table


def _listed(rows: list[int]) -> str:
    more = f" ... {len(rows)} in all" if len(rows) > 6 else ""
    return ", ".join(map(str, rows[:6])) + more


@contextmanager
def _progress() -> Iterator[tuple[Callable[[StudyProgress], None] | None, Callable[[str], None]]]:
    def columns() -> Sequence[str | ProgressColumn]:
        from rich.progress import BarColumn, MofNCompleteColumn

        return MofNCompleteColumn(), "runs", BarColumn(), "{task.fields[rate]}"

    with terminal_bar(columns) as (bar, say):
        if bar is None:
            yield None, say
            return
        task = bar.add_task("study", total=None, rate="")

        def show(now: StudyProgress) -> None:
            rate = f"{now.runs_per_s:.2f} runs/s"
            if now.remaining_s is not None:
                rate += f", {_clock(now.remaining_s)} left"
            bar.update(task, completed=now.done, total=now.total, rate=rate)

        yield show, say


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"


@app.command()
def merge(
    folders: Annotated[
        list[Path],
        typer.Argument(metavar="DIR...", help="Folders of a study's shards.", show_default=False),
    ],
    out: Out,
) -> None:
    """Merge the shards of a study into one table.

    The folders hold parts of the same study, made with --shard; --out may be one of them.

    Example: railquake merge shard-1 shard-2 --out study
    """
    from railquake.study import merge_results

    results = merge_results(folders, out, notify=say_on_stderr)
    echo(f"{len(results.table)} of {results.design.size} runs: {out / 'runs.parquet'}")


@app.command()
def rerun(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder of a study.", show_default=False)
    ],
    row: Annotated[
        int, typer.Argument(metavar="ROW", help="Number of the row, from 0.", show_default=False)
    ],
    out: Out,
    records: Annotated[
        Path | None,
        typer.Option("--records", help="Folder of the records, if they were moved since."),
    ] = None,
    as_json: Json = False,
) -> None:
    """Run one row of a study again, as `railquake run` does.

    Writes its numbers, histories, pictures and its case file.

    Example: railquake rerun study 17 --out row-17
    """
    from railquake.cli.single import run_scenario
    from railquake.study import open_results

    run_scenario(open_results(folder, records=records).scenario(row), out, as_json)
