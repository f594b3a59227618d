"""With an elastic pier, decoupled displacements are a tenth too large.

Gomez & DeJong (2023), "Comparison between coupled and decoupled analyses" and Figure 8a:

    If the model is linear elastic, the responses for the decoupled model were found to be about 10%
    larger, in mean, than the displacements of the coupled models.
"""

from __future__ import annotations

from railquake.findings.claim import BORNE_OUT, IN_PART, NOT_BORNE_OUT, Verdict, claim
from railquake.findings.comparison import PairedComparison
from railquake.findings.evidence import Evidence
from railquake.findings.models import DECOUPLED, ELASTIC
from railquake.findings.words import interval, ratio

TENTH = 1.1


@claim(
    order=50,
    says="With an elastic pier decoupled displacements are about 10 % larger, in the mean.",
    needs=(("pbd_m", DECOUPLED[ELASTIC], ELASTIC),),
)
def larger_by_a_tenth(_: Evidence, displacement: PairedComparison) -> Verdict:
    """By the interval of the geometric mean, which has to hold 1.1 and lie above 1."""
    mean = displacement.geometric_mean
    words = (
        f"PBD {interval(mean)} times in the geometric mean, {ratio(displacement)} in the median."
    )
    if mean.certain and mean.low <= TENTH <= mean.high and mean.low > 1.0:
        return Verdict(BORNE_OUT, words)
    if displacement.direction > 0:
        return Verdict(IN_PART, words, "They are larger, but not by about 10 %.")
    return Verdict(NOT_BORNE_OUT, words, "They are not clearly larger.")
