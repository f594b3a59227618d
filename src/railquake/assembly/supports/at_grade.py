"""No structure: the track moves with the ground.

A column stands idle: neither ground nor train acts on it, and it does not move the track.
"""

from __future__ import annotations

import numpy as np

from railquake.assembly.supports import Structure
from railquake.inputs.solver import Solver
from railquake.inputs.support import AtGrade
from railquake.physics.hinge.elastic import Parameters

__all__ = ["KIND", "idle_column", "structure"]

KIND = AtGrade


def idle_column() -> Structure:
    """A column on which nothing acts."""
    return Structure(
        mass=np.ones(3),
        stiffness=np.eye(3),
        damping=np.zeros((3, 3)),
        ground_load=np.zeros(3),
        hinge="elastic",
        parameters=Parameters(1.0),
    )


def structure(support: AtGrade, solver: Solver, train_mass: float) -> Structure:
    """An idle column."""
    return idle_column()
