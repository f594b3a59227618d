"""The top of a decoupled elastic pier turns more, and the train is lifted more.

Gomez & DeJong (2023), "Comparison between coupled and decoupled analyses" and Figure 8b:

    A large difference was obtained in the peak rotations at the top of the column for nonlinear and
    linear analyses. ... this does influence the train response: more derailments and larger uplift
    values are obtained for decoupled linear elastic analyses, as shown in Figure 8b.
"""

from __future__ import annotations

from railquake.findings.claim import BORNE_OUT, Verdict, claim, graded
from railquake.findings.comparison import PairedComparison
from railquake.findings.evidence import Evidence
from railquake.findings.models import DECOUPLED, ELASTIC
from railquake.findings.words import capital, listed, ratio


@claim(
    order=80,
    says="The top’s rotation differs much, and with an elastic pier the decoupled model gives "
    "larger uplift and more derailments.",
    needs=(
        ("top_rotation_peak_rad", DECOUPLED[ELASTIC], ELASTIC),
        ("uplift_ratio", DECOUPLED[ELASTIC], ELASTIC),
    ),
)
def larger_rotation_and_uplift(
    evidence: Evidence, rotation: PairedComparison, uplift: PairedComparison
) -> Verdict:
    """By the directions of both ratios and the number of derailments."""
    one, other = evidence.outcomes[DECOUPLED[ELASTIC]], evidence.outcomes[ELASTIC]
    words = (
        f"Top rotation {ratio(rotation)}; uplift {ratio(uplift)}; {one.derailed} "
        f"decoupled and {other.derailed} coupled runs derail, {one.onset} and {other.onset} reach "
        "the onset."
    )
    against = {
        "the rotation is not clearly larger": not rotation.direction > 0,
        "the uplift is not clearly larger": not uplift.direction > 0,
        "no more runs derail": not one.derailed > other.derailed,
    }
    said = [text for text, holds in against.items() if holds]
    if not said:
        return Verdict(BORNE_OUT, words)
    verdict = graded(False, len(said) < len(against))
    return Verdict(verdict, words, f"{capital(listed(said))}.")
