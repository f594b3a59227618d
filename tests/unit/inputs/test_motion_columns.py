"""Columns and lists of numbers: heads, units, steps and times are read, or said to be missing."""

from pathlib import Path

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.inputs.ground_motion import STANDARD_GRAVITY, read_motion, record_contents

G = STANDARD_GRAVITY
VALUES = np.round(0.2 * np.sin(np.arange(60) * 0.7) * np.exp(-np.arange(60) / 30.0), 6)
ROWS = "".join(f"{i * 0.01:.2f},{value:.6f}\n" for i, value in enumerate(VALUES))
ALONE = "".join(f"{value:.6e}\n" for value in VALUES)
THREE = "".join(f"{a:.6f} {-a / 2:.6f} {a / 4:.6f}\n" for a in VALUES)


def write(folder: Path, text: str) -> Path:
    path = folder / "record.txt"
    path.write_text(text)
    return path


def read(folder: Path, text: str, **options: object) -> tuple[np.ndarray, float, str]:
    motion = read_motion(write(folder, text), **options)  # type: ignore[arg-type]
    return np.array(motion.acceleration), motion.dt, " ".join(motion.notes)


@pytest.mark.parametrize("head", ["t_s,a_g", "time,acc_g", "t (s),a_G"])
def test_a_unit_taken_from_a_name_is_remarked_on_and_gives_way(tmp_path: Path, head: str) -> None:
    values, _, notes = read(tmp_path, f"{head}\n{ROWS}")
    np.testing.assert_allclose(values, VALUES * G, rtol=1e-9)
    assert "may mean something else" in notes
    values, _, notes = read(tmp_path, f"{head}\n{ROWS}", units="m/s2")
    np.testing.assert_allclose(values, VALUES, rtol=1e-9)
    assert "the unit m/s2 given is used" in notes


@pytest.mark.parametrize("head", ["t (s),a (g)", "t_s,acc_cm_s2", "t_s,a_gal"])
def test_a_unit_stated_for_certain_needs_no_remark(tmp_path: Path, head: str) -> None:
    assert "taken" not in read(tmp_path, f"{head}\n{ROWS}")[2]
    with pytest.raises(InputError, match="was given"):
        read(tmp_path, f"{head}\n{ROWS}", units="ft/s2")


@pytest.mark.parametrize(
    "head",
    [
        "t_s,acc_h",
        "t_s,acc_v",
        "# Units: s, g\n# time acceleration",
        "# units: s\nt,acc",
        "t_s,a_s",
    ],
)
def test_heads_that_name_no_unit_of_acceleration_take_the_one_given(
    tmp_path: Path, head: str
) -> None:
    values, dt, _ = read(tmp_path, f"{head}\n{ROWS}", units="g")
    np.testing.assert_allclose(values, VALUES * G, rtol=1e-9)
    assert dt == 0.01


def test_a_line_of_units_is_read(tmp_path: Path) -> None:
    rows = "".join(f"{10 * i},{value:.6f}\n" for i, value in enumerate(VALUES))
    values, dt, notes = read(tmp_path, f"# Units: ms, m/s2\ntime,acc\n{rows}")
    np.testing.assert_allclose(values, VALUES, rtol=1e-9)
    assert dt == pytest.approx(0.01) and "no unit of time" not in notes


def test_cells_in_quotation_marks_are_read(tmp_path: Path) -> None:
    quoted = "".join(
        ",".join(f'"{cell}"' for cell in row.split(",")) + "\n" for row in ROWS.split()
    )
    values, dt, _ = read(tmp_path, f'"Time (s)","Acceleration (m/s2)"\n{quoted}')
    np.testing.assert_allclose(values, VALUES, rtol=1e-9)
    assert dt == 0.01


@pytest.mark.parametrize("head", ["", "N-S E-W U-D\n", "x y z\n", "HNN HNE HNZ\n"])
def test_three_columns_without_a_time_are_three_components(tmp_path: Path, head: str) -> None:
    path = write(tmp_path, head + THREE)
    assert len(record_contents(path).channels) == 3
    for channel, factor in ((1, 1.0), (2, -0.5), (3, 0.25)):
        motion = read_motion(path, channel=channel, units="g", dt=0.02)
        np.testing.assert_allclose(motion.acceleration, VALUES * G * factor, atol=1e-5)
        assert motion.dt == 0.02
    with pytest.raises(InputError, match="components and no time"):
        read_motion(path, channel=1, units="g")


@pytest.mark.parametrize("per_line", [2, 4, 5, 8])
def test_lists_of_values_are_called_so_and_not_damaged(tmp_path: Path, per_line: int) -> None:
    rows = [VALUES[at : at + per_line] for at in range(0, len(VALUES), per_line)]
    text = "\n".join(" ".join(f"{value:.7E}" for value in row) for row in rows)
    with pytest.raises(
        InputError, match="a list of values, it seems; write one value on each line"
    ):
        read(tmp_path, text, units="g", dt=0.01)


@pytest.mark.parametrize(
    "text",
    [
        " ".join(f"{value:.5e}" for value in VALUES),
        "\n".join(" ".join(f"{v:.5e}" for v in VALUES[at : at + 3]) for at in range(0, 59, 3))
        + f"\n{VALUES[-1]:.5e}",
    ],
)
def test_one_line_and_a_shorter_last_one_are_lists_too(tmp_path: Path, text: str) -> None:
    with pytest.raises(InputError, match="a list of values, it seems"):
        read(tmp_path, text, units="g", dt=0.01)


@pytest.mark.parametrize("name", ["vel_cm_s", "velocity", "disp", "displacement (g)"])
def test_a_column_of_another_motion_is_not_read_as_acceleration(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError, match="holds no acceleration"):
        read(tmp_path, f"t_s,{name}\n{ROWS}", units="g")


def test_a_number_of_values_alone_is_no_value(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="first value, 60, is the number of those that follow"):
        read(tmp_path, f"60\n{ALONE}", units="gal", dt=0.01)


def test_text_behind_the_values_of_at2_is_called_so(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="the text 'Processed by nobody' stands behind the 60"):
        read(tmp_path, f"{AT2}NPTS= 60, DT= .0100 SEC\n{ALONE}Processed by nobody\n")


def test_a_step_and_a_number_before_the_values_are_read(tmp_path: Path) -> None:
    values, dt, _ = read(tmp_path, f"0.0100 60\n{ALONE}", units="m/s2")
    np.testing.assert_allclose(values, VALUES, rtol=1e-9)
    assert dt == 0.01


@pytest.mark.parametrize(
    ("head", "step"),
    [
        ("dt = 0.01\n", 0.01),
        ("Time step (s): 0.005\n", 0.005),
        ("SAMPLING_INTERVAL_S: 0.02\n", 0.02),
        ("sampling rate = 200 Hz\n", 0.005),
        ("DT: 5 ms\n", 0.005),
    ],
)
def test_a_step_that_the_header_states_is_used_and_not_overridden(
    tmp_path: Path, head: str, step: float
) -> None:
    assert read(tmp_path, head + ALONE, units="g")[1] == pytest.approx(step)
    with pytest.raises(InputError, match="states a time step"):
        read(tmp_path, head + ALONE, units="g", dt=2 * step)


def test_a_step_that_the_time_column_does_not_have_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"states a time step of 0\.02 s, and the time column"):
        read(tmp_path, f"# dt = 0.02 s\nt (s),a (g)\n{ROWS}")


@pytest.mark.parametrize("head", ["NPTS: 61\n", "number of points = 59\n"])
def test_a_number_of_values_that_are_not_there_is_refused(tmp_path: Path, head: str) -> None:
    with pytest.raises(InputError, match=r"announces (61|59) values and has 60"):
        read(tmp_path, head + ALONE, units="g", dt=0.01)


@pytest.mark.parametrize("mark", ["-999", "-9999.0", "999.9", "-99999"])
@pytest.mark.parametrize("units", ["g", "gal", "mm/s2"])
def test_marks_of_missing_values_are_noticed_in_any_unit(
    tmp_path: Path, mark: str, units: str
) -> None:
    lines = ALONE.splitlines()
    lines[30] = mark
    with pytest.raises(InputError, match="sample 31 is .*mark of a missing value"):
        read(tmp_path, "\n".join(lines), units=units, dt=0.01)


def test_a_real_value_of_999_is_no_mark(tmp_path: Path) -> None:
    lines = (VALUES * 6000.0).round(1).astype(str).tolist()
    lines[30] = "999.0"
    assert read(tmp_path, "\n".join(lines), units="gal", dt=0.01)[0][30] == pytest.approx(9.99)


@pytest.mark.parametrize("per_line", [1, 2, 5])
def test_a_number_and_a_step_before_the_values_are_read(tmp_path: Path, per_line: int) -> None:
    rows = [VALUES[at : at + per_line] for at in range(0, len(VALUES), per_line)]
    body = "\n".join(" ".join(f"{value:.6e}" for value in row) for row in rows)
    values, dt, notes = read(tmp_path, f"a sample motion\n60 0.0100\n{body}\n", units="m/s2")
    np.testing.assert_allclose(values, VALUES, rtol=1e-9)
    assert dt == 0.01 and "'60 0.0100' in line 2" in notes
    with pytest.raises(
        InputError, match="announces 61 values at steps of 0.01 s, and 60"
    ) as caught:
        read(tmp_path, f"a sample motion\n61 0.0100\n{ALONE}", units="m/s2")
    assert "damaged" not in str(caught.value)


AT2 = "PEER\nX, 1/1/2001, Y, 90\nACCELERATION TIME SERIES IN UNITS OF G\n"


@pytest.mark.parametrize(
    "end", ["*** End Data ***", "END", "/&", "--- end of file ---\n\n", "# End", "\n***\n"]
)
def test_end_marks_of_at2_are_no_values(tmp_path: Path, end: str) -> None:
    values, _, _ = read(tmp_path, f"{AT2}NPTS= 60, DT= .0100 SEC\n{ALONE}{end}\n")
    np.testing.assert_allclose(values, VALUES * G, rtol=1e-9)


@pytest.mark.parametrize("zero", ["0.0", "0", "0.", "0.000"])
def test_one_zero_appended_to_at2_is_a_sample(tmp_path: Path, zero: str) -> None:
    values, _, _ = read(tmp_path, f"{AT2}NPTS= 61, DT= .0100 SEC\n{ALONE}{zero}\n")
    assert values.size == 61 and values[-1] == 0.0


def test_the_step_may_stand_before_the_number(tmp_path: Path) -> None:
    values, dt, _ = read(tmp_path, f"{AT2}DT= 0.0100 SEC, NPTS= 60\n{ALONE}")
    assert (values.size, dt) == (60, 0.01)
