"""Stages once a frame: means that slide over a window, of Y/Q and of what the treads bear."""

from typing import Any

import numpy as np

from railquake.march.packing import reader
from railquake.march.peaks import raise_peak
from railquake.march.rows import constant, state
from railquake.physics.derailment import lateral_over_vertical, least_load
from railquake.physics.sliding_mean import BLOCKS, Filling, Window, filled

__all__ = ["measure_climb", "slide"]

Array = np.ndarray[Any, np.dtype[np.float64]]

read_window = reader(Window)


def measure_climb(S: Array, Q: Array, lanes: int) -> None:
    """Means of low-passed Y/Q of each side; and of the lateral force while no flange bears."""
    for lane in range(lanes):
        least = least_load(Q[constant.STATIC_WHEEL_LOAD, lane])
        # of each wheel towards its own flange
        left = lateral_over_vertical(
            -S[state.LATERAL_LEFT_FILTERED, lane], S[state.LOAD_LEFT_FILTERED, lane], least
        )
        right = lateral_over_vertical(
            S[state.LATERAL_RIGHT_FILTERED, lane], S[state.LOAD_RIGHT_FILTERED, lane], least
        )
        on = S[state.ON_TRACK, lane]
        left_mean = slide(S, Q, 0, left, constant.CLIMB_WINDOW, on, lane)
        right_mean = slide(S, Q, 1, right, constant.CLIMB_WINDOW, on, lane)
        raise_peak(S, state.PEAK_CLIMB_LEFT, max(left_mean, 0.0), lane)
        raise_peak(S, state.PEAK_CLIMB_RIGHT, max(right_mean, 0.0), lane)
    for lane in range(lanes):
        # a flange that bears begins the window anew
        free = 0.0 if S[state.FLANGE_BORE, lane] > 0.0 else S[state.ON_TRACK, lane]
        treads = S[state.MEAN_TREADS, lane]
        sustained = slide(S, Q, 2, treads, constant.SUSTAINED_WINDOW, free, lane)
        raise_peak(S, state.PEAK_LATERAL_SUSTAINED, sustained, lane)
        S[state.FLANGE_BORE, lane] = 0.0


def slide(
    S: Array, Q: Array, number: int, value: float, window: int, on: float, lane: int
) -> float:
    """Sliding mean number ``number`` at the end of a frame; 0 where no window ends with it.

    Parameters
    ----------
    S, Q : array, shape (its rows, lanes)
    number : int
        Of `rows_state.SLIDING`.
    value : float
        Mean over the frame.
    window : int
        First row of its `Window`.
    on : float
        1; or 0 in a frame after which a window begins anew.
    lane : int
    """
    by = read_window(Q, window, lane)
    filling = Filling(
        S[state.BLOCK_SHARE + number, lane],
        S[state.BLOCK_PART + number, lane],
        S[state.BLOCKS_BEFORE + number, lane],
    )
    now = filled(value, filling, by)
    total = 0.0
    # blocks that a short window does not have stay zero
    for k in range(BLOCKS):
        row = state.BLOCK_MEAN + BLOCKS * number + k
        kept = now.mean if now.ends and now.at == k else S[row, lane]
        S[row, lane] = kept
        total += kept
    S[state.BLOCK_SHARE + number, lane] = on * now.then.share
    S[state.BLOCK_PART + number, lane] = on * now.then.part
    S[state.BLOCKS_BEFORE + number, lane] = on * now.then.before
    return on * total / by.blocks if now.is_full else 0.0
