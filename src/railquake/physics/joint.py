"""Joints between bodies that turn by any angle: springs, dashpots, stops and anti-roll bars.

A joint holds a point of an upper body to a point of a lower one.  What it feels is, in the mean
axes of the two bodies ::

    d = R(phi_m)^T (P_u - P_l) - d_0        phi_m = (phi_u + phi_l)/2        theta = phi_u - phi_l

(d_0 where the points lie apart at rest).  Mean axes, because a coil or an air spring bends alike at
both ends, so that the moment of what it bears is shared half and half.  Forces follow from ::

    V = ky dy^2/2 + kz dz^2/2 + kr theta^2/2 + ny dy + nz dz + nr theta + stops
    D = cy dy'^2/2 + cz dz'^2/2, and of dashpots with a knee

n being what the joint bears at rest: the weight above it.  With y to the right, z down and phi
turning the right side down, R(phi) = [[cos, -sin], [sin, cos]].
"""

import math
from typing import NamedTuple

__all__ = [
    "JointSpring",
    "Pose",
    "Pull",
    "Relative",
    "Sides",
    "Tie",
    "knee_force",
    "pull",
    "relative",
    "spring_energy",
    "spring_force",
    "spring_moment",
    "stop_force",
]


class Pose(NamedTuple):
    """A body: displacements from rest and their rates."""

    y: float  # m
    z: float  # m
    roll: float  # rad
    sine: float  # of its roll
    cosine: float
    vy: float  # m/s
    vz: float  # m/s
    vroll: float  # rad/s


class Tie(NamedTuple):
    """The two points of a joint, from the centre of gravity of each body, at rest."""

    upper_y: float  # m
    upper_z: float  # m
    lower_y: float  # m
    lower_z: float  # m


class Relative(NamedTuple):
    """What a joint feels, and where it pulls."""

    y: float  # d, m
    z: float
    vy: float  # its rate, m/s
    vz: float
    sine: float  # of the mean axes' roll
    cosine: float
    upper: tuple[float, float]  # from the upper body's centre of gravity to its point now, m
    lower: tuple[float, float]  # the same of the lower body
    apart: tuple[float, float]  # P_u - P_l in mean axes, m


class JointSpring(NamedTuple):
    """A joint's linear springs and dashpots, and what it bears at rest."""

    ky: float  # N/m
    kz: float  # N/m
    kr: float  # N m/rad
    cy: float  # N s/m
    cz: float  # N s/m
    ny: float  # N
    nz: float  # N
    nr: float  # N m


class Sides(NamedTuple):
    """To which sides a stop bears, 1 or 0, and its damping while it does."""

    positive: float
    negative: float
    damping: float  # N s/m


class Pull(NamedTuple):
    """Generalised forces on both bodies; along y and z the lower one's are opposite."""

    y: float  # on the upper body, N
    z: float  # N
    upper_roll: float  # N m
    lower_roll: float  # N m


def relative(upper: Pose, lower: Pose, tie: Tie, gap: tuple[float, float]) -> Relative:
    """What a joint feels.

    Parameters
    ----------
    upper, lower : Pose
    tie : Tie
    gap : (float, float)
        d_0: from the lower to the upper point at rest, m.
    """
    upper_y = upper.cosine * tie.upper_y - upper.sine * tie.upper_z
    upper_z = upper.sine * tie.upper_y + upper.cosine * tie.upper_z
    lower_y = lower.cosine * tie.lower_y - lower.sine * tie.lower_z
    lower_z = lower.sine * tie.lower_y + lower.cosine * tie.lower_z
    # P_u - P_l; at rest both are at the same place, but for the gap
    apart_y = upper.y - lower.y + gap[0] + (upper_y - tie.upper_y) - (lower_y - tie.lower_y)
    apart_z = upper.z - lower.z + gap[1] + (upper_z - tie.upper_z) - (lower_z - tie.lower_z)
    rate_y = upper.vy - lower.vy - upper.vroll * upper_z + lower.vroll * lower_z
    rate_z = upper.vz - lower.vz + upper.vroll * upper_y - lower.vroll * lower_y
    # the mean of two directions
    sine = upper.sine + lower.sine
    cosine = upper.cosine + lower.cosine
    scale = 1.0 / math.sqrt(sine * sine + cosine * cosine)
    sine *= scale
    cosine *= scale
    along_y = cosine * apart_y + sine * apart_z
    along_z = cosine * apart_z - sine * apart_y
    turning = 0.5 * (upper.vroll + lower.vroll)
    return Relative(
        along_y - gap[0],
        along_z - gap[1],
        cosine * rate_y + sine * rate_z + turning * along_z,
        cosine * rate_z - sine * rate_y - turning * along_y,
        sine,
        cosine,
        (upper_y, upper_z),
        (lower_y, lower_z),
        (along_y, along_z),
    )


def pull(at: Relative, force: tuple[float, float], moment: float) -> Pull:
    """What a joint does to both bodies.

    Parameters
    ----------
    at : Relative
    force : (float, float)
        On the upper body along the mean axes, N: -dV/dd - dD/dd'.
    moment : float
        On the upper body, N m: -dV/dtheta - dD/dtheta'.
    """
    along_y, along_z = force
    y = at.cosine * along_y - at.sine * along_z
    z = at.sine * along_y + at.cosine * along_z
    # d turns with the mean axes: each body has half of that
    half = 0.5 * (along_y * at.apart[1] - along_z * at.apart[0])
    return Pull(
        y,
        z,
        at.upper[0] * z - at.upper[1] * y + half + moment,
        at.lower[1] * y - at.lower[0] * z + half - moment,
    )


def spring_force(at: Relative, spring: JointSpring) -> tuple[tuple[float, float], float]:
    """Force on the upper body along the mean axes, N, and what the dashpots take, W."""
    damping_y = spring.cy * at.vy
    damping_z = spring.cz * at.vz
    return (
        (
            -spring.ny - spring.ky * at.y - damping_y,
            -spring.nz - spring.kz * at.z - damping_z,
        ),
        damping_y * at.vy + damping_z * at.vz,
    )


def spring_moment(theta: float, spring: JointSpring) -> float:
    """Moment of anti-roll bars on the upper body, N m, at its roll against the lower, rad."""
    return -spring.nr - spring.kr * theta


def spring_energy(at: Relative, theta: float, spring: JointSpring) -> float:
    """V of the springs, J."""
    return (
        at.y * (spring.ny + 0.5 * spring.ky * at.y)
        + at.z * (spring.nz + 0.5 * spring.kz * at.z)
        + theta * (spring.nr + 0.5 * spring.kr * theta)
    )


def stop_force(pushed: float, rate: float, sides: Sides) -> float:
    """Force of a stop at a travel to one side, N; it does not hold back.

    Parameters
    ----------
    pushed : float
        Force of its table at that travel, N.
    rate : float
        Of the travel to that side, m/s.
    sides : Sides
    """
    return max(pushed + sides.damping * rate, 0.0) if pushed > 0.0 else 0.0


def knee_force(rate: float, knee: float, damping: float, beyond: float) -> float:
    """Force of a dashpot whose damping changes at the knee, N.

    Parameters
    ----------
    rate : float
        m/s.
    knee : float
        m/s.
    damping, beyond : float
        Below and beyond it, N s/m.
    """
    within = min(max(rate, -knee), knee)
    return damping * within + beyond * (rate - within)
