"""The pier by itself, stepped with the kernel's own integrator under a given ground motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.statics import UNKNOWN_DEGRADATION
from railquake.assembly.system import hinge_parameters
from railquake.physics import boucwen, constant, newmark, pier, state
from railquake.physics.kernel import SCALAR, bind

if TYPE_CHECKING:
    from railquake.inputs.support import Pier

__all__ = ["QUANTITIES", "march_pier", "pier_matrices"]

Array = np.ndarray[Any, np.dtype[np.float64]]

# OpenSees' names of the histories, and where they stand in the state
QUANTITIES = {"u": state.U, "theta1": state.THETA1, "theta2": state.THETA2, "M_base": state.MOMENT}
UPPER = np.triu_indices(3)


def pier_matrices(column: Pier) -> tuple[Array, Array, Array, Array]:
    """Diagonal of the mass, damping, stiffness without the hinge, and with it before it yields."""
    mass = np.array([column.mass, column.base_rotational_inertia, column.rotational_inertia])
    bare = pier.stiffness_matrix(
        column.youngs_modulus, column.second_moment_of_area, column.length, 0.0
    )
    initial = bare + np.diag([0.0, column.bouc_wen.k0, 0.0])
    return mass, pier.rayleigh_damping(mass, initial, column.damping_ratio), bare, initial


def march_pier(column: Pier, ground: Array, dt: float) -> Array:
    """States after every step, from rest.

    Parameters
    ----------
    column : Pier
    ground : array, shape (steps,)
        Acceleration of the ground at the ends of the steps, m/s2.
    dt : float
        s.

    Returns
    -------
    array, shape (steps, 4)
        In the order of `QUANTITIES`.

    Raises
    ------
    ArithmeticError
        If Newton's method does not converge in a step.
    """
    mass, damping, bare, _ = pier_matrices(column)
    q = np.zeros((constant.VEHICLE, 1))
    q[constant.DT], q[constant.RATE] = dt, 1.0 / dt
    q[constant.PIER_LOAD] = column.mass
    q[constant.M_U : constant.M_U + 3, 0] = mass
    q[constant.K : constant.K + 6, 0] = bare[UPPER]
    q[constant.C : constant.C + 6, 0] = damping[UPPER]
    effective = newmark.effective_matrix(np.diag(mass), damping, bare, dt)
    q[constant.FLEX : constant.FLEX + 6, 0] = np.linalg.inv(effective)[UPPER]
    parameters = hinge_parameters(column.bouc_wen, 1e-6, 50)
    q[constant.K0 : constant.K0 + len(parameters), 0] = parameters
    s = np.zeros((state.VEHICLE, 1))
    s[state.DAMAGE : state.DAMAGE + 5, 0] = UNKNOWN_DEGRADATION
    laws = {boucwen.advance: boucwen.advance_elastic} if column.hinge == "elastic" else {}
    step = bind(pier.move_structure, SCALAR, laws).call
    rows = list(QUANTITIES.values())
    found = np.empty((len(ground), len(rows)))
    for k, acceleration in enumerate(ground):
        s[state.GROUND, 0] = acceleration
        step(s, q, 0)
        found[k] = s[rows, 0]
    if s[state.UNCONVERGED, 0] != 0.0:
        raise ArithmeticError("the pier's hinge does not converge")
    return found
