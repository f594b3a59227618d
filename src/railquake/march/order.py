"""The order in which the march keeps a vehicle's degrees of freedom."""

from typing import Any

import numpy as np

__all__ = ["kernel_order", "lateral_block"]

Array = np.ndarray[Any, np.dtype[np.float64]]


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
