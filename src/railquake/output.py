"""The folder that a run leaves: numbers, histories, pictures; whole or not at all."""

from __future__ import annotations

import csv
import json
import os
import shutil
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from railquake.assessment import assess
from railquake.errors import InputError

if TYPE_CHECKING:
    from railquake.response import Response

__all__ = ["prepare_folder", "write_run"]

# What a run writes; only these are replaced in a folder that is there already.
FILES = (
    "summary.json", "history.nc", "events.csv", "case.toml", "histories.png", "wheel-loads.png",
    "relative-roll.png", "section.png", "hinge-loop.png",
)  # fmt: skip


def prepare_folder(folder: Path) -> None:
    """Make sure, before a long run, that its results can be written.

    Raises
    ------
    InputError
        If the folder cannot be made or written to, or is a file.
    """
    if folder.exists() and not folder.is_dir():
        raise InputError(f"--out {folder}: is a file; name a folder")
    parent = folder if folder.exists() else folder.absolute().parent
    try:
        parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=parent):
            pass
    except OSError as error:
        raise InputError(f"--out {folder}: cannot be written: {error.strerror or error}") from None


def write_run(response: Response, folder: Path, *, pictures: bool = True) -> dict[str, Any]:
    """Write everything that a run gave.

    All files are written to a folder beside it first and then moved, so that an interruption
    leaves no broken file.

    Parameters
    ----------
    response : Response
    folder : Path
        Made if it is not there; files of a former run in it are replaced, others left alone.
    pictures : bool

    Returns
    -------
    dict
        The summary, see `assess`.

    Raises
    ------
    InputError
        If the files cannot be written.
    """
    row = assess(response)
    folder = folder.absolute()
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        part = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", dir=folder.parent))
    except OSError as error:
        raise InputError(f"{folder}: cannot be written: {error.strerror or error}") from None
    try:
        (part / "summary.json").write_text(json.dumps(row, indent=2) + "\n")
        (part / "case.toml").write_text(response.system.scenario.to_toml())
        _write_events(response, part / "events.csv")
        response.history.to_netcdf(part / "history.nc", engine="h5netcdf")
        if pictures:
            from railquake.plots import write_pictures

            write_pictures(response, part)
        folder.mkdir(exist_ok=True)
        written = {path.name for path in part.iterdir()}
        for name in written:
            os.replace(part / name, folder / name)
        for name in set(FILES) - written:  # of a former run of another kind
            (folder / name).unlink(missing_ok=True)
    except OSError as error:
        raise InputError(f"{folder}: cannot be written: {error.strerror or error}") from None
    finally:
        shutil.rmtree(part, ignore_errors=True)
    return row


def _write_events(response: Response, path: Path) -> None:
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["event", "begin_s", "end_s"])
        for event in response.events:
            end = "" if event.end_s != event.end_s else f"{event.end_s:.6g}"
            writer.writerow([event.name, f"{event.begin_s:.6g}", end])
