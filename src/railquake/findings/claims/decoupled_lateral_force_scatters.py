"""Decoupled, the lateral force is less clearly capped and scatters more.

Gomez & DeJong (2023), "Lateral forces in the train" and Figure 10:

    For the decoupled analyses, however, the lateral force cap is not as clear as for the coupled
    analyses, with much higher scatter in the data.
"""

from __future__ import annotations

from railquake.findings.claim import BORNE_OUT, Verdict, claim, graded, not_tested
from railquake.findings.evidence import Evidence
from railquake.findings.models import DECOUPLED, PIERS
from railquake.findings.words import interval, sentence


@claim(
    order=120,
    says="In decoupled analyses the cap is less clear and the lateral force scatters much more.",
)
def scatters_more(evidence: Evidence) -> Verdict:
    """By the scatter about both lines: its intervals are apart, or only its values larger."""
    levels = evidence.level_offs
    pairs = [
        (name, levels[name], levels[other])
        for name, other in DECOUPLED.items()
        if name in levels and other in levels
    ]
    pairs = [pair for pair in pairs if pair[1].scatter.known and pair[2].scatter.known]
    if not pairs:
        return not_tested("There are too few decoupled runs")
    words = sentence(
        f"{PIERS[name]}: scatter of ln force {interval(one.scatter)} coupled, "
        f"{interval(other.scatter)} decoupled; exponent beyond the knee "
        f"{interval(one.slope_beyond)} and {interval(other.slope_beyond)}"
        for name, one, other in pairs
    )
    verdict = graded(
        all(other.scatter.low > one.scatter.high for _, one, other in pairs),
        all(other.scatter.value > one.scatter.value for _, one, other in pairs),
    )
    why = (
        "The low-passed force scatters no more: the impacts by which the two models differ are "
        "filtered out of it."
    )
    return Verdict(verdict, words, "" if verdict == BORNE_OUT else why)
