"""The suspension: linear springs and dashpots between a vehicle's bodies (Eq. 1 of the paper).

An element joins a point of one body to a point of another, along y or z.  A point at (p_y, p_z)
from a body's centre of gravity is displaced by (y - p_z phi, z + p_y phi), linearly about the
undeformed position, so an element's elongation is b^T X and its share of K_v (or C_v) is k b b^T.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from railquake.physics.joint import Tie

__all__ = ["element_matrix", "element_row", "lateral_travel", "roll_row"]

Array = np.ndarray[Any, np.dtype[np.float64]]


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


def roll_row(bodies: int, first: int, second: int) -> Array:
    """Twist of an anti-roll bar per unit of each degree of freedom, shape (3 * bodies,)."""
    row = np.zeros(3 * bodies)
    row[3 * first + 2], row[3 * second + 2] = 1.0, -1.0
    return row


def lateral_travel(upper: tuple[float, float], lower: tuple[float, float], tie: Tie) -> float:
    """Lateral travel of a point of an upper body against one of a lower body, m.

    Parameters
    ----------
    upper, lower : (float, float)
        Lateral displacement, m, and roll, rad, of each body.
    tie : Tie
        The two points.
    """
    return upper[0] - tie.upper_z * upper[1] - (lower[0] - tie.lower_z * lower[1])


def element_matrix(rows: Sequence[Array], coefficients: Sequence[float], dofs: int) -> Array:
    """Stiffness (or damping) matrix of all springs (or dashpots), sum of k b b^T."""
    matrix = np.zeros((dofs, dofs))
    for row, coefficient in zip(rows, coefficients, strict=True):
        matrix += coefficient * np.outer(row, row)
    return matrix
