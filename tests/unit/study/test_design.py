"""The design: the order of its rows, and that each scenario is what a case file would give."""

import pytest

import railquake as rq
from railquake.errors import InputError
from railquake.inputs.scenario import scenario_from_dict
from railquake.study.design import Design
from study_files import BASE, MODELS, MOTION, small, tables


def design(data):
    return Design(rq.Study.from_dict(data))


def test_motions_change_slowest_then_levels_then_axes_in_their_order():
    data = small()
    data["axes"] = {"model": MODELS[:2], "vehicle.speed": [10.0, 20.0]}
    points = [design(data).point(row) for row in range(16)]
    assert [p.record for p in points] == ["a"] * 8 + ["b"] * 8
    assert [p.level for p in points[:8]] == ["low"] * 4 + ["high"] * 4
    assert [p.labels["model"] for p in points[:4]] == ["coupled"] * 2 + ["decoupled"] * 2
    assert [p.labels["vehicle.speed"] for p in points[:4]] == [10.0, 20.0] * 2
    assert [p.scale for p in points[::4]] == [0.5, 1.5, 1.0, 3.0]


def test_every_scenario_is_the_one_that_overrides_of_the_case_give():
    data = tables(
        **{
            "model": MODELS,
            "vehicle.speed": ["36 km/h", "72 km/h"],
            "support.length": ["5 m"],
            "wheelrail.friction": {"distribution": "uniform", "low": 0.2, "high": 0.4},
            "motion.scale": [2.0],
            "motion.synthetic.seed": [5],
        }
    )
    data["sampling"] = {"count": 2, "seed": 1}
    made = design(data)
    assert made.size == 12
    for row in range(made.size):
        point = made.point(row)
        model = next(m["set"] for m in MODELS if m["name"] == point.labels["model"])
        overrides = {**{k: v for k, v in point.labels.items() if k != "model"}, **model}
        plain = scenario_from_dict(BASE, overrides=overrides)
        assert made.scenario(point) == plain
        assert made.identified(point)[1] == plain.content_hash()


def test_a_scale_of_an_axis_multiplies_that_of_a_suite_and_replaces_that_of_the_case():
    with_suite = {**small(), "axes": {"motion.scale": [3.0]}}
    assert design(with_suite).point(0).scale == pytest.approx(0.5 * 3.0)
    alone = tables(**{"motion.scale": [3.0]})
    alone["base"] = {**BASE, "motion": {"synthetic": MOTION, "scale": 7.0}}
    assert design(alone).point(0).scale == 3.0
    assert design({**alone, "axes": {}}).point(0).scale == 7.0


def test_a_motion_is_called_by_its_record_or_its_seed():
    seeds = design(tables(**{"motion.synthetic.seed": [4, 9]}))
    assert [seeds.point(row).record for row in (0, 1)] == ["synthetic-4", "synthetic-9"]
    record = {"base": {**BASE, "motion": {"record": "/r/RSN1.AT2"}}}
    assert design(record).point(0).record == "RSN1"


@pytest.mark.parametrize(
    ("axes", "message"),
    [
        ({"support.hinge": ["elastic", "plastic"]}, "support.hinge.*plastic"),
        ({"vehicle.preset": ["bart", "bort"]}, "bort"),
        ({"vehicle.speed": [10.0], "wheelrail.friction": [0.3, 9.0]}, "wheelrail.friction"),
        ({"motion.synthetic.seed": [1, -1]}, "seed"),
    ],
)
def test_a_wrong_value_is_found_before_anything_runs(axes, message):
    with pytest.raises(InputError, match=message):
        design(tables(**axes)).check()


def test_a_missing_record_is_named_before_anything_runs(tmp_path):
    data = {"base": {**BASE, "motion": {"record": str(tmp_path / "none.AT2")}}}
    with pytest.raises(InputError, match=r"none\.AT2"):
        design(data).check()
    no_motion = {key: table for key, table in BASE.items() if key != "motion"}
    with pytest.raises(InputError, match="motion"):
        design({"base": no_motion}).check()


# --- factors on the motion ---------------------------------------------------------------------


def ladder(**changes):
    """An incremental analysis of a motion of 0.6 g, the axis of factors between others."""
    found = tables(
        **{
            "vehicle.speed": ["0.01 km/h", "80 km/h"],
            "motion.scale": [0.5, 5.5, 1.0],
            "model": MODELS,
        }
    )
    return {**found, **changes}


@pytest.mark.parametrize("consent", [False, True])
def test_factors_of_an_axis_need_consent_above_3_g(consent):
    base = {**BASE, "motion": {**BASE["motion"], "allow_high_pga": consent}}
    found = design(ladder(base=base))
    if consent:
        found.check()
        return
    with pytest.raises(InputError, match=r"row 3: motion .*PGA is 3.3 g with scale = 5.5, over 3"):
        found.check()


def test_levels_of_a_suite_need_consent_above_3_g():
    study = small()
    study["suite"]["levels"]["high"] = 3.0
    with pytest.raises(InputError, match=r"suite: b: motion .*PGA is 3.6 g with scale = 6, over 3"):
        design(study).check()
    study["base"] = {**BASE, "motion": {"allow_high_pga": True}}
    design(study).check()


@pytest.mark.parametrize("where", ["list", "variant"])
def test_a_factor_of_zero_on_an_axis_is_refused(where):
    axes = {
        "list": {"motion.scale": [1.0, 0.0]},
        "variant": {
            "how": [{"name": "all", "set": {}}, {"name": "no", "set": {"motion.scale": 0}}]
        },
    }[where]
    axes["vehicle.speed"] = ["0.01 km/h", "80 km/h"]
    with pytest.raises(InputError, match="scale must not be 0"):
        design(tables(**axes)).check()
