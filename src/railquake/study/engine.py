"""Running a study: batches of scenarios on an executor, finished rows to parts."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    Executor,
    Future,
    wait,
)
from concurrent.futures import ThreadPoolExecutor as Threads
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from railquake.errors import InputError
from railquake.lockstep import choose_time_step, group_of, prepare
from railquake.physics.kernel import lockstep_target
from railquake.study.batches import Batch, Ended, kept_design, run_batch
from railquake.study.design import Design
from railquake.study.folder import ResultsFolder, no_note
from railquake.study.plan import Work, hardest, kernel_key, parse_shard, plan
from railquake.study.table import table_row, table_schema, to_pandas

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

    from railquake.study.file import Study
    from railquake.time_step import TimeStep

__all__ = ["StudyProgress", "run_study"]

FLUSH_S = 2.0  # between two parts
FLUSH_ROWS = 2048


@dataclass(frozen=True)
class StudyProgress:
    """How far a study is.

    Attributes
    ----------
    done, total : int
        Runs, those of former executions included.
    runs_per_s : float
        Of this execution.
    remaining_s : float or None
        What is left, by the steps that it takes; None before the first run has ended.
    """

    done: int
    total: int
    runs_per_s: float
    remaining_s: float | None


def run_study(
    study: Study,
    out: Path,
    *,
    jobs: int | None = None,
    records: Path | None = None,
    progress: Callable[[StudyProgress], None] | None = None,
    notify: Callable[[str], None] | None = None,
    executor: Executor | None = None,
    scheduler: str | None = None,
    shard: tuple[int, int] | str | None = None,
) -> pd.DataFrame:
    """Run a study, or what is left of it; see `Study.run`."""
    import pyarrow as pa
    import pyarrow.compute as pc

    say = notify or no_note
    number, count = parse_shard(shard)
    if jobs is not None and jobs < 1:
        raise InputError(f"--jobs: must be at least 1, found {jobs}")
    if executor is not None and scheduler is not None:
        raise InputError("study: give either an executor or a scheduler, not both")
    study = study.with_suite(records)
    design = Design(study)
    if number > design.size:
        raise InputError(f"--shard: {number}/{count} is empty, the study has {design.size} runs")
    schema = table_schema(design)
    design.check()
    with _executor(executor, scheduler, jobs, say) as (pool, workers, stop):
        folder = ResultsFolder(out)
        folder.prepare(study, say)
        step = _time_step(design, folder, jobs, say)
        if step is not None:
            design = Design(study, step)
        rows = range(number - 1, design.size, count)
        work = plan(design, rows, _finished(folder.load(schema, say)), workers)
        key = f"{out.resolve()}:{os.getpid()}:{time.monotonic_ns()}"
        batches = [Batch(key, study, step, batch) for batch in work.batches]
        if stop is not None and batches:
            _compile(design, work, say)
        with kept_design(key, design):
            _run_all(pool, workers, stop, batches, work, design, folder, schema, progress)
    whole = folder.write_table(schema, dict(zip(rows, work.hashes, strict=True)))
    if count > 1:
        whole = whole.filter(pc.is_in(whole.column("row"), pa.array(list(rows), pa.int64())))
    return to_pandas(whole)


def _finished(table: pa.Table) -> set[tuple[int, str | None]]:
    """Rows that need not be run again, with the hashes of their scenarios."""
    columns = (table.column(name).to_pylist() for name in ("row", "scenario_hash", "status"))
    return {(row, key) for row, key, state in zip(*columns, strict=True) if state != "failed"}


@contextmanager
def _executor(
    given: Executor | None, scheduler: str | None, jobs: int | None, say: Callable[[str], None]
) -> Iterator[tuple[Executor, int, threading.Event | None]]:
    """The executor, how many tasks it runs at a time, and how to stop those of this process."""
    if given is not None:
        yield given, jobs or getattr(given, "_max_workers", None) or os.cpu_count() or 1, None
    elif scheduler is not None:
        from railquake.study.cluster import cluster_executor

        with cluster_executor(scheduler, say) as (executor, workers):
            yield executor, workers, None
    else:
        workers = jobs or os.cpu_count() or 1
        stop = threading.Event()
        with Threads(workers, thread_name_prefix="railquake") as threads:
            try:
                yield threads, workers, stop
            finally:
                stop.set()


def _time_step(
    design: Design, folder: ResultsFolder, jobs: int | None, say: Callable[[str], None]
) -> TimeStep | None:
    """The time step where the study leaves it open: chosen once, then read."""
    if not design.study.chooses_time_step:
        return None
    known = folder.time_step()
    if known is not None:
        return known
    tried = [scenario for scenario in hardest(design) if scenario.solver.dt == "auto"]
    if not tried:
        return None  # an axis sets it
    chosen = choose_time_step(tried, threads=jobs)
    say(chosen.text)
    return folder.note_time_step(chosen)


def _compile(design: Design, work: Work, say: Callable[[str], None]) -> None:
    """Compile or load each kernel here, where a request to stop is heard."""
    from railquake.assembly import assemble
    from railquake.simulation import COMPILING

    seen = set()
    for batch in work.batches:
        scenario = design.scenario(design.point(batch[0]))
        if scenario.solver.contact == "grid" or kernel_key(scenario) in seen:
            continue
        seen.add(kernel_key(scenario))
        with suppress(InputError):  # the run will say so
            system = assemble(scenario)
            group = group_of(system)
            if group in seen:
                continue
            seen.add(group)
            if not system.kernel(lockstep_target()).is_cached:
                say(COMPILING)
            prepare(system)


def _run_all(
    pool: Executor,
    workers: int,
    stop: threading.Event | None,
    batches: Iterable[Batch],
    work: Work,
    design: Design,
    folder: ResultsFolder,
    schema: pa.Schema,
    progress: Callable[[StudyProgress], None] | None,
) -> None:
    """Run all batches; keep what has finished, whatever happens."""
    keeper = _Keeper(work, design, folder, schema)
    keeper.take([(row, {"status": "failed", "error": e}) for row, e in work.failed.items()])
    task = run_batch if stop is None else partial(run_batch, stop=stop)
    waiting = iter(batches)
    running: set[Future[Ended]] = set()
    try:
        while True:
            while len(running) < 2 * workers and (batch := next(waiting, None)) is not None:
                running.add(pool.submit(task, batch))
            if progress is not None:
                progress(keeper.progress())
            if not running:
                break
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                keeper.take(future.result())
                running.remove(future)
            keeper.flush()
    except (KeyboardInterrupt, InputError):
        raise
    except Exception as error:
        if stop is not None:
            raise  # in this process it is a fault of the program
        text = (str(error).splitlines() or [""])[0]
        raise InputError(
            f"study: the workers failed ({type(error).__name__}{': ' if text else ''}{text}); "
            "finished rows are kept: see that they run this version of railquake and reach its "
            "files, and run the same command again to go on"
        ) from None
    finally:
        try:
            _wind_down(running, stop, keeper)
        finally:
            keeper.flush(all_of_it=True)


def _wind_down(running: set[Future[Ended]], stop: threading.Event | None, keeper: _Keeper) -> None:
    """Stop what runs; what it has finished is kept."""
    for future in running:
        future.cancel()
    if stop is not None:
        stop.set()
        wait(running)  # of other machines, nobody knows when they hear of it
    for future in running:
        if future.done() and not future.cancelled() and future.exception() is None:
            keeper.take(future.result())


class _Keeper:
    """Takes the rows that have finished and brings them to the disk."""

    def __init__(
        self,
        work: Work,
        design: Design,
        folder: ResultsFolder,
        schema: pa.Schema,
    ) -> None:
        self.work, self.design, self.folder, self.schema = work, design, folder, schema
        self.rows: list[dict[str, Any]] = []
        self.ended = 0
        self.begin = self.flushed = time.monotonic()
        self.left = sum(work.steps.values())
        self.all_steps = self.left
        self.total = len(work.rows)
        self.former = self.total - len(work.failed) - len(work.steps)
        self.former -= sum(map(len, work.twins.values()))

    def take(self, results: Ended) -> None:
        """Take the measures of some rows; those of the same scenario have the same."""
        for row, measures in results:
            self.left -= self.work.steps.get(row, 0.0)
            for twin in (row, *self.work.twins.get(row, ())):
                key = self.work.hashes[(twin - self.work.rows.start) // self.work.rows.step]
                self.rows.append(table_row(self.design.point(twin), key, measures))
                self.ended += 1

    def progress(self) -> StudyProgress:
        """How far the study is."""
        passed = max(time.monotonic() - self.begin, 1e-9)
        worked = self.all_steps - self.left
        remaining = passed * self.left / worked if worked > 0.0 else None
        return StudyProgress(self.former + self.ended, self.total, self.ended / passed, remaining)

    def flush(self, all_of_it: bool = False) -> None:
        """Write a part, if it is time."""
        now = time.monotonic()
        due = all_of_it or now - self.flushed > FLUSH_S or len(self.rows) > FLUSH_ROWS
        if not self.rows or not due:
            return
        rows, self.rows = self.rows, []
        self.folder.add(rows, self.schema)
        self.flushed = now
