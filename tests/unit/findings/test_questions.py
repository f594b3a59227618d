"""Sentences: they follow the numbers, in both directions, and say what they cannot tell."""

import pytest

from made_up_runs import table
from railquake.findings import Evidence, answer_questions, gather
from railquake.findings.claim import BORNE_OUT, IN_PART, NOT_BORNE_OUT, NOT_TESTED
from railquake.findings.resampling import Estimate
from railquake.findings.words import chance, interval, number

FEW = 60  # replicates


def answers(**options):
    return answer_questions(gather(table(**options), 0.3, replicates=FEW))


def finding(findings, start):
    (found,) = [item for item in findings if item.claim.startswith(start)]
    return found


@pytest.mark.parametrize(
    ("ratio", "short", "verdict"),
    [(0.8, "Yes: as a rule it lowers", BORNE_OUT),
     (1.25, "Yes: as a rule it raises", NOT_BORNE_OUT),
     (1.0, "No clear influence", NOT_BORNE_OUT)],
)  # fmt: skip
def test_the_nonlinear_pier_s_influence_is_told_as_it_is(ratio, short, verdict):
    changes = {("coupled-nonlinear", q): ratio for q in ("uplift_ratio", "pbv_m_s")}
    (first, _, _), findings = answers(ratios=changes)
    assert first.short.startswith(short)
    if ratio != 1.0:
        assert number(ratio) in first.sentence
    assert finding(findings, "A nonlinear pier gives generally smaller").verdict == verdict


@pytest.mark.parametrize(
    ("ratio", "verdict"),
    [(1.1, BORNE_OUT), (1.3, IN_PART), (1.0, NOT_BORNE_OUT), (0.9, NOT_BORNE_OUT)],
)
def test_ten_per_cent_of_decoupled_displacement_is_borne_out_only_where_it_is_there(ratio, verdict):
    _, findings = answers(ratios={("decoupled-elastic", "pbd_m"): ratio})
    found = finding(findings, "With an elastic pier decoupled displacements")
    assert found.verdict == verdict
    assert (found.why == "") == (verdict == BORNE_OUT)


def test_a_decoupled_model_on_the_unsafe_side_is_called_so():
    changes = {(f"decoupled-{pier}", "uplift_ratio"): 0.7 for pier in ("elastic", "nonlinear")}
    (_, second, _), findings = answers(ratios=changes)
    assert "unsafe" in second.short
    assert finding(findings, "A decoupled analysis tends").verdict == NOT_BORNE_OUT


def test_a_cap_of_the_lateral_force_is_told_from_a_force_that_grows():
    made = table()
    (_, _, third), findings = answer_questions(gather(made, 0.3, replicates=FEW))
    assert third.short.startswith("Yes: the force levels off")
    assert finding(findings, "In coupled analyses the lateral").verdict == BORNE_OUT
    grows = made.assign(lateral_force_filtered_peak_n=1e4 * made["pba_m_s2"])
    (_, _, third), findings = answer_questions(gather(grows, 0.3, replicates=FEW))
    assert third.short.startswith("No cap")
    assert finding(findings, "In coupled analyses the lateral").verdict == NOT_BORNE_OUT


def test_derailments_are_counted_by_mode():
    made = table()
    made.loc[:3, "status"] = "derailed"
    made.loc[:2, "derailment_mode"] = "slide-off left"
    made.loc[3, "derailment_mode"] = "overturned right"
    _, findings = answer_questions(gather(made, 0.3, replicates=FEW))
    found = finding(findings, "All derailments")
    assert found.verdict == IN_PART
    assert "4 derailments: 1 overturned, 3 slide-off" in found.evidence
    _, findings = answers()
    assert finding(findings, "All derailments").verdict == NOT_TESTED


@pytest.mark.parametrize(
    "evidence",
    [
        Evidence(),
        gather(table().drop(columns="model")),
        gather(table(models=("coupled-nonlinear",)), 0.3, replicates=FEW),
        gather(table().assign(status="failed"), 0.3, replicates=FEW),
        gather(table(records=2, speeds=(22.2,)), 0.3, replicates=FEW),
        gather(table()[:0]),
    ],
)
def test_a_study_that_is_not_the_paper_s_gets_answers_that_say_what_is_missing(evidence):
    three, findings = answer_questions(evidence)
    assert len(three) == 3 and len(findings) == 12
    for answer in three:
        assert answer.short and answer.sentence.endswith(".")
        assert "nan" not in answer.sentence.lower().split()
    for item in findings:
        assert item.verdict in (BORNE_OUT, IN_PART, NOT_BORNE_OUT, NOT_TESTED)
        assert item.evidence.endswith(".")


def test_every_verdict_but_the_best_says_why():
    for seed in range(3):
        _, findings = answers(seed=seed)
        for item in findings:
            assert item.why or item.verdict in (BORNE_OUT, NOT_TESTED), item


def test_numbers_in_sentences():
    assert interval(Estimate(0.5, 0.25, 0.75)) == "0.50 (0.25 to 0.75)"
    assert interval(Estimate(-0.001)) == "0.00"
    assert interval(Estimate(-0.5)) == "−0.50"
    assert number(float("nan")) == "unknown"
    assert [chance(p) for p in (1e-5, 0.0123, 0.5)] == ["p < 0.001", "p = 0.012", "p = 0.50"]
