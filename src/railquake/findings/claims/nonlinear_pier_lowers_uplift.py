"""A nonlinear pier lowers the uplift.

Gomez & DeJong (2023), "Running safety assessment" and Figure 7:

    Generally speaking, a nonlinear model for the bridge provides smaller uplift values, since the
    PBVs are lower, due to increased damping.
"""

from __future__ import annotations

from railquake.findings.claim import BORNE_OUT, IN_PART, NOT_BORNE_OUT, Verdict, claim
from railquake.findings.comparison import PairedComparison
from railquake.findings.evidence import Evidence
from railquake.findings.models import ELASTIC, NONLINEAR
from railquake.findings.words import ratio


@claim(
    order=30,
    says="A nonlinear pier gives generally smaller uplift, since its peak velocities are lower.",
    needs=(("uplift_ratio", NONLINEAR, ELASTIC),),
)
def smaller_uplift(evidence: Evidence, uplift: PairedComparison) -> Verdict:
    """By the direction of both ratios; uplift may be told without PBV."""
    velocity = evidence.ratio("pbv_m_s", NONLINEAR, ELASTIC)
    words = f"Uplift {ratio(uplift)}; PBV {ratio(velocity)}."
    if uplift.direction >= 0:
        return Verdict(
            NOT_BORNE_OUT, words,
            "The uplift is not clearly lower: the interval of the median ratio or the sign test "
            "holds no difference.",
        )  # fmt: skip
    if velocity.direction >= 0:
        return Verdict(IN_PART, words, "Uplift is lower, but PBV not clearly.")
    return Verdict(BORNE_OUT, words)
