"""The stages of a suspension: which bodies they are between, and at what level."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from railquake.march.rows_constant import STAGES
from railquake.physics.joint import Tie

if TYPE_CHECKING:
    from railquake.inputs.vehicle import Body, Spring, Vehicle

__all__ = ["Stage", "stages_of"]


class Stage(NamedTuple):
    """One of them; bodies by their numbers."""

    upper: int
    lower: int
    tie: Tie
    gap: tuple[float, float]  # from the lower to the upper point at rest, m


def stages_of(vehicle: Vehicle, bodies: list[Body]) -> tuple[Stage, ...]:
    """Primary and secondary suspension, as many as there are.

    A stage joins a body by lateral springs to the heaviest one that is not below it; its level on
    each of them is the mean of the springs' heights there, weighed by their stiffness.

    Parameters
    ----------
    vehicle : Vehicle
    bodies : list of Body
        In the order of the degrees of freedom: the wheelset stands last.
    """
    number = {body.name: k for k, body in enumerate(bodies)}
    stages: list[Stage] = []
    lower = vehicle.wheelset
    below = {lower}
    while len(stages) < len(STAGES):
        springs = [s for s in vehicle.springs if s.direction == "lateral" and lower in s.bodies]
        above = {name for spring in springs for name in spring.bodies} - below
        if not above:
            break
        upper = max(above, key=lambda name: bodies[number[name]].mass)
        joining = [spring for spring in springs if upper in spring.bodies]
        upper_level, lower_level = _level(joining, upper), _level(joining, lower)
        # z points down: a point above a body's centre of gravity has a negative z
        tie = Tie(
            0.0,
            bodies[number[upper]].height - upper_level,
            0.0,
            bodies[number[lower]].height - lower_level,
        )
        stages.append(Stage(number[upper], number[lower], tie, (0.0, lower_level - upper_level)))
        below.add(upper)
        lower = upper
    return tuple(stages)


def _level(springs: list[Spring], body: str) -> float:
    """Mean height above the rails, m, of springs where they are attached to a body."""
    heights = [spring.end_heights[spring.bodies.index(body)] for spring in springs]
    shares = [(2.0 if spring.pair else 1.0) * spring.stiffness for spring in springs]
    return float(np.average(heights, weights=shares))
