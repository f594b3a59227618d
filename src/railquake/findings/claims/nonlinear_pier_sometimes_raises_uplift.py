"""Now and then a damaged pier raises the uplift.

Gomez & DeJong (2023), "Running safety assessment" and Figure 7:

    However, in some cases, the frequency content of the ground motion, and the resonant frequencies
    of the structure and the train, might generate a situation where there is an amplification of
    the bridge response after damage (period lengthening), increasing the uplift values and the
    derailment likelihood.
"""

from __future__ import annotations

from railquake.findings.claim import BORNE_OUT, IN_PART, NOT_BORNE_OUT, Verdict, claim
from railquake.findings.comparison import PairedComparison
from railquake.findings.evidence import Evidence
from railquake.findings.models import ELASTIC, NONLINEAR


@claim(
    order=40,
    says="In some cases the damaged, softer pier amplifies the motion, and uplift and the "
    "likelihood of derailment grow.",
    needs=(("uplift_ratio", NONLINEAR, ELASTIC),),
)
def amplified_uplift(evidence: Evidence, uplift: PairedComparison) -> Verdict:
    """By the pairs with more uplift, and by the runs that reach the onset or derail."""
    one, other = evidence.outcomes[NONLINEAR], evidence.outcomes[ELASTIC]
    words = (
        f"Uplift is higher in {uplift.above} of {uplift.pairs} pairs; {one.onset} nonlinear and "
        f"{other.onset} elastic runs reach the onset, {one.derailed} and {other.derailed} derail."
    )
    if uplift.above == 0:
        return Verdict(NOT_BORNE_OUT, words, "There is no such pair among these runs.")
    if one.onset > other.onset or one.derailed > other.derailed:
        return Verdict(BORNE_OUT, words)
    return Verdict(
        IN_PART, words,
        "Uplift does grow in some pairs, but no more of the nonlinear runs reach the onset.",
    )  # fmt: skip
