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
from railquake.physics.newmark import new_acceleration, new_velocity

__all__ = [
    "follow_track",
    "geometric_stiffness",
    "hold_structure",
    "move_structure",
    "move_track",
    "natural_frequencies",
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


def move_track(S: Array, Q: Array, lane: int) -> None:
    """Stage: position and velocity of the track's origin from the pier's top node."""
    phi = -S[state.THETA2, lane]
    v_phi = -S[state.THETA2_V, lane]
    y = Q[constant.MAP_U, lane] * S[state.U, lane] + Q[constant.MAP_H, lane] * phi
    z = Q[constant.MAP_E, lane] * phi
    S[state.TRACK_STEP_Y, lane] = y - S[state.TRACK_Y, lane]
    S[state.TRACK_STEP_Z, lane] = z - S[state.TRACK_Z, lane]
    S[state.TRACK_STEP_PHI, lane] = Q[constant.MAP_PHI, lane] * phi - S[state.TRACK_PHI, lane]
    S[state.TRACK_Y, lane] = y
    S[state.TRACK_Z, lane] = z
    S[state.TRACK_PHI, lane] = Q[constant.MAP_PHI, lane] * phi
    S[state.TRACK_VY, lane] = (
        Q[constant.MAP_U, lane] * S[state.U_V, lane] + Q[constant.MAP_H, lane] * v_phi
    )
    S[state.TRACK_VZ, lane] = Q[constant.MAP_E, lane] * v_phi
    S[state.TRACK_VPHI, lane] = Q[constant.MAP_PHI, lane] * v_phi


def hold_structure(S: Array, Q: Array, lane: int) -> None:
    """Stage in the place of `move_structure` where the track's motion is prescribed."""


def follow_track(S: Array, Q: Array, lane: int) -> None:
    """Stage in the place of `move_track`: the prescribed motion, cubic within a frame.

    The bridge's measures are then those of the track's origin.
    """
    S[state.TRACK_PLACE, lane] += 1.0 / Q[constant.FRAME_STEPS, lane]
    place = S[state.TRACK_PLACE, lane]
    rate = S[state.TRACK_RATE, lane]
    for k in range(3):
        row = state.TRACK_CUBIC + 4 * k
        c1, c2, c3 = S[row + 1, lane], S[row + 2, lane], S[row + 3, lane]
        position = S[row, lane] + place * (c1 + place * (c2 + place * c3))
        S[state.TRACK_STEP_Y + k, lane] = position - S[state.TRACK_Y + k, lane]
        S[state.TRACK_Y + k, lane] = position
        S[state.TRACK_VY + k, lane] = rate * (c1 + place * (2.0 * c2 + 3.0 * place * c3))
    row = state.TRACK_CUBIC
    S[state.U, lane] = S[state.TRACK_Y, lane]
    S[state.U_V, lane] = S[state.TRACK_VY, lane]
    S[state.U_A, lane] = rate * rate * (2.0 * S[row + 2, lane] + 6.0 * place * S[row + 3, lane])
    S[state.THETA2, lane] = -S[state.TRACK_PHI, lane]
    S[state.THETA2_V, lane] = -S[state.TRACK_VPHI, lane]
