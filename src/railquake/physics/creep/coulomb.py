"""Coulomb's friction as a bound."""

from railquake.physics.creep import CreepLaw

__all__ = ["LAW"]


def saturation(linear: float, limit: float) -> float:
    """Kalker's linear force cut off at mu N."""
    size = abs(linear)
    return 1.0 if size < limit else limit / max(size, 1e-30)


LAW = CreepLaw("coulomb", saturation, "Coulomb's bound")
