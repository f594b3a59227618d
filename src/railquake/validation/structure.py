"""The pier by itself, as a run assembles and steps it, under a given ground motion."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.constants import fill_structure, fill_substeps
from railquake.assembly.supports import Structure, structure_of
from railquake.inputs.solver import Solver
from railquake.march.compiler import SCALAR, bind
from railquake.march.rows import layout_of
from railquake.march.slots import chosen, solving
from railquake.march.structure import move_structure_with_hinge
from railquake.physics.hinge import HINGE_LAWS

if TYPE_CHECKING:
    from railquake.inputs.support import Pier

__all__ = ["QUANTITIES", "march_pier", "pier_matrices", "structure"]

Array = np.ndarray[Any, np.dtype[np.float64]]

# OpenSees' names of the histories, and the rows where they stand
QUANTITIES = {"u": "U", "theta1": "THETA1", "theta2": "THETA2", "M_base": "MOMENT"}
SOLVER = Solver(newton_tolerance=1e-6, newton_max_iterations=50)


def structure(column: Pier) -> Structure:
    """What a run makes of the pier, without a train."""
    return structure_of(column, SOLVER, 0.0)


def pier_matrices(column: Pier) -> tuple[Array, Array, Array, Array]:
    """Diagonal of the mass, damping and stiffness without the hinge, stiffness before it yields."""
    made = structure(column)
    initial = made.stiffness + np.diag([0.0, made.parameters.k0, 0.0])
    return made.mass, made.damping, made.stiffness, initial


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
    made = structure(column)
    law = HINGE_LAWS[made.hinge]
    layout = layout_of(law)
    state, constant = layout.state, layout.constant
    q = np.zeros((layout.size.CONSTANT_ROWS, 1))
    q[constant.DT] = dt
    fill_structure(q[:, 0], made, layout)
    fill_substeps(q[:, 0], 1, layout)
    s = np.zeros((layout.size.STATE_ROWS, 1))
    s[layout.state_blocks["HINGE"], 0] = law.virgin
    s[state.TANGENT] = made.parameters.k0
    laws = {**chosen({"hinge law": made.hinge}), **solving(made.hinge, False, False)}
    step = bind(move_structure_with_hinge, SCALAR, laws, layout).call
    rows = [getattr(state, name) for name in QUANTITIES.values()]
    found = np.empty((len(ground), len(rows)))
    for k, acceleration in enumerate(ground):
        s[state.GROUND, 0] = acceleration
        step(s, q, 0)
        found[k] = s[rows, 0]
    if s[state.UNCONVERGED, 0] != 0.0:
        raise ArithmeticError("the pier's hinge does not converge")
    return found
