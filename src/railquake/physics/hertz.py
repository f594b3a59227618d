"""Hertz' stiffness of wheel on rail (Eq. 6 of the paper), and what else its ellipse decides.

Hertz (1882), with the relative curvatures A (lateral) and B (rolling direction) ::

    A = (1/R_wheel,y + 1/R_rail,y)/2     B = (1/R_wheel,x + 1/R_rail,x)/2
    N = K delta^1.5       K = (4 E*/3) / sqrt(r^3 (A + B))                               (Eq. 6)
    1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2

where r is the *dimensionless* approach coefficient of Hertz' theory, a function of
cos(theta) = (B - A)/(A + B) (the paper calls it a radius of curvature; r = 1 for A = B).  With the
semi-axes' coefficients m (along the rolling direction) and n, the ellipse has
a b = delta m n / (r (A + B)).  Concave radii are negative.
"""

import math
from functools import cache
from typing import Any, NamedTuple

import numpy as np
from scipy.special import ellipe, ellipk

from railquake.physics.creep.kalker import kalker_coefficients

__all__ = [
    "HertzTable",
    "effective_modulus",
    "hertz_coefficients",
    "hertz_lookup",
    "hertz_table",
]

Array = np.ndarray[Any, np.dtype[np.float64]]


def effective_modulus(youngs_modulus: float, poisson_ratio: float) -> float:
    """E* of two bodies of the same material, Pa."""
    return youngs_modulus / (2.0 * (1.0 - poisson_ratio**2))


def hertz_coefficients(angle: Array) -> tuple[Array, Array, Array]:
    """Hertz' coefficients from the complete elliptic integrals.

    Parameters
    ----------
    angle : array
        theta with cos(theta) = (B - A)/(A + B), in (0, pi).

    Returns
    -------
    m, n, r : array
        Semi-axis along the rolling direction a = m (3 N / (4 E* (A + B)))^(1/3), transverse one
        b likewise with n, and approach coefficient r.

    Notes
    -----
    With the ratio k of the smaller to the larger semi-axis and e^2 = 1 - k^2, the smaller relative
    curvature's share of A + B is k^2 (K(e) - E(e)) / (e^2 E(e)); this is solved for k, and the
    rest is explicit (Johnson 1985, section 4.2).
    """
    cosine = np.cos(np.asarray(angle, dtype=float))
    share = 0.5 * (1.0 - np.abs(cosine))
    low = np.full(share.shape, 1e-6)
    high = np.full(share.shape, 1.0 - 1e-9)
    for _ in range(60):  # bisection: monotone, and this runs once per material
        k = 0.5 * (low + high)
        e2 = 1.0 - k * k
        first, second = ellipk(e2), ellipe(e2)
        found = k * k * (first - second) / (e2 * second)
        low = np.where(found < share, k, low)
        high = np.where(found < share, high, k)
    k = 0.5 * (low + high)
    e2 = 1.0 - k * k
    first, second = ellipk(e2), ellipe(e2)
    large = np.cbrt(2.0 * second / (math.pi * k * k))
    small = k * large
    approach = np.cbrt(4.0 * first**3 * k * k / (math.pi**2 * second))
    # B > A (cosine > 0): the rolling direction is the more curved one and a the smaller semi-axis
    rolling_is_small = cosine > 0.0
    return (
        np.where(rolling_is_small, small, large),
        np.where(rolling_is_small, large, small),
        approach,
    )


class HertzTable(NamedTuple):
    """Hertz' and Kalker's coefficients on evenly spaced theta in [0, pi]; see `hertz_lookup`."""

    stiffness: Array  # (4 E*/3) r^-1.5
    area: Array  # m n / r
    along: Array  # G C11
    creep: Array  # G C22
    spin: Array  # G C23
    a_over_b: Array


HERTZ_NODES = 4097


@cache
def hertz_table(youngs_modulus: float, poisson_ratio: float) -> HertzTable:
    """Tabulate all that a contact needs to know of its curvatures' ratio, for one material."""
    # the ends theta = 0 and pi (line contacts) are out of reach: A and B are bounded below
    angle = np.linspace(0.0, math.pi, HERTZ_NODES).clip(1e-3, math.pi - 1e-3)
    m, n, r = hertz_coefficients(angle)
    c11, c22, c23 = kalker_coefficients(m / n, poisson_ratio)
    shear = youngs_modulus / (2.0 * (1.0 + poisson_ratio))
    four_thirds = 4.0 * effective_modulus(youngs_modulus, poisson_ratio) / 3.0
    return HertzTable(
        four_thirds * r**-1.5, m * n / r, shear * c11, shear * c22, shear * c23, m / n
    )


def hertz_lookup(
    lateral: float,
    rolling: float,
    stiffness: Array,
    area: Array,
    along: Array,
    creep: Array,
    spin: Array,
    log_ratio: Array,
) -> tuple[float, float, float, float, float]:
    """Hertz stiffness and creep coefficients of one wheel's contact.

    Parameters
    ----------
    lateral, rolling : float
        Relative curvatures A and B, 1/m, both positive.
    stiffness, area, along, creep, spin, log_ratio : array
        Columns of `HertzTable`, and the logarithm of the last.

    Returns
    -------
    K : float
        N/m^1.5.
    f11 / delta, f22 / delta, f23 / delta^1.5 : float
        Kalker's linear coefficients per indentation: a b is proportional to delta.
    log(a/b) : float
    """
    total = lateral + rolling
    place = math.acos((rolling - lateral) / total) * ((len(stiffness) - 1) / math.pi)
    cell = min(int(place), len(stiffness) - 2)
    w = place - cell
    k = ((1.0 - w) * stiffness[cell] + w * stiffness[cell + 1]) / math.sqrt(total)
    ab = ((1.0 - w) * area[cell] + w * area[cell + 1]) / total
    f11 = ((1.0 - w) * along[cell] + w * along[cell + 1]) * ab
    f22 = ((1.0 - w) * creep[cell] + w * creep[cell + 1]) * ab
    f23 = ((1.0 - w) * spin[cell] + w * spin[cell + 1]) * ab * math.sqrt(ab)
    return k, f11, f22, f23, (1.0 - w) * log_ratio[cell] + w * log_ratio[cell + 1]
