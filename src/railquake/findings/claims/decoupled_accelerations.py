"""Decoupled accelerations are too large as well, though by less.

Gomez & DeJong (2023), "Comparison between coupled and decoupled analyses" and Figure 9:

    In terms of accelerations, the same behavior is observed, with larger values observed in the
    decoupled cases. The differences, however, are smaller than for the displacements.
"""

from __future__ import annotations

from railquake.findings.claim import BORNE_OUT, IN_PART, NOT_BORNE_OUT, Verdict, claim
from railquake.findings.comparison import PairedComparison
from railquake.findings.evidence import Evidence
from railquake.findings.models import DECOUPLED, ELASTIC
from railquake.findings.words import interval, ratio


@claim(
    order=70,
    says="Decoupled accelerations are larger too, with smaller differences than displacements have "
    "(elastic pier).",
    needs=(
        ("pba_m_s2", DECOUPLED[ELASTIC], ELASTIC),
        ("pbd_m", DECOUPLED[ELASTIC], ELASTIC),
    ),
)
def larger_by_less(
    _: Evidence, acceleration: PairedComparison, displacement: PairedComparison
) -> Verdict:
    """By the direction of PBA's ratio, and whether its interval ends below PBD's ratio."""
    words = f"PBA {ratio(acceleration)}; PBD {interval(displacement.median)} times."
    if acceleration.direction <= 0:
        return Verdict(NOT_BORNE_OUT, words, "They are not clearly larger.")
    if not acceleration.median.value < displacement.median.value:
        return Verdict(IN_PART, words, "They are larger, by no less than displacements are.")
    if not acceleration.median.high < displacement.median.value:
        return Verdict(IN_PART, words, "The two differences lie within each other’s intervals.")
    return Verdict(BORNE_OUT, words)
