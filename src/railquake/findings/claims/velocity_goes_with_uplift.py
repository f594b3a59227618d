"""Peak bridge velocity goes with uplift.

Gomez & DeJong (2023), "Running safety assessment" and Figure 7:

    In particular, PBV was found to be well correlated with the onset of uplift, and therefore, with
    the likelihood of derailment.
"""

from __future__ import annotations

from railquake.findings.claim import BORNE_OUT, Verdict, claim, graded, not_tested
from railquake.findings.evidence import Evidence
from railquake.findings.models import COUPLED, PIERS
from railquake.findings.words import interval, sentence

WELL = 0.7  # Spearman's rho above which two quantities are called well correlated


@claim(order=10, says="Peak bridge velocity is well correlated with uplift.")
def well_correlated(evidence: Evidence) -> Verdict:
    """By the interval of the rank correlation over all runs of a coupled model."""
    found = {
        name: correlations.of("pbv_m_s")
        for name, correlations in evidence.correlations.items()
        if name in COUPLED
    }
    known = {name: item for name, item in found.items() if item is not None}
    if not known:
        return not_tested("There are too few coupled runs")
    words = [
        f"{PIERS[name]}: Spearman’s ρ {interval(item.spearman)}, scatter about a power law β "
        f"{interval(item.dispersion)}"
        for name, item in known.items()
    ]
    rho = [item.spearman for item in known.values()]
    verdict = graded(all(r.above(WELL) for r in rho), any(r.above(0.0) for r in rho))
    why = f"The intervals of ρ do not lie above {WELL}, which is taken as well correlated here."
    return Verdict(verdict, sentence(words), "" if verdict == BORNE_OUT else why)
