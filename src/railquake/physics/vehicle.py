"""The vehicle: rigid bodies joined by linear springs and dashpots (Eq. 1 of the paper).

    M_v X'' + C_v X' + K_v X = P_ev(t)                                                     (Eq. 1)

Each body has three degrees of freedom: lateral displacement y (right), vertical displacement z
(down) and rotation phi about the longitudinal axis (right side down).  A point at (p_y, p_z) from
a body's centre of gravity is displaced by (y - p_z phi, z + p_y phi).  The equations are linear
about the undeformed position.  P_ev holds gravity, the effective forces -m a_g of the shaking
ground and the contact forces on the wheelset, whose three degrees of freedom stand last.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from railquake.physics import constant, state
from railquake.physics.zhai import predict_displacement, predict_velocity

__all__ = [
    "DOF_COUNT",
    "accelerate",
    "element_row",
    "element_matrix",
    "fixed_wheelset_modes",
    "predict",
    "push_wheelset",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

DOF_COUNT = 9  # bound to the vehicle's own number when a kernel is made


def element_row(
    bodies: int,
    first: int,
    second: int,
    direction: tuple[float, float],
    first_point: tuple[float, float],
    second_point: tuple[float, float],
) -> Array:
    """Elongation of a spring or dashpot per unit of each degree of freedom.

    Parameters
    ----------
    bodies : int
        Number of bodies.
    first, second : int
        Numbers of the bodies that it joins.
    direction : (float, float)
        Its direction (y, z), of length one.
    first_point, second_point : (float, float)
        Its ends (y, z) from the centre of gravity of each body, m.

    Returns
    -------
    array, shape (3 * bodies,)
    """
    row = np.zeros(3 * bodies)
    for body, (y, z), sign in ((first, first_point, 1.0), (second, second_point, -1.0)):
        row[3 * body] += sign * direction[0]
        row[3 * body + 1] += sign * direction[1]
        row[3 * body + 2] += sign * (direction[1] * y - direction[0] * z)
    return row


def element_matrix(rows: Sequence[Array], coefficients: Sequence[float], dofs: int) -> Array:
    """Stiffness (or damping) matrix of all springs (or dashpots), sum of k b b^T."""
    matrix = np.zeros((dofs, dofs))
    for row, coefficient in zip(rows, coefficients, strict=True):
        matrix += coefficient * np.outer(row, row)
    return matrix


def fixed_wheelset_modes(mass: Array, stiffness: Array) -> tuple[Array, Array]:
    """Natural frequencies (Hz, ascending) and shapes with the wheelset held fast (Table 1).

    Parameters
    ----------
    mass : array, shape (n,)
        Diagonal of M_v; the wheelset's three degrees of freedom stand last.
    stiffness : array, shape (n, n)

    Returns
    -------
    frequencies : array, shape (n - 3,)
    shapes : array, shape (n - 3, n - 3)
        Column i is mode i, normalised to unit modal mass.
    """
    free = slice(0, len(mass) - 3)
    root = 1.0 / np.sqrt(mass[free])
    values, vectors = np.linalg.eigh(stiffness[free, free] * np.outer(root, root))
    frequencies = np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi)
    return frequencies, vectors * root[:, None]


def predict(S: Array, Q: Array, i: int, lane: int) -> None:
    """Stage: displacement and velocity of degree of freedom ``i`` at the new time (Zhai).

    The work of the effective ground forces and of gravity goes with it.
    """
    dt = Q[constant.DT, lane]
    x = state.VEHICLE + i
    v = x + DOF_COUNT
    a = v + DOF_COUNT
    before = a + DOF_COUNT
    on = S[state.ON_TRACK, lane]
    dx = on * predict_displacement(
        S[v, lane], S[a, lane], S[before, lane], dt, Q[constant.ZHAI_PSI, lane]
    )
    dv = on * predict_velocity(S[a, lane], S[before, lane], dt, Q[constant.ZHAI_PHI, lane])
    S[x, lane] += dx
    S[v, lane] += dv
    S[before, lane] = S[a, lane]
    S[before + DOF_COUNT, lane] = dx
    lateral = Q[constant.VEHICLE + DOF_COUNT + i, lane] * dx
    vertical = Q[constant.VEHICLE + 2 * DOF_COUNT + i, lane] * dx
    # the ground's acceleration has already moved on; its mean over the step does the work
    mean_y = S[state.GROUND, lane] - 0.5 * S[state.GROUND_SLOPE, lane]
    mean_z = S[state.GROUND_Z, lane] - 0.5 * S[state.GROUND_Z_SLOPE, lane]
    S[state.WORK_GROUND, lane] -= lateral * mean_y + vertical * mean_z
    S[state.WORK_GRAVITY, lane] += vertical * Q[constant.GRAVITY, lane]


def accelerate(S: Array, Q: Array, i: int, lane: int) -> None:
    """Stage: row ``i`` of Eq. 1 solved for the acceleration, contact forces left out."""
    stiffness = constant.VEHICLE + 3 * DOF_COUNT + i * DOF_COUNT
    damping = stiffness + DOF_COUNT * DOF_COUNT
    elastic = 0.0
    viscous = 0.0
    for j in range(DOF_COUNT):
        elastic += Q[stiffness + j, lane] * S[state.VEHICLE + j, lane]
        viscous += Q[damping + j, lane] * S[state.VEHICLE + DOF_COUNT + j, lane]
    external = Q[constant.VEHICLE + 2 * DOF_COUNT + i, lane] * (
        Q[constant.GRAVITY, lane] - S[state.GROUND_Z, lane]
    ) - Q[constant.VEHICLE + DOF_COUNT + i, lane] * S[state.GROUND, lane]
    S[state.VEHICLE + 2 * DOF_COUNT + i, lane] = Q[constant.VEHICLE + i, lane] * (
        external - elastic - viscous
    )
    S[state.DASHPOT_POWER, lane] += viscous * S[state.VEHICLE + DOF_COUNT + i, lane]


def push_wheelset(S: Array, Q: Array, lane: int) -> None:
    """Stage: contact forces on the wheelset, and the work that they do."""
    last = DOF_COUNT - 3
    for k in range(3):
        force = S[state.WHEELSET_Y + k, lane]
        S[state.VEHICLE + 2 * DOF_COUNT + last + k, lane] += (
            Q[constant.VEHICLE + last + k, lane] * force
        )
        moved = S[state.VEHICLE + 4 * DOF_COUNT + last + k, lane]
        S[state.WORK_VEHICLE, lane] += 0.5 * (S[state.WHEELSET_OLD + k, lane] + force) * moved
        S[state.WHEELSET_OLD + k, lane] = force


