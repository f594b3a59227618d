"""A car by itself, its wheelset held to the ground: what a march of it needs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.constants import fill_vehicle
from railquake.assembly.vehicle import VehicleMatrices, refuse_unstable, sag_of, vehicle_matrices
from railquake.inputs.solver import Solver
from railquake.march.compiler import PYTHON, Target, bind
from railquake.march.order import kernel_order
from railquake.march.rows import Layout, layout_of
from railquake.march.slots import chosen, joining
from railquake.march.step import find_vehicle_energy
from railquake.physics.hinge import HINGE_LAWS

if TYPE_CHECKING:
    from railquake.inputs.vehicle import Vehicle

__all__ = ["HeldCar", "held_car"]

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class HeldCar:
    """A car whose wheelset is held.

    Attributes
    ----------
    matrices : VehicleMatrices
    layout : Layout
        Numbers of the rows of ``start`` and ``constants``.
    start : array, shape (state rows, 1)
        State at rest.
    constants : array, shape (constant rows, 1)
    """

    matrices: VehicleMatrices
    layout: Layout
    start: Array
    constants: Array

    def bind(self, entry: Callable[..., Any], target: Target) -> Callable[..., Any]:
        """An entry function of the march for this car."""
        laws = chosen({"kinematics": self.matrices.kinematics})
        laws.update(joining(self.matrices.joints.joined))
        return bind(entry, target, laws, self.layout).call

    def energy_residual(self, end: Array) -> float:
        """What is left of the energy balance at the state ``end``, over all that came in, J/J."""
        state = self.layout.state
        energy = self.bind(find_vehicle_energy, PYTHON)
        stored = energy(end.copy(), self.constants) - energy(self.start.copy(), self.constants)
        came = float(end[state.WORK_GROUND, 0] + end[state.WORK_GRAVITY, 0])
        lost = float(end[state.LOST_DASHPOTS, 0])
        return (came - stored - lost) / max(abs(came), abs(lost), 1e-9)


def held_car(vehicle: Vehicle, step: float, frame_steps: int) -> HeldCar:
    """Assemble a car by itself.

    Parameters
    ----------
    vehicle : Vehicle
    step : float
        Time step, s.
    frame_steps : int
        Time steps between two rows of a history.

    Raises
    ------
    InputError
        If it falls over by its own weight.
    """
    matrices = vehicle_matrices(vehicle)
    refuse_unstable(matrices)
    layout = layout_of(
        HINGE_LAWS["elastic"],
        len(matrices.bodies),
        matrices.block,
        joined=matrices.joints.joined,
    )
    constant, state = layout.constant, layout.state
    solver = Solver()
    q = np.zeros(layout.size.CONSTANT_ROWS)
    q[constant.DT] = step
    q[constant.FRAME_STEPS] = frame_steps
    q[constant.SUBSTEPS] = 1.0
    q[constant.RATE] = 1.0 / step
    q[constant.ZHAI_PSI] = solver.psi
    q[constant.ZHAI_PHI] = solver.phi
    fill_vehicle(q, matrices, layout)
    start = np.zeros((layout.size.STATE_ROWS, 1))
    start[state.ON_TRACK] = 1.0
    if not matrices.is_finite:
        sag = sag_of(matrices.stiffness, matrices.weight)
        start[layout.state_blocks["VEHICLE_X"], 0] = sag[kernel_order(len(sag))]
    return HeldCar(matrices, layout, start, q[:, None])
