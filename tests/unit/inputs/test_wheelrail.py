"""Wheels on rails: shipped pairs, profile specifications, and what is refused."""

import math

import pytest

from railquake.errors import InputError
from railquake.inputs.profile import point_at_height
from railquake.inputs.wheelrail import ProfileSpec, WheelRail


def test_bart_values():
    pair = WheelRail.from_preset("bart")
    assert pair.running_circle == pytest.approx(34.3355 * 0.0254)
    assert pair.rail_half_distance() == pair.running_circle
    assert pair.rolling_radius == pytest.approx(0.392, abs=5e-4)
    assert pair.reference_roll == pytest.approx(math.radians(0.836))
    assert (pair.friction, pair.restitution, pair.creep_law) == (0.3, 0.7, "she")


def test_bart_profiles_are_drawn_from_their_segments():
    pair = WheelRail.from_preset("bart")
    wheel, rail = pair.wheel_profile(), pair.rail_profile()
    assert (wheel.kind, rail.kind) == ("wheel", "rail")
    assert wheel.y[0] == pytest.approx(-2.867 * 0.0254)
    assert wheel.z.max() == pytest.approx(0.9994 * 0.0254, abs=1e-5)
    assert rail.z.min() == pytest.approx(0.0, abs=1e-9)
    # The gauge is measured between the faces; the rails' centres give it.
    assert 2.0 * (pair.rail_half_distance(rail) + rail.y.min()) == pytest.approx(1.6764, abs=1e-5)


def test_bart_2023_runs_differs_in_law_and_restitution():
    pair = WheelRail.from_preset("bart-2023-runs")
    assert (pair.creep_law, pair.restitution, pair.friction) == ("carter", 0.0, 0.3)
    assert pair.wheel == WheelRail.from_preset("bart").wheel


def test_european_pair_stands_at_its_gauge():
    pair = WheelRail.from_preset("s1002-60e1")
    assert (pair.wheel.builtin, pair.rail.builtin) == ("s1002", "60e1")
    assert pair.reference_roll == pytest.approx(28 / 1500)
    assert (pair.running_circle, pair.rolling_radius) == (0.75, 0.46)
    rail = pair.rail_profile()
    gauge_face = point_at_height(rail, rail.z.min() + 0.014, "gauge")
    assert 2.0 * (pair.rail_half_distance() + gauge_face) == pytest.approx(1.435)
    # Head half width 36 mm; the crown of a canted rail stands 300 mm / 40 outward of its axis.
    assert pair.rail_half_distance() == pytest.approx(0.7175 + 0.036 + 0.0075, abs=1e-3)


def test_a_text_is_a_builtin_name_or_a_file(tmp_path):
    over = {"wheel": str(tmp_path / "w.prw"), "rail": "60e1"}
    pair = WheelRail.from_preset("bart", over)
    assert pair.wheel == ProfileSpec(file=str(tmp_path / "w.prw"))
    assert pair.rail == ProfileSpec(builtin="60e1")
    with pytest.raises(InputError, match=r"w\.prw"):
        pair.wheel_profile()


def test_gauge_replaces_the_presets_rail_centre():
    pair = WheelRail.from_preset("bart", {"gauge": "1435 mm"})
    assert (pair.gauge, pair.rail_centre) == (1.435, None)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        ({"friction": -0.1}, ["friction", "zero or positive"]),
        ({"friction": "0.3 m"}, ["friction", "plain number"]),
        ({"restitution": 1.1}, ["restitution", "at most 1"]),
        ({"restitution": 0, "restitution_law": "calibrated"}, ["restitution", "above 0"]),
        ({"poisson_ratio": 0.5}, ["poisson_ratio", "below 0.5"]),
        ({"gauge": 1.4, "rail_centre": 0.8}, ["gauge or rail_centre", "both"]),
        ({"creep_law": "kalker"}, ["creep_law", '"polach"']),
        ({"reference_roll": "1 m"}, ["reference_roll", "(a length)"]),
        ({"youngs_modulus": "200 GN"}, ["youngs_modulus", "44.8 GPa"]),
        ({"wheel": {}}, ["wheel", "found none of them"]),
        ({"wheel": {"builtin": "s1002", "file": "x.prw"}}, ["wheel", "more than one"]),
        ({"wheel": 3}, ["wheel", "must be a table"]),
        ({"rail": {"segments": [{"kind": "lin"}]}}, ["rail.segments[0]", '"line"']),
        (
            {"rail": {"segments": [{"kind": "line", "start": [0, 0], "end": [1]}]}},
            ["rail.segments[0].end[1]", "missing"],
        ),
        (
            {"rail": {"segments": [{"kind": "line", "start": [0, 0]}]}},
            ["segments[0].end", "missing"],
        ),
    ],
)
def test_pairs_that_make_no_sense(overrides, words):
    with pytest.raises(InputError) as caught:
        WheelRail.from_preset("bart", overrides)
    assert all(word in str(caught.value) for word in words), str(caught.value)


def test_a_rail_is_no_wheel():
    pair = WheelRail.from_preset("bart", {"wheel": "60e1"})
    with pytest.raises(InputError, match="is a rail, where a wheel is needed"):
        pair.wheel_profile()
