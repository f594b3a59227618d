"""Momentum audit: what pushes the car from outside must be what changes its momentum.

Of all bodies together, in the frame that moves with the ground, about the place O of the track's
origin at rest ::

    d/dt sum m v                    = R + sum m (g - a_g)
    d/dt sum [ m (p x v) + I phi' ] = M_O + sum p x m (g - a_g)        p x f = p_y f_z - p_z f_y

with the force R of the rails and its moment M_O, and p the bodies' true places.  No force between
two bodies stands in it, so a joint that does not act back with the same force along the same line
is seen; and the number of axles, or a mass, does not cancel as it does where a force works on both
sides.

The paper's linear car turns its bodies about their undeformed places, p = (0, -height): gravity has
no moment then, and joints whose ends stand at two heights hold a turning car by a couple from
nowhere.  Its own equations keep, with the rows k and c of that couple over displacements X ::

    d/dt { sum [ m (p x v) + I phi' ] + c X } = M_w + p_w x R - sum p x m a_g - k X

M_w being the rails' moment about the wheelset's centre p_w.  What gravity's moment would have given
is counted by itself.
"""

from dataclasses import dataclass
from typing import NamedTuple

from railquake.physics.profiles import Patch

__all__ = [
    "MomentumAudit",
    "Pair",
    "counted_moment",
    "counted_place",
    "moment",
    "moment_undeformed",
    "patch_moment",
    "place_undeformed",
    "true_moment",
    "true_place",
]

LEAST_SPEED = 1e-3  # m/s; a car that is given less counts as given this
ARM = 1.0  # m, of that impulse


class Pair(NamedTuple):
    """A place or a force in the plane."""

    y: float  # right, m or N
    z: float  # down, m or N


def moment(place: Pair, force: Pair) -> float:
    """Of a force about x, p x f: right side down, N m."""
    return place.y * force.z - place.z * force.y


def counted_place(y: float, z: float, height: float) -> Pair:
    """Slot of the kinematics: where the equations have a body.

    Parameters
    ----------
    y, z : float
        Its displacement from the undeformed position, m.
    height : float
        Of its centre of gravity above the rails there, m.
    """
    raise NotImplementedError("a vehicle's kinematics are chosen when a kernel is bound")


def true_place(y: float, z: float, height: float) -> Pair:
    """Of a body that turns by any angle: where it is."""
    return Pair(y, z - height)


def place_undeformed(y: float, z: float, height: float) -> Pair:
    """Of a linear car's body: where it was drawn."""
    return Pair(0.0, -height)


def patch_moment(patch: Patch, shift: float, height: float, force: Pair) -> float:
    """Moment of a patch's force about the track's origin, right-hand wheel, N m.

    From the point on the rail, by itself: the wheelset is moved by derivatives of the gap instead.

    Parameters
    ----------
    patch : profiles.Patch
    shift, height : float
        The wheelset's centre in track axes, seen from a right-hand wheel, m.
    force : Pair
        On the wheel.
    """
    arm_z = patch.rail_z - height
    arm_y = -patch.gap_psi - patch.slope * arm_z
    return moment(Pair(shift + arm_y, patch.rail_z), force)


def counted_moment(about_track: float, force: Pair, track: Pair, arm: Pair, height: float) -> float:
    """Slot of the kinematics: the rails' moment about O as the equations have it, N m.

    Parameters
    ----------
    about_track : float
        About the track's origin, N m.
    force : Pair
        Of the rails on the car.
    track, arm : Pair
        From O to the track's origin, and from there to the wheelset's centre.
    height : float
        Of that centre where it was drawn, m.
    """
    raise NotImplementedError("a vehicle's kinematics are chosen when a kernel is bound")


def true_moment(about_track: float, force: Pair, track: Pair, arm: Pair, height: float) -> float:
    """Of a car that turns by any angle: the force acts where it is."""
    return about_track + moment(track, force)


def moment_undeformed(
    about_track: float, force: Pair, track: Pair, arm: Pair, height: float
) -> float:
    """Of a linear car: about the wheelset's centre, and the force where that was drawn."""
    return about_track - moment(arm, force) + height * force.y


@dataclass(frozen=True)
class MomentumAudit:
    """Largest values at the frames' ends; all impulses since the start.

    Attributes
    ----------
    linear_residual, angular_residual : float
        What the impulses do not explain of the car's momentum, either direction, N s, and of its
        angular momentum about the track's origin at rest, N m s.
    linear_impulse, angular_impulse : float
        Largest impulse and impulse of a moment of the rails, of the effective forces of the ground
        and of gravity; what the rails bear against the weight counts without it.
    omitted_impulse : float
        Of gravity's moment where the car's equations leave it out, N m s; else 0.
    mass : float
        Of the car, kg.
    """

    linear_residual: float
    angular_residual: float
    linear_impulse: float
    angular_impulse: float
    omitted_impulse: float
    mass: float

    @property
    def linear_relative(self) -> float:
        """Residual of the momentum over the largest impulse."""
        return self.linear_residual / max(self.linear_impulse, self.mass * LEAST_SPEED)

    @property
    def angular_relative(self) -> float:
        """Residual of the angular momentum over the largest impulse of a moment."""
        return self.angular_residual / self._largest_angular

    @property
    def omitted_relative(self) -> float:
        """Impulse of gravity's moment that is left out over the largest of those that are not."""
        return self.omitted_impulse / self._largest_angular

    @property
    def _largest_angular(self) -> float:
        return max(self.angular_impulse, self.mass * LEAST_SPEED * ARM)
