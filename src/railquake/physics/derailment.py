"""What is called contact, uplift, onset, flange over, derailed and overturned.

Onset of slide-off is a relative roll at which the lifted flange comes over its rail; derailed is a
wheelset whose flange has crossed its rail's centre line above the crown, or that has moved
sideways by `SHIFT_LIMIT`; overturned is one whose relative roll is beyond `ROLL_LIMIT`, or whose
vehicle's centre of gravity stands outside the lower rail once the onset has been reached.
"""

import math
from typing import Final, NamedTuple

__all__ = [
    "DERAILED",
    "EVENTS",
    "FLANGE_CONTACT",
    "FLANGE_OVER",
    "ONSET",
    "OVERTURNED",
    "ROLL_LIMIT",
    "SHIFT_LIMIT",
    "UPLIFT",
    "Events",
    "FlangeTips",
    "Limits",
    "clearance",
    "derailment_coefficient",
    "events",
    "flange_tips",
    "least_load",
]

SHIFT_LIMIT: Final = 0.127  # lateral shift that counts as derailed, m (5 in)
ROLL_LIMIT: Final = math.pi / 4.0  # relative roll that counts as overturned
LEAST_SHARE: Final = 0.1  # of the static load, see `least_load`


class Limits(NamedTuple):
    """Thresholds of the events."""

    reference_roll: float  # onset of slide-off, rad
    rail_centre: float  # half the distance between the rails' centre lines, m
    shift: float  # m
    roll: float  # rad


class FlangeTips(NamedTuple):
    """Where the flanges' tips are in track axes, m."""

    right_y: float
    right_z: float
    left_y: float
    left_z: float


class Events(NamedTuple):
    """Which events hold."""

    flange_contact: bool
    uplift: bool
    onset: bool
    flange_over: bool
    derailed: bool
    overturned: bool


FLANGE_CONTACT, UPLIFT, ONSET, FLANGE_OVER, DERAILED, OVERTURNED = range(len(Events._fields))
EVENTS: Final = tuple(name.replace("_", " ") for name in Events._fields)


def flange_tips(
    place: tuple[float, float], sine: float, cosine: float, tip: tuple[float, float]
) -> FlangeTips:
    """Places of both tips.

    Parameters
    ----------
    place : (float, float)
        Y and Z of the wheelset, m.
    sine, cosine : float
        Of its roll psi.
    tip : (float, float)
        Of the right-hand flange in wheelset axes, m.
    """
    shift, height = place
    y, z = tip
    return FlangeTips(
        shift + y * cosine - z * sine,
        height + y * sine + z * cosine,
        shift - y * cosine - z * sine,
        height - y * sine + z * cosine,
    )


def clearance(tips: FlangeTips) -> float:
    """How high the higher tip is above the rails' crowns, m."""
    return max(-tips.left_z, -tips.right_z)


def events(
    place: tuple[float, float],
    tips: FlangeTips,
    centre_of_gravity: float,
    flange_penetration: float,
    off: float,
    limits: Limits,
) -> Events:
    """Which events hold.

    Parameters
    ----------
    place : (float, float)
        Shift, m, and roll, rad.
    tips : FlangeTips
    centre_of_gravity : float
        Of the vehicle, from the middle of the track along the ground's horizontal, m.
    flange_penetration : float
        The larger of both flanges', m.
    off : float
        1 if a wheel touches its rail nowhere, else 0.
    limits : Limits
    """
    shift, roll = place
    rail = limits.rail_centre
    # a derailing flange passes over its rail's head, so it is above the crown when it crosses
    across = max(
        tips.right_y - rail if tips.right_z < 0.0 else -1.0,
        -tips.left_y - rail if tips.left_z < 0.0 else -1.0,
    )
    # the lower wheel's contact is near the running circle of its rail
    beyond = abs(centre_of_gravity) - rail
    onset = abs(roll) >= limits.reference_roll
    return Events(
        flange_penetration > 0.0,
        off > 0.0,
        onset,
        clearance(tips) > 0.0,
        across > 0.0 or abs(shift) >= limits.shift,
        abs(roll) >= limits.roll or (beyond > 0.0 and onset),
    )


def least_load(static: float) -> float:
    """Y/Q means little on a wheel that hardly bears: it is taken above this load, N."""
    return LEAST_SHARE * static


def derailment_coefficient(lateral: float, load: float, least: float) -> float:
    """Y/Q of a wheel; 0 below the least load."""
    return abs(lateral) / max(load, least) if load > least else 0.0
