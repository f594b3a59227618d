"""The folder that a run leaves: numbers, histories, pictures; whole or not at all."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from railquake.errors import InputError
from railquake.files import whole_folder
from railquake.messages import csv_cell, reason
from railquake.run.assess import assess

if TYPE_CHECKING:
    import xarray

    from railquake.run.response import Response

__all__ = ["json_text", "write_run"]

SUMMARY = "summary.json"
# What a run writes; only these are replaced in a folder that is there already.
FILES = (
    SUMMARY, "history.nc", "events.csv", "case.toml", "histories.png", "wheel-loads.png",
    "relative-roll.png", "section.png", "hinge-loop.png",
)  # fmt: skip


def json_text(value: Any) -> str:
    """JSON that every reader takes: a number that is not finite becomes null."""
    return json.dumps(_finite(value), indent=2, allow_nan=False)


def _finite(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, Mapping):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return value


def write_run(response: Response, folder: Path, *, pictures: bool = True) -> dict[str, Any]:
    """Write everything that a run gave.

    All files are written under a temporary name first and then moved, so that an interruption
    leaves no broken file, and no mixture of two runs.

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
    try:
        with whole_folder(folder, ours=FILES, last=SUMMARY) as part:
            (part / "case.toml").write_text(response.system.scenario.to_toml(), encoding="utf-8")
            _write_events(response, part / "events.csv")
            (part / "history.nc").write_bytes(_netcdf(response.history))
            if pictures:
                from railquake.plots import write_pictures

                write_pictures(response, part)
            (part / SUMMARY).write_text(json_text(row) + "\n", encoding="utf-8")
    except OSError as error:
        raise InputError(f"{folder}: cannot be written: {reason(error)}") from None
    return row


def _netcdf(history: xarray.Dataset) -> bytes:
    """The bytes of a NetCDF file, made in memory: HDF5 ends the process where a disk is full."""
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    buffer = io.BytesIO()
    with h5netcdf.File(buffer, mode="w") as file:
        history.dump_to_store(H5NetCDFStore(file))
    return buffer.getvalue()


def _write_events(response: Response, path: Path) -> None:
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["event", "begin_s", "end_s"])
        for event in response.events:
            end = "" if event.end_s != event.end_s else f"{event.end_s:.6g}"
            writer.writerow([csv_cell(event.name), f"{event.begin_s:.6g}", end])
