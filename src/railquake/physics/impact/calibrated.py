"""The coefficient with which a free impact rebounds at exactly c_r."""

import math

from railquake.physics.impact import RestitutionLaw

__all__ = ["LAW"]


def coefficient(restitution: float) -> float:
    """alpha_r with which a free impact rebounds at exactly ``restitution`` (in (0, 1]).

    Solves alpha (1 + c_r) = ln((1 + alpha)/(1 - alpha c_r)), the first integral of the impact of a
    mass with Eq. 5.  No finite damping makes an impact stick: infinite for 0.
    """
    if restitution <= 0.0:
        return math.inf
    if restitution >= 1.0:
        return 0.0
    from scipy.optimize import brentq  # a long import, for who uses it alone

    def excess(alpha: float) -> float:
        return alpha * (1.0 + restitution) - math.log((1.0 + alpha) / (1.0 - alpha * restitution))

    # alpha = 0 is the trivial root; the wanted one lies above 3 (1 - c_r)/2 and below the pole
    return float(brentq(excess, 1.0 - restitution, (1.0 - 1e-13) / restitution, xtol=1e-15))


LAW = RestitutionLaw("calibrated", coefficient, "first integral of a free impact with Eq. 5")
