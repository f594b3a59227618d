"""Correlation: the right numbers, the right measure, and what is left out."""

import numpy as np
import pandas as pd
import pytest
from scipy.stats import spearmanr

from made_up_runs import table
from railquake.findings import correlate


def some(model="coupled-elastic", **options):
    made = table(**options)
    return made[made["model"] == model]


def test_numbers_are_spearman_s_rho_and_the_residual_deviation_of_a_power_law():
    runs = some()
    found = correlate(runs, measures=["pbv_m_s", "pga_m_s2"], replicates=20).of("pga_m_s2")
    x, y = np.log(runs["pga_m_s2"]), np.log(runs["uplift_ratio"])
    slope, cut = np.polyfit(x, y, 1)
    residual = y - cut - slope * x
    assert found.spearman.value == pytest.approx(spearmanr(x, y).statistic)
    assert found.exponent.value == pytest.approx(slope)
    assert found.dispersion.value == pytest.approx(np.sqrt((residual**2).sum() / (len(x) - 2)))


def test_the_better_measure_is_told_by_a_difference_whose_interval_leaves_zero_out():
    found = correlate(some())
    difference = found.against("pga_m_s2")
    assert difference.spearman.above(0.0)
    assert difference.dispersion.below(0.0)
    better, worse = found.of("pbv_m_s"), found.of("pga_m_s2")
    assert difference.spearman.value == pytest.approx(better.spearman.value - worse.spearman.value)
    assert better.spearman.low <= better.spearman.value <= better.spearman.high


def test_intervals_come_from_records_and_not_from_runs():
    once = some(speeds=(22.2,))
    # the same runs at nine speeds tell no more about the records
    nine = pd.concat([once.assign(**{"vehicle.speed": float(k)}) for k in range(9)])
    narrow, wide = (correlate(runs).of("pga_m_s2").spearman for runs in (nine, once))
    assert narrow.value == pytest.approx(wide.value, abs=1e-3)
    assert narrow.high - narrow.low == pytest.approx(wide.high - wide.low, rel=1e-2)


def test_within_a_level_only_records_tell():
    runs = some()
    over_all, within = correlate(runs), correlate(runs, within="level")
    assert over_all.of("pga_m_s2").spearman.value > 0.6  # all grow with the level
    assert abs(within.of("pga_m_s2").spearman.value) < 0.4
    assert within.of("pbv_m_s").spearman.value > 0.9


def test_ties_have_their_mean_rank():
    runs = some()
    runs = runs.assign(pbv_m_s=np.round(runs["pbv_m_s"], 1) + 0.1)
    found = correlate(runs, measures=["pbv_m_s"], replicates=10).of("pbv_m_s")
    expected = spearmanr(runs["pbv_m_s"], runs["uplift_ratio"]).statistic
    assert found.spearman.value == pytest.approx(expected)


def test_zeros_are_left_out_and_counted_and_failed_runs_are_not_looked_at():
    runs = some().reset_index(drop=True)
    runs.loc[0, "uplift_ratio"] = 0.0
    runs.loc[1, "status"] = "failed"
    runs.loc[2, "status"] = "diverged"
    found = correlate(runs, replicates=10)
    assert (found.runs, found.left_out) == (len(runs) - 3, 1)


def test_at_grade_there_is_no_bridge_velocity():
    found = correlate(some("at-grade"), replicates=10)
    assert "pbv_m_s" in found.missing and "sa_t1_m_s2" in found.missing
    assert {item.measure for item in found.items} == {"pba_m_s2", "pgv_m_s", "pga_m_s2"}
    assert found.differences == ()  # nothing that PBV could be better than


def test_few_records_give_a_number_without_an_interval_and_few_runs_nothing():
    few = correlate(some(records=3), measures=["pbv_m_s"])
    assert few.of("pbv_m_s").spearman.known and not few.of("pbv_m_s").spearman.certain
    none = correlate(some()[:2])
    assert none.items == () and none.runs == 2
    assert correlate(some()[:0]).items == ()


def test_a_repeated_analysis_gives_the_same_interval():
    assert correlate(some(), replicates=50) == correlate(some(), replicates=50)
