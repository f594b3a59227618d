"""Creepage coefficients of Kalker's linear theory.

Source: Kalker (1990), Three-Dimensional Elastic Bodies in Rolling Contact, table E.3, whose last
entries are at a/b 5 and 10; for the longer ellipses of flanges the program CONTACT.
"""

from typing import Any

import numpy as np

__all__ = ["KALKER_A_OVER_B", "LARGEST_A_OVER_B", "kalker_coefficients"]

Array = np.ndarray[Any, np.dtype[np.float64]]

# C11, C22, C23 at Poisson's ratio 0, 0.25 and 0.5.  First a/b = 0.1 ... 1, then b/a = 1 ... 0.1
# (so a/b rises).
KALKER_A_OVER_B: Array = np.concatenate(
    [np.arange(1, 11) / 10.0, 1.0 / (np.arange(9, 0, -1) / 10.0)]
)
_POISSON = np.array([0.0, 0.25, 0.5])
_C11 = np.array(
    [
        (2.51, 3.31, 4.85), (2.59, 3.37, 4.81), (2.68, 3.44, 4.80), (2.78, 3.53, 4.82),
        (2.88, 3.62, 4.83), (2.98, 3.72, 4.91), (3.09, 3.81, 4.97), (3.19, 3.91, 5.05),
        (3.29, 4.01, 5.12), (3.40, 4.12, 5.20), (3.51, 4.22, 5.30), (3.65, 4.36, 5.42),
        (3.82, 4.54, 5.58), (4.06, 4.78, 5.80), (4.37, 5.10, 6.11), (4.84, 5.57, 6.57),
        (5.57, 6.34, 7.34), (6.96, 7.78, 8.82), (10.7, 11.7, 12.9),
    ]
)  # fmt: skip
_C22 = np.array(
    [
        (2.51, 2.52, 2.53), (2.59, 2.63, 2.66), (2.68, 2.75, 2.81), (2.78, 2.88, 2.98),
        (2.88, 3.01, 3.14), (2.98, 3.14, 3.31), (3.09, 3.28, 3.48), (3.19, 3.41, 3.65),
        (3.29, 3.54, 3.82), (3.40, 3.67, 3.98), (3.51, 3.81, 4.16), (3.65, 3.99, 4.39),
        (3.82, 4.21, 4.67), (4.06, 4.50, 5.04), (4.37, 4.90, 5.56), (4.84, 5.48, 6.31),
        (5.57, 6.40, 7.51), (6.96, 8.14, 9.79), (10.7, 12.8, 16.0),
    ]
)  # fmt: skip
_C23 = np.array(
    [
        (0.334, 0.473, 0.731), (0.483, 0.603, 0.809), (0.607, 0.715, 0.889),
        (0.720, 0.823, 0.977), (0.827, 0.929, 1.07), (0.930, 1.03, 1.18), (1.03, 1.14, 1.29),
        (1.13, 1.25, 1.40), (1.23, 1.36, 1.51), (1.33, 1.47, 1.63), (1.44, 1.59, 1.77),
        (1.58, 1.75, 1.94), (1.76, 1.95, 2.18), (2.01, 2.23, 2.50), (2.35, 2.62, 2.96),
        (2.88, 3.24, 3.70), (3.79, 4.32, 5.01), (5.72, 6.63, 7.89), (12.2, 14.6, 18.0),
    ]
)  # fmt: skip


# Flanges lie at a/b 9 to 24.  At Poisson's ratio 0.28, from CONTACT (Vollebregt and Kalker, exact
# half-space theory; open source version, revision 2707), its grid's error extrapolated away.
_FLANGE_A_OVER_B = np.array([6.0, 7.0, 8.0, 9.0, 10.0, 12.0, 15.0, 18.0, 20.0])
_FLANGE = np.array(
    [
        (8.7525, 9.5655, 10.3456, 11.0625, 11.8142, 13.2825, 15.4144, 17.4347, 18.7538),
        (9.3707, 10.367, 11.3215, 12.2021, 13.1242, 14.925, 17.5407, 20.0344, 21.6623),
        (8.2592, 9.8248, 11.4446, 12.9678, 14.6655, 18.1936, 23.806, 29.6687, 33.7637),
    ]
)
_FLANGE_POISSON = 0.28
_BOTH = 4  # of them, a/b 10, stands in Kalker's table as well
LARGEST_A_OVER_B = 40.0


def kalker_coefficients(a_over_b: Array, poisson: float) -> tuple[Array, Array, Array]:
    """Creepage coefficients C11, C22, C23 of Kalker's linear theory.

    Parameters
    ----------
    a_over_b : array
        Semi-axis along the rolling direction over the transverse one.  Below 0.1 and above
        `LARGEST_A_OVER_B` the value there is used.
    poisson : float

    Returns
    -------
    C11, C22, C23 : array
        Kalker's to a/b 5, CONTACT's from 6 on; at 10 both are given, C23 2 % apart, and their
        geometric mean stands.  Quadratic in Poisson's ratio, as Kalker says, whose action beyond 5
        is that of his table at 5 and 10; and log C linear in log(a/b) between the nodes: read
        linearly in b/a, as his table is printed, they would be too large by up to 7 % (C23: 17 %)
        between a/b 5 and 10.  Beyond 20 the last slope goes on.
    """
    lagrange, at_flanges = _quadratic(poisson), _quadratic(_FLANGE_POISSON)
    table_place, flange_place = np.log(KALKER_A_OVER_B), np.log(_FLANGE_A_OVER_B)
    end = np.log(LARGEST_A_OVER_B)
    knots = [*table_place[:-1], *flange_place, end]
    place = np.log(np.asarray(a_over_b, dtype=float))
    found = []
    for table, flange in zip((_C11, _C22, _C23), _FLANGE, strict=True):
        own = np.log(table @ lagrange)
        action = own - np.log(table @ at_flanges)
        beyond = np.log(flange) + np.interp(flange_place, table_place, action)
        beyond[_BOTH] = 0.5 * (beyond[_BOTH] + own[-1])
        slope = (beyond[-1] - beyond[-2]) / (flange_place[-1] - flange_place[-2])
        last = beyond[-1] + slope * (end - flange_place[-1])
        found.append(np.exp(np.interp(place, knots, [*own[:-1], *beyond, last])))
    return found[0], found[1], found[2]


def _quadratic(poisson: float) -> Array:
    """Weights of the table's three columns at a Poisson's ratio."""
    return np.array(
        [np.prod([(poisson - p) / (q - p) for p in _POISSON if p != q]) for q in _POISSON]
    )
