"""Stages of the momentum audit: impulses of what pushes the car from outside, and its momentum.

The forces are taken where they arise, of one wheelset's patches on their rails, and masses, heights
and the number of axles from rows that nothing else reads: a factor that is forgotten on the way to
the bodies' accelerations is seen.
"""

from typing import Any

import numpy as np

from railquake.march.peaks import raise_peak
from railquake.march.rows import constant, size, state
from railquake.measures import STANDARD_GRAVITY
from railquake.physics.momentum import Pair, counted_moment, counted_place, moment

__all__ = [
    "close_momentum",
    "couple_of_ends",
    "damping_of_ends",
    "gather_rails",
    "held_by_ends",
    "no_couple",
    "nothing_held",
    "open_momentum",
    "push_by_rails",
    "push_on_bodies",
    "pushed_by_rails",
    "stiffness_of_ends",
]

Array = np.ndarray[Any, np.dtype[np.float64]]


def gather_rails(S: Array, Q: Array, lane: int) -> None:
    """Force of the rails on the car in ground axes, and its moment, from a wheelset's patches."""
    count = Q[constant.AUDIT_AXLES, lane] * S[state.ON_TRACK, lane]
    across = -count * (S[state.LATERAL_LEFT, lane] + S[state.LATERAL_RIGHT, lane])
    down = -count * (S[state.LOAD_LEFT, lane] + S[state.LOAD_RIGHT, lane])
    sine = S[state.TRACK_SIN, lane]
    cosine = S[state.TRACK_COS, lane]
    force = Pair(cosine * across - sine * down, sine * across + cosine * down)
    S[state.RAILS_Y, lane] = force.y
    S[state.RAILS_Z, lane] = force.z
    S[state.RAILS_PHI, lane] = counted_moment(
        count * S[state.PATCH_MOMENTS, lane],
        force,
        Pair(S[state.TRACK_Y, lane], S[state.TRACK_Z, lane]),
        Pair(S[state.ARM_Y, lane], S[state.ARM_Z, lane]),
        Q[constant.AUDIT_HEIGHT + size.BODIES - 1, lane],
    )


def push_by_rails(S: Array, Q: Array, lane: int) -> None:
    """Impulse of the rails up to this time step; see `pushed_by_rails`."""
    dt = Q[constant.DT, lane]
    for k in range(3):
        S[state.RAILS_IMPULSE + k, lane] += dt * S[state.RAILS + k, lane]


def pushed_by_rails(S: Array, Q: Array, k: int, lane: int) -> float:
    """Impulse of the rails along y, z or phi: the trapezoid has half of the last force.

    And half of the first, which is the same for ever.
    """
    last = 0.5 * Q[constant.DT, lane] * S[state.RAILS + k, lane]
    impulse: float = S[state.RAILS_IMPULSE + k, lane] - last
    return impulse


def push_on_bodies(S: Array, Q: Array, lane: int) -> None:
    """Impulses of ground and gravity during a step of structure and sprung bodies."""
    step = S[state.ON_TRACK, lane] * Q[constant.SUBSTEPS, lane] * Q[constant.DT, lane]
    half = 0.5 * step
    mass = 0.0
    first_y = 0.0
    first_z = 0.0
    true_y = 0.0
    for k in range(size.BODIES):
        own = Q[constant.AUDIT_MASS + k, lane]
        # half a step back: the mean of a force is that of the lever and of the acceleration
        y = halfway(S, 2 * k, half, lane)
        z = halfway(S, 2 * size.BODIES + k, half, lane)
        place = counted_place(y, z, Q[constant.AUDIT_HEIGHT + k, lane])
        mass += own
        first_y += own * place.y
        first_z += own * place.z
        true_y += own * y
    # the ground's acceleration has already moved on
    push_y = -step * (S[state.GROUND, lane] - 0.5 * S[state.GROUND_SLOPE, lane])
    push_z = -step * (S[state.GROUND_Z, lane] - 0.5 * S[state.GROUND_Z_SLOPE, lane])
    S[state.SHAKEN_Y, lane] += mass * push_y
    S[state.SHAKEN_Z, lane] += mass * push_z
    S[state.SHAKEN_PHI, lane] += moment(Pair(first_y, first_z), Pair(push_y, push_z))
    fall = step * STANDARD_GRAVITY
    S[state.WEIGHED_Z, lane] += fall * mass
    S[state.WEIGHED_PHI, lane] += fall * first_y
    S[state.OMITTED, lane] += fall * (true_y - first_y)
    S[state.COUPLED_PHI, lane] += step * stiffness_of_ends(S, Q, half, lane)


def halfway(S: Array, i: int, half: float, lane: int) -> float:
    """Displacement of degree of freedom ``i`` half a step ago."""
    at: float = S[state.VEHICLE_X + i, lane] - half * S[state.VEHICLE_V + i, lane]
    return at


def stiffness_of_ends(S: Array, Q: Array, half: float, lane: int) -> float:
    """Slot of the kinematics: moment from nowhere of springs with ends at two heights, N m.

    ``half`` is half a step: it is that of the displacements so long ago.
    """
    raise NotImplementedError("a vehicle's kinematics are chosen when a kernel is bound")


def damping_of_ends(S: Array, Q: Array, lane: int) -> float:
    """Slot of the kinematics: impulse of such a moment of dashpots, but for its sign, N m s."""
    raise NotImplementedError("a vehicle's kinematics are chosen when a kernel is bound")


def couple_of_ends(S: Array, Q: Array, half: float, lane: int) -> float:
    """Of a linear car: its lateral elements stay level while it turns."""
    couple = 0.0
    for i in range(size.DOFS):
        couple -= Q[constant.COUPLE_STIFFNESS + i, lane] * halfway(S, i, half, lane)
    return couple


def held_by_ends(S: Array, Q: Array, lane: int) -> float:
    """Of a linear car; a dashpot's impulse is that of its travel."""
    held = 0.0
    for i in range(size.DOFS):
        held += Q[constant.COUPLE_DAMPING + i, lane] * S[state.VEHICLE_X + i, lane]
    return held


def no_couple(S: Array, Q: Array, half: float, lane: int) -> float:
    """A joint whose bodies turn by any angle acts along the line between its ends."""
    return 0.0


def nothing_held(S: Array, Q: Array, lane: int) -> float:
    """A joint whose bodies turn by any angle acts along the line between its ends."""
    return 0.0


def unexplained(S: Array, Q: Array, lane: int) -> tuple[float, float, float]:
    """Momentum along y and z, N s, and angular momentum, N m s, less all impulses so far."""
    y = -pushed_by_rails(S, Q, 0, lane) - S[state.SHAKEN_Y, lane]
    z = -pushed_by_rails(S, Q, 1, lane) - S[state.SHAKEN_Z, lane] - S[state.WEIGHED_Z, lane]
    roll = (
        damping_of_ends(S, Q, lane)
        - pushed_by_rails(S, Q, 2, lane)
        - S[state.SHAKEN_PHI, lane]
        - S[state.WEIGHED_PHI, lane]
        - S[state.COUPLED_PHI, lane]
    )
    for k in range(size.BODIES):
        along = 2 * size.BODIES + k
        mass = Q[constant.AUDIT_MASS + k, lane]
        step = Q[constant.DT, lane]
        if k < size.BODIES - 1:
            step *= Q[constant.SUBSTEPS, lane]
        push = Pair(
            mass * velocity(S, Q, 2 * k, step, lane), mass * velocity(S, Q, along, step, lane)
        )
        place = counted_place(
            S[state.VEHICLE_X + 2 * k, lane],
            S[state.VEHICLE_X + along, lane],
            Q[constant.AUDIT_HEIGHT + k, lane],
        )
        y += push.y
        z += push.z
        roll += moment(place, push)
        roll += Q[constant.AUDIT_INERTIA + k, lane] * velocity(S, Q, 2 * k + 1, step, lane)
    return y, z, roll


def velocity(S: Array, Q: Array, i: int, step: float, lane: int) -> float:
    """Velocity of degree of freedom ``i`` by the trapezoid of its accelerations.

    Zhai's own stops at the accelerations of the step before and guesses on: that is as much as
    ``step`` times their last change off, the only difference between both rules, and it would
    hide what is looked for wherever a blow falls on a frame's end.
    """
    at: float = S[state.VEHICLE_V + i, lane] + step * (
        0.5 * S[state.VEHICLE_A + i, lane]
        - Q[constant.ZHAI_PHI, lane] * S[state.VEHICLE_A_OLD + i, lane]
    )
    return at


def open_momentum(S: Array, Q: Array, lane: int) -> None:
    """At a frame's begin: what the impulses of the frame are to leave as it is."""
    y, z, roll = unexplained(S, Q, lane)
    S[state.UNEXPLAINED_Y, lane] = y
    S[state.UNEXPLAINED_Z, lane] = z
    S[state.UNEXPLAINED_PHI, lane] = roll


def close_momentum(S: Array, Q: Array, lane: int) -> None:
    """At its end: what they do not explain, added up over the frames, and the largest values."""
    on = S[state.ON_TRACK, lane]
    y, z, roll = unexplained(S, Q, lane)
    S[state.LEFT_Y, lane] += on * (y - S[state.UNEXPLAINED_Y, lane])
    S[state.LEFT_Z, lane] += on * (z - S[state.UNEXPLAINED_Z, lane])
    S[state.LEFT_PHI, lane] += on * (roll - S[state.UNEXPLAINED_PHI, lane])
    raise_peak(S, state.PEAK_LINEAR_LEFT, S[state.LEFT_Y, lane], lane)
    raise_peak(S, state.PEAK_LINEAR_LEFT, S[state.LEFT_Z, lane], lane)
    raise_peak(S, state.PEAK_ANGULAR_LEFT, S[state.LEFT_PHI, lane], lane)
    borne = S[state.PUSHED_Z, lane] + S[state.WEIGHED_Z, lane]
    raise_peak(S, state.PEAK_IMPULSE, S[state.PUSHED_Y, lane], lane)
    raise_peak(S, state.PEAK_IMPULSE, S[state.SHAKEN_Y, lane], lane)
    raise_peak(S, state.PEAK_IMPULSE, borne, lane)
    raise_peak(S, state.PEAK_IMPULSE, S[state.SHAKEN_Z, lane], lane)
    raise_peak(S, state.PEAK_TURNING, S[state.PUSHED_PHI, lane], lane)
    raise_peak(S, state.PEAK_TURNING, S[state.SHAKEN_PHI, lane], lane)
    raise_peak(S, state.PEAK_TURNING, S[state.WEIGHED_PHI, lane], lane)
    raise_peak(S, state.PEAK_OMITTED, S[state.OMITTED, lane], lane)
