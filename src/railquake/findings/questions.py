"""The paper's three questions and its findings, answered in sentences from the statistics.

Gomez & DeJong (2023), "Analytical parametric investigation of nonlinear train-structure
interaction under earthquake excitation": the questions stand at the end of its introduction, the
findings in `claims`.  Every sentence is made from the numbers of the runs at hand; none is written
for a result that is known beforehand.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from railquake.findings.claim import Finding
from railquake.findings.claims import every_claim
from railquake.findings.evidence import Evidence
from railquake.findings.models import DECOUPLED, ELASTIC, NONLINEAR
from railquake.findings.words import interval, number, split

__all__ = ["DECOUPLED", "ELASTIC", "NONLINEAR", "Answer", "answer_questions", "interval"]

Q1 = (
    "Does the nonlinear behavior of the structure influence the running safety of the train under "
    "seismic loading?"
)
Q2 = (
    "Is a decoupled train-structure model sufficiently accurate to capture the response of the "
    "structure and the train?"
)
Q3 = "Does overturning limit the lateral force the train transmits to the structure?"

PIER = {ELASTIC: "elastic", NONLINEAR: "nonlinear"}


@dataclass(frozen=True)
class Answer:
    """A question of the paper with its answer.

    Attributes
    ----------
    question, short, sentence : str
        The short answer is a few words; the sentence holds numbers and intervals.
    """

    question: str
    short: str
    sentence: str


def answer_questions(evidence: Evidence) -> tuple[tuple[Answer, ...], tuple[Finding, ...]]:
    """The three questions of the paper's introduction, and its findings one by one.

    Parameters
    ----------
    evidence : Evidence

    Returns
    -------
    answers : tuple of Answer, of length 3
    findings : tuple of Finding
        One for each file in `claims`.
    """
    answers = (_nonlinear(evidence), _decoupled(evidence), _overturning(evidence))
    return answers, tuple(claim.test(evidence) for claim in every_claim())


def _not_tested(question: str, reason: str) -> Answer:
    return Answer(question, "Not tested here", f"These runs cannot tell: {reason}.")


def _nonlinear(evidence: Evidence) -> Answer:
    uplift = evidence.ratio("uplift_ratio", NONLINEAR, ELASTIC)
    if uplift.missing:
        return _not_tested(Q1, uplift.missing)
    velocity = evidence.ratio("pbv_m_s", NONLINEAR, ELASTIC)
    sign = uplift.direction
    short = {
        -1: "Yes: as a rule it lowers the uplift",
        0: "No clear influence on the uplift",
        1: "Yes: as a rule it raises the uplift",
    }[sign]
    one, other = evidence.outcomes[NONLINEAR], evidence.outcomes[ELASTIC]
    if sign < 0 and one.onset > other.onset:
        short += ", though more runs reach the onset"
    sentence = (
        f"With a nonlinear pier the peak uplift is {interval(uplift.median)} times that with an "
        f"elastic one (median of {uplift.pairs} pairs of runs that differ in nothing else, with "
        f"its 95 % interval); {split(uplift)}."
    )
    if not velocity.missing:
        sentence += f" The bridge’s peak velocity is {interval(velocity.median)} times as high."
    against = {-1: uplift.above, 0: 0, 1: uplift.below}[sign]
    if against:
        way = "higher" if sign < 0 else "lower"
        sentence += f" It is no rule without exception: in {against} pairs it is {way}."
    sentence += (
        f" The onset of slide-off is reached in {one.onset} of {one.runs} runs with the nonlinear "
        f"pier and in {other.onset} of {other.runs} with the elastic one; {one.derailed} and "
        f"{other.derailed} derail."
    )
    return Answer(Q1, short, sentence)


def _decoupled(evidence: Evidence) -> Answer:
    parts, structure, train = [], {}, []
    reasons: list[str] = []
    for name, word in PIER.items():
        displacement, acceleration, uplift = (
            evidence.ratio(quantity, DECOUPLED[name], name)
            for quantity in ("pbd_m", "pba_m_s2", "uplift_ratio")
        )
        if displacement.missing or uplift.missing:
            reasons.append(displacement.missing or uplift.missing)
            continue
        parts.append(
            f"With the {word} pier the decoupled model gives {interval(displacement.median)} "
            f"times the coupled one’s peak displacement, {interval(acceleration.median)} "
            f"times its acceleration and {interval(uplift.median)} times its uplift (medians of "
            f"{uplift.pairs} pairs; single pairs scatter by a factor of about "
            f"{number(math.exp(displacement.scatter))} in displacement and "
            f"{number(math.exp(uplift.scatter))} in uplift); it understates the uplift in "
            f"{uplift.below} pairs."
        )
        structure[word] = displacement.close
        train.append(uplift.direction)
    if not parts:
        return _not_tested(Q2, reasons[0])
    short = f"{_for_the_structure(structure)}; {_for_the_train(train)}"
    return Answer(Q2, short, " ".join(parts))


def _for_the_structure(close: dict[str, bool]) -> str:
    """Short answer by whether the displacements agree, for each pier that was compared."""
    if all(close.values()):
        return "For the structure, in the median"
    for word, agrees in close.items():
        if agrees:
            return f"For the structure only where it is {word}, in the median"
    return "Only roughly"


def _for_the_train(directions: list[int]) -> str:
    """Short answer by where the uplift errs to."""
    if all(sign > 0 for sign in directions):
        return "for the train it errs on the safe side as a rule"
    if all(sign < 0 for sign in directions):
        return "for the train it is unsafe as a rule"
    return "for the train it is not safe throughout"


def _overturning(evidence: Evidence) -> Answer:
    known = evidence.coupled_level_offs()
    if not known:
        reasons = [found.missing for found in evidence.level_offs.values() if found.missing]
        return _not_tested(Q3, reasons[0] if reasons else "the study has no coupled model")
    parts = [
        f"With the coupled {PIER[name]} model the peak lateral force, short impacts filtered out, "
        f"grows as PBA to the power {interval(found.slope_before)} up to a PBA of "
        f"{number(found.knee.value, 1)} m/s² and to the power {interval(found.slope_beyond)} "
        f"beyond; there it is {interval(found.level)} times friction × weight in the median, and "
        f"at most {number(found.highest)} times."
        for name, found in known.items()
    ]
    lifted = sum(evidence.outcomes[name].lifted for name in known)
    runs = sum(evidence.outcomes[name].runs for name in known)
    parts.append(f"A wheel lifts off its rail in {lifted} of these {runs} runs.")
    levels_off = [found.levels_off for found in known.values()]
    if all(levels_off):
        short = "Yes: the force levels off"
    elif any(levels_off):
        short = "In part: the force levels off with one of the piers only"
    elif any(found.slows for found in known.values()):
        short = "It slows the growth of the force, but sets no cap within the range of these runs"
    else:
        short = "No cap within the range of these runs"
    return Answer(Q3, short, " ".join(parts))
