"""A car by itself: its wheelset held to the moving ground, its bodies marched as in `step`."""

from typing import Any

import numpy as np

from railquake.march.rows import constant, size, state
from railquake.march.sprung import accelerate_free, lose_to_dashpots, predict_sprung, work_on_bodies

__all__ = ["march_held"]

Array = np.ndarray[Any, np.dtype[np.float64]]


def march_held(S: Array, Q: Array, drive: Array, channels: Array, history: Array) -> None:
    """Run a car whose wheelset is held fast.

    Parameters
    ----------
    S, Q : array, shape (its rows, 1)
        Rows of `rows_state` and `rows_constant`.
    drive : array, shape (frames + 1, 2)
        Ground acceleration, right and down, at the frames' ends, m/s2.
    channels : array, shape (n,)
        Numbers of the rows of the state to keep.
    history : array, shape (frames + 1, n)
        Filled in; its first row is the state at the start.
    """
    steps = int(Q[constant.FRAME_STEPS, 0])
    for channel in range(len(channels)):
        history[0, channel] = S[channels[channel], 0]
    for frame in range(len(drive) - 1):
        for n in range(1, steps + 1):
            place = n / steps
            for i in range(size.WHEELSET_Y):
                predict_sprung(S, Q, i, 0)
            for i in range(2 * size.BODIES, size.WHEELSET_Z):
                predict_sprung(S, Q, i, 0)
            before = S[state.GROUND, 0], S[state.GROUND_Z, 0]
            S[state.GROUND, 0] = drive[frame, 0] + place * (drive[frame + 1, 0] - drive[frame, 0])
            S[state.GROUND_Z, 0] = drive[frame, 1] + place * (drive[frame + 1, 1] - drive[frame, 1])
            S[state.GROUND_SLOPE, 0] = S[state.GROUND, 0] - before[0]
            S[state.GROUND_Z_SLOPE, 0] = S[state.GROUND_Z, 0] - before[1]
            work_on_bodies(S, Q, 0)
            accelerate_free(S, Q, 1)
            lose_to_dashpots(S, Q, 0)
        for channel in range(len(channels)):
            history[frame + 1, channel] = S[channels[channel], 0]
