"""The track on the pier, and the wheelset on the track: positions, velocities and forces.

The track's origin, the midpoint of the two rail crowns, hangs on the pier's top node by a rigid
offset: eccentricity e to the right, height h upwards.  With phi = -theta_2 ::

    Y_t = u + h phi       Z_t = e phi       phi_t = phi

and a force (F_y, F_z) with moment M_x on the track acts on the node by the transpose of this map,
Q_u = F_y and Q_phi = h F_y + e F_z + M_x = -Q_theta2.

With R turning ground axes into track axes, the wheelset is at (Y, Z) = R (x_w - x_t) from the
track's origin and, the track turning at phi_t', moves at
(Y', Z') = R (v_w - v_t) - phi_t' x (Y, Z).
"""

from typing import NamedTuple

__all__ = [
    "Offset",
    "Planar",
    "Relative",
    "carried_track",
    "moment_about_track",
    "node_force",
    "turn_on",
    "wheelset_on_track",
]


class Offset(NamedTuple):
    """Rigid offset of the track from the node that carries it."""

    u: float  # 1, or 0 where nothing moves the track
    height: float  # h, m; 0 where nothing moves the track
    eccentricity: float  # e, m
    phi: float  # 1, or 0 where nothing moves the track


class Planar(NamedTuple):
    """Something in the plane: along y (right), along z (down) and about x (right side down)."""

    y: float
    z: float
    phi: float


def carried_track(u: float, phi: float, offset: Offset) -> Planar:
    """Displacement of the track's origin from that of the node; velocities likewise."""
    return Planar(offset.u * u + offset.height * phi, offset.eccentricity * phi, offset.phi * phi)


def node_force(track: Planar, offset: Offset) -> tuple[float, float]:
    """Q_u and Q_phi on the node from the force and moment on the track's origin."""
    return (
        offset.u * track.y,
        offset.height * track.y + offset.eccentricity * track.z + offset.phi * track.phi,
    )


class Relative(NamedTuple):
    """The wheelset in track axes: place of its centre and rates."""

    shift: float  # Y, m
    height: float  # Z, m; negative above the rails
    shift_v: float
    height_v: float


def wheelset_on_track(
    arm: tuple[float, float],
    velocity: tuple[float, float],
    turning: float,
    sine: float,
    cosine: float,
) -> Relative:
    """Place and rates of the wheelset in track axes.

    Parameters
    ----------
    arm : (float, float)
        x_w - x_t in ground axes, m.
    velocity : (float, float)
        v_w - v_t in ground axes, m/s.
    turning : float
        phi_t', rad/s.
    sine, cosine : float
        Of the track's roll.
    """
    dy, dz = arm
    vy, vz = velocity
    shift = cosine * dy + sine * dz
    height = cosine * dz - sine * dy
    return Relative(
        shift,
        height,
        cosine * vy + sine * vz + turning * height,
        cosine * vz - sine * vy - turning * shift,
    )


def moment_about_track(arm: tuple[float, float], force: Planar) -> float:
    """Moment about the track's origin of what the wheelset's force does to the track, N m."""
    dy, dz = arm
    return -(force.phi + dy * force.z - dz * force.y)


def turn_on(sine: float, cosine: float, turn: float) -> tuple[float, float]:
    """Sine and cosine of a roll after a small turn, to the second order.

    The third is below 1e-13 for any roll that is no derailment's.
    """
    return (
        sine + turn * (cosine - 0.5 * turn * sine),
        cosine - turn * (sine + 0.5 * turn * cosine),
    )
