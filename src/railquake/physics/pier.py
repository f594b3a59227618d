"""The pier: a cantilever with a plastic hinge at its foot (Eqs. 9 and 10 of the paper).

    M_s X_s'' + C_s X_s' + F_rs = -M_s t u_g''                                             (Eq. 9)

X_s = (u, theta_1, theta_2): lateral displacement of the top, rotations at base and top; the
rotations are positive against phi, so a rigid rotation of the column is u = -L theta.  The
column's stiffness is Eq. 10, the hinge's tangent being added at (theta_1, theta_1).  Rayleigh
damping C_s = a M_s + b K has its ratio in the first two modes of the initial stiffness, hinge
included; which stiffness of the hinge then stands in K is a choice (`HingeDamping`).
"""

from typing import Any, NamedTuple

import numpy as np

__all__ = [
    "HingeDamping",
    "geometric_stiffness",
    "natural_frequencies",
    "rayleigh_coefficients",
    "rayleigh_damping",
    "stiffness_matrix",
]

Array = np.ndarray[Any, np.dtype[np.float64]]


class HingeDamping(NamedTuple):
    """The hinge's own damping moment over its rate: constant + per_tangent times its tangent.

    With the hinge's initial stiffness in K the moment stays b k_0 theta_1' after the hinge has
    yielded, when its own no longer grows.  Charney (2008), "Unintended consequences of modeling
    damping in structures", Journal of Structural Engineering 134(4), 581-592.
    """

    constant: float
    """N m s."""
    per_tangent: float
    """s."""


def stiffness_matrix(
    youngs_modulus: float, second_moment: float, length: float, hinge: float
) -> Array:
    """Eq. 10: stiffness for (u, theta_1, theta_2), hinge tangent ``hinge`` in N m/rad."""
    ei_l3 = youngs_modulus * second_moment / length**3
    matrix: Array = ei_l3 * np.array(
        [
            [12.0, 6.0 * length, 6.0 * length],
            [6.0 * length, 4.0 * length**2, 2.0 * length**2],
            [6.0 * length, 2.0 * length**2, 4.0 * length**2],
        ]
    )
    matrix[1, 1] += hinge
    return matrix


def geometric_stiffness(axial_load: float, length: float) -> Array:
    """P-delta: consistent geometric stiffness of a column under compression P, N."""
    matrix: Array = (
        -axial_load
        / (30.0 * length)
        * np.array(
            [
                [36.0, 3.0 * length, 3.0 * length],
                [3.0 * length, 4.0 * length**2, -(length**2)],
                [3.0 * length, -(length**2), 4.0 * length**2],
            ]
        )
    )
    return matrix


def natural_frequencies(mass: Array, stiffness: Array) -> Array:
    """Circular frequencies, rad/s, ascending; ``mass`` is the diagonal."""
    root = 1.0 / np.sqrt(mass)
    frequencies: Array = np.sqrt(np.linalg.eigvalsh(stiffness * np.outer(root, root)))
    return frequencies


def rayleigh_coefficients(mass: Array, stiffness: Array, ratio: float) -> tuple[float, float]:
    """A (1/s) and b (s) of C = a M + b K: damping ratio ``ratio`` in the first two modes."""
    first, second = natural_frequencies(mass, stiffness)[:2]
    return 2.0 * ratio * first * second / (first + second), 2.0 * ratio / (first + second)


def rayleigh_damping(mass: Array, stiffness: Array, a: float, b: float) -> Array:
    """C = a M + b K, with a in 1/s and b in s; ``mass`` is the diagonal."""
    matrix: Array = a * np.diag(mass) + b * stiffness
    return matrix
