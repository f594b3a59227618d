"""Stages of the vehicle's bodies on their springs (Eq. 1), marched by Zhai's method (Eqs. 2, 3)."""

from typing import Any

import numpy as np

from railquake.march.packed import packed
from railquake.march.packing import reader
from railquake.march.rows import constant, size, state
from railquake.physics.energy import kinetic_and_elastic
from railquake.physics.joint import Tie
from railquake.physics.suspension import lateral_travel
from railquake.physics.vehicle import free_acceleration
from railquake.physics.zhai import predict_displacement, predict_velocity

__all__ = [
    "accelerate_free",
    "accelerate_linear",
    "linear_energy",
    "linear_travel",
    "lose_to_dashpots",
    "predict",
    "predict_sprung",
    "read_tie",
    "stage_travel",
    "vehicle_energy",
    "work_on_bodies",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

read_tie = reader(Tie)


def predict_sprung(S: Array, Q: Array, i: int, lane: int) -> None:
    """A sprung body's degree of freedom ``i`` at the end of the structure's step."""
    predict(S, Q, i, Q[constant.SUBSTEPS, lane] * Q[constant.DT, lane], lane)


def predict(S: Array, Q: Array, i: int, dt: float, lane: int) -> None:
    """Displacement and velocity of degree of freedom ``i`` a time ``dt`` later (Zhai)."""
    v = S[state.VEHICLE_V + i, lane]
    a = S[state.VEHICLE_A + i, lane]
    a_before = S[state.VEHICLE_A_OLD + i, lane]
    on = S[state.ON_TRACK, lane]
    dx = on * predict_displacement(v, a, a_before, dt, Q[constant.ZHAI_PSI, lane])
    dv = on * predict_velocity(a, a_before, dt, Q[constant.ZHAI_PHI, lane])
    S[state.VEHICLE_X + i, lane] += dx
    S[state.VEHICLE_V + i, lane] += dv
    S[state.VEHICLE_A_OLD + i, lane] = a
    S[state.VEHICLE_STEP + i, lane] = dx


def work_on_bodies(S: Array, Q: Array, lane: int) -> None:
    """Work of the effective ground forces and of gravity on the moving bodies."""
    lateral = 0.0
    vertical = 0.0
    for k in range(size.BODIES - 1):
        mass = Q[constant.BODY_MASS + k, lane]
        lateral += mass * S[state.VEHICLE_STEP + 2 * k, lane]
        vertical += mass * S[state.VEHICLE_STEP + 2 * size.BODIES + k, lane]
    # the wheelset, the last body, has taken several steps
    mass = Q[constant.BODY_MASS + size.BODIES - 1, lane]
    y = S[state.VEHICLE_X + size.WHEELSET_Y, lane]
    z = S[state.VEHICLE_X + size.WHEELSET_Z, lane]
    lateral += mass * (y - S[state.WHEELSET_FROM_Y, lane])
    vertical += mass * (z - S[state.WHEELSET_FROM_Z, lane])
    # the ground's acceleration has already moved on; its mean over the step does the work
    mean_y = S[state.GROUND, lane] - 0.5 * S[state.GROUND_SLOPE, lane]
    mean_z = S[state.GROUND_Z, lane] - 0.5 * S[state.GROUND_Z_SLOPE, lane]
    S[state.WORK_GROUND, lane] -= lateral * mean_y + vertical * mean_z
    S[state.WORK_GRAVITY, lane] += vertical * Q[constant.GRAVITY, lane]
    # what `accelerate` will add up
    S[state.DASHPOT_POWER_OLD, lane] = S[state.DASHPOT_POWER, lane]
    S[state.DASHPOT_POWER, lane] = 0.0


def accelerate_free(S: Array, Q: Array, lanes: int) -> None:
    """Slot of the vehicle: accelerations of all bodies, contact forces left out."""
    raise NotImplementedError("a vehicle's kinematics are chosen when a kernel is bound")


def vehicle_energy(S: Array, Q: Array, lane: int) -> float:
    """Slot of the vehicle: its kinetic and elastic energy now, J."""
    raise NotImplementedError("a vehicle's kinematics are chosen when a kernel is bound")


def stage_travel(S: Array, Q: Array, stage: int, lane: int) -> float:
    """Slot of the vehicle: lateral travel of a stage of its suspension, m.

    Of the upper body's point at the level of the springs against the lower one's.
    """
    raise NotImplementedError("a vehicle's kinematics are chosen when a kernel is bound")


def accelerate_linear(S: Array, Q: Array, lanes: int) -> None:
    """Eq. 1: rows that are coupled to each other only, lateral and roll first."""
    for lane in range(lanes):
        for i in range(size.LATERAL):
            accelerate_lateral(S, Q, i, lane)
    for lane in range(lanes):
        for i in range(size.LATERAL, size.DOFS):
            accelerate_vertical(S, Q, i, lane)


def accelerate_lateral(S: Array, Q: Array, i: int, lane: int) -> None:
    """Row ``i`` of Eq. 1 in the first block, contact forces left out."""
    accelerate(S, Q, i, 0, size.LATERAL, lane)


def accelerate_vertical(S: Array, Q: Array, i: int, lane: int) -> None:
    """Row ``i`` of Eq. 1 in the second block, contact forces left out."""
    accelerate(S, Q, i, size.LATERAL, size.DOFS, lane)


def accelerate(S: Array, Q: Array, i: int, first: int, last: int, lane: int) -> None:
    """Row ``i`` of Eq. 1, coupled to ``first <= j < last``, contact forces left out."""
    elastic = 0.0
    viscous = 0.0
    for j in range(first, last):
        entry = packed(i, j, size.DOFS)
        elastic += Q[constant.STIFFNESS + entry, lane] * S[state.VEHICLE_X + j, lane]
        viscous += Q[constant.DAMPING + entry, lane] * S[state.VEHICLE_V + j, lane]
    is_y = 1.0 if i < 2 * size.BODIES and (i & 1) == 0 else 0.0
    is_z = 1.0 if i >= 2 * size.BODIES else 0.0
    S[state.DASHPOT_POWER, lane] += viscous * S[state.VEHICLE_V + i, lane]
    S[state.VEHICLE_A + i, lane] = free_acceleration(
        is_y,
        is_z,
        (S[state.GROUND, lane], S[state.GROUND_Z, lane]),
        Q[constant.GRAVITY, lane],
        Q[constant.INVERSE_MASS + i, lane] * (elastic + viscous),
    )


def lose_to_dashpots(S: Array, Q: Array, lane: int) -> None:
    """Energy lost to the dashpots during the step of structure and sprung bodies."""
    S[state.LOST_DASHPOTS, lane] += (
        0.5
        * Q[constant.SUBSTEPS, lane]
        * Q[constant.DT, lane]
        * (S[state.DASHPOT_POWER_OLD, lane] + S[state.DASHPOT_POWER, lane])
    )


def linear_energy(S: Array, Q: Array, lane: int) -> float:
    """Kinetic and elastic energy of a vehicle with the matrices of Eq. 1, J."""
    energy = 0.0
    for i in range(size.DOFS):
        force = 0.0
        for j in range(size.DOFS):
            entry = constant.STIFFNESS + packed(i, j, size.DOFS)
            force += Q[entry, lane] * S[state.VEHICLE_X + j, lane]
        energy += kinetic_and_elastic(
            S[state.VEHICLE_X + i, lane],
            S[state.VEHICLE_V + i, lane],
            force,
            Q[constant.INVERSE_MASS + i, lane],
        )
    return energy


def linear_travel(S: Array, Q: Array, stage: int, lane: int) -> float:
    """Lateral travel of a stage of a vehicle with the matrices of Eq. 1, m."""
    upper = state.VEHICLE_X + 2 * int(Q[constant.STAGE_UPPER + stage, lane])
    lower = state.VEHICLE_X + 2 * int(Q[constant.STAGE_LOWER + stage, lane])
    return lateral_travel(
        (S[upper, lane], S[upper + 1, lane]),
        (S[lower, lane], S[lower + 1, lane]),
        read_tie(Q, constant.STAGE_TIES + size.TIE_FIELDS * stage, lane),
    )
