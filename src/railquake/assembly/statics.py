"""The state from which a run starts, and the longest time step that it may be marched with."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
from scipy.optimize import brentq

from railquake.errors import InputError
from railquake.physics import constant, state
from railquake.physics.profiles import Geometry
from railquake.physics.vehicle import kernel_order

__all__ = [
    "UNKNOWN_DEGRADATION",
    "ContactForces",
    "critical_time_step",
    "fastest_rate",
    "monotonic_hinge",
    "rest",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

STEP_GROWTH = 1.3  # between two time steps that are looked at for stability
# Nothing known of degradation and pinching: no damage is negative, see `boucwen.degradation_now`.
UNKNOWN_DEGRADATION = (-1.0, 0.0, 0.0, 0.0, 0.0)

# (displacement, velocity of the wheelset; track y, z, phi) -> forces on the wheelset and on the
# pier's top node, both in ground axes
ContactForces = Callable[[Array, Array, Array], tuple[Array, Array]]


def monotonic_hinge(
    law: Callable[..., tuple[float, ...]], parameters: tuple[float, ...], moment: float
) -> tuple[float, float, float, float]:
    """Rotation, z, eps and x_max of a virgin hinge loaded by ``moment``, N m.

    The rotation grows in steps of a hundredth of the elastic answer, so that the result does not
    depend on the path.

    Raises
    ------
    InputError
        If the hinge cannot carry the moment.
    """
    if moment == 0.0:
        return 0.0, 0.0, 0.0, 0.0
    increment = moment / parameters[0] / 100.0

    def turned(at: tuple[float, ...], by: float) -> tuple[float, ...]:
        x, z, eps, x_max = at
        dx, z, eps, x_max, found, *_ = law(
            x, z, z, eps, x_max, *UNKNOWN_DEGRADATION, by, 0.0, *parameters
        )
        return x + dx, z, eps, x_max, found

    at: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)
    for _ in range(20_000):
        after = turned(at, increment)
        if abs(after[4]) >= abs(moment):
            break
        at = after[:4]
    else:
        raise InputError(
            f"the hinge cannot carry the standing train: a moment of {abs(moment):.3g} N m is "
            "needed; check support.bouc_wen (k0, beta0) and support.track_offset"
        )
    last = brentq(lambda by: turned(at, by)[4] - moment, 0.0, increment, xtol=1e-18)
    x, z, eps, x_max, _ = turned(at, float(last))
    return x, z, eps, x_max


def rest(
    vehicle_mass: Array,
    vehicle_stiffness: Array,
    gravity: float,
    pier_stiffness: Array,
    hinge: Callable[[float], tuple[float, float, float, float]],
    hinge_stiffness: float,
    track_map: Array,
    reaction: float,
    forces: ContactForces,
    settlement: float,
    carried: Callable[[Array], Array],
) -> tuple[Array, Array, float, tuple[float, float, float, float]]:
    """Equilibrium of the standing or evenly running train, centred on the track.

    Where the track is tilted by the train's eccentric weight, no position is at rest on
    cylindrical treads: the car then creeps sideways at the small, constant speed at which
    creepage carries the weight's lateral part.  That speed is found with the positions.

    Parameters
    ----------
    vehicle_mass : array, shape (n,)
    vehicle_stiffness : array, shape (n, n)
    gravity : float
        m/s2.
    pier_stiffness : array, shape (3, 3)
        Without the hinge.
    hinge : callable
        Moment -> rotation, z, eps, x_max.
    hinge_stiffness : float
        Its initial stiffness, N m/rad.
    track_map : array, shape (3, 3)
        Track (y, z, phi) from (u, theta_1, theta_2).
    reaction : float
        1 if the train's forces act on the pier, else 0.
    forces : callable
        See `ContactForces`.
    settlement : float
        Vertical displacement of the wheelset at which the treads bear about their load, m.
    carried : callable
        Track (y, z, phi) -> displacements of a car carried along undeformed.

    Returns
    -------
    pier : array, shape (3,)
    vehicle : array, shape (n,)
    drift : float
        Sideways creep of the whole car, m/s.
    hinge : tuple
        Rotation, z, eps, x_max.
    """
    n = len(vehicle_mass)
    weight = vehicle_mass.copy()
    weight[0::3] = 0.0
    weight[2::3] = 0.0
    weight *= gravity
    sideways = np.zeros(n)
    sideways[0::3] = 1.0
    # the suspension's own compression under the bodies' weight, wheelset held
    sag = np.zeros(n)
    if n > 3:
        sag[:-3] = np.linalg.solve(vehicle_stiffness[:-3, :-3], weight[:-3])
    secant = hinge_stiffness

    def unpack(unknown: Array) -> tuple[Array, Array, float]:
        vehicle = sag + 1e-3 * unknown[3:]
        drift = 1e-4 * unknown[3 + n - 3]
        vehicle[n - 3] = (track_map @ (1e-3 * unknown[:3]))[0]  # centred
        return 1e-3 * unknown[:3], vehicle, float(drift)

    def residual(unknown: Array) -> Array:
        pier, vehicle, drift = unpack(unknown)
        on_wheelset, on_node = forces(vehicle[-3:], drift * sideways[-3:], track_map @ pier)
        out = np.empty(3 + n)
        out[:3] = pier_stiffness @ pier - reaction * on_node
        out[1] += secant * pier[1]
        out[3:] = vehicle_stiffness @ vehicle - weight
        out[-3:] -= on_wheelset
        return out / weight.sum()

    # first guess: the pier under the weight on its track, the car carried along
    initial = pier_stiffness.copy()
    initial[1, 1] += secant
    down = track_map.T @ np.array([0.0, weight.sum(), 0.0])
    guess = np.linalg.solve(initial, reaction * down)
    start = np.concatenate([guess, carried(track_map @ guess)])
    start[4::3] += settlement
    start *= 1e3
    start[n] = 0.0
    for _ in range(50):
        solved = _newton(residual, start)
        if solved is None:
            raise InputError(
                "no equilibrium of the standing train was found: wheel and rail may not meet "
                "where the wheels stand (check wheelrail.running_circle, rail_centre, gauge and "
                "friction), or the support may not carry it (check support.length and "
                "track_offset)"
            )
        pier, vehicle, drift = unpack(solved)
        moment = secant * pier[1]
        hinge_state = hinge(moment)
        settled = abs(hinge_state[0] - pier[1]) <= 1e-12 * max(abs(pier[1]), 1e-6)
        if settled:
            break
        secant = moment / hinge_state[0]
        start = solved
    pier[1] = hinge_state[0]
    return pier, vehicle, drift, hinge_state


def _newton(residual: Callable[[Array], Array], start: Array) -> Array | None:
    """Root of a smooth system by Newton's method with halved steps; None if it does not converge.

    General root finders take difference steps that are far too long for an indentation of some
    hundredths of a millimetre among displacements of millimetres.
    """
    x = start
    found = residual(x)
    jacobian = None
    for _ in range(60):
        if np.abs(found).max() < 1e-12:
            return x
        if jacobian is not None:  # the last one serves as long as it cuts the residual to a tenth
            near = x - np.linalg.solve(jacobian, found)
            tried = residual(near)
            if np.linalg.norm(tried) < 0.1 * np.linalg.norm(found):
                x, found = near, tried
                continue
        jacobian = _jacobian(residual, x, found)
        try:
            full = -np.linalg.solve(jacobian, found)
        except np.linalg.LinAlgError:
            return None
        share = 1.0
        while share > 1e-4:
            tried = residual(x + share * full)
            if np.linalg.norm(tried) < np.linalg.norm(found):
                break
            share *= 0.5
        else:
            # no descent: roundoff has been reached, or there is nothing to stand on
            return x if np.abs(found).max() < 1e-8 else None
        x, found = x + share * full, tried
    return x if np.abs(found).max() < 1e-8 else None


def _jacobian(residual: Callable[[Array], Array], x: Array, found: Array) -> Array:
    """Derivatives of the residual, which is ``found`` at ``x``, by forward differences."""
    jacobian = np.empty((len(x), len(x)))
    for k in range(len(x)):
        unit = np.zeros(len(x))
        unit[k] = 1e-6
        jacobian[:, k] = (residual(x + unit) - found) / 1e-6
    return jacobian


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


def contact_forces(
    S: Array, Q: Array, geometry: Geometry, stages: Callable[[Array, Array, Geometry], None]
) -> ContactForces:
    """Contact forces as a plain function of the wheelset's and the track's position.

    ``stages`` runs the contact stages of the kernel on a scratch state ``S``.
    """
    dofs = (len(S) - state.VEHICLE) // state.VEHICLE_BLOCKS
    # the wheelset's (y, z, phi) among the kernel's rows
    rows = state.VEHICLE + np.argsort(kernel_order(dofs))[-3:]

    @cache  # most derivatives of the equilibrium leave the contacts where they are
    def acting(place: tuple[float, ...]) -> tuple[Array, Array]:
        S[rows, 0] = place[:3]
        S[rows + dofs, 0] = place[3:6]
        S[state.TRACK_Y : state.TRACK_Y + 3, 0] = place[6:]
        S[state.TRACK_VY : state.TRACK_VY + 3, 0] = 0.0
        # a standing contact: closed, with the hysteresis of the slowest onset
        hysteresis = Q[constant.ALPHA_R, 0] / Q[constant.ONSET_BOUND, 0]
        for patch in range(4):
            row = state.PATCH + patch * state.PATCH_ROWS + state.PATCH_HYSTERESIS
            S[row, 0] = hysteresis
        stages(S, Q, geometry)
        wheelset = S[state.WHEELSET_Y : state.WHEELSET_Y + 3, 0].copy()
        node = np.array([S[state.NODE_U, 0], 0.0, S[state.NODE_THETA2, 0]])
        return wheelset, node

    return lambda position, velocity, track: acting((*position, *velocity, *track))
