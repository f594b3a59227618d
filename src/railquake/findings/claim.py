"""What a claim of the paper is, and how far runs may bear it out.

A file in `claims` holds one: the paper's sentence, what is compared for it, the wording and the
verdict.  It is known by lying there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from railquake.findings.evidence import Evidence

__all__ = [
    "BORNE_OUT", "IN_PART", "NOT_BORNE_OUT", "NOT_TESTED", "Claim", "Finding", "Verdict", "claim",
    "graded", "not_tested",
]  # fmt: skip

BORNE_OUT, IN_PART, NOT_BORNE_OUT, NOT_TESTED = (
    "borne out", "in part", "not borne out", "not tested",
)  # fmt: skip


@dataclass(frozen=True)
class Finding:
    """A finding of the paper, and how far these runs bear it out.

    Attributes
    ----------
    claim : str
    verdict : str
        ``borne out``, ``in part``, ``not borne out``, ``not tested``.
    evidence : str
        With numbers.
    why : str
        Where it is not borne out: what in these runs stands against it.
    """

    claim: str
    verdict: str
    evidence: str
    why: str = ""


class Verdict(NamedTuple):
    """A `Finding` without the claim that it is about."""

    verdict: str
    evidence: str
    why: str = ""


Judge = Callable[..., Verdict]


@dataclass(frozen=True)
class Claim:
    """A claim of the paper.

    Attributes
    ----------
    order : int
        Place among the findings; steps of ten leave room between them.
    says : str
        As it stands in the report.
    needs : tuple of (str, str, str)
        Quantity, model and reference of the paired comparisons that it rests on; without any one
        of them it is not tested.
    judge : callable
        Evidence and those comparisons -> `Verdict`.
    """

    order: int
    says: str
    needs: tuple[tuple[str, str, str], ...]
    judge: Judge

    def test(self, evidence: Evidence) -> Finding:
        """How far the runs bear it out."""
        found = [evidence.ratio(*key) for key in self.needs]
        reasons = [item.missing for item in found if item.missing]
        verdict = not_tested(reasons[0]) if reasons else self.judge(evidence, *found)
        return Finding(self.says, *verdict)


def claim(
    *, order: int, says: str, needs: tuple[tuple[str, str, str], ...] = ()
) -> Callable[[Judge], Claim]:
    """Make a claim of the function that judges it; see `Claim`."""
    return lambda judge: Claim(order, says, needs, judge)


def not_tested(reason: str) -> Verdict:
    """The verdict where the runs cannot tell."""
    return Verdict(NOT_TESTED, f"{reason.capitalize()}.")


def graded(whole: bool, part: bool) -> str:
    """``borne out`` if the whole holds, ``in part`` if a part does."""
    return BORNE_OUT if whole else IN_PART if part else NOT_BORNE_OUT
