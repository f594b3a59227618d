"""Batches of runs: what one task does."""

from __future__ import annotations

import os
import platform
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from railquake.errors import InputError
from railquake.memory import Bounded
from railquake.run.assess import physics
from railquake.run.many import failed_row, run_here
from railquake.study.design import Design

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario
    from railquake.run.time_step import TimeStep
    from railquake.study.file import StudyInputs

__all__ = ["Batch", "Ended", "kept_design", "refuse_other_physics", "run_batch"]

Ended = list[tuple[int, dict[str, Any]]]
"""Rows that have ended, and their measures."""


@dataclass(frozen=True)
class Batch:
    """Work for one task: some rows of a study.

    Attributes
    ----------
    key : str
        Tells studies apart within a process.
    study : StudyInputs
        Its suite loaded.
    time_step : TimeStep or None
        Where the study leaves it open.
    rows : tuple of int
    physics : str
        See `physics`: of the process that made the batch.
    """

    key: str
    study: StudyInputs
    time_step: TimeStep | None
    rows: tuple[int, ...]
    physics: str


def refuse_other_physics(workers: Mapping[str, str], ours: str) -> None:
    """Refuse workers whose rows would not be those of this process.

    Parameters
    ----------
    workers : mapping of str to str
        What each computes with, by its name; see `physics`.
    ours : str

    Raises
    ------
    InputError
        Naming the first of them.
    """
    for name, theirs in workers.items():
        if theirs != ours:
            raise InputError(
                f"study: the worker {name} has physics {theirs}, the study {ours}; give it the "
                "same versions of railquake, Numba and llvmlite, and run the same command again"
            )


_DESIGNS = Bounded[str, Design](4)


def run_batch(batch: Batch, stop: threading.Event | None = None) -> Ended:
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

    Raises
    ------
    InputError
        If this process has other physics than the one that made the batch.
    """
    refuse_other_physics({f"{platform.node()}, process {os.getpid()}": physics()}, batch.physics)
    stop = threading.Event() if stop is None else stop
    design = _DESIGNS.get(batch.key, lambda: Design(batch.study, batch.time_step))
    done: Ended = []

    def scenarios() -> Iterator[tuple[int, Scenario]]:
        for row in batch.rows:
            if stop.is_set():
                return
            try:
                yield row, design.scenario(design.point(row))
            except Exception as error:  # the others shall not suffer
                done.append((row, failed_row(error)))

    for ended in run_here(scenarios(), stop):
        done.append(ended)
    return done


@contextmanager
def kept_design(key: str, design: Design) -> Iterator[None]:
    """Let the tasks of this process find the design; forget it afterwards."""
    _DESIGNS.put(key, design)
    try:
        yield
    finally:
        _DESIGNS.forget(key)
