"""Running a study: batches of scenarios on an executor, finished rows to parts."""

from __future__ import annotations

import math
import os
import re
import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
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
from railquake.lockstep import REFRESH_STEPS, _Batch, _group, _run
from railquake.physics.kernel import LOCKSTEP
from railquake.study.design import Design
from railquake.study.results import ResultsFolder, no_note, table_row, table_schema, to_pandas

if TYPE_CHECKING:
    import pandas as pd
    import pyarrow as pa

    from railquake.inputs.scenario import Scenario
    from railquake.study.file import Study

__all__ = ["Batch", "StudyProgress", "parse_shard", "run_batch", "run_study"]

Ended = list[tuple[int, dict[str, Any]]]
"""Rows that have ended, and their measures."""
STEPS_A_BATCH = 40e6  # about eight seconds of one processor
LEAST_BATCH, LARGEST_BATCH = 16, 256  # runs
BLOCK = 32  # assemblies of car, support and track that are worked on at a time
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


@dataclass(frozen=True)
class Batch:
    """Work for one task: some rows of a study.

    Attributes
    ----------
    key : str
        Tells studies apart within a process.
    study : Study
        Its suite loaded.
    time_step : float or None
        Where the study leaves it open, s.
    rows : tuple of int
    """

    key: str
    study: Study
    time_step: float | None
    rows: tuple[int, ...]


_DESIGNS: OrderedDict[str, Design] = OrderedDict()
_DESIGNS_MOST = 4
_DESIGNS_LOCK = threading.Lock()


def _design_of(batch: Batch) -> Design:
    with _DESIGNS_LOCK:
        known = _DESIGNS.get(batch.key)
    return known or _keep_design(batch.key, Design(batch.study, batch.time_step))


def _keep_design(key: str, design: Design) -> Design:
    with _DESIGNS_LOCK:
        _DESIGNS[key] = design
        _DESIGNS.move_to_end(key)
        while len(_DESIGNS) > _DESIGNS_MOST:
            _DESIGNS.popitem(last=False)
    return design


def run_batch(
    batch: Batch, stop: threading.Event | None = None
) -> list[tuple[int, dict[str, Any]]]:
    """Run some rows of a study in lockstep, on this thread.

    Parameters
    ----------
    batch : Batch
    stop : threading.Event, optional
        Once it is set, what has finished is returned.

    Returns
    -------
    list of (int, dict)
        Row and measures.  A run that cannot be made has the status ``failed`` and its ``error``.
    """
    stop = threading.Event() if stop is None else stop
    design = _design_of(batch)
    done: dict[int, dict[str, Any]] = {}

    def scenarios(rows: Sequence[int]) -> Iterator[tuple[int, Scenario]]:
        for row in rows:
            if stop.is_set():
                return
            try:
                yield row, design.scenario(design.point(row))
            except InputError as error:
                done[row] = {"status": "failed", "error": str(error)}

    try:
        for row, measures in _run(scenarios(batch.rows), REFRESH_STEPS, stop):
            done[row] = measures
    except Exception:
        # one of them has a fault that nobody foresaw: the others shall not suffer
        for row in batch.rows:
            if row in done or stop.is_set():
                continue
            try:
                done.update(_run(scenarios([row]), REFRESH_STEPS, stop))
            except Exception as error:
                text = " ".join(f"{type(error).__name__}: {error}".split())
                done[row] = {"status": "failed", "error": f"unexpected: {text}"}
    return list(done.items())


# --- what is to be done -------------------------------------------------------------------------


def parse_shard(shard: tuple[int, int] | str | None) -> tuple[int, int]:
    """Number of a shard, from 1, and of all shards.

    Parameters
    ----------
    shard : (int, int), str or None
        ``(3, 8)`` or ``"3/8"``; None is the whole.

    Raises
    ------
    InputError
        If it is none.
    """
    if shard is None:
        return 1, 1
    text = shard if isinstance(shard, str) else "/".join(map(str, shard))
    match = re.fullmatch(r"\s*(\d{1,9})\s*/\s*(\d{1,9})\s*", text)
    if match is None or not 1 <= int(match[1]) <= int(match[2]):
        raise InputError(f'--shard: must be I/N with I from 1 to N, such as 3/8, found "{text}"')
    return int(match[1]), int(match[2])


@dataclass
class _Work:
    """Rows that are to be run, and how they go together."""

    hashes: list[str | None]  # of the shard's rows
    rows: range  # of the shard
    twins: dict[int, list[int]]  # rows with the scenario of another
    batches: list[tuple[int, ...]]
    steps: dict[int, float]  # of each row that is run
    failed: dict[int, str]  # rows of which no scenario can be made, and why


def _plan(design: Design, rows: range, done: set[tuple[int, str | None]], workers: int) -> _Work:
    """Group what is left into batches whose runs share a kernel and are of similar length."""
    hashes: list[str | None] = []
    first: dict[str, int] = {}
    twins: dict[int, list[int]] = {}
    steps: dict[int, float] = {}
    failed: dict[int, str] = {}
    kernels: dict[Any, int] = {}
    assemblies: dict[tuple[str, ...], tuple[int, int]] = {}  # kernel, number
    found: list[tuple[int, int, int]] = []  # kernel, assembly, row
    for row in rows:
        try:
            scenario, key, parts = design.identified(design.point(row))
            length = _steps(scenario)
        except InputError as error:
            hashes.append(None)
            failed[row] = str(error)
            continue
        hashes.append(key)
        if (row, key) in done:
            continue
        if key in first:
            twins.setdefault(first[key], []).append(row)
            continue
        first[key] = row
        steps[row] = length
        if parts not in assemblies:
            kernel = kernels.setdefault(_lane_key(scenario), len(kernels))
            assemblies[parts] = kernel, len(assemblies)
        found.append((*assemblies[parts], row))
    # similar assemblies are worked on together, so that each is made once
    place = {number: at for at, (_, number) in enumerate(sorted(assemblies.values()))}
    block = {row: place[number] // BLOCK for _, number, row in found}
    found.sort(key=lambda f: (f[0], block[f[2]], -steps[f[2]], f[1], f[2]))
    batches: list[tuple[int, ...]] = []
    share = max(8, math.ceil(len(found) / max(4 * workers, 1) / 8) * 8)
    here: list[int] = []
    former: tuple[int, int] | None = None
    for kernel, _, row in found:
        size = int(min(max(STEPS_A_BATCH / steps[row], LEAST_BATCH), LARGEST_BATCH, share))
        group = (kernel, block[row])
        if here and (group != former or len(here) >= size // 8 * 8):
            batches.append(tuple(here))
            here = []
        here.append(row)
        former = group
    if here:
        batches.append(tuple(here))
    # the longest first, so that all processors end together
    batches.sort(key=lambda batch: (block[batch[0]], -sum(steps[row] for row in batch)))
    return _Work(hashes, rows, twins, batches, steps, failed)


def _steps(scenario: Scenario) -> float:
    """Time steps of a run, about."""
    motion = scenario.motion
    if motion is not None and motion.synthetic is not None:
        duration = float(motion.synthetic["duration"])
    else:
        duration = scenario.ground_motion().duration
    return max(1.0, duration / scenario.solver.dt)


def _lane_key(scenario: Scenario) -> tuple[Any, ...]:
    """What scenarios must share to go abreast, as far as inputs tell; see `lockstep`."""
    support, track, solver = scenario.support, scenario.wheelrail, scenario.solver
    return (
        support.kind == "prescribed",
        getattr(support, "hinge", "elastic"),
        len(scenario.vehicle.bodies),
        track.wheel, track.rail, track.running_circle, track.rail_centre, track.gauge,
        track.rolling_radius, track.youngs_modulus, track.poisson_ratio, track.creep_law,
        solver.dt, solver.history_step, solver.contact, solver.hinge_solve,
    )  # fmt: skip


# --- running ------------------------------------------------------------------------------------


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
        work = _plan(design, rows, _finished(folder.load(schema, say)), workers)
        key = f"{out.resolve()}:{os.getpid()}:{time.monotonic_ns()}"
        batches = [Batch(key, study, step, batch) for batch in work.batches]
        if stop is not None and batches:
            _compile(design, work, say)
        with _kept_design(key, design):
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
def _kept_design(key: str, design: Design) -> Iterator[None]:
    """Forget a design afterwards."""
    try:
        yield
    finally:
        with _DESIGNS_LOCK:
            _DESIGNS.pop(key, None)


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
) -> float | None:
    """The time step where the study leaves it open: chosen once, then read."""
    if not design.study.chooses_time_step:
        return None
    known = folder.time_step()
    if known is not None:
        return known
    from railquake.time_step import choose_time_step

    chosen = choose_time_step(hardest(design), threads=jobs)
    say(chosen.text)
    facts = {"dt_s": chosen.dt, "largest_relative_change": chosen.error, "text": chosen.text}
    return folder.note_time_step(facts)


MOST_HARDEST = 12


def hardest(design: Design) -> list[Scenario]:
    """Some runs that ask most of the time step.

    Of every kind of support, hinge and speed the one with the largest ground velocity; those with
    the largest of these.
    """
    worst: dict[Any, tuple[float, int]] = {}
    velocities: dict[Any, float] = {}
    for row in range(design.size):
        point = design.point(row)
        motion = (point.member, point.motion_key)
        try:
            scenario = design.scenario(point)
            if motion not in velocities:
                unit = scenario.ground_motion()
                velocities[motion] = unit.pgv / abs(point.scale) if point.scale else 0.0
        except InputError:
            continue
        support = scenario.support
        key = (
            support.kind,
            getattr(support, "hinge", None),
            getattr(support, "coupled", None),
            scenario.vehicle.name,
            scenario.vehicle.speed,
        )
        size = velocities[motion] * abs(point.scale)
        if key not in worst or size > worst[key][0]:
            worst[key] = (size, row)
    order = sorted(worst.values(), key=lambda item: (-item[0], item[1]))
    return [design.scenario(design.point(row)) for _, row in order[:MOST_HARDEST]]


def _compile(design: Design, work: _Work, say: Callable[[str], None]) -> None:
    """Compile or load each kernel here, where a request to stop is heard."""
    from railquake.assembly import assemble
    from railquake.simulation import COMPILING

    seen = set()
    for batch in work.batches:
        scenario = design.scenario(design.point(batch[0]))
        if scenario.solver.contact == "grid" or _lane_key(scenario) in seen:
            continue
        seen.add(_lane_key(scenario))
        with suppress(InputError):  # the run will say so
            system = assemble(scenario)
            group = _group(system)
            if group in seen:
                continue
            seen.add(group)
            if not system.kernel(LOCKSTEP).is_cached:
                say(COMPILING)
            _Batch(system, REFRESH_STEPS).advance()


def _run_all(
    pool: Executor,
    workers: int,
    stop: threading.Event | None,
    batches: Iterable[Batch],
    work: _Work,
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
    except (CancelledError, BrokenExecutor, OSError) as error:
        raise InputError(
            f"study: the workers are gone ({type(error).__name__}); finished rows are kept: run "
            "the same command again to go on"
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
        work: _Work,
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
