"""The plastic hinge at the column's base: laws of its moment under rotation (Eqs. 11 and 12).

A *hinge law* has a state and parameters of its own, both named tuples, and answers one question:
what happens during a step in which the structure around it, condensed on the hinge, turns it by
``dx = free_step - flexibility * M``.  With ``flexibility = 0`` the rotation is prescribed.  Each
law is a file of this folder; a new one is found by lying here.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from railquake.laws import HINGE_LAWS

__all__ = [
    "HINGE_LAWS",
    "Answer",
    "HingeLaw",
    "Kept",
    "advance",
    "follow",
    "refresh",
]

Array = np.ndarray[Any, np.dtype[np.float64]]
Law = Callable[..., Any]


class Kept(NamedTuple):
    """What a field of a law's state or parameters is: annotates the field."""

    unit: str
    meaning: str
    channel: str | None = None
    """Name in a history, where it is kept in one."""


class Answer(NamedTuple):
    """What a hinge does during a step."""

    step: float
    """Increment of its rotation, rad."""
    moment: float
    """At the end, N m."""
    tangent: float
    """Consistent dM/dx, N m/rad."""
    unconverged: float
    """0, or 1 where its equation was not solved to the tolerance asked for."""
    state: Any
    """At the end; a named tuple of the law's own."""


def as_it_is(x: float, state: Any, parameters: Any) -> Any:
    """The state unchanged: for laws that have nothing to keep for some steps."""
    return state


def standing(state: Any) -> Any:
    """The state of a hinge that stands still: for laws that do not remember their last step."""
    return state


def known_damage(state: Any, parameters: Any) -> float:
    """Damage, for laws that have none."""
    return 0.0


@dataclass(frozen=True, eq=False)
class HingeLaw:
    """One law of the hinge.

    Parameters
    ----------
    name : str
        As in a case file.
    source : str
    virgin : named tuple
        State before the first step; each field's annotation is `Kept`.
    parameter_fields : type
        The named tuple of its parameters; each field's annotation is `Kept`, and ``k0`` is the
        initial stiffness, N m/rad.
    parameters : callable
        ``(values, tolerance, iterations) -> parameter_fields``: from the input's values, and how
        an equation is to be solved (relative tolerance, most iterations).
    advance : callable
        ``(x, state, parameters, free_step, flexibility) -> Answer``: scalars and named tuples, no
        arrays, exceptions or early exits; x is the rotation at the step's begin, rad.
    linearised : callable, optional
        The same by one consistently linearised solve; `advance` itself where it does not iterate.
    refresh : callable, optional
        ``(x, state, parameters) -> state``: where many run abreast, now and then, what is kept
        between.
    abreast : mapping of function to function
        What is put in the place of functions that these call, where many run abreast.
    standing : callable, optional
        ``state -> state`` of a hinge that stands still.
    damage : callable, optional
        ``(state, parameters) -> damage index``.
    inputs : type, optional
        Model of the law's own table in a case, for a law from outside the package.
    """

    name: str
    source: str
    virgin: Any
    parameter_fields: type
    parameters: Callable[[Any, float, int], Any]
    advance: Law
    linearised: Law | None = None
    refresh: Law = as_it_is
    abreast: Mapping[Law, Law] = field(default_factory=dict)
    standing: Callable[[Any], Any] = standing
    damage: Callable[[Any, Any], float] = known_damage
    inputs: type | None = None


def advance(x: float, state: Any, parameters: Any, free_step: float, flexibility: float) -> Answer:
    """Slot of the hinge's law: one step, see `HingeLaw`."""
    raise NotImplementedError("a hinge law is chosen when a kernel is bound")


def refresh(x: float, state: Any, parameters: Any) -> Any:
    """Slot of the hinge's law: what is kept between, see `HingeLaw`."""
    raise NotImplementedError("a hinge law is chosen when a kernel is bound")


def follow(
    path: Array,
    flexibility: float,
    state: Any,
    parameters: Any,
    substeps: int,
    moment: Array,
    states: Array,
) -> int:
    """Drive a hinge, and an elastic column over it, along a path; to be bound to a law.

    Parameters
    ----------
    path : array, shape (n,)
        Rotation of hinge and column together, rad; the step from zero to the first one counts.
    flexibility : float
        Of the column, rad/(N m): the path is x + flexibility M.
    state, parameters : named tuple
        Of the law; ``state`` before the first step.
    substeps : int
        Equal steps into which each one is divided.
    moment : array, shape (n,)
        Filled: moment at each point, N m.
    states : array, shape (n, fields of the state)
        Filled: the state there.

    Returns
    -------
    int
        Points up to which each step was solved to the tolerance asked for.
    """
    x = 0.0
    before = 0.0
    solved = 0
    missed = 0.0
    for k in range(len(path)):
        part = (path[k] - before) / substeps
        for n in range(substeps):
            target = path[k] if n + 1 == substeps else before + (n + 1) * part
            answer = advance(x, state, parameters, target - x, flexibility)
            x = x + answer.step
            state = answer.state
            moment[k] = answer.moment
            # what is no number has not been solved either
            missed += 0.0 if answer.unconverged == 0.0 and answer.moment == answer.moment else 1.0
        before = path[k]
        for j in range(len(state)):
            states[k, j] = state[j]
        solved = k + 1 if missed == 0.0 else solved
    return solved
