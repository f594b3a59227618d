"""Stages that measure: peaks, losses, low-passed forces.  A new measure is accumulated here."""

from typing import Any

import numpy as np

from railquake.march.packing import reader
from railquake.march.rows import constant, state
from railquake.march.rows_state import FILTERED, POWERS
from railquake.march.sprung import stage_travel
from railquake.measures.housner import PERIODS
from railquake.physics.derailment import climbing_time, derailment_coefficient, least_load
from railquake.physics.elementary import larger_of
from railquake.physics.low_pass import Coefficients, Memory, low_pass
from railquake.physics.oscillator import Step, swing

__all__ = [
    "filter_forces",
    "measure_bodies",
    "measure_contact",
    "measure_structure",
    "raise_peak",
    "swing_on_track",
    "wheels_off",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

FILTERS = len(FILTERED)
KINDS = len(POWERS)
OSCILLATORS = len(PERIODS)

read_coefficients = reader(Coefficients)
read_swing = reader(Step)


def raise_peak(S: Array, row: int, value: float, lane: int) -> None:
    """Keep the largest absolute value."""
    S[row, lane] = larger_of(S[row, lane], abs(value))


def measure_structure(S: Array, lane: int) -> None:
    """Peaks of the structure and of the track on it."""
    raise_peak(S, state.PEAK_U, S[state.U, lane], lane)
    raise_peak(S, state.PEAK_U_V, S[state.U_V, lane], lane)
    raise_peak(S, state.PEAK_U_A, S[state.U_A, lane] + S[state.GROUND, lane], lane)
    raise_peak(S, state.PEAK_THETA1, S[state.THETA1, lane], lane)
    raise_peak(S, state.PEAK_MOMENT, S[state.MOMENT, lane], lane)
    raise_peak(S, state.PEAK_DAMPING_MOMENT, S[state.DAMPING_MOMENT, lane], lane)
    raise_peak(S, state.PEAK_THETA2, S[state.THETA2, lane], lane)
    raise_peak(S, state.PEAK_TRACK_V, S[state.TRACK_VY, lane] + S[state.GROUND_V, lane], lane)


def measure_contact(S: Array, Q: Array, lane: int) -> None:
    """Peaks, losses and times of wheel and rail."""
    dt = Q[constant.DT, lane]
    half = 0.5 * dt
    for k in range(KINDS):
        power = S[state.CONTACT_POWER + k, lane]
        S[state.CONTACT_LOST + k, lane] += half * (S[state.CONTACT_POWER_OLD + k, lane] + power)
        S[state.CONTACT_POWER_OLD + k, lane] = power
    on = S[state.ON_TRACK, lane]
    lateral = -S[state.FORCE_Y, lane]
    load_left = S[state.LOAD_LEFT, lane]
    load_right = S[state.LOAD_RIGHT, lane]
    raise_peak(S, state.PEAK_ROLL, on * S[state.ROLL, lane], lane)
    raise_peak(S, state.PEAK_SHIFT, on * S[state.SHIFT, lane], lane)
    raise_peak(S, state.PEAK_LOAD, max(load_left, load_right), lane)
    raise_peak(S, state.PEAK_LATERAL, lateral, lane)
    left, right = wheels_off(S, lane)
    S[state.TIME_ONE_WHEEL, lane] += dt * on * max(left, right)
    S[state.TIME_DETACHED, lane] += dt * on * min(left, right)
    least = least_load(Q[constant.STATIC_WHEEL_LOAD, lane])
    climbing_left = climbing_time(
        S[state.CLIMB_TIME_LEFT, lane], dt, -S[state.LATERAL_LEFT, lane], load_left, least
    )
    climbing_right = climbing_time(
        S[state.CLIMB_TIME_RIGHT, lane], dt, S[state.LATERAL_RIGHT, lane], load_right, least
    )
    S[state.CLIMB_TIME_LEFT, lane] = climbing_left
    S[state.CLIMB_TIME_RIGHT, lane] = climbing_right
    raise_peak(S, state.LONGEST_CLIMB_LEFT, climbing_left, lane)
    raise_peak(S, state.LONGEST_CLIMB_RIGHT, climbing_right, lane)
    raise_peak(S, state.FLANGE_BORE, flange_penetration(S, lane), lane)
    # for the frame's means
    S[state.SUM_LATERAL, lane] += lateral
    for side in range(2):
        S[state.SUM_LOAD_LEFT + side, lane] += S[state.LOAD + side, lane]
        S[state.SUM_LATERAL_LEFT + side, lane] += S[state.LATERAL + side, lane]


def wheels_off(S: Array, lane: int) -> tuple[float, float]:
    """1 for each side (left, right) whose wheels touch their rail nowhere, else 0."""
    left = max(S[state.PENETRATION_LEFT_TREAD, lane], S[state.PENETRATION_LEFT_FLANGE, lane])
    right = max(S[state.PENETRATION_RIGHT_TREAD, lane], S[state.PENETRATION_RIGHT_FLANGE, lane])
    return 0.0 if left > 0.0 else 1.0, 0.0 if right > 0.0 else 1.0


def flange_penetration(S: Array, lane: int) -> float:
    """Of the flange that penetrates its rail more, m; 0 where none bears."""
    left = S[state.PENETRATION_LEFT_FLANGE, lane]
    right = S[state.PENETRATION_RIGHT_FLANGE, lane]
    return max(left, right, 0.0)


def filtered(S: Array, Q: Array, number: int, share: float, lane: int) -> float:
    """A low-pass filter's new output, fed with the mean over the frame."""
    memory = low_pass(
        share * S[state.SUM + number, lane],
        Memory(
            S[state.FILTER_X1 + number, lane],
            S[state.FILTER_X2 + number, lane],
            S[state.FILTER_Y1 + number, lane],
            S[state.FILTER_Y2 + number, lane],
        ),
        read_coefficients(Q, constant.FILTER_BY, lane),
    )
    S[state.FILTER_X1 + number, lane] = memory.x1
    S[state.FILTER_X2 + number, lane] = memory.x2
    S[state.FILTER_Y1 + number, lane] = memory.y1
    S[state.FILTER_Y2 + number, lane] = memory.y2
    return memory.y1


def filter_forces(S: Array, Q: Array, lane: int) -> None:
    """Once a frame: low-passed lateral force, wheel loads and derailment coefficient Y/Q.

    That of the treads alone is zero while a flange bears, whose force would ring on in the filter.
    """
    free = 0.0 if S[state.FLANGE_BORE, lane] > 0.0 else 1.0
    S[state.SUM_TREADS, lane] = free * S[state.SUM_LATERAL, lane]
    share = 1.0 / Q[constant.FRAME_STEPS, lane]
    lateral = filtered(S, Q, 0, share, lane)
    load_left = filtered(S, Q, 1, share, lane)
    load_right = filtered(S, Q, 2, share, lane)
    y_left = filtered(S, Q, 3, share, lane)
    y_right = filtered(S, Q, 4, share, lane)
    treads = filtered(S, Q, 5, share, lane)
    for k in range(FILTERS):
        S[state.SUM + k, lane] = 0.0
    on = S[state.ON_TRACK, lane]
    raise_peak(S, state.PEAK_LATERAL_FILTERED, on * lateral, lane)
    raise_peak(S, state.PEAK_LATERAL_TREADS, on * free * treads, lane)
    keep_lowest(S, state.LOWEST_LOAD_LEFT, load_left, lane)
    keep_lowest(S, state.LOWEST_LOAD_RIGHT, load_right, lane)
    least = least_load(Q[constant.STATIC_WHEEL_LOAD, lane])
    left = derailment_coefficient(y_left, load_left, least)
    right = derailment_coefficient(y_right, load_right, least)
    raise_peak(S, state.PEAK_DERAILMENT_COEFFICIENT, on * max(left, right), lane)


def keep_lowest(S: Array, row: int, load: float, lane: int) -> None:
    """Keep the lowest load of a train that is on the track."""
    kept = S[row, lane]
    S[row, lane] = load if load < kept and S[state.ON_TRACK, lane] > 0.0 else kept


def measure_bodies(S: Array, Q: Array, lane: int) -> None:
    """Once a frame: roll and acceleration of the car's body, and travel of the suspension."""
    on = S[state.ON_TRACK, lane]
    body = 2 * int(Q[constant.MEASURED_BODY, lane])
    roll = S[state.VEHICLE_X + body + 1, lane] - S[state.TRACK_PHI, lane]
    acceleration = S[state.VEHICLE_A + body, lane] + S[state.GROUND, lane]
    raise_peak(S, state.PEAK_BODY_ROLL, on * roll, lane)
    raise_peak(S, state.PEAK_BODY_A, on * acceleration, lane)
    raise_peak(S, state.PEAK_PRIMARY_TRAVEL, on * stage_travel(S, Q, 0, lane), lane)
    raise_peak(S, state.PEAK_SECONDARY_TRAVEL, on * stage_travel(S, Q, 1, lane), lane)


def swing_on_track(S: Array, Q: Array, n: int, lane: int) -> None:
    """Once a frame: oscillator ``n`` of the track's spectral intensity."""
    push = S[state.TRACK_VY, lane] + S[state.GROUND_V, lane] - S[state.TRACK_V_BEGUN, lane]
    by = read_swing(Q, constant.SWING_BY + 4 * n, lane)
    re, im = swing(S[state.SWING_RE + n, lane], S[state.SWING_IM + n, lane], push, by)
    S[state.SWING_RE + n, lane] = re
    S[state.SWING_IM + n, lane] = im
    raise_peak(S, state.PEAK_SWING + n, im, lane)
