"""A car by itself, its wheelset held: how it leans, and how it answers a motion."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly import (
    VehicleMatrices,
    held_car,
    newton_root,
    refuse_unstable,
    vehicle_matrices,
)
from railquake.errors import InputError
from railquake.march.compiler import SCALAR
from railquake.march.held import march_held
from railquake.march.order import kernel_order
from railquake.physics.vehicle import GRAVITY

if TYPE_CHECKING:
    from railquake.inputs.vehicle import Vehicle

__all__ = ["Lean", "Shaken", "lean", "shake_held"]

Array = np.ndarray[Any, np.dtype[np.float64]]

FRAME = 1e-3  # s, between two rows of a history
STEP = 1e-5  # s


@dataclass(frozen=True)
class Lean:
    """A car under a steady lateral inertia force.

    Attributes
    ----------
    bodies : tuple of str
        The wheelset, which is held, left out.
    displacements : array, shape (bodies, 3)
        y, z, m, and roll, rad, of each from where it stands at rest.
    flexibility_coefficient : float
        Roll of the heaviest body over a/g.
    """

    bodies: tuple[str, ...]
    displacements: Array
    flexibility_coefficient: float


@dataclass(frozen=True)
class Shaken:
    """A car's answer to a motion of the ground.

    Attributes
    ----------
    times : array, shape (n,)
        s.
    bodies : tuple of str
    displacements : array, shape (n, bodies, 3)
        y, z, m, and roll, rad.
    energy_residual : float
        What is left of the energy balance over all that came in.
    """

    times: Array
    bodies: tuple[str, ...]
    displacements: Array
    energy_residual: float


def lean(vehicle: Vehicle, acceleration: float) -> Lean:
    """Equilibrium under a steady lateral inertia force m a to the right, the wheelset held.

    Parameters
    ----------
    vehicle : Vehicle
    acceleration : float
        a, m/s2.

    Raises
    ------
    InputError
        If the car is unstable, or falls over under that force.
    """
    matrices = vehicle_matrices(vehicle)
    refuse_unstable(matrices)
    free = len(matrices.mass) - 3
    load = matrices.weight.copy()
    load[0::3] = acceleration * matrices.mass[0::3]
    x = np.zeros(len(load))
    if not matrices.is_finite:  # Eq. 1 is linear: from where it stands under gravity
        x[:free] = np.linalg.solve(
            matrices.stiffness[:free, :free], (load - matrices.weight)[:free]
        )
    else:
        x[:free] = _balance(matrices, load, free)
    names = matrices.bodies[:-1]
    heaviest = int(np.argmax(matrices.mass[0:free:3]))
    moved = x[:free].reshape(-1, 3)
    roll = abs(float(moved[heaviest, 2]))
    coefficient = roll * GRAVITY / abs(acceleration) if acceleration else math.nan
    return Lean(names, moved, coefficient)


def _balance(matrices: VehicleMatrices, load: Array, free: int) -> Array:
    """Displacements of the free bodies under ``load``."""
    held = np.zeros(3)

    def residual(moved: Array) -> Array:
        """Out of balance, over the weight; ``moved`` in mm and mrad."""
        there = np.concatenate([1e-3 * moved, held])
        out: Array = (matrices.held_by(there) - load)[:free] / matrices.weight.sum()
        return out

    found = newton_root(residual, np.zeros(free))
    if found is None:
        raise InputError(
            "--lean: no equilibrium was found under that acceleration: the car falls over; take "
            "less"
        )
    return 1e-3 * found


def shake_held(vehicle: Vehicle, time: Array, lateral: Array, vertical: Array) -> Shaken:
    """March a car whose wheelset is held to the ground, with the stages of a coupled run.

    Parameters
    ----------
    vehicle : Vehicle
    time : array, shape (n,)
        s, rising.
    lateral, vertical : array, shape (n,)
        Ground acceleration, to the right and down, m/s2.
    """
    car = held_car(vehicle, STEP, round(FRAME / STEP))
    frames = max(1, math.ceil((time[-1] - time[0]) / FRAME - 1e-9))
    times: Array = FRAME * np.arange(frames + 1, dtype=np.float64)
    drive = np.column_stack(
        [np.interp(time[0] + times, time, values) for values in (lateral, vertical)]
    )
    # y, z and roll of each body from the order of the march
    rows = car.layout.state_blocks["VEHICLE_X"].start + np.argsort(
        kernel_order(car.layout.size.DOFS)
    )
    history = np.empty((frames + 1, len(rows)))
    end = car.start.copy()
    car.bind(march_held, SCALAR)(end, car.constants, drive, rows, history)
    moved = (history - history[0])[:, :-3].reshape(frames + 1, -1, 3)
    return Shaken(times, car.matrices.bodies[:-1], moved, car.energy_residual(end))
