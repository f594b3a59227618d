"""The hinge by itself, under a prescribed rotation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.hinge import drive_hinge
from railquake.errors import InputError

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
    law = "elastic" if elastic else "bouc-wen"
    driven = drive_hinge(law, hinge, rotation, tolerance=1e-13, iterations=200)
    if driven.solved < len(rotation):
        k = driven.solved
        step = float(rotation[k]) - (float(rotation[k - 1]) if k else 0.0)
        raise InputError(
            f"path, row {k + 1}: the hinge does not converge over a step of {step:.3g} rad; "
            "take smaller steps, in rad"
        )
    return np.column_stack([driven.moment, driven.state("z"), driven.damage])
