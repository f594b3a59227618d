"""Manifests of suites: what they may say, and what is refused with file, line and column."""

import os
from pathlib import Path

import pytest

from railquake.errors import InputError
from railquake.inputs.scenario import scenario
from railquake.suite import load_suite
from railquake.suite.hazard import read_hazard

HEADER = "file,scale_factor\n"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for name in ("a.AT2", "b.AT2", "RSN0181_X.AT2", "deep/a.AT2"):
        path = tmp_path / "records" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("not read when the suite is loaded")
    return tmp_path / "records"


def manifest(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "suite.csv"
    path.write_text(text)
    return path


def refused(path: Path | str, records: Path | None) -> str:
    with pytest.raises(InputError) as caught:
        load_suite(path, records)
    message = str(caught.value)
    assert "\n" not in message
    return message


def test_rows_become_motion_tables_with_absolute_paths(tmp_path: Path, folder: Path) -> None:
    path = manifest(tmp_path, HEADER + "a.AT2,1.5\nb.AT2,2\n")
    suite = load_suite(path, folder)
    assert suite.name == "suite"
    assert [member.name for member in suite.members] == ["a", "b"]
    assert suite.members[0].motion == {"record": str(folder / "a.AT2")}
    assert [member.scale_factor for member in suite.members] == [1.5, 2.0]


def test_files_start_from_the_manifest_where_no_folder_is_given(folder: Path) -> None:
    path = manifest(folder, HEADER + "a.AT2,1\n")
    assert load_suite(path, None).members[0].motion["record"] == str(folder / "a.AT2")


def test_columns_in_any_order_with_remarks_and_blank_lines(tmp_path: Path, folder: Path) -> None:
    text = (
        '# a remark, "quoted\n\nstation,scale_factor,file\n"X, Y",2.5,a.AT2\n# another\n,1,b.AT2\n'
    )
    suite = load_suite(manifest(tmp_path, text), folder)
    assert [member.scale_factor for member in suite.members] == [2.5, 1.0]


def test_channel_units_and_time_step_go_into_the_motion(tmp_path: Path, folder: Path) -> None:
    text = "file,channel,units,dt,scale_factor\na.AT2,2,g,0.01,1\na.AT2,UP,,,1\n"
    first, second = load_suite(manifest(tmp_path, text), folder).members
    assert dict(first.motion) | {"record": ""} == {
        "record": "", "channel": 2, "units": "g", "dt": 0.01,
    }  # fmt: skip
    assert second.motion["channel"] == "UP"
    assert first.name != second.name


def test_motion_tables_are_what_a_case_takes(tmp_path: Path, folder: Path) -> None:
    text = "file,channel,units,dt,scale_factor\na.AT2,2,g,0.01,3\n"
    (member,) = load_suite(manifest(tmp_path, text), folder).members
    case = scenario(motion=member.motion, scale=member.scale_factor)
    assert case.motion is not None and case.motion.channel == 2 and case.motion.scale == 3.0


def test_members_have_names_of_their_own(tmp_path: Path, folder: Path) -> None:
    suite = load_suite(manifest(tmp_path, HEADER + "a.AT2,1\ndeep/a.AT2,1\nb.AT2,1\n"), folder)
    assert [member.name for member in suite.members] == ["a.AT2", "deep/a.AT2", "b"]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "suite.csv: is empty"),
        ("# only a remark\n", "suite.csv: is empty"),
        (HEADER, "suite.csv: has a header but no rows"),
        ("file,factor\na.AT2,1\n", "suite.csv, line 1: column scale_factor is missing"),
        ("name,scale_factor\na.AT2,1\n", "suite.csv, line 1: column file is missing"),
        ("file,file,scale_factor\na.AT2,b.AT2,1\n", "line 1: column 'file' is there twice"),
        (HEADER + "a.AT2\n", "suite.csv, line 2: 1 cells under 2 columns"),
        (HEADER + "\n# x\na.AT2,two\n", "suite.csv, line 4: scale_factor: must be a number"),
        (HEADER + "a.AT2,0\n", "line 2: scale_factor: must be finite and over zero, found 0"),
        (HEADER + "a.AT2,-1.2\n", "line 2: scale_factor: must be finite and over zero"),
        (HEADER + "a.AT2,nan\n", "line 2: scale_factor: must be finite and over zero"),
        (HEADER + "a.AT2,inf\n", "line 2: scale_factor: must be finite and over zero"),
        (HEADER + "a.AT2,\n", "line 2: scale_factor: must be a number, found ''"),
        (HEADER + ",1\n", "line 2: file: a record's file is needed"),
        (HEADER + "a\x00.AT2,1\n", "line 2: file: a record's file is needed"),
        (HEADER + "a.AT2,1\nb.AT2,1\n./a.AT2,2\n", "file: ./a.AT2 is there already (line 2)"),
        ("file,rsn,scale_factor\nRSN0181_X.AT2,182,1\n", "line 2: rsn: is 182, but the file"),
        ("file,rsn,scale_factor\na.AT2,one,1\n", "line 2: rsn: must be a whole number"),
        ("file,dt,scale_factor\na.AT2,x,1\n", "line 2: dt: must be a number"),
        (HEADER + '"a.AT2,1\n', "is no CSV"),
    ],
)  # fmt: skip
def test_a_wrong_manifest_is_refused_in_one_line(
    tmp_path: Path, folder: Path, text: str, told: str
) -> None:
    assert told in refused(manifest(tmp_path, text), folder)


def test_a_matching_record_sequence_number_is_taken(tmp_path: Path, folder: Path) -> None:
    text = "file,rsn,scale_factor\nRSN0181_X.AT2,181,1\n"
    assert load_suite(manifest(tmp_path, text), folder).members[0].name == "RSN0181_X"


def test_the_first_missing_record_is_named_and_all_are_counted(
    tmp_path: Path, folder: Path
) -> None:
    text = HEADER + "a.AT2,1\nnot.AT2,1\nb.AT2,1\nneither.AT2,1\n"
    told = refused(manifest(tmp_path, text), folder)
    assert "line 3: file: not.AT2 is not in" in told and "(2 of 4 are missing)" in told
    assert "--records" in told


def test_a_folder_that_is_none_is_refused(tmp_path: Path, folder: Path) -> None:
    path = manifest(tmp_path, HEADER + "a.AT2,1\n")
    assert "there is no such folder" in refused(path, tmp_path / "elsewhere")
    assert "is no folder" in refused(path, folder / "a.AT2")


def test_a_manifest_that_is_none_is_refused(tmp_path: Path) -> None:
    assert "there is no such manifest" in refused(tmp_path / "not.csv", None)
    assert "cannot be read" in refused(tmp_path, None)
    (tmp_path / "binary.csv").write_bytes(b"\xff\xfe\x00\x80")
    assert "is not text" in refused(tmp_path / "binary.csv", None)


def test_an_unknown_suite_is_refused_with_those_there_are() -> None:
    assert "did you mean paper-suite?" in refused("paper-suit", None)
    assert "known are paper-suite, synthetic-berkeley" in refused("qqq", None)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no such file")
def test_a_pipe_in_the_place_of_a_file_is_refused_without_waiting(tmp_path: Path):
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    with pytest.raises(InputError, match=r"pipe\.csv: .*no regular file"):
        load_suite(pipe)
    with pytest.raises(InputError, match=r"pipe\.csv: .*no regular file"):
        read_hazard(pipe)
