"""Presets: what ships, how files build on each other, and what is refused."""

import tomllib

import pytest

from railquake.errors import InputError
from railquake.inputs.presets import KINDS, list_presets, preset_path, resolved_section
from railquake.inputs.support import Pier
from railquake.inputs.vehicle import Vehicle
from railquake.inputs.wheelrail import WheelRail

MODELS = {"vehicle": Vehicle, "support": Pier, "wheelrail": WheelRail}


def test_the_shipped_sets():
    assert [(info.kind, info.name) for info in list_presets()] == [
        ("vehicle", "bart"),
        ("vehicle", "bart-2023-runs"),
        ("vehicle", "bart-under-gravity"),
        ("vehicle", "crh380a"),
        ("vehicle", "hsr-generic"),
        ("vehicle", "ice3-motor"),
        ("vehicle", "manchester"),
        ("support", "bart-berkeley"),
        ("support", "bart-berkeley-2023-runs"),
        ("wheelrail", "bart"),
        ("wheelrail", "bart-2023-runs"),
        ("wheelrail", "s1002-60e1"),
    ]


@pytest.mark.parametrize("info", list_presets(), ids=lambda info: f"{info.kind}-{info.name}")
def test_each_set_is_valid_and_says_where_it_comes_from(info):
    model = MODELS[info.kind].from_preset(info.name)
    assert model.name == info.name
    assert 20 < len(info.summary) < 100
    assert len(info.source) > 40
    assert len(info.note) > 80
    # Its own words, not those of the set it builds on.
    own = tomllib.loads(info.path.read_text("utf-8"))
    assert {"name", "summary", "source", "note"} <= set(own)


@pytest.mark.parametrize("kind", KINDS)
def test_unknown_presets_list_those_there_are(kind):
    with pytest.raises(InputError, match=r"unknown .* preset \"bert\"; .*bart"):
        preset_path(kind, "bert")


def test_unknown_kinds():
    with pytest.raises(InputError, match='did you mean "vehicle"'):
        preset_path("vehicles", "bart")


def test_a_file_builds_on_a_shipped_set_and_on_its_neighbour(tmp_path):
    (tmp_path / "a.toml").write_text('preset = "bart"\nspeed = "100 km/h"\naxles = 2\n')
    (tmp_path / "b.toml").write_text('preset = "a.toml"\naxles = 3\n[bodies.car]\nmass = "30 t"\n')
    vehicle = Vehicle.from_preset(str(tmp_path / "b.toml"))
    assert (vehicle.axles, vehicle.bodies[0].mass) == (3, 30000.0)
    assert vehicle.speed == pytest.approx(100 / 3.6)
    assert vehicle.bodies[0].roll_inertia == 3.2e4


def test_profile_files_are_found_beside_the_preset(tmp_path):
    (tmp_path / "pair.toml").write_text('preset = "bart"\nwheel = "w.prw"\nrail.file = "r.prr"\n')
    pair = WheelRail.from_preset(str(tmp_path / "pair.toml"))
    assert (pair.wheel.file, pair.rail.file) == (str(tmp_path / "w.prw"), str(tmp_path / "r.prr"))


def test_an_override_of_a_list_by_name(tmp_path):
    rows = '[[bodies]]\nname = "wheelset"\nmass = 1\nroll_inertia = 1\nheight = 1\n'
    (tmp_path / "x.toml").write_text('name = "x"\naxles = 1\nspeed = 0\n' + rows)
    vehicle = Vehicle.from_preset(str(tmp_path / "x.toml"), {"bodies": {"wheelset": {"mass": 5}}})
    assert (vehicle.bodies[0].mass, vehicle.bodies[0].height) == (5.0, 1.0)


def test_circles_of_presets_end(tmp_path):
    (tmp_path / "a.toml").write_text('preset = "a.toml"\n')
    with pytest.raises(InputError, match="without end"):
        resolved_section("vehicle", {"preset": "a.toml"}, tmp_path)


@pytest.mark.parametrize(
    ("preset", "words"),
    [("none.toml", "cannot be read"), ("bad.toml", "bad.toml, line 2"), (3, "a name or a path")],
)
def test_bad_preset_files(tmp_path, preset, words):
    (tmp_path / "bad.toml").write_text("a = 1\nb = = 2\n")
    with pytest.raises(InputError, match=words):
        resolved_section("vehicle", {"preset": preset}, tmp_path)
