"""Folders for results: whether they can be written is known before a long run."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from railquake.errors import InputError

__all__ = ["prepare_folder", "reason"]


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


def reason(error: OSError) -> str:
    """Why, on one line."""
    return error.strerror or " ".join(str(error).split())
