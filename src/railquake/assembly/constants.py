"""The constants of a run by their rows (`rows_constant`)."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.geometry import DISPLACEMENT_AXIS, ROLL_AXIS, running_circle
from railquake.assembly.joints import fill_joints
from railquake.assembly.momentum import fill_momentum
from railquake.errors import InputError
from railquake.inputs.profile import flange_tip
from railquake.march.order import kernel_order
from railquake.march.packed import unpacked, upper_triangle
from railquake.measures import housner
from railquake.physics import newmark
from railquake.physics.contact_table import axis_cells
from railquake.physics.impact import RESTITUTION_LAWS
from railquake.physics.low_pass import low_pass_coefficients
from railquake.physics.oscillator import oscillator_step
from railquake.physics.sliding_mean import window_of
from railquake.physics.vehicle import GRAVITY

if TYPE_CHECKING:
    from railquake.assembly.supports import Structure
    from railquake.assembly.vehicle import VehicleMatrices
    from railquake.inputs.scenario import Scenario
    from railquake.inputs.solver import Solver
    from railquake.inputs.wheelrail import WheelRail
    from railquake.march.rows import Layout

__all__ = ["constants_of", "fill_structure", "fill_substeps", "fill_vehicle", "frame_steps"]

Array = np.ndarray[Any, np.dtype[np.float64]]

CLIMB_LENGTH = 2.0  # m; of the mean of Y/Q, EN 14363
SUSTAINED_TIME = 0.3  # s; of the mean of the lateral force


def frame_steps(solver: Solver) -> int:
    """Time steps in a frame."""
    return max(1, round(solver.history_step / solver.step))


def constants_of(
    scenario: Scenario, vehicle: VehicleMatrices, structure: Structure, layout: Layout
) -> Array:
    """All constants of a scenario, shape (constant rows, 1)."""
    constant = layout.constant
    q = np.zeros(layout.size.CONSTANT_ROWS)
    solver = scenario.solver
    q[constant.DT] = solver.step
    q[constant.FRAME_STEPS] = frame_steps(solver)
    q[constant.ZHAI_PSI] = solver.psi
    q[constant.ZHAI_PHI] = solver.phi
    q[constant.AXLES] = scenario.vehicle.axles
    q[constant.SPEED] = scenario.vehicle.speed
    q[constant.AXLE_INERTIA] = scenario.vehicle.inertia_about_axle(
        scenario.wheelrail.rolling_radius
    )
    q[constant.VEHICLE_MASS] = scenario.vehicle.mass
    q[constant.STATIC_WHEEL_LOAD] = static_wheel_load(vehicle)
    frame = solver.step * frame_steps(solver)
    q[layout.constant_blocks["FILTER_BY"]] = low_pass_coefficients(
        solver.lateral_force_filter, frame
    )
    speed = scenario.vehicle.speed
    # a train so slow stands for the time of an earthquake
    travelled = CLIMB_LENGTH / speed if speed >= scenario.wheelrail.speed_bound else frame
    q[layout.constant_blocks["CLIMB_WINDOW"]] = window_of(travelled, frame)
    q[layout.constant_blocks["SUSTAINED_WINDOW"]] = window_of(SUSTAINED_TIME, frame)
    q[layout.constant_blocks["SWING_BY"]] = np.ravel(
        [oscillator_step(period, housner.DAMPING, frame) for period in housner.PERIODS]
    )
    fill_vehicle(q, vehicle, layout)
    _fill_wheelrail(q, scenario.wheelrail, scenario.vehicle.speed, layout)
    # a linear car leaves out gravity's moment, a wheelset by itself does not; the lower wheel's
    # contact is near the running circle of its rail
    has_gravity = vehicle.is_finite or len(vehicle.bodies) == 1
    q[constant.BODY_LIMIT] = math.inf if has_gravity else q[constant.RAIL_CENTRE]
    fill_momentum(q, scenario.vehicle, scenario.wheelrail.rolling_radius, layout)
    fill_structure(q, structure, layout)
    fill_substeps(q, 1, layout)
    return q[:, None]


def static_wheel_load(vehicle: VehicleMatrices) -> float:
    """Vertical load of one side's wheels together, N."""
    return 0.5 * float(vehicle.mass[1::3].sum()) * GRAVITY


def fill_vehicle(q: Array, vehicle: VehicleMatrices, layout: Layout) -> None:
    """Bodies and what joins them."""
    constant, blocks = layout.constant, layout.constant_blocks
    order = kernel_order(len(vehicle.mass))
    upper = upper_triangle(len(order))
    q[constant.GRAVITY] = GRAVITY
    masses = vehicle.mass[0::3]
    q[blocks["BODY_MASS"]] = masses
    # the wheelset stands last; it is measured where it is alone
    q[constant.MEASURED_BODY] = int(np.argmax(masses[:-1])) if len(masses) > 1 else 0
    for number, stage in enumerate(vehicle.stages):
        q[constant.STAGE_UPPER + number] = stage.upper
        q[constant.STAGE_LOWER + number] = stage.lower
        ties = constant.STAGE_TIES + len(stage.tie) * number
        q[ties : ties + len(stage.tie)] = stage.tie
        gap = constant.STAGE_GAPS + 2 * number
        q[gap : gap + 2] = stage.gap
    q[blocks["INVERSE_MASS"]] = 1.0 / vehicle.mass[order]
    q[blocks["STIFFNESS"]] = vehicle.stiffness[np.ix_(order, order)][upper]
    q[blocks["DAMPING"]] = vehicle.damping[np.ix_(order, order)][upper]
    if vehicle.is_finite:
        fill_joints(q, vehicle.joints, layout)


def _fill_wheelrail(q: Array, wheelrail: WheelRail, speed: float, layout: Layout) -> None:
    constant, blocks = layout.constant, layout.constant_blocks
    try:
        alpha_r = RESTITUTION_LAWS[wheelrail.restitution_law].coefficient(wheelrail.restitution)
    except (ValueError, ArithmeticError):  # a root that lies nearer to its pole than numbers do
        alpha_r = math.inf
    if not math.isfinite(alpha_r):
        raise InputError(
            f"wheelrail.restitution: {wheelrail.restitution:g} cannot be reached with "
            f'restitution_law = "{wheelrail.restitution_law}" (the hysteresis would be infinite, '
            'or too large to be found); take 0.04 or more, or restitution_law = "hunt-crossley"'
        )
    q[constant.WHEELSET_HEIGHT] = wheelrail.rolling_radius
    q[constant.ALPHA_R] = alpha_r
    q[constant.ONSET_BOUND] = wheelrail.onset_rate_bound
    q[constant.FRICTION] = wheelrail.friction
    q[constant.INVERSE_SPEED] = 1.0 / max(speed, wheelrail.speed_bound)
    q[blocks["RUNNING_CIRCLE"]] = running_circle(wheelrail)
    q[blocks["DISPLACEMENT_AXIS"]] = axis_cells(DISPLACEMENT_AXIS)
    q[blocks["ROLL_AXIS"]] = axis_cells(ROLL_AXIS)
    tip_y, tip_z = flange_tip(wheelrail.wheel_profile())
    rail = wheelrail.rail_profile()
    crown = rail.y[int(np.argmin(rail.z))]
    q[constant.TIP_Y] = wheelrail.running_circle + tip_y
    q[constant.TIP_Z] = wheelrail.rolling_radius + tip_z
    q[constant.REFERENCE_ROLL] = wheelrail.reference_roll
    q[constant.RAIL_CENTRE] = wheelrail.rail_half_distance(rail) + crown
    q[constant.SLIDE_LIMIT] = wheelrail.slide_off_limit


def fill_structure(q: Array, structure: Structure, layout: Layout) -> None:
    """What of the structure does not depend on the time step."""
    constant, blocks = layout.constant, layout.constant_blocks
    upper = upper_triangle(structure.degrees[0])
    q[blocks["GROUND_LOAD"]] = structure.ground_load
    q[blocks["MASS"]] = structure.mass
    q[blocks["K"]] = structure.stiffness[upper]
    q[blocks["C"]] = structure.damping[upper]
    q[blocks["OFFSET"]] = structure.offset
    q[blocks["HINGE_DAMPING"]] = structure.hinge_damping
    q[constant.REACTION] = structure.reaction
    q[blocks["HINGE"]] = structure.parameters


def fill_substeps(q: Array, substeps: int, layout: Layout) -> None:
    """Time steps in one of structure and sprung bodies, and what of the structure depends on it."""
    constant, blocks, size = layout.constant, layout.constant_blocks, layout.size
    step = substeps * float(q[constant.DT])
    effective = newmark.effective_matrix(
        np.diag(q[blocks["MASS"]]),
        unpacked(q[blocks["C"]]),
        unpacked(q[blocks["K"]]),
        step,
    )
    q[constant.SUBSTEPS] = substeps
    q[constant.RATE] = 1.0 / step
    q[blocks["FLEX"]] = np.linalg.inv(effective)[upper_triangle(size.STRUCTURE)]
