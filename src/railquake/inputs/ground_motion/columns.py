"""Plain text or CSV: time and acceleration in columns, or acceleration alone.

The unit of acceleration comes from the header ("a_g", "acc (m/s2)", "# units: cm/s2") or from
the caller; the time step from the time column, or from the caller where there is none.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from railquake.inputs.ground_motion import units as unit_table
from railquake.inputs.ground_motion.text import (
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    convert,
    shown,
    to_float,
    unit_of_file,
)

HEADER_LINES = 200
"""The first row of numbers is looked for within this many lines."""

_NOT_FINITE = re.compile(r"[+-]?(?:nan|inf|infinity)|\*+", re.IGNORECASE)
_BRACKETS = re.compile(r"([^()\[\]]*)[(\[]([^()\[\]]*)[)\]]")
_DECIMAL = re.compile(r"[+-]?[0-9]*\.?([0-9]*)(?:[eEdD]([+-]?[0-9]{1,4}))?")


def first_row(record: RecordFile) -> int | None:
    """Index of the first line that holds nothing but numbers, or None."""
    for index, line in enumerate(record.lines[:HEADER_LINES]):
        fields = _split(line, _separator(line))
        others = [field for field in fields if to_float(field) is None]
        finite = len(others) < len(fields)
        if finite and all(not field or _NOT_FINITE.fullmatch(field) for field in others):
            return index
    return None


def column_channels(record: RecordFile, options: Options) -> list[Channel]:
    """The columns beside the time column, each a channel.

    Raises
    ------
    InputError
        If the rows differ in length.
    """
    start = first_row(record)
    assert start is not None, "first_row comes first"
    separator = _separator(record.lines[start])
    count = len(_split(record.lines[start], separator))
    names, units = _names_and_units(record, start, count)
    read = partial(_read, record, options, start, units)
    if count <= 2:
        return [Channel(None, "", partial(read, count - 1))]
    return [Channel(column, names[column], partial(read, column)) for column in range(1, count)]


def _read(
    record: RecordFile,
    options: Options,
    start: int,
    units: list[str | None],
    column: int,
) -> Series:
    """Read one column of numbers and the time beside it."""
    table, rows, first_column = _table(record, start, len(units))
    if len(table) < 2:
        raise record.fault("has a single row of numbers; a record needs at least two", start)
    stated = units[column]
    if stated is None:
        header = unit_table.unit_statements(record.lines[:start])
        stated = header[0] if header else None
    factor = unit_of_file(record, stated, options)
    if len(units) == 1:
        if options.dt is None:
            raise record.fault(
                "has one column and no time; give the time step, dt = 0.01 for example"
            )
        return Series(check_dt(record, options.dt, options), table[:, 0] * factor)
    notes: tuple[str, ...] = ()
    to_seconds: float | None = 1.0
    if units[0] is None:
        notes += ("the header states no unit of time: seconds taken",)
    else:
        to_seconds = unit_table.time_factor(units[0])
    if to_seconds is None:
        raise record.fault(
            f"the first column is in {shown(str(units[0]))}; time in s is expected there",
            start - 1,
        )
    dt = to_seconds * _time_step(record, table[:, 0], rows, first_column)
    dt = check_dt(record, _short(dt), options)
    begin = float(table[0, 0]) * to_seconds
    if abs(begin) > 1.5 * dt:
        notes += (f"the file's time starts at {begin:g} s, the motion's at 0",)
    return Series(dt, table[:, column] * factor, notes)


def _separator(line: str) -> str | None:
    """What stands between the fields of a line; None for blanks."""
    for separator in (";", ",", "\t"):
        if separator in line:
            return separator
    return None


def _split(line: str, separator: str | None) -> list[str]:
    """Fields of a line; a separator at the very end ends the last field."""
    if separator is None:
        return line.split()
    fields = [field.strip() for field in line.split(separator)]
    if len(fields) > 1 and not fields[-1]:
        fields.pop()
    return fields


def _table(
    record: RecordFile, start: int, count: int
) -> tuple[NDArray[np.float64], list[int], list[str]]:
    """All rows: the numbers (rows, count), the line of each row, and the first column as text."""
    separator = _separator(record.lines[start])
    block = record.lines[start:]
    if separator is not None and {line.count(separator) for line in block} == {count - 1}:
        # The usual CSV, in one go: the numbers may keep the blanks around them.
        tokens = separator.join(block).split(separator)
        rows = list(range(start, len(record.lines)))
    else:
        tokens, rows = _ragged(record, start, count, separator)
    values = convert(record, tokens, _LineOfRow(rows, count))
    return values.reshape(len(rows), count), rows, tokens[::count]


def _ragged(
    record: RecordFile, start: int, count: int, separator: str | None
) -> tuple[list[str], list[int]]:
    """Tokens and the line of each row, where lines may be blank or end in a separator."""
    tokens: list[str] = []
    rows: list[int] = []
    for index in range(start, len(record.lines)):
        fields = _split(record.lines[index], separator)
        if not fields or fields == [""]:
            continue  # a blank line; a missing sample shows in the time column
        if len(fields) != count:
            raise record.fault(
                f"has {len(fields)} column{'s' if len(fields) > 1 else ''}, "
                f"the rows above have {count}; the file is damaged or cut off",
                index,
            )
        tokens += fields
        rows.append(index)
    return tokens, rows


class _LineOfRow(Sequence[int]):
    """Line index of each token, `count` tokens to a row."""

    def __init__(self, rows: list[int], count: int) -> None:
        self._rows, self._count = rows, count

    def __len__(self) -> int:
        return len(self._rows) * self._count

    def __getitem__(self, place: int) -> int:  # type: ignore[override]
        return self._rows[place // self._count]


def _time_step(
    record: RecordFile, time: NDArray[np.float64], rows: list[int], text: list[str]
) -> float:
    """The constant step of the time column, in its own unit.

    Times are printed to so many digits: each step may differ from the mean one by the last
    printed digit, or by 1 %, not more.
    """
    dt = float((time[-1] - time[0]) / (len(time) - 1))
    if not dt > 0.0:
        raise record.fault(
            f"the time column runs from {time[0]:g} to {time[-1]:g}; it must increase", rows[0]
        )
    # The finest digit printed at either end: early times may be written with fewer digits
    # ("0"), late ones lose some where the number of significant digits is fixed.
    resolution = max(
        min(_last_digit(token) for token in text[:20]),
        min(_last_digit(token) for token in text[-20:]),
    )
    steps = np.diff(time)
    usual = float(np.median(steps))
    tolerance = min(max(1.01 * resolution, 0.01 * dt), 0.45 * dt)
    wrong = np.flatnonzero(np.abs(steps - usual) > tolerance)
    if wrong.size:
        place = int(wrong[0])
        raise record.fault(
            f"the time step from {time[place]:g} to {time[place + 1]:g} is {steps[place]:.6g}, "
            f"elsewhere {usual:.6g}: a gap or an uneven record; fill or resample it first",
            rows[place + 1],
        )
    drift = np.abs(time - time[0] - dt * np.arange(len(time)))
    if float(np.max(drift)) > 0.5 * max(dt, resolution):
        raise record.fault(
            "the time steps change along the record; resample it to a constant step first",
            rows[int(np.argmax(drift))],
        )
    return dt


def _last_digit(token: str) -> float:
    """Value of one unit in the last printed digit of a number."""
    match = _DECIMAL.fullmatch(token.strip())
    if match is None:
        return 0.0
    power = int(match.group(2) or 0) - len(match.group(1))
    return float(10.0 ** min(max(power, -300), 300))


def _short(dt: float) -> float:
    """`dt` without the rounding noise of the division that made it."""
    return float(f"{dt:.10g}")


def _names_and_units(
    record: RecordFile, start: int, count: int
) -> tuple[list[str], list[str | None]]:
    """Names and units of the columns from the last line above the numbers that fits."""
    for index in range(start - 1, -1, -1):
        line = record.lines[index].strip().strip("#%/!").strip()
        if not line:
            continue
        bracketed = _BRACKETS.findall(line)
        if len(bracketed) == count:
            names = [name.strip(" \t,;:\"'") for name, _ in bracketed]
            return names, [unit.strip() or None for _, unit in bracketed]
        fields = [field.strip("\"'") for field in _split(line, _separator(line))]
        if len(fields) == count:
            return fields, [_unit_of_name(field) for field in fields]
        break
    return [""] * count, [None] * count


def _unit_of_name(name: str) -> str | None:
    """The unit in a column's name: in brackets, or what follows an underscore."""
    match = _BRACKETS.search(name)
    if match:
        return match.group(2).strip() or None
    parts = name.split("_")
    for first in range(1, len(parts)):
        unit = "_".join(parts[first:])
        known = unit_table.acceleration_factor(unit) or unit_table.time_factor(unit)
        if known is not None:
            return unit
    return None
