"""Trains derail by sliding off.

Gomez & DeJong (2023), "Running safety assessment":

    Since for all cases analyzed the derailments were observed to happen in a slide-off mode, the
    derailment condition can be defined as the wheelset-track relative rotation needed to begin the
    slide-off mode.
"""

from __future__ import annotations

from collections import Counter

from railquake.findings.claim import BORNE_OUT, Verdict, claim, graded, not_tested
from railquake.findings.evidence import Evidence

SLIDE_OFF = "slide-off"


@claim(order=100, says="All derailments are slide-offs.")
def slide_offs(evidence: Evidence) -> Verdict:
    """By the modes of all derailments of all models."""
    modes: Counter[str] = Counter()
    for found in evidence.outcomes.values():
        modes.update(found.modes)
    if not modes.total():
        return not_tested("No run derails")
    counts = ", ".join(f"{count} {mode}" for mode, count in sorted(modes.items()))
    words = f"Of {modes.total()} derailments: {counts}."
    verdict = graded(set(modes) == {SLIDE_OFF}, SLIDE_OFF in modes)
    if verdict == BORNE_OUT:
        return Verdict(verdict, words)
    return Verdict(
        verdict, words,
        "A wheelset slides off or climbs where a flange crosses its rail or the bearing wheel is "
        "displaced by more than the pair’s limit; it has overturned at a roll of 30° with a wheel "
        "still bearing. A linear car has no gravity to tip it over.",
    )  # fmt: skip
