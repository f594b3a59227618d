"""The folder of a run: whole or not at all, and nothing of the user's is touched."""

import json
import os
import signal

import pytest

import railquake as rq
from railquake import files, plots
from railquake.files import prepare_folder
from railquake.report.run_folder import json_text, write_run

MOTION = {"seed": 3, "duration": "2 s", "pga": "0.6 g", "highpass_frequency": "0.6 Hz"}
NUMBERS = {"summary.json", "history.nc", "events.csv", "case.toml"}


@pytest.fixture(scope="module")
def response():
    return rq.simulate(rq.scenario(synthetic=MOTION))


def names(folder):
    return {path.name for path in folder.iterdir()}


def test_numbers_without_pictures(response, tmp_path):
    row = write_run(response, tmp_path / "new" / "out", pictures=False)
    assert names(tmp_path / "new" / "out") == NUMBERS
    assert json.loads((tmp_path / "new" / "out" / "summary.json").read_text()) == row
    assert names(tmp_path / "new") == {"out"}


def test_new_folder_may_be_read_by_others(response, tmp_path):
    """Its permissions are those of any new folder, not those of a temporary one."""
    (tmp_path / "usual").mkdir()
    write_run(response, tmp_path / "out", pictures=False)
    assert (tmp_path / "out").stat().st_mode == (tmp_path / "usual").stat().st_mode


@pytest.mark.parametrize("fault", [KeyboardInterrupt, OSError("disk full"), ValueError])
@pytest.mark.parametrize("out", ["new", "deep/er/new"])
def test_fault_leaves_nothing_behind(response, tmp_path, monkeypatch, fault, out):
    def fail(*_):
        raise fault

    monkeypatch.setattr(plots, "write_pictures", fail)
    with pytest.raises((KeyboardInterrupt, rq.InputError, ValueError)):
        write_run(response, tmp_path / out)
    assert names(tmp_path) == set()


def test_fault_leaves_the_former_run_as_it_was(response, tmp_path, monkeypatch):
    write_run(response, tmp_path, pictures=False)
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}

    def fail(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(plots, "write_pictures", fail)
    with pytest.raises(KeyboardInterrupt):
        write_run(response, tmp_path)
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


def test_files_of_a_former_run_are_replaced_and_others_kept(response, tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "section.png").write_text("of a former run")
    (tmp_path / "summary.json").write_text("of a former run")
    write_run(response, tmp_path, pictures=False)
    assert names(tmp_path) == NUMBERS | {"notes.txt"}
    assert "status" in json.loads((tmp_path / "summary.json").read_text())


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interruption_waits_while_files_are_moved(response, tmp_path, monkeypatch, number):
    def stop(*_):
        raise KeyboardInterrupt

    move = files._move_all

    def interrupted(*arguments):
        os.kill(os.getpid(), number)
        move(*arguments)

    monkeypatch.setattr(files, "_move_all", interrupted)
    former = signal.signal(number, stop)
    try:
        with pytest.raises(KeyboardInterrupt):
            write_run(response, tmp_path / "out", pictures=False)
        assert signal.getsignal(number) is stop
    finally:
        signal.signal(number, former)
    assert names(tmp_path / "out") == NUMBERS
    assert names(tmp_path) == {"out"}


def test_folder_is_tried_without_a_trace(tmp_path):
    prepare_folder(tmp_path / "not" / "there" / "yet")
    prepare_folder(tmp_path)
    assert names(tmp_path) == set()


def test_folder_that_cannot_be_is_refused(tmp_path):
    (tmp_path / "file").write_text("")
    (tmp_path / "dangling").symlink_to(tmp_path / "nowhere")
    for wrong in ("file", "file/below", "dangling"):
        with pytest.raises(rq.InputError, match=wrong):
            prepare_folder(tmp_path / wrong)


def test_json_has_null_for_what_is_not_finite():
    value = {"a": float("nan"), "b": [1.0, float("inf")], "c": {"d": (2, None, True)}}
    assert json.loads(json_text(value)) == {
        "a": None,
        "b": [1.0, None],
        "c": {"d": [2, None, True]},
    }
