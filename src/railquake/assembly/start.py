"""The state at rest by its rows (`rows_state`), and the contact forces that belong to it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.constants import static_wheel_load
from railquake.assembly.vehicle import bodies_of
from railquake.march.compiler import PYTHON, bind
from railquake.march.order import kernel_order
from railquake.march.slots import chosen
from railquake.march.step import find_contact_forces
from railquake.physics.axle import axle_step
from railquake.physics.profiles import Geometry, zone_contact

if TYPE_CHECKING:
    from railquake.assembly.rest import Rest
    from railquake.assembly.stability import ContactForces
    from railquake.assembly.vehicle import VehicleMatrices
    from railquake.inputs.scenario import Scenario
    from railquake.march.rows import Layout

__all__ = [
    "blank_state",
    "carried_car",
    "contact_forces",
    "contact_stages",
    "settle_axle",
    "settlement",
    "start_state",
]

Array = np.ndarray[Any, np.dtype[np.float64]]
Stages = Callable[[Array, Array, Geometry], None]

MOST_TURNS = 50  # of Newton's method for the axle's rate


def contact_stages(choices: Mapping[str, str], layout: Layout) -> Stages:
    """The contact stages of the march as one plain function."""
    laws = chosen({**choices, "engine": "alone"})
    stages: Stages = bind(find_contact_forces, PYTHON, laws, layout).call
    return stages


def blank_state(vehicle: VehicleMatrices, Q: Array, layout: Layout) -> Array:
    """The state before anything is known, shape (state rows, 1); the axle rolls evenly."""
    state = layout.state
    S = np.zeros((layout.size.STATE_ROWS, 1))
    S[state.AXLE_RATE] = Q[layout.constant.SPEED] / Q[layout.constant.WHEELSET_HEIGHT]
    S[state.ON_TRACK] = 1.0
    S[layout.state_blocks["NEAR"]] = 1.0
    S[layout.state_blocks["CELL_HELD"]] = -1.0  # no cell has been fetched yet
    S[state.LOWEST_LOAD_LEFT] = S[state.LOWEST_LOAD_RIGHT] = static_wheel_load(vehicle)
    S[state.PEAK_CLEARANCE] = -1.0
    S[layout.state_blocks["FIRST_TIME"]] = -1.0
    S[state.DERAILED_TIME] = S[state.LEFT_TIME] = S[state.BEYOND_TIME] = -1.0
    S[state.UPLIFT_END] = -1.0
    return S


def _close_patches(S: Array, Q: Array, layout: Layout) -> None:
    """A standing contact: closed, with the hysteresis of the slowest onset."""
    slowest = Q[layout.constant.ALPHA_R, 0] / Q[layout.constant.ONSET_BOUND, 0]
    S[layout.state_blocks["PATCH_HYSTERESIS"], 0] = slowest


def settle_axle(S: Array, Q: Array, geometry: Geometry, stages: Stages, layout: Layout) -> None:
    """Run the contact stages with the axle's rate at which its moments balance.

    Newton's method from the rate that is there; it is in the state afterwards.
    """
    state = layout.state
    for _ in range(MOST_TURNS):
        stages(S, Q, geometry)
        change = axle_step(
            float(S[state.AXLE_MOMENT, 0]), float(S[state.AXLE_DAMPING, 0]), 0.0, 1.0
        )
        if abs(change) <= 1e-13 * abs(S[state.AXLE_RATE, 0]):
            break
        S[state.AXLE_RATE, 0] += change


def contact_forces(
    S: Array, Q: Array, geometry: Geometry, stages: Stages, layout: Layout
) -> ContactForces:
    """Contact forces as a plain function of the wheelset's and the track's position.

    ``stages`` runs the contact stages of the march on a scratch state ``S``.
    """
    state, size, blocks = layout.state, layout.size, layout.state_blocks
    place = [size.WHEELSET_Y, size.WHEELSET_Z, size.WHEELSET_PHI]
    position = state.VEHICLE_X + np.array(place)
    velocity = state.VEHICLE_V + np.array(place)
    even = S[state.AXLE_RATE].copy()

    @cache  # most derivatives of the equilibrium leave the contacts where they are
    def acting(place: tuple[float, ...]) -> tuple[Array, Array]:
        S[position, 0] = place[:3]
        S[velocity, 0] = place[3:6]
        S[blocks["TRACK"], 0] = place[6:]
        S[blocks["TRACK_V"], 0] = 0.0
        _close_patches(S, Q, layout)
        S[layout.state.AXLE_RATE] = even
        settle_axle(S, Q, geometry, stages, layout)
        return S[blocks["WHEELSET_FORCE"], 0].copy(), S[blocks["NODE"], 0].copy()

    return lambda position, velocity, track: acting((*position, *velocity, *track))


def settlement(geometry: Geometry, scenario: Scenario, load: float) -> float:
    """Vertical displacement of the wheelset at which the treads bear about the static load, m."""
    tread = zone_contact(0.0, 0.0, geometry.flange_points, len(geometry.wheel_y), geometry)
    indentation = (load / scenario.vehicle.axles / tread.stiffness) ** (2.0 / 3.0)
    return float(tread.gap + scenario.wheelrail.rolling_radius + indentation)


def carried_car(track: Array, scenario: Scenario) -> Array:
    """Displacements of the bodies when the undeformed car is carried with the track."""
    y, z, roll = track
    bodies = bodies_of(scenario.vehicle)
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
    state, blocks = layout.state, layout.state_blocks
    S = blank.copy()
    S[blocks["STRUCTURE_X"], 0] = at.structure
    S[blocks["HINGE"], 0] = at.hinge.state
    S[state.MOMENT] = at.hinge.moment
    S[state.TANGENT] = at.hinge.tangent
    order = kernel_order(layout.size.DOFS)
    S[blocks["VEHICLE_X"], 0] = at.vehicle[order]
    S[blocks["VEHICLE_V"], 0] = np.where(order % 3 == 0, at.drift, 0.0)
    S[blocks["TRACK"], 0] = track
    _close_patches(S, Q, layout)
    settle_axle(S, Q, geometry, stages, layout)
    for block in ("TRACK_FORCE", "WHEELSET_FORCE", "CONTACT_POWER"):
        S[blocks[f"{block}_OLD"]] = S[blocks[block]]
    # at rest the suspension bears what the contact pushes
    free = -S[blocks["WHEELSET_FORCE"]] / vehicle.mass[-3:, None]
    S[blocks["WHEELSET_FREE"]] = free
    S[blocks["WHEELSET_FREE_KNOWN"]] = free
    flanges = (S[state.PENETRATION_LEFT_FLANGE, 0], S[state.PENETRATION_RIGHT_FLANGE, 0])
    standing_on_flange = max(flanges) > 0.0
    # low-pass filters start from the steady state
    means = (
        -S[state.FORCE_Y, 0],
        S[state.LOAD_LEFT, 0],
        S[state.LOAD_RIGHT, 0],
        S[state.LATERAL_LEFT, 0],
        S[state.LATERAL_RIGHT, 0],
        0.0 if standing_on_flange else -S[state.FORCE_Y, 0],
    )
    for block in ("FILTER_X1", "FILTER_X2", "FILTER_Y1", "FILTER_Y2"):
        S[blocks[block], 0] = means
    return S
