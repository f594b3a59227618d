"""Stages once a frame: events, derailment, divergence, and the train that leaves the model."""

from typing import Any

import numpy as np

from railquake.march.packing import reader
from railquake.march.peaks import wheels_off
from railquake.march.rows import constant, size, state
from railquake.march.sprung import vehicle_energy
from railquake.physics.derailment import (
    DERAILED,
    FLANGE_CONTACT,
    FLANGE_OVER,
    ONSET,
    OVERTURNED,
    UPLIFT,
    Limits,
    clearance,
    events,
    flange_tips,
)
from railquake.physics.elementary import floor_of

__all__ = ["BOUND", "detect_events", "release_train"]

Array = np.ndarray[Any, np.dtype[np.float64]]

BOUND = 5.0  # m or rad; what is farther from where it belongs has diverged

read_limits = reader(Limits)


def detect_events(S: Array, Q: Array, lane: int) -> None:
    """Events, derailment and divergence."""
    on = S[state.ON_TRACK, lane]
    shift = S[state.SHIFT, lane]
    roll = S[state.ROLL, lane]
    height = S[state.HEIGHT, lane]
    left_off, right_off = wheels_off(S, lane)
    tips = flange_tips(
        (shift, height),
        S[state.ROLL_SIN, lane],
        S[state.ROLL_COS, lane],
        (Q[constant.TIP_Y, lane], Q[constant.TIP_Z, lane]),
    )
    S[state.PEAK_CLEARANCE, lane] = max(
        S[state.PEAK_CLEARANCE, lane], clearance(tips) if on > 0.0 else -1.0
    )
    held = events(
        (shift, roll),
        tips,
        centre_of_gravity(S, Q, lane),
        max(S[state.PENETRATION_LEFT_FLANGE, lane], S[state.PENETRATION_RIGHT_FLANGE, lane]),
        max(left_off, right_off),
        read_limits(Q, constant.LIMITS, lane),
    )
    flags = S[state.FLAGS, lane]
    time = S[state.TIME, lane]
    # the event's bit of the last frame
    was_up = floor_of(flags / 2.0**UPLIFT) - 2.0 * floor_of(flags / 2.0 ** (UPLIFT + 1))
    now_up = on if held.uplift else 0.0
    S[state.UPLIFTS, lane] += now_up * (1.0 - was_up)
    S[state.UPLIFT_END, lane] = time if was_up * (1.0 - now_up) > 0.0 else S[state.UPLIFT_END, lane]
    S[state.FLAGS, lane] = (
        keep_first(S, FLANGE_CONTACT, held.flange_contact, on, time, lane)
        + keep_first(S, UPLIFT, held.uplift, on, time, lane)
        + keep_first(S, ONSET, held.onset, on, time, lane)
        + keep_first(S, FLANGE_OVER, held.flange_over, on, time, lane)
        + keep_first(S, DERAILED, held.derailed, on, time, lane)
        + keep_first(S, OVERTURNED, held.overturned, on, time, lane)
    )
    # NaN fails every comparison, so it counts as diverged
    plausible = (
        abs(S[state.U, lane]) < BOUND
        and abs(S[state.THETA2, lane]) < BOUND
        and abs(shift) < BOUND
        and abs(roll) < BOUND
        and abs(height + Q[constant.WHEELSET_HEIGHT, lane]) < BOUND
    )
    S[state.DIVERGED, lane] = S[state.DIVERGED, lane] if plausible else 1.0
    S[state.LEAVING, lane] = on if (held.derailed or held.overturned) else 0.0


def centre_of_gravity(S: Array, Q: Array, lane: int) -> float:
    """Of the vehicle, from the middle of the track along the ground's horizontal, m."""
    moved = 0.0
    for k in range(size.BODIES):
        moved += Q[constant.BODY_MASS + k, lane] * S[state.VEHICLE_X + 2 * k, lane]
    from_track: float = moved / Q[constant.VEHICLE_MASS, lane] - S[state.TRACK_Y, lane]
    return from_track


def keep_first(S: Array, event: int, holds: bool, on: float, time: float, lane: int) -> float:
    """Keep when an event first held; its flag, 2^event, if it holds now."""
    first = S[state.FIRST_TIME + event, lane]
    holds_now = holds and on > 0.0
    S[state.FIRST_TIME + event, lane] = time if (holds_now and first < 0.0) else first
    return 2.0**event if holds_now else 0.0


def release_train(S: Array, Q: Array, lane: int) -> None:
    """Take a derailed vehicle out of the model, with its energy on record.

    From then on it stands still and pushes no more; the structure runs on alone.
    """
    leaving = S[state.LEAVING, lane]
    staying = 1.0 - leaving
    S[state.VEHICLE_ENERGY, lane] += leaving * vehicle_energy(S, Q, lane)
    S[state.HERTZ_LEFT, lane] += leaving * S[state.HERTZ_ENERGY, lane]
    S[state.ON_TRACK, lane] *= staying
    for first, end in state.RELEASED:
        for row in range(first, end):
            S[row, lane] *= staying
