"""The lateral force: a cap is seen as a cap, a power law as none."""

import numpy as np
import pytest

from made_up_runs import table
from railquake.findings import force_ratio, level_off


def runs(force):
    """Runs whose force ratio is a function of PBA."""
    made = table(models=("coupled-elastic",))
    scatter = np.exp(0.05 * np.random.default_rng(3).standard_normal(len(made)))
    return made, force(made["pba_m_s2"].to_numpy()) * scatter


def test_ratio_is_force_over_friction_times_the_whole_weight():
    made = table(records=1)
    ratio = force_ratio(made, 0.3)
    expected = made["lateral_force_filtered_peak_n"] / (0.3 * 2.0 * made["wheel_load_static_n"])
    assert ratio == pytest.approx(expected.to_numpy())
    friction = np.full(len(made), 0.3)
    assert force_ratio(made, friction) == pytest.approx(ratio)


def test_a_cap_is_found_where_it_is():
    made, ratio = runs(lambda pba: np.minimum(pba / 6.0, 1.2))
    found = level_off(made, ratio)
    assert found.levels_off
    assert found.knee.value == pytest.approx(7.2, rel=0.1)
    assert found.level.value == pytest.approx(1.2, rel=0.03)
    assert found.slope_before.value == pytest.approx(1.0, abs=0.05)
    assert found.slope_beyond.value == pytest.approx(0.0, abs=0.05)
    assert found.scatter.value == pytest.approx(0.05, rel=0.2)
    assert found.scatter.low < found.scatter.value < found.scatter.high


def test_a_power_law_does_not_level_off():
    made, ratio = runs(lambda pba: pba / 6.0)
    found = level_off(made, ratio, replicates=50)
    assert not found.levels_off
    assert found.slope_beyond.value == pytest.approx(1.0, abs=0.1)


def test_too_few_or_unknown_values_say_so():
    made, ratio = runs(lambda pba: pba)
    assert "only 5 runs" in level_off(made[:5], ratio[:5]).missing
    assert "only 0 runs" in level_off(made, np.full(len(made), np.nan)).missing
    assert not level_off(made[:5], ratio[:5]).levels_off
