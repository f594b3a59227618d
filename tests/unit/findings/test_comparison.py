"""Paired comparisons: known ratios are found, and nothing is compared that differs otherwise."""

import numpy as np
import pytest
from scipy.stats import binomtest

from made_up_runs import table
from railquake.findings import compare_models
from railquake.findings.comparison import pairs_of

ONE, OTHER = "decoupled-elastic", "coupled-elastic"


def test_a_known_ratio_is_found_with_its_sign_test():
    found = compare_models(table(ratios={(ONE, "pbd_m"): 1.1}), "pbd_m", ONE, OTHER)
    assert found.pairs == 240 and found.records == 20
    assert found.median.value == pytest.approx(1.1, rel=0.01)
    assert found.median.low < 1.1 < found.median.high or found.median.value == pytest.approx(
        1.1, abs=0.003
    )
    assert found.geometric_mean.above(1.0)
    assert found.above == 240 and found.below == found.ties == 0
    assert found.p_value == pytest.approx(binomtest(20, 20).pvalue)
    assert found.scatter == pytest.approx(np.sqrt(2.0) * 0.01, rel=0.2)


def test_no_difference_is_not_made_into_one():
    found = compare_models(table(), "pbd_m", ONE, OTHER)
    assert found.median.low < 1.0 < found.median.high
    assert found.p_value > 0.05


def test_records_count_once_in_the_sign_test_however_many_speeds_they_ran_at():
    made = table(ratios={(ONE, "pbd_m"): 1.1}, records=6)
    found = compare_models(made, "pbd_m", ONE, OTHER)
    assert found.p_value == pytest.approx(2.0 * 0.5**6)
    assert found.p_value_pairs < 1e-10  # as if runs were independent


def test_pairs_agree_in_everything_but_the_model():
    made = table(records=2).sample(frac=1.0, random_state=1)
    pairs = pairs_of(made, "pbd_m", ONE, OTHER)
    assert len(pairs) == 24
    keys = ["record", "level", "vehicle.speed"]
    rows = made.set_index("row")
    for side, model in (("row_x", OTHER), ("row_y", ONE)):
        assert (rows.loc[pairs[side], "model"] == model).all()
        assert rows.loc[pairs[side], keys].reset_index(drop=True).equals(pairs[keys])


def test_a_run_whose_partner_failed_is_no_pair():
    made = table(records=5)
    first = made.index[(made["model"] == ONE)][0]
    made.loc[first, "status"] = "failed"
    assert compare_models(made, "pbd_m", ONE, OTHER, replicates=10).pairs == 59


def test_ties_are_counted_and_left_out_of_the_sign_test():
    made = table()
    equal = made.loc[made["model"] == OTHER, "pbd_m"].to_numpy()
    made.loc[made["model"] == ONE, "pbd_m"] = equal
    found = compare_models(made, "pbd_m", ONE, OTHER, replicates=10)
    assert found.ties == found.pairs == 240
    assert found.median.value == 1.0 and np.isnan(found.p_value)


def test_zeros_have_no_ratio_and_are_counted():
    made = table()
    made.loc[made.index[made["model"] == ONE][:7], "pbd_m"] = 0.0
    found = compare_models(made, "pbd_m", ONE, OTHER, replicates=10)
    assert (found.pairs, found.left_out) == (233, 7)


@pytest.mark.parametrize(
    ("made", "reason"),
    [
        (table(models=("coupled-elastic",)), "no model decoupled-elastic"),
        (table().drop(columns="model"), "no axis of models"),
        (table().drop(columns="pbd_m"), "no pbd_m"),
        (table(records=1, speeds=(22.2,)), "only 4 pairs"),
        (table().assign(pbd_m=0.0), "only 0 pairs"),
    ],
)
def test_what_cannot_be_compared_says_why(made, reason):
    found = compare_models(made, "pbd_m", ONE, OTHER)
    assert reason in found.missing
    assert not found.median.known and found.pairs == 0
