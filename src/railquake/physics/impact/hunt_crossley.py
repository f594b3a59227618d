"""Hunt and Crossley's coefficient as the paper prints it (Eq. 7)."""

from railquake.physics.impact import RestitutionLaw

__all__ = ["LAW"]


def coefficient(restitution: float) -> float:
    """alpha_r = 3 (1 - c_r)/2 of Eq. 7."""
    return 1.5 * (1.0 - restitution)


LAW = RestitutionLaw("hunt-crossley", coefficient, "Eq. 7; Hunt and Crossley (1975)")
