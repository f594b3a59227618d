"""The commands study, merge and rerun: what they print and write, and what they refuse."""

import json
import socket
import time

import pandas as pd
import pytest

from railquake.cli import main
from railquake.inputs.toml import dumps
from railquake.study import cluster
from study_files import BASE, small, tables, untimed


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "study.toml"
    path.write_text(dumps(small()))
    return path


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    folder = tmp_path_factory.mktemp("commands")
    (folder / "study.toml").write_text(dumps(small()))
    assert main(["study", str(folder / "study.toml"), "--out", str(folder / "out")]) == 0
    return folder / "out"


def refused(capsys, *arguments):
    """The single line with which a command is refused."""
    assert main([str(a) for a in arguments]) == 2
    error = capsys.readouterr().err
    assert error.count("\n") == 1 and "Traceback" not in error
    return error


def test_study_writes_the_table_and_says_how_the_runs_ended(file, tmp_path, capsys):
    assert main(["study", str(file), "--out", str(tmp_path / "out"), "--jobs", "1"]) == 0
    printed = capsys.readouterr()
    assert printed.out.startswith("12 runs: ")
    assert printed.err == ""  # the progress bar is for terminals
    assert len(pd.read_parquet(tmp_path / "out" / "runs.parquet")) == 12


def test_failed_runs_are_counted_and_told_apart(tmp_path, capsys):
    (tmp_path / "study.toml").write_text(dumps(tables(**{"solver.dt": ["5e-5 s", "4.9e-4 s"]})))
    assert main(["study", str(tmp_path / "study.toml"), "--out", str(tmp_path / "out")]) == 0
    printed = capsys.readouterr().out
    assert "1 failed" in printed and "1 safe" in printed
    assert "failed: solver.dt: 0.00049 s is above" in printed and "(rows 1)" in printed


def test_shards_merge_into_the_table_of_the_whole(file, finished, tmp_path, capsys):
    folders = [str(tmp_path / "1"), str(tmp_path / "2")]
    for number, out in enumerate(folders, 1):
        assert main(["study", str(file), "--out", out, "--shard", f"{number}/2"]) == 0
    assert main(["merge", *folders, "--out", str(tmp_path / "all")]) == 0
    assert "12 of 12 runs" in capsys.readouterr().out
    merged, whole = (pd.read_parquet(f / "runs.parquet") for f in (tmp_path / "all", finished))
    assert untimed(merged).equals(untimed(whole))


def test_rerun_runs_a_row_as_a_case(finished, tmp_path, capsys):
    assert main(["rerun", str(finished), "3", "--out", str(tmp_path / "row"), "--json"]) == 0
    row = json.loads(capsys.readouterr().out)
    table = pd.read_parquet(finished / "runs.parquet")
    assert row["pbv_m_s"] == pytest.approx(table["pbv_m_s"][3], rel=3e-3)
    assert (tmp_path / "row" / "case.toml").exists()


def test_rerun_refuses_a_row_that_is_not_there(finished, tmp_path, capsys):
    message = refused(capsys, "rerun", finished, 99, "--out", tmp_path)
    assert "there is no row 99; rows are 0 to 11" in message


WRONG = [
    ({"axes": {"vehicle.sped": [1.0]}}, 'did you mean "speed"'),
    ({"axes": {"vehicle.speed": []}}, "list is empty"),
    (
        {"axes": {"wheelrail.friction": {"distribution": "gauss"}}, "sampling": {"count": 2}},
        "unknown distribution",
    ),
    ({"suite": {"manifest": "none.csv"}}, "no such manifest"),
    ({"base": {**BASE, "motion": {"record": "none.AT2"}}}, "none.AT2"),
]


@pytest.mark.parametrize(("change", "message"), WRONG)
def test_bad_input_is_one_line_before_anything_is_written(tmp_path, capsys, change, message):
    (tmp_path / "study.toml").write_text(dumps({"base": BASE, **change}))
    out = tmp_path / "out"
    assert message in refused(capsys, "study", tmp_path / "study.toml", "--out", out)
    assert not out.exists()


def test_a_duplicate_axis_is_refused_with_its_line(tmp_path, capsys):
    text = dumps({"base": BASE}) + '[axes]\n"vehicle.speed" = [1.0]\n"vehicle.speed" = [2.0]\n'
    (tmp_path / "study.toml").write_text(text)
    message = refused(capsys, "study", tmp_path / "study.toml", "--out", tmp_path / "out")
    assert "study.toml, line" in message


def test_a_changed_study_is_refused_with_what_differs(finished, tmp_path, capsys):
    data = small()
    data["suite"]["levels"]["low"] = 0.7
    (tmp_path / "study.toml").write_text(dumps(data))
    message = refused(capsys, "study", tmp_path / "study.toml", "--out", finished)
    assert "suite.levels.low was 0.5, now is 0.7" in message


@pytest.mark.parametrize(
    ("address", "message"),
    [
        ("nowhere", "must be an address such as tcp://host:8786"),
        ("tcp://127.0.0.1", "must be an address such as tcp://host:8786"),
        ("tcp://127.0.0.1:port", "must be an address such as tcp://host:8786"),
    ],
)
def test_what_is_no_address_of_a_scheduler_is_refused(file, tmp_path, capsys, address, message):
    out = tmp_path / "out"
    assert message in refused(capsys, "study", file, "--out", out, "--scheduler", address)


def test_a_scheduler_that_is_not_there_is_refused_at_once(file, tmp_path, capsys):
    pytest.importorskip("distributed")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{free.getsockname()[1]}"
    out = tmp_path / "out"
    begin = time.monotonic()
    message = refused(capsys, "study", file, "--out", out, "--scheduler", address)
    assert f"no scheduler answers at {address}" in message
    assert time.monotonic() - begin < 30.0
    assert not out.exists()


def test_something_else_that_answers_is_refused(file, tmp_path, capsys, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setattr(cluster, "PATIENCE_S", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as other:
        address = f"tcp://127.0.0.1:{other.getsockname()[1]}"
        out = tmp_path / "out"
        message = refused(capsys, "study", file, "--out", out, "--scheduler", address)
    assert "is no Dask scheduler" in message


def test_merging_a_foreign_folder_is_refused(tmp_path, capsys):
    (tmp_path / "photos").mkdir()
    message = refused(capsys, "merge", tmp_path / "photos", "--out", tmp_path / "all")
    assert "is empty; give the folder that railquake study wrote" in message
