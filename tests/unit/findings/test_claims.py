"""A claim is one file: it quotes the paper, and is known by lying there."""

from importlib import import_module
from pathlib import Path

from made_up_runs import table
from railquake.findings import answer_questions, claims, gather
from railquake.findings.claim import BORNE_OUT, NOT_BORNE_OUT, NOT_TESTED

FEW = 60  # replicates
SAYS = "A yielding pier makes derailment less likely."


def test_each_file_holds_one_claim_at_its_own_place_and_quotes_the_paper():
    files = {path.stem for path in Path(claims.__file__).parent.glob("*.py")} - {"__init__"}
    found = claims.every_claim()
    assert {claim.judge.__module__.rpartition(".")[2] for claim in found} == files
    assert len(found) == len(files) == len({claim.order for claim in found})
    for name in files:
        quoted = import_module(f"{claims.__name__}.{name}").__doc__
        assert '\nGomez & DeJong (2023), "' in quoted and "\n\n    " in quoted, name


def test_another_finding_takes_one_file_and_stands_at_the_place_that_it_states(another_claim):
    evidence = gather(table(), 0.3, replicates=FEW)
    _, former = answer_questions(evidence)
    another_claim()
    _, findings = answer_questions(evidence)
    assert [item.claim for item in findings].index(SAYS) == 4
    assert [item for item in findings if item.claim != SAYS] == list(former)
    assert (findings[4].verdict, findings[4].evidence) == (
        NOT_BORNE_OUT, "0 nonlinear and 0 elastic runs derail."
    )  # fmt: skip


def test_what_only_another_finding_compares_is_compared_for_it(another_claim):
    # PBA at grade against that on the pier, which no other finding asks for
    another_claim('("uplift_ratio", NONLINEAR, ELASTIC)', '("pba_m_s2", "at-grade", ELASTIC)')
    made = table()
    made.loc[made["model"] == "coupled-elastic", "status"] = "derailed"
    evidence = gather(made, 0.3, replicates=FEW)
    assert evidence.ratio("pba_m_s2", "at-grade", "coupled-elastic").pairs == 240
    _, findings = answer_questions(evidence)
    assert findings[4].verdict == BORNE_OUT
    _, findings = answer_questions(gather(made[made["model"] != "at-grade"], replicates=FEW))
    assert findings[4].verdict == NOT_TESTED
    assert findings[4].evidence == "The study has no model at-grade."
