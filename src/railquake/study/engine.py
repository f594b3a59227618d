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
from contextlib import closing, contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from railquake.errors import InputError
from railquake.march.compiler.cache import check_compiler
from railquake.messages import first_line
from railquake.run.assess import physics
from railquake.run.many import (
    Device,
    choose_time_step,
    group_of,
    lanes_on,
    prepare,
    simulate_many,
)
from railquake.study.batches import Batch, Ended, kept_design, run_batch
from railquake.study.design import Design
from railquake.study.folder import ResultsFolder, made_by_this, no_note
from railquake.study.plan import Work, hardest, kernel_key, parse_shard, plan
from railquake.study.table import table_row, table_schema, to_pandas

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

    from railquake.run.many import MakeLanes
    from railquake.run.time_step import TimeStep
    from railquake.study.file import StudyInputs

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
    study: StudyInputs,
    out: Path,
    *,
    jobs: int | None = None,
    records: Path | None = None,
    progress: Callable[[StudyProgress], None] | None = None,
    notify: Callable[[str], None] | None = None,
    executor: Executor | None = None,
    scheduler: str | None = None,
    shard: tuple[int, int] | str | None = None,
    device: Device = "cpu",
) -> pd.DataFrame:
    """Run a study, or what is left of it; see `railquake.Study.run`."""
    import pyarrow as pa
    import pyarrow.compute as pc

    say = notify or no_note
    number, count = parse_shard(shard)
    if jobs is not None and jobs < 1:
        raise InputError(f"--jobs: must be at least 1, found {jobs}")
    if executor is not None and scheduler is not None:
        raise InputError("study: give either an executor or a scheduler, not both")
    if device == "cuda" and (executor is not None or scheduler is not None):
        raise InputError(
            "study: device cuda is the GPU of this process and goes with neither an executor nor a "
            "scheduler; give each GPU a shard"
        )
    check_compiler()
    make_lanes = lanes_on(device)
    study = study.with_suite(records)
    design = Design(study)
    if number > design.size:
        raise InputError(f"--shard: {number}/{count} is empty, the study has {design.size} runs")
    schema = table_schema(design)
    design.check()
    with _executor(executor, scheduler, jobs, say) as (pool, workers, stop):
        folder = ResultsFolder(out)
        folder.prepare(study, say, made_by_this())
        step = _time_step(design, folder, jobs, say)
        if step is not None:
            design = Design(study, step)
        rows = range(number - 1, design.size, count)
        work = plan(design, rows, _finished(folder.load(schema, say)), workers)
        if stop is not None:
            _compile(design, work, say, make_lanes)
        with _Keeper(work, design, folder, schema, progress) as keeper:
            if device == "cuda":
                _run_on_gpu(design, work, keeper, jobs)
            else:
                key = f"{out.resolve()}:{os.getpid()}:{time.monotonic_ns()}"
                batches = [Batch(key, study, step, batch, physics()) for batch in work.batches]
                with kept_design(key, design):
                    _run_all(pool, workers, stop, batches, keeper)
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


def _compile(design: Design, work: Work, say: Callable[[str], None], make_lanes: MakeLanes) -> None:
    """Compile or load each kernel here, where a request to stop is heard."""
    from railquake.assembly import assemble

    seen = set()
    for batch in work.batches:
        scenario = design.scenario(design.point(batch[0]))
        if scenario.solver.contact == "grid" or kernel_key(scenario) in seen:
            continue
        seen.add(kernel_key(scenario))
        try:
            system = assemble(scenario)
        except Exception:  # the row fails later, and says why
            continue
        with suppress(InputError):  # the run will say so
            group = group_of(system)
            if group in seen:
                continue
            seen.add(group)
            prepare(system, make_lanes, say)


def _run_all(
    pool: Executor,
    workers: int,
    stop: threading.Event | None,
    batches: Iterable[Batch],
    keeper: _Keeper,
) -> None:
    """Run all batches on an executor; keep what has finished, whatever happens."""
    task = run_batch if stop is None else partial(run_batch, stop=stop)
    waiting = iter(batches)
    running: set[Future[Ended]] = set()
    try:
        while True:
            while len(running) < 2 * workers and (batch := next(waiting, None)) is not None:
                running.add(pool.submit(task, batch))
            keeper.look_up()
            if not running:
                break
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                keeper.take(future.result())
                running.remove(future)
    except (KeyboardInterrupt, InputError):
        raise
    except Exception as error:
        if stop is not None:
            raise  # in this process it is a fault of the program
        text = first_line(error)
        raise InputError(
            f"study: the workers failed ({type(error).__name__}{': ' if text else ''}{text}); "
            "finished rows are kept: see that they run this version of railquake and reach its "
            "files, and run the same command again to go on"
        ) from None
    finally:
        _wind_down(running, stop, keeper)


def _run_on_gpu(design: Design, work: Work, keeper: _Keeper, threads: int | None) -> None:
    """Run all rows on the GPU, whose lanes take the next one when they are free."""
    rows = [row for batch in work.batches for row in batch]
    scenarios = (design.scenario(design.point(row)) for row in rows)
    keeper.look_up()
    with closing(simulate_many(scenarios, threads=threads, device="cuda")) as results:
        for place, measures in results:
            keeper.take([(rows[place], measures)])
            keeper.look_up()


def _wind_down(running: set[Future[Ended]], stop: threading.Event | None, keeper: _Keeper) -> None:
    """Stop what runs; what it has finished is kept."""
    for future in running:
        future.cancel()
    if stop is not None:
        stop.set()
        keeper.flush()  # before what may take too long for whoever stopped it
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
        report: Callable[[StudyProgress], None] | None,
    ) -> None:
        self.work, self.design, self.folder, self.schema = work, design, folder, schema
        self.report = report
        self.rows: list[dict[str, Any]] = []
        self.ended = 0
        self.begin = self.flushed = time.monotonic()
        self.left = sum(work.steps.values())
        self.all_steps = self.left
        self.total = len(work.rows)
        self.former = self.total - len(work.failed) - len(work.steps)
        self.former -= sum(map(len, work.twins.values()))

    def __enter__(self) -> _Keeper:
        self.take([(row, {"status": "failed", "error": e}) for row, e in self.work.failed.items()])
        return self

    def __exit__(self, *_: object) -> None:
        self.flush()

    def take(self, results: Ended) -> None:
        """Take the measures of some rows; those of the same scenario have the same."""
        for row, measures in results:
            self.left -= self.work.steps.get(row, 0.0)
            for twin in (row, *self.work.twins.get(row, ())):
                key = self.work.hashes[(twin - self.work.rows.start) // self.work.rows.step]
                point = self.design.point(twin)
                made = table_row(point, key, measures)
                chosen = None if "solver.dt" in point.changes else self.design.time_step
                if chosen is not None and "dt_error" in measures:
                    made["dt_error"] = chosen.error
                self.rows.append(made)
                self.ended += 1

    def look_up(self) -> None:
        """Write a part, if it is time, and say how far the study is."""
        if time.monotonic() - self.flushed > FLUSH_S or len(self.rows) > FLUSH_ROWS:
            self.flush()
        if self.report is not None:
            self.report(self._progress())

    def _progress(self) -> StudyProgress:
        passed = max(time.monotonic() - self.begin, 1e-9)
        worked = self.all_steps - self.left
        remaining = passed * self.left / worked if worked > 0.0 else None
        return StudyProgress(self.former + self.ended, self.total, self.ended / passed, remaining)

    def flush(self) -> None:
        """Write a part of what has finished."""
        if not self.rows:
            return
        rows, self.rows = self.rows, []
        self.folder.add(rows, self.schema)
        self.flushed = time.monotonic()
