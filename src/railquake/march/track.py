"""Stages of the track: what the train does to it, and how it moves during a structure's step."""

from typing import Any

import numpy as np

from railquake.march.packing import reader
from railquake.march.rows import constant, size, state
from railquake.physics.elementary import sin_cos
from railquake.physics.track import (
    Offset,
    Planar,
    carried_track,
    moment_about_track,
    node_force,
    turn_on,
)

__all__ = [
    "lead_carried_track",
    "lead_prescribed_track",
    "lead_track",
    "load_track",
    "move_track",
    "orient_track",
    "place_carried_track",
    "place_prescribed_track",
    "place_track",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

read_offset = reader(Offset)


def load_track(S: Array, Q: Array, lane: int) -> None:
    """The train's forces on the track, and by it on the structure.

    They are those of the last contact, one time step before; where the structure takes longer
    steps, they are carried on linearly by what is missing.
    """
    force = Planar(
        S[state.WHEELSET_Y, lane], S[state.WHEELSET_Z, lane], S[state.WHEELSET_PHI, lane]
    )
    moment = moment_about_track((S[state.ARM_Y, lane], S[state.ARM_Z, lane]), force)
    ahead = 1.0 - Q[constant.DT, lane] * Q[constant.RATE, lane]
    on_track = Planar(
        carry_force_on(S, 0, -force.y, ahead, lane),
        carry_force_on(S, 1, -force.z, ahead, lane),
        carry_force_on(S, 2, moment, ahead, lane),
    )
    on_u, on_phi = node_force(on_track, read_offset(Q, constant.OFFSET, lane))
    S[state.NODE_U, lane] = on_u
    S[state.NODE_THETA2, lane] = -on_phi


def carry_force_on(S: Array, k: int, contact: float, ahead: float, lane: int) -> float:
    """A force on the track during the coming step of the structure, from the contact's."""
    force: float = contact + ahead * (contact - S[state.TRACK_CONTACT + k, lane])
    S[state.TRACK_CONTACT + k, lane] = contact
    S[state.TRACK_FORCE_OLD + k, lane] = S[state.TRACK_FORCE + k, lane]
    S[state.TRACK_FORCE + k, lane] = force
    return force


def place_track(S: Array, Q: Array, lane: int) -> None:
    """Slot of the support: where the track is before the structure moves on."""
    raise NotImplementedError("a support is chosen when a kernel is bound")


def lead_track(S: Array, Q: Array, lane: int) -> None:
    """Slot of the support: how the track gets to where the structure has moved."""
    raise NotImplementedError("a support is chosen when a kernel is bound")


def orient_track(S: Array, lane: int) -> None:
    """Sine and cosine of the track's roll."""
    S[state.TRACK_SIN, lane], S[state.TRACK_COS, lane] = sin_cos(S[state.TRACK_PHI, lane])


def track_on_node(S: Array, Q: Array, structure: int, lane: int) -> Planar:
    """Position of the track's origin, or its velocity, from those of the structure's node."""
    return carried_track(
        S[structure + size.TOP, lane],
        -S[structure + size.TOP_ROLL, lane],
        read_offset(Q, constant.OFFSET, lane),
    )


def place_carried_track(S: Array, Q: Array, lane: int) -> None:
    """The track where the structure's node holds it."""
    place = track_on_node(S, Q, state.STRUCTURE_X, lane)
    velocity = track_on_node(S, Q, state.STRUCTURE_V, lane)
    S[state.TRACK_Y, lane] = place.y
    S[state.TRACK_Z, lane] = place.z
    S[state.TRACK_PHI, lane] = place.phi
    S[state.TRACK_VY, lane] = velocity.y
    S[state.TRACK_VZ, lane] = velocity.z
    S[state.TRACK_VPHI, lane] = velocity.phi


def lead_carried_track(S: Array, Q: Array, lane: int) -> None:
    """To where the structure's node has moved."""
    place = track_on_node(S, Q, state.STRUCTURE_X, lane)
    velocity = track_on_node(S, Q, state.STRUCTURE_V, lane)
    lead(S, Q, 0, place.y, velocity.y, lane)
    lead(S, Q, 1, place.z, velocity.z, lane)
    lead(S, Q, 2, place.phi, velocity.phi, lane)


def lead(S: Array, Q: Array, k: int, position: float, velocity: float, lane: int) -> None:
    """Constant acceleration that brings the track there by the end of the structure's step.

    It is Newmark's own.  The train's force on the track works on the way.
    """
    change = velocity - S[state.TRACK_V + k, lane]
    S[state.TRACK_A + k, lane] = Q[constant.RATE, lane] * change
    S[state.WORK_TRACK, lane] += (
        0.5
        * (S[state.TRACK_FORCE_OLD + k, lane] + S[state.TRACK_FORCE + k, lane])
        * (position - S[state.TRACK + k, lane])
    )


def move_track(S: Array, Q: Array, lane: int) -> None:
    """The track's origin at the new time, within the structure's step."""
    dt = Q[constant.DT, lane]
    move_on(S, 0, dt, lane)
    move_on(S, 1, dt, lane)
    turn = move_on(S, 2, dt, lane)
    S[state.TRACK_SIN, lane], S[state.TRACK_COS, lane] = turn_on(
        S[state.TRACK_SIN, lane], S[state.TRACK_COS, lane], turn
    )


def move_on(S: Array, k: int, dt: float, lane: int) -> float:
    """Position and velocity under constant acceleration; by how far it has moved."""
    v = S[state.TRACK_V + k, lane]
    dv = dt * S[state.TRACK_A + k, lane]
    step: float = dt * (v + 0.5 * dv)
    S[state.TRACK + k, lane] += step
    S[state.TRACK_V + k, lane] = v + dv
    return step


def prescribed_motion(S: Array, k: int, lane: int) -> tuple[float, float, float]:
    """Position, velocity and acceleration of a prescribed track: a cubic within each frame."""
    place = S[state.TRACK_PLACE, lane]
    rate = S[state.TRACK_RATE, lane]
    c1, c2 = S[state.TRACK_C1 + k, lane], S[state.TRACK_C2 + k, lane]
    c3 = S[state.TRACK_C3 + k, lane]
    return (
        S[state.TRACK_C0 + k, lane] + place * (c1 + place * (c2 + place * c3)),
        rate * (c1 + place * (2.0 * c2 + 3.0 * place * c3)),
        rate * rate * (2.0 * c2 + 6.0 * place * c3),
    )


def place_prescribed_track(S: Array, Q: Array, lane: int) -> None:
    """The track where its motion is prescribed to be."""
    for k in range(3):
        position, velocity, _ = prescribed_motion(S, k, lane)
        S[state.TRACK + k, lane] = position
        S[state.TRACK_V + k, lane] = velocity


def lead_prescribed_track(S: Array, Q: Array, lane: int) -> None:
    """To where its motion is prescribed to be.

    The bridge's measures are then those of the track's origin.
    """
    S[state.TRACK_PLACE, lane] += Q[constant.SUBSTEPS, lane] / Q[constant.FRAME_STEPS, lane]
    for k in range(3):
        position, velocity, _ = prescribed_motion(S, k, lane)
        lead(S, Q, k, position, velocity, lane)
    S[state.U, lane], S[state.U_V, lane], S[state.U_A, lane] = prescribed_motion(S, 0, lane)
    phi, v_phi, _ = prescribed_motion(S, 2, lane)
    S[state.THETA2, lane] = -phi
    S[state.THETA2_V, lane] = -v_phi
