"""One row of a manifest: a record's file and its scale factor."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path

from railquake.errors import InputError

__all__ = ["SuiteRow", "positive_number"]


@dataclass(frozen=True)
class SuiteRow:
    """One row of a manifest.

    Parameters
    ----------
    place : str
        File and line, for messages.
    file : str
        As written.
    scale_factor : float
        Over zero.
    cells : dict
        All cells of the row that are not empty, by column.
    """

    place: str
    file: str
    scale_factor: float
    cells: dict[str, str] = field(default_factory=dict)

    @property
    def label(self) -> str:
        """The row's name, else its file's without folder and ending."""
        return self.cells.get("name") or Path(self.file).stem


def positive_number(text: str, what: str) -> float:
    """A finite number over zero, or a fault that names `what`."""
    try:
        value = float(text)
    except ValueError:
        raise InputError(f"{what}: must be a number, found {text!r}") from None
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"{what}: must be finite and over zero, found {text}")
    return value
