"""How rows are declared."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

__all__ = ["Part", "Row", "block", "row"]


class Part(NamedTuple):
    """One row of a block that has a name of its own."""

    name: str
    unit: str
    meaning: str
    channel: str | None = None
    """Name in a history."""
    at: int | str | None = None
    """Place in the block, or the name of a size that gives it; else after the part before."""


class Row(NamedTuple):
    """A row, or a block of rows that is addressed by its first one."""

    name: str
    unit: str
    meaning: str
    rows: int | str
    """How many, or the name of a size."""
    parts: tuple[Part, ...]
    train: bool
    """Whether it is the train's: a history no longer shows it once the train has left."""
    released: bool
    """Whether it is set to zero when the train leaves the model."""


def row(
    name: str,
    unit: str,
    meaning: str,
    channel: str | None = None,
    *,
    rows: int | str = 1,
    train: bool = False,
    released: bool = False,
) -> Row:
    """One row; or ``rows`` of one kind, such as one a side."""
    parts = (Part(name, unit, meaning, channel, 0),) if rows == 1 else ()
    return Row(name, unit, meaning, rows, parts, train, released)


def block(
    name: str,
    meaning: str,
    parts: Sequence[tuple[str | int | None, ...] | Part],
    *,
    rows: int | str | None = None,
    train: bool = False,
    released: bool = False,
) -> Row:
    """Rows that are met together, each with a name of its own."""
    named = tuple(Part(*part) for part in parts)
    units = " or ".join(dict.fromkeys(part.unit for part in named))
    count = len(named) if rows is None else rows
    return Row(name, units, meaning, count, named, train, released)
