"""The coupled run: Figure 4 of the paper, step by step (see `step`), and what is measured.

A run is a sequence of *frames* of ``steps`` time steps (1 ms by default).  Peaks and energies are
taken at every step; events, low-pass filters, the test for derailment and the history once a
frame.  Within a frame the ground's acceleration is linear.
"""

import math
from typing import Any

import numpy as np

from railquake.physics import constant, state
from railquake.physics.contact import normal_force, onset_hysteresis
from railquake.physics.creep import reduction_shen_hedrick_elkins
from railquake.physics.elementary import floor_of, larger_of, sin_cos
from railquake.physics.pier import (
    lead_track,
    move_structure,
    move_track,
    orient_track,
    place_track,
    refresh_hinge,
)
from railquake.physics.profiles import (
    FIELDS,
    POSITIVE,
    Geometry,
    axis_cell,
    cubic,
    hermite_coefficients,
    zone_contact,
)
from railquake.physics.vehicle import (
    BLOCK,
    DOF_COUNT,
    accelerate_lateral,
    accelerate_vertical,
    carry,
    carry_suspension_on,
    damp,
    note_place,
    note_suspension,
    packed,
    predict_sprung,
    predict_wheelset,
    push_wheelset,
)

__all__ = ["LANES", "march", "march_abreast", "march_on_device", "step"]

Array = np.ndarray[Any, np.dtype[np.float64]]

LOOK = 2e-4  # s; twice what passes at most between two looks at flanges, see `look_at_flange`
SPARE = 1e-4  # m
# bound when a kernel is made
BOUND = 5.0  # m or rad; what is farther from where it belongs has diverged
LANES = 1  # scenarios abreast
STATE_ROWS = 1  # of a thread's own state and constants, see `march_on_device`
CONSTANT_ROWS = 1


def step(S: Array, Q: Array, geometry: Geometry, lanes: int, substeps: int) -> None:
    """One step of the coupled system (Figure 4 of the paper).

    Structure, track, contact, vehicle.  The wheelset on its rails, whose contacts are stiffest by
    far, may take several time steps while the structure and the sprung bodies take one.

    Parameters
    ----------
    S, Q : array, shape (rows, lanes)
        `state` and `constant`.
    geometry : Geometry
    lanes : int
        Scenarios abreast.
    substeps : int
        Time steps of the wheelset; with one, all go together.
    """
    bodies = DOF_COUNT // 3
    # structure, under the ground and the last contact forces
    for lane in range(lanes):
        move_ground(S, lane)
        react(S, Q, lane)
        place_track(S, Q, lane)
        orient_track(S, lane)
    for lane in range(lanes):
        move_structure(S, Q, lane)
    for lane in range(lanes):
        lead_track(S, Q, lane)
        note_place(S, lane)
    # sprung bodies
    for i in range(2 * bodies - 2):
        for lane in range(lanes):
            predict_sprung(S, Q, i, lane)
    for i in range(2 * bodies, DOF_COUNT - 1):
        for lane in range(lanes):
            predict_sprung(S, Q, i, lane)
    # wheelset on the moving track
    left_near = comes_near(S, 0, lanes)
    right_near = comes_near(S, 1, lanes)
    for n in range(substeps):
        for lane in range(lanes):
            move_track(S, Q, lane)
            predict_wheelset(S, Q, lane)
            place_wheelset(S, Q, lane)
        for lane in range(lanes):
            locate(S, Q, geometry.shift_nodes, lane)
        for lane in range(lanes):
            fetch(S, Q, geometry, lane)
        for lane in range(lanes):
            clear_forces(S, lane)
            press(S, Q, geometry, 0, 0, lane)
            press(S, Q, geometry, 1, 0, lane)
        if left_near:
            for lane in range(lanes):
                press(S, Q, geometry, 0, 1, lane)
        if right_near:
            for lane in range(lanes):
                press(S, Q, geometry, 1, 1, lane)
        if n + 1 < substeps:
            for lane in range(lanes):
                carry_suspension_on(S, lane)
        else:
            for lane in range(lanes):
                carry(S, Q, lane)
            for lane in range(lanes):
                for i in range(BLOCK):
                    accelerate_lateral(S, Q, i, lane)
            for lane in range(lanes):
                for i in range(BLOCK, DOF_COUNT):
                    accelerate_vertical(S, Q, i, lane)
            for lane in range(lanes):
                damp(S, Q, lane)
            for lane in range(lanes):
                note_suspension(S, Q, lane)
        for lane in range(lanes):
            add_up(S, Q, lane)
            push_wheelset(S, Q, lane)
            measure_contact(S, Q, lane)
    for lane in range(lanes):
        measure_structure(S, lane)


def find_contact_forces(S: Array, Q: Array, geometry: Geometry) -> None:
    """The contact stages of `step` alone, for one scenario at rest or held."""
    orient_track(S, 0)
    place_wheelset(S, Q, 0)
    locate(S, Q, geometry.shift_nodes, 0)
    fetch(S, Q, geometry, 0)
    clear_forces(S, 0)
    for side in range(2):
        for zone in range(2):
            press(S, Q, geometry, side, zone, 0)
    add_up(S, Q, 0)
    react(S, Q, 0)


def move_ground(S: Array, lane: int) -> None:
    """Stage: ground acceleration at the end of the structure's step."""
    S[state.GROUND, lane] += S[state.GROUND_SLOPE, lane]
    S[state.GROUND_Z, lane] += S[state.GROUND_Z_SLOPE, lane]


def place_wheelset(S: Array, Q: Array, lane: int) -> None:
    """Stage: wheelset relative to the track, in track axes, and its rates.

    With R turning ground axes into track axes, (Y, Z) = R (x_w - x_t) and, the track turning at
    phi_t', (Y', Z') = R (v_w - v_t) - phi_t' x (Y, Z).
    """
    y = state.VEHICLE + 2 * (DOF_COUNT // 3) - 2  # wheelset's rows; phi follows y
    z = state.VEHICLE + DOF_COUNT - 1
    sine = S[state.TRACK_SIN, lane]
    cosine = S[state.TRACK_COS, lane]
    dy = S[y, lane] - S[state.TRACK_Y, lane]
    dz = S[z, lane] - Q[constant.WHEELSET_HEIGHT, lane] - S[state.TRACK_Z, lane]
    vy = S[y + DOF_COUNT, lane] - S[state.TRACK_VY, lane]
    vz = S[z + DOF_COUNT, lane] - S[state.TRACK_VZ, lane]
    turning = S[state.TRACK_VPHI, lane]
    shift = cosine * dy + sine * dz
    height = cosine * dz - sine * dy
    roll = S[y + 1, lane] - S[state.TRACK_PHI, lane]
    S[state.ARM_Y, lane] = dy
    S[state.ARM_Z, lane] = dz
    S[state.SHIFT, lane] = shift
    S[state.HEIGHT, lane] = height
    S[state.ROLL, lane] = roll
    S[state.SHIFT_V, lane] = cosine * vy + sine * vz + turning * height
    S[state.HEIGHT_V, lane] = cosine * vz - sine * vy - turning * shift
    S[state.ROLL_V, lane] = S[y + DOF_COUNT + 1, lane] - turning
    S[state.ROLL_SIN, lane], S[state.ROLL_COS, lane] = sin_cos(roll)


def clear_forces(S: Array, lane: int) -> None:
    """Stage: nothing of what the patches will add up."""
    S[state.FORCE_PSI, lane] = 0.0
    S[state.HERTZ_ENERGY, lane] = 0.0
    S[state.IMPACT_POWER, lane] = 0.0
    S[state.CREEP_POWER, lane] = 0.0
    S[state.SPIN_POWER, lane] = 0.0
    S[state.LOAD_LEFT, lane] = 0.0
    S[state.LOAD_RIGHT, lane] = 0.0
    S[state.LATERAL_LEFT, lane] = 0.0
    S[state.LATERAL_RIGHT, lane] = 0.0


def locate(S: Array, Q: Array, shift_nodes: int, lane: int) -> None:
    """Stage: the contact table's cell for each side's (shift, roll).

    The axes are symmetric, so the left side's cell is the mirror image of the right one's.
    """
    axis = constant.SHIFT_AXIS
    j, w, rate = axis_cell(
        S[state.SHIFT, lane],
        Q[axis, lane],
        Q[axis + 1, lane],
        Q[axis + 2, lane],
        Q[axis + 3, lane],
        Q[axis + 4, lane],
        Q[axis + 5, lane],
    )
    last_j = 2.0 * Q[axis + 4, lane] + Q[axis + 5, lane] - 1.0
    axis = constant.ROLL_AXIS
    i, w_roll, roll_rate = axis_cell(
        S[state.ROLL, lane],
        Q[axis, lane],
        Q[axis + 1, lane],
        Q[axis + 2, lane],
        Q[axis + 3, lane],
        Q[axis + 4, lane],
        Q[axis + 5, lane],
    )
    last_i = 2.0 * Q[axis + 4, lane] + Q[axis + 5, lane] - 1.0
    left = state.CELL
    right = state.CELL + state.CELL_ROWS
    S[left + state.CELL_BASE, lane] = ((last_i - i) * shift_nodes + last_j - j) * (2 * FIELDS)
    S[left + state.CELL_SHIFT, lane] = 1.0 - w
    S[left + state.CELL_SHIFT_RATE, lane] = rate
    S[left + state.CELL_ROLL, lane] = 1.0 - w_roll
    S[left + state.CELL_ROLL_RATE, lane] = roll_rate
    S[right + state.CELL_BASE, lane] = (i * shift_nodes + j) * (2 * FIELDS)
    S[right + state.CELL_SHIFT, lane] = w
    S[right + state.CELL_SHIFT_RATE, lane] = rate
    S[right + state.CELL_ROLL, lane] = w_roll
    S[right + state.CELL_ROLL_RATE, lane] = roll_rate


def fetch(S: Array, Q: Array, geometry: Geometry, lane: int) -> None:
    """Stage: the polynomials of each side's cell, when a wheel has come to another cell.

    A wheel stays in its cell for many steps.
    """
    fetch_side(S, geometry, 0, lane)
    fetch_side(S, geometry, 1, lane)


def fetch_side(S: Array, geometry: Geometry, side: int, lane: int) -> None:
    """`fetch` for one side."""
    cell = state.CELL + side * state.CELL_ROWS
    base = S[cell + state.CELL_BASE, lane]
    if base != S[cell + state.CELL_HELD, lane]:
        S[cell + state.CELL_HELD, lane] = base
        width = 1.0 / S[cell + state.CELL_SHIFT_RATE, lane]
        roll_width = 1.0 / S[cell + state.CELL_ROLL_RATE, lane]
        table = geometry.table
        next_roll = (geometry.shift_nodes * 2 * FIELDS) & POSITIVE
        for zone in range(2):
            # corners: (shift, roll) = (low, low), (high, low), (low, high), (high, high)
            c00 = (int(base) & POSITIVE) + zone * FIELDS
            c10 = c00 + 2 * FIELDS
            c01 = c00 + next_roll
            c11 = c01 + 2 * FIELDS
            row = state.POLYNOMIAL + (2 * side + zone) * state.POLYNOMIAL_ROWS
            low = hermite_coefficients(
                table[c00], table[c10], width * table[c00 + 1], width * table[c10 + 1]
            )
            high = hermite_coefficients(
                table[c01], table[c11], width * table[c01 + 1], width * table[c11 + 1]
            )
            low_rise = (
                roll_width * table[c00 + 2], roll_width * (table[c10 + 2] - table[c00 + 2])
            )  # fmt: skip
            high_rise = (
                roll_width * table[c01 + 2], roll_width * (table[c11 + 2] - table[c01 + 2])
            )  # fmt: skip
            S[row, lane], S[row + 1, lane], S[row + 2, lane], S[row + 3, lane] = low
            S[row + 4, lane], S[row + 5, lane] = low_rise
            for k in range(4):
                rise = high[k] - low[k]
                d0 = low_rise[k] if k < 2 else 0.0
                d1 = high_rise[k] if k < 2 else 0.0
                S[row + 6 + k, lane] = 3.0 * rise - 2.0 * d0 - d1
                S[row + 10 + k, lane] = d0 + d1 - 2.0 * rise
            for k in range(4):
                f00 = table[c00 + 3 + k]
                f10 = table[c10 + 3 + k]
                f01 = table[c01 + 3 + k]
                f11 = table[c11 + 3 + k]
                S[row + 14 + 4 * k, lane] = f00
                S[row + 15 + 4 * k, lane] = f10 - f00
                S[row + 16 + 4 * k, lane] = f01 - f00
                S[row + 17 + 4 * k, lane] = f11 - f10 - f01 + f00


def gap_in_cell(
    S: Array, row: int, w: float, w_roll: float, lane: int
) -> tuple[float, float, float]:
    """Gap G within a cell and its derivatives by the places ``w`` (shift) and ``w_roll``.

    Cubic (Hermite) in the shift from the corners' G and dG/dY, then in the roll from these and
    dG/dpsi, the last linear in the shift.  The derivatives are those of this very interpolation,
    so that the normal force remains the gradient of the gap.
    """
    q0, r0 = cubic(w, S[row, lane], S[row + 1, lane], S[row + 2, lane], S[row + 3, lane])
    r1 = S[row + 5, lane]
    q1 = S[row + 4, lane] + w * r1
    q2, r2 = cubic(w, S[row + 6, lane], S[row + 7, lane], S[row + 8, lane], S[row + 9, lane])
    q3, r3 = cubic(w, S[row + 10, lane], S[row + 11, lane], S[row + 12, lane], S[row + 13, lane])
    gap, gap_roll = cubic(w_roll, q0, q1, q2, q3)
    return gap, r0 + w_roll * (r1 + w_roll * (r2 + w_roll * r3)), gap_roll


def blend(S: Array, row: int, w: float, w_roll: float, lane: int) -> float:
    """Bilinear interpolation within a cell."""
    return S[row, lane] + w * S[row + 1, lane] + w_roll * (S[row + 2, lane] + w * S[row + 3, lane])


def patch_at(
    S: Array, Q: Array, geometry: Geometry, side: int, zone: int, lane: int
) -> tuple[float, float, float, float, float, float, float]:
    """What `profiles.zone_contact` gives, from the polynomials of the wheel's cell."""
    cell = state.CELL + side * state.CELL_ROWS
    w = S[cell + state.CELL_SHIFT, lane]
    w_roll = S[cell + state.CELL_ROLL, lane]
    row = state.POLYNOMIAL + (2 * side + zone) * state.POLYNOMIAL_ROWS
    gap, slope, gap_psi = gap_in_cell(S, row, w, w_roll, lane)
    return (
        gap,
        slope * S[cell + state.CELL_SHIFT_RATE, lane],
        gap_psi * S[cell + state.CELL_ROLL_RATE, lane],
        blend(S, row + 14, w, w_roll, lane),
        blend(S, row + 18, w, w_roll, lane),
        blend(S, row + 22, w, w_roll, lane),
        blend(S, row + 26, w, w_roll, lane),
    )


def search_grid(
    S: Array, Q: Array, geometry: Geometry, side: int, zone: int, lane: int
) -> tuple[float, float, float, float, float, float, float]:
    """In the place of `patch_at`: the grid method itself."""
    sign = 2.0 * side - 1.0
    first = geometry.flange_points if zone == 0 else 0
    last = len(geometry.wheel_y) if zone == 0 else geometry.flange_points
    return zone_contact(
        sign * S[state.SHIFT, lane], sign * S[state.ROLL, lane], first, last, geometry
    )


def skip_locate(S: Array, Q: Array, shift_nodes: int, lane: int) -> None:
    """Stage in the place of `locate` where no table is used."""


def skip_fetch(S: Array, Q: Array, geometry: Geometry, lane: int) -> None:
    """Stage in the place of `fetch` where no table is used."""


def closing_rate(
    slope: float, gap_psi: float, shift_v: float, height_v: float, roll_v: float
) -> float:
    """Rate of the penetration Z - G(Y, psi), vertical, m/s; arguments as in `patch_forces`."""
    return height_v - slope * shift_v - gap_psi * roll_v


def patch_forces(
    penetration: float,
    slope: float,
    gap_psi: float,
    arm_z: float,
    stiffness: float,
    creep: float,
    spin: float,
    shift_v: float,
    height_v: float,
    roll_v: float,
    roll_sin: float,
    roll_cos: float,
    hysteresis: float,
    alpha_r: float,
    onset_bound: float,
    friction: float,
    inverse_speed: float,
) -> tuple[float, float, float, float, float, float, float, float]:
    """Forces of one wheel's patch on the wheelset (Eqs. 5 to 8), right-hand wheel, track axes.

    Parameters
    ----------
    penetration : float
        Z - G, vertical, m; positive in contact.
    slope, gap_psi : float
        dG/dY = tan(gamma) and dG/dpsi.
    arm_z : float
        Contact point below the wheelset's centre, m.
    stiffness, creep, spin : float
        K, f22/delta and f23/(delta^1.5 r).
    shift_v, height_v, roll_v : float
        Y', Z', psi'.
    roll_sin, roll_cos : float
    hysteresis, alpha_r, onset_bound : float
        See `contact.onset_hysteresis`.
    friction, inverse_speed : float
        mu and 1/V.

    Returns
    -------
    hysteresis : float
    Q_Y, Q_Z, Q_psi : float
        Generalised forces, N, N, N m.
    energy : float
        Stored Hertz energy, J.
    impact, creepage, spin_input : float
        Power lost to hysteresis and to creepage, and power brought in by spin, W.
    """
    cos_gamma = 1.0 / math.sqrt(1.0 + slope * slope)
    delta = max(penetration, 0.0) * cos_gamma
    rate = closing_rate(slope, gap_psi, shift_v, height_v, roll_v) * cos_gamma
    hysteresis = onset_hysteresis(penetration > 0.0, hysteresis, rate, alpha_r, onset_bound)
    normal, elastic = normal_force(delta, rate, stiffness, hysteresis)
    # the contact point's arm follows from dG/dpsi = -(arm_y + tan(gamma) arm_z)
    arm_y = -gap_psi - slope * arm_z
    sliding = cos_gamma * (shift_v - roll_v * arm_z + slope * (height_v + roll_v * arm_y))
    # angle from the axle: sin(gamma - psi)
    sine = cos_gamma * (slope * roll_cos - roll_sin)
    by_creep = -creep * delta * sliding * inverse_speed
    by_spin = -spin * delta * math.sqrt(delta) * sine
    factor = reduction_shen_hedrick_elkins(by_creep + by_spin, friction * normal)
    tangential = factor * (by_creep + by_spin)
    down = normal * cos_gamma
    across = tangential * cos_gamma
    return (
        hysteresis,
        down * slope + across,
        across * slope - down,
        down * gap_psi + across * (slope * arm_y - arm_z),
        0.4 * elastic * delta,
        (normal - elastic) * rate,
        -factor * by_creep * sliding,
        factor * by_spin * sliding,
    )


def press(S: Array, Q: Array, geometry: Geometry, side: int, zone: int, lane: int) -> None:
    """Stage: contact forces of a patch, added up for all wheels of the section."""
    gap, slope, gap_psi, rail_z, stiffness, creep, spin = patch_at(S, Q, geometry, side, zone, lane)
    bear(S, Q, side, zone, gap, slope, gap_psi, rail_z, stiffness, creep, spin, lane)


def comes_near(S: Array, side: int, lanes: int) -> bool:
    """Whether the flange of a side may touch its rail in any lane until it is looked at again."""
    nearest = 0.0
    for lane in range(lanes):
        nearest = max(nearest, S[state.NEAR + side, lane])
    return nearest > 0.0


def may_be_near(S: Array, side: int, lanes: int) -> bool:
    """In the place of `comes_near` for one scenario, which looks at every flange in every step."""
    return True


def look_again(S: Array, Q: Array, geometry: Geometry, lane: int) -> None:
    """Stage, now and then where many run abreast: how near the flanges are to their rails."""
    look_at_flange(S, Q, geometry, 0, lane)
    look_at_flange(S, Q, geometry, 1, lane)


def look_at_flange(S: Array, Q: Array, geometry: Geometry, side: int, lane: int) -> None:
    """`look_again` for one side.

    A flange that would not reach its rail within `LOOK` (and a time step) if it went on as it does,
    with `SPARE` left for what it is hurried, bears nothing until it is looked at again.
    """
    sign = 2.0 * side - 1.0
    gap, slope, gap_psi, _, _, _, _ = patch_at(S, Q, geometry, side, 1, lane)
    penetration = S[state.HEIGHT, lane] - gap
    closing = closing_rate(
        slope,
        gap_psi,
        sign * S[state.SHIFT_V, lane],
        S[state.HEIGHT_V, lane],
        sign * S[state.ROLL_V, lane],
    )
    horizon = LOOK + Q[constant.DT, lane]
    reaches = penetration + max(closing, 0.0) * horizon + SPARE > 0.0
    S[state.NEAR + side, lane] = S[state.ON_TRACK, lane] if reaches else 0.0


def press_closed(S: Array, Q: Array, geometry: Geometry, side: int, zone: int, lane: int) -> None:
    """`press` for one scenario: an open patch costs nothing."""
    gap, slope, gap_psi, rail_z, stiffness, creep, spin = patch_at(S, Q, geometry, side, zone, lane)
    if S[state.HEIGHT, lane] > gap:
        bear(S, Q, side, zone, gap, slope, gap_psi, rail_z, stiffness, creep, spin, lane)
    else:
        row = state.PATCH + (2 * side + zone) * state.PATCH_ROWS
        S[row + state.PATCH_PENETRATION, lane] = S[state.HEIGHT, lane] - gap
        S[row + state.PATCH_HYSTERESIS, lane] = 0.0


def bear(
    S: Array,
    Q: Array,
    side: int,
    zone: int,
    gap: float,
    slope: float,
    gap_psi: float,
    rail_z: float,
    stiffness: float,
    creep: float,
    spin: float,
    lane: int,
) -> None:
    """Forces of a patch whose gap and contact data are known."""
    sign = 2.0 * side - 1.0
    row = state.PATCH + (2 * side + zone) * state.PATCH_ROWS
    height = S[state.HEIGHT, lane]
    penetration = height - gap
    if zone == 1:
        penetration *= S[state.NEAR + side, lane]
    hysteresis, q_y, q_z, q_psi, stored, lost, crept, spun = patch_forces(
        penetration,
        slope,
        gap_psi,
        rail_z - height,
        stiffness,
        creep,
        spin,
        sign * S[state.SHIFT_V, lane],
        S[state.HEIGHT_V, lane],
        sign * S[state.ROLL_V, lane],
        sign * S[state.ROLL_SIN, lane],
        S[state.ROLL_COS, lane],
        S[row + state.PATCH_HYSTERESIS, lane],
        Q[constant.ALPHA_R, lane],
        Q[constant.ONSET_BOUND, lane],
        Q[constant.FRICTION, lane],
        Q[constant.INVERSE_SPEED, lane],
    )
    S[row + state.PATCH_PENETRATION, lane] = penetration
    S[row + state.PATCH_HYSTERESIS, lane] = hysteresis
    S[state.FORCE_PSI, lane] += sign * q_psi
    S[state.HERTZ_ENERGY, lane] += stored
    S[state.IMPACT_POWER, lane] += lost
    S[state.CREEP_POWER, lane] += crept
    S[state.SPIN_POWER, lane] += spun
    S[state.LOAD_LEFT + side, lane] -= q_z
    S[state.LATERAL_LEFT + side, lane] -= sign * q_y


def add_up(S: Array, Q: Array, lane: int) -> None:
    """Stage: forces and powers of all wheels of the section; the forces in ground axes, too."""
    count = Q[constant.AXLES, lane] * S[state.ON_TRACK, lane]
    S[state.LOAD_LEFT, lane] *= count
    S[state.LOAD_RIGHT, lane] *= count
    S[state.LATERAL_LEFT, lane] *= count
    S[state.LATERAL_RIGHT, lane] *= count
    S[state.FORCE_PSI, lane] *= count
    S[state.HERTZ_ENERGY, lane] *= count
    S[state.IMPACT_POWER, lane] *= count
    S[state.CREEP_POWER, lane] *= count
    S[state.SPIN_POWER, lane] *= count
    force_y = -(S[state.LATERAL_LEFT, lane] + S[state.LATERAL_RIGHT, lane])
    force_z = -(S[state.LOAD_LEFT, lane] + S[state.LOAD_RIGHT, lane])
    sine = S[state.TRACK_SIN, lane]
    cosine = S[state.TRACK_COS, lane]
    S[state.FORCE_Y, lane] = force_y
    S[state.FORCE_Z, lane] = force_z
    S[state.WHEELSET_Y, lane] = cosine * force_y - sine * force_z
    S[state.WHEELSET_Z, lane] = sine * force_y + cosine * force_z
    S[state.WHEELSET_PHI, lane] = S[state.FORCE_PSI, lane]


def react(S: Array, Q: Array, lane: int) -> None:
    """Stage: the train's forces on the track, and by it on the pier's top node.

    They are those of the last contact, one time step before; where the structure takes longer
    steps, they are carried on linearly by what is missing.
    """
    force_y = S[state.WHEELSET_Y, lane]
    force_z = S[state.WHEELSET_Z, lane]
    moment = -(
        S[state.WHEELSET_PHI, lane]
        + S[state.ARM_Y, lane] * force_z
        - S[state.ARM_Z, lane] * force_y
    )
    ahead = 1.0 - Q[constant.DT, lane] * Q[constant.RATE, lane]
    on_y = load_track(S, 0, -force_y, ahead, lane)
    on_z = load_track(S, 1, -force_z, ahead, lane)
    on_phi = load_track(S, 2, moment, ahead, lane)
    S[state.NODE_U, lane] = Q[constant.MAP_U, lane] * on_y
    S[state.NODE_THETA2, lane] = -(
        Q[constant.MAP_H, lane] * on_y
        + Q[constant.MAP_E, lane] * on_z
        + Q[constant.MAP_PHI, lane] * on_phi
    )


def load_track(S: Array, k: int, contact: float, ahead: float, lane: int) -> float:
    """A force on the track during the coming step of the structure, from the contact's."""
    force: float = contact + ahead * (contact - S[state.TRACK_CONTACT + k, lane])
    S[state.TRACK_CONTACT + k, lane] = contact
    S[state.TRACK_OLD + k, lane] = S[state.TRACK_FY + k, lane]
    S[state.TRACK_FY + k, lane] = force
    return force


def measure_structure(S: Array, lane: int) -> None:
    """Stage: peaks of the structure."""
    raise_peak(S, state.PEAK_U, S[state.U, lane], lane)
    raise_peak(S, state.PEAK_U_V, S[state.U_V, lane], lane)
    raise_peak(S, state.PEAK_U_A, S[state.U_A, lane] + S[state.GROUND, lane], lane)
    raise_peak(S, state.PEAK_THETA1, S[state.THETA1, lane], lane)
    raise_peak(S, state.PEAK_MOMENT, S[state.MOMENT, lane], lane)
    raise_peak(S, state.PEAK_THETA2, S[state.THETA2, lane], lane)


def measure_contact(S: Array, Q: Array, lane: int) -> None:
    """Stage: peaks, losses and times of wheel and rail."""
    dt = Q[constant.DT, lane]
    half = 0.5 * dt
    impact = S[state.IMPACT_POWER, lane]
    creepage = S[state.CREEP_POWER, lane]
    spin = S[state.SPIN_POWER, lane]
    S[state.LOST_IMPACT, lane] += half * (S[state.IMPACT_POWER_OLD, lane] + impact)
    S[state.LOST_CREEP, lane] += half * (S[state.CREEP_POWER_OLD, lane] + creepage)
    S[state.SPIN_INPUT, lane] += half * (S[state.SPIN_POWER_OLD, lane] + spin)
    S[state.IMPACT_POWER_OLD, lane] = impact
    S[state.CREEP_POWER_OLD, lane] = creepage
    S[state.SPIN_POWER_OLD, lane] = spin
    on = S[state.ON_TRACK, lane]
    lateral = -S[state.FORCE_Y, lane]
    load_left = S[state.LOAD_LEFT, lane]
    load_right = S[state.LOAD_RIGHT, lane]
    raise_peak(S, state.PEAK_ROLL, on * S[state.ROLL, lane], lane)
    raise_peak(S, state.PEAK_SHIFT, on * S[state.SHIFT, lane], lane)
    raise_peak(S, state.PEAK_LOAD, max(load_left, load_right), lane)
    raise_peak(S, state.PEAK_LATERAL, lateral, lane)
    left, right = wheels_off(S, lane)
    S[state.TIME_ONE_WHEEL, lane] += dt * on * max(left, right)
    S[state.TIME_DETACHED, lane] += dt * on * min(left, right)
    S[state.SUM_LATERAL, lane] += lateral
    S[state.SUM_LOAD_LEFT, lane] += load_left
    S[state.SUM_LOAD_RIGHT, lane] += load_right
    S[state.SUM_LATERAL_LEFT, lane] += S[state.LATERAL_LEFT, lane]
    S[state.SUM_LATERAL_RIGHT, lane] += S[state.LATERAL_RIGHT, lane]


def raise_peak(S: Array, row: int, value: float, lane: int) -> None:
    """Keep the largest absolute value."""
    S[row, lane] = larger_of(S[row, lane], abs(value))


def wheels_off(S: Array, lane: int) -> tuple[float, float]:
    """1 for each side (left, right) whose wheels touch their rail nowhere, else 0."""
    row = state.PATCH + state.PATCH_PENETRATION
    left = max(S[row, lane], S[row + state.PATCH_ROWS, lane])
    right = max(S[row + 2 * state.PATCH_ROWS, lane], S[row + 3 * state.PATCH_ROWS, lane])
    return 0.0 if left > 0.0 else 1.0, 0.0 if right > 0.0 else 1.0


def low_pass(S: Array, Q: Array, number: int, value: float, lane: int) -> float:
    """Second-order low-pass filter ``number`` fed with ``value``; its new output."""
    row = state.FILTER + number * state.FILTER_ROWS
    output = (
        Q[constant.FILTER_B0, lane] * value
        + Q[constant.FILTER_B1, lane] * S[row, lane]
        + Q[constant.FILTER_B2, lane] * S[row + 1, lane]
        - Q[constant.FILTER_A1, lane] * S[row + 2, lane]
        - Q[constant.FILTER_A2, lane] * S[row + 3, lane]
    )
    S[row + 1, lane] = S[row, lane]
    S[row, lane] = value
    S[row + 3, lane] = S[row + 2, lane]
    S[row + 2, lane] = output
    return output


def filter_forces(S: Array, Q: Array, steps: float, lane: int) -> None:
    """Frame stage: low-passed lateral force, wheel loads and derailment coefficient Y/Q."""
    share = 1.0 / steps
    lateral = low_pass(S, Q, 0, share * S[state.SUM_LATERAL, lane], lane)
    load_left = low_pass(S, Q, 1, share * S[state.SUM_LOAD_LEFT, lane], lane)
    load_right = low_pass(S, Q, 2, share * S[state.SUM_LOAD_RIGHT, lane], lane)
    y_left = low_pass(S, Q, 3, share * S[state.SUM_LATERAL_LEFT, lane], lane)
    y_right = low_pass(S, Q, 4, share * S[state.SUM_LATERAL_RIGHT, lane], lane)
    for k in range(5):
        S[state.SUM_LATERAL + k, lane] = 0.0
    on = S[state.ON_TRACK, lane]
    raise_peak(S, state.PEAK_LATERAL_FILTERED, on * lateral, lane)
    lowest = min(load_left, load_right)
    kept = S[state.LOWEST_LOAD, lane]
    S[state.LOWEST_LOAD, lane] = min(kept, lowest) if on > 0.0 else kept
    # Y/Q means little on a wheel that hardly bears: it is taken above a tenth of the static load
    least = 0.1 * Q[constant.STATIC_WHEEL_LOAD, lane]
    left = abs(y_left) / max(load_left, least) if load_left > least else 0.0
    right = abs(y_right) / max(load_right, least) if load_right > least else 0.0
    raise_peak(S, state.PEAK_DERAILMENT_COEFFICIENT, on * max(left, right), lane)


def watch(S: Array, Q: Array, lane: int) -> None:
    """Frame stage: events, derailment and divergence."""
    on = S[state.ON_TRACK, lane]
    shift = S[state.SHIFT, lane]
    roll = S[state.ROLL, lane]
    sine = S[state.ROLL_SIN, lane]
    cosine = S[state.ROLL_COS, lane]
    flange = state.PATCH + state.PATCH_ROWS + state.PATCH_PENETRATION
    left_off, right_off = wheels_off(S, lane)
    # flange tips in track axes
    tip_y = Q[constant.TIP_Y, lane]
    tip_z = Q[constant.TIP_Z, lane]
    right_y = shift + tip_y * cosine - tip_z * sine
    right_z = S[state.HEIGHT, lane] + tip_y * sine + tip_z * cosine
    left_y = shift - tip_y * cosine - tip_z * sine
    left_z = S[state.HEIGHT, lane] - tip_y * sine + tip_z * cosine
    clearance = max(-left_z, -right_z)
    S[state.PEAK_CLEARANCE, lane] = max(
        S[state.PEAK_CLEARANCE, lane], clearance if on > 0.0 else -1.0
    )
    rail = Q[constant.RAIL_CENTRE, lane]
    # a derailing flange passes over its rail's head, so it is above the crown when it crosses
    across = max(
        right_y - rail if right_z < 0.0 else -1.0, -left_y - rail if left_z < 0.0 else -1.0
    )
    # centre of gravity of the vehicle, from the middle of the track along the ground's horizontal
    moved = 0.0
    for k in range(DOF_COUNT // 3):
        moved += Q[constant.VEHICLE + k, lane] * S[state.VEHICLE + 2 * k, lane]
    cg = moved / Q[constant.VEHICLE_MASS, lane] - S[state.TRACK_Y, lane]
    # the lower wheel's contact is near the running circle of its rail
    beyond = abs(cg) - rail
    holds_flange = max(S[flange, lane], S[flange + 2 * state.PATCH_ROWS, lane]) > 0.0
    holds_uplift = max(left_off, right_off) > 0.0
    holds_onset = abs(roll) >= Q[constant.REFERENCE_ROLL, lane]
    holds_over = clearance > 0.0
    holds_derailed = across > 0.0 or abs(shift) >= Q[constant.SHIFT_LIMIT, lane]
    holds_overturned = abs(roll) >= Q[constant.ROLL_LIMIT, lane] or (beyond > 0.0 and holds_onset)
    flags = S[state.FLAGS, lane]
    time = S[state.TIME, lane]
    was_up = floor_of(flags * 0.5) - 2.0 * floor_of(flags * 0.25)
    now_up = on if holds_uplift else 0.0
    S[state.UPLIFTS, lane] += now_up * (1.0 - was_up)
    S[state.UPLIFT_END, lane] = time if was_up * (1.0 - now_up) > 0.0 else S[state.UPLIFT_END, lane]
    sum_of_flags = note(S, state.FLANGE_CONTACT, holds_flange, on, time, lane)
    sum_of_flags += note(S, state.UPLIFT, holds_uplift, on, time, lane)
    sum_of_flags += note(S, state.ONSET, holds_onset, on, time, lane)
    sum_of_flags += note(S, state.FLANGE_OVER, holds_over, on, time, lane)
    sum_of_flags += note(S, state.DERAILED, holds_derailed, on, time, lane)
    sum_of_flags += note(S, state.OVERTURNED, holds_overturned, on, time, lane)
    S[state.FLAGS, lane] = sum_of_flags
    # NaN fails every comparison, so it counts as diverged
    plausible = (
        abs(S[state.U, lane]) < BOUND
        and abs(S[state.THETA2, lane]) < BOUND
        and abs(shift) < BOUND
        and abs(roll) < BOUND
        and abs(S[state.HEIGHT, lane] + Q[constant.WHEELSET_HEIGHT, lane]) < BOUND
    )
    S[state.DIVERGED, lane] = S[state.DIVERGED, lane] if plausible else 1.0
    S[state.LEAVING, lane] = on if (holds_derailed or holds_overturned) else 0.0


def note(S: Array, event: int, holds: bool, on: float, time: float, lane: int) -> float:
    """Note when an event first held; its flag, 2^event, if it holds now."""
    first = S[state.FIRST_TIME + event, lane]
    holds_now = holds and on > 0.0
    S[state.FIRST_TIME + event, lane] = time if (holds_now and first < 0.0) else first
    return 2.0**event if holds_now else 0.0


def vehicle_energy(S: Array, Q: Array, lane: int) -> float:
    """Kinetic and elastic energy of the vehicle now, J."""
    bodies = DOF_COUNT // 3
    energy = 0.0
    for i in range(DOF_COUNT):
        x = S[state.VEHICLE + i, lane]
        v = S[state.VEHICLE + DOF_COUNT + i, lane]
        force = 0.0
        for j in range(DOF_COUNT):
            force += (
                Q[constant.VEHICLE + bodies + DOF_COUNT + packed(i, j, DOF_COUNT), lane]
                * S[state.VEHICLE + j, lane]
            )
        energy += 0.5 * (x * force + v * v / Q[constant.VEHICLE + bodies + i, lane])
    return energy


def release(S: Array, Q: Array, lane: int) -> None:
    """Frame stage: take a derailed vehicle out of the model, with its energy on record.

    From then on it stands still and pushes no more; the structure runs on alone.
    """
    leaving = S[state.LEAVING, lane]
    staying = 1.0 - leaving
    S[state.VEHICLE_ENERGY, lane] += leaving * vehicle_energy(S, Q, lane)
    S[state.HERTZ_LEFT, lane] += leaving * S[state.HERTZ_ENERGY, lane]
    S[state.ON_TRACK, lane] *= staying
    for i in range(DOF_COUNT, 4 * DOF_COUNT):
        S[state.VEHICLE + i, lane] *= staying
    for k in range(state.PATCHES_END, state.FORCES_END):
        S[k, lane] *= staying
    S[state.DASHPOT_POWER, lane] *= staying


def begin_frame(S: Array, Q: Array, drive: Array, frame: int, lane: int) -> None:
    """Frame stage: what drives the run during this frame."""
    shake(S, Q, drive, frame, lane)


def shake(S: Array, Q: Array, drive: Array, frame: int, lane: int) -> None:
    """Frame stage: ground acceleration at the frame's start; its change per structure's step."""
    steps = Q[constant.FRAME_STEPS, lane] / Q[constant.SUBSTEPS, lane]
    S[state.GROUND, lane] = drive[frame, 0]
    S[state.GROUND_Z, lane] = drive[frame, 1]
    S[state.GROUND_SLOPE, lane] = (drive[frame + 1, 0] - drive[frame, 0]) / steps
    S[state.GROUND_Z_SLOPE, lane] = (drive[frame + 1, 1] - drive[frame, 1]) / steps


def begin_frame_on_track(S: Array, Q: Array, drive: Array, frame: int, lane: int) -> None:
    """Frame stage in the place of `begin_frame`: the cubics of a prescribed track as well.

    Columns 2 to 7 of ``drive`` are y, y', z, z', phi, phi' of the track at the frames' ends.
    """
    shake(S, Q, drive, frame, lane)
    length = Q[constant.FRAME_STEPS, lane] * Q[constant.DT, lane]
    S[state.TRACK_PLACE, lane] = 0.0
    S[state.TRACK_RATE, lane] = 1.0 / length
    for k in range(3):
        row = state.TRACK_CUBIC + 4 * k
        d0 = length * drive[frame, 3 + 2 * k]
        d1 = length * drive[frame + 1, 3 + 2 * k]
        rise = drive[frame + 1, 2 + 2 * k] - drive[frame, 2 + 2 * k]
        S[row, lane] = drive[frame, 2 + 2 * k]
        S[row + 1, lane] = d0
        S[row + 2, lane] = 3.0 * rise - 2.0 * d0 - d1
        S[row + 3, lane] = d0 + d1 - 2.0 * rise


def march(
    state_in: Array,
    constants: Array,
    geometry: Geometry,
    drive: Array,
    first_frame: int,
    frames: int,
    rows: Array,
    history: Array,
) -> int:
    """Run ``frames`` frames of one scenario and note each frame's state.

    A run that diverges stops at the end of that frame.

    Parameters
    ----------
    state_in : array, shape (state rows, 1)
        State at the start; holds the state at the end on return.
    constants : array, shape (constant rows, 1)
    geometry : Geometry
    drive : array, shape (all frames + 1, 2 or 8)
        Ground acceleration, lateral and vertical (down), at the frames' ends, m/s2, and the
        motion of a prescribed track (see `begin_frame_on_track`).
    first_frame : int
        Number of the first of these frames in ``drive`` and ``history``.
    frames : int
    rows : array of int, shape (channels,)
        State rows to keep.
    history : array, shape (all frames + 1, channels)
        Row k is the state at the end of frame k (row 0, the start, is not written).

    Returns
    -------
    int
        Frames that it ran.
    """
    S = np.empty((state_in.shape[0], LANES))
    Q = np.empty((constants.shape[0], LANES))
    S[:, :] = state_in
    Q[:, :] = constants
    steps = int(Q[constant.FRAME_STEPS, 0])
    substeps = int(Q[constant.SUBSTEPS, 0])
    frame = first_frame
    end = first_frame + frames
    while frame < end:
        begin_frame(S, Q, drive, frame, 0)
        for _ in range(steps // substeps):
            step(S, Q, geometry, LANES, substeps)
        frame += 1
        S[state.TIME, 0] = frame * steps * Q[constant.DT, 0]
        filter_forces(S, Q, steps, 0)
        watch(S, Q, 0)
        for k in range(len(rows)):
            history[frame, k] = S[rows[k], 0]
        if S[state.LEAVING, 0] > 0.0:
            release(S, Q, 0)
        if S[state.DIVERGED, 0] > 0.0:
            end = frame
    state_in[:, :] = S
    return frame - first_frame


def march_abreast(
    state_in: Array,
    constants: Array,
    geometry: Geometry,
    drive: Array,
    first: Array,
    stride: Array,
    done: Array,
    frames: int,
    lanes: int,
    refresh: int,
) -> int:
    """Run ``frames`` frames of several scenarios in lockstep, one to a lane.

    Every lane takes the same path through the same instructions: what it gives does not depend on
    its neighbours.  If one diverges, all stop at the end of that frame.

    Parameters
    ----------
    state_in, constants : array, shape (rows, LANES)
        As in `march`; the frame's number of steps must be the same in all lanes.
    geometry : Geometry
    drive : array, shape (any, 2 or 8)
        Drives of all lanes, one after the other.
    first, stride : array of int, shape (LANES,)
        Row of ``drive`` at which each lane's first frame begins, and rows to the next frame (0
        holds an idle lane where it is).
    done : array of int, shape (LANES,)
        Frames that each lane has behind it.
    frames, lanes : int
        ``lanes`` is LANES; as an argument it keeps the compiler from unrolling the loops.
    refresh : int
        Steps between two evaluations of the hinge's degradation, and between two looks at flanges
        that are far from their rails.

    Returns
    -------
    int
        Frames that they ran.
    """
    S = np.empty((state_in.shape[0], LANES))
    Q = np.empty((constants.shape[0], LANES))
    S[:, :] = state_in
    Q[:, :] = constants
    steps = int(Q[constant.FRAME_STEPS, 0])
    substeps = int(Q[constant.SUBSTEPS, 0])
    frame = 0
    end = frames
    while frame < end:
        for lane in range(lanes):
            begin_frame(S, Q, drive, first[lane] + frame * stride[lane], lane)
        for n in range(steps // substeps):
            if n % refresh == 0:
                for lane in range(lanes):
                    refresh_hinge(S, Q, lane)
                for lane in range(lanes):
                    look_again(S, Q, geometry, lane)
            step(S, Q, geometry, lanes, substeps)
        frame += 1
        for lane in range(lanes):
            S[state.TIME, lane] = (done[lane] + frame) * steps * Q[constant.DT, lane]
        for lane in range(lanes):
            filter_forces(S, Q, steps, lane)
        for lane in range(lanes):
            watch(S, Q, lane)
        for lane in range(lanes):
            if S[state.LEAVING, lane] > 0.0:
                release(S, Q, lane)
        for lane in range(lanes):
            if S[state.DIVERGED, lane] > 0.0:
                end = frame
    state_in[:, :] = S
    return frame


def thread_number() -> int:
    """Number of this thread among all that run at once; bound to the device's own."""
    return 0


def own_rows(rows: int) -> Array:
    """Memory that belongs to this thread alone; bound to the device's own."""
    return np.empty((rows, 1))


def march_on_device(
    states: Array,
    constants: Array,
    geometry: Geometry,
    drive: Array,
    first: Array,
    done: Array,
    frames: Array,
    refresh: int,
) -> None:
    """Run some frames of many scenarios, each by a thread of its own.

    A lane that has diverged stops at the end of that frame.

    Parameters
    ----------
    states : array, shape (lanes, state rows)
        State of each lane, in and out; a lane's rows lie together, for the host's sake.
    constants : array, shape (lanes, constant rows)
    geometry : Geometry
    drive : array, shape (any, 2 or 8)
        Drives of all lanes, one after the other; lanes may share one.
    first : array of int, shape (lanes,)
        Row of ``drive`` at which each lane's motion begins.
    done : array of int, shape (lanes,)
        Frames that each lane has behind it, in and out.
    frames : array of int, shape (lanes,)
        Frames to run now; 0 for an idle lane.
    refresh : int
        As in `march_abreast`.
    """
    column = thread_number()
    count = frames[column] if column < len(frames) else 0
    if count > 0:
        S = own_rows(STATE_ROWS)
        Q = own_rows(CONSTANT_ROWS)
        for row in range(STATE_ROWS):
            S[row, 0] = states[column, row]
        for row in range(CONSTANT_ROWS):
            Q[row, 0] = constants[column, row]
        steps = int(Q[constant.FRAME_STEPS, 0])
        substeps = int(Q[constant.SUBSTEPS, 0])
        frame = done[column]
        end = frame + count
        while frame < end:
            begin_frame(S, Q, drive, first[column] + frame, 0)
            for n in range(steps // substeps):
                if n % refresh == 0:
                    refresh_hinge(S, Q, 0)
                    look_again(S, Q, geometry, 0)
                step(S, Q, geometry, LANES, substeps)
            frame += 1
            S[state.TIME, 0] = frame * steps * Q[constant.DT, 0]
            filter_forces(S, Q, steps, 0)
            watch(S, Q, 0)
            if S[state.LEAVING, 0] > 0.0:
                release(S, Q, 0)
            if S[state.DIVERGED, 0] > 0.0:
                end = frame
        done[column] = frame
        for row in range(STATE_ROWS):
            states[column, row] = S[row, 0]
