"""`railquake select`: what it writes and prints, and what it refuses in one line."""

import json
from pathlib import Path

import pytest

from railquake.cli import main
from railquake.suite import load_suite
from record_folders import write_records


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = write_records(tmp_path_factory.mktemp("records"), 8)
    (folder / "readme.txt").write_text("nothing\n")
    text = (folder / "r01.AT2").read_text()
    (folder / "cut.AT2").write_text(text[: len(text) // 3])
    return folder


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    assert main(["select", *(str(a) for a in arguments)]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1, lines
    return lines[0]


def test_it_writes_a_manifest_and_a_picture_and_tells_the_misfit(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "deep" / "out"
    assert main(["select", "--records", str(folder), "--count", "4", "--out", str(out)]) == 0
    printed = capsys.readouterr().out
    assert "4 of 8 chosen" in printed
    assert "2: 1 x damaged or incomplete, 1 x no record" in printed and "cut.AT2" in printed
    for words in ("misfit as recorded", "misfit, greedy start", "exchanges", "largest deviation"):
        assert words in printed
    assert (out / "suite.png").read_bytes().startswith(b"\x89PNG")
    suite = load_suite(out / "manifest.csv", folder)
    assert len(suite.members) == 4
    assert sorted(path.name for path in out.iterdir()) == ["manifest.csv", "suite.png"]


def test_as_json_for_programs(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["--count", "3", "--poe", "0.1", "--period-range", "0.1,1", "--scatter", "0.3"]
    out = tmp_path / "out"
    command = ["select", "--records", str(folder), "--out", str(out), "--json", *arguments]
    assert main(command) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["considered"] == 8 and len(facts["members"]) == 3
    assert facts["misfit"] <= facts["misfit_before"]
    assert facts["skipped"] == {"damaged or incomplete": 1, "no record": 1}


def test_wrong_input_is_refused_in_one_line(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    out = ("--out", tmp_path / "out")
    told = refused(capsys, "--records", folder, "--hazard", "unknown", *out)
    assert "known are berkeley, berkeley-rock" in told
    told = refused(capsys, "--records", folder, "--poe", 0.3, *out)
    assert "known are 0.5, 0.1, 0.05, 0.02" in told
    assert "holds no usable record" in refused(capsys, "--records", empty, *out)
    assert "there is no such folder" in refused(capsys, "--records", tmp_path / "no", *out)
    assert "20 are wanted" in refused(capsys, "--records", folder, *out)
    told = refused(capsys, "--records", folder, "--period-range", "1", *out)
    assert "--period-range" in told
    assert "--records" in refused(capsys, *out)
    assert not (tmp_path / "out").exists()


def test_a_place_that_cannot_be_written_is_refused_first(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("")
    told = refused(capsys, "--records", folder, "--count", 3, "--out", tmp_path / "file")
    assert "is no folder" in told
