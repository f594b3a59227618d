"""Temporary parts of what is being written: of a random name, ours alone, and never left behind.

A part is a hidden file or folder that ends with ``.part``.  Its writer holds a lock on it, which
ends with its process: whoever writes next beside it sees by that which parts were left by a process
that was killed, and removes them.
"""

from __future__ import annotations

import hashlib
import os
import platform
import re
import secrets
import shutil
import signal
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path

__all__ = ["drop_parts", "new_file", "new_folder", "sweep", "uninterrupted"]

NAME = re.compile(r"\.(?P<name>.+)\.(?P<host>[0-9a-f]{8})[0-9a-f]{16}\.part", re.DOTALL)
FOREIGN_S = 24 * 3600.0  # after which a part of another machine, whose locks we may not see, is old
SETTLING_S = 0.2  # between the making of a part and its lock
PATIENCE_S = 10.0  # for files that are just being moved

_LIVE: dict[Path, Sequence[Path]] = {}  # parts of this process, and the folders made for them
_MOVING = threading.RLock()


@contextmanager
def new_file(folder: Path, name: str) -> Iterator[Path]:
    """An empty file of ours in a folder; gone when the block ends, unless it was moved.

    Parameters
    ----------
    folder : Path
        Must be there.
    name : str
        Of what it is to become.

    Raises
    ------
    OSError
        If it cannot be made.
    """
    sweep(folder, name)
    part = folder / _random_name(name)
    lock = None
    _LIVE[part] = ()
    try:
        opened = os.open(part, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o666)
        lock = _held(opened)
        yield part
    finally:
        with suppress(OSError):
            part.unlink(missing_ok=True)
        _let_go(lock)
        _LIVE.pop(part, None)


@contextmanager
def new_folder(above: Path, name: str) -> Iterator[Path]:
    """An empty folder of ours; gone when the block ends, unless it was moved.

    Parameters
    ----------
    above : Path
        Made if it is not there, and gone again if it is empty at the end.
    name : str
        Of what it is to become.

    Raises
    ------
    OSError
        If it cannot be made.
    """
    sweep(above, name)
    part = above / _random_name(name)
    made = [parent for parent in part.parents if not parent.exists()]
    lock = None
    _LIVE[part] = made
    try:
        part.mkdir(parents=True)
        lock = None if sys.platform == "win32" else _held(os.open(part, os.O_RDONLY))
        yield part
    finally:
        with uninterrupted():
            _remove(part, made)
            _let_go(lock)
            _LIVE.pop(part, None)


def sweep(folder: Path, name: str | None = None) -> None:
    """Remove the parts that writers who are no more have left in a folder.

    Parameters
    ----------
    folder : Path
    name : str, optional
        Only those that were to become this; all by default.
    """
    with suppress(OSError):
        for entry in list(os.scandir(folder)):
            found = NAME.fullmatch(entry.name)
            if found is not None and name in (None, found["name"]):
                with suppress(OSError):
                    _remove_if_left(Path(entry.path), found["host"] == _host())


def drop_parts() -> None:
    """Remove all parts of this process, which is about to end at once.

    What is just being moved gets there first.
    """
    _MOVING.acquire(timeout=PATIENCE_S)  # and never given back: nothing is moved from now on
    for part, made in list(_LIVE.items()):
        _remove(part, made)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Let Ctrl-C and the request to terminate wait until the block is done."""
    if threading.current_thread() is not threading.main_thread():
        yield  # only the main thread is interrupted
        return
    arrived: list[int] = []
    former = {
        number: signal.signal(number, lambda number, _: arrived.append(number))
        for number in (signal.SIGINT, signal.SIGTERM)
    }
    try:
        with _MOVING:
            yield
    finally:
        for number, handler in former.items():
            signal.signal(number, signal.SIG_DFL if handler is None else handler)
        if arrived:
            signal.raise_signal(arrived[0])


def _random_name(name: str) -> str:
    return f".{name}.{_host()}{secrets.token_hex(8)}.part"


@cache
def _host() -> str:
    """What tells this machine from others that share a file system."""
    return hashlib.sha256(platform.node().encode()).hexdigest()[:8]


def _held(opened: int) -> int | None:
    """Lock what was opened until it is closed; None where that cannot be done."""
    if sys.platform == "win32":
        os.close(opened)  # an open file cannot be moved there
        return None
    import fcntl

    with suppress(OSError):  # without locks nobody can tell, and nothing is swept
        fcntl.flock(opened, fcntl.LOCK_SH)
    return opened


def _let_go(lock: int | None) -> None:
    if lock is not None:
        os.close(lock)


def _remove_if_left(part: Path, is_ours: bool) -> None:
    is_folder = part.is_dir() and not part.is_symlink()
    young = SETTLING_S if is_ours and sys.platform != "win32" else FOREIGN_S
    if 0.0 <= time.time() - part.lstat().st_mtime < young:
        return
    if sys.platform == "win32":
        _remove(part, ())
        return
    import fcntl

    opened = os.open(part, (os.O_RDONLY if is_folder else os.O_RDWR) | os.O_NOFOLLOW)
    try:
        fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)  # fails while its writer lives
        _remove(part, ())
    finally:
        os.close(opened)


def _remove(part: Path, made: Sequence[Path]) -> None:
    if part.is_dir() and not part.is_symlink():
        shutil.rmtree(part, ignore_errors=True)
    with suppress(OSError):
        part.unlink(missing_ok=True)
    for parent in made:
        with suppress(OSError):  # it holds the results
            parent.rmdir()
