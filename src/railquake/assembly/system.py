"""A scenario assembled: what the march needs, and nothing that it does not."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from railquake.assembly import stability
from railquake.assembly.constants import (
    constants_of,
    fill_substeps,
    frame_steps,
    static_wheel_load,
)
from railquake.assembly.geometry import build_geometry, running_circle, with_table
from railquake.assembly.rest import Equilibrium, find_rest
from railquake.assembly.start import (
    blank_state,
    carried_car,
    contact_forces,
    contact_stages,
    settlement,
    start_state,
)
from railquake.assembly.supports import Structure, structure_of
from railquake.assembly.vehicle import VehicleMatrices, refuse_unstable, vehicle_matrices
from railquake.errors import InputError
from railquake.inputs.ground_motion.motion import cumulative_trapezoid, without_line
from railquake.inputs.identity import files_of
from railquake.march import frames
from railquake.march.compiler import CUDA, SCALAR, Kernel, Target, bind
from railquake.march.rows import Layout, layout_of
from railquake.march.slots import chosen, joining, solving
from railquake.memory import Bounded
from railquake.messages import on_one_line
from railquake.physics.hinge import HINGE_LAWS
from railquake.physics.profiles import Geometry

if TYPE_CHECKING:
    from collections.abc import Callable

    from railquake.inputs.ground_motion import GroundMotion
    from railquake.inputs.scenario import Scenario

__all__ = ["System", "assemble", "critical_time_step"]

Array = np.ndarray[Any, np.dtype[np.float64]]

MOST_STEPS = 1e10  # of a run; about an hour
SHORT_STEP = 1e-9  # s; below any critical one


@dataclass(frozen=True)
class System:
    """All that a run needs.

    Attributes
    ----------
    scenario : Scenario
    ground : GroundMotion
        Lateral motion, scaled.
    vehicle : VehicleMatrices
    structure : Structure
    layout : Layout
        Numbers of the rows of ``start`` and ``constants``.
    start : array, shape (state rows, 1)
        State at rest.
    constants : array, shape (constant rows, 1)
    geometry : Geometry
        Profiles and contact table.
    drive : array, shape (frames + 1, 3 or 9)
        Ground acceleration and velocity (and prescribed track) at the frames' ends.
    choices : dict
        What stands in the slots (`slots.SLOTS`): name of the choice by name of the slot.
    critical_dt : float
        Longest stable time step at static load, s.
    slow_dt : float
        Longest step, s, with which structure and sprung bodies may be marched by themselves, at
        most `stability.LONGEST_SLOW`; see `step.step`.
    static_wheel_load : float
        Vertical load of one side's wheels together, N.
    """

    scenario: Scenario
    ground: GroundMotion
    vehicle: VehicleMatrices
    structure: Structure
    layout: Layout
    start: Array
    constants: Array
    geometry: Geometry
    drive: Array
    choices: dict[str, str]
    critical_dt: float
    slow_dt: float
    static_wheel_load: float

    @property
    def dt(self) -> float:
        """Time step, s."""
        return float(self.constants[self.layout.constant.DT, 0])

    @property
    def frame_steps(self) -> int:
        """Time steps in a frame."""
        return int(self.constants[self.layout.constant.FRAME_STEPS, 0])

    @property
    def substeps(self) -> int:
        """Time steps in one of the structure and of the sprung bodies."""
        return int(self.constants[self.layout.constant.SUBSTEPS, 0])

    @property
    def frames(self) -> int:
        """Frames in the run."""
        return len(self.drive) - 1

    def with_substeps(self, most: int) -> System:
        """The same with as many `substeps` as can be, up to ``most``; see `step.step`.

        They divide a frame and take no longer than `slow_dt`.
        """
        longest = (1.0 + 1e-9) * self.slow_dt / self.dt
        tried = range(min(most, max(1, int(longest))), 0, -1)
        substeps = next(n for n in tried if self.frame_steps % n == 0)
        constants = self.constants.copy()
        fill_substeps(constants[:, 0], substeps, self.layout)
        constants.setflags(write=False)
        return replace(self, constants=constants)

    def kernel(self, target: Target = SCALAR) -> Kernel:
        """Bind `frames.march` with what was chosen, or one of its kin.

        For several lanes that is `frames.march_abreast`, for `CUDA` `frames.march_on_device`.
        """
        alone = target.lanes == 1 and target is not CUDA
        engine = "device" if target is CUDA else "alone" if alone else "abreast"
        entries: dict[str, Callable[..., Any]] = {
            "alone": frames.march,
            "abreast": frames.march_abreast,
            "device": frames.march_on_device,
        }
        how = self.scenario.solver.hinge_solve
        linearised = not alone if how is None else how == "linearised"
        laws = chosen({**self.choices, "engine": engine})
        laws.update(joining(self.vehicle.joints.joined))
        laws.update(solving(self.structure.hinge, linearised, abreast=not alone))
        return bind(
            entries[engine], target, laws, _layout(self.structure, self.vehicle, target.lanes)
        )


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
        carry the standing train, the time step is above the critical one, or its numbers are
        beyond what can be computed with.
    """
    with _computable():
        return _assemble(scenario)


@contextmanager
def _computable() -> Iterator[None]:
    """Say in one line that inputs, each of them possible, overflow or cancel with each other."""
    try:
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            yield
    except InputError:
        raise
    except (ArithmeticError, ValueError, np.linalg.LinAlgError) as error:
        raise InputError(
            "the scenario cannot be assembled: its numbers are beyond what can be computed with "
            f"({on_one_line(error)}); look for a value that is far too large or too small"
        ) from error


def _assemble(scenario: Scenario) -> System:
    solver = scenario.solver
    ground = scenario.ground_motion()
    steps = ground.duration / solver.step
    if steps > MOST_STEPS:
        raise InputError(
            f"solver.dt: {solver.step:g} s takes {steps:.3g} steps over {ground.duration:g} s; at "
            f"most {MOST_STEPS:.0e} are possible: take a longer step"
        )
    rest = _at_rest(scenario)
    drive = _drive(scenario, ground, solver.step * frame_steps(solver), rest.structure)
    drive.setflags(write=False)
    system = System(scenario=scenario, ground=ground, drive=drive, **rest._asdict())
    return system if solver.substeps is None else system.with_substeps(solver.substeps)


def critical_time_step(scenario: Scenario) -> float:
    """Longest stable time step of the scenario at static load, s; ``solver.dt`` does not matter.

    Raises
    ------
    InputError
        If the scenario cannot be assembled.
    """
    with _computable():
        return _at_rest(scenario.with_step(SHORT_STEP)).critical_dt


class _AtRest(NamedTuple):
    """What does not depend on the ground's motion; see `System`."""

    vehicle: VehicleMatrices
    structure: Structure
    layout: Layout
    start: Array
    constants: Array
    geometry: Geometry
    choices: dict[str, str]
    critical_dt: float
    slow_dt: float
    static_wheel_load: float


_REMEMBERED: Bounded[Any, _AtRest] = Bounded(64)


def _at_rest(scenario: Scenario) -> _AtRest:
    """`_assemble_at_rest`, once for all ground motions of a study."""
    key = (
        scenario.vehicle,
        scenario.support,
        scenario.wheelrail,
        scenario.solver,
        _stamps(scenario),
    )
    return _REMEMBERED.get(key, lambda: _assemble_at_rest(scenario))


def _stamps(scenario: Scenario) -> tuple[tuple[str, int, int], ...]:
    """Time and size of the files that it reads; reading them says what is wrong with others."""
    stamps = []
    for section in (scenario.wheelrail, scenario.support):
        for path in files_of(section):
            with suppress(OSError):
                found = os.stat(path)
                stamps.append((path, found.st_mtime_ns, found.st_size))
    return tuple(stamps)


def _layout(structure: Structure, vehicle: VehicleMatrices, lanes: int = 1) -> Layout:
    law = HINGE_LAWS[structure.hinge]
    return layout_of(
        law,
        len(vehicle.bodies),
        vehicle.block,
        structure.degrees,
        lanes,
        vehicle.joints.joined,
    )


def _assemble_at_rest(scenario: Scenario) -> _AtRest:
    """Everything but the ground's motion."""
    solver = scenario.solver
    vehicle = vehicle_matrices(scenario.vehicle)
    refuse_unstable(vehicle)
    structure = structure_of(scenario.support, solver, scenario.vehicle.mass)
    layout = _layout(structure, vehicle)
    choices = {
        "creep law": scenario.wheelrail.creep_law,
        "flange creep law": scenario.wheelrail.flange_creep_law,
        "restitution law": scenario.wheelrail.restitution_law,
        "hinge law": structure.hinge,
        "structure": structure.choice,
        "kinematics": vehicle.kinematics,
        "contact method": solver.contact,
    }
    geometry = build_geometry(scenario.wheelrail)
    if solver.contact == "table":
        geometry = with_table(geometry, running_circle(scenario.wheelrail))
    constants = constants_of(scenario, vehicle, structure, layout)
    load = static_wheel_load(vehicle)

    # --- the state at rest ---------------------------------------------------------------------
    stages = contact_stages(choices, layout)
    blank = blank_state(vehicle, constants, layout)
    forces = contact_forces(blank.copy(), constants, geometry, stages, layout)
    at = find_rest(
        Equilibrium(
            vehicle,
            structure,
            forces,
            settlement(geometry, scenario, load),
            lambda track: carried_car(track, scenario),
        )
    )
    track = structure.track_map @ at.structure
    if structure.prescribed is not None:
        track = np.array(structure.prescribed(np.zeros(1))[0::2])[:, 0]
        at = replace(at, vehicle=at.vehicle + carried_car(track, scenario))
    start = start_state(blank, constants, geometry, at, track, stages, layout, vehicle)

    contact = stability.linear_contact(at.vehicle[-3:], at.drift, forces, track)
    critical = min(
        stability.critical_time_step(
            vehicle.mass, *stability.with_contact(contact, *matrices), solver.phi, solver.psi
        )
        for matrices in vehicle.states
    )
    if solver.step > critical:
        raise InputError(
            f"solver.dt: {solver.step:g} s is above the critical time step of {critical:.3g} s "
            "(contact stiffness and creep damping at static load); take a smaller one, "
            f"such as {_rounded_down(0.5 * critical):g} s"
        )
    for array in (start, constants, *geometry):
        if isinstance(array, np.ndarray):
            array.setflags(write=False)
    # the contact forces are carried on over a step of the structure: they must be resolved by it
    slow = min(critical, stability.slow_time_step(contact, vehicle.fastest_rate, structure))
    return _AtRest(
        vehicle, structure, layout, start, constants, geometry, choices, critical, slow, load
    )


def _rounded_down(value: float) -> float:
    """One significant digit, towards zero."""
    unit = 10.0 ** math.floor(math.log10(value))
    return math.floor(value / unit) * unit


def _drive(scenario: Scenario, ground: GroundMotion, frame: float, structure: Structure) -> Array:
    """The ground at the frames' ends, by linear interpolation of the records.

    Its lateral velocity is corrected as in `GroundMotion.pgv`.
    """
    frames = max(1, math.ceil(ground.duration / frame - 1e-9))
    times: Array = frame * np.arange(frames + 1, dtype=np.float64)
    columns: list[Array] = [np.interp(times, ground.time, ground.acceleration)]
    vertical = scenario.vertical_motion()
    if vertical is None:
        columns.append(np.zeros(frames + 1))
    else:
        # recorded positive up, z is positive down
        columns.append(-np.interp(times, vertical.time, vertical.acceleration, right=0.0))
    columns.append(without_line(cumulative_trapezoid(columns[0], frame)))
    if structure.prescribed is not None:
        columns += structure.prescribed(times)
    return np.ascontiguousarray(np.column_stack(columns))
