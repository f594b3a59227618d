"""Scenarios: case files, overrides, round trip, fingerprint, schema."""

import json
import shutil
import tomllib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.errors import InputError
from railquake.inputs.ground_motion import GroundMotion
from railquake.inputs.scenario import load_scenario, scenario, scenario_from_dict
from railquake.inputs.schema import json_schema
from railquake.inputs.support import AtGrade, Pier, PrescribedTrack

CASE = """
[vehicle]
preset = "bart"
speed = "80 km/h"
[support]
preset = "bart-berkeley"
hinge = "bouc-wen"
coupled = true
damping_ratio = 0.02
length = "7 m"
[support.bouc_wen]
m = 1.0
[wheelrail]
preset = "bart"
[motion]
record = "records/ground.csv"
scale = 1.81
[solver]
dt = "2e-5 s"
contact = "grid"
"""
RECORD = "time (s),acc (m/s2)\n" + "".join(f"{0.01 * i:.2f},{0.1 * (-1) ** i}\n" for i in range(20))


@pytest.fixture
def case(tmp_path):
    (tmp_path / "records").mkdir()
    (tmp_path / "records" / "ground.csv").write_text(RECORD)
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    return path


def test_a_case_file(case):
    loaded = load_scenario(case)
    assert loaded.vehicle.speed == pytest.approx(80 / 3.6)
    assert isinstance(loaded.support, Pier)
    assert (loaded.support.length, loaded.support.bouc_wen.m) == (7.0, 1.0)
    assert loaded.support.bouc_wen.n == 1.28
    assert loaded.motion is not None
    assert loaded.motion.record == str(case.parent / "records" / "ground.csv")
    assert (loaded.solver.dt, loaded.solver.contact) == (pytest.approx(2e-5), "grid")


def test_solver_defaults():
    solver = scenario(record="x.AT2").solver
    assert solver.model_dump() == {
        "dt": 1e-5,
        "time_step_tolerance": 0.01,
        "contact": "table",
        "hinge_solve": None,
        "substeps": None,
        "phi": 0.5,
        "psi": 0.5,
        "history_step": 1e-3,
        "newton_tolerance": 1e-4,
        "newton_max_iterations": 20,
        "lateral_force_filter": 20.0,
    }


def test_the_record_is_read_only_on_demand_and_scaled(case):
    loaded = load_scenario(case)
    motion = loaded.ground_motion()
    assert np.abs(motion.acceleration).max() == pytest.approx(0.181)
    mirrored = loaded.with_changes({"motion.scale": -1.81}).ground_motion()
    np.testing.assert_array_equal(mirrored.acceleration, -motion.acceleration)
    assert loaded.vertical_motion() is None
    absent = load_scenario(case, ["motion.record=none.AT2"])
    with pytest.raises(InputError, match=r"none\.AT2"):
        absent.ground_motion()


def test_vertical_component(case):
    loaded = load_scenario(case, ["motion.vertical=records/ground.csv", "motion.scale=-2"])
    vertical = loaded.vertical_motion()
    assert vertical is not None
    np.testing.assert_allclose(vertical.acceleration, -loaded.ground_motion().acceleration)


@pytest.mark.parametrize(
    ("override", "path", "expected"),
    [
        ("motion.scale=1.5", ("motion", "scale"), 1.5),
        ("vehicle.speed=240 km/h", ("vehicle", "speed"), 240 / 3.6),
        ('vehicle.speed="240 km/h"', ("vehicle", "speed"), 240 / 3.6),
        ("support.hinge=elastic", ("support", "hinge"), "elastic"),
        ("support.coupled=false", ("support", "coupled"), False),
        ("support.bouc_wen.n = 1.2", ("support", "bouc_wen", "n"), 1.2),
        ("solver.newton_max_iterations=5", ("solver", "newton_max_iterations"), 5),
        ("vehicle.preset=bart-2023-runs", ("vehicle", "axles"), 1),
    ],
)
def test_overrides(case, override, path, expected):
    value = load_scenario(case, [override])
    for step in path:
        value = getattr(value, step)
    assert value == (pytest.approx(expected) if isinstance(expected, float) else expected)


def test_override_of_one_body(case):
    loaded = load_scenario(case, ["vehicle.bodies.car.mass=31 t"])
    assert loaded.vehicle.bodies[0].mass == 31000.0


def test_at_grade_beside_a_piers_preset_and_values(case):
    loaded = load_scenario(case, {"support.kind": "at-grade"})
    assert loaded.support == AtGrade()
    with pytest.raises(InputError, match=r"support\.lenght: unknown key; known: kind"):
        load_scenario(case, {"support.kind": "at-grade", "support.lenght": 3})


def test_prescribed_track_needs_no_motion(case):
    (case.parent / "track.csv").write_text("t_s,y_m\n0,0\n0.01,1e-3\n0.02,0\n")
    data = tomllib.loads(CASE)
    data["support"] = {"kind": "prescribed", "file": "track.csv"}
    del data["motion"]
    loaded = scenario_from_dict(data, case.parent)
    assert isinstance(loaded.support, PrescribedTrack)
    assert loaded.support.file == str(case.parent / "track.csv")
    motion = loaded.ground_motion()
    assert (motion.dt, motion.acceleration.tolist()) == (pytest.approx(0.01), [0.0, 0.0, 0.0])
    assert loaded.vertical_motion() is None
    assert scenario_from_dict(tomllib.loads(loaded.to_toml())) == loaded


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("support.lenght=7 m", ['support.lenght: unknown key; did you mean "length"']),
        ("support.length=7 s", ["support.length: must be a length", "(a time)", "6.0 m"]),
        ("support.length=nan", ["support.length: must be a finite number"]),
        ("support.bouc_wen.alpha=2", ["support.bouc_wen.alpha: must be between 0 and 1"]),
        ("support.kind=at grade", ['support.kind: unknown kind of support "at grade"', "at-grade"]),
        ("vehicle.speed=80 km", ["vehicle.speed: must be a speed", "80 km/h"]),
        ("vehicle.bodies.car.mass=3 m", ["vehicle.bodies.car.mass: must be a mass"]),
        ("vehicle.preset=bert", ["vehicle.preset", 'did you mean "bart"', "bart-2023-runs"]),
        ("vehicle.speed.x=1", ["vehicle.speed is not a table"]),
        ("suport.length=7", ['suport: unknown key; did you mean "support"']),
        ("support=7", ["support: must be a table", '[support] preset = "bart-berkeley"']),
        ("solver.contact=tabel", ['solver.contact: must be "table" or "grid", found "tabel"']),
        ("solver.dt=0", ["solver.dt: must be positive"]),
        ("solver.dt=1 m", ["solver.dt: must be a time"]),
        ("solver.history_step=1e-6", ["solver.history_step: must be at least the time step"]),
        ("solver.phi=2", ["solver.phi: must be at most 1"]),
        ("motion.record=3", ["motion.record: must be a text"]),
        ("motion.scale=nan", ["motion.scale: must be a finite number"]),
        ("motion.channel=1.5", ["motion.channel: must be a whole number"]),
        ("motion.synthetic={sed = 1}", ["motion.synthetic", "sed", "seed"]),
        ("motion.synthetic={pga = '1 s'}", ["motion.synthetic.pga: must be an acceleration"]),
        ("motion.acceleration=[0.0, 1.0]", ["motion.dt: is needed"]),
        ("nothing", ["not path=value"]),
        (".x=3", ["is no path"]),
    ],
)
def test_wrong_values_are_refused_in_one_line(case, override, words):
    with pytest.raises(InputError) as caught:
        load_scenario(case, [override])
    message = str(caught.value)
    assert all(word in message for word in words), message
    assert "\n" not in message
    if "=" in override:
        assert message.startswith(f"{case}: ")


@pytest.mark.parametrize("section", ["vehicle", "support", "wheelrail", "motion"])
def test_missing_sections_say_what_to_write(section):
    data = {k: v for k, v in tomllib.loads(CASE).items() if k != section}
    with pytest.raises(InputError, match=rf"{section}: missing; write e.g. \[{section}\]"):
        scenario_from_dict(data)


def test_a_wrong_value_in_a_preset_file_names_the_file(case):
    (case.parent / "my.toml").write_text('preset = "bart"\n[bodies.car]\nmass = "7 s"\n')
    with pytest.raises(InputError, match=r"vehicle\.bodies\.car\.mass: .* \(in my\.toml\)$"):
        load_scenario(case, ["vehicle.preset=my.toml"])


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"[vehicle]\nx = = 3\n", "case.toml, line 2: not valid TOML"),
        (b"[vehicle", "not valid TOML"),
        (b"\xff\xfe", "not a UTF-8"),
        (b"x = " + b"9" * 5000, "not valid TOML"),
        (b"x = " + b"[" * 5000, "not valid TOML"),
        (b"", "vehicle: missing"),
    ],
)
def test_files_that_are_no_cases(tmp_path, content, words):
    path = tmp_path / "case.toml"
    path.write_bytes(content)
    with pytest.raises(InputError, match=words) as caught:
        load_scenario(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_a_missing_case_file(tmp_path):
    with pytest.raises(InputError, match=r"none\.toml: cannot be read"):
        load_scenario(tmp_path / "none.toml")


VARIANTS = [
    {},
    {"support": "at-grade"},
    {"vehicle": "bart-2023-runs", "wheelrail": "s1002-60e1", "hinge": "elastic"},
    {"record": None, "synthetic": {"seed": 3, "pga": "0.3 g"}},
    {"record": None, "motion": GroundMotion("g", 0.01, np.array([0.0, 0.1, -0.2]))},
    {"vertical": "v.AT2", "scale": -2.0, "channel": "UP", "units": "cm/s2", "dt": "2e-5 s"},
    {"support": Pier.from_preset("bart-berkeley", {"p_delta": True, "note": 'a "b"\n\x7f ü'})},
]


@pytest.mark.parametrize("variant", VARIANTS)
def test_round_trip_through_toml(variant, tmp_path):
    made = scenario(**{"record": "x.AT2", **variant})
    path = tmp_path / "elsewhere" / "case.toml"
    path.parent.mkdir()
    path.write_text(made.to_toml(), encoding="utf-8")
    assert load_scenario(path) == made
    assert "preset" not in tomllib.loads(made.to_toml())["vehicle"]


@given(
    scale=st.floats(-1e6, 1e6).filter(bool),
    speed=st.floats(0, 200),
    length=st.floats(1e-3, 1e3),
    name=st.text(min_size=1, max_size=20),
)
def test_round_trip_of_any_numbers_and_texts(scale, speed, length, name):
    support = {"preset": "bart-berkeley", "length": length, "note": name}
    made = scenario(record="x.AT2", scale=scale, speed=speed, support=support)
    assert scenario_from_dict(tomllib.loads(made.to_toml())) == made


def test_fingerprint_sees_contents_not_names(case, tmp_path):
    made = load_scenario(case)
    fingerprint = made.content_hash()
    assert len(fingerprint) == 64
    shutil.copy(case.parent / "records" / "ground.csv", tmp_path / "copy.txt")
    same = {
        "motion.record": str(tmp_path / "copy.txt"),
        "vehicle.note": "other",
        "support.name": "p",
    }
    assert load_scenario(case, same).content_hash() == fingerprint
    (tmp_path / "copy.txt").write_text(RECORD + "0.20,0.0\n")
    assert load_scenario(case, same).content_hash() != fingerprint
    for other in ("motion.scale=1.82", "support.bouc_wen.n=1.3", "solver.dt=1e-5"):
        assert load_scenario(case, [other]).content_hash() != fingerprint
    with pytest.raises(InputError, match="cannot be read"):
        load_scenario(case, ["motion.record=none.AT2"]).content_hash()


def test_fingerprint_of_a_motion_in_memory():
    ends = {"a": 0.0, "b": 0.0, "c": 1.0}
    motions = [GroundMotion(name, 0.01, np.array([0.0, 0.1, end])) for name, end in ends.items()]
    first, renamed, other = (scenario(motion=motion).content_hash() for motion in motions)
    assert first == renamed != other


def test_a_motion_in_memory_comes_out_as_it_went_in():
    motion = GroundMotion("ground", 0.01, np.array([0.0, 0.1, -0.2]))
    vertical = GroundMotion("up", 0.01, np.array([0.3, 0.0]))
    made = scenario(motion=motion, vertical=vertical, scale=2.0)
    out, up = made.ground_motion(), made.vertical_motion()
    assert out.acceleration.tolist() == [0.0, 0.2, -0.4]
    assert (out.name, out.dt) == ("ground", 0.01)
    assert up is not None
    assert up.acceleration.tolist() == [0.6, 0.0]
    with pytest.raises(InputError, match="time steps differ"):
        scenario(motion=motion, vertical=GroundMotion("up", 0.02, np.array([0.3, 0.0])))


def test_synthetic_motion_is_resolved_and_made():
    made = scenario(synthetic={"seed": 3, "pga": "0.3 g"}, scale=2.0)
    assert made.motion is not None
    assert made.motion.synthetic is not None
    assert made.motion.synthetic["seed"] == 3
    assert made.motion.synthetic["pga"] == pytest.approx(0.3 * 9.80665)
    assert np.abs(made.ground_motion().acceleration).max() == pytest.approx(0.6 * 9.80665)


def test_changes_of_a_scenario():
    made = scenario(record="x.AT2")
    assert made.with_changes({}) == made
    changed = made.with_changes({"vehicle.speed": "240 km/h", "support.kind": "at-grade"})
    assert changed.vehicle.speed == pytest.approx(240 / 3.6)
    assert changed.support == AtGrade()
    # A preset replaces a section that is whole by itself; values set with it stay.
    again = changed.with_changes(
        {
            "support.length": 7.0,
            "support.preset": "bart-berkeley",
            "vehicle.preset": "bart-2023-runs",
        }
    )
    assert again.support == Pier.from_preset("bart-berkeley", {"length": 7.0})
    assert again.vehicle.axles == 1


def test_wrong_arguments_in_python():
    with pytest.raises(InputError, match=r'solver\.dtt: unknown key; did you mean "dt"'):
        scenario(record="x", dtt=3)
    with pytest.raises(InputError, match=r"vehicle\.preset: must be a name or a path"):
        scenario(vehicle=3, record="x")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="motion: missing"):
        scenario()
    with pytest.raises(InputError, match="found record and synthetic"):
        scenario(record="x", synthetic={"seed": 1})


def test_schema_names_every_section_and_no_key_is_required():
    schema = json.loads(json.dumps(json_schema()))
    assert set(schema["properties"]) == {"vehicle", "support", "wheelrail", "motion", "solver"}
    assert '"required"' not in json.dumps(schema)
    assert "bart-berkeley" in schema["$defs"]["Support"]["properties"]["preset"]["examples"]
    assert schema["$defs"]["Solver"]["additionalProperties"] is False


def test_a_changed_file_changes_the_hash_and_the_motion(tmp_path):
    record = tmp_path / "motion.csv"
    case = scenario(record=record, units="g")

    def written(peak):
        record.write_text("".join(f"{0.01 * k:.2f},{peak * (k == 5)}\n" for k in range(20)))
        return case.content_hash(), case.ground_motion().pga

    first = written(0.1)
    assert written(0.125)[1] == pytest.approx(1.25 * first[1])
    assert written(0.125)[0] != first[0]
    assert written(0.1) == first


# --- a motion times its factor -------------------------------------------------------------


@pytest.mark.parametrize("origin", ["record", "synthetic", "samples", "vertical"])
def test_a_peak_above_3_g_after_scale_needs_the_same_consent_as_in_the_file(origin, case):
    made = {
        "record": load_scenario(case),  # 0.1 m/s2
        "synthetic": scenario(synthetic={"seed": 3, "pga": "0.1 m/s2"}),
        "samples": scenario(motion={"acceleration": [0.0, 0.1], "dt": 0.01}),
        "vertical": scenario(
            motion={"acceleration": [0.0, 1e-6], "dt": 0.01},
            vertical=GroundMotion("up", 0.01, [0.0, -0.1]),
        ),
    }[origin]

    def peak(scale, consent=False):
        changed = made.with_changes({"motion.scale": scale, "motion.allow_high_pga": consent})
        motion = changed.vertical_motion() if origin == "vertical" else changed.ground_motion()
        return motion.pga / 9.80665

    assert peak(294.0) == pytest.approx(2.998, abs=1e-3)
    for sign in (1.0, -1.0):
        with pytest.raises(
            InputError, match=r"PGA is 3.008 g with scale = -?295, over 3 g; .*allow"
        ):
            peak(sign * 295.0)
        assert peak(sign * 295.0, consent=True) == pytest.approx(3.008, abs=1e-3)
        for consent in (False, True):
            with pytest.raises(InputError, match=r"PGA is 102 g .*, over 100 g; lower it$"):
                peak(sign * 1e4, consent)


def test_a_factor_of_zero_is_refused(case):
    with pytest.raises(InputError, match=r"motion\.scale: must not be 0"):
        load_scenario(case, ["motion.scale=0"])
    validated = load_scenario(case).motion
    with pytest.raises(InputError, match="scale must not be 0"):
        validated.model_copy(update={"scale": 0.0}).lateral_motion()
