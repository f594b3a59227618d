"""Measured loops: what is read, and what is refused in one line."""

import numpy as np
import pytest

from railquake.calibration.cyclic import read_loop
from railquake.calibration.loop import column_flexibility, drive_hinge
from railquake.errors import InputError

LENGTH = 6.0
FLEXIBILITY = column_flexibility(44.8e9, 0.16425, LENGTH)


@pytest.fixture
def specimen(known_hinge, cycles):
    """Displacement, m, and force, N, of a specimen of known hinge."""
    moment = drive_hinge(known_hinge, cycles, FLEXIBILITY, substeps=10)
    return np.column_stack([cycles * LENGTH, moment / LENGTH])


def write(path, table, header="displacement_mm,force_kN", factors=(1e3, 1e-3)):
    rows = [",".join(repr(float(v)) for v in row) for row in table * np.array(factors)]
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def refused(path, *arguments, **options):
    with pytest.raises(InputError) as error:
        read_loop(path, *arguments, **options)
    message = str(error.value)
    assert "\n" not in message
    assert str(path) in message or "--" in message
    return message


@pytest.mark.parametrize(
    ("header", "factors"),
    [
        ("displacement_mm,force_kN", (1e3, 1e-3)),
        ("Displacement [m],Force [N]", (1.0, 1.0)),
        ("disp (inch),load (kip)", (1.0 / 0.0254, 1.0 / 4448.2216152605)),
        ("drift mm, shear MN", (1e3, 1e-6)),
        ("drift_%,force_kN", (100.0 / LENGTH, 1e-3)),
        ("drift (percent),force (kgf)", (100.0 / LENGTH, 1.0 / 9.80665)),
        ("drift [rad],force [tf]", (1.0 / LENGTH, 1.0 / 9806.65)),
    ],
)
def test_units_stand_behind_the_names(tmp_path, specimen, header, factors):
    path = write(tmp_path / "t.csv", specimen, header, factors)
    loop = read_loop(path, length=LENGTH, flexibility=FLEXIBILITY)
    assert np.abs(loop.chord).max() == pytest.approx(0.02, rel=0.01)
    largest = np.abs(specimen[:, 1]).max() * LENGTH
    assert np.abs(loop.moment).max() == pytest.approx(largest, rel=0.01)
    assert loop.flexibility == FLEXIBILITY


@pytest.mark.parametrize("separator", [";", "\t"])
def test_semicolons_and_tabs_part_the_columns(tmp_path, specimen, separator):
    path = write(tmp_path / "t.csv", specimen)
    plain = read_loop(path, length=LENGTH)
    path.write_text("# a remark, with a comma\n" + path.read_text().replace(",", separator))
    assert np.array_equal(read_loop(path, length=LENGTH).moment, plain.moment)


@pytest.mark.parametrize(
    ("header", "row", "reason"),
    [
        ("displacement_mm;force_kN", "0,5;1,25", "decimal comma; write decimal points"),
        ("displacement_mm,force_kN", "2001-01-01 00:00:01,1.0", "a date or time of day"),
        ("displacement_mm,force_tonf", "0.5,1.0", "may be 9.807 kN .metric. or 8.896 kN"),
        ("displacement_mm,force_kN", "0.5,x", '"x" is no number'),
    ],
)
def test_numbers_and_units_that_are_not_read_are_named(tmp_path, header, row, reason):
    path = tmp_path / "t.csv"
    path.write_text(f"{header}\n{row}\n")
    with pytest.raises(InputError, match=reason):
        read_loop(path, length=LENGTH)


def test_units_can_be_given_beside_the_file(tmp_path, specimen):
    path = write(tmp_path / "t.csv", specimen, "u,f", (1e3, 1e-3))
    assert '"u" has no unit' in refused(path, length=LENGTH)
    loop = read_loop(path, length=LENGTH, rotation_unit="mm", moment_unit="kN")
    assert np.abs(loop.chord).max() == pytest.approx(0.02, rel=0.01)


def test_moment_and_rotation_are_the_hinges_own(tmp_path, known_hinge, cycles):
    table = np.column_stack([cycles, drive_hinge(known_hinge, cycles, substeps=10)])
    path = write(tmp_path / "t.csv", table, "rotation_mrad,moment_kN m", (1e3, 1e-3))
    loop = read_loop(path, "moment-rotation", flexibility=FLEXIBILITY)
    assert loop.flexibility == 0.0
    assert np.abs(loop.hinge_rotation).max() == pytest.approx(0.02, rel=0.01)


def test_comments_other_columns_and_blank_lines_are_passed_over(tmp_path, specimen):
    path = tmp_path / "t.csv"
    rows = [f"{k},{1e-3 * f},{1e3 * u}" for k, (u, f) in enumerate(specimen)]
    path.write_text("# test 7\nstep,force_kN,displacement_mm\n\n" + "\n".join(rows))
    loop = read_loop(path, length=LENGTH)
    assert np.abs(loop.chord).max() == pytest.approx(0.02, rel=0.01)


def test_monotonic_file_is_no_loop(tmp_path):
    x = np.linspace(0.0, 0.1, 50)
    path = write(tmp_path / "t.csv", np.column_stack([x, 1e6 * np.tanh(x / 0.02)]))
    assert "is no loop: displacement_mm grows or falls throughout" in refused(path, length=LENGTH)
    there_and_back = np.concatenate([x, x[::-1]])
    path = write(tmp_path / "u.csv", np.column_stack([there_and_back, 1e7 * there_and_back]))
    assert "is no loop: displacement_mm turns only once" in refused(path, length=LENGTH)


def test_swapped_columns_are_known_by_their_energy(tmp_path, specimen):
    """Read the other way round, a dissipating loop gains energy."""
    # values that pass for either: displacement and force of a like size
    swapped = np.column_stack([specimen[:, 1] * 1e-7, specimen[:, 0] * 1e7])
    message = refused(write(tmp_path / "t.csv", swapped), length=LENGTH)
    assert "gains energy" in message and "columns are swapped" in message


def test_swapped_names_are_known_by_the_energy_or_the_size(tmp_path, specimen):
    path = write(tmp_path / "t.csv", specimen, "force_kN,displacement_mm", (1e3, 1e-3))
    message = refused(path, length=LENGTH)
    assert "swapped" in message or "the unit is another" in message


def test_reversed_sign_is_told_from_swapped_columns(tmp_path, specimen):
    path = write(tmp_path / "t.csv", specimen * np.array([1.0, -1.0]))
    assert "force_kN falls where displacement_mm grows" in refused(path, length=LENGTH)


@pytest.mark.parametrize(
    ("header", "found"),
    [
        ("displacement_m,force_kN", "the largest drift (displacement over length) would be 20 rad"),
        ("displacement_um,force_kN", "would be 2e-05 rad"),
        ("displacement_mm,force_GN", "which no concrete column has"),
        ("displacement_mm,force_mN", "which no concrete column has"),
    ],
)
def test_other_units_are_known_by_the_size(tmp_path, specimen, header, found):
    message = refused(write(tmp_path / "t.csv", specimen, header), length=LENGTH)
    assert found in message and "the unit is another (or --length is)" in message


def test_degrees_for_radians_are_known_by_the_size(tmp_path, known_hinge, cycles):
    table = np.column_stack([cycles, drive_hinge(known_hinge, cycles)])
    degrees = 180.0 / np.pi
    path = write(tmp_path / "t.csv", table, "rotation_rad,moment_kN m", (degrees, 1e-3))
    message = refused(path, "moment-rotation")
    assert "the largest rotation would be 1.15 rad" in message
    path = write(tmp_path / "u.csv", table, "rotation_deg,moment_kN m", (degrees, 1e-3))
    assert np.abs(read_loop(path, "moment-rotation").chord).max() == pytest.approx(0.02, rel=0.01)


def test_unit_of_another_kind_is_named(tmp_path, specimen):
    message = refused(write(tmp_path / "t.csv", specimen, "displacement_mm,force_mm"), length=6.0)
    assert "force_mm" in message and "must be a force" in message


def test_column_softer_than_the_loop_leaves_nothing_to_a_hinge(tmp_path, specimen):
    path = write(tmp_path / "t.csv", specimen)
    message = refused(path, length=LENGTH, flexibility=20.0 * FLEXIBILITY)
    assert "nothing is left to a hinge" in message


def test_too_few_points_are_refused(tmp_path, specimen):
    path = write(tmp_path / "t.csv", specimen[:12])
    assert "holds 12 points; a loop needs at least 20" in refused(path, length=LENGTH)


@pytest.mark.parametrize("bad", ["nan", "inf", "1,2;3", ""])
def test_a_value_that_is_no_finite_number_is_refused_with_its_line(tmp_path, specimen, bad):
    path = write(tmp_path / "t.csv", specimen)
    lines = path.read_text().splitlines()
    lines[7] = f"{lines[7].split(',')[0]},{bad.split(',')[-1]}"
    path.write_text("\n".join(lines))
    message = refused(path, length=LENGTH)
    assert "line 8" in message and "force_kN" in message


def test_a_loop_must_begin_at_rest(tmp_path, specimen):
    path = write(tmp_path / "t.csv", specimen[200:])
    assert "must begin at rest" in refused(path, length=LENGTH)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("a,b\n1,2\n", "no column for the displacement among a, b"),
        ("u_mm,d_mm,f_kN\n", "more than one column for the displacement"),
        ("displacement_mm,force_kN\n" + "0,0\n" * 30, "displacement_mm is zero throughout"),
        ("displacement_mm,force_kN\n" + "0,0\n1,0\n-1,0\n" * 10, "force_kN is zero throughout"),
    ],
)
def test_files_without_a_loop_are_refused(tmp_path, text, message):
    path = tmp_path / "t.csv"
    path.write_text(text)
    assert message in refused(path, length=LENGTH)


def test_missing_file_length_and_kind_are_named(tmp_path, specimen):
    assert "cannot be read" in refused(tmp_path / "none.csv", length=LENGTH)
    path = write(tmp_path / "t.csv", specimen)
    assert "--length" in refused(path)
    assert 'did you mean "moment-rotation"?' in refused(path, "moment-rotaton")
    (tmp_path / "b.csv").write_bytes(b"\xff\xfe\x00\x01")
    assert "is not a CSV text file" in refused(tmp_path / "b.csv", length=LENGTH)
