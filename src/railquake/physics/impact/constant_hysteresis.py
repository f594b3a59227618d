"""A loss without memory: chi/K is one number, whenever and however hard a wheel hits its rail.

    chi = 3 K (1 - c_r)/(2 v_r)

Eq. 7 with a rate that does not change from contact to contact, v_r = `REFERENCE_RATE`.  It is Hunt
and Crossley's own law: with chi/K = 3 a/2 a free impact at a small rate v rebounds at e = 1 - a v,
and a is a property of the material.  Restitution falls as the rate grows, as it does between
metals; c_r is that at v_r by this line.  The force depends on indentation and rate alone, so that
a hit within a contact that is held already loses what a hit on an open one does.

Source: Hunt and Crossley (1975), Journal of Applied Mechanics 42, 440-445.
"""

from railquake.physics.impact import RestitutionLaw, hunt_crossley

__all__ = ["LAW", "REFERENCE_RATE"]

REFERENCE_RATE = 1.0  # m/s


def constant(
    closed: bool, hysteresis: float, rate: float, alpha_r: float, rate_bound: float
) -> float:
    """chi/K of a contact, s/m; of what `frozen_at_onset` takes, only ``closed`` and ``alpha_r``."""
    return alpha_r / REFERENCE_RATE if closed else 0.0


LAW = RestitutionLaw(
    "constant-hysteresis",
    hunt_crossley.coefficient,
    "Hunt and Crossley (1975), e = 1 - a v",
    constant,
)
