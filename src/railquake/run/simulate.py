"""One run: assemble a scenario, march it and give the response."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from railquake.assembly import System, assemble
from railquake.march.compiler import SCALAR, Target
from railquake.run.assess import assess
from railquake.run.audit import audit
from railquake.run.response import Channel, Response, channels
from railquake.run.time_step import TimeStep, search_time_step

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario

__all__ = ["settled", "simulate"]

CHUNK = 500  # frames between two signs of life
COMPILING = "compiling the kernel for this machine (once; about half a minute) ..."


def simulate(
    scenario: Scenario | System,
    *,
    progress: Callable[[int, int], None] | None = None,
    notify: Callable[[str], None] | None = None,
    target: Target = SCALAR,
) -> Response:
    """Run one scenario.

    Parameters
    ----------
    scenario : Scenario or System
    progress : callable, optional
        Called with the frames done and all frames, some times a second.
    notify : callable, optional
        Called with a line of text before something that takes long, such as compiling.
    target : Target
        Where the kernel runs; ``PYTHON`` for the uncompiled physics.

    Returns
    -------
    Response

    Raises
    ------
    InputError
        If the scenario cannot be run; see `assemble`.
    """
    begin = time.perf_counter()
    choice = None
    if isinstance(scenario, System):
        system = scenario
    else:
        scenario, choice = settled(scenario, notify)
        system = assemble(scenario)
    kernel = system.kernel(target)
    kept = channels(system)
    rows = np.array([channel.row for channel in kept])
    end = system.start.copy()
    frames = np.empty((system.frames + 1, len(rows)))
    frames[0] = end[rows, 0]
    if not kernel.is_cached and notify is not None:
        notify(COMPILING)
    # no frames: compiles or loads the kernel, so that the march is timed without it
    kernel.call(end, system.constants, system.geometry, system.drive, 0, rows, frames)
    march = time.perf_counter()
    done = 0
    while done < system.frames:
        count = min(CHUNK, system.frames - done)
        done += kernel.call(
            end, system.constants, system.geometry, system.drive, count, rows, frames
        )
        if progress is not None:
            progress(done, system.frames)
        if end[system.layout.state.DIVERGED, 0] > 0.0:
            frames = frames[: done + 1]
            break
    now = time.perf_counter()
    _absolute(frames, kept)
    _forget_train(frames, kept, end, system)
    return Response(
        system=system,
        end=end,
        frames=frames,
        audit=audit(system, end),
        wall_s=now - begin,
        march_s=now - march,
        time_step=choice,
    )


def settled(
    scenario: Scenario, notify: Callable[[str], None] | None = None
) -> tuple[Scenario, TimeStep | None]:
    """A scenario with its time step, and how that was chosen where it says ``dt = "auto"``.

    Many scenarios of one study are better settled together, by `many.choose_time_step`.
    """
    if scenario.solver.dt != "auto":
        return scenario, None
    choice = search_time_step([scenario], lambda cases: [assess(simulate(case)) for case in cases])
    if notify is not None:
        notify(choice.text)
    return choice.settled(scenario), choice


def _absolute(frames: np.ndarray, kept: Sequence[Channel]) -> None:
    """Turn the march's own quantities into those that a history shows."""
    column = {channel.name: k for k, channel in enumerate(kept)}
    # the structure's acceleration is marched relative to the ground
    frames[:, column["bridge_acceleration_m_s2"]] += frames[:, column["ground_acceleration_m_s2"]]
    # the contact forces are kept as they act on the wheelset
    frames[:, column["lateral_force_n"]] *= -1.0


def _forget_train(
    frames: np.ndarray, kept: Sequence[Channel], end: np.ndarray, system: System
) -> None:
    """NaN for the train's motion once it has left the track."""
    state = system.layout.state
    left = float(end[state.LEFT_TIME, 0])
    if left < 0.0:
        return
    last = round(left / (system.dt * system.frame_steps))
    frames[last + 1 :, [channel.train for channel in kept]] = np.nan
