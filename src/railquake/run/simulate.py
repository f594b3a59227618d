"""One run: assemble a scenario, march it and give the response."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from railquake.assembly import System, assemble
from railquake.physics import state
from railquake.physics.energy import audit
from railquake.physics.kernel import SCALAR, Target
from railquake.run.assess import assess
from railquake.run.response import Response, channels
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
    rows = np.array([row for _, row, _, _ in channels(system.vehicle.bodies)])
    end = system.start.copy()
    frames = np.empty((system.frames + 1, len(rows)))
    frames[0] = end[rows, 0]
    if not kernel.is_cached and notify is not None:
        notify(COMPILING)
    # no frames: compiles or loads the kernel, so that the march is timed without it
    kernel.call(end, system.constants, system.geometry, system.drive, 0, 0, rows, frames)
    march = time.perf_counter()
    done = 0
    while done < system.frames:
        count = min(CHUNK, system.frames - done)
        done += kernel.call(
            end, system.constants, system.geometry, system.drive, done, count, rows, frames
        )
        if progress is not None:
            progress(done, system.frames)
        if end[state.DIVERGED, 0] > 0.0:
            frames = frames[: done + 1]
            break
    now = time.perf_counter()
    _absolute(frames, rows)
    _forget_train(frames, rows, end, system)
    return Response(
        system=system,
        end=end,
        frames=frames,
        audit=audit(system.start, end, system.constants),
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


def _absolute(frames: np.ndarray, rows: np.ndarray) -> None:
    """Turn the kernel's own quantities into those that a history shows."""
    column = {int(row): k for k, row in enumerate(rows)}
    # the pier's acceleration is marched relative to the ground
    frames[:, column[state.U_A]] += frames[:, column[state.GROUND]]
    # the contact forces are kept as they act on the wheelset
    frames[:, column[state.FORCE_Y]] *= -1.0


def _forget_train(frames: np.ndarray, rows: np.ndarray, end: np.ndarray, system: System) -> None:
    """NaN for the train's motion once it has left the track."""
    times = end[state.FIRST_TIME + np.array([state.DERAILED, state.OVERTURNED]), 0]
    left = times[times >= 0.0]
    if end[state.ON_TRACK, 0] > 0.0 or left.size == 0:
        return
    last = round(float(left.min()) / (system.dt * system.frame_steps))
    train = (rows >= state.VEHICLE) | np.isin(rows, (state.SHIFT, state.HEIGHT, state.ROLL))
    penetrations = (rows >= state.PATCH) & (rows < state.PATCHES_END)
    frames[last + 1 :, train | penetrations] = np.nan
