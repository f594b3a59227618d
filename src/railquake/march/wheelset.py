"""Stages of the wheelset, the last body: where it is on the track, and what moves it."""

from typing import Any

import numpy as np

from railquake.march.rows import constant, size, state
from railquake.march.sprung import predict
from railquake.physics.axle import axle_step
from railquake.physics.elementary import sin_cos
from railquake.physics.track import wheelset_on_track

__all__ = [
    "carry_suspension_on",
    "keep_place",
    "keep_suspension",
    "place_wheelset",
    "predict_wheelset",
    "push_wheelset",
    "turn_axle",
]

Array = np.ndarray[Any, np.dtype[np.float64]]


def keep_place(S: Array, lane: int) -> None:
    """Where the wheelset is before the structure's step."""
    S[state.WHEELSET_FROM_Y, lane] = S[state.VEHICLE_X + size.WHEELSET_Y, lane]
    S[state.WHEELSET_FROM_Z, lane] = S[state.VEHICLE_X + size.WHEELSET_Z, lane]


def predict_wheelset(S: Array, Q: Array, lane: int) -> None:
    """The wheelset at the new time."""
    dt = Q[constant.DT, lane]
    predict(S, Q, size.WHEELSET_Y, dt, lane)
    predict(S, Q, size.WHEELSET_PHI, dt, lane)
    predict(S, Q, size.WHEELSET_Z, dt, lane)


def place_wheelset(S: Array, Q: Array, lane: int) -> None:
    """Wheelset relative to the track, in track axes, and its rates."""
    y = S[state.VEHICLE_X + size.WHEELSET_Y, lane]
    z = S[state.VEHICLE_X + size.WHEELSET_Z, lane]
    vy = S[state.VEHICLE_V + size.WHEELSET_Y, lane]
    vz = S[state.VEHICLE_V + size.WHEELSET_Z, lane]
    dy = y - S[state.TRACK_Y, lane]
    dz = z - Q[constant.WHEELSET_HEIGHT, lane] - S[state.TRACK_Z, lane]
    turning = S[state.TRACK_VPHI, lane]
    place = wheelset_on_track(
        (dy, dz),
        (vy - S[state.TRACK_VY, lane], vz - S[state.TRACK_VZ, lane]),
        turning,
        S[state.TRACK_SIN, lane],
        S[state.TRACK_COS, lane],
    )
    roll = S[state.VEHICLE_X + size.WHEELSET_PHI, lane] - S[state.TRACK_PHI, lane]
    S[state.ARM_Y, lane] = dy
    S[state.ARM_Z, lane] = dz
    S[state.SHIFT, lane] = place.shift
    S[state.HEIGHT, lane] = place.height
    S[state.ROLL, lane] = roll
    S[state.SHIFT_V, lane] = place.shift_v
    S[state.HEIGHT_V, lane] = place.height_v
    S[state.ROLL_V, lane] = S[state.VEHICLE_V + size.WHEELSET_PHI, lane] - turning
    S[state.ROLL_SIN, lane], S[state.ROLL_COS, lane] = sin_cos(roll)


def keep_suspension(S: Array, Q: Array, lane: int) -> None:
    """What Eq. 1 gives the wheelset without its contact, and how that has changed per step."""
    per_substep = Q[constant.DT, lane] * Q[constant.RATE, lane]
    keep_share(S, 0, S[state.VEHICLE_A + size.WHEELSET_Y, lane], per_substep, lane)
    keep_share(S, 1, S[state.VEHICLE_A + size.WHEELSET_Z, lane], per_substep, lane)
    keep_share(S, 2, S[state.VEHICLE_A + size.WHEELSET_PHI, lane], per_substep, lane)


def keep_share(S: Array, k: int, now: float, per_substep: float, lane: int) -> None:
    """`keep_suspension` for one of y, z, phi."""
    change = now - S[state.WHEELSET_FREE_KNOWN + k, lane]
    S[state.WHEELSET_FREE_SLOPE + k, lane] = per_substep * change
    S[state.WHEELSET_FREE_KNOWN + k, lane] = now
    S[state.WHEELSET_FREE + k, lane] = now


def carry_suspension_on(S: Array, lane: int) -> None:
    """Between two evaluations of the suspension: the wheelset's share of it, carried on."""
    for k in range(3):
        S[state.WHEELSET_FREE + k, lane] += S[state.WHEELSET_FREE_SLOPE + k, lane]


def push_wheelset(S: Array, Q: Array, lane: int) -> None:
    """Contact forces on the wheelset, and the work that they do."""
    S[state.WORK_VEHICLE, lane] += 0.5 * (
        push_along(S, Q, 0, size.WHEELSET_Y, lane)
        + push_along(S, Q, 1, size.WHEELSET_Z, lane)
        + push_along(S, Q, 2, size.WHEELSET_PHI, lane)
    )


def turn_axle(S: Array, Q: Array, lane: int) -> None:
    """The wheelsets about their axles at the new time."""
    S[state.AXLE_RATE, lane] += S[state.ON_TRACK, lane] * axle_step(
        S[state.AXLE_MOMENT, lane],
        S[state.AXLE_DAMPING, lane],
        Q[constant.AXLE_INERTIA, lane],
        Q[constant.DT, lane],
    )


def push_along(S: Array, Q: Array, k: int, i: int, lane: int) -> float:
    """`push_wheelset` for one of y, z, phi; twice the work."""
    force = S[state.WHEELSET_FORCE + k, lane]
    S[state.VEHICLE_A + i, lane] = (
        S[state.WHEELSET_FREE + k, lane] + Q[constant.INVERSE_MASS + i, lane] * force
    )
    work: float = (S[state.WHEELSET_FORCE_OLD + k, lane] + force) * S[state.VEHICLE_STEP + i, lane]
    S[state.WHEELSET_FORCE_OLD + k, lane] = force
    return work
