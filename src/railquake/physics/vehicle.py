"""The vehicle: rigid bodies joined by linear springs and dashpots (Eq. 1 of the paper).

    M_v X'' + C_v X' + K_v X = P_ev(t)                                                     (Eq. 1)

Each body has three degrees of freedom: lateral displacement y (right), vertical displacement z
(down) and rotation phi about the longitudinal axis (right side down).  The equations are linear
about the undeformed position.  P_ev holds gravity, the effective forces -m a_g of the shaking
ground and the contact forces on the wheelset, the last body.
"""

from typing import Any

import numpy as np

from railquake.measures import STANDARD_GRAVITY as GRAVITY

__all__ = ["GRAVITY", "fixed_wheelset_modes", "free_acceleration"]

Array = np.ndarray[Any, np.dtype[np.float64]]


def free_acceleration(
    shaken: float, heavy: float, ground: tuple[float, float], gravity: float, pulled: float
) -> float:
    """One row of Eq. 1 solved for the acceleration, contact forces left out.

    Parameters
    ----------
    shaken, heavy : float
        1 for a row of y and for one of z, else 0.
    ground : (float, float)
        Acceleration of the ground, lateral and down, m/s2.
    gravity : float
        m/s2.
    pulled : float
        What springs and dashpots give to it, over its mass or inertia: (K X + C X')/m.
    """
    return heavy * (gravity - ground[1]) - shaken * ground[0] - pulled


def fixed_wheelset_modes(mass: Array, stiffness: Array) -> tuple[Array, Array]:
    """Natural frequencies (Hz, ascending) and shapes with the wheelset held fast (Table 1).

    Parameters
    ----------
    mass : array, shape (n,)
        Diagonal of M_v; the wheelset's three degrees of freedom stand last.
    stiffness : array, shape (n, n)

    Returns
    -------
    frequencies : array, shape (n - 3,)
        Negative where the mode is unstable: -sqrt(-omega^2)/(2 pi).
    shapes : array, shape (n - 3, n - 3)
        Column i is mode i, normalised to unit modal mass.
    """
    free = slice(0, len(mass) - 3)
    root = 1.0 / np.sqrt(mass[free])
    values, vectors = np.linalg.eigh(stiffness[free, free] * np.outer(root, root))
    frequencies = np.sign(values) * np.sqrt(np.abs(values)) / (2.0 * np.pi)
    return frequencies, vectors * root[:, None]
