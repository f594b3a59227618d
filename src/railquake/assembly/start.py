"""The state at rest by its rows (`rows_state`), and the contact forces that belong to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.constants import static_wheel_load
from railquake.march.compiler import PYTHON, bind
from railquake.march.order import kernel_order
from railquake.march.rows_state import FILTERED, PATCHES
from railquake.march.slots import chosen
from railquake.march.step import find_contact_forces
from railquake.physics.derailment import EVENTS
from railquake.physics.profiles import Geometry, zone_contact

if TYPE_CHECKING:
    from railquake.assembly.rest import ContactForces, Rest
    from railquake.assembly.vehicle import VehicleMatrices
    from railquake.inputs.scenario import Scenario
    from railquake.march.rows import Layout

__all__ = [
    "blank_state",
    "carried_car",
    "contact_forces",
    "contact_stages",
    "settlement",
    "start_state",
]

Array = np.ndarray[Any, np.dtype[np.float64]]
Stages = Callable[[Array, Array, Geometry], None]


def contact_stages(choices: Mapping[str, str], layout: Layout) -> Stages:
    """The contact stages of the march as one plain function."""
    laws = chosen({**choices, "engine": "alone"})
    stages: Stages = bind(find_contact_forces, PYTHON, laws, layout).call
    return stages


def blank_state(vehicle: VehicleMatrices, layout: Layout) -> Array:
    """The state before anything is known, shape (state rows, 1)."""
    state = layout.state
    S = np.zeros((layout.size.STATE_ROWS, 1))
    S[state.ON_TRACK] = 1.0
    S[state.NEAR : state.NEAR + 2] = 1.0
    S[state.CELL_HELD : state.CELL_HELD + 2] = -1.0  # no cell has been fetched yet
    S[state.LOWEST_LOAD] = static_wheel_load(vehicle)
    S[state.PEAK_CLEARANCE] = -1.0
    S[state.FIRST_TIME : state.FIRST_TIME + len(EVENTS)] = -1.0
    S[state.UPLIFT_END] = -1.0
    return S


def _close_patches(S: Array, Q: Array, layout: Layout) -> None:
    """A standing contact: closed, with the hysteresis of the slowest onset."""
    first = layout.state.PATCH_HYSTERESIS
    slowest = Q[layout.constant.ALPHA_R, 0] / Q[layout.constant.ONSET_BOUND, 0]
    S[first : first + len(PATCHES), 0] = slowest


def contact_forces(
    S: Array, Q: Array, geometry: Geometry, stages: Stages, layout: Layout
) -> ContactForces:
    """Contact forces as a plain function of the wheelset's and the track's position.

    ``stages`` runs the contact stages of the march on a scratch state ``S``.
    """
    state, size = layout.state, layout.size
    place = [size.WHEELSET_Y, size.WHEELSET_Z, size.WHEELSET_PHI]
    position = state.VEHICLE_X + np.array(place)
    velocity = state.VEHICLE_V + np.array(place)

    @cache  # most derivatives of the equilibrium leave the contacts where they are
    def acting(place: tuple[float, ...]) -> tuple[Array, Array]:
        S[position, 0] = place[:3]
        S[velocity, 0] = place[3:6]
        S[state.TRACK : state.TRACK + 3, 0] = place[6:]
        S[state.TRACK_V : state.TRACK_V + 3, 0] = 0.0
        _close_patches(S, Q, layout)
        stages(S, Q, geometry)
        wheelset = S[state.WHEELSET_FORCE : state.WHEELSET_FORCE + 3, 0].copy()
        node = S[state.NODE : state.NODE + size.STRUCTURE, 0].copy()
        return wheelset, node

    return lambda position, velocity, track: acting((*position, *velocity, *track))


def settlement(geometry: Geometry, scenario: Scenario, load: float) -> float:
    """Vertical displacement of the wheelset at which the treads bear about the static load, m."""
    tread = zone_contact(0.0, 0.0, geometry.flange_points, len(geometry.wheel_y), geometry)
    indentation = (load / scenario.vehicle.axles / tread.stiffness) ** (2.0 / 3.0)
    return float(tread.gap + scenario.wheelrail.rolling_radius + indentation)


def carried_car(track: Array, scenario: Scenario) -> Array:
    """Displacements of the bodies when the undeformed car is carried with the track."""
    y, z, roll = track
    bodies = sorted(scenario.vehicle.bodies, key=lambda b: b.name == scenario.vehicle.wheelset)
    moved = np.zeros(3 * len(bodies))
    for i, body in enumerate(bodies):
        moved[3 * i : 3 * i + 3] = (y + body.height * roll, z, roll)
    return moved


def start_state(
    blank: Array,
    Q: Array,
    geometry: Geometry,
    at: Rest,
    track: Array,
    stages: Stages,
    layout: Layout,
    vehicle: VehicleMatrices,
) -> Array:
    """The state at rest, with what a step expects of the one before it.

    Parameters
    ----------
    blank : array, shape (state rows, 1)
        See `blank_state`.
    Q : array, shape (constant rows, 1)
    geometry : Geometry
    at : Rest
    track : array, shape (3,)
        Place of the track.
    stages : callable
        See `contact_stages`.
    layout : Layout
    vehicle : VehicleMatrices
    """
    state, size = layout.state, layout.size
    S = blank.copy()
    S[state.STRUCTURE_X : state.STRUCTURE_X + size.STRUCTURE, 0] = at.structure
    S[state.HINGE : state.HINGE + len(at.hinge.state), 0] = at.hinge.state
    S[state.MOMENT] = at.hinge.moment
    order = kernel_order(size.DOFS)
    S[state.VEHICLE_X : state.VEHICLE_X + size.DOFS, 0] = at.vehicle[order]
    S[state.VEHICLE_V : state.VEHICLE_V + size.DOFS, 0] = np.where(order % 3 == 0, at.drift, 0.0)
    S[state.TRACK : state.TRACK + 3, 0] = track
    _close_patches(S, Q, layout)
    stages(S, Q, geometry)
    for old, new in (
        (state.TRACK_FORCE_OLD, state.TRACK_FORCE),
        (state.WHEELSET_FORCE_OLD, state.WHEELSET_FORCE),
        (state.CONTACT_POWER_OLD, state.CONTACT_POWER),
    ):
        S[old : old + 3] = S[new : new + 3]
    # at rest the suspension bears what the contact pushes
    pushed = S[state.WHEELSET_FORCE : state.WHEELSET_FORCE + 3]
    free = -pushed / vehicle.mass[-3:, None]
    S[state.WHEELSET_FREE : state.WHEELSET_FREE + 3] = free
    S[state.WHEELSET_FREE_KNOWN : state.WHEELSET_FREE_KNOWN + 3] = free
    # low-pass filters start from the steady state
    means = (
        -S[state.FORCE_Y, 0],
        S[state.LOAD_LEFT, 0],
        S[state.LOAD_RIGHT, 0],
        S[state.LATERAL_LEFT, 0],
        S[state.LATERAL_RIGHT, 0],
    )
    for first in (state.FILTER_X1, state.FILTER_X2, state.FILTER_Y1, state.FILTER_Y2):
        S[first : first + len(FILTERED), 0] = means
    return S
