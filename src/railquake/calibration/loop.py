"""A hinge under a prescribed rotation of the whole column: what a fit evaluates again and again.

The column over the hinge is elastic, so that under a lateral force F at its top ::

    u / L = theta + c M,     M = F L,     c = L / (3 E I)

Driven by the chord's rotation u / L, the hinge turns by ``d theta = d(u / L) - c dM``, which is
what `railquake.physics.boucwen.advance` solves for.  With ``c = 0`` the rotation of the hinge
itself is prescribed.
"""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np

from railquake.assembly.system import hinge_parameters
from railquake.inputs.hinge import BoucWenHinge
from railquake.physics.boucwen import advance
from railquake.physics.kernel import SCALAR, Target, bind

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
    moment = np.empty(len(chord))
    parameters = np.array(hinge_parameters(hinge, TOLERANCE, ITERATIONS))
    _kernel(target)(np.ascontiguousarray(chord), flexibility, parameters, substeps, moment)
    return moment


def _kernel(target: Target) -> Any:
    # the compiler's cache knows the sources of the physics, not this file
    code = _follow.__code__
    text = repr((code.co_code, code.co_consts, code.co_names))
    own = int(hashlib.sha256(text.encode()).hexdigest()[:12], 16)
    return bind(_follow, target, constants={"follow": own}).call


def _follow(
    chord: Array, flexibility: float, parameters: Array, substeps: int, moment: Array
) -> None:
    k0, alpha, n, eta0, beta0 = (
        parameters[0], parameters[1], parameters[2], parameters[3], parameters[4],
    )  # fmt: skip
    rho_eps_m, rho_x, phi, delta_k, delta_f = (
        parameters[5], parameters[6], parameters[7], parameters[8], parameters[9],
    )  # fmt: skip
    per_sigma, u, per_eps_p, rho_p, per_mass = (
        parameters[10], parameters[11], parameters[12], parameters[13], parameters[14],
    )  # fmt: skip
    tolerance, iterations = parameters[15], parameters[16]
    x = z = z_step = eps = x_max = 0.0
    # nothing is known of degradation yet
    d, a, beta, log_a, kp = -1.0, 0.0, 0.0, 0.0, 0.0
    now = before = failed = 0.0
    for k in range(len(chord)):
        part = (chord[k] - before) / substeps
        before = chord[k]
        for _ in range(substeps):
            dx, z_new, eps, x_max, now, _tangent, correction, d, a, beta, log_a, kp = advance(
                x, z, z + z_step, eps, x_max, d, a, beta, log_a, kp,
                part + flexibility * now, flexibility,
                k0, alpha, n, eta0, beta0, rho_eps_m, rho_x, phi, delta_k, delta_f,
                per_sigma, u, per_eps_p, rho_p, per_mass, tolerance, iterations,
            )  # fmt: skip
            x = x + dx
            z_step = z_new - z
            z = z_new
            if not abs(correction) <= tolerance:
                failed = 1.0
        moment[k] = now if failed == 0.0 else np.nan
