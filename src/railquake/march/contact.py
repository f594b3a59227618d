"""Stages of wheel on rail: where they touch, and with what forces.

Sides are numbered 0 (left) and 1 (right), zones 0 (tread) and 1 (flange).
"""

from typing import Any

import numpy as np

from railquake.march.packing import reader, writer
from railquake.march.rows import constant, size, state
from railquake.march.rows_state import POWERS
from railquake.physics.contact_table import (
    FIELDS,
    AxisCells,
    Polynomials,
    RunningCircle,
    RunningPoint,
    axis_cell,
    cell_polynomials,
    patch_in_cell,
    running_point,
)
from railquake.physics.momentum import Pair, patch_moment
from railquake.physics.patch import Contact, WheelMotion, closing_rate, patch_forces
from railquake.physics.profiles import POSITIVE, Geometry, Patch, zone_contact

__all__ = [
    "add_wheels",
    "any_flange_near",
    "bearing_flanges",
    "clear_forces",
    "closed_patch",
    "displacement",
    "evaluated_patch",
    "every_flange",
    "every_flange_near",
    "fetch_cells",
    "fetch_polynomials",
    "flange_near",
    "locate_cells",
    "locate_in_table",
    "look_at_flanges",
    "no_cells",
    "no_polynomials",
    "patch",
    "patch_by_grid",
    "patch_by_table",
    "press_flange",
    "press_patch",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

LOOK = 2e-4  # s; twice what passes at most between two looks at flanges, see `look_at_flange`
SPARE = 1e-4  # m
KINDS = len(POWERS)

read_axis = reader(AxisCells)
read_circle = reader(RunningCircle)
read_contact = reader(Contact)
read_polynomials = reader(Polynomials)
write_polynomials = writer(Polynomials)


# --- where they may touch -----------------------------------------------------------------------


def locate_cells(S: Array, Q: Array, displacement_nodes: int, lane: int) -> None:
    """Slot of the contact method: the contact table's cell for each side."""
    raise NotImplementedError("a contact method is chosen when a kernel is bound")


def fetch_cells(S: Array, Q: Array, geometry: Geometry, lane: int) -> None:
    """Slot of the contact method: the polynomials of each side's cell."""
    raise NotImplementedError("a contact method is chosen when a kernel is bound")


def patch(S: Array, Q: Array, geometry: Geometry, side: int, zone: int, lane: int) -> Patch:
    """Slot of the contact method: smallest gap of a zone, and what the forces there need."""
    raise NotImplementedError("a contact method is chosen when a kernel is bound")


def no_cells(S: Array, Q: Array, displacement_nodes: int, lane: int) -> None:
    """No table is used."""


def no_polynomials(S: Array, Q: Array, geometry: Geometry, lane: int) -> None:
    """No table is used."""


def patch_by_grid(S: Array, Q: Array, geometry: Geometry, side: int, zone: int, lane: int) -> Patch:
    """By the grid method itself."""
    sign = 2.0 * side - 1.0
    first = geometry.flange_points if zone == 0 else 0
    last = len(geometry.wheel_y) if zone == 0 else geometry.flange_points
    return zone_contact(
        sign * S[state.SHIFT, lane], sign * S[state.ROLL, lane], first, last, geometry
    )


def locate_in_table(S: Array, Q: Array, displacement_nodes: int, lane: int) -> None:
    """Each side by its own displacement; the left side's roll is the mirror image."""
    rolls = read_axis(Q, constant.ROLL_AXIS, lane)
    i, w_roll, roll_rate = axis_cell(S[state.ROLL, lane], rolls)
    last_i = 2.0 * rolls.coarse_cells + rolls.inner_cells - 1.0
    first_of_roll = (last_i - i) * displacement_nodes, i * displacement_nodes
    place_of_roll = 1.0 - w_roll, w_roll
    for side in range(2):
        j, w, rate = axis_cell(
            displacement(S, Q, side, lane), read_axis(Q, constant.DISPLACEMENT_AXIS, lane)
        )
        S[state.CELL_BASE + side, lane] = (first_of_roll[side] + j) * (2 * FIELDS)
        S[state.CELL_DISPLACEMENT + side, lane] = w
        S[state.CELL_DISPLACEMENT_RATE + side, lane] = rate
        S[state.CELL_ROLL + side, lane] = place_of_roll[side]
        S[state.CELL_ROLL_RATE + side, lane] = roll_rate


def point_of_side(S: Array, Q: Array, side: int, lane: int) -> RunningPoint:
    """A wheel's running point seen from its own side."""
    sign = 2.0 * side - 1.0
    return running_point(
        sign * S[state.ROLL_SIN, lane],
        S[state.ROLL_COS, lane],
        read_circle(Q, constant.RUNNING_CIRCLE, lane),
    )


def displacement(S: Array, Q: Array, side: int, lane: int) -> float:
    """Of a wheel on its rail, u, outward, m."""
    sign = 2.0 * side - 1.0
    reach = point_of_side(S, Q, side, lane).reach
    u: float = sign * S[state.SHIFT, lane] + reach - Q[constant.HALF_SPACING, lane]
    return u


def fetch_polynomials(S: Array, Q: Array, geometry: Geometry, lane: int) -> None:
    """When a wheel has come to another cell; it stays in one for many steps."""
    fetch_side(S, geometry, 0, lane)
    fetch_side(S, geometry, 1, lane)


def fetch_side(S: Array, geometry: Geometry, side: int, lane: int) -> None:
    """`fetch_polynomials` for one side."""
    base = S[state.CELL_BASE + side, lane]
    if base != S[state.CELL_HELD + side, lane]:
        S[state.CELL_HELD + side, lane] = base
        width = 1.0 / S[state.CELL_DISPLACEMENT_RATE + side, lane]
        roll_width = 1.0 / S[state.CELL_ROLL_RATE + side, lane]
        next_roll = (geometry.displacement_nodes * 2 * FIELDS) & POSITIVE
        for zone in range(2):
            corner = (int(base) & POSITIVE) + zone * FIELDS
            made = cell_polynomials(corner, next_roll, width, roll_width, geometry.table)
            write_polynomials(S, polynomials_of(side, zone), made, lane)


def polynomials_of(side: int, zone: int) -> int:
    """First row of a patch's polynomials."""
    return state.POLYNOMIALS + (2 * side + zone) * size.POLYNOMIAL_FIELDS


def patch_by_table(
    S: Array, Q: Array, geometry: Geometry, side: int, zone: int, lane: int
) -> Patch:
    """From the polynomials of the wheel's cell."""
    return patch_in_cell(
        read_polynomials(S, polynomials_of(side, zone), lane),
        (S[state.CELL_DISPLACEMENT + side, lane], S[state.CELL_ROLL + side, lane]),
        (S[state.CELL_DISPLACEMENT_RATE + side, lane], S[state.CELL_ROLL_RATE + side, lane]),
        point_of_side(S, Q, side, lane),
    )


# --- whether a flange may touch -----------------------------------------------------------------


def flange_near(S: Array, side: int, lanes: int) -> bool:
    """Slot of the engine: whether a side's flange may touch its rail before the next look."""
    raise NotImplementedError("an engine is chosen when a kernel is bound")


def any_flange_near(S: Array, side: int, lanes: int) -> bool:
    """Whether it may in any lane."""
    nearest = 0.0
    for lane in range(lanes):
        nearest = max(nearest, S[state.NEAR + side, lane])
    return nearest > 0.0


def every_flange_near(S: Array, side: int, lanes: int) -> bool:
    """One scenario looks at every flange in every step."""
    return True


def look_at_flanges(S: Array, Q: Array, geometry: Geometry, lane: int) -> None:
    """Now and then, where many run abreast: how near the flanges are to their rails."""
    look_at_flange(S, Q, geometry, 0, lane)
    look_at_flange(S, Q, geometry, 1, lane)


def look_at_flange(S: Array, Q: Array, geometry: Geometry, side: int, lane: int) -> None:
    """`look_at_flanges` for one side.

    A flange that would not reach its rail within `LOOK` (and a time step) if it went on as it does,
    with `SPARE` left for what it is hurried, bears nothing until it is looked at again.
    """
    found = patch(S, Q, geometry, side, 1, lane)
    motion = motion_of_side(S, side, lane)
    penetration = motion.height - found.gap
    horizon = LOOK + Q[constant.DT, lane]
    reaches = penetration + max(closing_rate(found, motion), 0.0) * horizon + SPARE > 0.0
    S[state.NEAR + side, lane] = S[state.ON_TRACK, lane] if reaches else 0.0


# --- forces -------------------------------------------------------------------------------------


def clear_forces(S: Array, lane: int) -> None:
    """Nothing of what the patches will add up."""
    S[state.FORCE_PSI, lane] = 0.0
    S[state.HERTZ_ENERGY, lane] = 0.0
    S[state.PATCH_MOMENTS, lane] = 0.0
    S[state.AXLE_MOMENT, lane] = 0.0
    S[state.AXLE_DAMPING, lane] = 0.0
    for k in range(KINDS):
        S[state.CONTACT_POWER + k, lane] = 0.0
    for side in range(2):
        S[state.LOAD + side, lane] = 0.0
        S[state.LATERAL + side, lane] = 0.0


def motion_of_side(S: Array, side: int, lane: int) -> WheelMotion:
    """The wheelset's motion seen from the wheel of a side."""
    sign = 2.0 * side - 1.0
    return WheelMotion(
        S[state.HEIGHT, lane],
        sign * S[state.SHIFT_V, lane],
        S[state.HEIGHT_V, lane],
        sign * S[state.ROLL_V, lane],
        sign * S[state.ROLL_SIN, lane],
        S[state.ROLL_COS, lane],
        S[state.AXLE_RATE, lane],
    )


def press_patch(S: Array, Q: Array, geometry: Geometry, side: int, zone: int, lane: int) -> None:
    """Slot of the engine: contact forces of a patch, added up for the wheelset."""
    raise NotImplementedError("an engine is chosen when a kernel is bound")


def evaluated_patch(
    S: Array, Q: Array, geometry: Geometry, side: int, zone: int, lane: int
) -> None:
    """Many abreast evaluate open patches all the same."""
    add_patch(S, Q, geometry, side, zone, patch(S, Q, geometry, side, zone, lane), lane)


def closed_patch(S: Array, Q: Array, geometry: Geometry, side: int, zone: int, lane: int) -> None:
    """For one scenario an open patch costs nothing."""
    found = patch(S, Q, geometry, side, zone, lane)
    if S[state.HEIGHT, lane] > found.gap:
        add_patch(S, Q, geometry, side, zone, found, lane)
    else:
        S[state.PATCH_PENETRATION + 2 * side + zone, lane] = S[state.HEIGHT, lane] - found.gap
        S[state.PATCH_HYSTERESIS + 2 * side + zone, lane] = 0.0


def press_flange(S: Array, Q: Array, geometry: Geometry, side: int, lanes: int) -> None:
    """Slot of the engine: contact forces of a side's flange in every lane."""
    raise NotImplementedError("an engine is chosen when a kernel is bound")


def every_flange(S: Array, Q: Array, geometry: Geometry, side: int, lanes: int) -> None:
    """Lane by lane."""
    for lane in range(lanes):
        press_patch(S, Q, geometry, side, 1, lane)


def bearing_flanges(S: Array, Q: Array, geometry: Geometry, side: int, lanes: int) -> None:
    """All gaps by vectors, then one by one the flanges that bear.

    The numbers of a law's table come singly from memory, whatever a vector unit can do, and few
    flanges bear at a time.
    """
    number = 2 * side + 1
    for lane in range(lanes):
        gap = patch(S, Q, geometry, side, 1, lane).gap
        penetration = S[state.NEAR + side, lane] * (S[state.HEIGHT, lane] - gap)
        S[state.PATCH_PENETRATION + number, lane] = penetration
        held = S[state.PATCH_HYSTERESIS + number, lane]
        S[state.PATCH_HYSTERESIS + number, lane] = held if penetration > 0.0 else 0.0
    lane = next_bearing(S, number, 0, lanes)
    while lane < lanes:
        press_patch(S, Q, geometry, side, 1, lane)
        lane = next_bearing(S, number, lane + 1, lanes)


def next_bearing(S: Array, number: int, lane: int, lanes: int) -> int:
    """First lane from ``lane`` on in which a patch bears; ``lanes`` where none does."""
    while lane < lanes and not S[state.PATCH_PENETRATION + number, lane] > 0.0:
        lane += 1
    return lane


def add_patch(
    S: Array, Q: Array, geometry: Geometry, side: int, zone: int, found: Patch, lane: int
) -> None:
    """Forces of a patch whose gap and contact data are known."""
    sign = 2.0 * side - 1.0
    number = 2 * side + zone
    motion = motion_of_side(S, side, lane)
    penetration = motion.height - found.gap
    if zone == 1:
        penetration *= S[state.NEAR + side, lane]
    forces = patch_forces(
        penetration,
        found,
        motion,
        S[state.PATCH_HYSTERESIS + number, lane],
        read_contact(Q, constant.CONTACT, lane),
        zone,
        geometry.flange_law if zone == 1 else geometry.tread_law,
    )
    S[state.PATCH_PENETRATION + number, lane] = penetration
    S[state.PATCH_HYSTERESIS + number, lane] = forces.hysteresis
    S[state.FORCE_PSI, lane] += sign * forces.psi
    S[state.HERTZ_ENERGY, lane] += forces.energy
    S[state.IMPACT_POWER, lane] += forces.impact
    S[state.CREEP_POWER, lane] += forces.creep
    S[state.SPIN_POWER, lane] += forces.spin
    S[state.FORWARD_POWER, lane] += forces.forward
    S[state.AXLE_MOMENT, lane] += forces.axle_moment
    S[state.AXLE_DAMPING, lane] += forces.axle_damping
    S[state.LOAD + side, lane] -= forces.z
    S[state.LATERAL + side, lane] -= sign * forces.y
    S[state.PATCH_MOMENTS, lane] += sign * patch_moment(
        found, sign * S[state.SHIFT, lane], motion.height, Pair(forces.y, forces.z)
    )


def add_wheels(S: Array, Q: Array, lane: int) -> None:
    """Forces and powers of all wheels of the section; the forces in ground axes, too."""
    count = Q[constant.AXLES, lane] * S[state.ON_TRACK, lane]
    for side in range(2):
        S[state.LOAD + side, lane] *= count
        S[state.LATERAL + side, lane] *= count
    S[state.FORCE_PSI, lane] *= count
    S[state.HERTZ_ENERGY, lane] *= count
    for k in range(KINDS):
        S[state.CONTACT_POWER + k, lane] *= count
    force_y = -(S[state.LATERAL_LEFT, lane] + S[state.LATERAL_RIGHT, lane])
    force_z = -(S[state.LOAD_LEFT, lane] + S[state.LOAD_RIGHT, lane])
    sine = S[state.TRACK_SIN, lane]
    cosine = S[state.TRACK_COS, lane]
    S[state.FORCE_Y, lane] = force_y
    S[state.FORCE_Z, lane] = force_z
    S[state.WHEELSET_Y, lane] = cosine * force_y - sine * force_z
    S[state.WHEELSET_Z, lane] = sine * force_y + cosine * force_z
    S[state.WHEELSET_PHI, lane] = S[state.FORCE_PSI, lane]
