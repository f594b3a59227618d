"""A single column with a hinge at its foot (Eqs. 9 and 10)."""

from __future__ import annotations

import numpy as np

from railquake.assembly.supports import Structure
from railquake.inputs.solver import Solver
from railquake.inputs.support import Pier
from railquake.physics import pier
from railquake.physics.hinge import HINGE_LAWS
from railquake.physics.track import Offset
from railquake.physics.vehicle import GRAVITY

__all__ = ["KIND", "structure"]

KIND = Pier


def structure(support: Pier, solver: Solver, train_mass: float) -> Structure:
    """Mass, stiffness and damping of the column; the train's weight counts where it is coupled."""
    law = HINGE_LAWS[support.hinge]
    parameters = law.parameters(
        support.hinge_parameters, solver.newton_tolerance, solver.newton_max_iterations
    )
    mass = np.array([support.mass, support.base_rotational_inertia, support.rotational_inertia])
    column = pier.stiffness_matrix(
        support.youngs_modulus, support.second_moment_of_area, support.length, 0.0
    )
    initial = column.copy()
    initial[1, 1] += parameters.k0
    a, b = pier.rayleigh_coefficients(mass, initial, support.damping_ratio)
    damping = pier.rayleigh_damping(mass, column, a, b)
    of_hinge = {
        "column": pier.HingeDamping(0.0, 0.0),
        "initial": pier.HingeDamping(b * parameters.k0, 0.0),
        "tangent": pier.HingeDamping(0.0, b),
    }
    if support.p_delta:
        weight = (support.mass + (train_mass if support.coupled else 0.0)) * GRAVITY
        column = column + pier.geometric_stiffness(weight, support.length)
    return Structure(
        mass=mass,
        stiffness=column,
        damping=damping,
        ground_load=np.array([support.mass, 0.0, 0.0]),
        hinge=support.hinge,
        parameters=parameters,
        offset=Offset(1.0, support.track_height, support.track_offset, 1.0),
        hinge_damping=of_hinge[support.damping_of],
        reaction=1.0 if support.coupled else 0.0,
    )
