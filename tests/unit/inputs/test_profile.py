"""Profiles: segments, the standards' shapes, readers."""

import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from railquake.errors import InputError
from railquake.inputs.profile import (
    Arc,
    Line,
    Polynomial,
    Profile,
    builtin_profile,
    face_offset,
    flange_tip,
    outward_lean,
    point_at_height,
    profile_from_segments,
    read_profile,
    segments_from_table,
)
from railquake.inputs.wheelrail import WheelRail

RAIL_HALF = [
    {"kind": "arc", "start": [0, 0], "end": [0.6244, 0.0139], "centre": [0, 14], "radius": 14},
    {
        "kind": "arc",
        "start": [0.6244, 0.0139],
        "end": [0.8725, 0.0459],
        "centre": [0.5575, 1.5124],
        "radius": 1.5,
    },
    {
        "kind": "arc",
        "start": [0.8725, 0.0459],
        "end": [1.3167, 0.5820],
        "centre": [0.7544, 0.5958],
        "radius": 0.5625,
    },
    {"kind": "line", "start": [1.3167, 0.5820], "end": [1.3355, 1.3459]},
]


def distances(points: np.ndarray, profile: Profile) -> np.ndarray:
    """Distance of each point to the polyline of a profile."""
    line = np.column_stack([profile.y, profile.z])
    step = np.diff(line, axis=0)
    found = []
    for point in points:
        share = np.clip(((point - line[:-1]) * step).sum(1) / (step**2).sum(1), 0.0, 1.0)
        found.append(np.hypot(*(line[:-1] + share[:, None] * step - point).T).min())
    return np.array(found)


def simpack_points(path: Path) -> np.ndarray:
    text = path.read_text().split("point.begin")[1].split("point.end")[0]
    rows = [line.split("!")[0].split()[:2] for line in text.splitlines()]
    return np.array([[float(v) for v in row] for row in rows if row]) * 1e-3


def write_csv(path: Path, y: np.ndarray, z: np.ndarray, header: str = "y_mm,z_mm") -> Path:
    rows = "\n".join(f"{a:.7f},{b:.7f}" for a, b in zip(y * 1e3, z * 1e3, strict=True))
    path.write_text(f"{header}\n{rows}\n")
    return path


# --- segments ------------------------------------------------------------------------------


def test_arc_is_sampled_on_the_circle_with_its_own_curvature():
    quarter = Arc((0.0, 0.0), (0.01, 0.01), (0.0, 0.01), 0.01)
    profile = profile_from_segments("rail", "q", [quarter], spacing=1e-4)
    assert np.hypot(profile.y, profile.z - 0.01) == pytest.approx(0.01, abs=1e-15)
    assert profile.curvature == pytest.approx(100.0)
    assert np.diff(profile.arc_length).max() <= 1e-4
    assert profile.arc_length[-1] == pytest.approx(0.01 * math.pi / 2, rel=1e-5)


def test_curvature_is_positive_where_a_wheel_bulges_down_and_a_rail_up():
    bulge_down = Polynomial((0.0, 0.0, -2.0), -0.02, 0.02)
    assert (profile_from_segments("wheel", "w", [bulge_down]).curvature > 0.0).all()
    assert (profile_from_segments("rail", "r", [bulge_down]).curvature < 0.0).all()
    at_vertex = profile_from_segments("wheel", "w", [bulge_down]).curvature.max()
    assert at_vertex == pytest.approx(4.0, rel=1e-6)


def test_a_chain_drawn_from_the_field_side_is_turned():
    forward = [Line((-0.02, 0.001), (0.0, 0.0)), Polynomial((0.0, 0.0, 1.0), 0.0, 0.03)]
    backward = [Polynomial((0.0, 0.0, 1.0), 0.03, 0.0), Line((0.0, 0.0), (-0.02, 0.001))]
    one, other = (profile_from_segments("rail", "r", chain) for chain in (forward, backward))
    assert one.y == pytest.approx(other.y, abs=1e-15)
    assert one.curvature == pytest.approx(other.curvature)
    joint = int(np.flatnonzero(one.y == 0.0)[0])
    assert one.curvature[joint - 1] == 0.0 and one.curvature[joint] == pytest.approx(2.0)


def test_joints_are_points_and_appear_once():
    profile = profile_from_segments("rail", "r", segments_from_table(RAIL_HALF, "in", mirror=True))
    for y in (-0.6244, 0.0, 0.6244, 0.8725, 1.3355):
        assert np.count_nonzero(np.abs(profile.y - y * 0.0254) < 1e-12) == 1


def test_mirrored_rail_head_is_symmetric():
    profile = profile_from_segments("rail", "r", segments_from_table(RAIL_HALF, "in", mirror=True))
    assert profile.y[::-1] == pytest.approx(-profile.y, abs=1e-15)
    assert profile.z[::-1] == pytest.approx(profile.z, abs=1e-15)
    assert profile.curvature.max() == pytest.approx(1 / (0.5625 * 0.0254))
    assert face_offset(profile) == pytest.approx(-1.3167 * 0.0254, abs=1e-4)


def test_profile_arrays_cannot_be_changed():
    profile = builtin_profile("60e1")
    with pytest.raises(ValueError, match="read-only"):
        profile.y[0] = 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kind": "circle"}, "kind is 'circle'"),
        ({"centre": [0, 13]}, "off the circle"),
        ({"concave": True}, "given as concave"),
        ({"radius": "14"}, "not a number"),
        ({"radius": float("nan")}, "not finite"),
        ({"radius": -14}, "must be positive"),
        ({"end": [0.6, 0.0128]}, "begins .* mm away"),
        ({"start": [0, 0, 0]}, "two numbers"),
        ({"start": [0.1, 0.0004]}, "axis of symmetry"),
        ({"color": "red"}, 'unknown key "color"'),
    ],
)
def test_a_wrong_segment_is_refused_in_one_line(change, message):
    rows = [{**RAIL_HALF[0], **change}, *RAIL_HALF[1:]]
    with pytest.raises(InputError, match=message) as caught:
        profile_from_segments("rail", "r", segments_from_table(rows, "in", mirror=True))
    assert "\n" not in str(caught.value)


def test_a_missing_key_and_an_unknown_unit_are_refused():
    with pytest.raises(InputError, match='"end" is missing'):
        segments_from_table([{"kind": "line", "start": [0, 0]}])
    with pytest.raises(InputError, match='unknown unit "furlong"'):
        segments_from_table(RAIL_HALF, "furlong")


# --- the standards' shapes -----------------------------------------------------------------


def test_s1002_lies_within_a_micrometre_of_the_benchmark_points(shared):
    points = simpack_points(shared / "profiles" / "MBench_S1002_v3.prw") * [-1, 1]
    assert distances(points, builtin_profile("s1002")).max() < 1e-6


def test_60e1_lies_within_a_twentieth_of_a_millimetre_of_the_benchmark_points(shared):
    points = simpack_points(shared / "profiles" / "MBench_UIC60_v3.prr")
    assert distances(points, builtin_profile("60e1")).max() < 0.05e-3


def test_s1002_flange_is_28_mm_high_and_32_5_mm_thick():
    wheel = builtin_profile("s1002")
    y_tip, z_tip = flange_tip(wheel)
    assert (y_tip, z_tip) == (pytest.approx(-0.055, abs=5e-5), pytest.approx(0.028, abs=1e-6))
    # Thickness: from the back to the face, 10 mm below the running circle (EN 13715).
    assert point_at_height(wheel, 0.010, "field") + 0.070 == pytest.approx(0.0325, abs=1e-4)
    assert np.interp(0.0, wheel.y, wheel.z) == pytest.approx(0.0, abs=1e-6)


def test_s1002_flank_is_the_70_degrees_of_the_standard():
    wheel = builtin_profile("s1002")
    slope = np.diff(wheel.z) / np.diff(wheel.y)
    on_flank = (wheel.y[:-1] > -0.03975) & (wheel.y[1:] < -0.03843)
    assert np.degrees(np.arctan(-slope[on_flank])) == pytest.approx(70.0, abs=0.01)


def test_60e1_has_its_top_at_the_origin_and_its_face_where_contact_found_it():
    rail = builtin_profile("60e1")
    top = int(np.argmin(rail.z))
    assert (rail.y[top], rail.z[top]) == pytest.approx((0.0, 0.0), abs=1e-4)
    assert rail.curvature[top] == pytest.approx(1 / 0.3)
    # CONTACT places the benchmark's rail at 760.53 mm for a gauge of 1435 mm.
    assert 1.435 / 2 - face_offset(rail) == pytest.approx(0.76053, abs=0.05e-3)


@pytest.mark.parametrize("name", ["s1002", "60e1"])
def test_builtin_shapes_are_tangent_continuous(name):
    profile = builtin_profile(name)
    turn = np.abs(np.diff(np.unwrap(np.arctan2(np.diff(profile.z), np.diff(profile.y)))))
    neighbours = np.abs(profile.curvature)
    greatest = np.maximum(np.maximum(neighbours[:-2], neighbours[1:-1]), neighbours[2:])
    assert (turn - greatest * 1e-4).max() < 1e-4  # no corner beyond the bend itself


def test_unknown_builtin_names_what_there_is():
    with pytest.raises(InputError, match="built in are s1002, 60e1"):
        builtin_profile("s1003")


# --- files ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("file", "kind", "builtin"),
    [("MBench_S1002_v3.prw", "wheel", "s1002"), ("MBench_UIC60_v3.prr", "rail", "60e1")],
)
def test_benchmark_files_read_like_the_built_in_shapes(shared, file, kind, builtin):
    read, drawn = read_profile(shared / "profiles" / file, kind), builtin_profile(builtin)
    points = np.column_stack([read.y, read.z])
    assert distances(points[30:-30], drawn).max() < 0.05e-3
    tread = np.abs(read.y + 0.003) < (0.02 if kind == "wheel" else 0.003)
    expected = np.interp(read.y[tread], drawn.y, drawn.curvature)
    tolerance = 0.05 if kind == "wheel" else 0.35  # the rail file's own points wave
    assert read.curvature[tread] == pytest.approx(expected, abs=tolerance)


def test_csv_noise_of_two_micrometres_leaves_the_curvature_usable(tmp_path):
    drawn = builtin_profile("s1002", spacing=2e-4)
    noise = np.random.default_rng(1).normal(0.0, 2e-6, drawn.z.size)
    read = read_profile(write_csv(tmp_path / "w.csv", drawn.y, drawn.z + noise), "wheel")
    tread = np.abs(read.y) < 0.015
    expected = np.interp(read.y[tread], drawn.y, drawn.curvature)
    assert np.sqrt(np.mean((read.curvature[tread] - expected) ** 2)) < 1.0
    throat = (read.y > -0.0378) & (read.y < -0.0360)
    assert read.curvature[throat] == pytest.approx(-1 / 0.013, rel=0.1)


def test_csv_order_columns_and_units_are_the_files_own(tmp_path):
    drawn = builtin_profile("60e1", spacing=5e-4)
    rows = "\n".join(
        f"{n},{z:.9f},{y / 0.0254:.9f}"
        for n, (y, z) in enumerate(zip(drawn.y[::-1], drawn.z[::-1], strict=True))
    )
    path = tmp_path / "r.csv"
    path.write_text(f"# a comment\nnumber, z_m, y_in\n{rows}\n")
    read = read_profile(path, "rail")
    assert distances(np.column_stack([read.y, read.z])[30:-30], drawn).max() < 0.03e-3
    assert np.diff(read.arc_length).max() <= 1e-4


def _swap(y, z):
    y[200:202], z[200:202] = y[201:199:-1].copy(), z[201:199:-1].copy()


def _half_reversed(y, z):
    y[900:], z[900:] = y[900:][::-1].copy(), z[900:][::-1].copy()


def _fold(y, z):
    y[1000:1100] -= np.concatenate([np.linspace(0, 0.006, 50), np.linspace(0.006, 0, 50)])


def _repeat(y, z):
    y[300], z[300] = y[299], z[299]


def _mirror(y, z):
    y *= -1.0


def _upside_down(y, z):
    z *= -1.0


def _in_metres(y, z):
    y *= 1000.0
    z *= 1000.0


@pytest.mark.parametrize(
    ("damage", "message"),
    [
        (_swap, r"w.csv, line 20\d: the outline folds back"),
        (_half_reversed, "folds back"),
        (_fold, r"w.csv, line \d+: (y goes back|the outline folds)"),
        (_repeat, "line 302: repeats the point of line 301"),
        (_mirror, "flange tip is at y = .* mirror y"),
        (_upside_down, "no flange tip"),
        (_in_metres, "check the unit"),
    ],
)
def test_damaged_wheel_is_refused_with_its_line(tmp_path, damage, message):
    drawn = builtin_profile("s1002")
    y, z = drawn.y.copy(), drawn.z.copy()
    damage(y, z)
    with pytest.raises(InputError, match=message) as caught:
        read_profile(write_csv(tmp_path / "w.csv", y, z), "wheel")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty"),
        ("y,z\n1,2\n", "column y has no unit"),
        ("y_furlong,z_mm\n1,2\n", 'unit "furlong"'),
        ("1,2\n3,4\n", "no table of points"),
        ("y_mm,z_mm\n1,2\n2,3\n", "2 points"),
        ("y_mm,z_mm\n1,nan\n", "line 2.*not a finite number"),
        ("y_mm,z_mm\n1,2\nx,3\n", 'line 3: "x" is not a number'),
        ("y_mm,z_mm\n1\n", "line 2: 1 values"),
    ],
)
def test_csv_without_a_usable_table_is_refused(tmp_path, text, message):
    path = tmp_path / "p.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        read_profile(path, "wheel")


SIMPACK = """
header.begin
  type = {type}
header.end
spline.begin
  mirror.y = {mirror}
  units.len.f = {units}
{extra}
  point.begin
{points}
  point.end
spline.end
"""


def write_simpack(path: Path, profile: Profile, **fields: object) -> Path:
    points = "\n".join(
        f"{-y * 1e3:.7E}\t{z * 1e3:.7E} ! comment"
        for y, z in zip(profile.y, profile.z, strict=True)
    )
    filled = {"type": 1, "mirror": 1, "units": 1000.0, "extra": "", "points": points, **fields}
    path.write_text(SIMPACK.format(**filled))
    return path


def test_simpack_mirror_flag_and_units_are_carried_out(tmp_path):
    drawn = builtin_profile("s1002", spacing=3e-4)
    read = read_profile(write_simpack(tmp_path / "w.prw", drawn), "wheel")
    assert flange_tip(read) == pytest.approx(flange_tip(drawn), abs=5e-4)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"mirror": 0}, "mirror y"),
        ({"type": 0}, "holds a rail profile where a wheel"),
        ({"extra": "rotate = 0.025"}, "rotate is not zero"),
        ({"extra": "bound.y.min = -10\nbound.y.max = 10"}, "bound.y cuts"),
        ({"units": 0}, "must be positive"),
        ({"units": "mm"}, '"mm" is not a number'),
        ({"points": "1 2 3 4"}, "4 values"),
        ({"points": "NaN 2"}, "not a finite number"),
        ({"points": ""}, "0 points"),
    ],
)
def test_wrong_simpack_file_is_refused(tmp_path, fields, message):
    path = write_simpack(tmp_path / "w.prw", builtin_profile("s1002", spacing=1e-3), **fields)
    with pytest.raises(InputError, match=message):
        read_profile(path, "wheel")


def test_simpack_file_without_table_or_units_is_refused(tmp_path):
    path = write_simpack(tmp_path / "w.prw", builtin_profile("s1002", spacing=1e-3))
    whole = path.read_text()
    for removed, message in (
        ("point.begin", "no table of points|without point.begin"),
        ("point.end", "cut short"),
        ("units.len.f", "units.len.f is missing"),
    ):
        path.write_text("\n".join(row for row in whole.splitlines() if removed not in row))
        with pytest.raises(InputError, match=message):
            read_profile(path, "wheel")


def test_a_rail_is_not_a_wheel_nor_a_wheel_a_rail(tmp_path):
    wheel, rail = builtin_profile("s1002"), builtin_profile("60e1")
    with pytest.raises(InputError, match="no flange tip"):
        read_profile(write_csv(tmp_path / "r.csv", rail.y, rail.z), "wheel")
    with pytest.raises(InputError, match="whole head is needed"):
        read_profile(write_csv(tmp_path / "w.csv", wheel.y, wheel.z), "rail")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(InputError, match=r"nowhere.csv: No such file"):
        read_profile(tmp_path / "nowhere.csv", "rail")


def _is_valid(profile: Profile) -> bool:
    finite = all(np.isfinite(v).all() for v in (profile.y, profile.z, profile.curvature))
    return finite and bool((np.diff(profile.arc_length) > 0.0).all())


@given(data=st.data(), suffix=st.sampled_from([".csv", ".prw", ".prr"]))
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_nothing_but_an_input_error_or_a_valid_profile_comes_out(tmp_path_factory, data, suffix):
    folder = tmp_path_factory.getbasetemp()
    kind = data.draw(st.sampled_from(["wheel", "rail"]))
    drawn = builtin_profile("s1002" if kind == "wheel" else "60e1", spacing=2e-3)
    path = folder / f"fuzz{suffix}"
    if suffix == ".csv":
        write_csv(path, drawn.y, drawn.z)
    else:
        sign = "1" if suffix == ".prw" else "0"
        write_simpack(path, drawn, type=sign)
    lines = path.read_bytes().splitlines()
    for _ in range(data.draw(st.integers(0, 3))):
        at = data.draw(st.integers(0, len(lines) - 1))
        kind_of_damage = data.draw(st.sampled_from(["drop", "repeat", "text", "number", "swap"]))
        if kind_of_damage == "drop" and len(lines) > 1:
            del lines[at]
        elif kind_of_damage == "repeat":
            lines.insert(at, lines[at])
        elif kind_of_damage == "text":
            lines[at] = data.draw(st.binary(max_size=30))
        elif kind_of_damage == "swap":
            other = data.draw(st.integers(0, len(lines) - 1))
            lines[at], lines[other] = lines[other], lines[at]
        else:
            pair = st.tuples(st.floats(), st.floats(-100.0, 100.0))
            y, z = data.draw(pair)
            lines[at] = f"{y},{z}".encode() if suffix == ".csv" else f"{y} {z}".encode()
    path.write_bytes(b"\n".join(lines))
    outcome: Profile | InputError
    try:
        outcome = read_profile(path, kind)
    except InputError as error:
        outcome = error
    assert "\n" not in str(outcome) if isinstance(outcome, InputError) else _is_valid(outcome)


@given(content=st.binary(max_size=400), suffix=st.sampled_from([".csv", ".prw"]))
@settings(max_examples=100, deadline=None)
def test_random_bytes_are_refused_clearly(tmp_path_factory, content, suffix):
    path = tmp_path_factory.getbasetemp() / f"noise{suffix}"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_profile(path, "wheel")
    assert "\n" not in str(caught.value)


# --- a rail that is mirrored; dialects -----------------------------------------------------


def canted(lean, *, mirror=False):
    """60E1, built in with 1:40, turned so that its top leans by so much to the track's middle."""
    rail = builtin_profile("60e1")
    lean -= math.atan(1 / 40)
    sign = -1.0 if mirror else 1.0
    y, z = (
        math.cos(lean) * rail.y + math.sin(lean) * rail.z,
        math.cos(lean) * rail.z - math.sin(lean) * rail.y,
    )
    order = slice(None, None, int(sign))
    return Profile("rail", "canted", sign * y[order], z[order], rail.curvature[order])


@pytest.mark.parametrize("lean", [1 / 40, 1 / 30, 1 / 20])
def test_a_canted_rail_that_is_mirrored_leans_outward(lean):
    upright = outward_lean(canted(0.0))
    assert abs(upright) < 1e-3
    assert outward_lean(canted(lean)) == pytest.approx(-lean, rel=0.15)
    assert outward_lean(canted(lean, mirror=True)) == pytest.approx(lean, rel=0.15)


def test_a_worn_gauge_corner_is_no_lean():
    """As a worn high rail has it: up to 6 mm off at the top of its gauge face."""
    rail = canted(0.0)
    gauge = rail.y < np.median(rail.y)
    y = rail.y + np.where(gauge, 6e-3 * np.clip(1.0 - rail.z / 0.035, 0.0, 1.0), 0.0) * (
        rail.z > 0.012
    )
    assert outward_lean(Profile("rail", "worn", y, rail.z, rail.curvature)) < 0.0125


def test_a_pair_with_a_mirrored_rail_says_so(tmp_path):
    for mirror in (False, True):
        rail = canted(1 / 40, mirror=mirror)
        rows = "".join(
            f"{1e3 * y:.6f},{1e3 * z:.6f}\n" for y, z in zip(rail.y, rail.z, strict=True)
        )
        (tmp_path / "r.csv").write_text("y_mm,z_mm\n" + rows)
        pair = WheelRail.from_preset("s1002-60e1", {"rail": str(tmp_path / "r.csv")})
        doubts = pair.doubts()
        assert bool(doubts) == mirror
    assert "mirror y" in doubts[0] and "r.csv" in doubts[0]
    for name in ("bart", "s1002-60e1"):
        assert WheelRail.from_preset(name).doubts() == ()


def rail_text(head, between=","):
    rail = builtin_profile("60e1")
    rows = [
        f"{1e3 * y:.5f}{between}{1e3 * z:.5f}"
        for y, z in zip(rail.y[::5], rail.z[::5], strict=True)
    ]
    return "\n".join([head, *rows]) + "\n"


@pytest.mark.parametrize(
    ("head", "between"),
    [
        ("y (mm),z (mm)", ","), ("Y_MM,Z_MM", ","), ("y [mm],z [mm]", ","), ("y mm,z mm", ","),
        ("y_mm;z_mm", ";"), ("y_mm\tz_mm", "\t"),
    ],
)  # fmt: skip
def test_heads_of_profiles_are_read_however_the_unit_is_written(tmp_path, head, between):
    (tmp_path / "plain.csv").write_text(rail_text("y_mm,z_mm"))
    (tmp_path / "other.csv").write_text(rail_text(head, between))
    plain, other = (read_profile(tmp_path / f"{n}.csv", "rail") for n in ("plain", "other"))
    np.testing.assert_array_equal(other.y, plain.y)
    np.testing.assert_array_equal(other.z, plain.z)


def test_an_exponent_of_fortran_is_one(tmp_path):
    (tmp_path / "d.csv").write_text(
        rail_text("y_mm,z_mm").replace("\n", "D+00\n").replace("z_mmD+00", "z_mm")
    )
    (tmp_path / "e.csv").write_text(rail_text("y_mm,z_mm"))
    d, e = (read_profile(tmp_path / f"{n}.csv", "rail") for n in "de")
    np.testing.assert_array_equal(d.z, e.z)


@pytest.mark.parametrize("number", ["1e308", "-1e308", "9" * 5000, "nan", "1_0", "0x10"])
def test_a_number_that_no_profile_has_is_one_line(tmp_path, number):
    (tmp_path / "r.csv").write_text(rail_text("y_mm,z_mm") + f"40,{number}\n")
    (tmp_path / "r.prr").write_text(f"units.len.f = {number}\npoint.begin\n0 0\n1 1\npoint.end\n")
    for name in ("r.csv", "r.prr"):
        with pytest.raises(InputError, match=r", line \d+: ") as error:
            read_profile(tmp_path / name, "rail")
        assert len(str(error.value)) < 300 + len(str(tmp_path))
