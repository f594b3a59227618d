"""Where wheel and rail touch: the grid method (Eq. 4 of the paper).

Everything here is for the right-hand wheel, in track axes: y to the right (outward), z down,
origin midway between the rail crowns.  The left-hand wheel is its mirror image, (Y, psi) ->
(-Y, -psi).  The wheelset's centre of gravity stands at (Y, Z), its relative roll is psi; a wheel
point (s, q) of the wheelset's own axes is at ::

    y = Y + s cos(psi) - q sin(psi)          z = Z + s sin(psi) + q cos(psi)

and the gap to the rail is delta_z = z_rail(y) - z (Eq. 4), negative in contact.  For given Y and
psi the place of a local minimum of the gap does not depend on Z, so ::

    gap = G(Y, psi) - Z,     G = min over the zone of [z_rail(y) - (z - Z)]

and the gap's own derivatives are dG/dY = tan(gamma), gamma the contact angle, and
dG/dpsi = -(y_r + tan(gamma) z_r), with (y_r, z_r) from the wheelset's centre to the contact point:
a force along the contact normal is exactly the gradient of the gap.  The contact plane is the
common tangent at the minimum, to which the chord of the paper's patch shrinks with it.

Two zones of the wheel, *tread* and *flange*, are searched each for its own minimum, so a wheel may
bear on two patches at once.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from railquake.physics.hertz import hertz_lookup

__all__ = [
    "POSITIVE",
    "Extremum",
    "Geometry",
    "Patch",
    "cubic",
    "hermite",
    "hermite_coefficients",
    "rail_at",
    "zone_contact",
    "zone_extremum",
]

Array = np.ndarray[Any, np.dtype[np.float64]]

# An index masked with this is seen to be positive, so that no Python-style wrap-around from the
# array's end is compiled for it.
POSITIVE = 0x7FFFFFFF
MIN_CURVATURE = 0.05  # 1/m; see `zone_contact`
REFINEMENTS = 2


class Geometry(NamedTuple):
    """Arrays of one wheel-rail pair, as the kernel reads them (all float64, SI).

    ``wheel_*`` are per wheel point, from the flange's back to the field side, in wheelset axes:
    lateral place, height below the axle, their derivatives by the point's number, curvature
    (convex positive).  Points before ``flange_points`` belong to the flange zone.  ``rail_*`` are
    evenly spaced by ``rail_step`` from ``rail_start`` in track axes; ``rail_slope`` is dz/dy.
    ``table`` is that of `contact_table`, with ``displacement_nodes`` nodes of a wheel's own
    displacement; ``tread_law`` and ``flange_law`` are those of the creep laws.
    """

    wheel_y: Array
    wheel_z: Array
    wheel_dy: Array
    wheel_dz: Array
    wheel_curvature: Array
    flange_points: int
    rail_start: float
    rail_step: float
    rail_z: Array
    rail_slope: Array
    rail_curvature: Array
    hertz_stiffness: Array
    hertz_area: Array
    hertz_along: Array
    hertz_creep: Array
    hertz_spin: Array
    hertz_log_ratio: Array
    table: Array
    displacement_nodes: int
    tread_law: Array
    flange_law: Array


class Extremum(NamedTuple):
    """Smallest gap of one zone of a wheel, and the geometry of the contact there."""

    gap: float  # G, with the wheelset's centre at Z = 0, m
    slope: float  # rail slope there, dG/dY = tan(gamma)
    gap_psi: float  # dG/dpsi, m
    place: float  # lateral place of the contact point in track coordinates, outward, m
    rail_z: float  # height of the contact point in track axes, m
    lateral: float  # relative curvature A, 1/m
    rolling: float  # relative curvature B, 1/m
    radius: float  # local rolling radius, m


class Patch(NamedTuple):
    """Smallest gap of one zone of a wheel, and what the forces there need."""

    gap: float  # G, with the wheelset's centre at Z = 0, m
    slope: float  # rail slope there, dG/dY = tan(gamma)
    gap_psi: float  # dG/dpsi, m
    rail_z: float  # height of the contact point in track axes, m
    stiffness: float  # K, N/m^1.5
    along: float  # f11/delta, N/m
    creep: float  # f22/delta, N/m
    spin: float  # f23/delta^1.5, N/m^0.5
    log_ratio: float  # log(a/b), semi-axes along and across the rolling direction


def hermite_coefficients(
    f0: float, f1: float, d0: float, d1: float
) -> tuple[float, float, float, float]:
    """Coefficients of the cubic on 0 <= t <= 1 with ends f0, f1 and slopes d0, d1 per unit t."""
    rise = f1 - f0
    return f0, d0, 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise


def hermite(t: float, f0: float, f1: float, d0: float, d1: float) -> tuple[float, float]:
    """Cubic Hermite polynomial on 0 <= t <= 1 and its derivative (d0, d1 per unit of t)."""
    c0, c1, c2, c3 = hermite_coefficients(f0, f1, d0, d1)
    return cubic(t, c0, c1, c2, c3)


def cubic(t: float, c0: float, c1: float, c2: float, c3: float) -> tuple[float, float]:
    """Cubic polynomial and its derivative."""
    return c0 + t * (c1 + t * (c2 + t * c3)), c1 + t * (2.0 * c2 + 3.0 * t * c3)


def rail_at(
    y: float, start: float, step: float, height: Array, slope: Array
) -> tuple[float, float]:
    """Height (down) and slope dz/dy of the rail at y; beside the rail, those of its last point."""
    last = len(height) - 1
    place = min(max((y - start) / step, 0.0), last - 1e-9)
    cell = int(place) & POSITIVE
    z, dz = hermite(
        place - cell, height[cell], height[cell + 1], step * slope[cell], step * slope[cell + 1]
    )
    return z, dz / step


def zone_extremum(shift: float, psi: float, first: int, last: int, geometry: Geometry) -> Extremum:
    """Smallest gap of one zone of the right-hand wheel, and the geometry of the contact there.

    Parameters
    ----------
    shift, psi : float
        Y (m) and relative roll (rad) of the wheelset.
    first, last : int
        The zone's wheel points, ``first <= i < last``.
    geometry : Geometry

    Returns
    -------
    Extremum

    Notes
    -----
    The grid is searched for its lowest node; there parabolas through the gap on the Hermite
    curves, each on a quarter of the last one's spacing, find the minimum between nodes.  Where
    the relative lateral curvature is not positive (a rail's shoulder in the wheel's throat) the
    contact is no Hertz ellipse; A is then held at a lower bound, a patch of finite width.
    """
    sine = math.sin(psi)
    cosine = math.cos(psi)
    start = geometry.rail_start
    step = geometry.rail_step
    rail_z = geometry.rail_z
    wheel_y = geometry.wheel_y
    wheel_z = geometry.wheel_z
    inverse = 1.0 / step
    end = len(rail_z) - 1 - 1e-9
    best = first
    lowest = 1e9
    for i in range(first & POSITIVE, last & POSITIVE):
        y = shift + wheel_y[i] * cosine - wheel_z[i] * sine
        place = min(max((y - start) * inverse, 0.0), end)
        cell = int(place) & POSITIVE
        rail = rail_z[cell] + (place - cell) * (rail_z[cell + 1] - rail_z[cell])
        gap = rail - wheel_y[i] * sine - wheel_z[i] * cosine
        best = i if gap < lowest else best
        lowest = min(gap, lowest)
    at = float(best)
    reach = 1.0 if best > first and best < last - 1 else 0.0
    for _ in range(REFINEMENTS):
        g0, _, _, _ = gap_at(at - reach, sine, cosine, shift, geometry)
        g1, _, _, _ = gap_at(at, sine, cosine, shift, geometry)
        g2, _, _, _ = gap_at(at + reach, sine, cosine, shift, geometry)
        bend = g0 - 2.0 * g1 + g2
        move = 0.5 * (g0 - g2) / bend if bend > 1e-18 else 0.0
        at = at + reach * min(max(move, -1.0), 1.0)
        reach = 0.25 * reach
    gap, y, height, slope = gap_at(at, sine, cosine, shift, geometry)
    place = min(max((y - start) * inverse, 0.0), end)
    rail_curvature = geometry.rail_curvature[int(place + 0.5)]
    near = min(int(at + 0.5), last - 1)
    cos_gamma = 1.0 / math.sqrt(1.0 + slope * slope)
    # rolling radius about the axle, and its curvature seen along the contact normal
    radius = wheel_z[near]
    cos_from_axle = max(cos_gamma * (cosine + slope * sine), 0.05)
    lateral = max(0.5 * (geometry.wheel_curvature[near] + rail_curvature), MIN_CURVATURE)
    rolling = 0.5 * cos_from_axle / radius
    gap_psi = -(y - shift) - slope * (height - gap)
    return Extremum(gap, slope, gap_psi, y, height, lateral, rolling, radius)


def zone_contact(shift: float, psi: float, first: int, last: int, geometry: Geometry) -> Patch:
    """Smallest gap of one zone of the right-hand wheel, and what the forces there need.

    Parameters are those of `zone_extremum`.
    """
    found = zone_extremum(shift, psi, first, last, geometry)
    stiffness, f11, f22, f23, log_ratio = hertz_lookup(
        found.lateral,
        found.rolling,
        geometry.hertz_stiffness,
        geometry.hertz_area,
        geometry.hertz_along,
        geometry.hertz_creep,
        geometry.hertz_spin,
        geometry.hertz_log_ratio,
    )
    return Patch(
        found.gap,
        found.slope,
        found.gap_psi,
        found.rail_z,
        stiffness,
        f11,
        f22,
        f23,
        log_ratio,
    )


def gap_at(
    at: float, sine: float, cosine: float, shift: float, geometry: Geometry
) -> tuple[float, float, float, float]:
    """Gap (Z = 0), lateral place, rail height and rail slope at wheel point number ``at``."""
    cell = min(max(int(at), 0), len(geometry.wheel_y) - 2)
    t = at - cell
    s, _ = hermite(
        t,
        geometry.wheel_y[cell],
        geometry.wheel_y[cell + 1],
        geometry.wheel_dy[cell],
        geometry.wheel_dy[cell + 1],
    )
    q, _ = hermite(
        t,
        geometry.wheel_z[cell],
        geometry.wheel_z[cell + 1],
        geometry.wheel_dz[cell],
        geometry.wheel_dz[cell + 1],
    )
    y = shift + s * cosine - q * sine
    height, slope = rail_at(
        y, geometry.rail_start, geometry.rail_step, geometry.rail_z, geometry.rail_slope
    )
    return height - s * sine - q * cosine, y, height, slope
