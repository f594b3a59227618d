"""Stages once a frame: events, derailment, divergence, and the train that leaves the model."""

from typing import Any

import numpy as np

from railquake.march.contact import displacement
from railquake.march.packing import reader
from railquake.march.rows import constant, size, state
from railquake.march.sprung import vehicle_energy
from railquake.physics.derailment import (
    BEYOND_BODY,
    BEYOND_STOP,
    CHATTER,
    CLIMB,
    FLANGE_CONTACT,
    FLANGE_OVER,
    ONSET,
    OVERTURNED,
    SLIDE_OFF,
    UPLIFT,
    Events,
    Limits,
    Wheel,
    bears,
    clearance,
    events,
    flange_tip,
    goes_to,
    gone_to,
    has_left,
    passed_crown,
    side_of,
)
from railquake.physics.elementary import floor_of

__all__ = ["BOUND", "detect_events", "release_train"]

Array = np.ndarray[Any, np.dtype[np.float64]]

BOUND = 5.0  # m or rad; what is farther from where it belongs has diverged

read_limits = reader(Limits)


def detect_events(S: Array, Q: Array, lane: int) -> None:
    """Events, derailment, the end of the model and divergence."""
    left = look_at_wheel(S, Q, 0, lane)
    right = look_at_wheel(S, Q, 1, lane)
    on = S[state.ON_TRACK, lane]
    S[state.PEAK_CLEARANCE, lane] = max(
        S[state.PEAK_CLEARANCE, lane], clearance(left, right) if on > 0.0 else -1.0
    )
    limits = read_limits(Q, constant.LIMITS, lane)
    held = events(S[state.ROLL, lane], left, right, limits)
    goes = goes_to(S[state.ROLL, lane], left, right)
    count_uplifts(S, held.uplift, lane)
    off = gone_to(right, limits) - gone_to(left, limits)
    keep_events(S, held, left, right, (goes, off), lane)
    watch_model(S, Q, lane)
    follow_train(S, Q, goes, lane)
    watch_bounds(S, Q, lane)


def look_at_wheel(S: Array, Q: Array, side: int, lane: int) -> Wheel:
    """The wheels of a side, and how their flange came above the crown."""
    sign = 2.0 * side - 1.0
    flange = S[state.PATCH_PENETRATION + 2 * side + 1, lane]
    tip_y, tip_z = flange_tip(
        (sign * S[state.SHIFT, lane], S[state.HEIGHT, lane]),
        sign * S[state.ROLL_SIN, lane],
        S[state.ROLL_COS, lane],
        (Q[constant.TIP_Y, lane], Q[constant.TIP_Z, lane]),
    )
    passed = passed_crown(S[state.PASSED_CROWN + side, lane], tip_z, flange)
    S[state.PASSED_CROWN + side, lane] = passed
    return Wheel(
        displacement(S, Q, side, lane),
        tip_y,
        tip_z,
        S[state.PATCH_PENETRATION + 2 * side, lane],
        flange,
        passed,
    )


def count_uplifts(S: Array, lifted: bool, lane: int) -> None:
    """A wheel that lifts again at once, as it lands, has not come back in between."""
    time = S[state.TIME, lane]
    flags = S[state.FLAGS, lane]
    # the event's bit of the last frame
    was_up = floor_of(flags / 2.0**UPLIFT) - 2.0 * floor_of(flags / 2.0 ** (UPLIFT + 1))
    now_up = S[state.ON_TRACK, lane] if lifted else 0.0
    ended = S[state.UPLIFT_END, lane]
    begins = now_up * (1.0 - was_up)
    is_new = ended < 0.0 or time - ended > CHATTER
    S[state.UPLIFTS, lane] += begins if is_new else 0.0
    S[state.UPLIFT_END, lane] = time if was_up * (1.0 - now_up) > 0.0 else ended


def keep_events(
    S: Array, held: Events, left: Wheel, right: Wheel, motion: tuple[float, float], lane: int
) -> None:
    """Which events hold; of each, when it first did, to which side and where the wheelset was.

    ``motion`` is the wheelset's displacement and, where a wheel has left its rail, whereto.
    """
    goes, off = motion
    roll = 1.0 if S[state.ROLL, lane] > 0.0 else -1.0
    onwards = 1.0 if (goes if off == 0.0 else off) > 0.0 else -1.0
    # a train leaves its rails once
    slides = held.slide_off and S[state.FIRST_TIME + CLIMB, lane] < 0.0
    climbs = held.climb and S[state.FIRST_TIME + SLIDE_OFF, lane] < 0.0
    flange = side_of(left.flange > 0.0, right.flange > 0.0, onwards)
    lifted = side_of(not bears(left), not bears(right), -roll)
    over = side_of(left.tip_z < 0.0, right.tip_z < 0.0, -roll)
    S[state.FLAGS, lane] = (
        keep_first(S, FLANGE_CONTACT, held.flange_contact, flange, goes, lane)
        + keep_first(S, UPLIFT, held.uplift, lifted, goes, lane)
        + keep_first(S, ONSET, held.onset, lifted, goes, lane)
        + keep_first(S, FLANGE_OVER, held.flange_over, over, goes, lane)
        + keep_first(S, SLIDE_OFF, slides, onwards, goes, lane)
        + keep_first(S, CLIMB, climbs, onwards, goes, lane)
        + keep_first(S, OVERTURNED, held.overturned, roll, goes, lane)
    )


def keep_first(S: Array, event: int, holds: bool, side: float, goes: float, lane: int) -> float:
    """Keep when an event first held, and how; its flag, 2^event, if it holds now."""
    holds_now = holds and S[state.ON_TRACK, lane] > 0.0
    begins = holds_now and S[state.FIRST_TIME + event, lane] < 0.0
    S[state.FIRST_TIME + event, lane] = (
        S[state.TIME, lane] if begins else S[state.FIRST_TIME + event, lane]
    )
    S[state.FIRST_SIDE + event, lane] = side if begins else S[state.FIRST_SIDE + event, lane]
    S[state.FIRST_DISPLACEMENT + event, lane] = (
        goes if begins else S[state.FIRST_DISPLACEMENT + event, lane]
    )
    S[state.FIRST_ROLL + event, lane] = (
        S[state.ROLL, lane] if begins else S[state.FIRST_ROLL + event, lane]
    )
    return 2.0**event if holds_now else 0.0


def watch_model(S: Array, Q: Array, lane: int) -> None:
    """Keep when the car first was where its model ends, and why."""
    body = abs(centre_of_gravity(S, Q, lane)) > Q[constant.BODY_LIMIT, lane]
    reason = BEYOND_BODY * 1.0 if body else 0.0
    for k in range(size.STOPS):
        past = S[state.STOP_TRAVEL + k, lane] > Q[constant.STOP_END + k, lane]
        reason = BEYOND_STOP * 1.0 if past else reason
    begins = reason * S[state.ON_TRACK, lane] > 0.0 and S[state.BEYOND_TIME, lane] < 0.0
    S[state.BEYOND_TIME, lane] = S[state.TIME, lane] if begins else S[state.BEYOND_TIME, lane]
    S[state.BEYOND_REASON, lane] = reason if begins else S[state.BEYOND_REASON, lane]


def centre_of_gravity(S: Array, Q: Array, lane: int) -> float:
    """Of the vehicle, from the middle of the track along the ground's horizontal, m."""
    moved = 0.0
    for k in range(size.BODIES):
        moved += Q[constant.BODY_MASS + k, lane] * S[state.VEHICLE_X + 2 * k, lane]
    from_track: float = moved / Q[constant.VEHICLE_MASS, lane] - S[state.TRACK_Y, lane]
    return from_track


def follow_train(S: Array, Q: Array, goes: float, lane: int) -> None:
    """A derailed train is followed for a while, and then leaves the model."""
    time = S[state.TIME, lane]
    slid = S[state.FIRST_TIME + SLIDE_OFF, lane]
    climbed = S[state.FIRST_TIME + CLIMB, lane]
    overturned = S[state.FIRST_TIME + OVERTURNED, lane]
    is_off = slid >= 0.0 or climbed >= 0.0
    has_derailed = is_off or overturned >= 0.0
    first = S[state.DERAILED_TIME, lane]
    S[state.DERAILED_TIME, lane] = time if (first < 0.0 and has_derailed) else first
    leaves = has_derailed and has_left(
        S[state.ROLL, lane],
        (goes, S[state.HEIGHT, lane] + Q[constant.WHEELSET_HEIGHT, lane]),
        time - S[state.DERAILED_TIME, lane],
        is_off and overturned >= 0.0,
    )
    leaving = S[state.ON_TRACK, lane] if leaves else 0.0
    S[state.LEAVING, lane] = leaving
    S[state.LEFT_TIME, lane] = time if leaving > 0.0 else S[state.LEFT_TIME, lane]


def watch_bounds(S: Array, Q: Array, lane: int) -> None:
    """Whether a state has left every plausible bound."""
    # NaN fails every comparison, so it counts as diverged
    plausible = (
        abs(S[state.U, lane]) < BOUND
        and abs(S[state.THETA2, lane]) < BOUND
        and abs(S[state.SHIFT, lane]) < BOUND
        and abs(S[state.ROLL, lane]) < BOUND
        and abs(S[state.HEIGHT, lane] + Q[constant.WHEELSET_HEIGHT, lane]) < BOUND
    )
    S[state.DIVERGED, lane] = S[state.DIVERGED, lane] if plausible else 1.0


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
