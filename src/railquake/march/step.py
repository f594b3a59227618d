"""One step of the coupled system: Figure 4 of the paper.

Each call of `step` is a stage, or some, for all lanes: a short loop over lanes, so that a compiler
may advance many scenarios by one instruction.
"""

from typing import Any

import numpy as np

from railquake.march.contact import (
    add_wheels,
    clear_forces,
    fetch_cells,
    flange_near,
    locate_cells,
    press_flange,
    press_patch,
)
from railquake.march.ground import move_ground
from railquake.march.momentum import gather_rails, push_by_rails, push_on_bodies
from railquake.march.peaks import measure_contact, measure_structure
from railquake.march.rows import size
from railquake.march.sprung import (
    accelerate_free,
    lose_to_dashpots,
    predict_sprung,
    vehicle_energy,
    work_on_bodies,
)
from railquake.march.structure import move_structure
from railquake.march.track import lead_track, load_track, move_track, orient_track, place_track
from railquake.march.wheelset import (
    carry_suspension_on,
    keep_place,
    keep_suspension,
    place_wheelset,
    predict_wheelset,
    push_wheelset,
    turn_axle,
)
from railquake.physics.profiles import Geometry

__all__ = ["find_contact_forces", "find_free_accelerations", "find_vehicle_energy", "step"]

Array = np.ndarray[Any, np.dtype[np.float64]]


def step(S: Array, Q: Array, geometry: Geometry, lanes: int, substeps: int) -> None:
    """One step of structure, track, contact and vehicle.

    The wheelset on its rails, whose contacts are stiffest by far, may take several time steps while
    the structure and the sprung bodies take one.

    Parameters
    ----------
    S, Q : array, shape (its rows, lanes)
        Rows of `rows_state` and `rows_constant`.
    geometry : Geometry
    lanes : int
        Scenarios abreast.
    substeps : int
        Time steps of the wheelset; with one, all go together.
    """
    load_structure(S, Q, lanes)
    advance_structure(S, Q, lanes)
    direct_track(S, Q, lanes)
    predict_bodies(S, Q, lanes)
    left_near = flange_near(S, 0, lanes)
    right_near = flange_near(S, 1, lanes)
    for n in range(substeps):
        predict_contact(S, Q, geometry, lanes)
        press_treads(S, Q, geometry, lanes)
        if left_near:
            press_flange(S, Q, geometry, 0, lanes)
        if right_near:
            press_flange(S, Q, geometry, 1, lanes)
        if n + 1 < substeps:
            carry_suspension(S, lanes)
        else:
            accelerate_bodies(S, Q, lanes)
        accelerate_wheelset(S, Q, lanes)
    for lane in range(lanes):
        measure_structure(S, lane)


def load_structure(S: Array, Q: Array, lanes: int) -> None:
    """The ground at the step's end; the last contact forces on the track where it is."""
    for lane in range(lanes):
        move_ground(S, Q, lane)
        load_track(S, Q, lane)
        place_track(S, Q, lane)
        orient_track(S, lane)


def advance_structure(S: Array, Q: Array, lanes: int) -> None:
    """Newmark's step of the structure."""
    for lane in range(lanes):
        move_structure(S, Q, lane)


def direct_track(S: Array, Q: Array, lanes: int) -> None:
    """How the track gets to where the structure has moved."""
    for lane in range(lanes):
        lead_track(S, Q, lane)
        keep_place(S, lane)


def predict_bodies(S: Array, Q: Array, lanes: int) -> None:
    """Zhai's prediction of the sprung bodies."""
    for i in range(size.WHEELSET_Y):
        for lane in range(lanes):
            predict_sprung(S, Q, i, lane)
    for i in range(2 * size.BODIES, size.WHEELSET_Z):
        for lane in range(lanes):
            predict_sprung(S, Q, i, lane)


def predict_contact(S: Array, Q: Array, geometry: Geometry, lanes: int) -> None:
    """Track and wheelset at the new time, and where wheel and rail may touch."""
    for lane in range(lanes):
        move_track(S, Q, lane)
        predict_wheelset(S, Q, lane)
        place_wheelset(S, Q, lane)
    for lane in range(lanes):
        locate_cells(S, Q, geometry.displacement_nodes, lane)
    for lane in range(lanes):
        fetch_cells(S, Q, geometry, lane)


def press_treads(S: Array, Q: Array, geometry: Geometry, lanes: int) -> None:
    """Contact forces of both treads."""
    for lane in range(lanes):
        clear_forces(S, lane)
        press_patch(S, Q, geometry, 0, 0, lane)
        press_patch(S, Q, geometry, 1, 0, lane)


def carry_suspension(S: Array, lanes: int) -> None:
    """The suspension's share of the wheelset between two of its evaluations."""
    for lane in range(lanes):
        carry_suspension_on(S, lane)


def accelerate_bodies(S: Array, Q: Array, lanes: int) -> None:
    """Accelerations of all bodies, the contact forces on the wheelset left out."""
    for lane in range(lanes):
        work_on_bodies(S, Q, lane)
    for lane in range(lanes):
        push_on_bodies(S, Q, lane)
    accelerate_free(S, Q, lanes)
    for lane in range(lanes):
        lose_to_dashpots(S, Q, lane)
    for lane in range(lanes):
        keep_suspension(S, Q, lane)


def accelerate_wheelset(S: Array, Q: Array, lanes: int) -> None:
    """The contact forces on the wheelset, and what is measured of them."""
    for lane in range(lanes):
        gather_rails(S, Q, lane)
        push_by_rails(S, Q, lane)
    for lane in range(lanes):
        add_wheels(S, Q, lane)
        push_wheelset(S, Q, lane)
        turn_axle(S, Q, lane)
        measure_contact(S, Q, lane)


def find_contact_forces(S: Array, Q: Array, geometry: Geometry) -> None:
    """The contact stages of `step` alone, for one scenario at rest or held."""
    orient_track(S, 0)
    place_wheelset(S, Q, 0)
    locate_cells(S, Q, geometry.displacement_nodes, 0)
    fetch_cells(S, Q, geometry, 0)
    clear_forces(S, 0)
    for side in range(2):
        for zone in range(2):
            press_patch(S, Q, geometry, side, zone, 0)
    gather_rails(S, Q, 0)
    add_wheels(S, Q, 0)
    load_track(S, Q, 0)


def find_free_accelerations(S: Array, Q: Array) -> None:
    """The suspension's stage of `step` alone, for one scenario at rest or held."""
    accelerate_free(S, Q, 1)


def find_vehicle_energy(S: Array, Q: Array) -> float:
    """Energy of the vehicle, for one scenario, J."""
    return vehicle_energy(S, Q, 0)
