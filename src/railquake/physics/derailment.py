"""What is called contact, uplift, onset, slide-off, climb and overturned.

A train has derailed when a wheelset has left its rails for good, by mechanics and not by a number
on its centre: a wheelset that rocks about the wheel on which it stands shifts its centre by r0
sin(psi) + b (1 - cos(psi)), 127 mm at 13 degrees, and may still come back.  In the order in which
it happens ::

    flange contact    a flange touches its rail
    uplift            the wheels of one side touch their rail nowhere
    onset             the flange's tip of a lifted wheel is above the rail's crown
    flange over       a flange's tip is above its rail's crown, lifted or loaded
    slide-off         a wheel that bears is displaced on its rail by more than the pair's limit, or
                      a flange's tip is outside its rail's centre line above the crown
    climb             the same, where that flange carried load as its tip passed the crown
    overturned        the relative roll is beyond 30 degrees with a wheel still bearing

A train that leaves its rails and overturns within half a second does both, `combined`; so it is
followed for so long, to 45 degrees, until its wheels have fallen beside the rails or are far from
them.  One that overturns first has overturned, whatever its wheels do then: the flange's flank has
turned with the wheelset, and the bearing wheel rolls over it.
"""

import math
from typing import Final, NamedTuple

__all__ = [
    "BEYOND",
    "BEYOND_BODY",
    "BEYOND_STOP",
    "CHATTER",
    "CLIMB",
    "CLIMB_LIMIT",
    "COMBINED_WITHIN",
    "DERAILMENTS",
    "EVENTS",
    "FLANGE_CONTACT",
    "FLANGE_OVER",
    "ONSET",
    "OVERTURNED",
    "OVERTURNED_ROLL",
    "SLIDE_OFF",
    "UPLIFT",
    "Events",
    "Limits",
    "Wheel",
    "bears",
    "clearance",
    "climbing_time",
    "derailment_coefficient",
    "events",
    "flange_tip",
    "goes_to",
    "gone_to",
    "has_left",
    "is_above",
    "lateral_over_vertical",
    "least_load",
    "passed_crown",
    "side_of",
]

OVERTURNED_ROLL: Final = math.pi / 6.0  # relative roll, rad
FOLLOWED_ROLL: Final = math.pi / 4.0  # to which a train that has overturned is followed, rad
FOLLOWED_DISPLACEMENT: Final = 0.130  # and one that has slid off, m
FALLEN: Final = 0.05  # how far below its place a wheelset has fallen beside its rails, m
COMBINED_WITHIN: Final = 0.5  # between slide-off and overturning, s
CHATTER: Final = 0.05  # an event that holds again after less than this has not ended, s
NEARLY: Final = 1e-4  # below the crown, m; a loaded tip on it flattens a little
LEAST_SHARE: Final = 0.1  # of the static load, see `least_load`
CLIMB_LIMIT: Final = 0.8  # of Y/Q, EN 14363's and that of Japanese practice


class Limits(NamedTuple):
    """Thresholds of the events."""

    rail_centre: float  # half the distance between the rails' centre lines, m
    displacement: float  # of a bearing wheel on its rail, m
    body: float  # of the vehicle's centre of gravity from the track's, m; see `BEYOND_BODY`


class Wheel(NamedTuple):
    """The wheels of one side, seen from there: outward is positive."""

    displacement: float  # on the rail, m; see `contact_table`
    tip_y: float  # flange's tip from the track's centre, m
    tip_z: float  # below the crowns, m
    tread: float  # penetrations, m
    flange: float
    passed: float  # what `passed_crown` gave last


class Events(NamedTuple):
    """Which events hold."""

    flange_contact: bool
    uplift: bool
    onset: bool
    flange_over: bool
    slide_off: bool
    climb: bool
    overturned: bool


FLANGE_CONTACT, UPLIFT, ONSET, FLANGE_OVER, SLIDE_OFF, CLIMB, OVERTURNED = range(
    len(Events._fields)
)
DERAILMENTS: Final = (SLIDE_OFF, CLIMB, OVERTURNED)
EVENTS: Final = ("flange contact", "uplift", "onset", "flange over", "slide-off", "climb",
                 "overturned")  # fmt: skip

BEYOND: Final = (
    "the car's centre of gravity is beyond the rail: the moment of gravity that a linear car "
    "leaves out equals the one that holds it",
    "a bump stop is past the end of its table",
)
"""Why the model ends; a run goes on, and what follows is not to be believed."""
BEYOND_BODY, BEYOND_STOP = 1, 2


def flange_tip(
    place: tuple[float, float], sine: float, cosine: float, tip: tuple[float, float]
) -> tuple[float, float]:
    """Place of the right-hand flange's tip in track axes, m.

    Parameters
    ----------
    place : (float, float)
        Y and Z of the wheelset, m.
    sine, cosine : float
        Of its roll psi.
    tip : (float, float)
        In wheelset axes, m.
    """
    shift, height = place
    y, z = tip
    return shift + y * cosine - z * sine, height + y * sine + z * cosine


def bears(wheel: Wheel) -> bool:
    """Whether it touches its rail."""
    return wheel.tread > 0.0 or wheel.flange > 0.0


def clearance(left: Wheel, right: Wheel) -> float:
    """How high the higher tip is above the rails' crowns, m."""
    return max(-left.tip_z, -right.tip_z)


def is_above(tip_z: float, flange: float) -> bool:
    """Whether a flange's tip is above the crown, or stands on it."""
    return tip_z < max(flange, 0.0) + NEARLY


def passed_crown(before: float, tip_z: float, flange: float) -> float:
    """How a flange's tip came above the crown: 1 under load, -1 lifted; 0 where it is below.

    Parameters
    ----------
    before : float
        The same one frame before.
    tip_z : float
        Tip below the crown, m.
    flange : float
        Penetration of the flange, m.
    """
    now = 1.0 if flange > 0.0 else -1.0
    return (before if before != 0.0 else now) if is_above(tip_z, flange) else 0.0


def gone_to(wheel: Wheel, limits: Limits) -> float:
    """1 for a wheel that has left its rail outward for good, -1 inward; else 0."""
    crossed = wheel.passed != 0.0 and wheel.tip_y > limits.rail_centre
    displaced = bears(wheel) and abs(wheel.displacement) >= limits.displacement
    return 1.0 if crossed or (displaced and wheel.displacement > 0.0) else -1.0 * displaced


def events(roll: float, left: Wheel, right: Wheel, limits: Limits) -> Events:
    """Which events hold.

    Parameters
    ----------
    roll : float
        Relative roll, rad.
    left, right : Wheel
    limits : Limits
    """
    left_bears, right_bears = bears(left), bears(right)
    left_gone, right_gone = gone_to(left, limits) != 0.0, gone_to(right, limits) != 0.0
    climbs = (left_gone and left.passed > 0.0) or (right_gone and right.passed > 0.0)
    return Events(
        left.flange > 0.0 or right.flange > 0.0,
        not (left_bears and right_bears),
        (left.tip_z < 0.0 and not left_bears) or (right.tip_z < 0.0 and not right_bears),
        left.tip_z < 0.0 or right.tip_z < 0.0,
        (left_gone or right_gone) and not climbs,
        climbs,
        abs(roll) >= OVERTURNED_ROLL and (left_bears or right_bears),
    )


def side_of(left: bool, right: bool, otherwise: float) -> float:
    """-1 where only the left side does it, 1 where only the right one; else ``otherwise``."""
    if left == right:
        return otherwise
    return 1.0 if right else -1.0


def goes_to(roll: float, left: Wheel, right: Wheel) -> float:
    """Displacement of the wheelset to the right, by its bearing wheel's own, m."""
    lower = 1.0 if roll > 0.0 else -1.0
    side = side_of(bears(left), bears(right), 0.0 if bears(left) else lower)
    weight = 0.5 * (1.0 + side)
    return weight * right.displacement - (1.0 - weight) * left.displacement


def has_left(roll: float, wheels: tuple[float, float], since: float, both: bool) -> bool:
    """Whether a derailed train need not be followed any longer.

    Parameters
    ----------
    roll : float
        Relative roll, rad.
    wheels : (float, float)
        Displacement of the wheelset by its bearing wheel, and how far it has fallen, m.
    since : float
        Time since it derailed, s.
    both : bool
        Whether it has both left its rails and overturned.
    """
    displaced, fallen = wheels
    return (
        both
        or since >= COMBINED_WITHIN
        or abs(roll) >= FOLLOWED_ROLL
        or abs(displaced) >= FOLLOWED_DISPLACEMENT
        or fallen >= FALLEN
    )


def least_load(static: float) -> float:
    """Y/Q means little on a wheel that hardly bears: it is taken above this load, N."""
    return LEAST_SHARE * static


def lateral_over_vertical(lateral: float, load: float, least: float) -> float:
    """Y/Q of a wheel, with the sign of its lateral force; 0 below the least load."""
    return lateral / max(load, least) if load > least else 0.0


def derailment_coefficient(lateral: float, load: float, least: float) -> float:
    """Magnitude of a wheel's Y/Q; 0 below the least load."""
    return abs(lateral_over_vertical(lateral, load, least))


def climbing_time(before: float, dt: float, outward: float, load: float, least: float) -> float:
    """For how long Y/Q has been above `CLIMB_LIMIT` without interruption, s.

    Parameters
    ----------
    before : float
        The same one time step before, s.
    dt : float
        Time step, s.
    outward : float
        Lateral force of the wheel on its rail, towards its flange, N.
    load : float
        Vertical load, N.
    least : float
        `least_load`, N.
    """
    return before + dt if load > least and outward > CLIMB_LIMIT * load else 0.0
