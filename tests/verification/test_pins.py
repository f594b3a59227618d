"""Numbers of before the restructuring, a sample of them; ``make pins`` compares them all."""

from functools import cache

import pytest

import pinned

# from what all tests compile anyway: Bouc-Wen and elastic, the usual car and wheels
SUITE = [
    f"{engine}: {run}"
    for engine in pinned.SUITE_ENGINES
    for run in ("RSN159_IMPVALLH2 x 0.74, bouc-wen", "RSN185_IMPVALLH2 x 1.38, elastic")
]
MIXED = [
    f"{engine}: {name}"
    for engine in pinned.MIXED_ENGINES
    for name in (
        "strong", "stronger, elastic", "violent", "at grade, stronger",
        "decoupled, strong, elastic", "vertical, strong, elastic", "standing", "P-delta",
        "wearing hinge, stronger", "5e-5 s, elastic", "four substeps", "short frames",
    )
]  # fmt: skip


@cache
def pins(group):
    return pinned.read(group)


def engine_of(run):
    return run.partition(": ")[0]


def beyond(group, run, row):
    """What is out of bounds in a run, in words."""
    differences = pinned.compare_rows(group, run, pins(group)[run], row)
    return [str(d) for d in differences if d.excess > 1.0]


@pytest.mark.parametrize("run", SUITE)
def test_runs_of_the_papers_suite_are_what_they_were(shared, run):
    inputs = pinned.suite_inputs(shared / "records" / "paper_suite", engine_of(run))
    assert beyond("suite", run, pinned.rows_of({run: inputs[run]})[run]) == []


@pytest.mark.parametrize("run", MIXED)
def test_runs_of_all_kinds_are_what_they_were(tmp_path, run):
    inputs = pinned.mixed_inputs(tmp_path, engine_of(run))
    assert beyond("mixed", run, pinned.rows_of({run: inputs[run]})[run]) == []


@pytest.mark.parametrize("run", pinned.PLAIN)
def test_uncompiled_runs_are_what_they_were_in_every_history(run):
    assert beyond("plain", run, pinned.plain_row(run)) == []


def test_every_run_is_pinned(tmp_path):
    mixed = [name for e in pinned.MIXED_ENGINES for name in pinned.mixed_inputs(tmp_path, e)]
    assert list(pins("mixed")) == mixed
    assert list(pins("plain")) == list(pinned.PLAIN)
    assert len(pins("suite")) == 3 * 160
    assert len(pins("demo")) == 1200


# --- the comparison itself -----------------------------------------------------------------------

SMOOTH, LIFTING = "single: as it comes", "single: stronger, elastic"


def found_with(changes, run=SMOOTH, group="mixed", exact=False):
    """What the comparison finds in a run with some measures changed."""
    rows = {run: pins(group)[run]}
    differences = pinned.compare(group, rows, {run: rows[run] | changes}, exact)
    return [d.measure for d in differences if d.excess > 1.0]


def number(measure, run=SMOOTH):
    return pins("mixed")[run][measure]


def test_measures_that_have_come_since_are_no_difference():
    assert found_with({"a new measure": 1.0}) == []


def test_what_is_the_same_has_no_difference():
    rows = pins("mixed")
    assert pinned.compare("mixed", rows, rows, exact=True) == []


@pytest.mark.parametrize(
    "changes",
    [
        {"status": "onset"},
        {"derailment_mode": "slide-off left"},
        {"steps": 199_999},
        {"uplift_first_s": 0.8},
        {"pbd_m": None},
        {"pbd_m": float("nan")},
    ],
)
@pytest.mark.parametrize("run", [SMOOTH, LIFTING])
def test_another_kind_of_end_is_noticed_whatever_lifts(run, changes):
    if run == LIFTING and "uplift_first_s" in changes:
        changes = {"uplift_first_s": None}
    assert found_with(changes, run) == list(changes)


@pytest.mark.parametrize("measure", ["pbd_m", "wheel_load_peak_n", "lateral_shift_peak_m"])
def test_a_millionth_is_noticed_where_nothing_lifts(measure):
    changes = {measure: number(measure) * (1.0 + 1e-6)}
    assert found_with(changes) == [measure]


def test_a_compilers_last_bit_is_allowed_unless_none_is():
    changes = {"pbd_m": number("pbd_m") * (1.0 + 1e-14)}
    assert found_with(changes) == []
    assert found_with(changes, exact=True) == ["pbd_m"]


def test_where_wheels_lift_a_percent_is_noticed_and_a_millionth_is_not():
    assert found_with({"pbd_m": number("pbd_m", LIFTING) * 1.01}, LIFTING) == ["pbd_m"]
    assert found_with({"pbd_m": number("pbd_m", LIFTING) * (1.0 + 1e-6)}, LIFTING) == []


def test_an_event_may_move_by_a_frame():
    first = number("flange_contact_first_s", LIFTING)
    assert found_with({"flange_contact_first_s": first + 1e-3}, LIFTING) == []
    assert found_with({"flange_contact_first_s": first + 2e-3}, LIFTING) == [
        "flange_contact_first_s"
    ]


def test_a_run_that_is_missing_or_new_is_noticed():
    rows = {"a run": pins("mixed")[SMOOTH]}
    for pair in ((rows, {}), ({}, rows)):
        (difference,) = pinned.compare("mixed", *pair)
        assert difference.excess > 1.0


def test_a_run_that_fails_is_noticed():
    failed = {"status": "failed", "error": "solver.dt: too long"}
    differences = pinned.compare("mixed", {SMOOTH: pins("mixed")[SMOOTH]}, {SMOOTH: failed})
    assert {"status", "error", "pbd_m"} <= {d.measure for d in differences if d.excess > 1.0}


def test_a_history_that_ends_elsewhere_is_noticed():
    run = "jolt"
    value = pins("plain")[run]["last car_roll_rad"]
    assert found_with({"last car_roll_rad": value * (1.0 + 1e-6)}, run, "plain") == [
        "last car_roll_rad"
    ]


def test_a_millionth_more_shaking_is_noticed(monkeypatch):
    run = "jolt at grade, coulomb, lopsided"
    monkeypatch.setitem(pinned.PLAIN, run, {**pinned.PLAIN[run], "scale": 1.0 + 1e-6})
    assert len(beyond("plain", run, pinned.plain_row(run))) > 20
