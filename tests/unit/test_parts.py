"""Parts that a killed process left are removed by the next; those of a living one are not."""

import os
import signal
import subprocess
import sys
import time

import pytest

from railquake import parts
from railquake.files import whole_file, whole_folder
from railquake.parts import sweep

WRITER = """
import sys, time
from pathlib import Path
from railquake.files import whole_file, whole_folder

out = Path(sys.argv[1])
with whole_file(out / "page.html") as page, whole_folder(out / "figures") as figures:
    page.write_text("half")
    (figures / "a.png").write_text("half")
    print("ready", flush=True)
    time.sleep(60.0)
"""

posix = pytest.mark.skipif(sys.platform == "win32", reason="has no such locks")


def names(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.fixture
def writer(tmp_path):
    with subprocess.Popen(
        [sys.executable, "-c", WRITER, str(tmp_path)], stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(2 * parts.SETTLING_S)
        yield process
        process.kill()


def write(out):
    with whole_file(out / "page.html") as page, whole_folder(out / "figures") as figures:
        page.write_text("whole")
        (figures / "a.png").write_text("whole")


@posix
def test_what_a_killed_writer_left_is_removed_by_the_next(tmp_path, writer):
    writer.send_signal(signal.SIGKILL)
    writer.wait()
    assert len(names(tmp_path)) == 2
    write(tmp_path)
    assert names(tmp_path) == ["figures", "page.html"]
    assert names(tmp_path / "figures") == ["a.png"]


@posix
def test_what_is_being_written_stays(tmp_path, writer):
    before = names(tmp_path)
    write(tmp_path)
    sweep(tmp_path)
    assert len(before) == 2
    assert names(tmp_path) == sorted([*before, "figures", "page.html"])


@posix
def test_only_parts_are_removed(tmp_path):
    mine = [".notes.part", "a.part", ".report.html.0123456789abcdef.parts", ".part"]
    for name in mine:
        (tmp_path / name).write_text("")
        os.utime(tmp_path / name, (0, 0))
    sweep(tmp_path)
    assert names(tmp_path) == sorted(mine)


def test_a_part_of_another_machine_stays_for_a_day(tmp_path, monkeypatch):
    path = tmp_path / f".a.{'0' * 24}.part"
    path.write_text("")
    sweep(tmp_path)
    assert names(tmp_path) == [path.name]
    old = time.time() - 2 * parts.FOREIGN_S
    os.utime(path, (old, old))
    sweep(tmp_path)
    assert names(tmp_path) == []


@posix
def test_a_link_is_not_followed(tmp_path):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "a").write_text("")
    link = tmp_path / parts._random_name("x")
    link.symlink_to(tmp_path / "mine")
    os.utime(link, (0, 0), follow_symlinks=False)
    sweep(tmp_path)
    assert names(tmp_path / "mine") == ["a"]


@posix
def test_a_study_that_goes_on_removes_what_a_killed_one_was_writing(tmp_path):
    import railquake as rq
    from railquake.study.folder import ResultsFolder, made_by_this, no_note
    from study_files import small

    study, folder = rq.Study.from_dict(small()).with_suite(None), ResultsFolder(tmp_path / "out")
    folder.prepare(study, no_note, made_by_this())
    before = names(folder.path)
    for left in (folder.path, folder.parts):
        part = left / parts._random_name("0123.parquet")
        part.write_text("half")
        os.utime(part, (0, 0))
    folder.prepare(study, no_note, made_by_this())
    assert names(folder.path) == before
    assert names(folder.parts) == []
