"""The pier: a cantilever with a plastic hinge at its foot, and the track on it (Eqs. 9 and 10).

    M_s X_s'' + C_s X_s' + F_rs = -M_s t u_g''                                             (Eq. 9)

X_s = (u, theta_1, theta_2): lateral displacement of the top, rotations at base and top; the
rotations are positive against phi, so a rigid rotation of the column is u = -L theta.  The
column's stiffness is Eq. 10, the hinge's tangent being added at (theta_1, theta_1).  Rayleigh
damping is set on the first two modes of the initial stiffness, hinge included.

The track's origin hangs on the top node by a rigid offset: eccentricity e to the right, height h
upwards.  With phi = -theta_2 ::

    Y_t = u + h phi       Z_t = e phi       phi_t = phi

and a force (F_y, F_z) with moment M_x on the track acts on the node by the transpose of this map,
Q_u = F_y and Q_phi = h F_y + e F_z + M_x = -Q_theta2.
"""

from typing import Any

import numpy as np

from railquake.physics import constant, state
from railquake.physics.boucwen import advance, damage_index, degradation, pinched_stiffness
from railquake.physics.elementary import sin_cos
from railquake.physics.newmark import new_acceleration, new_velocity

__all__ = [
    "geometric_stiffness",
    "hold_structure",
    "lead_prescribed_track",
    "lead_track",
    "move_structure",
    "move_track",
    "natural_frequencies",
    "orient_track",
    "place_prescribed_track",
    "place_track",
    "rayleigh_damping",
    "refresh_hinge",
    "stiffness_matrix",
]

Array = np.ndarray[Any, np.dtype[np.float64]]


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


def rayleigh_damping(mass: Array, stiffness: Array, ratio: float) -> Array:
    """C = a M + b K with the damping ratio ``ratio`` in the first two modes of ``stiffness``."""
    first, second = natural_frequencies(mass, stiffness)[:2]
    a = 2.0 * ratio * first * second / (first + second)
    b = 2.0 * ratio / (first + second)
    matrix: Array = a * np.diag(mass) + b * stiffness
    return matrix


def move_structure(S: Array, Q: Array, lane: int) -> None:
    """Stage: one Newmark step of Eq. 9 under the ground and the last contact forces.

    The column is linear, so the unknowns are condensed on the rotation of the hinge, where
    Newton's method (`boucwen.advance`) finds the hinge's share.
    """
    rate = Q[constant.RATE, lane]
    u, th1, th2 = S[state.U, lane], S[state.THETA1, lane], S[state.THETA2, lane]
    vu, v1, v2 = S[state.U_V, lane], S[state.THETA1_V, lane], S[state.THETA2_V, lane]
    au, a1, a2 = S[state.U_A, lane], S[state.THETA1_A, lane], S[state.THETA2_A, lane]
    k_uu, k_u1, k_u2 = Q[constant.K, lane], Q[constant.K + 1, lane], Q[constant.K + 2, lane]
    k_11, k_12, k_22 = Q[constant.K + 3, lane], Q[constant.K + 4, lane], Q[constant.K + 5, lane]
    c_uu, c_u1, c_u2 = Q[constant.C, lane], Q[constant.C + 1, lane], Q[constant.C + 2, lane]
    c_11, c_12, c_22 = Q[constant.C + 3, lane], Q[constant.C + 4, lane], Q[constant.C + 5, lane]
    f_uu, f_u1, f_u2 = (
        Q[constant.FLEX, lane],
        Q[constant.FLEX + 1, lane],
        Q[constant.FLEX + 2, lane],
    )
    f_11, f_12, f_22 = (
        Q[constant.FLEX + 3, lane],
        Q[constant.FLEX + 4, lane],
        Q[constant.FLEX + 5, lane],
    )
    load = Q[constant.PIER_LOAD, lane]
    reaction = Q[constant.REACTION, lane]
    node_u = reaction * S[state.NODE_U, lane]
    node_2 = reaction * S[state.NODE_THETA2, lane]
    four = 4.0 * rate
    b_u = (
        node_u
        - load * S[state.GROUND, lane]
        - (k_uu * u + k_u1 * th1 + k_u2 * th2)
        + Q[constant.M_U, lane] * (four * vu + au)
        + (c_uu * vu + c_u1 * v1 + c_u2 * v2)
    )
    b_1 = (
        -(k_u1 * u + k_11 * th1 + k_12 * th2)
        + Q[constant.M_1, lane] * (four * v1 + a1)
        + (c_u1 * vu + c_11 * v1 + c_12 * v2)
    )
    b_2 = (
        node_2
        - (k_u2 * u + k_12 * th1 + k_22 * th2)
        + Q[constant.M_2, lane] * (four * v2 + a2)
        + (c_u2 * vu + c_12 * v1 + c_22 * v2)
    )
    z = S[state.Z, lane]
    d_1, z_new, eps, x_max, moment, _, correction, damage, a, beta, log_a, kp = advance(
        th1,
        z,
        z + S[state.Z_STEP, lane],
        S[state.EPS, lane],
        S[state.X_MAX, lane],
        S[state.DAMAGE, lane],
        S[state.DEGRADED_A, lane],
        S[state.DEGRADED_BETA, lane],
        S[state.DEGRADED_LOG, lane],
        S[state.PINCHED, lane],
        f_u1 * b_u + f_11 * b_1 + f_12 * b_2,
        f_11,
        Q[constant.K0, lane],
        Q[constant.ALPHA, lane],
        Q[constant.N, lane],
        Q[constant.ETA0, lane],
        Q[constant.BETA0, lane],
        Q[constant.RHO_EPS_M, lane],
        Q[constant.RHO_X, lane],
        Q[constant.PHI, lane],
        Q[constant.DELTA_K, lane],
        Q[constant.DELTA_F, lane],
        Q[constant.PER_SIGMA, lane],
        Q[constant.PINCH_U, lane],
        Q[constant.PER_EPS_P, lane],
        Q[constant.RHO_P, lane],
        Q[constant.PER_HINGE_MASS, lane],
        Q[constant.TOLERANCE, lane],
        Q[constant.MAX_ITERATIONS, lane],
    )
    b_1 -= moment
    d_u = f_uu * b_u + f_u1 * b_1 + f_u2 * b_2
    d_2 = f_u2 * b_u + f_12 * b_1 + f_22 * b_2

    # energy: all trapezoids, exact for this integrator
    mean_ground = S[state.GROUND, lane] - 0.5 * S[state.GROUND_SLOPE, lane]
    S[state.WORK_GROUND, lane] -= load * mean_ground * d_u
    S[state.LOST_RAYLEIGH, lane] += rate * (
        d_u * (c_uu * d_u + 2.0 * (c_u1 * d_1 + c_u2 * d_2))
        + d_1 * (c_11 * d_1 + 2.0 * c_12 * d_2)
        + c_22 * d_2 * d_2
    )
    S[state.HINGE_ENERGY, lane] += 0.5 * (S[state.MOMENT, lane] + moment) * d_1

    S[state.U, lane] = u + d_u
    S[state.THETA1, lane] = th1 + d_1
    S[state.THETA2, lane] = th2 + d_2
    S[state.U_V, lane] = new_velocity(d_u, vu, rate)
    S[state.THETA1_V, lane] = new_velocity(d_1, v1, rate)
    S[state.THETA2_V, lane] = new_velocity(d_2, v2, rate)
    S[state.U_A, lane] = new_acceleration(d_u, vu, au, rate)
    S[state.THETA1_A, lane] = new_acceleration(d_1, v1, a1, rate)
    S[state.THETA2_A, lane] = new_acceleration(d_2, v2, a2, rate)
    S[state.Z_STEP, lane] = z_new - z
    S[state.Z, lane] = z_new
    S[state.EPS, lane] = eps
    S[state.X_MAX, lane] = x_max
    S[state.MOMENT, lane] = moment
    S[state.DAMAGE, lane] = damage
    S[state.DEGRADED_A, lane] = a
    S[state.DEGRADED_BETA, lane] = beta
    S[state.DEGRADED_LOG, lane] = log_a
    S[state.PINCHED, lane] = kp
    missed = 1.0 if abs(correction) > Q[constant.TOLERANCE, lane] else 0.0
    S[state.UNCONVERGED, lane] += missed


def refresh_hinge(S: Array, Q: Array, lane: int) -> None:
    """Stage, now and then where many run abreast: degradation and pinching of the hinge as it is.

    In between they are extrapolated and kept (`boucwen.degradation_extrapolated`,
    `boucwen.pinched_stiffness_kept`).
    """
    eps = S[state.EPS, lane]
    damage = damage_index(
        eps, S[state.X_MAX, lane], Q[constant.RHO_EPS_M, lane], Q[constant.RHO_X, lane]
    )
    a, beta, log_a = degradation(
        damage,
        Q[constant.PHI, lane],
        Q[constant.DELTA_K, lane],
        Q[constant.DELTA_F, lane],
        Q[constant.N, lane],
        Q[constant.BETA0, lane],
    )
    S[state.DAMAGE, lane] = damage
    S[state.DEGRADED_A, lane] = a
    S[state.DEGRADED_BETA, lane] = beta
    S[state.DEGRADED_LOG, lane] = log_a
    S[state.PINCHED, lane] = pinched_stiffness(
        S[state.THETA1, lane],
        eps,
        Q[constant.K0, lane],
        Q[constant.RHO_P, lane],
        Q[constant.PER_SIGMA, lane],
        Q[constant.PINCH_U, lane],
        Q[constant.PER_EPS_P, lane],
    )


def track_motion(S: Array, Q: Array, lane: int) -> tuple[float, float, float, float, float, float]:
    """Position (y, z, phi) and velocity of the track's origin, from the pier's top node."""
    phi = -S[state.THETA2, lane]
    v_phi = -S[state.THETA2_V, lane]
    return (
        Q[constant.MAP_U, lane] * S[state.U, lane] + Q[constant.MAP_H, lane] * phi,
        Q[constant.MAP_E, lane] * phi,
        Q[constant.MAP_PHI, lane] * phi,
        Q[constant.MAP_U, lane] * S[state.U_V, lane] + Q[constant.MAP_H, lane] * v_phi,
        Q[constant.MAP_E, lane] * v_phi,
        Q[constant.MAP_PHI, lane] * v_phi,
    )


def place_track(S: Array, Q: Array, lane: int) -> None:
    """Stage: the track where the pier's top node holds it, before the structure moves on."""
    y, z, phi, v_y, v_z, v_phi = track_motion(S, Q, lane)
    S[state.TRACK_Y, lane] = y
    S[state.TRACK_Z, lane] = z
    S[state.TRACK_PHI, lane] = phi
    S[state.TRACK_VY, lane] = v_y
    S[state.TRACK_VZ, lane] = v_z
    S[state.TRACK_VPHI, lane] = v_phi


def orient_track(S: Array, lane: int) -> None:
    """Stage: sine and cosine of the track's roll."""
    S[state.TRACK_SIN, lane], S[state.TRACK_COS, lane] = sin_cos(S[state.TRACK_PHI, lane])


def lead_track(S: Array, Q: Array, lane: int) -> None:
    """Stage: how the track gets to where the pier's top node has moved."""
    y, z, phi, v_y, v_z, v_phi = track_motion(S, Q, lane)
    lead(S, Q, 0, y, v_y, lane)
    lead(S, Q, 1, z, v_z, lane)
    lead(S, Q, 2, phi, v_phi, lane)


def lead(S: Array, Q: Array, k: int, position: float, velocity: float, lane: int) -> None:
    """Constant acceleration that brings the track there by the end of the structure's step.

    It is Newmark's own.  The train's force on the track works on the way.
    """
    S[state.TRACK_AY + k, lane] = Q[constant.RATE, lane] * (velocity - S[state.TRACK_VY + k, lane])
    S[state.WORK_TRACK, lane] += (
        0.5
        * (S[state.TRACK_OLD + k, lane] + S[state.TRACK_FY + k, lane])
        * (position - S[state.TRACK_Y + k, lane])
    )


def move_track(S: Array, Q: Array, lane: int) -> None:
    """Stage: the track's origin at the new time, within the structure's step."""
    dt = Q[constant.DT, lane]
    move_on(S, 0, dt, lane)
    move_on(S, 1, dt, lane)
    turn = move_on(S, 2, dt, lane)
    # to the second order: the third is below 1e-13 for any roll that is no derailment's
    sine = S[state.TRACK_SIN, lane]
    cosine = S[state.TRACK_COS, lane]
    S[state.TRACK_SIN, lane] = sine + turn * (cosine - 0.5 * turn * sine)
    S[state.TRACK_COS, lane] = cosine - turn * (sine + 0.5 * turn * cosine)


def move_on(S: Array, k: int, dt: float, lane: int) -> float:
    """Position and velocity under constant acceleration; by how far it has moved."""
    v = S[state.TRACK_VY + k, lane]
    dv = dt * S[state.TRACK_AY + k, lane]
    step: float = dt * (v + 0.5 * dv)
    S[state.TRACK_Y + k, lane] += step
    S[state.TRACK_VY + k, lane] = v + dv
    return step


def hold_structure(S: Array, Q: Array, lane: int) -> None:
    """Stage in the place of `move_structure` where the track's motion is prescribed."""


def prescribed_motion(S: Array, k: int, lane: int) -> tuple[float, float, float]:
    """Position, velocity and acceleration of a prescribed track: a cubic within each frame."""
    place = S[state.TRACK_PLACE, lane]
    rate = S[state.TRACK_RATE, lane]
    row = state.TRACK_CUBIC + 4 * k
    c1, c2, c3 = S[row + 1, lane], S[row + 2, lane], S[row + 3, lane]
    return (
        S[row, lane] + place * (c1 + place * (c2 + place * c3)),
        rate * (c1 + place * (2.0 * c2 + 3.0 * place * c3)),
        rate * rate * (2.0 * c2 + 6.0 * place * c3),
    )


def place_prescribed_track(S: Array, Q: Array, lane: int) -> None:
    """Stage in the place of `place_track` where the track's motion is prescribed."""
    for k in range(3):
        position, velocity, _ = prescribed_motion(S, k, lane)
        S[state.TRACK_Y + k, lane] = position
        S[state.TRACK_VY + k, lane] = velocity


def lead_prescribed_track(S: Array, Q: Array, lane: int) -> None:
    """Stage in the place of `lead_track` where the track's motion is prescribed.

    The bridge's measures are then those of the track's origin.
    """
    S[state.TRACK_PLACE, lane] += Q[constant.SUBSTEPS, lane] / Q[constant.FRAME_STEPS, lane]
    for k in range(3):
        position, velocity, _ = prescribed_motion(S, k, lane)
        lead(S, Q, k, position, velocity, lane)
    S[state.U, lane], S[state.U_V, lane], S[state.U_A, lane] = prescribed_motion(S, 0, lane)
    phi, v_phi, _ = prescribed_motion(S, 2, lane)
    S[state.THETA2, lane] = -phi
    S[state.THETA2_V, lane] = -v_phi
