"""The creep force of one contact ellipse."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from railquake.assembly.geometry import law_table
from railquake.physics.creep import CREEP_LAWS, bounded_force, linear_force
from railquake.physics.creep.kalker import kalker_coefficients

__all__ = ["CreepForce", "creep_force"]


class CreepForce(NamedTuple):
    """On the wheel of one contact ellipse, N."""

    lateral: float
    longitudinal: float
    f22: float
    """G a b C22."""


def creep_force(
    semi_axes: tuple[float, float],
    load: float,
    creepages: tuple[float, float, float],
    friction: float,
    shear_modulus: float,
    poisson: float,
    law: str,
) -> CreepForce:
    """Creep force on the wheel of one contact ellipse.

    Parameters
    ----------
    semi_axes : (float, float)
        a along the rolling direction and b across, m.
    load : float
        Normal force, N.
    creepages : (float, float, float)
        Of the wheel relative to the rail: longitudinal, lateral, and spin about the normal (1/m).
    friction, shear_modulus, poisson : float
        mu, G (Pa), nu.
    law : str
        Name of a creep law.

    Returns
    -------
    CreepForce
    """
    a, b = semi_axes
    c11, c22, c23 = (float(c[0]) for c in kalker_coefficients(np.array([a / b]), poisson))
    f22 = shear_modulus * a * b * c22
    linear = linear_force(
        shear_modulus * a * b * c11, f22, shear_modulus * (a * b) ** 1.5 * c23, creepages
    )
    force = bounded_force(
        CREEP_LAWS[law], linear, friction * load, math.log(a / b), law_table(law, poisson)
    )
    return CreepForce(force.creep + force.spin, force.along, f22)
