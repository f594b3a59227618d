"""What each kind of support is to the march; a file a kind, found by lying here.

Each module says which input it is for, ``KIND``, and has a function
``structure(support, solver, train_mass) -> Structure``.
"""

from __future__ import annotations

import pkgutil
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import Any

import numpy as np

from railquake.march.rows import PIER
from railquake.physics.pier import HingeDamping
from railquake.physics.track import Offset

__all__ = ["Structure", "structure_of"]

Array = np.ndarray[Any, np.dtype[np.float64]]


UNMOVED = Offset(0.0, 0.0, 0.0, 0.0)
UNDAMPED = HingeDamping(0.0, 0.0)


@dataclass(frozen=True)
class Structure:
    """N degrees of freedom, linear but for one hinge, and the track on one of their nodes.

    Attributes
    ----------
    mass : array, shape (N,)
        Diagonal, kg and kg m2.
    stiffness, damping : array, shape (N, N)
        The hinge's apart.
    ground_load : array, shape (N,)
        What the ground's acceleration acts on, kg; zeros where nothing moves.
    hinge : str
        Name of the hinge's law.
    parameters : named tuple
        Of that law.
    offset : Offset
        Of the track from the node that carries it.
    hinge_damping : HingeDamping
        Of the hinge itself.
    reaction : float
        1 if the train's forces act on the structure, else 0.
    degrees : (int, int, int, int)
        See `rows.layout_of`.
    choice : str
        What stands in the slot "structure".
    prescribed : callable, optional
        ``times -> (y, y', z, z', phi, phi')`` of a track whose motion is known; SI.
    """

    mass: Array
    stiffness: Array
    damping: Array
    ground_load: Array
    hinge: str
    parameters: Any
    offset: Offset = UNMOVED
    hinge_damping: HingeDamping = UNDAMPED
    reaction: float = 0.0
    degrees: tuple[int, int, int, int] = PIER
    choice: str = "node"
    prescribed: Callable[[Array], list[Array]] | None = None

    @property
    def moves(self) -> bool:
        """Whether anything of it moves."""
        return bool(np.any(self.ground_load > 0.0))

    @property
    def track_map(self) -> Array:
        """Track (y, z, phi) from the degrees of freedom, shape (3, N)."""
        count, top, _, top_roll = self.degrees
        track = np.zeros((3, count))
        track[:, top_roll] = (-self.offset.height, -self.offset.eccentricity, -self.offset.phi)
        track[0, top] = self.offset.u
        return track


@cache
def _kinds() -> dict[type, Callable[..., Structure]]:
    found = {}
    for module in pkgutil.iter_modules(__path__):
        support = import_module(f"{__name__}.{module.name}")
        found[support.KIND] = support.structure
    return found


def structure_of(support: Any, solver: Any, train_mass: float) -> Structure:
    """The structure of a support.

    Parameters
    ----------
    support : Support
    solver : Solver
    train_mass : float
        kg.
    """
    return _kinds()[type(support)](support, solver, train_mass)
