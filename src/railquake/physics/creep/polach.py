"""Polach (1999), Vehicle System Dynamics Supplement 33, 728-739."""

import math

from railquake.physics.creep import CreepLaw

__all__ = ["LAW"]


def saturation(linear: float, limit: float) -> float:
    """F = (2 mu N / pi) (eps/(1 + eps^2) + atan eps), eps = pi tau / 4.

    Polach's separate term for spin is replaced by the linear force, which holds spin's part too.
    """
    size = abs(linear)
    tau = size / max(limit, 1e-30)
    eps = 0.25 * math.pi * tau
    return (0.5 * (eps / (1.0 + eps * eps) + math.atan(eps)) / eps) if eps > 1e-9 else 1.0


LAW = CreepLaw("polach", saturation, "Polach (1999)")
