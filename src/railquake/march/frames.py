"""A run is a sequence of frames, for one scenario, for many abreast or a thread each on a GPU.

A *frame* has a fixed number of time steps (1 ms by default).  Peaks and energies are taken at
every step; events, low-pass filters, oscillators on the track, the test for derailment and the
history once a frame.  Within a frame the ground's acceleration is linear.
"""

from typing import Any

import numpy as np

from railquake.march.climb import measure_climb
from railquake.march.contact import look_at_flanges
from railquake.march.events import detect_events, release_train
from railquake.march.ground import begin_frame
from railquake.march.momentum import close_momentum, open_momentum
from railquake.march.peaks import OSCILLATORS, filter_forces, measure_bodies, swing_on_track
from railquake.march.rows import constant, size, state
from railquake.march.step import step
from railquake.march.structure import refresh_hinge
from railquake.physics.profiles import Geometry

__all__ = [
    "look_again",
    "look_again_abreast",
    "march",
    "march_abreast",
    "march_on_device",
    "nothing_again",
    "own_constants",
    "own_state",
    "thread_number",
]

Array = np.ndarray[Any, np.dtype[np.float64]]


def own_state() -> Array:
    """Memory for the state of a batch, or of a thread; bound to the target's own."""
    return np.empty((size.STATE_ROWS, size.LANES))


def own_constants() -> Array:
    """Memory for the constants of a batch, or of a thread; bound to the target's own."""
    return np.empty((size.CONSTANT_ROWS, size.LANES))


def thread_number() -> int:
    """Number of this thread among all that run at once; bound to the device's own."""
    return 0


def copy_rows(source: Array, target: Array) -> None:
    """All rows of all lanes."""
    for row in range(target.shape[0]):
        for lane in range(target.shape[1]):
            target[row, lane] = source[row, lane]


def run_frame(S: Array, Q: Array, geometry: Geometry, lanes: int, refresh: int) -> None:
    """All steps of a frame, and what is done at its end.

    ``refresh`` is the number of the structure's steps between two looks at what changes slowly.
    """
    steps = int(Q[constant.FRAME_STEPS, 0])
    substeps = int(Q[constant.SUBSTEPS, 0])
    for lane in range(lanes):
        open_momentum(S, Q, lane)
    for n in range(steps // substeps):
        if n % refresh == 0:
            look_again(S, Q, geometry, lanes)
        step(S, Q, geometry, lanes, substeps)
    for lane in range(lanes):
        S[state.FRAMES, lane] += 1.0
        S[state.TIME, lane] = S[state.FRAMES, lane] * steps * Q[constant.DT, lane]
    for lane in range(lanes):
        close_momentum(S, Q, lane)
    for lane in range(lanes):
        filter_forces(S, Q, lane)
    measure_climb(S, Q, lanes)
    for lane in range(lanes):
        measure_bodies(S, Q, lane)
    for n in range(OSCILLATORS):
        for lane in range(lanes):
            swing_on_track(S, Q, n, lane)
    for lane in range(lanes):
        detect_events(S, Q, lane)


def release_trains(S: Array, Q: Array, lanes: int) -> bool:
    """Trains that have derailed leave the model; whether any lane has diverged."""
    diverged = 0.0
    for lane in range(lanes):
        if S[state.LEAVING, lane] > 0.0:
            release_train(S, Q, lane)
        diverged = max(diverged, S[state.DIVERGED, lane])
    return diverged > 0.0


def look_again(S: Array, Q: Array, geometry: Geometry, lanes: int) -> None:
    """Slot of the engine: now and then, what changes slowly."""
    raise NotImplementedError("an engine is chosen when a kernel is bound")


def look_again_abreast(S: Array, Q: Array, geometry: Geometry, lanes: int) -> None:
    """Degradation of the hinge, and how near the flanges are to their rails."""
    for lane in range(lanes):
        refresh_hinge(S, Q, lane)
    for lane in range(lanes):
        look_at_flanges(S, Q, geometry, lane)


def nothing_again(S: Array, Q: Array, geometry: Geometry, lanes: int) -> None:
    """One scenario by itself looks at everything in every step."""


def march(
    state_in: Array,
    constants: Array,
    geometry: Geometry,
    drive: Array,
    frames: int,
    rows: Array,
    history: Array,
) -> int:
    """Run ``frames`` frames of one scenario and note each frame's state.

    A run that diverges stops at the end of that frame.

    Parameters
    ----------
    state_in : array, shape (state rows, 1)
        State at the start; holds the state at the end on return.
    constants : array, shape (constant rows, 1)
    geometry : Geometry
    drive : array, shape (all frames + 1, 3 or 9)
        Ground acceleration, lateral and vertical (down), m/s2, and lateral velocity, m/s, at the
        frames' ends, and the motion of a prescribed track (see
        `ground.begin_frame_on_prescribed_track`).
    frames : int
    rows : array of int, shape (channels,)
        State rows to keep.
    history : array, shape (all frames + 1, channels)
        Row k is the state at the end of frame k (row 0, the start, is not written).

    Returns
    -------
    int
        Frames that it ran.
    """
    S = own_state()
    Q = own_constants()
    copy_rows(state_in, S)
    copy_rows(constants, Q)
    first = int(S[state.FRAMES, 0])
    frame = first
    end = first + frames
    while frame < end:
        begin_frame(S, Q, drive, frame, 0)
        run_frame(S, Q, geometry, size.LANES, 1)
        frame += 1
        for k in range(len(rows)):
            history[frame, k] = S[rows[k], 0]
        if release_trains(S, Q, size.LANES):
            end = frame
    copy_rows(S, state_in)
    return frame - first


def march_abreast(
    state_in: Array,
    constants: Array,
    geometry: Geometry,
    drive: Array,
    lane_rows: tuple[Array, Array],
    frames: int,
    lanes: int,
    refresh: int,
) -> int:
    """Run ``frames`` frames of several scenarios in lockstep, one to a lane.

    Every lane takes the same path through the same instructions: what it gives does not depend on
    its neighbours.  If one diverges, all stop at the end of that frame.

    Parameters
    ----------
    state_in, constants : array, shape (its rows, LANES)
        As in `march`; the frame's number of steps must be the same in all lanes.
    geometry : Geometry
    drive : array, shape (any, 3 or 9)
        Drives of all lanes, one after the other.
    lane_rows : (first, stride), arrays of int, shape (LANES,)
        Row of ``drive`` at which each lane's first frame begins, and rows to the next frame (0
        holds an idle lane where it is).
    frames, lanes : int
        ``lanes`` is LANES; as an argument it keeps the compiler from unrolling the loops.
    refresh : int
        The structure's steps between two evaluations of the hinge's degradation, and between two
        looks at flanges that are far from their rails.

    Returns
    -------
    int
        Frames that they ran.
    """
    S = own_state()
    Q = own_constants()
    copy_rows(state_in, S)
    copy_rows(constants, Q)
    first, stride = lane_rows
    frame = 0
    end = frames
    while frame < end:
        for lane in range(lanes):
            begin_frame(S, Q, drive, first[lane] + frame * stride[lane], lane)
        run_frame(S, Q, geometry, lanes, refresh)
        frame += 1
        if release_trains(S, Q, lanes):
            end = frame
    copy_rows(S, state_in)
    return frame


def march_on_device(
    states: Array,
    constants: Array,
    geometry: Geometry,
    drive: Array,
    first: Array,
    frames: Array,
    refresh: int,
) -> None:
    """Run some frames of many scenarios, each by a thread of its own.

    A lane that has diverged stops at the end of that frame.

    Parameters
    ----------
    states : array, shape (lanes, state rows)
        State of each lane, in and out; a lane's rows lie together, for the host's sake.
    constants : array, shape (lanes, constant rows)
    geometry : Geometry
    drive : array, shape (any, 3 or 9)
        Drives of all lanes, one after the other; lanes may share one.
    first : array of int, shape (lanes,)
        Row of ``drive`` at which each lane's motion begins.
    frames : array of int, shape (lanes,)
        Frames to run now; 0 for an idle lane.
    refresh : int
        As in `march_abreast`.
    """
    column = thread_number()
    count = frames[column] if column < len(frames) else 0
    if count > 0:
        S = own_state()
        Q = own_constants()
        for row in range(size.STATE_ROWS):
            S[row, 0] = states[column, row]
        for row in range(size.CONSTANT_ROWS):
            Q[row, 0] = constants[column, row]
        frame = int(S[state.FRAMES, 0])
        end = frame + count
        while frame < end:
            begin_frame(S, Q, drive, first[column] + frame, 0)
            run_frame(S, Q, geometry, size.LANES, refresh)
            frame += 1
            if release_trains(S, Q, size.LANES):
                end = frame
        for row in range(size.STATE_ROWS):
            states[column, row] = S[row, 0]
