"""Stages of a car of bodies that turn by any angle, with gravity, springs, dashpots and stops.

A kernel is bound to the joints of its car: the functions that go through all of them are made from
the list of joints (`joined_laws`), since compiled code is fast only where it knows which bodies a
joint holds.
"""

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np

from railquake.march import momentum, sprung
from railquake.march.packing import reader
from railquake.march.rows import Joined, constant, size, state
from railquake.physics.elementary import sin_cos
from railquake.physics.joint import (
    JointSpring,
    Pose,
    Pull,
    Relative,
    Sides,
    Tie,
    knee_force,
    pull,
    relative,
    spring_energy,
    spring_force,
    spring_moment,
    stop_force,
)
from railquake.physics.momentum import counted_moment, counted_place, true_moment, true_place
from railquake.physics.vehicle import free_acceleration

__all__ = ["joined_laws"]

Array = np.ndarray[Any, np.dtype[np.float64]]

read_tie = reader(Tie)
read_spring = reader(JointSpring)
read_sides = reader(Sides)


# --- bodies -------------------------------------------------------------------------------------


def turn_bodies(S: Array, lane: int) -> None:
    """Sine and cosine of each body's roll."""
    for k in range(size.BODIES):
        S[state.BODY_SIN + k, lane], S[state.BODY_COS + k, lane] = sin_cos(
            S[state.VEHICLE_X + 2 * k + 1, lane]
        )


def clear_pulls(S: Array, lane: int) -> None:
    """No forces yet; the rows of the accelerations add them up."""
    for i in range(size.DOFS):
        S[state.VEHICLE_A + i, lane] = 0.0


def pose_of(S: Array, body: int, lane: int) -> Pose:
    """A body by its rows."""
    along = 2 * size.BODIES + body
    return Pose(
        S[state.VEHICLE_X + 2 * body, lane],
        S[state.VEHICLE_X + along, lane],
        S[state.VEHICLE_X + 2 * body + 1, lane],
        S[state.BODY_SIN + body, lane],
        S[state.BODY_COS + body, lane],
        S[state.VEHICLE_V + 2 * body, lane],
        S[state.VEHICLE_V + along, lane],
        S[state.VEHICLE_V + 2 * body + 1, lane],
    )


def add_pull(S: Array, upper: int, lower: int, force: Pull, lane: int) -> None:
    """What a joint does to its bodies."""
    S[state.VEHICLE_A + 2 * upper, lane] += force.y
    S[state.VEHICLE_A + 2 * size.BODIES + upper, lane] += force.z
    S[state.VEHICLE_A + 2 * upper + 1, lane] += force.upper_roll
    S[state.VEHICLE_A + 2 * lower, lane] -= force.y
    S[state.VEHICLE_A + 2 * size.BODIES + lower, lane] -= force.z
    S[state.VEHICLE_A + 2 * lower + 1, lane] += force.lower_roll


def free_body(S: Array, Q: Array, i: int, lane: int) -> None:
    """Acceleration of degree of freedom ``i`` from what pulls it, contact forces left out."""
    is_y = 1.0 if i < 2 * size.BODIES and (i & 1) == 0 else 0.0
    is_z = 1.0 if i >= 2 * size.BODIES else 0.0
    S[state.VEHICLE_A + i, lane] = free_acceleration(
        is_y,
        is_z,
        (S[state.GROUND, lane], S[state.GROUND_Z, lane]),
        Q[constant.GRAVITY, lane],
        -Q[constant.INVERSE_MASS + i, lane] * S[state.VEHICLE_A + i, lane],
    )


def kinetic_energy(S: Array, Q: Array, lane: int) -> float:
    """Of all bodies, J."""
    energy = 0.0
    for i in range(size.DOFS):
        v = S[state.VEHICLE_V + i, lane]
        energy += 0.5 * v * v / Q[constant.INVERSE_MASS + i, lane]
    return energy


# --- joints -------------------------------------------------------------------------------------


def felt(S: Array, Q: Array, element: int, upper: int, lower: int, lane: int) -> Relative:
    """What element number ``element`` feels between two bodies."""
    gap = constant.GAPS + 2 * element
    return relative(
        pose_of(S, upper, lane),
        pose_of(S, lower, lane),
        read_tie(Q, constant.TIES + size.TIE_FIELDS * element, lane),
        (Q[gap, lane], Q[gap + 1, lane]),
    )


def twist(S: Array, upper: int, lower: int, lane: int) -> float:
    """theta: roll of the upper body against the lower, rad."""
    theta: float = (
        S[state.VEHICLE_X + 2 * upper + 1, lane] - S[state.VEHICLE_X + 2 * lower + 1, lane]
    )
    return theta


def pull_spring(
    S: Array, Q: Array, element: int, number: int, upper: int, lower: int, lane: int
) -> None:
    """Springs and dashpots, number ``number`` of them."""
    at = felt(S, Q, element, upper, lower, lane)
    spring = read_spring(Q, constant.SPRINGS + size.SPRING_FIELDS * number, lane)
    force, lost = spring_force(at, spring)
    moment = spring_moment(twist(S, upper, lower, lane), spring)
    S[state.DASHPOT_POWER, lane] += lost
    add_pull(S, upper, lower, pull(at, force, moment), lane)


def stored_in_spring(
    S: Array, Q: Array, element: int, number: int, upper: int, lower: int, lane: int
) -> float:
    """Energy of `pull_spring`, J."""
    at = felt(S, Q, element, upper, lower, lane)
    spring = read_spring(Q, constant.SPRINGS + size.SPRING_FIELDS * number, lane)
    return spring_energy(at, twist(S, upper, lower, lane), spring)


def pushed_by(Q: Array, number: int, travel: float, lane: int) -> float:
    """Force of a stop's table at a travel to one side, N."""
    force = 0.0
    for k in range(size.RAMPS):
        ramp = size.RAMPS * number + k
        beyond = max(travel - Q[constant.RAMP_TRAVEL + ramp, lane], 0.0)
        force += Q[constant.RAMP_SLOPE + ramp, lane] * beyond
    return force


def stored_by(Q: Array, number: int, travel: float, lane: int) -> float:
    """Energy of `pushed_by`, J."""
    energy = 0.0
    for k in range(size.RAMPS):
        ramp = size.RAMPS * number + k
        beyond = max(travel - Q[constant.RAMP_TRAVEL + ramp, lane], 0.0)
        energy += 0.5 * Q[constant.RAMP_SLOPE + ramp, lane] * beyond * beyond
    return energy


def bear_on_stop(S: Array, Q: Array, number: int, travel: float, rate: float, lane: int) -> float:
    """Force of a stop against its travel, N; what its damping takes, and its largest travel."""
    sides = read_sides(Q, constant.STOP_SIDES + size.SIDES_FIELDS * number, lane)
    right = sides.positive * pushed_by(Q, number, travel, lane)
    left = sides.negative * pushed_by(Q, number, -travel, lane)
    force = stop_force(right, rate, sides) - stop_force(left, -rate, sides)
    S[state.DASHPOT_POWER, lane] += (force - (right - left)) * rate
    borne = max(sides.positive * travel, -sides.negative * travel)
    S[state.STOP_TRAVEL + number, lane] = max(S[state.STOP_TRAVEL + number, lane], borne)
    return force


def pull_lateral_stop(
    S: Array, Q: Array, element: int, number: int, upper: int, lower: int, lane: int
) -> None:
    """A stop along the mean axes' y, number ``number`` of the stops."""
    at = felt(S, Q, element, upper, lower, lane)
    force = bear_on_stop(S, Q, number, at.y, at.vy, lane)
    add_pull(S, upper, lower, pull(at, (-force, 0.0), 0.0), lane)


def pull_vertical_stop(
    S: Array, Q: Array, element: int, number: int, upper: int, lower: int, lane: int
) -> None:
    """A stop along the mean axes' z, number ``number`` of the stops."""
    at = felt(S, Q, element, upper, lower, lane)
    force = bear_on_stop(S, Q, number, at.z, at.vz, lane)
    add_pull(S, upper, lower, pull(at, (0.0, -force), 0.0), lane)


def stored_in_stop(S: Array, Q: Array, number: int, travel: float, lane: int) -> float:
    """Energy of a stop, J."""
    sides = read_sides(Q, constant.STOP_SIDES + size.SIDES_FIELDS * number, lane)
    return sides.positive * stored_by(Q, number, travel, lane) + sides.negative * stored_by(
        Q, number, -travel, lane
    )


def stored_in_lateral_stop(
    S: Array, Q: Array, element: int, number: int, upper: int, lower: int, lane: int
) -> float:
    """Energy of `pull_lateral_stop`, J."""
    return stored_in_stop(S, Q, number, felt(S, Q, element, upper, lower, lane).y, lane)


def stored_in_vertical_stop(
    S: Array, Q: Array, element: int, number: int, upper: int, lower: int, lane: int
) -> float:
    """Energy of `pull_vertical_stop`, J."""
    return stored_in_stop(S, Q, number, felt(S, Q, element, upper, lower, lane).z, lane)


def resist_by_knee(S: Array, Q: Array, number: int, rate: float, lane: int) -> float:
    """Force of a dashpot with a knee, N, and what it takes."""
    first = constant.KNEES + 3 * number
    force = knee_force(rate, Q[first, lane], Q[first + 1, lane], Q[first + 2, lane])
    S[state.DASHPOT_POWER, lane] += force * rate
    return force


def pull_lateral_knee(
    S: Array, Q: Array, element: int, number: int, upper: int, lower: int, lane: int
) -> None:
    """A dashpot with a knee along y, number ``number`` of them."""
    at = felt(S, Q, element, upper, lower, lane)
    force = resist_by_knee(S, Q, number, at.vy, lane)
    add_pull(S, upper, lower, pull(at, (-force, 0.0), 0.0), lane)


def pull_vertical_knee(
    S: Array, Q: Array, element: int, number: int, upper: int, lower: int, lane: int
) -> None:
    """A dashpot with a knee along z, number ``number`` of them."""
    at = felt(S, Q, element, upper, lower, lane)
    force = resist_by_knee(S, Q, number, at.vz, lane)
    add_pull(S, upper, lower, pull(at, (0.0, -force), 0.0), lane)


def finite_travel(S: Array, Q: Array, stage: int, lane: int) -> float:
    """Lateral travel of a stage of the suspension in the mean axes of its bodies, m."""
    gap = constant.STAGE_GAPS + 2 * stage
    return relative(
        pose_of(S, int(Q[constant.STAGE_UPPER + stage, lane]), lane),
        pose_of(S, int(Q[constant.STAGE_LOWER + stage, lane]), lane),
        read_tie(Q, constant.STAGE_TIES + size.TIE_FIELDS * stage, lane),
        (Q[gap, lane], Q[gap + 1, lane]),
    ).y


# --- all joints of a car ------------------------------------------------------------------------

_PULLS = {
    "spring": pull_spring,
    "lateral stop": pull_lateral_stop,
    "vertical stop": pull_vertical_stop,
    "lateral knee": pull_lateral_knee,
    "vertical knee": pull_vertical_knee,
}
_STORES = {
    "spring": stored_in_spring,
    "lateral stop": stored_in_lateral_stop,
    "vertical stop": stored_in_vertical_stop,
}


@cache
def joined_laws(joined: Joined) -> dict[Callable[..., Any], Callable[..., Any]]:
    """What stands in the slots of the vehicle (`sprung`) for a car with these joints."""
    accelerate = [
        "for lane in range(lanes):",
        "    turn_bodies(S, lane)",
        "    clear_pulls(S, lane)",
    ]
    energy = ["turn_bodies(S, lane)", "energy = kinetic_energy(S, Q, lane)"]
    numbers = {"spring": 0, "stop": 0, "knee": 0}
    for element, (kind, upper, lower) in enumerate(joined.elements):
        family = kind.split()[-1]
        arguments = f"(S, Q, {element}, {numbers[family]}, {upper}, {lower}, lane)"
        numbers[family] += 1
        accelerate += ["for lane in range(lanes):", f"    {_PULLS[kind].__name__}{arguments}"]
        if kind in _STORES:
            energy.append(f"energy += {_STORES[kind].__name__}{arguments}")
    accelerate += [
        "for lane in range(lanes):",
        "    for i in range(size.DOFS):",
        "        free_body(S, Q, i, lane)",
    ]
    energy.append("return energy")
    return {
        sprung.accelerate_free: _made("accelerate_joined", "S, Q, lanes", accelerate),
        sprung.vehicle_energy: _made("joined_energy", "S, Q, lane", energy),
        sprung.stage_travel: finite_travel,
        counted_place: true_place,
        counted_moment: true_moment,
        momentum.stiffness_of_ends: momentum.no_couple,
        momentum.damping_of_ends: momentum.nothing_held,
    }


def _made(name: str, arguments: str, lines: list[str]) -> Callable[..., Any]:
    """Function with these lines, which sees what this module holds."""
    scope = dict(globals())
    body = "\n    ".join(lines)
    exec(f"def {name}({arguments}):\n    {body}\n", scope)
    made: Callable[..., Any] = scope[name]
    return made
