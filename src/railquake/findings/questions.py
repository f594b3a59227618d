"""The paper's three questions and its findings, answered in sentences from the statistics.

Gomez & DeJong (2023), "Analytical parametric investigation of nonlinear train-structure
interaction under earthquake excitation".  Every sentence is made from the numbers of the runs at
hand; none is written for a result that is known beforehand.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from railquake.findings.comparison import PairedComparison, compare_models
from railquake.findings.correlation import Correlations, correlate
from railquake.findings.lateral import LevelOff, force_ratio, level_off
from railquake.findings.resampling import REPLICATES, Estimate, finished
from railquake.measures import paired, short_name

if TYPE_CHECKING:
    import pandas as pd

__all__ = [
    "BORNE_OUT", "ELASTIC", "IN_PART", "NONLINEAR", "NOT_BORNE_OUT", "NOT_TESTED", "Answer",
    "Evidence", "Finding", "Outcomes", "answer_questions", "gather",
]  # fmt: skip

ELASTIC, NONLINEAR = "coupled-elastic", "coupled-nonlinear"
DECOUPLED = {ELASTIC: "decoupled-elastic", NONLINEAR: "decoupled-nonlinear"}
AT_GRADE = "at-grade"
PIERS = {ELASTIC: "elastic pier", NONLINEAR: "nonlinear pier"}
MODELS = (ELASTIC, NONLINEAR, *DECOUPLED.values(), AT_GRADE)

BORNE_OUT, IN_PART, NOT_BORNE_OUT, NOT_TESTED = (
    "borne out", "in part", "not borne out", "not tested",
)  # fmt: skip

SIGNIFICANT = 0.05
CLOSE = (0.95, 1.05)  # a median ratio that an engineer would call equal


@dataclass(frozen=True)
class Outcomes:
    """How the runs of a model ended.

    Attributes
    ----------
    runs, flange, lifted, onset, derailed : int
        Finished runs; those in which a flange touched its rail; in which a wheel left its rail;
        that reached the onset; that left the track.
    modes : mapping of str to int
        Derailments by mode, sides together.
    """

    runs: int
    flange: int
    lifted: int
    onset: int
    derailed: int
    modes: Mapping[str, int]


@dataclass(frozen=True)
class Evidence:
    """All statistics that the sentences are made from.

    Attributes
    ----------
    correlations, within_level : mapping
        By model: uplift against the measures, over all runs and with the levels' means taken away.
    comparisons : mapping
        By quantity, model and reference.
    level_offs : mapping
        By model: lateral force against PBA.
    outcomes : mapping
        By model.
    """

    correlations: Mapping[str, Correlations] = field(default_factory=dict)
    within_level: Mapping[str, Correlations] = field(default_factory=dict)
    comparisons: Mapping[tuple[str, str, str], PairedComparison] = field(default_factory=dict)
    level_offs: Mapping[str, LevelOff] = field(default_factory=dict)
    outcomes: Mapping[str, Outcomes] = field(default_factory=dict)

    def ratio(self, quantity: str, model: str, reference: str) -> PairedComparison:
        """A comparison, or one that says why it is missing."""
        known = self.comparisons.get((quantity, model, reference))
        if known is not None:
            return known
        return PairedComparison(quantity, model, reference, missing="not compared")


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


def gather(
    table: pd.DataFrame, friction: Any = None, *, replicates: int = REPLICATES, seed: int = 0
) -> Evidence:
    """All statistics of a study.

    Parameters
    ----------
    table : DataFrame
        Rows of a study; with ``sa_t1_m_s2`` if that is to be compared.
    friction : float or array_like, optional
        mu of wheel on rail, of all runs or of each; by default the rows' own.
    replicates, seed : int
        Of the bootstrap.

    Returns
    -------
    Evidence
        Empty where the study has no axis ``model``.
    """
    if "model" not in table:
        return Evidence()
    options: dict[str, Any] = {"replicates": replicates, "seed": seed}
    present = [name for name in MODELS if (table["model"] == name).any()]
    ratio = force_ratio(table, friction)
    correlations, within, levels, outcomes = {}, {}, {}, {}
    for name in present:
        chosen = (table["model"] == name).to_numpy()
        rows = table[chosen]
        outcomes[name] = _outcomes(rows)
        correlations[name] = correlate(rows, **options)
        if "level" in rows and rows["level"].nunique() > 1:
            within[name] = correlate(rows, within="level", **options)
        levels[name] = level_off(rows, ratio[chosen], replicates=replicates // 2, seed=seed)
    pairs = [(NONLINEAR, ELASTIC)] + [(DECOUPLED[name], name) for name in (ELASTIC, NONLINEAR)]
    comparisons = {
        (quantity, model, reference): compare_models(table, quantity, model, reference, **options)
        for model, reference in pairs
        for quantity in paired()
    }
    return Evidence(correlations, within, comparisons, levels, outcomes)


def _outcomes(rows: pd.DataFrame) -> Outcomes:
    done = finished(rows)
    modes: dict[str, int] = {}
    for mode in done["derailment_mode"].dropna():
        kind = str(mode).removesuffix(" left").removesuffix(" right")
        modes[kind] = modes.get(kind, 0) + 1
    onset = done["status"].isin(("onset", "derailed")) | done["onset_first_s"].notna()
    return Outcomes(
        len(done),
        int(done["flange_contact_first_s"].notna().sum()),
        int((done["off_rail_time_s"] > 0.0).sum()),
        int(onset.sum()),
        int((done["status"] == "derailed").sum()),
        modes,
    )


def answer_questions(evidence: Evidence) -> tuple[tuple[Answer, ...], tuple[Finding, ...]]:
    """The three questions of the paper's introduction, and its findings one by one.

    Parameters
    ----------
    evidence : Evidence

    Returns
    -------
    answers : tuple of Answer, of length 3
    findings : tuple of Finding
    """
    answers = (_nonlinear(evidence), _decoupled(evidence), _overturning(evidence))
    findings = (
        _velocity_goes_with_uplift(evidence),
        _velocity_is_better(evidence),
        _nonlinear_lowers_uplift(evidence),
        _nonlinear_sometimes_raises(evidence),
        _decoupled_displacement(evidence),
        _decoupled_displacement_nonlinear(evidence),
        _decoupled_acceleration(evidence),
        _decoupled_rotation(evidence),
        _conservative(evidence),
        _slide_off(evidence),
        _force_is_capped(evidence),
        _decoupled_force_scatters(evidence),
    )
    return answers, findings


# --- words for numbers -----------------------------------------------------------------------


def number(value: float, digits: int = 2) -> str:
    """A number as it stands in a sentence."""
    if not math.isfinite(value):
        return "unknown"
    return f"{round(value, digits) + 0.0:.{digits}f}".replace("-", "\u2212")


def interval(estimate: Estimate, digits: int = 2) -> str:
    """A value with its 95 % interval."""
    if not estimate.certain:
        return number(estimate.value, digits)
    ends = f"{number(estimate.low, digits)} to {number(estimate.high, digits)}"
    return f"{number(estimate.value, digits)} ({ends})"


def chance(p: float) -> str:
    """A p-value."""
    if not math.isfinite(p):
        return "no sign test"
    return "p < 0.001" if p < 0.001 else f"p = {p:.3f}" if p < 0.1 else f"p = {p:.2f}"


def _direction(found: PairedComparison) -> int:
    """1 up, -1 down, 0 not to be told: by the interval of the median, and the sign test."""
    if found.missing or not math.isfinite(found.p_value) or found.p_value >= SIGNIFICANT:
        return 0
    if found.median.above(1.0):
        return 1
    return -1 if found.median.below(1.0) else 0


def _ratio_words(found: PairedComparison) -> str:
    """The ratio with its interval and sign test."""
    if found.missing:
        return found.missing
    return f"{interval(found.median)} times, {_split(found)}"


def _split(found: PairedComparison) -> str:
    """For how many records it is higher, or lower, and the sign test."""
    most = max(found.records_above, found.records_below)
    way = "higher" if found.records_above >= found.records_below else "lower"
    return f"{way} for {most} of {found.records} records, {chance(found.p_value)}"


def _sentence(parts: list[str]) -> str:
    """Parts as one sentence."""
    text = "; ".join(parts)
    return f"{text[0].upper()}{text[1:]}."


def _runs(count: int, of: int) -> str:
    return f"{count} of {of} runs"


# --- the three questions ---------------------------------------------------------------------

Q1 = (
    "Does the nonlinear behavior of the structure influence the running safety of the train under "
    "seismic loading?"
)
Q2 = (
    "Is a decoupled train-structure model sufficiently accurate to capture the response of the "
    "structure and the train?"
)
Q3 = "Does overturning limit the lateral force the train transmits to the structure?"


def _nonlinear(evidence: Evidence) -> Answer:
    uplift = evidence.ratio("uplift_ratio", NONLINEAR, ELASTIC)
    if uplift.missing:
        return Answer(Q1, "Not tested here", f"These runs cannot tell: {uplift.missing}.")
    velocity = evidence.ratio("pbv_m_s", NONLINEAR, ELASTIC)
    sign = _direction(uplift)
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
        f"its 95 % interval); {_split(uplift)}."
    )
    if not velocity.missing:
        sentence += f" The bridge’s peak velocity is {interval(velocity.median)} times as high."
    if sign and (uplift.above if sign < 0 else uplift.below):
        against = uplift.above if sign < 0 else uplift.below
        way = "higher" if sign < 0 else "lower"
        sentence += f" It is no rule without exception: in {against} pairs it is {way}."
    sentence += (
        f" The onset of slide-off is reached in {_runs(one.onset, one.runs)} with the nonlinear "
        f"pier and in {other.onset} of {other.runs} with the elastic one; {one.derailed} and "
        f"{other.derailed} derail."
    )
    return Answer(Q1, short, sentence)


def _decoupled(evidence: Evidence) -> Answer:
    parts, structure, train = [], [], []
    reasons: list[str] = []
    for name, word in ((ELASTIC, "elastic"), (NONLINEAR, "nonlinear")):
        found = {
            quantity: evidence.ratio(quantity, DECOUPLED[name], name)
            for quantity in ("pbd_m", "pba_m_s2", "uplift_ratio")
        }
        if found["pbd_m"].missing or found["uplift_ratio"].missing:
            reasons.append(found["pbd_m"].missing or found["uplift_ratio"].missing)
            continue
        lift = found["uplift_ratio"]
        parts.append(
            f"With the {word} pier the decoupled model gives {interval(found['pbd_m'].median)} "
            f"times the coupled one’s peak displacement, {interval(found['pba_m_s2'].median)} "
            f"times its acceleration and {interval(lift.median)} times its uplift (medians of "
            f"{lift.pairs} pairs; single pairs scatter by a factor of about "
            f"{number(math.exp(found['pbd_m'].scatter))} in displacement and "
            f"{number(math.exp(lift.scatter))} in uplift); it understates the uplift in "
            f"{lift.below} pairs."
        )
        structure.append(CLOSE[0] <= found["pbd_m"].median.value <= CLOSE[1])
        train.append(_direction(lift))
    if not parts:
        return Answer(Q2, "Not tested here", f"These runs cannot tell: {reasons[0]}.")
    if all(structure):
        short = "For the structure, in the median"
    elif any(structure):
        short = "For the structure only where it is nonlinear, in the median"
        if structure[0]:
            short = "For the structure only where it is elastic, in the median"
    else:
        short = "Only roughly"
    if all(sign > 0 for sign in train):
        short += "; for the train it errs on the safe side as a rule"
    elif all(sign < 0 for sign in train):
        short += "; for the train it is unsafe as a rule"
    else:
        short += "; for the train it is not safe throughout"
    return Answer(Q2, short, " ".join(parts))


def _overturning(evidence: Evidence) -> Answer:
    known = [
        (name, word, evidence.level_offs[name])
        for name, word in ((ELASTIC, "elastic"), (NONLINEAR, "nonlinear"))
        if name in evidence.level_offs and evidence.level_offs[name].slope_beyond.known
    ]
    if not known:
        reasons = [found.missing for found in evidence.level_offs.values() if found.missing]
        reason = reasons[0] if reasons else "the study has no coupled model"
        return Answer(Q3, "Not tested here", f"These runs cannot tell: {reason}.")
    parts = [
        f"With the coupled {word} model the peak lateral force, short impacts filtered out, grows "
        f"as PBA to the power {interval(found.slope_before)} up to a PBA of "
        f"{number(found.knee.value, 1)} m/s² and to the power {interval(found.slope_beyond)} "
        f"beyond; there it is {interval(found.level)} times friction × weight in the median, and "
        f"at most {number(found.highest)} times."
        for name, word, found in known
    ]
    lifted = sum(evidence.outcomes[name].lifted for name, _, _ in known)
    runs = sum(evidence.outcomes[name].runs for name, _, _ in known)
    parts.append(f"A wheel lifts off its rail in {lifted} of these {runs} runs.")
    capped = [found.levels_off for _, _, found in known]
    slower = [found.slows for _, _, found in known]
    if all(capped):
        short = "Yes: the force levels off"
    elif any(capped):
        short = "In part: the force levels off with one of the piers only"
    elif any(slower):
        short = "It slows the growth of the force, but sets no cap within the range of these runs"
    else:
        short = "No cap within the range of these runs"
    return Answer(Q3, short, " ".join(parts))


# --- the findings ----------------------------------------------------------------------------


def _velocity_goes_with_uplift(evidence: Evidence) -> Finding:
    claim = "Peak bridge velocity is well correlated with uplift."
    known = {
        name: found.of("pbv_m_s")
        for name, found in evidence.correlations.items()
        if name in (ELASTIC, NONLINEAR) and found.of("pbv_m_s") is not None
    }
    if not known:
        return Finding(claim, NOT_TESTED, "There are too few coupled runs.")
    words, values = [], []
    for name, item in known.items():
        assert item is not None
        values.append(item.spearman)
        words.append(
            f"{PIERS[name]}: Spearman’s ρ {interval(item.spearman)}, scatter about a power law β "
            f"{interval(item.dispersion)}"
        )
    good = [estimate.certain and estimate.low > 0.7 for estimate in values]
    verdict = (
        BORNE_OUT if all(good) else IN_PART if any(v.above(0.0) for v in values) else NOT_BORNE_OUT
    )
    why = ""
    if verdict != BORNE_OUT:
        why = "The intervals of ρ do not lie above 0.7, which is taken as well correlated here."
    return Finding(claim, verdict, _sentence(words), why)


def _velocity_is_better(evidence: Evidence) -> Finding:
    claim = (
        "Peak bridge velocity is the better measure: uplift depends less on the ground motion’s "
        "peaks (PGA, PGV), and a single spike of acceleration (PBA) does not derail."
    )
    words: list[str] = []
    better, worse, open_ones = [], [], []
    for name in (ELASTIC, NONLINEAR):
        if name not in evidence.correlations:
            continue
        over_all, within = evidence.correlations[name], evidence.within_level.get(name)
        for difference in over_all.differences:
            inside = within.against(difference.other) if within is not None else None
            signs = [difference.spearman] + ([inside.spearman] if inside is not None else [])
            label = f"{short_name(difference.other)} ({PIERS[name]})"
            if any(s.below(0.0) for s in signs):
                worse.append(label)
            elif any(s.above(0.0) for s in signs):
                better.append(label)
            else:
                open_ones.append(label)
        listed = ", ".join(
            f"{short_name(d.other)} {interval(d.spearman)}" for d in over_all.differences
        )
        if listed:
            words.append(f"{PIERS[name]}: ρ of PBV less that of {listed}")
        if within is not None and within.differences:
            listed = ", ".join(
                f"{short_name(d.other)} {interval(d.spearman)}" for d in within.differences
            )
            words.append(f"within a level: {listed}")
    if not words:
        return Finding(claim, NOT_TESTED, "There are too few coupled runs to compare measures.")
    if better and not worse and not open_ones:
        return Finding(claim, BORNE_OUT, _sentence(words))
    verdict = IN_PART if better else NOT_BORNE_OUT
    why = []
    if open_ones:
        why.append(
            f"The intervals against {_listed(open_ones)} hold zero: with so few records these "
            "measures cannot be told apart, for over the levels all of them grow together"
        )
    if worse:
        why.append(f"{_listed(worse)} goes better with uplift than PBV does")
    return Finding(claim, verdict, _sentence(words), ". ".join(why) + ".")


def _listed(items: list[str]) -> str:
    return items[0] if len(items) == 1 else ", ".join(items[:-1]) + " and " + items[-1]


def _nonlinear_lowers_uplift(evidence: Evidence) -> Finding:
    claim = "A nonlinear pier gives generally smaller uplift, since its peak velocities are lower."
    uplift = evidence.ratio("uplift_ratio", NONLINEAR, ELASTIC)
    velocity = evidence.ratio("pbv_m_s", NONLINEAR, ELASTIC)
    if uplift.missing:
        return Finding(claim, NOT_TESTED, f"{uplift.missing.capitalize()}.")
    evidence_words = f"Uplift {_ratio_words(uplift)}; PBV {_ratio_words(velocity)}."
    signs = _direction(uplift), _direction(velocity)
    if signs == (-1, -1):
        return Finding(claim, BORNE_OUT, evidence_words)
    if signs[0] == -1:
        return Finding(claim, IN_PART, evidence_words, "Uplift is lower, but PBV not clearly.")
    return Finding(
        claim, NOT_BORNE_OUT, evidence_words,
        "The uplift is not clearly lower: the interval of the median ratio or the sign test holds "
        "no difference.",
    )  # fmt: skip


def _nonlinear_sometimes_raises(evidence: Evidence) -> Finding:
    claim = (
        "In some cases the damaged, softer pier amplifies the motion, and uplift and the "
        "likelihood of derailment grow."
    )
    uplift = evidence.ratio("uplift_ratio", NONLINEAR, ELASTIC)
    if uplift.missing:
        return Finding(claim, NOT_TESTED, f"{uplift.missing.capitalize()}.")
    one, other = evidence.outcomes[NONLINEAR], evidence.outcomes[ELASTIC]
    words = (
        f"Uplift is higher in {uplift.above} of {uplift.pairs} pairs; {one.onset} nonlinear and "
        f"{other.onset} elastic runs reach the onset, {one.derailed} and {other.derailed} derail."
    )
    if uplift.above == 0:
        return Finding(claim, NOT_BORNE_OUT, words, "There is no such pair among these runs.")
    if one.onset > other.onset or one.derailed > other.derailed:
        return Finding(claim, BORNE_OUT, words)
    return Finding(
        claim, IN_PART, words,
        "Uplift does grow in some pairs, but no more of the nonlinear runs reach the onset.",
    )  # fmt: skip


def _decoupled_displacement(evidence: Evidence) -> Finding:
    claim = "With an elastic pier decoupled displacements are about 10 % larger, in the mean."
    found = evidence.ratio("pbd_m", DECOUPLED[ELASTIC], ELASTIC)
    if found.missing:
        return Finding(claim, NOT_TESTED, f"{found.missing.capitalize()}.")
    mean = found.geometric_mean
    words = (
        f"PBD {interval(mean)} times in the geometric mean, {_ratio_words(found)} in the median."
    )
    if mean.certain and mean.low <= 1.1 <= mean.high and mean.low > 1.0:
        return Finding(claim, BORNE_OUT, words)
    if _direction(found) > 0:
        return Finding(claim, IN_PART, words, "They are larger, but not by about 10 %.")
    return Finding(claim, NOT_BORNE_OUT, words, "They are not clearly larger.")


def _decoupled_displacement_nonlinear(evidence: Evidence) -> Finding:
    claim = "With a nonlinear pier the differences in displacement tend to disappear."
    found = evidence.ratio("pbd_m", DECOUPLED[NONLINEAR], NONLINEAR)
    elastic = evidence.ratio("pbd_m", DECOUPLED[ELASTIC], ELASTIC)
    if found.missing:
        return Finding(claim, NOT_TESTED, f"{found.missing.capitalize()}.")
    words = (
        f"PBD {_ratio_words(found)}; single pairs scatter by a factor of "
        f"{number(math.exp(found.scatter))}."
    )
    near = CLOSE[0] <= found.median.value <= CLOSE[1]
    if near and _direction(found) == 0:
        return Finding(claim, BORNE_OUT, words)
    off = abs(math.log(found.median.value))
    if not elastic.missing and off < abs(math.log(elastic.median.value)):
        return Finding(claim, IN_PART, words, "They are smaller than with an elastic pier.")
    return Finding(claim, NOT_BORNE_OUT, words, "They do not disappear.")


def _decoupled_acceleration(evidence: Evidence) -> Finding:
    claim = (
        "Decoupled accelerations are larger too, with smaller differences than displacements have "
        "(elastic pier)."
    )
    found = evidence.ratio("pba_m_s2", DECOUPLED[ELASTIC], ELASTIC)
    shift = evidence.ratio("pbd_m", DECOUPLED[ELASTIC], ELASTIC)
    if found.missing or shift.missing:
        return Finding(claim, NOT_TESTED, f"{(found.missing or shift.missing).capitalize()}.")
    words = f"PBA {_ratio_words(found)}; PBD {interval(shift.median)} times."
    larger = _direction(found) > 0
    smaller = found.median.value < shift.median.value
    if larger and smaller:
        apart = found.median.high < shift.median.value
        remark = "" if apart else "The two differences lie within each other’s intervals."
        return Finding(claim, BORNE_OUT if apart else IN_PART, words, remark)
    if larger:
        return Finding(claim, IN_PART, words, "They are larger, by no less than displacements are.")
    return Finding(claim, NOT_BORNE_OUT, words, "They are not clearly larger.")


def _decoupled_rotation(evidence: Evidence) -> Finding:
    claim = (
        "The top’s rotation differs much, and with an elastic pier the decoupled model gives "
        "larger uplift and more derailments."
    )
    turn = evidence.ratio("top_rotation_peak_rad", DECOUPLED[ELASTIC], ELASTIC)
    uplift = evidence.ratio("uplift_ratio", DECOUPLED[ELASTIC], ELASTIC)
    if turn.missing or uplift.missing:
        return Finding(claim, NOT_TESTED, f"{(turn.missing or uplift.missing).capitalize()}.")
    one, other = evidence.outcomes[DECOUPLED[ELASTIC]], evidence.outcomes[ELASTIC]
    words = (
        f"Top rotation {_ratio_words(turn)}; uplift {_ratio_words(uplift)}; {one.derailed} "
        f"decoupled and {other.derailed} coupled runs derail, {one.onset} and {other.onset} reach "
        "the onset."
    )
    checks = _direction(turn) > 0, _direction(uplift) > 0, one.derailed > other.derailed
    if all(checks):
        return Finding(claim, BORNE_OUT, words)
    said = ("the rotation is not clearly larger", "the uplift is not clearly larger",
            "no more runs derail")  # fmt: skip
    why = _listed([text for text, holds in zip(said, checks, strict=True) if not holds])
    verdict = IN_PART if any(checks) else NOT_BORNE_OUT
    return Finding(claim, verdict, words, f"{why[0].upper()}{why[1:]}.")


def _conservative(evidence: Evidence) -> Finding:
    claim = "A decoupled analysis tends to be conservative for the train."
    found = [evidence.ratio("uplift_ratio", DECOUPLED[name], name) for name in (ELASTIC, NONLINEAR)]
    known = [item for item in found if not item.missing]
    if not known:
        return Finding(claim, NOT_TESTED, f"{found[0].missing.capitalize()}.")
    words = "; ".join(
        f"{PIERS[item.reference]}: uplift {_ratio_words(item)}, understated in {item.below} of "
        f"{item.pairs} pairs"
        for item in known
    )
    signs = [_direction(item) for item in known]
    if all(sign > 0 for sign in signs):
        return Finding(claim, BORNE_OUT, _sentence([words]))
    verdict = IN_PART if any(sign > 0 for sign in signs) else NOT_BORNE_OUT
    return Finding(
        claim, verdict, _sentence([words]), "The uplift is not clearly larger throughout."
    )


def _slide_off(evidence: Evidence) -> Finding:
    claim = "All derailments are slide-offs."
    modes: dict[str, int] = {}
    for found in evidence.outcomes.values():
        for mode, count in found.modes.items():
            modes[mode] = modes.get(mode, 0) + count
    total = sum(modes.values())
    if not total:
        return Finding(claim, NOT_TESTED, "No run derails.")
    words = ", ".join(f"{count} {mode}" for mode, count in sorted(modes.items()))
    words = f"Of {total} derailments: {words}."
    if set(modes) == {"slide-off"}:
        return Finding(claim, BORNE_OUT, words)
    verdict = IN_PART if "slide-off" in modes else NOT_BORNE_OUT
    return Finding(
        claim, verdict, words,
        "A run counts as overturned once the vehicle’s centre of gravity is beyond a rail while "
        "the onset holds; without bump stops the car body sways further than a real one, and may "
        "bring it there before the flange tip has crossed the rail.",
    )  # fmt: skip


def _force_is_capped(evidence: Evidence) -> Finding:
    claim = (
        "In coupled analyses the lateral force, impacts filtered out, is capped at slightly more "
        "than the friction force."
    )
    known = [
        (name, evidence.level_offs[name])
        for name in (ELASTIC, NONLINEAR)
        if name in evidence.level_offs and evidence.level_offs[name].slope_beyond.known
    ]
    if not known:
        return Finding(claim, NOT_TESTED, "There are too few coupled runs.")
    words = "; ".join(
        f"{PIERS[name]}: exponent {interval(found.slope_beyond)} beyond the knee against "
        f"{interval(found.slope_before)} before, {interval(found.level)} times friction × weight "
        f"there, at most {number(found.highest)}"
        for name, found in known
    )
    capped = [found.levels_off for _, found in known]
    near = [found.level.value <= 1.3 for _, found in known]
    if all(capped) and all(near):
        return Finding(claim, BORNE_OUT, _sentence([words]))
    slower = [found.slows for _, found in known]
    outcomes = [evidence.outcomes[name] for name, _ in known]
    runs = sum(found.runs for found in outcomes)
    why = []
    if not all(near):
        why.append(
            f"A flange bears against its rail in {sum(found.flange for found in outcomes)} of "
            f"these {runs} runs: its contact is steep, so that the force is not friction’s alone"
        )
    if not all(capped):
        why.append(
            "The force still grows beyond the knee"
            + (", though more slowly" if any(slower) else "")
            + f"; a wheel lifts in {sum(found.lifted for found in outcomes)} of {runs} runs"
        )
    verdict = IN_PART if any(capped) or any(slower) else NOT_BORNE_OUT
    return Finding(
        claim, verdict, _sentence([words]), ". ".join(t[0].upper() + t[1:] for t in why) + "."
    )


def _decoupled_force_scatters(evidence: Evidence) -> Finding:
    claim = "In decoupled analyses the cap is less clear and the lateral force scatters much more."
    known = [
        (evidence.level_offs[name], evidence.level_offs[DECOUPLED[name]], name)
        for name in (ELASTIC, NONLINEAR)
        if name in evidence.level_offs and DECOUPLED[name] in evidence.level_offs
    ]
    known = [item for item in known if item[0].scatter.known and item[1].scatter.known]
    if not known:
        return Finding(claim, NOT_TESTED, "There are too few decoupled runs.")
    words = "; ".join(
        f"{PIERS[name]}: scatter of ln force {interval(one.scatter)} coupled, "
        f"{interval(other.scatter)} decoupled; exponent beyond the knee "
        f"{interval(one.slope_beyond)} and {interval(other.slope_beyond)}"
        for one, other, name in known
    )
    more = [other.scatter.low > one.scatter.high for one, other, _ in known]
    larger = [other.scatter.value > one.scatter.value for one, other, _ in known]
    if all(more):
        return Finding(claim, BORNE_OUT, _sentence([words]))
    verdict = IN_PART if all(larger) else NOT_BORNE_OUT
    return Finding(
        claim, verdict, _sentence([words]),
        "The low-passed force scatters no more: the impacts by which the two models differ are "
        "filtered out of it.",
    )  # fmt: skip
