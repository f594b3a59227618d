"""One patch of a wheel on its rail: gap, normal and tangential force together (Eqs. 4 to 8).

The vertical gap G(Y, psi) - Z and its derivatives dG/dY = tan(gamma) and dG/dpsi say where the
patch is and how it closes; Hertz' stiffness, the loss at impacts and the creep force follow, and as
generalised forces on the wheelset they are the gradient of the gap and its transverse.  The creep
force's longitudinal part turns the axle (`axle`).
"""

import math
from typing import Any, NamedTuple

import numpy as np

from railquake.physics.axle import distance_from_axle
from railquake.physics.creep import bound_on_flange, bound_on_tread, linear_force
from railquake.physics.impact import hysteresis, normal_force
from railquake.physics.profiles import Patch

__all__ = ["Contact", "PatchForces", "WheelMotion", "closing_rate", "patch_forces"]


Array = np.ndarray[Any, np.dtype[np.float64]]


class WheelMotion(NamedTuple):
    """The wheelset in track axes, seen from a right-hand wheel."""

    height: float  # Z, m
    shift_v: float  # Y', m/s
    height_v: float  # Z', m/s
    roll_v: float  # psi', rad/s
    roll_sin: float
    roll_cos: float
    axle_rate: float  # w, rad/s


class Contact(NamedTuple):
    """Material of the contact and the train's speed."""

    alpha_r: float  # of the restitution law, see `impact`
    onset_bound: float  # least rate at an onset, m/s
    friction: float  # mu
    inverse_speed: float  # 1/V, s/m, V having a lower bound
    speed: float  # V without it, m/s


class PatchForces(NamedTuple):
    """What one wheel's patch does to the wheelset, right-hand wheel, track axes."""

    hysteresis: float  # chi/K now, s/m
    y: float  # generalised forces, N, N, N m
    z: float
    psi: float
    energy: float  # stored Hertz energy, J
    impact: float  # power lost to hysteresis, W
    creep: float  # power lost to creepage, W
    spin: float  # power brought in by spin, W
    forward: float  # power brought in by longitudinal slip, W
    axle_moment: float  # -r F_x, N m
    axle_damping: float  # how much it falls per axle's rate, N m s


def closing_rate(patch: Patch, motion: WheelMotion) -> float:
    """Rate of the penetration Z - G(Y, psi), vertical, m/s."""
    return motion.height_v - patch.slope * motion.shift_v - patch.gap_psi * motion.roll_v


def patch_forces(
    penetration: float,
    patch: Patch,
    motion: WheelMotion,
    held: float,
    contact: Contact,
    zone: int,
    table: Array,
) -> PatchForces:
    """Forces of one wheel's patch on the wheelset (Eqs. 5 to 8).

    Parameters
    ----------
    penetration : float
        Z - G, vertical, m; positive in contact.
    patch : profiles.Patch
    motion : WheelMotion
    held : float
        chi/K of this contact so far, s/m; 0 while open.
    contact : Contact
    zone : int
        0: tread, 1: flange; each has its creep law.
    table : array
        Of that law, where it has one.
    """
    slope = patch.slope
    cos_gamma = 1.0 / math.sqrt(1.0 + slope * slope)
    delta = max(penetration, 0.0) * cos_gamma
    rate = closing_rate(patch, motion) * cos_gamma
    held = hysteresis(penetration > 0.0, held, rate, contact.alpha_r, contact.onset_bound)
    normal, elastic = normal_force(delta, rate, patch.stiffness, held)
    # the contact point's arm follows from dG/dpsi = -(arm_y + tan(gamma) arm_z)
    arm_z = patch.rail_z - motion.height
    arm_y = -patch.gap_psi - slope * arm_z
    sliding = cos_gamma * (
        motion.shift_v - motion.roll_v * arm_z + slope * (motion.height_v + motion.roll_v * arm_y)
    )
    # angle from the axle: sin(gamma - psi)
    sine = cos_gamma * (slope * motion.roll_cos - motion.roll_sin)
    radius = distance_from_axle(arm_y, arm_z, motion.roll_sin, motion.roll_cos)
    slip = contact.speed - motion.axle_rate * radius
    f11 = patch.along * delta
    linear = linear_force(
        f11,
        patch.creep * delta,
        patch.spin * delta * math.sqrt(delta),
        (
            slip * contact.inverse_speed,
            sliding * contact.inverse_speed,
            sine * motion.axle_rate * contact.inverse_speed,
        ),
    )
    limit = contact.friction * normal
    if zone == 1:
        force = bound_on_flange(linear, limit, patch.log_ratio, table)
    else:
        force = bound_on_tread(linear, limit, patch.log_ratio, table)
    down = normal * cos_gamma
    across = (force.creep + force.spin) * cos_gamma
    return PatchForces(
        held,
        down * slope + across,
        across * slope - down,
        down * patch.gap_psi + across * (slope * arm_y - arm_z),
        0.4 * elastic * delta,
        (normal - elastic) * rate,
        -force.creep * sliding - force.along * slip,
        force.spin * sliding,
        -force.along * slip,
        -radius * force.along,
        radius * radius * force.share * f11 * contact.inverse_speed,
    )
