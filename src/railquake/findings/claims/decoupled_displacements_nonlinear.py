"""With a nonlinear pier, decoupled displacements are those of the coupled model.

Gomez & DeJong (2023), "Comparison between coupled and decoupled analyses" and Figure 8a:

    For nonlinear models, the differences tend to disappear, since the nonlinear model is able to
    dissipate the large energy caused by the instantaneous impacts in the decoupled model.
"""

from __future__ import annotations

import math

from railquake.findings.claim import BORNE_OUT, IN_PART, NOT_BORNE_OUT, Verdict, claim
from railquake.findings.comparison import PairedComparison
from railquake.findings.evidence import Evidence
from railquake.findings.models import DECOUPLED, ELASTIC, NONLINEAR
from railquake.findings.words import number, ratio


@claim(
    order=60,
    says="With a nonlinear pier the differences in displacement tend to disappear.",
    needs=(("pbd_m", DECOUPLED[NONLINEAR], NONLINEAR),),
)
def differences_disappear(evidence: Evidence, displacement: PairedComparison) -> Verdict:
    """By a median close to 1 and not clearly off it; in part if nearer than the elastic pier's."""
    words = (
        f"PBD {ratio(displacement)}; single pairs scatter by a factor of "
        f"{number(math.exp(displacement.scatter))}."
    )
    if displacement.close and displacement.direction == 0:
        return Verdict(BORNE_OUT, words)
    elastic = evidence.ratio("pbd_m", DECOUPLED[ELASTIC], ELASTIC)
    off = abs(math.log(displacement.median.value))
    if not elastic.missing and off < abs(math.log(elastic.median.value)):
        return Verdict(IN_PART, words, "They are smaller than with an elastic pier.")
    return Verdict(NOT_BORNE_OUT, words, "They do not disappear.")
