"""Vehicles of textbooks and starts out of balance, for the classical cases.

A vehicle is any set of bodies; one alone is a block or a ball on two rails.  It stands, so that
friction is Coulomb's but for a slow creep.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from railquake.measures import STANDARD_GRAVITY as GRAVITY

if TYPE_CHECKING:
    from railquake.assembly import System
    from railquake.inputs.ground_motion import GroundMotion

__all__ = ["GRAVITY", "block", "disturbed", "motion", "pair_of"]


def block(mass: float, roll_inertia: float, height: float) -> dict[str, Any]:
    """A single body on one wheel each side, standing.

    Parameters
    ----------
    mass, roll_inertia : float
        kg, kg m2.
    height : float
        Of its centre of gravity above the rails, m: the rolling radius of its wheels.
    """
    body = {"mass": mass, "roll_inertia": roll_inertia, "height": height}
    return {"name": "block", "bodies": {"wheelset": body}, "axles": 1, "speed": 0.0}


def pair_of(height: float, **values: Any) -> dict[str, Any]:
    """The preset ``bart``'s wheels and rails with that rolling radius, and other values."""
    return {"preset": "bart", "rolling_radius": height, **values}


def motion(step: float, acceleration: ArrayLike) -> GroundMotion:
    """Ground acceleration, m/s2, at steps of so many seconds."""
    from railquake.inputs.ground_motion import GroundMotion

    return GroundMotion("test", step, np.asarray(acceleration, dtype=float))


def disturbed(
    system: System, moved: Mapping[str, Sequence[float]], moving: Mapping[str, Sequence[float]]
) -> System:
    """The system started elsewhere than at rest.

    Parameters
    ----------
    system : System
    moved, moving : mapping of str to three floats
        What is added to the displacement (y, z, roll) and velocity of each body, or to the pier's
        (u, theta_1, theta_2) under the name ``pier``.

    Returns
    -------
    System
        Contact forces and accelerations of the first step are still those at rest, as if it had
        been let go just now.
    """
    from railquake.march.order import kernel_order

    start = system.start.copy()
    dofs = len(system.vehicle.mass)
    state = system.layout.state
    place = np.argsort(kernel_order(dofs))
    for changes, pier, body in (
        (moved, state.STRUCTURE_X, state.VEHICLE_X + place),
        (moving, state.STRUCTURE_V, state.VEHICLE_V + place),
    ):
        for name, values in changes.items():
            rows = np.arange(pier, pier + 3)
            if name != "pier":
                first = 3 * system.vehicle.bodies.index(name)
                rows = body[first : first + 3]
            start[rows, 0] += values
    return replace(system, start=start)
