"""Symmetric matrices kept as the rows of their upper triangles."""

from functools import cache
from typing import Any

import numpy as np

__all__ = ["packed", "unpacked", "upper_triangle"]

Array = np.ndarray[Any, np.dtype[np.float64]]


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
