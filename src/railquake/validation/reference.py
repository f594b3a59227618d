"""Reading of reference numbers: beside the comparisons, and in the folder of reference data."""

from __future__ import annotations

import csv
import os
import tomllib
from pathlib import Path
from typing import Any

import numpy as np

import railquake
from railquake.errors import InputError
from railquake.validation.comparison import Unavailable

__all__ = ["columns", "data_folder", "header", "numbers_beside", "paper_record", "toml"]

HERE = Path(__file__).parent
ENVIRONMENT = "RAILQUAKE_SHARED"


def data_folder(given: Path | None) -> Path | None:
    """The folder of reference data.

    The given one, or the one that the environment variable ``RAILQUAKE_SHARED`` names, or the
    folder ``shared`` beside a source checkout.

    Returns
    -------
    Path or None
        None where there is none and none was asked for.

    Raises
    ------
    InputError
        If a folder was asked for and is none, or holds no reference data.
    """
    if given is not None:
        return _checked(given, "--data")
    if os.environ.get(ENVIRONMENT):
        return _checked(Path(os.environ[ENVIRONMENT]), ENVIRONMENT)
    checkout = Path(railquake.__file__).resolve().parents[2]
    beside = checkout.parent / "shared"
    return beside if (checkout / "pyproject.toml").is_file() and beside.is_dir() else None


def _checked(folder: Path, what: str) -> Path:
    if not folder.is_dir():
        found = "a file" if folder.is_file() else "nothing"
        raise InputError(f"{what}: a folder of reference data is needed, found {found} at {folder}")
    if not any((folder / part).is_dir() for part in ("oracles", "records")):
        raise InputError(
            f"{what}: {folder} holds neither oracles/ nor records/; name the folder that does"
        )
    return folder


def numbers_beside(comparison: str, file: str) -> Path:
    """A file of numbers that lies beside the comparisons, in the folder of one of them."""
    return HERE / comparison / file


def columns(path: Path) -> dict[str, Any]:
    """Columns of a CSV file by name; lines that begin with # are its provenance.

    Returns
    -------
    dict of arrays
        Of floats, or of texts where a cell is no number.

    Raises
    ------
    Unavailable
        If the file is not there.
    """
    with _opened(path) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    table: dict[str, Any] = {}
    for name in rows[0]:
        cells = [row[name] for row in rows]
        try:
            table[name] = np.array(cells, dtype=float)
        except ValueError:
            table[name] = np.array(cells)
    return table


def header(path: Path) -> list[str]:
    """The provenance of a CSV file: its leading lines, without their #."""
    with _opened(path) as file:
        return [line[1:].strip() for line in file if line.startswith("#")]


def toml(path: Path) -> dict[str, Any]:
    """Numbers of a TOML file."""
    return tomllib.loads(path.read_text(encoding="utf-8"))


def paper_record(data: Path | None, record: str) -> Path:
    """File of one of the paper's twenty records.

    Raises
    ------
    Unavailable
        If it is not there.
    """
    if data is None:
        raise Unavailable("needs the folder of reference data: --data DIR")
    path = data / "records" / "paper_suite" / f"{record}.AT2"
    if not path.is_file():
        raise Unavailable(f"needs {path}")
    return path


def _opened(path: Path) -> Any:
    try:
        return open(path, newline="", encoding="utf-8")
    except FileNotFoundError:
        raise Unavailable(f"needs {path}") from None
