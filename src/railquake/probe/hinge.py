"""The hinge by itself, under a prescribed rotation."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.statics import UNKNOWN_DEGRADATION
from railquake.assembly.system import hinge_parameters
from railquake.errors import InputError
from railquake.physics import boucwen

if TYPE_CHECKING:
    from railquake.inputs.hinge import BoucWenHinge

__all__ = ["run_hinge"]

Array = np.ndarray[Any, np.dtype[np.float64]]


def run_hinge(hinge: BoucWenHinge, rotation: Array, *, elastic: bool = False) -> Array:
    """Drive a virgin hinge along a path of rotations.

    Parameters
    ----------
    hinge : BoucWenHinge
    rotation : array, shape (n,)
        rad; the step from zero to the first one counts.
    elastic : bool
        Whether M = k0 x instead.

    Returns
    -------
    array, shape (n, 3)
        Moment (N m), hysteretic rotation z (rad) and damage index d.

    Raises
    ------
    InputError
        If the iteration does not converge in a step.
    """
    parameters = hinge_parameters(hinge, tolerance=1e-13, iterations=200)
    law = boucwen.advance_elastic if elastic else boucwen.advance
    x = z = eps = x_max = 0.0
    rows = np.empty((len(rotation), 3))
    for k, target in enumerate(rotation):
        step = float(target) - x
        try:
            _, z_new, eps, x_max, moment, _, correction, *_ = law(
                x, z, z, eps, x_max, *UNKNOWN_DEGRADATION, step, 0.0, *parameters
            )
        except ArithmeticError:  # a number too large for a float
            z_new = correction = math.nan
        if not abs(correction) <= max(parameters[-2], 1e-15 * abs(z_new)):
            raise InputError(
                f"path, row {k + 1}: the hinge does not converge over a step of {step:.3g} rad; "
                "take smaller steps, in rad"
            )
        x, z = float(target), z_new
        damage = boucwen.damage_index(eps, x_max, parameters[5], parameters[6])
        rows[k] = moment, z, damage
    return rows
