"""A scenario assembled: what the kernel needs, and nothing that it does not."""

from __future__ import annotations

import math
import os
from collections import OrderedDict
from dataclasses import dataclass, replace
from threading import Lock
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from railquake.assembly import statics
from railquake.assembly.geometry import (
    ROLL_AXIS,
    SHIFT_AXIS,
    build_geometry,
    with_table,
)
from railquake.assembly.vehicle import VehicleMatrices, vehicle_matrices
from railquake.errors import InputError
from railquake.inputs.profile import flange_tip
from railquake.inputs.support import AtGrade, Pier, PrescribedTrack
from railquake.physics import (
    boucwen,
    constant,
    creep,
    elementary,
    march,
    newmark,
    pier,
    state,
)
from railquake.physics.contact import calibrated_hysteresis, printed_hysteresis
from railquake.physics.kernel import CUDA, PYTHON, SCALAR, Kernel, Target, bind
from railquake.physics.profiles import Geometry, axis_constants
from railquake.physics.vehicle import kernel_order, unpacked, upper_triangle

if TYPE_CHECKING:
    from collections.abc import Callable

    from railquake.inputs.ground_motion import GroundMotion
    from railquake.inputs.hinge import BoucWenHinge
    from railquake.inputs.scenario import Scenario
    from railquake.inputs.solver import Solver

__all__ = ["CREEP_LAWS", "GRAVITY", "System", "assemble", "critical_time_step", "hinge_parameters"]

Array = np.ndarray[Any, np.dtype[np.float64]]
Laws = dict["Callable[..., Any]", "Callable[..., Any]"]

GRAVITY = 9.80665  # m/s2
UNKNOWN_DEGRADATION = statics.UNKNOWN_DEGRADATION
MOST_STEPS = 1e10  # of a run; about an hour
LONGEST_SLOW = 1e-4  # s; no step of structure and sprung bodies is longer, but for ``dt`` itself
SLOW = 0.05  # rad; phase by which what is slow may turn in one of its steps
SHORT_STEP = 1e-9  # s; below any critical one
SHIFT_LIMIT = 0.127  # lateral shift that counts as derailed, m (5 in)
ROLL_LIMIT = math.pi / 4.0  # relative roll that counts as overturned

CREEP_LAWS = {
    "she": creep.reduction_shen_hedrick_elkins,
    "coulomb": creep.reduction_coulomb,
    "carter": creep.reduction_carter,
    "polach": creep.reduction_polach,
}


@dataclass(frozen=True)
class System:
    """All that a run needs.

    Attributes
    ----------
    scenario : Scenario
    ground : GroundMotion
        Lateral motion, scaled.
    vehicle : VehicleMatrices
    start : array, shape (state rows, 1)
        State at rest, `physics.state`.
    constants : array, shape (constant rows, 1)
        `physics.constant`.
    geometry : Geometry
        Profiles and contact table.
    drive : array, shape (frames + 1, 2 or 8)
        Ground acceleration (and prescribed track) at the frames' ends.
    laws : dict
        Laws and stages chosen for this scenario, to be bound.
    critical_dt : float
        Longest stable time step at static load, s.
    slow_dt : float
        Longest step, s, with which structure and sprung bodies may be marched by themselves, at
        most `LONGEST_SLOW`; see `march.step`.
    static_wheel_load : float
        Vertical load of one side's wheels together, N.
    """

    scenario: Scenario
    ground: GroundMotion
    vehicle: VehicleMatrices
    start: Array
    constants: Array
    geometry: Geometry
    drive: Array
    laws: Laws
    critical_dt: float
    slow_dt: float
    static_wheel_load: float

    @property
    def dt(self) -> float:
        """Time step, s."""
        return float(self.constants[constant.DT, 0])

    @property
    def frame_steps(self) -> int:
        """Time steps in a frame."""
        return int(self.constants[constant.FRAME_STEPS, 0])

    @property
    def substeps(self) -> int:
        """Time steps in one of the structure and of the sprung bodies."""
        return int(self.constants[constant.SUBSTEPS, 0])

    @property
    def frames(self) -> int:
        """Frames in the run."""
        return len(self.drive) - 1

    def with_substeps(self, most: int) -> System:
        """The same with as many `substeps` as can be, up to ``most``; see `march.step`.

        They divide a frame and take no longer than `slow_dt`.
        """
        longest = (1.0 + 1e-9) * self.slow_dt / self.dt
        tried = range(min(most, max(1, int(longest))), 0, -1)
        constants = self.constants.copy()
        _fill_substeps(constants[:, 0], next(n for n in tried if self.frame_steps % n == 0))
        constants.setflags(write=False)
        return replace(self, constants=constants)

    def kernel(self, target: Target = SCALAR) -> Kernel:
        """Bind `march.march` with the chosen laws, or one of its kin.

        For several lanes that is `march.march_abreast`, for `CUDA` `march.march_on_device`.
        """
        laws = dict(self.laws)
        sizes = {**_sizes(self.vehicle), "LANES": target.lanes}
        if target.lanes == 1:
            # what a patch does not need is not computed; many abreast must do it all the same
            laws[march.press] = march.press_closed
        if target.lanes == 1 and target is not CUDA:
            laws[march.comes_near] = march.may_be_near
            return bind(march.march, target, laws, sizes)
        laws[elementary.exponential] = elementary.exponential_polynomial
        laws[elementary.power] = elementary.power_polynomial
        laws[boucwen.degradation_now] = boucwen.degradation_extrapolated
        laws[boucwen.pinched_stiffness_now] = boucwen.pinched_stiffness_kept
        laws.setdefault(boucwen.advance, boucwen.advance_linearised)
        if target is CUDA:
            rows = {"STATE_ROWS": len(self.start), "CONSTANT_ROWS": len(self.constants)}
            return bind(march.march_on_device, target, laws, {**sizes, **rows})
        return bind(march.march_abreast, target, laws, sizes)


def assemble(scenario: Scenario) -> System:
    """Assemble a scenario.

    Parameters
    ----------
    scenario : Scenario

    Returns
    -------
    System

    Raises
    ------
    InputError
        If a file of the scenario cannot be used, wheel and rail do not meet, the hinge cannot
        carry the standing train or the time step is above the critical one.
    """
    solver = scenario.solver
    ground = scenario.ground_motion()
    steps = ground.duration / solver.step
    if steps > MOST_STEPS:
        raise InputError(
            f"solver.dt: {solver.step:g} s takes {steps:.3g} steps over {ground.duration:g} s; at "
            f"most {MOST_STEPS:.0e} are possible: take a longer step"
        )
    drive = _drive(scenario, ground, solver.step * _frame_steps(solver))
    drive.setflags(write=False)
    if isinstance(scenario.support, PrescribedTrack):
        rest = _assemble_at_rest(scenario, drive[0, [2, 4, 6]])
    else:
        rest = _remembered(scenario)
    system = System(
        scenario,
        ground,
        rest.vehicle,
        rest.start,
        rest.constants,
        rest.geometry,
        drive,
        rest.laws,
        rest.critical_dt,
        rest.slow_dt,
        rest.static_wheel_load,
    )
    return system if solver.substeps is None else system.with_substeps(solver.substeps)


def critical_time_step(scenario: Scenario) -> float:
    """Longest stable time step of the scenario at static load, s; ``solver.dt`` does not matter.

    Raises
    ------
    InputError
        If the scenario cannot be assembled.
    """
    if isinstance(scenario.support, PrescribedTrack):
        track = scenario.support.track_motion()
        first = np.array([track.y[0], track.z[0], track.roll[0]])
        return _assemble_at_rest(scenario.with_step(SHORT_STEP), first).critical_dt
    return _remembered(scenario.with_step(SHORT_STEP)).critical_dt


class _AtRest(NamedTuple):
    """What does not depend on the ground's motion; see `System`."""

    vehicle: VehicleMatrices
    start: Array
    constants: Array
    geometry: Geometry
    laws: Laws
    critical_dt: float
    slow_dt: float
    static_wheel_load: float


_REMEMBERED: OrderedDict[tuple[Any, ...], _AtRest] = OrderedDict()
_REMEMBERED_MOST = 64
_REMEMBERED_LOCK = Lock()


def _remembered(scenario: Scenario) -> _AtRest:
    """`_assemble_at_rest`, once for all ground motions of a study."""
    files = (scenario.wheelrail.wheel.file, scenario.wheelrail.rail.file)
    stamps = tuple(
        (path, found.st_mtime_ns, found.st_size)
        for path in files
        if path is not None and (found := _stat(path)) is not None
    )
    key = (scenario.vehicle, scenario.support, scenario.wheelrail, scenario.solver, stamps)
    with _REMEMBERED_LOCK:
        known = _REMEMBERED.get(key)
        if known is not None:
            _REMEMBERED.move_to_end(key)
            return known
    rest = _assemble_at_rest(scenario, None)
    with _REMEMBERED_LOCK:
        _REMEMBERED[key] = rest
        while len(_REMEMBERED) > _REMEMBERED_MOST:
            _REMEMBERED.popitem(last=False)
    return rest


def _stat(path: str) -> os.stat_result | None:
    try:
        return os.stat(path)
    except OSError:
        return None  # reading it says what is wrong


def _frame_steps(solver: Solver) -> int:
    """Time steps in a frame."""
    return max(1, round(solver.history_step / solver.step))


def _assemble_at_rest(scenario: Scenario, prescribed: Array | None) -> _AtRest:
    """Everything but the ground's motion; ``prescribed`` is a prescribed track's first place."""
    solver = scenario.solver
    support = scenario.support
    frame_steps = _frame_steps(solver)
    matrices = vehicle_matrices(scenario.vehicle)
    dofs = len(matrices.mass)
    geometry = build_geometry(scenario.wheelrail)
    laws: Laws = {creep.reduction_shen_hedrick_elkins: CREEP_LAWS[scenario.wheelrail.creep_law]}
    if solver.contact == "table":
        geometry = with_table(geometry)
    else:
        laws[march.patch_at] = march.search_grid
        laws[march.locate] = march.skip_locate
        laws[march.fetch] = march.skip_fetch

    S = np.zeros((state.VEHICLE + state.VEHICLE_BLOCKS * dofs, 1))
    Q = np.zeros((constant.VEHICLE + dofs // 3 + dofs + dofs * (dofs + 1), 1))
    q = Q[:, 0]
    q[constant.DT] = solver.step
    q[constant.FRAME_STEPS] = frame_steps
    _fill_vehicle(q, scenario, matrices)
    _fill_contact(q, scenario)
    q[constant.FILTER_B0 : constant.FILTER_B0 + 5] = low_pass_coefficients(
        solver.lateral_force_filter, solver.step * frame_steps
    )
    load = 0.5 * float(matrices.mass[1::3].sum()) * GRAVITY
    q[constant.STATIC_WHEEL_LOAD] = load

    stiffness, hinge_law, parameters = _fill_support(q, support, solver, scenario.vehicle.mass)
    _fill_substeps(q, 1)
    if isinstance(support, PrescribedTrack):
        laws[pier.move_structure] = pier.hold_structure
        laws[pier.place_track] = pier.place_prescribed_track
        laws[pier.lead_track] = pier.lead_prescribed_track
        laws[march.begin_frame] = march.begin_frame_on_track
    elif hinge_law is not boucwen.advance:
        laws[boucwen.advance] = hinge_law
    if (
        isinstance(support, Pier)
        and support.hinge == "bouc-wen"
        and solver.hinge_solve == "linearised"
    ):
        laws[boucwen.advance] = boucwen.advance_linearised

    # --- the state at rest ---------------------------------------------------------------------
    track_map = np.zeros((3, 3))
    track_map[:, 2] = (-q[constant.MAP_H], -q[constant.MAP_E], -q[constant.MAP_PHI])
    track_map[0, 0] = q[constant.MAP_U]
    S[state.ON_TRACK] = 1.0
    S[state.NEAR : state.NEAR + 2] = 1.0
    for side in range(2):  # no cell has been fetched yet
        S[state.CELL + side * state.CELL_ROWS + state.CELL_HELD] = -1.0
    S[state.LOWEST_LOAD] = load
    S[state.PEAK_CLEARANCE] = -1.0
    S[state.FIRST_TIME : state.FIRST_TIME + state.EVENTS] = -1.0
    S[state.UPLIFT_END] = -1.0
    forces = statics.contact_forces(S.copy(), Q, geometry, _contact_stages(laws, matrices))
    pier_rest, vehicle_rest, drift, hinge_rest = statics.rest(
        matrices.mass,
        matrices.stiffness,
        GRAVITY,
        stiffness,
        lambda moment: statics.monotonic_hinge(hinge_law, parameters, moment),
        parameters[0],
        track_map,
        q[constant.REACTION],
        forces,
        _settlement(geometry, scenario, load),
        lambda track: _carried(track, dofs, scenario),
    )
    track = track_map @ pier_rest if prescribed is None else prescribed
    if prescribed is not None:
        vehicle_rest = vehicle_rest + _carried(prescribed, len(matrices.mass), scenario)
    S[state.U : state.U + 3, 0] = pier_rest
    S[state.Z], S[state.EPS], S[state.X_MAX] = hinge_rest[1:]
    S[state.MOMENT] = _moment(hinge_law, parameters, hinge_rest)
    S[state.DAMAGE] = -1.0  # nothing is known of the degradation yet
    order = kernel_order(dofs)
    S[state.VEHICLE : state.VEHICLE + dofs, 0] = vehicle_rest[order]
    S[state.VEHICLE + dofs : state.VEHICLE + 2 * dofs, 0] = np.where(order % 3 == 0, drift, 0.0)
    S[state.TRACK_Y : state.TRACK_Y + 3, 0] = track
    _settle_forces(S, Q, geometry, laws, matrices)

    contact = _linear_contact(vehicle_rest[-3:], drift, forces, track)
    critical = _critical_time_step(contact, matrices, solver.phi, solver.psi)
    if solver.step > critical:
        raise InputError(
            f"solver.dt: {solver.step:g} s is above the critical time step of {critical:.3g} s "
            "(contact stiffness and creep damping at static load); take a smaller one, "
            f"such as {_rounded_down(0.5 * critical):g} s"
        )
    for array in (S, Q, *geometry):
        if isinstance(array, np.ndarray):
            array.setflags(write=False)
    # the contact forces are carried on over a step of the structure: they must be resolved by it
    slow = min(critical, _slow_time_step(contact, matrices, q, track_map))
    return _AtRest(matrices, S, Q, geometry, laws, critical, slow, load)


def _sizes(matrices: VehicleMatrices) -> dict[str, int]:
    """Constants of the kernel that follow from the vehicle."""
    return {
        "DOF_COUNT": len(matrices.mass),
        "BLOCK": matrices.block,
        "PACKED": len(matrices.mass) * (len(matrices.mass) + 1) // 2,
    }


def _rounded_down(value: float) -> float:
    """One significant digit, towards zero."""
    unit = 10.0 ** math.floor(math.log10(value))
    return math.floor(value / unit) * unit


def _drive(scenario: Scenario, ground: GroundMotion, frame: float) -> Array:
    """Ground acceleration at the frames' ends, by linear interpolation of the records."""
    frames = max(1, math.ceil(ground.duration / frame - 1e-9))
    times = frame * np.arange(frames + 1)
    columns = [np.interp(times, ground.time, ground.acceleration)]
    vertical = scenario.vertical_motion()
    if vertical is None:
        columns.append(np.zeros(frames + 1))
    else:
        # recorded positive up, z is positive down
        columns.append(-np.interp(times, vertical.time, vertical.acceleration, right=0.0))
    if isinstance(scenario.support, PrescribedTrack):
        track = scenario.support.track_motion()
        known = track.dt * np.arange(len(track.y))
        for values in (track.y, track.z, track.roll):
            curve = CubicSpline(known, values)
            at = np.minimum(times, known[-1])
            columns += [curve(at), np.where(times > known[-1], 0.0, curve(at, 1))]
    return np.ascontiguousarray(np.column_stack(columns))


def _fill_vehicle(q: Array, scenario: Scenario, matrices: VehicleMatrices) -> None:
    order = kernel_order(len(matrices.mass))
    upper = upper_triangle(len(order))
    rows = (
        matrices.mass[0::3],
        1.0 / matrices.mass[order],
        matrices.stiffness[np.ix_(order, order)][upper],
        matrices.damping[np.ix_(order, order)][upper],
    )
    q[constant.VEHICLE :] = np.concatenate(rows)
    q[constant.ZHAI_PSI] = scenario.solver.psi
    q[constant.ZHAI_PHI] = scenario.solver.phi
    q[constant.GRAVITY] = GRAVITY
    q[constant.AXLES] = scenario.vehicle.axles
    q[constant.VEHICLE_MASS] = scenario.vehicle.mass


def _fill_contact(q: Array, scenario: Scenario) -> None:
    wheelrail = scenario.wheelrail
    q[constant.WHEELSET_HEIGHT] = wheelrail.rolling_radius
    q[constant.FRICTION] = wheelrail.friction
    q[constant.INVERSE_SPEED] = 1.0 / max(scenario.vehicle.speed, wheelrail.speed_bound)
    if wheelrail.restitution_law == "calibrated":
        if wheelrail.restitution <= 0.0:
            raise InputError(
                "wheelrail.restitution: 0 cannot be calibrated (the hysteresis would be "
                'infinite); take a positive value or restitution_law = "hunt-crossley"'
            )
        q[constant.ALPHA_R] = calibrated_hysteresis(wheelrail.restitution)
    else:
        q[constant.ALPHA_R] = printed_hysteresis(wheelrail.restitution)
    q[constant.ONSET_BOUND] = wheelrail.onset_rate_bound
    q[constant.SHIFT_AXIS : constant.SHIFT_AXIS + 6] = axis_constants(SHIFT_AXIS)
    q[constant.ROLL_AXIS : constant.ROLL_AXIS + 6] = axis_constants(ROLL_AXIS)
    q[constant.REFERENCE_ROLL] = wheelrail.reference_roll
    wheel = wheelrail.wheel_profile()
    rail = wheelrail.rail_profile()
    tip_y, tip_z = flange_tip(wheel)
    q[constant.TIP_Y] = wheelrail.running_circle + tip_y
    q[constant.TIP_Z] = wheelrail.rolling_radius + tip_z
    crown = rail.y[int(np.argmin(rail.z))]
    q[constant.RAIL_CENTRE] = wheelrail.rail_half_distance(rail) + crown
    q[constant.SHIFT_LIMIT] = SHIFT_LIMIT
    q[constant.ROLL_LIMIT] = ROLL_LIMIT


def low_pass_coefficients(corner: float, frame: float) -> tuple[float, ...]:
    """Second-order Butterworth low-pass b0, b1, b2, a1, a2 (bilinear transform, prewarped).

    What ``scipy.signal.butter(2, corner, fs=1/frame)`` gives, without that package's long import.

    Parameters
    ----------
    corner : float
        Hz; held below the Nyquist frequency.
    frame : float
        Sampling interval, s.
    """
    warped = math.tan(0.5 * math.pi * min(2.0 * corner * frame, 0.99))
    scale = 1.0 / (1.0 + math.sqrt(2.0) * warped + warped**2)
    b0 = scale * warped**2
    return (
        b0,
        2.0 * b0,
        b0,
        2.0 * scale * (warped**2 - 1.0),
        scale * (1.0 - math.sqrt(2.0) * warped + warped**2),
    )


def _fill_support(
    q: Array, support: Pier | AtGrade | PrescribedTrack, solver: Solver, train_mass: float
) -> tuple[Array, Callable[..., tuple[float, ...]], tuple[float, ...]]:
    """Constants of the structure; its stiffness without hinge, the hinge's law and parameters.

    At grade a column stands idle: neither ground nor train acts on it, and it does not move the
    track.
    """
    if not isinstance(support, Pier):
        q[constant.M_U : constant.M_U + 3] = 1.0
        q[constant.K0] = 1.0
        q[constant.TOLERANCE] = 1.0
        q[constant.MAX_ITERATIONS] = 1.0
        return np.eye(3), boucwen.advance_elastic, (1.0,) + (0.0,) * 14 + (1.0, 1.0)
    hinge = support.bouc_wen
    mass = np.array([support.mass, support.base_rotational_inertia, support.rotational_inertia])
    column = pier.stiffness_matrix(
        support.youngs_modulus, support.second_moment_of_area, support.length, 0.0
    )
    initial = column.copy()
    initial[1, 1] += hinge.k0
    damping = pier.rayleigh_damping(mass, initial, support.damping_ratio)
    if support.p_delta:
        weight = (support.mass + (train_mass if support.coupled else 0.0)) * GRAVITY
        column = column + pier.geometric_stiffness(weight, support.length)
    upper = upper_triangle(3)
    q[constant.PIER_LOAD] = support.mass
    q[constant.M_U : constant.M_U + 3] = mass
    q[constant.K : constant.K + 6] = column[upper]
    q[constant.C : constant.C + 6] = damping[upper]
    q[constant.MAP_U] = 1.0
    q[constant.MAP_H] = support.track_height
    q[constant.MAP_E] = support.track_offset
    q[constant.MAP_PHI] = 1.0
    q[constant.REACTION] = 1.0 if support.coupled else 0.0
    parameters = hinge_parameters(hinge, solver.newton_tolerance, solver.newton_max_iterations)
    q[constant.K0 : constant.K0 + len(parameters)] = parameters
    law = boucwen.advance_elastic if support.hinge == "elastic" else boucwen.advance
    return column, law, parameters


def _fill_substeps(q: Array, substeps: int) -> None:
    """Time steps in one of structure and sprung bodies, and what of the structure depends on it."""
    step = substeps * float(q[constant.DT])
    effective = newmark.effective_matrix(
        np.diag(q[constant.M_U : constant.M_U + 3]),
        unpacked(q[constant.C : constant.C + 6]),
        unpacked(q[constant.K : constant.K + 6]),
        step,
    )
    q[constant.SUBSTEPS] = substeps
    q[constant.RATE] = 1.0 / step
    q[constant.FLEX : constant.FLEX + 6] = np.linalg.inv(effective)[upper_triangle(3)]


def hinge_parameters(hinge: BoucWenHinge, tolerance: float, iterations: int) -> tuple[float, ...]:
    """Parameters of `boucwen.advance` after the flexibility; ``tolerance`` is relative."""
    # z of a fully yielded hinge, without damage: what the tolerance is relative to
    yielded = (1.0 / (hinge.beta0 * (1.0 + abs(hinge.eta0)))) ** (1.0 / hinge.n)
    return (
        hinge.k0,
        hinge.alpha,
        hinge.n,
        hinge.eta0,
        hinge.beta0,
        hinge.rho_eps * hinge.m / (hinge.Fy * hinge.xu),
        hinge.rho_x / hinge.xu,
        hinge.phi,
        hinge.delta_k,
        hinge.delta_f,
        1.0 / hinge.sigma,
        hinge.u,
        1.0 / hinge.eps_p,
        hinge.rho_p,
        1.0 / hinge.m,
        tolerance * yielded,
        float(iterations),
    )


def _moment(
    law: Callable[..., tuple[float, ...]],
    parameters: tuple[float, ...],
    hinge: tuple[float, float, float, float],
) -> float:
    """Moment of a hinge held where it is."""
    x, z, eps, x_max = hinge
    return float(law(x, z, z, eps, x_max, *UNKNOWN_DEGRADATION, 0.0, 0.0, *parameters)[4])


def _contact_stages(
    laws: Laws, matrices: VehicleMatrices
) -> Callable[[Array, Array, Geometry], None]:
    """The kernel's contact stages as one plain function."""
    kernel = bind(march.find_contact_forces, PYTHON, laws, _sizes(matrices))
    stages: Callable[[Array, Array, Geometry], None] = kernel.call
    return stages


def _settlement(geometry: Geometry, scenario: Scenario, load: float) -> float:
    """Vertical displacement of the wheelset at which the treads bear about the static load, m."""
    from railquake.physics.profiles import zone_contact

    gap, _, _, _, stiffness, _, _ = zone_contact(
        0.0, 0.0, geometry.flange_points, len(geometry.wheel_y), geometry
    )
    indentation = (load / scenario.vehicle.axles / stiffness) ** (2.0 / 3.0)
    return float(gap + scenario.wheelrail.rolling_radius + indentation)


def _carried(track: Array, dofs: int, scenario: Scenario) -> Array:
    """Displacements of the bodies when the undeformed car is carried with the track."""
    y, z, roll = track
    bodies = sorted(scenario.vehicle.bodies, key=lambda b: b.name == scenario.vehicle.wheelset)
    moved = np.zeros(dofs)
    for i, body in enumerate(bodies):
        moved[3 * i : 3 * i + 3] = (y + body.height * roll, z, roll)
    return moved


def _settle_forces(
    S: Array, Q: Array, geometry: Geometry, laws: Laws, matrices: VehicleMatrices
) -> None:
    """Fill the rows that a step expects of the one before it."""
    hysteresis = Q[constant.ALPHA_R, 0] / Q[constant.ONSET_BOUND, 0]
    for patch in range(4):
        S[state.PATCH + patch * state.PATCH_ROWS + state.PATCH_HYSTERESIS, 0] = hysteresis
    _contact_stages(laws, matrices)(S, Q, geometry)
    for old, new in ((state.TRACK_OLD, state.TRACK_FY), (state.WHEELSET_OLD, state.WHEELSET_Y)):
        S[old : old + 3] = S[new : new + 3]
    # at rest the suspension bears what the contact pushes
    free = -S[state.WHEELSET_Y : state.WHEELSET_Y + 3] / matrices.mass[-3:, None]
    S[state.WHEELSET_FREE : state.WHEELSET_FREE + 3] = free
    S[state.WHEELSET_FREE_KNOWN : state.WHEELSET_FREE_KNOWN + 3] = free
    powers = slice(state.IMPACT_POWER, state.IMPACT_POWER + 3)
    S[state.IMPACT_POWER_OLD : state.IMPACT_POWER_OLD + 3] = S[powers]
    # low-pass filters start from the steady state
    means = (
        -S[state.FORCE_Y, 0],
        S[state.LOAD_LEFT, 0],
        S[state.LOAD_RIGHT, 0],
        S[state.LATERAL_LEFT, 0],
        S[state.LATERAL_RIGHT, 0],
    )
    for number, mean in enumerate(means):
        row = state.FILTER + number * state.FILTER_ROWS
        S[row : row + state.FILTER_ROWS] = mean


def _linear_contact(
    position: Array, drift: float, forces: statics.ContactForces, track: Array
) -> tuple[Array, Array]:
    """Stiffness and damping of the contact for the wheelset, by central differences at static load.

    Two arrays of shape (3, 3).
    """
    velocity = np.array([drift, 0.0, 0.0])
    stiffness, damping = np.empty((2, 3, 3))
    for k, unit in enumerate(np.eye(3)):
        for matrix, move, turn in ((stiffness, 1e-6, 0.0), (damping, 0.0, 1e-4)):
            ahead, _ = forces(position + move * unit, velocity + turn * unit, track)
            behind, _ = forces(position - move * unit, velocity - turn * unit, track)
            matrix[:, k] = -(ahead - behind) / (2.0 * (move + turn))
    return stiffness, damping


def _critical_time_step(
    contact: tuple[Array, Array], matrices: VehicleMatrices, phi: float, psi: float
) -> float:
    """Critical time step of the vehicle on a linear contact."""
    stiffness, damping = matrices.stiffness.copy(), matrices.damping.copy()
    stiffness[-3:, -3:] += contact[0]
    damping[-3:, -3:] += contact[1]
    return statics.critical_time_step(matrices.mass, stiffness, damping, phi, psi)


def _slow_time_step(
    contact: tuple[Array, Array], matrices: VehicleMatrices, q: Array, track_map: Array
) -> float:
    """Longest step of what is slow: the vehicle off its rails, the pier's top on the contact.

    The structure itself is marched implicitly.
    """
    rate = max(matrices.fastest_rate, SLOW / LONGEST_SLOW)
    if q[constant.REACTION] > 0.0:
        mass = q[[constant.M_U, constant.M_2]]
        top = track_map[:, [0, 2]]
        stiffness, damping = (top.T @ matrix @ top for matrix in contact)
        rate = max(rate, statics.fastest_rate(mass, stiffness, damping))
    return SLOW / rate
