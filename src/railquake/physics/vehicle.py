"""The vehicle: rigid bodies joined by linear springs and dashpots (Eq. 1 of the paper).

    M_v X'' + C_v X' + K_v X = P_ev(t)                                                     (Eq. 1)

Each body has three degrees of freedom: lateral displacement y (right), vertical displacement z
(down) and rotation phi about the longitudinal axis (right side down).  A point at (p_y, p_z) from
a body's centre of gravity is displaced by (y - p_z phi, z + p_y phi).  The equations are linear
about the undeformed position.  P_ev holds gravity, the effective forces -m a_g of the shaking
ground and the contact forces on the wheelset, the last body.  The kernel keeps the degrees of
freedom in the order of `kernel_order`.
"""

from collections.abc import Sequence
from functools import cache
from typing import Any

import numpy as np

from railquake.physics import constant, state
from railquake.physics.zhai import predict_displacement, predict_velocity

__all__ = [
    "BLOCK",
    "DOF_COUNT",
    "PACKED",
    "accelerate_lateral",
    "accelerate_vertical",
    "carry",
    "carry_suspension_on",
    "damp",
    "element_matrix",
    "element_row",
    "fixed_wheelset_modes",
    "kernel_order",
    "lateral_block",
    "note_place",
    "note_suspension",
    "packed",
    "predict_sprung",
    "predict_wheelset",
    "push_wheelset",
    "unpacked",
    "upper_triangle",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

# Bound to the vehicle's own numbers when a kernel is made.
DOF_COUNT = 9
BLOCK = 6  # rows of the first block, see `kernel_order`
PACKED = 45  # entries of a symmetric matrix


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


def kernel_order(dofs: int) -> Array:
    """Order in which the kernel keeps (y, z, phi of each body): lateral and roll first, then z.

    ``x_kernel = x[kernel_order]``.  In a car that is symmetric about its middle the vertical
    motion is decoupled from the rest, and each row of Eq. 1 needs its own block only.
    """
    bodies = np.arange(dofs // 3)
    lateral = np.column_stack([3 * bodies, 3 * bodies + 2]).ravel()
    return np.concatenate([lateral, 3 * bodies + 1])


def lateral_block(stiffness: Array, damping: Array) -> int:
    """Rows of the first block in `kernel_order`: two per body, or all where they are coupled."""
    dofs = len(stiffness)
    order = kernel_order(dofs)
    first = 2 * dofs // 3
    for matrix in (stiffness, damping):
        coupling = np.abs(matrix[np.ix_(order[:first], order[first:])])
        if coupling.max(initial=0.0) > 1e-12 * np.abs(matrix).max(initial=1e-300):
            return dofs
    return first


def packed(i: int, j: int, n: int) -> int:
    """Place of entry (i, j) of a symmetric n x n matrix kept as the rows of its upper triangle."""
    low = min(i, j)
    return ((low * (2 * n - low - 1)) >> 1) + max(i, j)


def unpacked(entries: Array) -> Array:
    """Symmetric matrix from the rows of its upper triangle; see `packed`."""
    n = round((2 * len(entries)) ** 0.5 - 0.5)
    matrix = np.empty((n, n))
    i, j = upper_triangle(n)
    matrix[i, j] = matrix[j, i] = entries
    return matrix


@cache
def upper_triangle(n: int) -> tuple[Any, Any]:
    """Rows and columns of the entries of a `packed` matrix."""
    return np.triu_indices(n)


def note_place(S: Array, lane: int) -> None:
    """Stage: where the wheelset is before the structure's step."""
    S[state.WHEELSET_FROM, lane] = S[state.VEHICLE + 2 * (DOF_COUNT // 3) - 2, lane]
    S[state.WHEELSET_FROM + 1, lane] = S[state.VEHICLE + DOF_COUNT - 1, lane]


def predict_sprung(S: Array, Q: Array, i: int, lane: int) -> None:
    """Stage: a sprung body's degree of freedom ``i`` at the end of the structure's step."""
    predict(S, Q, i, Q[constant.SUBSTEPS, lane] * Q[constant.DT, lane], lane)


def predict_wheelset(S: Array, Q: Array, lane: int) -> None:
    """Stage: the wheelset at the new time."""
    dt = Q[constant.DT, lane]
    predict(S, Q, 2 * (DOF_COUNT // 3) - 2, dt, lane)
    predict(S, Q, 2 * (DOF_COUNT // 3) - 1, dt, lane)
    predict(S, Q, DOF_COUNT - 1, dt, lane)


def predict(S: Array, Q: Array, i: int, dt: float, lane: int) -> None:
    """Displacement and velocity of degree of freedom ``i`` a time ``dt`` later (Zhai)."""
    x = state.VEHICLE + i
    v = x + DOF_COUNT
    a = v + DOF_COUNT
    before = a + DOF_COUNT
    step = before + DOF_COUNT
    on = S[state.ON_TRACK, lane]
    dx = on * predict_displacement(
        S[v, lane], S[a, lane], S[before, lane], dt, Q[constant.ZHAI_PSI, lane]
    )
    dv = on * predict_velocity(S[a, lane], S[before, lane], dt, Q[constant.ZHAI_PHI, lane])
    S[x, lane] += dx
    S[v, lane] += dv
    S[before, lane] = S[a, lane]
    S[step, lane] = dx


def carry(S: Array, Q: Array, lane: int) -> None:
    """Stage: work of the effective ground forces and of gravity on the moving bodies."""
    bodies = DOF_COUNT // 3
    step = state.VEHICLE + 4 * DOF_COUNT
    lateral = 0.0
    vertical = 0.0
    for k in range(bodies - 1):
        mass = Q[constant.VEHICLE + k, lane]
        lateral += mass * S[step + 2 * k, lane]
        vertical += mass * S[step + 2 * bodies + k, lane]
    # the wheelset has taken several steps
    mass = Q[constant.VEHICLE + bodies - 1, lane]
    y = S[state.VEHICLE + 2 * bodies - 2, lane]
    z = S[state.VEHICLE + DOF_COUNT - 1, lane]
    lateral += mass * (y - S[state.WHEELSET_FROM, lane])
    vertical += mass * (z - S[state.WHEELSET_FROM + 1, lane])
    # the ground's acceleration has already moved on; its mean over the step does the work
    mean_y = S[state.GROUND, lane] - 0.5 * S[state.GROUND_SLOPE, lane]
    mean_z = S[state.GROUND_Z, lane] - 0.5 * S[state.GROUND_Z_SLOPE, lane]
    S[state.WORK_GROUND, lane] -= lateral * mean_y + vertical * mean_z
    S[state.WORK_GRAVITY, lane] += vertical * Q[constant.GRAVITY, lane]
    # what `accelerate` will add up
    S[state.DASHPOT_POWER_OLD, lane] = S[state.DASHPOT_POWER, lane]
    S[state.DASHPOT_POWER, lane] = 0.0


def accelerate_lateral(S: Array, Q: Array, i: int, lane: int) -> None:
    """Stage: row ``i`` of Eq. 1 in the first block, contact forces left out."""
    accelerate(S, Q, i, 0, BLOCK, lane)


def accelerate_vertical(S: Array, Q: Array, i: int, lane: int) -> None:
    """Stage: row ``i`` of Eq. 1 in the second block, contact forces left out."""
    accelerate(S, Q, i, BLOCK, DOF_COUNT, lane)


def accelerate(S: Array, Q: Array, i: int, first: int, last: int, lane: int) -> None:
    """Row ``i`` of Eq. 1, coupled to ``first <= j < last``, solved for the acceleration."""
    bodies = DOF_COUNT // 3
    matrix = constant.VEHICLE + bodies + DOF_COUNT
    elastic = 0.0
    viscous = 0.0
    for j in range(first, last):
        entry = matrix + packed(i, j, DOF_COUNT)
        elastic += Q[entry, lane] * S[state.VEHICLE + j, lane]
        viscous += Q[entry + PACKED, lane] * S[state.VEHICLE + DOF_COUNT + j, lane]
    shaken = 1.0 if i < 2 * bodies and (i & 1) == 0 else 0.0  # y
    heavy = 1.0 if i >= 2 * bodies else 0.0  # z
    S[state.DASHPOT_POWER, lane] += viscous * S[state.VEHICLE + DOF_COUNT + i, lane]
    S[state.VEHICLE + 2 * DOF_COUNT + i, lane] = (
        heavy * (Q[constant.GRAVITY, lane] - S[state.GROUND_Z, lane])
        - shaken * S[state.GROUND, lane]
        - Q[constant.VEHICLE + bodies + i, lane] * (elastic + viscous)
    )


def damp(S: Array, Q: Array, lane: int) -> None:
    """Stage: energy lost to the dashpots during the step of structure and sprung bodies."""
    S[state.LOST_DASHPOTS, lane] += (
        0.5
        * Q[constant.SUBSTEPS, lane]
        * Q[constant.DT, lane]
        * (S[state.DASHPOT_POWER_OLD, lane] + S[state.DASHPOT_POWER, lane])
    )


def note_suspension(S: Array, Q: Array, lane: int) -> None:
    """Stage: what `accelerate` has found for the wheelset, and how that has changed per step."""
    bodies = DOF_COUNT // 3
    acceleration = state.VEHICLE + 2 * DOF_COUNT
    per_substep = Q[constant.DT, lane] * Q[constant.RATE, lane]
    note_share(S, 0, S[acceleration + 2 * bodies - 2, lane], per_substep, lane)
    note_share(S, 1, S[acceleration + DOF_COUNT - 1, lane], per_substep, lane)
    note_share(S, 2, S[acceleration + 2 * bodies - 1, lane], per_substep, lane)


def note_share(S: Array, k: int, now: float, per_substep: float, lane: int) -> None:
    """`note_suspension` for one of y, z, phi."""
    S[state.WHEELSET_FREE_SLOPE + k, lane] = per_substep * (
        now - S[state.WHEELSET_FREE_KNOWN + k, lane]
    )
    S[state.WHEELSET_FREE_KNOWN + k, lane] = now
    S[state.WHEELSET_FREE + k, lane] = now


def carry_suspension_on(S: Array, lane: int) -> None:
    """Stage between two evaluations of the suspension: the wheelset's share of it, carried on."""
    S[state.WHEELSET_FREE, lane] += S[state.WHEELSET_FREE_SLOPE, lane]
    S[state.WHEELSET_FREE + 1, lane] += S[state.WHEELSET_FREE_SLOPE + 1, lane]
    S[state.WHEELSET_FREE + 2, lane] += S[state.WHEELSET_FREE_SLOPE + 2, lane]


def push_wheelset(S: Array, Q: Array, lane: int) -> None:
    """Stage: contact forces on the wheelset, and the work that they do."""
    bodies = DOF_COUNT // 3
    y = 2 * bodies - 2
    phi = y + 1
    z = DOF_COUNT - 1
    acceleration = state.VEHICLE + 2 * DOF_COUNT
    inverse_mass = constant.VEHICLE + bodies
    step = state.VEHICLE + 4 * DOF_COUNT
    force_y = S[state.WHEELSET_Y, lane]
    force_z = S[state.WHEELSET_Z, lane]
    force_phi = S[state.WHEELSET_PHI, lane]
    S[acceleration + y, lane] = S[state.WHEELSET_FREE, lane] + Q[inverse_mass + y, lane] * force_y
    S[acceleration + z, lane] = (
        S[state.WHEELSET_FREE + 1, lane] + Q[inverse_mass + z, lane] * force_z
    )
    S[acceleration + phi, lane] = (
        S[state.WHEELSET_FREE + 2, lane] + Q[inverse_mass + phi, lane] * force_phi
    )
    S[state.WORK_VEHICLE, lane] += 0.5 * (
        (S[state.WHEELSET_OLD, lane] + force_y) * S[step + y, lane]
        + (S[state.WHEELSET_OLD + 1, lane] + force_z) * S[step + z, lane]
        + (S[state.WHEELSET_OLD + 2, lane] + force_phi) * S[step + phi, lane]
    )
    S[state.WHEELSET_OLD, lane] = force_y
    S[state.WHEELSET_OLD + 1, lane] = force_z
    S[state.WHEELSET_OLD + 2, lane] = force_phi
