"""Writing files and folders: whole or not at all, and known to be possible before a long run.

What is written lies under a hidden, random name that ends with ``.part`` until its writer is done,
and is then moved into its place: whoever reads sees the former state or the new one, and an
interruption leaves nothing behind.  What a killed process left is removed by the next (`parts`).
"""

from __future__ import annotations

import errno
import os
import secrets
import stat
import tempfile
from collections.abc import Collection, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from railquake.errors import InputError
from railquake.messages import reason
from railquake.parts import new_file, new_folder, sweep, uninterrupted

__all__ = [
    "prepare_folder",
    "random_name",
    "set_aside",
    "whole_file",
    "whole_folder",
]

OUR_FOLDERS = "railquake"  # what a folder's part is named after: the folder may be moved


def prepare_folder(folder: Path) -> None:
    """Make sure, before a long run, that its results can be written; nothing is left behind.

    Raises
    ------
    InputError
        If the folder cannot be made or written to, or is a file.
    """
    if os.path.lexists(folder) and not folder.is_dir():
        raise InputError(f"--out {folder}: is no folder; name a folder")
    there = folder.absolute()
    while not os.path.lexists(there):
        there = there.parent
    try:
        with tempfile.TemporaryFile(dir=there):
            pass
    except OSError as error:
        raise InputError(f"--out {folder}: cannot be written: {reason(error)}") from None


def random_name(suffix: str = "") -> str:
    """A file name that nobody else takes."""
    return secrets.token_hex(16) + suffix


@contextmanager
def whole_file(path: Path, *, durable: bool = False, replace: bool = True) -> Iterator[Path]:
    """A place to write a file to; it becomes ``path`` if the block ends without an error.

    Parameters
    ----------
    path : Path
        Its folder must be there.
    durable : bool
        Whether the file is brought to the disk itself before it is moved: it then survives a loss
        of power.
    replace : bool
        Whether it takes the place of a file of this name.  Otherwise that one stays, and what was
        written is dropped: of several writers the first one wins.

    Yields
    ------
    Path
        An empty file of ours, beside ``path``.

    Raises
    ------
    OSError
        If it cannot be written or moved, or if there is a device, a pipe or a folder.
    """
    _refuse_to_replace(path)
    with new_file(path.parent, path.name) as part:
        yield part
        if durable:
            with part.open("rb+") as file:
                os.fsync(file.fileno())
        if replace:
            os.replace(part, path)
        else:
            with suppress(FileExistsError):
                os.link(part, path)
        if durable:
            _note_folder(path.parent)


@contextmanager
def whole_folder(
    folder: Path, *, ours: Collection[str] = (), last: str | None = None
) -> Iterator[Path]:
    """A place to write a folder's files to; they get there if the block ends without an error.

    Ctrl-C and a request to terminate wait while the files are moved, so that there is no mixture of
    two writings.

    Parameters
    ----------
    folder : Path
        Made if it is not there, and so are those above it.  What is in it stays, but for files
        that are written again.
    ours : collection of str
        Files that leave the folder where they are not written again: those of a former writing of
        another kind.
    last : str, optional
        The file that is moved last, as the sign that all are there.

    Yields
    ------
    Path
        An empty folder.

    Raises
    ------
    OSError
        If it cannot be written or moved.
    """
    # In a folder that is there already the temporary one lies inside: its parent may be another
    # file system, or closed to us.
    above = folder if folder.is_dir() else folder.absolute().parent
    sweep(folder.absolute().parent, OUR_FOLDERS)
    with new_folder(above, OUR_FOLDERS) as part:
        yield part
        with uninterrupted():
            _move_all(part, folder, ours, last)


def set_aside(path: Path, suffix: str) -> None:
    """Give a file another suffix, if that can be done: what is damaged is looked at once."""
    with suppress(OSError):
        os.replace(path, path.with_suffix(suffix))


def _refuse_to_replace(path: Path) -> None:
    """Refuse what is no file: to move one into the place of a device would be the device's end."""
    with suppress(FileNotFoundError):
        if not stat.S_ISREG(path.stat().st_mode):
            raise OSError(errno.EEXIST, "is a device, a pipe or a folder; name a file", str(path))


def _move_all(part: Path, folder: Path, ours: Collection[str], last: str | None) -> None:
    if not folder.is_dir():
        os.rename(part, folder)
        return
    written = {path.name for path in part.iterdir()}
    for name in set(ours) - written:
        (folder / name).unlink(missing_ok=True)
    for name in sorted(written, key=lambda name: (name == last, name)):
        os.replace(part / name, folder / name)


def _note_folder(folder: Path) -> None:
    """Bring a folder's list of files to the disk; not every file system can."""
    with suppress(OSError):
        listed = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(listed)
        finally:
            os.close(listed)
