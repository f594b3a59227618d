"""Shen, Hedrick and Elkins (1983), Vehicle System Dynamics 12, 79-83."""

from railquake.physics.creep import CreepLaw

__all__ = ["LAW"]


def saturation(linear: float, limit: float) -> float:
    """F = mu N (tau - tau^2/3 + tau^3/27), sliding from tau = 3."""
    size = abs(linear)
    tau = size / max(limit, 1e-30)
    partial = 1.0 - tau / 3.0 + tau * tau / 27.0
    return partial if tau < 3.0 else limit / max(size, 1e-30)


LAW = CreepLaw("she", saturation, "Shen, Hedrick and Elkins (1983)")
