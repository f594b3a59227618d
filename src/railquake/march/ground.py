"""Stages of the shaking ground; within a frame its acceleration is linear."""

from typing import Any

import numpy as np

from railquake.march.rows import constant, state

__all__ = ["begin_frame", "begin_frame_on_ground", "begin_frame_on_prescribed_track", "move_ground"]

Array = np.ndarray[Any, np.dtype[np.float64]]


def begin_frame(S: Array, Q: Array, drive: Array, frame: int, lane: int) -> None:
    """Slot of the support, once a frame: what drives the run during this frame.

    ``frame`` is the row of ``drive`` at which it begins; columns 0 and 1 are the ground's
    acceleration, lateral and down, column 2 its lateral velocity.
    """
    raise NotImplementedError("a support is chosen when a kernel is bound")


def begin_frame_on_ground(S: Array, Q: Array, drive: Array, frame: int, lane: int) -> None:
    """Ground and track at the frame's start; the ground's change per step of the structure."""
    steps = Q[constant.FRAME_STEPS, lane] / Q[constant.SUBSTEPS, lane]
    S[state.GROUND, lane] = drive[frame, 0]
    S[state.GROUND_Z, lane] = drive[frame, 1]
    S[state.GROUND_SLOPE, lane] = (drive[frame + 1, 0] - drive[frame, 0]) / steps
    S[state.GROUND_Z_SLOPE, lane] = (drive[frame + 1, 1] - drive[frame, 1]) / steps
    S[state.GROUND_V, lane] = drive[frame, 2]
    S[state.TRACK_V_BEGUN, lane] = S[state.TRACK_VY, lane] + drive[frame, 2]


def begin_frame_on_prescribed_track(
    S: Array, Q: Array, drive: Array, frame: int, lane: int
) -> None:
    """The cubics of a prescribed track as well.

    Columns 3 to 8 of ``drive`` are y, y', z, z', phi, phi' of the track at the frames' ends.
    """
    begin_frame_on_ground(S, Q, drive, frame, lane)
    S[state.TRACK_V_BEGUN, lane] = drive[frame, 2] + drive[frame, 4]
    length = Q[constant.FRAME_STEPS, lane] * Q[constant.DT, lane]
    S[state.TRACK_PLACE, lane] = 0.0
    S[state.TRACK_RATE, lane] = 1.0 / length
    for k in range(3):
        d0 = length * drive[frame, 4 + 2 * k]
        d1 = length * drive[frame + 1, 4 + 2 * k]
        rise = drive[frame + 1, 3 + 2 * k] - drive[frame, 3 + 2 * k]
        S[state.TRACK_C0 + k, lane] = drive[frame, 3 + 2 * k]
        S[state.TRACK_C1 + k, lane] = d0
        S[state.TRACK_C2 + k, lane] = 3.0 * rise - 2.0 * d0 - d1
        S[state.TRACK_C3 + k, lane] = d0 + d1 - 2.0 * rise


def move_ground(S: Array, Q: Array, lane: int) -> None:
    """Ground acceleration and velocity at the end of the structure's step."""
    mean = S[state.GROUND, lane] + 0.5 * S[state.GROUND_SLOPE, lane]
    S[state.GROUND_V, lane] += mean / Q[constant.RATE, lane]
    S[state.GROUND, lane] += S[state.GROUND_SLOPE, lane]
    S[state.GROUND_Z, lane] += S[state.GROUND_Z_SLOPE, lane]
