"""Record files: every dialect that is read, and one clear line for every one that is not."""

import csv
import re
import runpy
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.inputs.ground_motion import STANDARD_GRAVITY, read_motion

FILES = runpy.run_path(str(Path(__file__).with_name("motion_files.py")))
VALUES, SAMPLES, fields = FILES["VALUES"], FILES["SAMPLES"], FILES["fields"]
at2, columns, csmip, cosmos = (FILES[name] for name in ("at2", "columns", "csmip", "cosmos"))
smc, knet, usc = (FILES[name] for name in ("smc", "knet", "usc"))


def write(folder: Path, text: str, name: str = "record.txt") -> Path:
    path = folder / name
    path.write_bytes(text.encode())
    return path


TOLERANCE = {"csmip": 0.0006 / 100, "knet": 1e-6, "smc": 1e-5, "cosmos": 1e-7}


@pytest.mark.parametrize("kind", SAMPLES)
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_every_format_is_told_by_its_content(tmp_path: Path, kind: str, end: str) -> None:
    motion = read_motion(write(tmp_path, SAMPLES[kind].replace("\n", end)))
    if kind in ("at2", "csv"):
        expected = VALUES * STANDARD_GRAVITY
    elif kind == "knet":
        expected = (VALUES - VALUES.mean()) * STANDARD_GRAVITY
    else:
        expected = VALUES
    assert motion.dt == pytest.approx(0.01, rel=1e-12)
    np.testing.assert_allclose(motion.acceleration, expected, atol=TOLERANCE.get(kind, 1e-9) * 10)
    assert motion.source == str(tmp_path / "record.txt")
    assert motion.notes[0].startswith("format: ")


# ---------------------------------------------------------------- PEER AT2


@pytest.mark.parametrize(
    ("line", "dt"),
    [
        ("npts=   43, dt=   .0050 sec,   0 pole @    40.00000 hz", 0.005),
        ("  43   .0050 NPTS, DT", 0.005),
        ("43 0.02 NPTS,DT", 0.02),
        ("NPTS: 43 DT: 1.0E-02", 0.01),
        ("NPTS=43, DT= 5 MSEC", 0.005),
    ],
)
def test_at2_dialects(tmp_path: Path, line: str, dt: float) -> None:
    assert read_motion(write(tmp_path, at2(npts=line))).dt == dt


@pytest.mark.parametrize(
    ("line", "factor"),
    [
        ("IN UNITS OF G", STANDARD_GRAVITY),
        ("acceleration time series in units of g. filter: hp=0.08", STANDARD_GRAVITY),
        ("UNITS OF CM/S/S", 0.01),
        ("units: cm/sec**2", 0.01),
        ("UNITS = m/s^2", 1.0),
        ("Units (gal)", 0.01),
    ],
)
def test_at2_units_come_from_the_header(tmp_path: Path, line: str, factor: float) -> None:
    motion = read_motion(write(tmp_path, at2(units=line)))
    np.testing.assert_allclose(motion.acceleration, VALUES * factor, rtol=1e-6)


def test_at2_fortran_exponents_and_ragged_lines(tmp_path: Path) -> None:
    header = "x\nUNITS OF G\nNPTS= 4, DT= .0100 SEC,\n"
    motion = read_motion(write(tmp_path, header + " .1D-01\n\n -.2D-01 .3D-01\n.4d-01\n"))
    np.testing.assert_allclose(motion.acceleration / STANDARD_GRAVITY, [0.01, -0.02, 0.03, 0.04])


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"npts": "NPTS= 50, DT= .01"}, "NPTS is 50 and the file has only 43 values"),
        ({"npts": "NPTS= 40, DT= .01"}, "NPTS is 40 and the file has 43 values"),
        ({"npts": "NPTS= 43, DT= .0000 SEC"}, r"line 4: DT is .0000 s"),
        ({"npts": "NPTS= 43, DT= -.01 SEC"}, r"line 4: DT is -.01 s"),
        ({"npts": "NPTS= 43, DT= .01 LY"}, "line 4: DT is in 'LY'"),
        ({"npts": "NPTS= 4.5, DT= .01"}, "line 4: NPTS is '4.5'"),
        ({"npts": "NPTS= 0, DT= .01"}, "line 4: NPTS is '0'"),
        ({"npts": "NPTS= 43, DT= 7"}, "7 s is implausible"),
        ({"npts": "NPTS, DT"}, "line 4: NPTS and DT cannot be read"),
        ({"units": "UNITS OF FURLONG"}, "'FURLONG' is not a known unit"),
        ({"units": "UNITS OF CM"}, "'CM' is not a known unit"),
        ({"units": "nothing said"}, "does not say in which units"),
        ({"units": "units: g, units: gal"}, "different units"),
        ({"units": "VELOCITY TIME SERIES IN UNITS OF CM/S"}, "line 3: holds a velocity"),
    ],
)
def test_at2_faults(tmp_path: Path, change: dict[str, str], message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_motion(write(tmp_path, at2(**change)))


def test_at2_cut_inside_its_very_last_number(tmp_path: Path) -> None:
    text = at2().rstrip()
    for lost in (1, 2, 4, 6):
        with pytest.raises(InputError, match=r"cut off"):
            read_motion(write(tmp_path, text[:-lost]))


# ---------------------------------------------------------------- columns


@pytest.mark.parametrize(
    ("header", "separator", "factor"),
    [
        ("t_s,a_g\n", ",", STANDARD_GRAVITY),
        ("t_s,a_m_s2\n", ",", 1.0),
        ("time (s), acceleration (cm/s^2)\n", ",", 0.01),
        ("Time [sec]   Ground acceleration [m/s/s]\n", "   ", 1.0),
        ("# made by hand\n# t_s a_mm_s2\n", " ", 0.001),
        ('"t_s";"acc_ns_gal"\n', ";", 0.01),
        ("# units: g\n", "\t", STANDARD_GRAVITY),
        ("\ufeffTime_s,Accel_in_s2\n", ",", 0.0254),
    ],
)
def test_units_of_columns_come_from_the_header(
    tmp_path: Path, header: str, separator: str, factor: float
) -> None:
    motion = read_motion(write(tmp_path, columns(header, separator)))
    assert motion.dt == 0.01
    np.testing.assert_allclose(motion.acceleration, VALUES * factor, rtol=1e-9, atol=1e-12)


def test_units_of_columns_are_never_guessed(tmp_path: Path) -> None:
    path = write(tmp_path, columns("time,acceleration\n"))
    with pytest.raises(InputError, match=r"does not say in which units"):
        read_motion(path)
    motion = read_motion(path, units="cm/s2")
    np.testing.assert_allclose(motion.acceleration, VALUES * 0.01, rtol=1e-9)
    assert "the header states no unit of time: seconds taken" in motion.notes
    with pytest.raises(InputError, match=r"'stone' is not a known unit"):
        read_motion(path, units="stone")


def test_given_units_must_agree_with_the_file(tmp_path: Path) -> None:
    path = write(tmp_path, columns("t (s),a (g)\n"))
    assert read_motion(path, units="G").pga == read_motion(path).pga
    with pytest.raises(InputError, match=r"the file states 'g' but units = 'm/s2' was given"):
        read_motion(path, units="m/s2")


def test_time_may_be_in_milliseconds_and_start_late(tmp_path: Path) -> None:
    rows = "".join(f"{1000 + 5 * i},{value}\n" for i, value in enumerate(VALUES))
    motion = read_motion(write(tmp_path, "t_ms,a_g\n" + rows))
    assert motion.dt == 0.005
    assert any("starts at 1 s" in note for note in motion.notes)


def test_times_printed_to_few_digits_are_even(tmp_path: Path) -> None:
    rows = "".join(f"{i / 256:.3f},{value}\n" for i, value in enumerate(VALUES))
    motion = read_motion(write(tmp_path, "t_s,a_g\n" + rows))
    assert motion.dt == pytest.approx(1 / 256, rel=5e-3)


def test_one_column_needs_its_time_step(tmp_path: Path) -> None:
    path = write(tmp_path, "".join(f"{value:.6f}\n" for value in VALUES))
    with pytest.raises(InputError, match=r"give the time step"):
        read_motion(path, units="g")
    assert read_motion(path, units="g", dt=0.01).npts == 43


def test_several_columns_need_a_channel(tmp_path: Path) -> None:
    rows = "".join(f"{i * 0.01:.2f},{v},{2 * v}\n" for i, v in enumerate(VALUES))
    path = write(tmp_path, "t_s,ns_g,ew_m_s2\n" + rows)
    with pytest.raises(InputError, match=r"holds 2 channels .1: ns_g, 2: ew_m_s2."):
        read_motion(path)
    by_name = read_motion(path, channel="ew_m_s2")
    np.testing.assert_allclose(by_name.acceleration, 2 * VALUES)
    np.testing.assert_array_equal(read_motion(path, channel=2).acceleration, by_name.acceleration)
    with pytest.raises(InputError, match=r"no channel '3'; it holds 1: ns_g"):
        read_motion(path, channel=3)


@pytest.mark.parametrize("lost", [1, 2, 20, 41])
def test_a_gap_in_time_is_refused_with_its_line(tmp_path: Path, lost: int) -> None:
    lines = columns().splitlines(keepends=True)
    del lines[1 + lost]
    message = f"line {lost + 2}: the time step .* a gap"
    if lost == 41:
        message = "line 43: the time step"
    with pytest.raises(InputError, match=message):
        read_motion(write(tmp_path, "".join(lines)))


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ("0.0500,nan", "line 7: value 2: 'nan' is not a finite number"),
        ("0.0500,1e999", "line 7: value 2: '1e999'"),
        ("0.0500,1_0", "line 7: value 2: '1_0' is not a number"),
        ("0.0500,\u0661", "line 7: value 2: "),
        ("0.0500,", "line 7: value 2: a value is missing"),
        ("0.0500", "line 7: has 1 column, the rows above have 2"),
        ("0.0500,0.1,0.2", "line 7: has 3 columns"),
        ("0.0500,,0.1", "line 7: has 3 columns"),
        ("0.0500,***", r"line 7: value 2: '\*\*\*' stands for"),
        ("0.0500,__import__('os')", "line 7: value 2: .* is not a number"),
    ],
)
def test_bad_rows_are_named(tmp_path: Path, row: str, message: str) -> None:
    lines = columns().splitlines()
    lines[6] = row
    with pytest.raises(InputError, match=message):
        read_motion(write(tmp_path, "\n".join(lines)))


def test_time_that_drifts_is_refused(tmp_path: Path) -> None:
    times = np.cumsum(0.01 * (1.0 + 0.3 * np.arange(200) / 200))
    rows = "".join(f"{t:.6f},0.1\n" for t in times)
    with pytest.raises(InputError, match=r"uneven|change along"):
        read_motion(write(tmp_path, "t_s,a_g\n" + rows))


# ---------------------------------------------------------------- files with channels and headers


@pytest.mark.parametrize("text", [csmip(3), cosmos(3)])
def test_channels_are_chosen_by_number_and_listed(tmp_path: Path, text: str) -> None:
    path = write(tmp_path, text)
    for number in (1, 2, 3):
        motion = read_motion(path, channel=number)
        np.testing.assert_allclose(motion.acceleration, number * VALUES, atol=6e-6)
    with pytest.raises(InputError, match=r"holds 3 channels \(1: .*, 2: .*, 3: .*\)"):
        read_motion(path)
    with pytest.raises(InputError, match=r"no channel '4'"):
        read_motion(path, channel=4)


def test_channels_are_chosen_by_label(tmp_path: Path) -> None:
    path = write(tmp_path, csmip(3))
    assert read_motion(path, channel="180 deg").name == "record 2: 180 DEG"
    assert read_motion(write(tmp_path, csmip(1), "one.v2"), channel=1).npts == 43
    assert read_motion(write(tmp_path, at2(), "one.at2"), channel=1).npts == 43
    with pytest.raises(InputError, match=r"single channel"):
        read_motion(write(tmp_path, at2(), "one.at2"), channel=2)


def test_a_channel_that_occurs_twice_is_not_chosen(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"there 2 times"):
        read_motion(write(tmp_path, csmip(1) * 2), channel=1)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (csmip(1)[:500], "43 values are announced and the file ends after"),
        (csmip(1).replace("CM/SEC/SEC", "STONES"), "'STONES' is not a known unit"),
        (csmip(1).replace(".010 SEC", ".000 SEC"), "time step is 0 s"),
        (csmip(1).replace("43 POINTS", " 1 POINTS"), "announces 1 points"),
        (csmip(1).replace("POINTS OF ACCEL", "POINTS OF NOTHING"), "no line '... POINTS OF ACCEL"),
        ("UN" + csmip(1), r"uncorrected \(Volume 1\)"),
        (cosmos(unit="counts(50)"), "not in units of acceleration"),
        (cosmos(kind="velocity"), "holds velocity, not acceleration"),
        (cosmos(unit="stone(99)"), "'stone' is not a known unit"),
        (cosmos().replace("approx   0 secs", "approx   70 secs"), "contradicts itself"),
        (cosmos().replace("10.000000", "-9.000000"), "real header 62"),
        (cosmos().replace("   0.00000", "-999.00000"), "the record has a gap"),
        (cosmos()[:900], "cut off"),
        (smc(3), "SMC file of type 3"),
        (smc(count=44), "44 values are announced and the file ends after 43"),
        (smc(count=32), "more follows after the 32 values"),
        (smc(count=41), "41 values are announced and the data's last line holds 2 more"),
        (smc(count=-32768), "integer header 17"),
        (knet(seconds="1"), "make 100 values and the file has 43"),
        (knet(scale="3920(gal)/0"), "must be over zero"),
        (knet(scale="3920"), "cannot be read"),
        (knet(scale="3920(lbs)/6182761"), "'lbs' is not a known unit"),
        (knet().replace("Duration Time(s)", "Duration Time(m)"), "no line 'duration time"),
        (usc(), "unevenly sampled; use the corrected record"),
    ],
)
def test_faults_of_formats_with_headers(tmp_path: Path, text: str, message: str) -> None:
    path = write(tmp_path, text)
    with pytest.raises(InputError, match=message) as caught:
        read_motion(path)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_knet_mean_is_removed_and_noted(tmp_path: Path) -> None:
    motion = read_motion(write(tmp_path, knet()))
    assert abs(motion.acceleration.mean()) < 1e-12
    assert any(re.fullmatch("mean of [0-9]+ counts removed", note) for note in motion.notes)


def test_a_header_peak_that_differs_is_noted(tmp_path: Path) -> None:
    motion = read_motion(write(tmp_path, knet()))
    assert any("the header gives a peak of 1 gal" in note for note in motion.notes)


def test_usc_is_resampled_when_told_so(tmp_path: Path) -> None:
    motion = read_motion(write(tmp_path, usc()), dt=0.001)
    assert motion.dt == 0.001
    assert motion.pga == pytest.approx(STANDARD_GRAVITY * np.max(np.abs(VALUES)), rel=1e-2)
    assert any("resampled from 43 uneven samples" in note for note in motion.notes)


# ---------------------------------------------------------------- any file


def test_pga_over_3_g_is_refused_unless_told(tmp_path: Path) -> None:
    path = write(tmp_path, at2(20.0 * VALUES))
    with pytest.raises(InputError, match=r"PGA is 3.\d+ g, over 3 g; .*allow_high_pga"):
        read_motion(path)
    assert read_motion(path, allow_high_pga=True).pga > 3.0 * STANDARD_GRAVITY
    with pytest.raises(InputError, match=r"over 100 g"):
        read_motion(write(tmp_path, at2(1e4 * VALUES)), allow_high_pga=True)


def test_given_time_step_must_agree_with_the_file(tmp_path: Path) -> None:
    path = write(tmp_path, at2())
    assert read_motion(path, dt=0.01).dt == 0.01
    with pytest.raises(InputError, match=r"the file states a time step of 0.01 s but"):
        read_motion(path, dt=0.02)
    for bad in (0.0, -1.0, float("nan"), 10.0):
        with pytest.raises(InputError, match=r"dt = .* was given"):
            read_motion(path, dt=bad)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "the file is empty"),
        (b" \r\n\n", "the file is empty"),
        (b"\x00\x01\x02abc", "binary data"),
        (bytes(range(256)), "binary data"),
        ("t_s,a_g\n0,1\n".encode("utf-16"), "UTF-16"),
        (b"hello\nworld\n", "none of the known formats"),
        (b"t_s,a_g\n0.0,0.1\n", "a single row"),
        (b"t_s,a_g\n0.1,0.1\n0.1,0.1\n", "must increase"),
        (b"t_s,a_g\n0.0,0.1\n1.0,0.1\n", "1 s is implausible"),
        (b"t_min,a_g\n0.0,0.1\n0.01,0.1\n", "0.6 s is implausible"),
        (b"x" * 5000, "5000 characters"),
    ],
)
def test_files_that_are_no_records(tmp_path: Path, content: bytes, message: str) -> None:
    path = tmp_path / "garbage.dat"
    path.write_bytes(content)
    with pytest.raises(InputError, match=message):
        read_motion(path)


def test_missing_files_and_folders(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nowhere.AT2: there is no such file"):
        read_motion(tmp_path / "nowhere.AT2")
    with pytest.raises(InputError, match=r"is a folder"):
        read_motion(tmp_path)
    with pytest.raises(InputError):
        read_motion("a\0b")


@pytest.mark.parametrize("kind", ["at2", "csv", "csmip"])
def test_80_000_values_are_read_whole(tmp_path: Path, kind: str) -> None:
    values = np.random.default_rng(1).normal(size=80_000) * 0.1
    if kind == "at2":
        text = at2(values)
    elif kind == "csv":
        text = "t_s,a_g\n" + "".join(f"{0.01 * i:.2f},{v:.6f}\n" for i, v in enumerate(values))
    else:
        text = " 80000 POINTS OF ACCEL DATA EQUALLY SPACED AT  .010 SEC.  (UNITS: GAL)\n"
        text += fields(100.0 * values, "{:10.3f}", 8)
    path = write(tmp_path, text)
    motion = read_motion(path)
    assert motion.npts == 80_000
    unit = 1.0 if kind == "csmip" else 9.80665  # written in 100 gal, or in g
    np.testing.assert_allclose(motion.acceleration, unit * values, rtol=1e-5, atol=1e-5)


# ---------------------------------------------------------------- the reference records

FORMATS: list[tuple[str, Any, float, int, str]] = [
    ("at2_lowercase_long_header.at2", None, 0.005, 4000, "0.156719"),
    ("at2_old_npts_dt_crlf.AT2", None, 0.005, 3998, "0.142476"),
    ("two_column_t_g.csv", None, 0.02, 2000, "0.261283"),
    ("smc_corrected_0111a.smc", None, 0.005, 6001, "0.106469"),
    ("csmip_ce36456p.V2", 1, 0.02, 3251, "0.273240"),
    ("csmip_ce36456p.V2", 2, 0.02, 3250, "0.096674"),
    ("csmip_ce36456p.V2", 3, 0.02, 3250, "0.261283"),
    ("cosmos_v1_20_test.v1", None, 0.01, 7000, "0.165155"),
    ("knet_layout_sample.NS", None, 0.01, 3000, "0.507327"),
]


@pytest.mark.parametrize(("name", "channel", "dt", "npts", "pga"), FORMATS)
def test_reference_formats(
    shared: Path, name: str, channel: int | None, dt: float, npts: int, pga: str
) -> None:
    motion = read_motion(shared / "records" / "formats" / name, channel=channel)
    assert (motion.dt, motion.npts) == (dt, npts)
    assert f"{motion.pga / STANDARD_GRAVITY:.6f}" == pga
    assert not any("peak" in note for note in motion.notes)


def test_reference_uneven_record(shared: Path) -> None:
    path = shared / "records" / "formats" / "usc_vol1_017m30lw.s0a"
    with pytest.raises(InputError, match=r"unevenly sampled"):
        read_motion(path)
    motion = read_motion(path, dt=0.001)
    assert motion.pga / STANDARD_GRAVITY == pytest.approx(0.2647, abs=2e-6)


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("truncated.AT2", "NPTS is 600 and the file has only 300 values, the last of them cut"),
        ("npts_too_large.AT2", "NPTS is 1000 and the file has only 600 values"),
        ("nan.AT2", "line 45: value 3: 'NaN' is not a finite number"),
        ("dt_zero.AT2", "line 4: DT is .0000 s"),
        ("empty.AT2", "the file is empty"),
        ("asterisks.AT2", r"line 65: value 2: '\*+' stands for a number"),
    ],
)
def test_reference_bad_files(shared: Path, name: str, message: str) -> None:
    with pytest.raises(InputError, match=message) as caught:
        read_motion(shared / "records" / "formats" / "bad" / name)
    assert name in str(caught.value)


@pytest.mark.parametrize("suite", ["paper_suite", "california"])
def test_reference_suites(shared: Path, suite: str) -> None:
    folder = shared / "records" / suite
    with (folder / "manifest.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        motion = read_motion(folder / row["file"])
        assert (motion.dt, motion.npts) == (float(row["dt_s"]), int(row["npts"])), row["file"]
        assert motion.pga / STANDARD_GRAVITY == pytest.approx(float(row["pga_g"]), rel=1e-6)
        assert motion.pgv == pytest.approx(float(row["pgv_m_s"]), abs=0.5001e-4)
