"""A hinge under a prescribed rotation of the whole column: what a fit evaluates again and again.

The column over the hinge is elastic, so that under a lateral force F at its top ::

    u / L = theta + c M,     M = F L,     c = L / (3 E I)

Driven by the chord's rotation u / L, the hinge turns by ``d theta = d(u / L) - c dM``, which is
what the hinge's law solves for.  With ``c = 0`` the rotation of the hinge
itself is prescribed.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from railquake.assembly.hinge import drive_hinge as assembled
from railquake.inputs.hinge import BoucWenHinge
from railquake.march.compiler import SCALAR, Target

__all__ = ["column_flexibility", "drive_hinge"]

Array = np.ndarray[Any, np.dtype[np.float64]]

TOLERANCE, ITERATIONS = 1e-9, 60


def column_flexibility(youngs_modulus: float, second_moment: float, length: float) -> float:
    """Chord rotation of an elastic cantilever per moment at its base, L / (3 E I), rad/(N m)."""
    return length / (3.0 * youngs_modulus * second_moment)


def drive_hinge(
    hinge: BoucWenHinge,
    chord: Array,
    flexibility: float = 0.0,
    *,
    substeps: int = 1,
    target: Target = SCALAR,
) -> Array:
    """Drive a virgin hinge and the elastic column over it along a path.

    Parameters
    ----------
    hinge : BoucWenHinge
    chord : array, shape (n,)
        u / L, rad; the step from zero to the first one counts.
    flexibility : float
        Of the column, see `column_flexibility`.
    substeps : int
        Equal steps into which each one is divided.
    target : Target
        Where the law runs.

    Returns
    -------
    array, shape (n,)
        Moment at the base, N m; NaN from where the law does not converge.
    """
    driven = assembled(
        "bouc-wen",
        hinge,
        chord,
        tolerance=TOLERANCE,
        iterations=ITERATIONS,
        flexibility=flexibility,
        substeps=substeps,
        target=target,
    )
    moment = driven.moment
    moment[driven.solved :] = np.nan
    return moment
