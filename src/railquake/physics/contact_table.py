"""The grid method's results in a table over a wheel's displacement and roll, and how it is read.

For given lateral shift Y and roll psi of the wheelset the place of each zone's smallest gap, its
angle and curvatures do not depend on the height (see `profiles`), so they are found once, by the
grid method, at the nodes of a table: fine where a wheel runs, coarse where it has left the rail.

A wheel that bears while the other is lifted stays on its rail though the wheelset's centre moves
far to the side, so the table is one over the wheel's *own* displacement u on its rail, and the
roll.  With b half the contact spacing and r0 the nominal radius, the running circle's lowest point
lies from the wheelset's centre at ::

    reach = b cos(psi) - r0 sin(psi)          drop = b sin(psi) + r0 cos(psi)

    u = Y + reach - b          H(u, psi) = G(Y, psi) + drop

H, the gap but for how the wheelset's roll lifts and lowers that point, changes little with psi.
Within a cell H is a cubic in both, made from the nodes' H, dH/du and dH/dpsi.  With d drop/d psi =
reach and d reach/d psi = -drop ::

    dG/dY = dH/du          dG/dpsi = dH/dpsi - drop dH/du - reach

are the derivatives of this very interpolation: the normal force remains the gradient of the gap.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from railquake.physics.elementary import floor_of
from railquake.physics.profiles import (
    Geometry,
    Patch,
    cubic,
    hermite_coefficients,
    zone_contact,
)

__all__ = [
    "FIELDS",
    "Axis",
    "AxisCells",
    "Polynomials",
    "RunningCircle",
    "RunningPoint",
    "axis_cell",
    "axis_cells",
    "axis_nodes",
    "cell_polynomials",
    "fill_table",
    "patch_in_cell",
    "running_point",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

# Of one zone at one node of the table, in the order of `profiles.Patch`.
FIELDS = len(Patch._fields)


class Axis(NamedTuple):
    """A table axis: evenly spaced finely within +-fine, coarsely beyond up to +-end."""

    fine: float
    fine_step: float
    coarse_step: float
    end: float


def axis_nodes(axis: Axis) -> Array:
    """Nodes of the axis, from -end to +end."""
    half = round((axis.end - axis.fine) / axis.coarse_step)
    inner = round(2.0 * axis.fine / axis.fine_step)
    left = -axis.end + axis.coarse_step * np.arange(half)
    middle = -axis.fine + axis.fine_step * np.arange(inner)
    right = axis.fine + axis.coarse_step * np.arange(half + 1)
    return np.concatenate([left, middle, right])


class AxisCells(NamedTuple):
    """What `axis_cell` needs of an `Axis`."""

    fine: float
    end: float
    fine_rate: float  # cells per unit
    coarse_rate: float
    coarse_cells: float  # on each side
    inner_cells: float


def axis_cells(axis: Axis) -> AxisCells:
    """Numbers of an axis's cells."""
    return AxisCells(
        axis.fine,
        axis.end,
        1.0 / axis.fine_step,
        1.0 / axis.coarse_step,
        float(round((axis.end - axis.fine) / axis.coarse_step)),
        float(round(2.0 * axis.fine / axis.fine_step)),
    )


def axis_cell(x: float, axis: AxisCells) -> tuple[float, float, float]:
    """Cell of x on an `Axis`: number of its left node, place in the cell (0 to 1), cells per unit.

    Beyond the ends x is held at the end.
    """
    bounded = min(max(x, -axis.end), axis.end)
    inside = abs(bounded) < axis.fine
    right = bounded >= axis.fine
    rate = axis.fine_rate if inside else axis.coarse_rate
    origin = -axis.fine if inside else (axis.fine if right else -axis.end)
    beyond = axis.coarse_cells + axis.inner_cells if right else 0.0
    first = axis.coarse_cells if inside else beyond
    cells = axis.inner_cells if inside else axis.coarse_cells
    place = (bounded - origin) * rate
    cell = min(max(floor_of(place), 0.0), cells - 1.0)
    return first + cell, place - cell, rate


class RunningCircle(NamedTuple):
    """Where a wheel of the table rolls as drawn."""

    half_spacing: float  # b, half the contact spacing, m
    radius: float  # r0, m


class RunningPoint(NamedTuple):
    """The running circle's lowest point as drawn, from the wheelset's centre in track axes, m."""

    reach: float  # outward
    drop: float  # down


def running_point(sine: float, cosine: float, circle: RunningCircle) -> RunningPoint:
    """Of a right-hand wheel whose wheelset has turned by an angle of that sine and cosine."""
    b, r0 = circle.half_spacing, circle.radius
    return RunningPoint(b * cosine - r0 * sine, b * sine + r0 * cosine)


class Polynomials(NamedTuple):
    """One zone's polynomials within a cell, in the places w (displacement) and w_roll of 0 to 1.

    The gap H is a polynomial of w_roll whose coefficients are polynomials of w: ``gap_ij`` goes
    with w_roll^i w^j.  The rest is bilinear, ``(1, w, w_roll, w w_roll)``.
    """

    gap_00: float
    gap_01: float
    gap_02: float
    gap_03: float
    gap_10: float
    gap_11: float
    gap_20: float
    gap_21: float
    gap_22: float
    gap_23: float
    gap_30: float
    gap_31: float
    gap_32: float
    gap_33: float
    rail_z: float
    rail_z_1: float
    rail_z_2: float
    rail_z_3: float
    stiffness: float
    stiffness_1: float
    stiffness_2: float
    stiffness_3: float
    along: float
    along_1: float
    along_2: float
    along_3: float
    creep: float
    creep_1: float
    creep_2: float
    creep_3: float
    spin: float
    spin_1: float
    spin_2: float
    spin_3: float
    log_ratio: float
    log_ratio_1: float
    log_ratio_2: float
    log_ratio_3: float


def cell_polynomials(
    corner: int, next_roll: int, width: float, roll_width: float, table: Array
) -> Polynomials:
    """Polynomials of one zone in one cell.

    Parameters
    ----------
    corner : int
        First number in the table of the zone at the cell's corner of least displacement and roll.
    next_roll : int
        Numbers from there to the corner of the same displacement and the next roll.
    width, roll_width : float
        Of the cell, m and rad.
    table : array
        See `fill_table`.
    """
    # corners: (displacement, roll) = (low, low), (high, low), (low, high), (high, high)
    c00 = corner
    c10 = c00 + 2 * FIELDS
    c01 = c00 + next_roll
    c11 = c01 + 2 * FIELDS
    low = hermite_coefficients(
        table[c00], table[c10], width * table[c00 + 1], width * table[c10 + 1]
    )
    high = hermite_coefficients(
        table[c01], table[c11], width * table[c01 + 1], width * table[c11 + 1]
    )
    low_0 = roll_width * table[c00 + 2]
    low_1 = roll_width * (table[c10 + 2] - table[c00 + 2])
    high_0 = roll_width * table[c01 + 2]
    high_1 = roll_width * (table[c11 + 2] - table[c01 + 2])
    gap_20, gap_30 = climb(low[0], high[0], low_0, high_0)
    gap_21, gap_31 = climb(low[1], high[1], low_1, high_1)
    gap_22, gap_32 = climb(low[2], high[2], 0.0, 0.0)
    gap_23, gap_33 = climb(low[3], high[3], 0.0, 0.0)
    z_0, z_1, z_2, z_3 = bilinear(table[c00 + 3], table[c10 + 3], table[c01 + 3], table[c11 + 3])
    k_0, k_1, k_2, k_3 = bilinear(table[c00 + 4], table[c10 + 4], table[c01 + 4], table[c11 + 4])
    a_0, a_1, a_2, a_3 = bilinear(table[c00 + 5], table[c10 + 5], table[c01 + 5], table[c11 + 5])
    f_0, f_1, f_2, f_3 = bilinear(table[c00 + 6], table[c10 + 6], table[c01 + 6], table[c11 + 6])
    s_0, s_1, s_2, s_3 = bilinear(table[c00 + 7], table[c10 + 7], table[c01 + 7], table[c11 + 7])
    r_0, r_1, r_2, r_3 = bilinear(table[c00 + 8], table[c10 + 8], table[c01 + 8], table[c11 + 8])
    return Polynomials(
        low[0], low[1], low[2], low[3], low_0, low_1,
        gap_20, gap_21, gap_22, gap_23, gap_30, gap_31, gap_32, gap_33,
        z_0, z_1, z_2, z_3, k_0, k_1, k_2, k_3, a_0, a_1, a_2, a_3,
        f_0, f_1, f_2, f_3, s_0, s_1, s_2, s_3, r_0, r_1, r_2, r_3,
    )  # fmt: skip


def climb(low: float, high: float, d0: float, d1: float) -> tuple[float, float]:
    """Second and third coefficient of the cubic from ``low`` to ``high`` with those slopes."""
    rise = high - low
    return 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise


def bilinear(f00: float, f10: float, f01: float, f11: float) -> tuple[float, float, float, float]:
    """Coefficients of 1, w, w_roll and w w_roll from the corners' values."""
    return f00, f10 - f00, f01 - f00, f11 - f10 - f01 + f00


def blend(w: float, w_roll: float, c0: float, c1: float, c2: float, c3: float) -> float:
    """Bilinear interpolation within a cell."""
    return c0 + w * c1 + w_roll * (c2 + w * c3)


def gap_in_cell(cell: Polynomials, w: float, w_roll: float) -> tuple[float, float, float]:
    """Gap H within a cell and its derivatives by the places ``w`` and ``w_roll``.

    Cubic (Hermite) in the displacement from the corners' H and dH/du, then in the roll from these
    and dH/dpsi, the last linear in the displacement.
    """
    q0, r0 = cubic(w, cell.gap_00, cell.gap_01, cell.gap_02, cell.gap_03)
    r1 = cell.gap_11
    q1 = cell.gap_10 + w * r1
    q2, r2 = cubic(w, cell.gap_20, cell.gap_21, cell.gap_22, cell.gap_23)
    q3, r3 = cubic(w, cell.gap_30, cell.gap_31, cell.gap_32, cell.gap_33)
    gap, gap_roll = cubic(w_roll, q0, q1, q2, q3)
    return gap, r0 + w_roll * (r1 + w_roll * (r2 + w_roll * r3)), gap_roll


def patch_in_cell(
    cell: Polynomials, place: tuple[float, float], rates: tuple[float, float], point: RunningPoint
) -> Patch:
    """What `profiles.zone_contact` gives, from the polynomials of the wheel's cell.

    Parameters
    ----------
    cell : Polynomials
    place : (float, float)
        Within the cell along displacement and roll, 0 to 1.
    rates : (float, float)
        Cells per metre and per radian.
    point : RunningPoint
    """
    w, w_roll = place
    rate, roll_rate = rates
    gap, gap_w, gap_w_roll = gap_in_cell(cell, w, w_roll)
    slope = gap_w * rate
    return Patch(
        gap - point.drop,
        slope,
        gap_w_roll * roll_rate - point.drop * slope - point.reach,
        blend(w, w_roll, cell.rail_z, cell.rail_z_1, cell.rail_z_2, cell.rail_z_3),
        blend(w, w_roll, cell.stiffness, cell.stiffness_1, cell.stiffness_2, cell.stiffness_3),
        blend(w, w_roll, cell.along, cell.along_1, cell.along_2, cell.along_3),
        blend(w, w_roll, cell.creep, cell.creep_1, cell.creep_2, cell.creep_3),
        blend(w, w_roll, cell.spin, cell.spin_1, cell.spin_2, cell.spin_3),
        blend(w, w_roll, cell.log_ratio, cell.log_ratio_1, cell.log_ratio_2, cell.log_ratio_3),
    )


def fill_table(
    displacements: Array, rolls: Array, circle: RunningCircle, geometry: Geometry, table: Array
) -> None:
    """Fill ``table`` (one row per roll and displacement, these fastest) by the grid method."""
    for i in range(len(rolls)):
        reach, drop = running_point(math.sin(rolls[i]), math.cos(rolls[i]), circle)
        for j in range(len(displacements)):
            shift = displacements[j] - reach + circle.half_spacing
            base = (i * len(displacements) + j) * 2 * FIELDS
            for zone in range(2):
                first = geometry.flange_points if zone == 0 else 0
                last = len(geometry.wheel_y) if zone == 0 else geometry.flange_points
                found = zone_contact(shift, rolls[i], first, last, geometry)
                place = base + zone * FIELDS
                table[place] = found.gap + drop
                table[place + 1] = found.slope
                table[place + 2] = found.gap_psi + found.slope * drop + reach
                table[place + 3] = found.rail_z
                table[place + 4] = found.stiffness
                table[place + 5] = found.along
                table[place + 6] = found.creep
                table[place + 7] = found.spin
                table[place + 8] = found.log_ratio
