"""The normal force with its loss at impacts: Hunt and Crossley (Eqs. 5 and 7 of the paper).

    N = (K + chi delta') delta^1.5 >= 0      chi = alpha_r K / delta'_0              (Eqs. 5, 7)

delta'_0 is the rate at the onset of this contact, frozen until it is lost, and bounded below.  A
*restitution law* says which alpha_r belongs to a coefficient of restitution c_r, and which rate is
taken: that of the onset, or one that is no matter of this contact, so that the force has no memory.
Each is a file of this folder; a new one is found by lying here.

Source: Hunt and Crossley (1975), Journal of Applied Mechanics 42, 440-445.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

from railquake.laws import RESTITUTION_LAWS

__all__ = [
    "RESTITUTION_LAWS",
    "RestitutionLaw",
    "frozen_at_onset",
    "hysteresis",
    "normal_force",
]


def frozen_at_onset(
    closed: bool, hysteresis: float, rate: float, alpha_r: float, rate_bound: float
) -> float:
    """chi/K of this contact, s/m: fixed at its onset, forgotten when it is lost.

    Parameters
    ----------
    closed : bool
        Whether wheel and rail touch now.
    hysteresis : float
        chi/K so far; 0 while open.
    rate : float
        delta', m/s.
    alpha_r : float
    rate_bound : float
        Least rate at an onset, m/s.
    """
    fresh = alpha_r / max(rate, rate_bound)
    kept = hysteresis if hysteresis > 0.0 else fresh
    return kept if closed else 0.0


class RestitutionLaw(NamedTuple):
    """How much of an impact is lost."""

    name: str
    coefficient: Callable[[float], float]
    """c_r -> alpha_r; infinite where there is none."""
    source: str
    hysteresis: Callable[[bool, float, float, float, float], float] = frozen_at_onset
    """chi/K now, see `frozen_at_onset`; 0 while open."""


def hysteresis(
    closed: bool, hysteresis: float, rate: float, alpha_r: float, rate_bound: float
) -> float:
    """Slot of the restitution law: chi/K now, see `frozen_at_onset`."""
    raise NotImplementedError("a restitution law is chosen when a kernel is bound")


def normal_force(
    delta: float, rate: float, stiffness: float, hysteresis: float
) -> tuple[float, float]:
    """Normal force (Eq. 5), never negative, and its elastic part, N."""
    elastic = stiffness * delta * math.sqrt(delta)
    return max(elastic * (1.0 + hysteresis * rate), 0.0), elastic
