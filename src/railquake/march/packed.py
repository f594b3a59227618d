"""Matrices in rows: the structure's as upper triangles, the vehicle's as two square blocks."""

from functools import cache
from typing import Any

import numpy as np

__all__ = ["from_blocks", "in_blocks", "packed", "unpacked", "upper_triangle"]

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


def in_blocks(matrix: Array, first: int) -> Array:
    """Entries of the two blocks on the diagonal, row by row: the first has ``first`` rows.

    What couples them is zero; see `order.lateral_block`.
    """
    entries: Array = np.concatenate(
        [matrix[:first, :first].ravel(), matrix[first:, first:].ravel()]
    )
    return entries


def from_blocks(entries: Array, first: int, n: int) -> Array:
    """Matrix of n rows from its blocks' entries; see `in_blocks`."""
    matrix = np.zeros((n, n))
    matrix[:first, :first] = entries[: first * first].reshape(first, first)
    matrix[first:, first:] = entries[first * first :].reshape(n - first, n - first)
    return matrix
