"""Sa(T1): the pier's period, and one spectrum for all levels of a record."""

import math

import pandas as pd
import pytest

import railquake as rq
from railquake.findings import first_period, with_spectral_acceleration
from railquake.inputs.ground_motion import response_spectrum


def case(support="bart-berkeley", scale=1.0, **changes):
    motion = {"seed": 3, "duration": "6 s", "pga": "3 m/s^2"}
    return rq.scenario(support=support, synthetic=motion, scale=scale, **changes)


def test_period_is_that_of_the_pier_with_its_initial_stiffness():
    # 0.411 s: authors' pier with an elastic hinge
    assert first_period(case().support) == pytest.approx(0.411, abs=5e-4)
    assert first_period(case(hinge="elastic").support) == first_period(case().support)


def rows(scenarios):
    return pd.DataFrame(
        {
            "row": range(len(scenarios)),
            "record": "one",
            "level": [str(k) for k in range(len(scenarios))],
            "scale": [scenario.motion.scale for scenario in scenarios],
            "model": [scenario.support.kind for scenario in scenarios],
            "scenario_hash": "",
        }
    )


def test_each_row_has_the_ordinate_of_its_own_motion_and_at_grade_none():
    scenarios = [case(), case(scale=2.5), case(scale=-2.5), case("at-grade")]
    asked = []

    def scenario_of(row):
        asked.append(row)
        return scenarios[row]

    found = with_spectral_acceleration(rows(scenarios), scenario_of)
    for k in range(3):
        period = first_period(scenarios[k].support)
        expected = response_spectrum(scenarios[k].ground_motion(), [period], 0.05).psa[0]
        assert found["sa_t1_m_s2"][k] == pytest.approx(expected)
        assert found["t1_s"][k] == pytest.approx(period)
    assert math.isnan(found["sa_t1_m_s2"][3])
    assert asked == [0, 3]  # levels of a record share one spectrum


def test_a_scenario_that_cannot_be_made_any_more_has_none():
    def gone(_):
        raise rq.InputError("record.at2: cannot be read")

    found = with_spectral_acceleration(rows([case()]), gone)
    assert found["sa_t1_m_s2"].isna().all()
