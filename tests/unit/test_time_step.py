"""The time step chosen: the longest whose error, seen by halving it, is within the tolerance."""

import math

import pytest

import railquake as rq
from railquake.assembly import critical_time_step
from railquake.run.many import choose_time_step
from railquake.run.time_step import LONGEST, SAFE_SHARE, search_time_step

SHORT = {"seed": 3, "duration": "1 s", "dt": "0.01 s", "pga": "0.6 g", "highpass_frequency": "1 Hz"}


def case(**inputs):
    return rq.scenario(synthetic=SHORT, dt="auto", **inputs)


def runs_with_error(slope, power=2.0, uplift=0.5):
    """Rows as a run would give them whose PBV errs by ``slope * dt^power``."""

    def run(cases):
        return [
            {
                "status": "safe",
                "pbd_m": 0.05,
                "pbv_m_s": 0.5 * (1.0 + slope * case.solver.dt**power),
                "uplift_ratio": uplift,
            }
            for case in cases
        ]

    return run


@pytest.mark.parametrize("power", [1.0, 2.0])
@pytest.mark.parametrize("error", [1e-4, 0.015, 0.1])
def test_the_longest_step_within_the_tolerance_is_chosen(error, power):
    slope = error / LONGEST**power
    found = search_time_step([case()], runs_with_error(slope, power))
    step = found.of(case())
    assert slope * step**power <= 0.01  # within
    assert found.error >= slope * step**power / (
        1.0 + error
    )  # and not said to be better than it is
    if found.halvings > 0:  # twice the step would not do
        longer = 2.0 * slope * ((2.0 * step) ** power - step**power)
        assert longer > 0.0099


def test_a_tolerance_that_no_step_keeps_is_said_so():
    found = search_time_step([case()], runs_with_error(1e6, 1.0))
    assert found.error > found.tolerance
    assert "NOT within" in found.text


def test_a_run_that_diverges_counts_as_wrong():
    def run(cases):
        rows = runs_with_error(0.0)(cases)
        return [
            {**row, "status": "diverged" if c.solver.dt > 4e-5 else "safe"}
            for c, row in zip(cases, rows, strict=True)
        ]

    found = search_time_step([case()], run)
    assert found.of(case()) <= 4e-5
    assert math.isfinite(found.error)


def test_small_uplifts_count_by_their_size():
    """A ratio of 0.001 may change by a tenth: that is 0.0001 of the onset."""

    def run(cases):
        rows = runs_with_error(0.0)(cases)
        return [{**row, "uplift_ratio": 1e-3 * (1.0 + 1e3 * c.solver.dt)} for c, row in
                zip(cases, rows, strict=True)]  # fmt: skip

    assert search_time_step([case()], run).halvings == 0


def test_steps_stay_below_the_critical_one_and_fill_frames():
    found = search_time_step([case()], runs_with_error(0.0))
    for scenario in (case(), case(speed="0.01 km/h"), case(support="at-grade")):
        step = found.of(scenario)
        assert step <= SAFE_SHARE * critical_time_step(scenario) * (1.0 + 1e-9)
        assert (1e-3 / step) == pytest.approx(round(1e-3 / step), abs=1e-9)
    # a standing train's creep damps stiffly: its step is shorter
    assert found.of(case(speed="0.01 km/h")) < found.of(case())


def test_a_scenario_that_names_its_step_keeps_it():
    found = search_time_step([case()], runs_with_error(0.0))
    named = rq.scenario(synthetic=SHORT, dt="2e-5 s")
    assert found.settled(named) is named
    assert found.settled(case()).solver.dt == found.of(case())


def test_single_runs_and_many_choose_alike_and_report_the_error():
    single = rq.assess(rq.simulate(case()))
    ((_, abreast),) = rq.simulate_many([case()], threads=1)
    for row in (single, abreast):
        assert row["status"] == "safe"
        assert row["dt_s"] == pytest.approx(1e-4)
        assert 0.0 <= row["dt_error"] <= 0.01
    fine = rq.assess(rq.simulate(rq.scenario(synthetic=SHORT, dt="1e-5 s")))
    assert fine["dt_error"] is None
    for key in ("pbd_m", "pbv_m_s"):
        assert single[key] == pytest.approx(fine[key], rel=0.01)


def test_a_study_chooses_once_for_its_hardest():
    found = choose_time_step([case(), case(scale=2.0, hinge="elastic")], 0.02, threads=1)
    assert found.tried == 2
    assert found.tolerance == 0.02
    assert found.error <= 0.02


def test_a_scenario_that_cannot_be_run_is_named():
    broken = case(wheelrail={"preset": "bart", "gauge": "1.2 m"})
    with pytest.raises(rq.InputError, match="time step"):
        choose_time_step([], threads=1)
    with pytest.raises(rq.InputError):
        choose_time_step([broken], threads=1)


def test_assembly_alone_does_not_settle_it():
    with pytest.raises(rq.InputError, match="auto"):
        rq.assemble(case())
    with pytest.raises(rq.InputError, match="solver.dt"):
        rq.scenario(synthetic=SHORT, dt="fast")
