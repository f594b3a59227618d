"""Stages of the structure: N degrees of freedom, linear but for one hinge (Eq. 9).

Newmark's method asks in each step for increments dx with ``K* dx + M_hinge = b`` (see `newmark`).
The structure being linear otherwise, they are condensed on the rotation of the hinge, whose law
answers how far it turns.  A dashpot turns with the hinge: of its initial stiffness, of its tangent
at the step's begin, or of nothing (`pier.HingeDamping`).
"""

from typing import Any

import numpy as np

from railquake.march.packed import packed
from railquake.march.rows import constant, size, state
from railquake.physics.hinge import advance, refresh
from railquake.physics.newmark import beside_dashpot, new_acceleration, new_velocity

__all__ = [
    "hold_structure",
    "move_structure",
    "move_structure_with_hinge",
    "read_hinge",
    "read_hinge_parameters",
    "refresh_hinge",
    "write_hinge",
]

Array = np.ndarray[Any, np.dtype[np.float64]]


def read_hinge(rows: Array, first: int, lane: int) -> Any:
    """Slot of the hinge's law: its state."""
    raise NotImplementedError("a hinge law is chosen when a kernel is bound")


def write_hinge(rows: Array, first: int, value: Any, lane: int) -> None:
    """Slot of the hinge's law: its state."""
    raise NotImplementedError("a hinge law is chosen when a kernel is bound")


def read_hinge_parameters(rows: Array, first: int, lane: int) -> Any:
    """Slot of the hinge's law: its parameters."""
    raise NotImplementedError("a hinge law is chosen when a kernel is bound")


def move_structure(S: Array, Q: Array, lane: int) -> None:
    """Slot of the support: one step of the structure under ground and train."""
    raise NotImplementedError("a support is chosen when a kernel is bound")


def hold_structure(S: Array, Q: Array, lane: int) -> None:
    """No structure: the track's motion is prescribed."""


def move_structure_with_hinge(S: Array, Q: Array, lane: int) -> None:
    """One Newmark step of Eq. 9 under the ground and the last contact forces."""
    rate = Q[constant.RATE, lane]
    reaction = Q[constant.REACTION, lane]
    ground = S[state.GROUND, lane]
    for i in range(size.STRUCTURE):
        v = S[state.STRUCTURE_V + i, lane]
        S[state.UNBALANCED + i, lane] = (
            reaction * S[state.NODE + i, lane]
            - Q[constant.GROUND_LOAD + i, lane] * ground
            - times(Q, constant.K, S, state.STRUCTURE_X, i, lane)
            + Q[constant.MASS + i, lane] * (4.0 * rate * v + S[state.STRUCTURE_A + i, lane])
            + times(Q, constant.C, S, state.STRUCTURE_V, i, lane)
        )

    hinge = constant.FLEX + packed(size.HINGE, size.HINGE, size.STRUCTURE)
    hinge_v = S[state.STRUCTURE_V + size.HINGE, lane]
    damping = hinge_damping(S, Q, lane)
    free_step, flexibility = beside_dashpot(
        times(Q, constant.FLEX, S, state.UNBALANCED, size.HINGE, lane),
        Q[hinge, lane],
        damping,
        hinge_v,
        rate,
    )
    answer = advance(
        S[state.STRUCTURE_X + size.HINGE, lane],
        read_hinge(S, state.HINGE, lane),
        read_hinge_parameters(Q, constant.HINGE, lane),
        free_step,
        flexibility,
    )
    damping_moment = damping * new_velocity(answer.step, hinge_v, rate)
    S[state.UNBALANCED + size.HINGE, lane] -= answer.moment + damping_moment
    for i in range(size.STRUCTURE):
        S[state.STRUCTURE_STEP + i, lane] = (
            answer.step
            if i == size.HINGE
            else times(Q, constant.FLEX, S, state.UNBALANCED, i, lane)
        )

    # energy: all trapezoids, exact for this integrator
    mean_ground = ground - 0.5 * S[state.GROUND_SLOPE, lane]
    for i in range(size.STRUCTURE):
        step = S[state.STRUCTURE_STEP + i, lane]
        S[state.WORK_GROUND, lane] -= Q[constant.GROUND_LOAD + i, lane] * mean_ground * step
    mean_damping_moment = 0.5 * (S[state.DAMPING_MOMENT, lane] + damping_moment)
    S[state.LOST_RAYLEIGH, lane] += rate * damped(S, Q, lane) + mean_damping_moment * answer.step
    S[state.HINGE_ENERGY, lane] += 0.5 * (S[state.MOMENT, lane] + answer.moment) * answer.step

    for i in range(size.STRUCTURE):
        step = S[state.STRUCTURE_STEP + i, lane]
        v = S[state.STRUCTURE_V + i, lane]
        S[state.STRUCTURE_X + i, lane] += step
        S[state.STRUCTURE_V + i, lane] = new_velocity(step, v, rate)
        S[state.STRUCTURE_A + i, lane] = new_acceleration(
            step, v, S[state.STRUCTURE_A + i, lane], rate
        )
    write_hinge(S, state.HINGE, answer.state, lane)
    S[state.MOMENT, lane] = answer.moment
    S[state.TANGENT, lane] = answer.tangent
    S[state.DAMPING_MOMENT, lane] = damping_moment
    S[state.UNCONVERGED, lane] += answer.unconverged


def hinge_damping(S: Array, Q: Array, lane: int) -> float:
    """Of the hinge itself, N m s; where its moment falls as it turns, that takes nothing away."""
    tangent = max(S[state.TANGENT, lane], 0.0)
    damping: float = (
        Q[constant.DAMPING_CONSTANT, lane] + Q[constant.DAMPING_PER_TANGENT, lane] * tangent
    )
    return damping


def times(Q: Array, matrix: int, S: Array, vector: int, i: int, lane: int) -> float:
    """Row ``i`` of a symmetric matrix of the structure times a vector."""
    total = 0.0
    for j in range(size.STRUCTURE):
        total += Q[matrix + packed(i, j, size.STRUCTURE), lane] * S[vector + j, lane]
    return total


def damped(S: Array, Q: Array, lane: int) -> float:
    """dx^T C dx of the last increments dx: what damping but the hinge's takes, over the rate."""
    total = 0.0
    for i in range(size.STRUCTURE):
        step = S[state.STRUCTURE_STEP + i, lane]
        others = 0.0
        for j in range(i + 1, size.STRUCTURE):
            entry = constant.C + packed(i, j, size.STRUCTURE)
            others += Q[entry, lane] * S[state.STRUCTURE_STEP + j, lane]
        own = Q[constant.C + packed(i, i, size.STRUCTURE), lane]
        total += step * (own * step + 2.0 * others)
    return total


def refresh_hinge(S: Array, Q: Array, lane: int) -> None:
    """Now and then, where many run abreast: what the hinge's law keeps between."""
    kept = refresh(
        S[state.STRUCTURE_X + size.HINGE, lane],
        read_hinge(S, state.HINGE, lane),
        read_hinge_parameters(Q, constant.HINGE, lane),
    )
    write_hinge(S, state.HINGE, kept, lane)
