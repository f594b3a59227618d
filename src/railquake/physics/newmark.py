"""Newmark's constant average acceleration for the structure (beta = 1/4, gamma = 1/2).

With the increment dx of displacement over a step dt ::

    x''(n+1) = 4 dx/dt^2 - 4 x'/dt - x''        x'(n+1) = 2 dx/dt - x'

so that M x'' + C x' + K x + F = P at the new time becomes ::

    (4 M/dt^2 + 2 C/dt + K) dx + F = P - K x + M (4 x'/dt + x'') + C x'

Source: Newmark (1959), ASCE Journal of the Engineering Mechanics Division 85, 67-94.
"""

from typing import Any

import numpy as np

__all__ = ["beside_dashpot", "effective_matrix", "new_acceleration", "new_velocity"]

Array = np.ndarray[Any, np.dtype[np.float64]]


def effective_matrix(mass: Array, damping: Array, stiffness: Array, dt: float) -> Array:
    """4 M/dt^2 + 2 C/dt + K."""
    matrix: Array = 4.0 / dt**2 * mass + 2.0 / dt * damping + stiffness
    return matrix


def new_velocity(dx: float, v: float, rate: float) -> float:
    """x'(n+1) after the increment dx; ``rate`` is 1/dt."""
    return 2.0 * rate * dx - v


def new_acceleration(dx: float, v: float, a: float, rate: float) -> float:
    """x''(n+1) after the increment dx; ``rate`` is 1/dt."""
    return 4.0 * rate * (rate * dx - v) - a


def beside_dashpot(
    free_step: float, flexibility: float, damping: float, v: float, rate: float
) -> tuple[float, float]:
    """Free step and flexibility that a hinge meets beside a dashpot that turns with it.

    dx = free_step - flexibility (M + c x'), with x' = 2 dx/dt - v at the step's end, solved for
    dx = free - soft M.

    Parameters
    ----------
    free_step : float
        Increment without any moment, rad.
    flexibility : float
        Rotation per moment, rad/(N m).
    damping : float
        c of the dashpot, N m s; without it both stay as they are.
    v : float
        Rate at the step's begin, rad/s.
    rate : float
        1/dt, 1/s.
    """
    held = 1.0 / (1.0 + 2.0 * rate * flexibility * damping)
    return held * (free_step + flexibility * damping * v), held * flexibility
