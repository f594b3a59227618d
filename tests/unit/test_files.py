"""Files and folders: whole or not at all, and nothing left behind."""

import os
import stat
import threading
from pathlib import Path

import pytest

from railquake.files import read_file, whole_file, whole_folder


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("durable", [False, True])
def test_a_file_gets_its_name_when_it_is_whole(tmp_path, durable):
    path = tmp_path / "a.txt"
    path.write_text("former")
    with whole_file(path, durable=durable) as part:
        assert part.parent == tmp_path and part.name.startswith(".a.txt.")
        assert part.read_bytes() == b""
        part.write_text("new")
        assert path.read_text() == "former"
    assert path.read_text() == "new"
    assert names(tmp_path) == ["a.txt"]


@pytest.mark.parametrize("error", [KeyboardInterrupt, OSError, SystemExit])
def test_an_interruption_leaves_the_former_file_and_nothing_else(tmp_path, error):
    path = tmp_path / "a.txt"
    path.write_text("former")

    def interrupted():
        with whole_file(path) as part:
            part.write_text("half")
            raise error

    with pytest.raises(error):
        interrupted()
    assert path.read_text() == "former"
    assert names(tmp_path) == ["a.txt"]


def test_a_file_has_the_rights_that_any_other_has(tmp_path):
    with whole_file(tmp_path / "a") as part:
        part.write_text("new")
    (tmp_path / "b").write_text("plain")
    assert stat.S_IMODE((tmp_path / "a").stat().st_mode) == stat.S_IMODE(
        (tmp_path / "b").stat().st_mode
    )


def test_two_writers_at_once_do_not_disturb_each_other(tmp_path):
    path, both = tmp_path / "a", threading.Barrier(2)

    def write(text):
        with whole_file(path) as part:
            both.wait()
            part.write_text(text)
            both.wait()

    threads = [threading.Thread(target=write, args=(text,)) for text in ("one" * 99, "two" * 99)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert path.read_text() in ("one" * 99, "two" * 99)
    assert names(tmp_path) == ["a"]


def test_of_several_writers_the_first_may_win(tmp_path):
    path = tmp_path / "choice"
    for text in ("first", "second"):
        with whole_file(path, replace=False) as part:
            part.write_text(text)
    assert path.read_text() == "first"
    assert names(tmp_path) == ["choice"]


def test_a_folder_that_is_not_there_cannot_hold_a_file(tmp_path):
    with pytest.raises(FileNotFoundError), whole_file(tmp_path / "none" / "a"):
        raise AssertionError("nothing to write to")
    assert names(tmp_path) == []


def test_a_folder_gets_its_files_together(tmp_path):
    folder = tmp_path / "above" / "out"
    with whole_folder(folder) as part:
        (part / "a").write_text("1")
        assert not folder.exists()
    assert names(folder) == ["a"]
    assert names(folder.parent) == ["out"]


def test_a_folder_in_use_keeps_what_is_not_ours(tmp_path):
    for name in ("mine", "a", "former"):
        (tmp_path / name).write_text("former")
    with whole_folder(tmp_path, ours=("a", "former", "never"), last="a") as part:
        (part / "a").write_text("new")
        (part / "b").write_text("new")
    found = {path.name: path.read_text() for path in tmp_path.iterdir()}
    assert found == {"mine": "former", "a": "new", "b": "new"}


def test_the_file_that_says_that_all_are_there_comes_last(tmp_path, monkeypatch):
    moved, move = [], os.replace
    monkeypatch.setattr(os, "replace", lambda a, b: moved.append(b.name) or move(a, b))
    with whole_folder(tmp_path, last="all") as part:
        for name in ("all", "z", "b"):
            (part / name).write_text("")
    assert moved == ["b", "z", "all"]


def test_an_interruption_leaves_no_folder(tmp_path):
    def interrupted():
        with whole_folder(tmp_path / "above" / "out") as part:
            (part / "a").write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert names(tmp_path) == []


def test_the_working_folder_may_be_written_to(tmp_path, monkeypatch):
    from pathlib import Path

    monkeypatch.chdir(tmp_path)
    with whole_folder(Path()) as part:
        (part / "a").write_text("1")
    with whole_file(Path("b")) as part:
        part.write_text("2")
    assert names(tmp_path) == ["a", "b"]


@pytest.mark.skipif(not Path("/dev/null").exists(), reason="no such device")
@pytest.mark.parametrize("kind", ["fifo", "folder", "device"])
def test_what_is_no_file_is_not_replaced_by_one(tmp_path, kind):
    """A picture written to /dev/null by an administrator must leave the device a device."""
    path = tmp_path / "a"
    if kind == "fifo":
        os.mkfifo(path)
    elif kind == "folder":
        path.mkdir()
    else:
        path.symlink_to("/dev/null")
    with pytest.raises(OSError, match="is a device, a pipe or a folder"), whole_file(path):
        raise AssertionError("nothing to write to")
    assert names(tmp_path) == ["a"]
    assert not path.is_file()


# --- reading what somebody named -----------------------------------------------------------


def pipe(folder):
    os.mkfifo(folder / "pipe")  # nobody writes to it: opening it would wait for ever
    return folder / "pipe"


@pytest.mark.parametrize(
    ("named", "said"),
    [
        (lambda folder: folder, "it is a folder"),
        (lambda folder: folder / "none", "No such file"),
        (lambda folder: "/dev/zero", "no regular file"),
        (pipe, "no regular file"),
        (lambda folder: "a\0b", "no file can have this name"),
    ],
    ids=["folder", "missing", "device", "pipe", "null"],
)
def test_what_is_no_regular_file_is_refused_before_a_byte_is_read(tmp_path, named, said):
    with pytest.raises(OSError, match=said):
        read_file(named(tmp_path))


def test_a_regular_file_is_read_whole_up_to_its_bound(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"12345")
    assert read_file(path, 5) == b"12345"
    with pytest.raises(OSError, match="too large"):
        read_file(path, 4)
