"""A decoupled analysis errs on the safe side.

Gomez & DeJong (2023), "Conclusions":

    Using a decoupled analysis for the analysis of the running safety of trains was found to provide
    a good estimate of the coupled response and tended to be conservative.
"""

from __future__ import annotations

from railquake.findings.claim import BORNE_OUT, Verdict, claim, graded, not_tested
from railquake.findings.evidence import Evidence
from railquake.findings.models import DECOUPLED, PIERS
from railquake.findings.words import ratio, sentence


@claim(order=90, says="A decoupled analysis tends to be conservative for the train.")
def conservative(evidence: Evidence) -> Verdict:
    """By the direction of the uplift's ratio with either pier; one of the two is enough to tell."""
    found = [
        evidence.ratio("uplift_ratio", decoupled, coupled)
        for coupled, decoupled in DECOUPLED.items()
    ]
    known = [item for item in found if not item.missing]
    if not known:
        return not_tested(found[0].missing)
    words = sentence(
        f"{PIERS[item.reference]}: uplift {ratio(item)}, understated in {item.below} of "
        f"{item.pairs} pairs"
        for item in known
    )
    larger = [item.direction > 0 for item in known]
    verdict = graded(all(larger), any(larger))
    why = "The uplift is not clearly larger throughout."
    return Verdict(verdict, words, "" if verdict == BORNE_OUT else why)
