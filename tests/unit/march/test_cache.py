"""What is kept between processes: where, by whom, and only while it is whole."""

import logging
import os
import stat
import sys
from pathlib import Path

import numpy as np
import pytest

from railquake.assembly import geometry
from railquake.errors import InputError
from railquake.march.compiler import SCALAR, bind
from railquake.march.compiler import cache as caching

pwd = pytest.importorskip("pwd")  # another system keeps others out by itself
binding = sys.modules["railquake.march.compiler.bind"]


def entry(x):
    return 2.0 * x


@pytest.fixture
def top(monkeypatch, tmp_path):
    """The cache's folder; nothing was said yet."""
    folder = tmp_path / "above" / "cache"
    monkeypatch.setenv("RAILQUAKE_CACHE_DIR", str(folder))
    caching._say.cache_clear()
    return folder


@pytest.fixture
def said(caplog):
    caplog.set_level(logging.WARNING, logger="railquake")
    return lambda: [record.getMessage() for record in caplog.records]


def compiled():
    """A small kernel of a process that has just begun."""
    binding._bind_cached.cache_clear()
    kernel = bind(entry, SCALAR)
    assert kernel.call(3.0) == 6.0
    return kernel


def was_loaded(kernel):
    return bool(kernel.call.stats.cache_hits)


def only_file(folder):
    files = [path for path in folder.rglob("*") if path.is_file()]
    assert len(files) == 1
    return files[0]


def truncated(path):
    path.write_bytes(path.read_bytes()[:-1])


def emptied(path):
    path.write_bytes(b"")


def flipped(path):
    raw = bytearray(path.read_bytes())
    raw[len(raw) // 2] ^= 1
    path.write_bytes(raw)


DAMAGES = pytest.mark.parametrize("damage", [truncated, emptied, flipped])


@DAMAGES
def test_a_damaged_kernel_is_deleted_and_made_again(top, said, damage):
    assert not was_loaded(compiled())
    assert was_loaded(compiled())
    path = only_file(top)
    damage(path)
    assert not was_loaded(compiled())
    assert said() == [f"railquake: {path}: is damaged; it is made again"]
    assert was_loaded(compiled())
    assert only_file(top) == path


@DAMAGES
def test_a_damaged_table_is_deleted_and_made_again(top, said, damage):
    made = []

    def fill(table):
        made.append(1)
        table[:] = np.arange(9.0)

    def table():
        found = geometry._kept("key" * 20, 9, fill)
        assert found.tolist() == list(range(9))
        assert found.flags.writeable  # the kernels are compiled for such
        return len(made)

    assert (table(), table()) == (1, 1)
    path = only_file(top)
    damage(path)
    assert (table(), table()) == (2, 2)
    assert said() == [f"railquake: {path}: is damaged; it is made again"]


def test_a_file_in_the_place_of_another_is_noticed(top):
    one, two = top / "tables" / "one", top / "tables" / "two"
    caching.keep(one, b"1")
    caching.keep(two, b"2")
    one.replace(two)
    assert caching.kept(two) is None
    assert not two.exists()


def test_what_cannot_be_rebuilt_is_compiled_again(top, said):
    compiled()
    path = only_file(top)
    caching.keep(path, b"of a library that is no more")
    assert not was_loaded(compiled())
    assert was_loaded(compiled())


def test_folders_are_for_their_owner_alone(top):
    former = os.umask(0)
    try:
        compiled()
    finally:
        os.umask(former)
    path = only_file(top)
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    for folder in (*path.relative_to(top).parents,):
        assert stat.S_IMODE((top / folder).stat().st_mode) == 0o700
    assert stat.S_IMODE(top.parent.stat().st_mode) == 0o700


@pytest.mark.parametrize("mode", [0o770, 0o707, 0o777, 0o1777])
@pytest.mark.parametrize("level", [0, 1, 2])
def test_nothing_is_loaded_that_others_can_write(top, said, mode, level):
    path = top / "kernels" / "hash" / "kernel"
    caching.keep(path, b"machine code")
    assert caching.kept(path) == b"machine code"
    folder = (top, top / "kernels", top / "kernels" / "hash")[level]
    folder.chmod(mode)
    for _ in range(2):
        assert caching.kept(path) is None
    caching.keep(top / "kernels" / "hash" / "other", b"new")
    assert [p.name for p in path.parent.iterdir()] == ["kernel"]
    assert len(said()) == 1
    assert str(folder) in said()[0] and f"mode {mode & 0o777:o}" in said()[0]
    assert "RAILQUAKE_CACHE_DIR" in said()[0]


def test_a_file_that_others_can_write_is_not_loaded(top):
    path = top / "kernel"
    caching.keep(path, b"machine code")
    path.chmod(0o666)
    assert caching.kept(path) is None


def test_nothing_of_another_user_is_loaded(top, said, monkeypatch):
    path = top / "kernel"
    caching.keep(path, b"machine code")
    other = os.geteuid() + 1
    monkeypatch.setattr(os, "geteuid", lambda: other)
    assert caching.kept(path) is None
    assert said() == [
        f"railquake: {top} belongs to another user, so nothing is loaded from it; machine code and "
        "tables are made in memory"
    ]


def test_a_cache_that_cannot_be_written_is_said_once(tmp_path, monkeypatch, said):
    caching._say.cache_clear()
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("RAILQUAKE_CACHE_DIR", str(tmp_path / "file" / "cache"))
    for _ in range(2):
        caching.keep(caching.cache_folder() / "kernel", b"")
    assert said() == [
        f"railquake: the cache {tmp_path / 'file' / 'cache'} cannot be written (Not a directory); "
        "machine code and tables are made in memory"
    ]


def test_a_cache_that_cannot_even_be_looked_into_is_none(top, said, monkeypatch):
    path = top / "kernels" / "kernel"
    caching.keep(path, b"machine code")
    look = os.stat

    def closed(at, **options):
        if str(at).startswith(str(top)) and str(at) != str(top):
            raise PermissionError(13, "Permission denied", str(at))
        return look(at, **options)

    monkeypatch.setattr(os, "stat", closed)
    assert caching.kept(path) is None
    caching.keep(path, b"new")
    monkeypatch.undo()
    assert len(said()) == 1
    assert f"the cache {top} cannot be written (Permission denied)" in said()[0]


def nobody(_):
    raise KeyError("uid not found")


@pytest.mark.skipif(sys.platform != "linux", reason="another system, another place")
@pytest.mark.parametrize("value", [None, "", "relative/cache"])
def test_a_cache_that_is_not_said_for_certain_is_at_home(monkeypatch, tmp_path, value):
    monkeypatch.delenv("RAILQUAKE_CACHE_DIR", raising=False)
    monkeypatch.setenv("HOME", str(tmp_path))
    if value is None:
        monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    else:
        monkeypatch.setenv("XDG_CACHE_HOME", value)
    assert caching.cache_folder() == tmp_path / ".cache" / "railquake"
    monkeypatch.setenv("XDG_CACHE_HOME", "/elsewhere")
    assert caching.cache_folder() == Path("/elsewhere/railquake")


@pytest.mark.skipif(sys.platform != "linux", reason="another system, another place")
@pytest.mark.parametrize("home", [None, "", "here"])
def test_without_a_home_kernels_are_compiled_in_memory(monkeypatch, said, home, tmp_path):
    caching._say.cache_clear()
    monkeypatch.chdir(tmp_path)
    for name in ("RAILQUAKE_CACHE_DIR", "XDG_CACHE_HOME", "HOME"):
        monkeypatch.delenv(name, raising=False)
    if home is not None:
        monkeypatch.setenv("HOME", home)
    listed = pwd.getpwuid(os.getuid()).pw_dir
    assert caching.cache_folder() == Path(listed) / ".cache" / "railquake"
    monkeypatch.setattr(pwd, "getpwuid", nobody)
    assert not was_loaded(compiled())
    assert not was_loaded(compiled())
    assert len(said()) == 1
    assert "no home folder" in said()[0]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("variable", "value"), [("NUMBA_DISABLE_JIT", "1"), ("NUMBA_NUM_THREADS", "0")]
)
def test_an_environment_without_a_compiler_is_refused_by_name(monkeypatch, variable, value):
    monkeypatch.delenv(variable, raising=False)
    caching.check_compiler()
    monkeypatch.setenv(variable, value)
    with pytest.raises(InputError, match=f"^{variable} is ") as caught:
        caching.check_compiler()
    assert "\n" not in str(caught.value)
