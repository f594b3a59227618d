"""The longest time steps: stable ones, and those that what is slow may take by itself."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from railquake.assembly.supports import Structure

__all__ = [
    "LONGEST_SLOW",
    "ContactForces",
    "critical_time_step",
    "fastest_rate",
    "linear_contact",
    "slow_time_step",
    "with_contact",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

# (displacement, velocity of the wheelset; track y, z, phi) -> forces on the wheelset and on the
# structure, both in ground axes
ContactForces = Callable[[Array, Array, Array], tuple[Array, Array]]

STEP_GROWTH = 1.3  # between two time steps that are looked at for stability
LONGEST_SLOW = 1e-4  # s; no step of structure and sprung bodies is longer, but for ``dt`` itself
SLOW = 0.05  # rad; phase by which what is slow may turn in one of its steps


def critical_time_step(
    mass: Array, stiffness: Array, damping: Array, phi: float, psi: float
) -> float:
    """Longest stable time step of Zhai's method for M x'' + C x' + K x = 0, s.

    Parameters
    ----------
    mass : array, shape (n,)
        Diagonal.
    stiffness, damping : array, shape (n, n)
        Of vehicle and contact, linearised at static load with the track held; friction makes
        them unsymmetric.
    phi, psi : float
        Zhai's parameters.

    Returns
    -------
    float
        Shortest step at which the step's amplification exceeds what the exact motion may grow by.
    """
    n = len(mass)
    k = stiffness / mass[:, None]
    c = damping / mass[:, None]
    growth = max(0.0, float(_eigenvalues(k, c).real.max()))
    eye = np.eye(n)

    def unstable(dt: float) -> bool:
        # state (x, v, a_before); a = -(k x + c v)
        x = np.hstack([eye, dt * eye, -psi * dt**2 * eye])
        a = np.hstack([-k, -c, np.zeros((n, n))])
        x = x + (0.5 + psi) * dt**2 * a
        v = np.hstack([np.zeros((n, n)), eye, -phi * dt * eye]) + (1.0 + phi) * dt * a
        radius = np.abs(np.linalg.eigvals(np.vstack([x, v, a]))).max()
        return bool(radius > np.exp(growth * dt) * (1.0 + 1e-6) + 1e-6)

    trial = 1e-7
    while not unstable(trial):
        trial *= STEP_GROWTH
        if trial > 1.0:
            return 1.0
    low, high = trial / STEP_GROWTH, trial
    for _ in range(20):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if unstable(middle) else (middle, high)
    return low


def fastest_rate(mass: Array, stiffness: Array, damping: Array) -> float:
    """Largest magnitude of the eigenvalues of M x'' + C x' + K x = 0, 1/s.

    Parameters are those of `critical_time_step`.
    """
    found = _eigenvalues(stiffness / mass[:, None], damping / mass[:, None])
    return float(np.abs(found).max())


def _eigenvalues(k: Array, c: Array) -> Array:
    """Eigenvalues of x'' + c x' + k x = 0, 1/s."""
    n = len(k)
    found: Array = np.linalg.eigvals(np.block([[np.zeros((n, n)), np.eye(n)], [-k, -c]]))
    return found


def linear_contact(
    position: Array, drift: float, forces: ContactForces, track: Array
) -> tuple[Array, Array]:
    """Stiffness and damping of the contact for the wheelset, by central differences at static load.

    Two arrays of shape (3, 3).
    """
    velocity = np.array([drift, 0.0, 0.0])
    stiffness, damping = np.empty((2, 3, 3))
    for k, unit in enumerate(np.eye(3)):
        for matrix, move, turn in ((stiffness, 1e-6, 0.0), (damping, 0.0, 1e-4)):
            ahead, _ = forces(position + move * unit, velocity + turn * unit, track)
            behind, _ = forces(position - move * unit, velocity - turn * unit, track)
            matrix[:, k] = -(ahead - behind) / (2.0 * (move + turn))
    return stiffness, damping


def with_contact(
    contact: tuple[Array, Array], stiffness: Array, damping: Array
) -> tuple[Array, Array]:
    """Stiffness and damping of the vehicle on a linear contact."""
    stiffness, damping = stiffness.copy(), damping.copy()
    stiffness[-3:, -3:] += contact[0]
    damping[-3:, -3:] += contact[1]
    return stiffness, damping


def slow_time_step(
    contact: tuple[Array, Array], vehicle_rate: float, structure: Structure
) -> float:
    """Longest step of what is slow: the vehicle off its rails, the track's node on the contact.

    ``vehicle_rate`` is the vehicle's fastest, 1/s.  The structure itself is marched implicitly.
    """
    rate = max(vehicle_rate, SLOW / LONGEST_SLOW)
    if structure.reaction > 0.0:
        _, top, _, top_roll = structure.degrees
        node = [top, top_roll]
        track = structure.track_map[:, node]
        stiffness, damping = (track.T @ matrix @ track for matrix in contact)
        rate = max(rate, fastest_rate(structure.mass[node], stiffness, damping))
    return SLOW / rate
