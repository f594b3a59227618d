"""The creep force of one contact ellipse."""

from __future__ import annotations

import numpy as np

from railquake.physics.creep import CREEP_LAWS, linear_force
from railquake.physics.creep.kalker import kalker_coefficients

__all__ = ["creep_force"]


def creep_force(
    semi_axes: tuple[float, float],
    load: float,
    creepage: float,
    spin: float,
    friction: float,
    shear_modulus: float,
    poisson: float,
    law: str,
) -> tuple[float, float]:
    """Lateral creep force on the wheel of one contact ellipse.

    Parameters
    ----------
    semi_axes : (float, float)
        a along the rolling direction and b across, m.
    load : float
        Normal force, N.
    creepage, spin : float
        Of the wheel relative to the rail: lateral, 1, and about the normal, 1/m.
    friction, shear_modulus, poisson : float
        mu, G (Pa), nu.
    law : str
        Name of a creep law.

    Returns
    -------
    force, f22 : float
        N.
    """
    a, b = semi_axes
    _, c22, c23 = kalker_coefficients(np.array([a / b]), poisson)
    f22 = shear_modulus * a * b * float(c22[0])
    f23 = shear_modulus * (a * b) ** 1.5 * float(c23[0])
    # the creepage is v_t / V
    linear = sum(linear_force(f22, f23, creepage, 1.0, spin))
    return linear * CREEP_LAWS[law].saturation(linear, friction * load), f22
