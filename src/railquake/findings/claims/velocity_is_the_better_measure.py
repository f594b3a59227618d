"""Peak bridge velocity is a better measure than the ground motion's peaks, or than PBA.

Gomez & DeJong (2023), "Running safety assessment" and Figure 7:

    ... the response of the train does not depend as much on the ground motion characteristics
    (PGDV or PGA) as it does on the structural displacements, velocities and accelerations. ... a
    single acceleration spike does not generate derailment, but a consistent acceleration in one
    direction is needed to reach the point where the system derails.
"""

from __future__ import annotations

from collections.abc import Iterable

from railquake.findings.claim import BORNE_OUT, IN_PART, NOT_BORNE_OUT, Verdict, claim, not_tested
from railquake.findings.correlation import Difference
from railquake.findings.evidence import Evidence
from railquake.findings.models import COUPLED, PIERS
from railquake.findings.words import interval, listed, sentence
from railquake.measures import short_name

BETTER, WORSE, OPEN = "better", "worse", "open"


@claim(
    order=20,
    says="Peak bridge velocity is the better measure: uplift depends less on the ground motion’s "
    "peaks (PGA, PGV), and a single spike of acceleration (PBA) does not derail.",
)
def better_measure(evidence: Evidence) -> Verdict:
    """By the intervals of the differences of rank correlation, on the same bootstrap samples."""
    words: list[str] = []
    measures: dict[str, list[str]] = {BETTER: [], WORSE: [], OPEN: []}
    for name in COUPLED:
        if name not in evidence.correlations:
            continue
        over_all = evidence.correlations[name].differences
        within = evidence.within_level.get(name)
        for difference in over_all:
            inside = None if within is None else within.against(difference.other)
            label = f"{short_name(difference.other)} ({PIERS[name]})"
            measures[_side(difference, inside)].append(label)
        if over_all:
            words.append(f"{PIERS[name]}: ρ of PBV less that of {_numbers(over_all)}")
        if within is not None and within.differences:
            words.append(f"within a level: {_numbers(within.differences)}")
    if not words:
        return not_tested("There are too few coupled runs to compare measures")
    if measures[BETTER] and not measures[WORSE] and not measures[OPEN]:
        return Verdict(BORNE_OUT, sentence(words))
    why = []
    if measures[OPEN]:
        why.append(
            f"The intervals against {listed(measures[OPEN])} hold zero: with so few records these "
            "measures cannot be told apart, for over the levels all of them grow together"
        )
    if measures[WORSE]:
        why.append(f"{listed(measures[WORSE])} goes better with uplift than PBV does")
    verdict = IN_PART if measures[BETTER] else NOT_BORNE_OUT
    return Verdict(verdict, sentence(words), ". ".join(why) + ".")


def _side(over_all: Difference, within: Difference | None) -> str:
    """Whether PBV is the better measure, over all runs or within a level."""
    signs = [found.spearman for found in (over_all, within) if found is not None]
    if any(s.below(0.0) for s in signs):
        return WORSE
    return BETTER if any(s.above(0.0) for s in signs) else OPEN


def _numbers(differences: Iterable[Difference]) -> str:
    return ", ".join(f"{short_name(d.other)} {interval(d.spearman)}" for d in differences)
