"""Many runs: scenarios advance in lockstep, some to a batch, on threads or on a GPU.

On the CPU a batch holds as many lanes as `compiler.lockstep_target` has, on a GPU thousands (see
`device`).  A lane whose scenario has ended is given the next one, so records of different lengths
do not wait for each other.  Scenarios that need another kernel, another contact table or another
number of steps a frame go to another batch.
"""

from __future__ import annotations

import os
import queue
import threading
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np

from railquake.assembly import System, assemble
from railquake.errors import InputError
from railquake.march.compiler import lockstep_target
from railquake.messages import on_one_line
from railquake.run.assess import assess
from railquake.run.audit import audit
from railquake.run.gpu import DeviceLanes, require_device, require_known
from railquake.run.response import Response
from railquake.run.simulate import COMPILING, settled, simulate
from railquake.run.time_step import TimeStep, search_time_step

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario
    from railquake.inputs.solver import Solver

__all__ = [
    "Device",
    "choose_time_step",
    "failed_row",
    "group_of",
    "lanes_on",
    "prepare",
    "run_here",
    "simulate_many",
]

Measures = dict[str, Any]
Device = Literal["cpu", "cuda"]
REFRESH_STEPS = 10  # of the hinge's degradation
REFRESH_TIME = 1e-4  # s; with longer time steps it is refreshed after fewer of them
SUBSTEPS = 10  # where a scenario does not say
GPU_THREADS = 2
CHUNK = 500  # frames that a batch runs without looking up
OPEN_BATCHES = 16  # of one thread


def simulate_many(
    scenarios: Iterable[Scenario],
    *,
    threads: int | None = None,
    refresh_steps: int = REFRESH_STEPS,
    hinge_solve: Literal["linearised", "newton"] = "linearised",
    device: Device = "cpu",
) -> Generator[tuple[int, Measures]]:
    """Run many scenarios; any may differ from any other.

    Parameters
    ----------
    scenarios : iterable of Scenario
        Drawn as they are needed, so that memory stays bounded.
    threads : int, optional
        All processors by default; two for a GPU, so that one prepares while the other waits.
    refresh_steps : int
        Steps between two evaluations of the hinge's degradation, and between two looks at flanges
        far from their rails; in between the degradation is extrapolated.  With steps above 1e-5 s
        they are fewer, so that no more than `REFRESH_TIME` passes.
    hinge_solve : {"linearised", "newton"}
        One consistently linearised solve of the hinge a step, unless a scenario's own
        ``solver.hinge_solve`` says "newton"; or each scenario run by `simulate`, which iterates
        unless it says "linearised", at a fifth of the speed.
    device : {"cpu", "cuda"}
        ``cuda`` runs thousands of scenarios at once on an NVIDIA GPU; it pays from some thousands.
        What is left to `simulate` runs on the CPU all the same.

    Yields
    ------
    index : int
        Place of the scenario among ``scenarios``; results come as they are ready.
    row : dict
        What `assess` gives.  A scenario that cannot be run has the status ``failed`` and its
        ``error``, which begins with ``unexpected:`` where nobody foresaw it.

    Raises
    ------
    InputError
        If ``threads`` or ``refresh_steps`` is not positive, ``hinge_solve`` or ``device`` unknown,
        or there is no GPU to be used.

    Notes
    -----
    The step is that of `simulate`, but for the hinge (one consistently linearised solve a step, and
    its degradation extrapolated between evaluations) and, unless ``solver.substeps`` says
    otherwise, for the longer step of structure and sprung bodies (`step.step`).  The grid method
    of contact and a hinge that is to be iterated are run by `simulate` itself.
    """
    make_lanes = lanes_on(device)
    count = threads
    if count is None:
        count = GPU_THREADS if device == "cuda" else os.cpu_count() or 1
    if count < 1:
        raise InputError(f"threads: must be at least 1, found {count}")
    if refresh_steps < 1:
        raise InputError(f"refresh_steps: must be at least 1, found {refresh_steps}")
    if hinge_solve not in ("linearised", "newton"):
        raise InputError(f'hinge_solve: must be linearised or newton, found "{hinge_solve}"')
    singly = hinge_solve == "newton"
    return _results(
        enumerate(scenarios),
        count,
        lambda drawn, stop: run_here(drawn, stop, refresh_steps, singly, make_lanes),
    )


def choose_time_step(
    scenarios: Sequence[Scenario], tolerance: float | None = None, *, threads: int | None = None
) -> TimeStep:
    """Choose time steps for a study by trying some of its scenarios, the hardest.

    Parameters
    ----------
    scenarios : sequence of Scenario
        Their own time steps do not matter.
    tolerance : float, optional
        Relative error allowed in PBD, PBV and uplift ratio, instead of the scenarios' own.
    threads : int, optional
        All processors by default.

    Returns
    -------
    TimeStep
        ``of(scenario)`` gives the step of any other scenario, ``settled(scenario)`` the scenario
        with it.

    Raises
    ------
    InputError
        If there is no scenario, or one cannot be run.
    """

    def run(cases: Sequence[Scenario]) -> list[Measures]:
        rows = dict(simulate_many(cases, threads=threads))
        return [rows[k] for k in range(len(cases))]

    return search_time_step(scenarios, run, tolerance)


def _results(
    scenarios: Iterator[tuple[int, Scenario]],
    threads: int,
    run: Callable[
        [Iterator[tuple[int, Scenario]], threading.Event], Iterator[tuple[int, Measures]]
    ],
) -> Generator[tuple[int, Measures]]:
    found: queue.Queue[tuple[int, Measures] | BaseException | None] = queue.Queue(maxsize=256)
    stop = threading.Event()
    drawing = threading.Lock()

    def put(item: tuple[int, Measures] | BaseException | None) -> None:
        while not stop.is_set():
            try:
                found.put(item, timeout=0.2)
                return
            except queue.Full:
                continue  # whoever asked is busy with the last ones

    def draw() -> tuple[int, Scenario] | None:
        with drawing:
            return None if stop.is_set() else next(scenarios, None)

    def work() -> None:
        try:
            for item in run(iter(draw, None), stop):
                put(item)
        except BaseException as error:
            put(error)
        finally:
            put(None)

    workers = [threading.Thread(target=work, daemon=True) for _ in range(threads)]
    for worker in workers:
        worker.start()
    try:
        running = threads
        while running:
            item = found.get()
            if item is None:
                running -= 1
            elif isinstance(item, BaseException):
                raise item
            else:
                yield item
    finally:
        stop.set()
        for worker in workers:
            worker.join()


class Lanes(Protocol):
    """Where the systems of a batch march, each in a lane of its own."""

    most: int
    compiling: str | None
    """What the first march must wait for, in words."""

    @property
    def is_full(self) -> bool:
        """Whether another system must wait although a lane is free."""

    def load(self, lane: int, system: System) -> System:
        """Give an idle lane a system; returns it, sharing with others what is the same."""

    def release(self, lane: int) -> None:
        """Leave a lane idle."""

    def march(self, left: dict[int, int]) -> None:
        """Run the lanes for a while, none for more than the frames that are ``left`` to it."""

    def frames_done(self, lane: int) -> int:
        """Frames that a lane has behind it."""

    def state(self, lane: int) -> np.ndarray[Any, np.dtype[np.float64]]:
        """State of a lane, shape (state rows, 1)."""


MakeLanes = Callable[[System, int], Lanes]  # for systems like this one, and its refresh steps


class _Abreast:
    """Lanes in lockstep on the CPU; see `Lanes`."""

    is_full = False

    def __init__(self, system: System, refresh_steps: int) -> None:
        lanes = self.most = lockstep_target().lanes
        self.refresh_steps = refresh_steps
        self.kernel = system.kernel(lockstep_target())
        self.compiling = None if self.kernel.is_cached else COMPILING
        self.geometry = system.geometry
        self.idle = system.start.copy()
        self.idle[system.layout.state.ON_TRACK] = 0.0
        self.states = np.repeat(self.idle, lanes, axis=1)
        self.constants = np.repeat(system.constants, lanes, axis=1)
        self.slot = 0  # rows of the drive kept for each lane
        self.drive = np.zeros((2, system.drive.shape[1]))  # the last two rows stay at rest
        self.first = np.zeros(lanes, dtype=np.int64)
        self.stride = np.zeros(lanes, dtype=np.int64)
        self.done = np.zeros(lanes, dtype=np.int64)

    def load(self, lane: int, system: System) -> System:
        rows = len(system.drive)
        if rows > self.slot:
            self._widen(rows)
        place = lane * self.slot
        self.drive[place : place + rows] = system.drive
        self.first[lane], self.stride[lane], self.done[lane] = place, 1, 0
        self.states[:, lane] = system.start[:, 0]
        self.constants[:, lane] = system.constants[:, 0]
        return system

    def _widen(self, rows: int) -> None:
        """Make room for a longer motion."""
        lanes = self.most
        wider = np.zeros((lanes * rows + 2, self.drive.shape[1]))
        for lane in range(lanes):
            old, new = lane * self.slot, lane * rows
            wider[new : new + self.slot] = self.drive[old : old + self.slot]
            is_idle = self.stride[lane] == 0
            self.first[lane] = lanes * rows if is_idle else new + self.done[lane]
        self.slot, self.drive = rows, wider

    def release(self, lane: int) -> None:
        self.states[:, lane] = self.idle[:, 0]
        self.first[lane], self.stride[lane] = self.most * self.slot, 0

    def march(self, left: dict[int, int]) -> None:
        frames = self.kernel.call(
            self.states,
            self.constants,
            self.geometry,
            self.drive,
            (self.first, self.stride),
            min(CHUNK, *left.values()) if left else 0,
            self.most,
            self.refresh_steps,
        )
        self.first += frames * self.stride
        self.done += frames

    def frames_done(self, lane: int) -> int:
        return int(self.done[lane])

    def state(self, lane: int) -> np.ndarray[Any, np.dtype[np.float64]]:
        return self.states[:, lane : lane + 1]


def lanes_on(device: str) -> MakeLanes:
    """Where batches march.

    Raises
    ------
    InputError
        If the device is neither ``cpu`` nor ``cuda``, or there is no GPU to be used.
    """
    require_known(device)
    if device == "cpu":
        return _Abreast
    require_device()
    return DeviceLanes


def run_here(
    scenarios: Iterator[tuple[int, Scenario]],
    stop: threading.Event,
    refresh_steps: int = REFRESH_STEPS,
    singly: bool = False,
    make_lanes: MakeLanes = _Abreast,
) -> Iterator[tuple[int, Measures]]:
    """Run numbered scenarios on this thread: one thread's share of `simulate_many`.

    Parameters
    ----------
    scenarios : iterator of (int, Scenario)
        Drawn as they are needed.
    stop : threading.Event
        Once it is set, no more rows come.
    refresh_steps, singly, make_lanes
        What `simulate_many` has chosen.

    Yields
    ------
    index : int
    row : dict
    """
    batches: dict[Any, _Batch] = {}
    for index, scenario in scenarios:
        begin = time.perf_counter()
        try:
            settled_scenario, choice = settled(scenario)
            system = assemble(settled_scenario)
            if singly or _by_itself(scenario.solver):
                row = assess(replace(simulate(system), time_step=choice))
            else:
                row = None
                if settled_scenario.solver.substeps is None:
                    system = system.with_substeps(SUBSTEPS)
        except Exception as error:  # the others shall not suffer
            row = failed_row(error)
        if row is not None:
            yield index, row
            continue
        key = group_of(system)
        if key not in batches:
            if len(batches) >= OPEN_BATCHES:
                oldest = batches.pop(next(iter(batches)))
                yield from oldest.drained(stop)
            batches[key] = _Batch(system, refresh_steps, make_lanes)
        batch = batches[key]
        while batch.is_full and not stop.is_set():
            yield from batch.advance()
        if stop.is_set():
            return
        batch.load(_Job(index, system, begin, choice))
    for batch in batches.values():
        yield from batch.drained(stop)


def _by_itself(solver: Solver) -> bool:
    """Whether a scenario asks for what many abreast do not do."""
    return solver.contact == "grid" or solver.hinge_solve == "newton"


def group_of(system: System) -> Any:
    """What scenarios must share to go abreast; hashable."""
    # the batch keeps the table alive, so its identity is not used again
    return (
        tuple(system.choices.items()),
        system.layout.key,
        system.dt,
        system.frame_steps,
        system.substeps,
        system.drive.shape[1],
        id(system.geometry.table),
    )


def prepare(system: System, make_lanes: MakeLanes, notify: Callable[[str], None]) -> None:
    """Compile or load the kernel that many scenarios of this group take; say if it takes long."""
    batch = _Batch(system, REFRESH_STEPS, make_lanes)
    if batch.lanes.compiling is not None:
        notify(batch.lanes.compiling)
    batch.advance()


@dataclass
class _Job:
    index: int
    system: System
    begin: float
    choice: TimeStep | None
    march_s: float = 0.0


class _Batch:
    """Runs that advance together."""

    def __init__(
        self, system: System, refresh_steps: int, make_lanes: MakeLanes = _Abreast
    ) -> None:
        steps = min(refresh_steps, round(REFRESH_TIME / system.dt))
        self.lanes = make_lanes(system, max(1, steps // system.substeps))
        self.free = list(range(self.lanes.most))[::-1]
        self.jobs: dict[int, _Job] = {}  # by lane

    @property
    def is_full(self) -> bool:
        """Whether no lane is free."""
        return not self.free or self.lanes.is_full

    def load(self, job: _Job) -> None:
        """Give a free lane a scenario."""
        lane = self.free.pop()
        self.jobs[lane] = replace(job, system=self.lanes.load(lane, job.system))

    def advance(self) -> list[tuple[int, Measures]]:
        """Run until a lane ends, or a while; the rows of what has ended."""
        begin = time.perf_counter()
        self.lanes.march(
            {
                lane: job.system.frames - self.lanes.frames_done(lane)
                for lane, job in self.jobs.items()
            }
        )
        share = (time.perf_counter() - begin) / max(len(self.jobs), 1)
        rows = []
        for lane, job in list(self.jobs.items()):
            job.march_s += share
            state_now = self.lanes.state(lane)
            done = self.lanes.frames_done(lane)
            diverged = state_now[job.system.layout.state.DIVERGED, 0] > 0.0
            if diverged or done >= job.system.frames:
                rows.append((job.index, _row(job, state_now.copy(), done)))
                del self.jobs[lane]
                self.lanes.release(lane)
                self.free.append(lane)
        return rows

    def drained(self, stop: threading.Event) -> Iterator[tuple[int, Measures]]:
        """Run all lanes to their ends."""
        while self.jobs and not stop.is_set():
            yield from self.advance()


def failed_row(error: Exception) -> Measures:
    """The row of a scenario that could not be run."""
    is_input = isinstance(error, InputError)
    text = str(error) if is_input else f"unexpected: {on_one_line(error)}"
    return {"status": "failed", "error": text}


def _row(job: _Job, end: np.ndarray[Any, np.dtype[np.float64]], frames: int) -> Measures:
    system = job.system
    try:
        return assess(
            Response(
                system=system,
                end=end,
                frames=np.empty((frames + 1, 0)),
                audit=audit(system, end),
                wall_s=time.perf_counter() - job.begin,
                march_s=job.march_s,
                time_step=job.choice,
            )
        )
    except Exception as error:
        return failed_row(error)
