"""The horizontal components that a folder of records holds."""

from __future__ import annotations

import hashlib
import os
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from railquake.errors import InputError
from railquake.inputs.ground_motion import GroundMotion, read_motion, record_contents
from railquake.inputs.ground_motion.orientation import vertical_by_name
from railquake.messages import no_folder, unreadable

__all__ = ["Component", "Skipped", "find_components"]

NO_RECORD = "no record"
PLAIN_COLUMNS = "plain columns of numbers"
VERTICAL = "vertical component"
COPY = "copy of another"
ALL_ZERO = "all zero"
DAMAGED = "damaged or incomplete"


@dataclass(frozen=True, eq=False)
class Component:
    """A horizontal component of a record.

    Parameters
    ----------
    file : str
        Relative to the folder, with forward slashes.
    channel : int or str or None
        Which one of the file's channels; None where it has one only.
    motion : GroundMotion
        As recorded.
    """

    file: str
    channel: int | str | None
    motion: GroundMotion


@dataclass(frozen=True)
class Skipped:
    """A file, or a channel of one, that cannot take part.

    Parameters
    ----------
    file : str
        Relative to the folder.
    kind : str
        A word or two for what it is.
    reason : str
        The whole message, where a reader gave one.
    """

    file: str
    kind: str
    reason: str = ""


def find_components(
    folder: Path, progress: Callable[[int, int], None] | None = None
) -> tuple[tuple[Component, ...], tuple[Skipped, ...]]:
    """Read all records in a folder and the folders in it.

    A file takes part if it is of a record format that `read_motion` knows and says everything
    itself (time step, unit).  Plain columns of numbers are left out: a table of a spectrum looks
    the same.  So are vertical components, told by the file's header or, where it does not tell, by
    the file's name, and components that are there already under another name.

    Parameters
    ----------
    folder : Path
        The folder.
    progress : callable, optional
        Called with the number of files looked at and of all files.

    Returns
    -------
    components : tuple of Component
        In the order of the files' paths; not empty.
    skipped : tuple of Skipped
        What was left out, and why; hidden files are not mentioned.

    Raises
    ------
    InputError
        If the folder cannot be read or holds no record.
    """
    paths = _files(folder)
    found: list[Component] = []
    skipped: list[Skipped] = []
    seen: set[bytes] = set()
    for number, path in enumerate(paths, 1):
        file = path.relative_to(folder).as_posix()
        for one in _components(path, file):
            if isinstance(one, Component):
                samples = one.motion.acceleration.tobytes() + repr(one.motion.dt).encode()
                key = hashlib.sha256(samples).digest()
                if key in seen:
                    skipped.append(Skipped(file, COPY))
                elif one.motion.pga == 0.0:
                    skipped.append(Skipped(file, ALL_ZERO))
                else:
                    found.append(one)
                seen.add(key)
            else:
                skipped.append(one)
        if progress is not None:
            progress(number, len(paths))
    if not found:
        raise InputError(f"{folder}: holds no usable record{_why_not(skipped)}")
    return tuple(found), tuple(skipped)


def _files(folder: Path) -> list[Path]:
    """All files below a folder, hidden ones apart, in the order of their paths."""
    if not folder.is_dir():
        raise no_folder(folder, "give the one that holds the records")

    def refuse(error: OSError) -> None:
        raise unreadable(str(error.filename), error) from None

    paths = []
    for parent, folders, names in os.walk(folder, onerror=refuse):
        folders[:] = [name for name in folders if not name.startswith(".")]
        paths += [Path(parent, name) for name in names if not name.startswith(".")]
    return sorted(paths, key=lambda path: path.relative_to(folder).as_posix())


def _components(path: Path, file: str) -> list[Component | Skipped]:
    try:
        contents = record_contents(path)
    except InputError as error:
        return [Skipped(file, NO_RECORD, str(error))]
    if contents.format == "columns":
        return [Skipped(file, PLAIN_COLUMNS)]
    several = len(contents.channels) > 1
    made: list[Component | Skipped] = []
    for (number, label), vertical in zip(contents.channels, contents.vertical, strict=True):
        channel = (number if number is not None else label) if several else None
        if vertical or (vertical is None and not several and vertical_by_name(path)):
            made.append(Skipped(file, VERTICAL))
            continue
        try:
            made.append(Component(file, channel, read_motion(path, channel=channel)))
        except InputError as error:
            made.append(Skipped(file, DAMAGED, str(error)))
    return made


def _why_not(skipped: list[Skipped]) -> str:
    if not skipped:
        return " (it is empty); fill it, or name another"
    kinds = Counter(one.kind for one in skipped)
    counts = ", ".join(f"{number} x {kind}" for kind, number in kinds.items())
    return f" ({counts}); name another folder"
