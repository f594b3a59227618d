"""Kalker's simplified theory with large spin, in a table: for flanges.

Kalker (1982), Vehicle System Dynamics 11, 1-13 (the algorithm FASTSIM).  The surface yields like a
bed of springs, u = L p, with flexibilities L1, L2, L3 for longitudinal creepage, lateral creepage
and spin that make it agree with the linear theory ::

    L1 = 8 a/(3 G C11)     L2 = 8 a/(3 G C22)     L3 = pi a sqrt(a/b)/(4 G C23)

With x = a X, y = b Y, the traction t in units of mu p_0, p_0 = 2 N/(pi a b), and the linear forces
f_x (longitudinal creepage), f_y (lateral creepage) and f_s (spin) over mu N, a particle that sticks
gathers on its way -dX from the leading edge ::

    dt_x = (3 pi/16 f_x - 2 f_s Y b/a) (-dX)      dt_y = (3 pi/16 f_y + 2 f_s X) (-dX)

until abs(t) reaches 1 - X^2 - Y^2; the force over mu N is (2/pi) times the integral of t.

Where it slides, two things differ from the algorithm of 1982, since sliding friction knows nothing
of the springs: the traction opposes the rigid slip (xi_x - phi y, xi_y + phi x) as it is, that is
with one flexibility (L2) for all three creepages; and its size is mu times Hertz' pressure, an
ellipse and not the parabola, which only says where sliding begins (as Sichani, Enblom and Berg
2016, Vehicle System Dynamics 54, 748-764, have it).  Both matter with spin: errors against the
exact theory are on the page of the theory.

The result depends on f_x, f_y, f_s and a/b, and weakly on Poisson's ratio.  It is tabulated over
log(a/b) and, with F = abs(f_x) + abs(f_y) + abs(f_s), over F/(F + 2), the spin's share of F and the
lateral creepage's share of the rest; all creepages may be infinite.  What is kept is the force
times (1 + F)/F, which for small creepages is linear theory and is then read exactly.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from railquake.physics.creep import (
    BoundedForce,
    CreepLaw,
    LawTable,
    LinearForce,
    magnitude,
    reduced,
)
from railquake.physics.creep.kalker import LARGEST_A_OVER_B, kalker_coefficients
from railquake.physics.elementary import floor_of, larger_of

__all__ = ["LAW", "Ellipse", "bound", "ellipses", "fill_table", "simplified_theory"]

Array = np.ndarray[Any, np.dtype[np.float64]]

# nodes of the table
RATIOS, SIZES, SPINS, LATERALS = 11, 24, 20, 21
TABLE_SIZE = RATIOS * SIZES * SPINS * LATERALS * 2
LOG_FIRST = math.log(0.1)
LOG_STEP = (math.log(LARGEST_A_OVER_B) - LOG_FIRST) / (RATIOS - 1)
HALF_SIZE = 2.0  # F at the middle of its axis
# grid over an ellipse; the strips are narrow near its tips, where spin slides first
STRIPS, ELEMENTS = 32, 96
SPRING = 3.0 * math.pi / 16.0
POSITIVE = 0x7FFFFFFF  # see `profiles.POSITIVE`


class Ellipse(NamedTuple):
    """Shape of a contact, and Kalker's coefficients for it."""

    a_over_b: float
    c11: float
    c22: float
    c23: float


def simplified_theory(
    along: float, creep: float, spin: float, ellipse: Ellipse, strips: int, elements: int
) -> tuple[float, float]:
    """F_x and F_y over mu N, by integration over the ellipse.

    Parameters
    ----------
    along, creep, spin : float
        Linear forces over mu N: F_x by longitudinal and F_y by lateral creepage, F_y by spin.
    ellipse : Ellipse
    strips, elements : int
        Strips along the rolling direction, and elements in each.
    """
    # what sticks and what slides gathers per -dX: of itself, and per Y or X
    stick_x, stick_y = SPRING * along, SPRING * creep
    stick_xy, stick_yx = 2.0 * spin / ellipse.a_over_b, 2.0 * spin
    slide_x = SPRING * along * ellipse.c22 / ellipse.c11
    slide_spin = SPRING * spin * ellipse.c22 / ellipse.c23
    root = math.sqrt(ellipse.a_over_b)
    slide_xy, slide_yx = slide_spin / root, slide_spin * root
    force_x, force_y = 0.0, 0.0
    for j in range(strips):
        angle = math.pi * (j + 0.5) / strips
        y = math.cos(angle)
        half = math.sin(angle)
        step = 2.0 * half / elements
        t_x, t_y, sum_x, sum_y = 0.0, 0.0, 0.0, 0.0
        for i in range(elements - 1):  # at the trailing edge nothing is left
            middle = half - (i + 0.5) * step
            end = half - (i + 1) * step
            parabola = half * half - end * end
            next_x = t_x + step * (stick_x - stick_xy * y)
            next_y = t_y + step * (stick_y + stick_yx * middle)
            slides = next_x * next_x + next_y * next_y > parabola * parabola
            if slides:
                next_x = t_x + step * (slide_x - slide_xy * y)
                next_y = t_y + step * (slide_yx * middle + stick_y)
            size = math.sqrt(next_x * next_x + next_y * next_y)
            share = parabola / max(size, 1e-30) if slides else 1.0
            hertz = 0.75 / math.sqrt(parabola) if slides else 1.0
            t_x = share * next_x
            t_y = share * next_y
            sum_x += hertz * t_x
            sum_y += hertz * t_y
        width = math.pi / strips * half * step
        force_x += width * sum_x
        force_y += width * sum_y
    return 2.0 / math.pi * force_x, 2.0 / math.pi * force_y


def ellipses(poisson: float) -> Array:
    """a/b, C11, C22 and C23 at the nodes of the table, shape (RATIOS, 4)."""
    ratio = np.exp(LOG_FIRST + LOG_STEP * np.arange(RATIOS))
    return np.column_stack([ratio, *kalker_coefficients(ratio, poisson)])


def fill_table(nodes: Array, table: Array) -> None:
    """Fill ``table``, of `TABLE_SIZE`, for the ellipses of `ellipses`."""
    for n in range(RATIOS):
        ellipse = Ellipse(nodes[n, 0], nodes[n, 1], nodes[n, 2], nodes[n, 3])
        for m in range(SIZES):
            place = min(max(m / (SIZES - 1.0), 1e-4), 0.9999)
            size = HALF_SIZE * place / (1.0 - place)
            for k in range(SPINS):
                spin = size * k / (SPINS - 1.0)
                rest = size - spin
                for j in range(LATERALS):
                    share = 2.0 * j / (LATERALS - 1.0) - 1.0
                    along, creep = rest * (1.0 - abs(share)), rest * share
                    x, y = along, creep + spin  # the linear theory, without the grid's error
                    scale = 1.0 / size
                    if m > 0:
                        x, y = simplified_theory(along, creep, spin, ellipse, STRIPS, ELEMENTS)
                        scale += 1.0
                    at = 2 * (((n * SIZES + m) * SPINS + k) * LATERALS + j)
                    table[at] = max(x, 0.0) * scale  # but for rounding, not below 0
                    table[at + 1] = y * scale


def cell_of(place: float, cells: int) -> tuple[int, float]:
    """Number of a cell and the place in it, 0 to 1; beyond the ends the last one's."""
    bounded = larger_of(min(place, float(cells)), 0.0)
    cell = floor_of(min(bounded, cells - 0.5))
    return int(cell) & POSITIVE, bounded - cell


def between(w: float, low: tuple[float, float], high: tuple[float, float]) -> tuple[float, float]:
    """Linear interpolation of a vector."""
    return low[0] + w * (high[0] - low[0]), low[1] + w * (high[1] - low[1])


def along_lateral(table: Array, at: int, w: float) -> tuple[float, float]:
    """The vector between a node and the next of the lateral share."""
    return between(w, (table[at], table[at + 1]), (table[at + 2], table[at + 3]))


def along_spin(table: Array, at: int, w: float, w_spin: float) -> tuple[float, float]:
    """The same between two nodes of the spin's share."""
    following = at + 2 * LATERALS
    return between(w_spin, along_lateral(table, at, w), along_lateral(table, following, w))


def bound(linear: LinearForce, limit: float, log_ratio: float, table: Array) -> BoundedForce:
    """The force by the table; what lateral creepage does of it is reduced as the whole is.

    Mirrored creepages give mirrored forces, so the table has one sign of spin and of longitudinal
    creepage.  Parameters are those of `creep.bound_on_tread`.
    """
    inverse = 1.0 / max(limit, 1e-30)
    side = -1.0 if linear.spin < 0.0 else 1.0
    along = abs(linear.along) * inverse
    creep = side * linear.creep * inverse
    spin = abs(linear.spin) * inverse
    rest = along + abs(creep)
    size = rest + spin
    n, w_ratio = cell_of((log_ratio - LOG_FIRST) / LOG_STEP, RATIOS - 1)
    m, w_size = cell_of(size / (size + HALF_SIZE) * (SIZES - 1.0), SIZES - 1)
    k, w_spin = cell_of(spin / max(size, 1e-30) * (SPINS - 1.0), SPINS - 1)
    share = creep / max(rest, 1e-30)
    j, w = cell_of(0.5 * (share + 1.0) * (LATERALS - 1.0), LATERALS - 1)
    at = 2 * (((n * SIZES + m) * SPINS + k) * LATERALS + j)
    larger = 2 * SPINS * LATERALS
    longer = larger * SIZES
    short = between(
        w_size,
        along_spin(table, at, w, w_spin),
        along_spin(table, at + larger, w, w_spin),
    )
    long = between(
        w_size,
        along_spin(table, at + longer, w, w_spin),
        along_spin(table, at + longer + larger, w, w_spin),
    )
    x, y = between(w_ratio, short, long)
    scale = size / (1.0 + size)
    x, y = scale * x, scale * y
    within = min(1.0, 1.0 / max(math.sqrt(x * x + y * y), 1e-30))
    x = -limit * within * x if linear.along < 0.0 else limit * within * x
    y = side * limit * within * y
    whole = math.sqrt(x * x + y * y)
    creeping = reduced(linear, whole / max(magnitude(linear), whole, 1e-30))
    return BoundedForce(x, creeping.creep, y - creeping.creep, creeping.share)


LAW = CreepLaw(
    "fastsim",
    None,
    "Kalker (1982), with Hertz' pressure and the rigid slip where it slides",
    bound,
    LawTable(TABLE_SIZE, ellipses, fill_table),
)
