"""Carter (1926), Proceedings of the Royal Society of London A 112, 151-157."""

from railquake.physics.creep import CreepLaw

__all__ = ["LAW"]


def saturation(linear: float, limit: float) -> float:
    """F = mu N (tau - tau^2/4) with Kalker's slope, sliding from tau = 2."""
    size = abs(linear)
    tau = size / max(limit, 1e-30)
    return 1.0 - tau / 4.0 if tau < 2.0 else limit / max(size, 1e-30)


LAW = CreepLaw("carter", saturation, "Carter (1926)")
