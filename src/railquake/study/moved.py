"""Files of a study that lie elsewhere by now: the folder of the records, or all of it, was moved.

A study's file names its files absolutely, and says in which folder it was written itself.  So a
study folder that was moved alone still finds them, and so does one that was moved together with
them.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path, PurePath
from typing import Any

from railquake.errors import InputError
from railquake.files import is_file
from railquake.inputs.marks import File, marked
from railquake.inputs.motion import Motion
from railquake.messages import no_folder

__all__ = ["FOLDER", "found_again", "without_folders"]

FOLDER = "folder"
"""Key of a study's file for the folder that it was written in."""
_RECORDS = tuple(marked(Motion, File))
_FILES = (*_RECORDS, "file", "preset")  # keys of paths, wherever they stand


def found_again(tables: Mapping[str, Any], here: Path, records: Path | None) -> dict[str, Any]:
    """A study's tables with the paths at which its files are now.

    Parameters
    ----------
    tables : mapping
        As they stand in the file.
    here : Path
        The folder in which the file lies.
    records : Path or None
        The folder of the records; None if they are where they were.

    Raises
    ------
    InputError
        If a record is not in that folder: says where it was looked for.
    """
    if records is not None and not records.is_dir():
        raise no_folder(records, "give the one that holds the records")
    written = tables.get(FOLDER)
    former = PurePath(written) if isinstance(written, str) else None
    kept = {key: value for key, value in tables.items() if key != FOLDER}
    found: dict[str, Any] = _walk(kept, here, former, records)
    return found


def _walk(
    value: Any, here: Path, former: PurePath | None, records: Path | None, path: str = ""
) -> Any:
    """The value with the paths in it; ``path`` is its own in the study's file."""
    if isinstance(value, Mapping):
        return {key: _walk(item, here, former, records, str(key)) for key, item in value.items()}
    if isinstance(value, list):
        return [_walk(item, here, former, records, path) for item in value]
    key = path.rpartition(".")[2]
    if isinstance(value, str) and key in _FILES and os.path.isabs(value):
        return _moved(key, value, here, former, records)
    return value


def _moved(key: str, path: str, here: Path, former: PurePath | None, records: Path | None) -> str:
    if key in _RECORDS and records is not None:
        return _in_folder(PurePath(path), records)
    if former is None or is_file(path):
        return path
    beside = os.path.normpath(here / os.path.relpath(path, former))
    return beside if is_file(beside) else path


def _in_folder(path: PurePath, records: Path) -> str:
    """The record in the folder, with as many of the folders above it as are there, too."""
    steps = path.parts[1:]
    for first in range(len(steps)):
        there = records.joinpath(*steps[first:]).absolute()
        if is_file(there):
            return str(there)
    raise InputError(
        f"--records {records}: holds no {path.name}, which the study had as {path}; give the "
        "folder that holds it"
    )


def without_folders(path: str, value: Any) -> Any:
    """A file's name alone, to compare studies; anything else as it stands.

    Whether the content is the same is known by the hashes of the scenarios.

    Parameters
    ----------
    path : str
        Of the value in the study's file, ``"suite.members.a.motion.record"``.
    value : object
    """
    if isinstance(value, str) and path.rpartition(".")[2] in _FILES:
        return PurePath(value).name
    return value
