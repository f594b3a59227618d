"""A hinge by itself: the very law that a run has, driven along a path."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.march.compiler import PYTHON, Target, bind
from railquake.march.slots import chosen, solving
from railquake.physics.hinge import HINGE_LAWS, HingeLaw, follow

if TYPE_CHECKING:
    from railquake.inputs.model import InputModel

__all__ = ["DrivenHinge", "drive_hinge"]

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class DrivenHinge:
    """What a hinge did along a path of n points.

    Attributes
    ----------
    law : HingeLaw
    parameters : named tuple
        Of the law.
    moment : array, shape (n,)
        N m.
    states : array, shape (n, fields of the state)
    solved : int
        Points up to which each step was solved to the tolerance asked for.
    """

    law: HingeLaw
    parameters: Any
    moment: Array
    states: Array
    solved: int

    def state(self, field: str) -> Array:
        """One field of the law's state, shape (n,)."""
        return self.states[:, type(self.law.virgin)._fields.index(field)]

    @property
    def damage(self) -> Array:
        """Damage index, shape (n,)."""
        kind = type(self.law.virgin)
        found: Array = np.array(
            [self.law.damage(kind(*row), self.parameters) for row in self.states]
        )
        return found


def drive_hinge(
    law: str,
    values: InputModel,
    path: Array,
    *,
    tolerance: float,
    iterations: int,
    flexibility: float = 0.0,
    substeps: int = 1,
    target: Target = PYTHON,
) -> DrivenHinge:
    """Drive a virgin hinge, and an elastic column over it, along a path.

    Parameters
    ----------
    law : str
        Name of the hinge's law.
    values : InputModel
        Its parameters as a case has them.
    path : array, shape (n,)
        Rotation of hinge and column together, rad; the step from zero to the first one counts.
    tolerance : float
        Of each step's equation, relative (`Solver.newton_tolerance`).
    iterations : int
        At most.
    flexibility : float
        Of the column, rad/(N m).
    substeps : int
        Equal steps into which each one is divided.
    target : Target
        Where the law runs.
    """
    chosen_law = HINGE_LAWS[law]
    parameters = chosen_law.parameters(values, tolerance, iterations)
    moment = np.full(len(path), np.nan)
    states = np.full((len(path), len(chosen_law.virgin)), np.nan)
    laws = {**chosen({"hinge law": law}), **solving(law, linearised=False, abreast=False)}
    run = bind(follow, target, laws).call
    path = np.ascontiguousarray(path, dtype=np.float64)
    try:
        solved = run(
            path, float(flexibility), chosen_law.virgin, parameters, substeps, moment, states
        )
    except ArithmeticError:  # a number too large for a float
        solved = np.argmax(np.isnan(moment))
    return DrivenHinge(chosen_law, parameters, moment, states, int(solved))
