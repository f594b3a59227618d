"""The lateral force is capped near friction.

Gomez & DeJong (2023), "Lateral forces in the train" and Figure 10:

    For the coupled analyses, the lateral forces are capped at a value that is slightly higher than
    the friction force, due to the curvature of the rails/wheel surface. Short-duration impact
    forces are not considered in the plots of maximum lateral force shown in Figure 10 ...
"""

from __future__ import annotations

from railquake.findings.claim import BORNE_OUT, IN_PART, NOT_BORNE_OUT, Verdict, claim, not_tested
from railquake.findings.evidence import Evidence
from railquake.findings.models import PIERS
from railquake.findings.words import capital, interval, number, sentence

SLIGHTLY_MORE = 1.3  # times friction x weight


@claim(
    order=110,
    says="In coupled analyses the lateral force, impacts filtered out, is capped at slightly more "
    "than the friction force.",
)
def capped(evidence: Evidence) -> Verdict:
    """By the growth of the force beyond the knee, and by its level there."""
    known = evidence.coupled_level_offs()
    if not known:
        return not_tested("There are too few coupled runs")
    words = sentence(
        f"{PIERS[name]}: exponent {interval(found.slope_beyond)} beyond the knee against "
        f"{interval(found.slope_before)} before, {interval(found.level)} times friction × weight "
        f"there, at most {number(found.highest)}"
        for name, found in known.items()
    )
    levels_off = [found.levels_off for found in known.values()]
    slows = [found.slows for found in known.values()]
    near = all(found.level.value <= SLIGHTLY_MORE for found in known.values())
    if all(levels_off) and near:
        return Verdict(BORNE_OUT, words)
    outcomes = [evidence.outcomes[name] for name in known]
    runs = sum(found.runs for found in outcomes)
    why = []
    if not near:
        why.append(
            f"A flange bears against its rail in {sum(found.flange for found in outcomes)} of "
            f"these {runs} runs: its contact is steep, so that the force is not friction’s alone"
        )
    if not all(levels_off):
        why.append(
            "The force still grows beyond the knee"
            + (", though more slowly" if any(slows) else "")
            + f"; a wheel lifts in {sum(found.lifted for found in outcomes)} of {runs} runs"
        )
    verdict = IN_PART if any(levels_off) or any(slows) else NOT_BORNE_OUT
    return Verdict(verdict, words, ". ".join(capital(text) for text in why) + ".")
