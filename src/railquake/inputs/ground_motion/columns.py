"""Plain text or CSV: time and acceleration in columns, or acceleration alone.

The unit of acceleration comes from the header ("acc (m/s2)", "acc_cm/s2", "# units: cm/s2") or
from the caller; that of "a_g" is taken with a remark only, and the caller's goes before it.  The
time step comes from the time column, else from the header ("dt = 0.01") or the caller.  Columns
whose first one is no time are components.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from railquake.inputs.ground_motion import units as unit_table
from railquake.inputs.ground_motion.column_heads import (
    Heads,
    read_heads,
    stated_count,
    stated_step,
    stated_unit,
)
from railquake.inputs.ground_motion.orientation import vertical_by_label
from railquake.inputs.ground_motion.text import (
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    check_not_cut,
    convert,
    no_marks,
    shown,
    to_float,
    unit_of_file,
)

HEADER_LINES = 200
"""The first row of numbers is looked for within this many lines."""
COMPONENTS = 3
"""So many columns without names or a time are components; others are a list of values."""
MOST_LOOKED_AT, FEWEST_STEPS = 2000, 5
"""Rows in which a time is looked for, and steps below which nothing can be told."""
TIME_INCREASES = 0.8
"""Share of the steps that increase in a column of time, damaged ones included."""

_NOT_FINITE = re.compile(r"[+-]?(?:nan|inf|infinity)|\*+", re.IGNORECASE)
_OTHER_MOTION = re.compile(r"vel(?:oc\w*)?\b|vel_|disp\w*\b|disp_|speed\b", re.IGNORECASE)
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
    heads = read_heads(record, start, count, lambda line: _split(line, _separator(line)))
    timed = count > 1 and _has_time(record, start, count, separator, heads)
    read = partial(_read, record, options, start, heads, timed)
    if count == 1 or (count == 2 and timed):
        return [Channel(None, "", partial(read, count - 1))]
    first = 1 if timed else 0
    return [
        Channel(
            column + 1 - first,
            heads.names[column],
            partial(read, column),
            vertical_by_label(heads.names[column]),
        )
        for column in range(first, count)
    ]


def _has_time(
    record: RecordFile, start: int, count: int, separator: str | None, heads: Heads
) -> bool:
    """Whether the first column is time: by its name, else by whether it increases.

    Raises
    ------
    InputError
        If it is no time and nothing names the columns: then the rows are a list of values.
    """
    if heads.time is not None:
        return heads.time
    unnamed = not any(heads.names)
    rest = len(_split(record.lines[-1], separator))
    wrapped = count >= COMPONENTS and unnamed and (rest < count or start + 1 == len(record.lines))
    column = [
        to_float(fields[0])
        for line in record.lines[start : start + MOST_LOOKED_AT]
        if (fields := _split(line, separator))
    ]
    numbers = [number for number in column if number is not None]
    steps = np.diff(np.array(numbers))
    increases = steps.size > 0 and float(np.mean(steps > 0.0)) >= TIME_INCREASES
    if not (wrapped and not increases):
        if steps.size < FEWEST_STEPS or increases:
            return True
        if count == COMPONENTS or not unnamed:
            return False
    raise record.fault(
        f"has rows of {count} numbers under no names, and the first of them is no time, as it does "
        "not increase: a list of values, it seems; write one value on each line and give units "
        "and dt",
        start,
    )


def _read(
    record: RecordFile,
    options: Options,
    start: int,
    heads: Heads,
    timed: bool,
    column: int,
) -> Series:
    """Read one column of numbers and the time beside it."""
    table, rows, first_column, last_column = _table(record, start, len(heads.names))
    _check_numbers(record, start, heads, column, first_column)
    factor, notes = _factor(record, options, start, heads, column)
    head = record.lines[:start]
    check_not_cut(record, last_column)
    no_marks(record, table[:, column])
    step = stated_step(head)
    if not timed:
        if step is not None:
            dt = check_dt(record, step[0], options, step[1])
        elif options.dt is not None:
            dt = check_dt(record, options.dt, options)
        else:
            raise record.fault(
                f"has {'one column' if len(heads.names) == 1 else 'components'} and no time; give "
                "the time step, dt = 0.01 for example"
            )
        if len(heads.names) > 1:
            notes += (f"{len(heads.names)} columns without a time: each taken for a component",)
        return Series(dt, table[:, column] * factor, notes)
    to_seconds: float | None = 1.0
    if heads.units[0] is None:
        notes += ("the header states no unit of time: seconds taken",)
    else:
        to_seconds = unit_table.time_factor(heads.units[0])
    if to_seconds is None:
        raise record.fault(
            f"the first column is in {shown(str(heads.units[0]))}; time in s is expected there",
            start - 1,
        )
    dt = to_seconds * _time_step(record, table[:, 0], rows, first_column)
    dt = check_dt(record, _short(dt), options)
    if step is not None and abs(step[0] - dt) > 0.01 * dt:
        raise record.fault(
            f"states a time step of {step[0]:g} s, and the time column has {dt:g} s; correct one",
            step[1],
        )
    begin = float(table[0, 0]) * to_seconds
    if abs(begin) > 1.5 * dt:
        notes += (f"the file's time starts at {begin:g} s, the motion's at 0",)
    return Series(dt, table[:, column] * factor, notes)


def _check_numbers(
    record: RecordFile, start: int, heads: Heads, column: int, first_column: Sequence[str]
) -> None:
    """That there are as many numbers as the file says, and of an acceleration."""
    rows = len(first_column)
    if rows < 2:
        raise record.fault("has a single row of numbers; a record needs at least two", start)
    if _OTHER_MOTION.match(heads.names[column]):
        raise record.fault(
            f"the column {shown(heads.names[column])} holds no acceleration; choose another", start
        )
    if len(heads.names) == 1 and first_column[0] == str(rows - 1):
        raise record.fault(
            f"its first value, {first_column[0]}, is the number of those that follow; remove it, "
            f"or write '{first_column[0]} DT' there",
            start,
        )
    count = stated_count(record.lines[:start])
    if count is not None and count[0] != rows:
        raise record.fault(
            f"announces {count[0]} values and has {rows}; the file is cut off or its header "
            "wrong: fetch it again",
            count[1],
        )


def _factor(
    record: RecordFile, options: Options, start: int, heads: Heads, column: int
) -> tuple[float, tuple[str, ...]]:
    """Factor to m/s2 of a column, and a remark where its unit is not certain."""
    stated, name = heads.units[column], heads.names[column]
    if stated is not None and heads.certain[column]:
        return unit_of_file(record, stated, options), ()
    written = stated_unit(record, start)
    if written is not None or stated is None:
        return unit_of_file(record, written, options), ()
    if options.units is not None:
        remark = (
            f"the unit {options.units} given is used; the column's name {shown(name)} says none"
        )
        return unit_of_file(record, None, options), (remark,)
    remark = (
        f"unit {stated} taken from the column's name {shown(name)}, which may mean something else: "
        "give units to be sure"
    )
    return unit_of_file(record, stated, options), (remark,)


def _separator(line: str) -> str | None:
    """What stands between the fields of a line; None for blanks."""
    for separator in (";", ",", "\t"):
        if separator in line:
            return separator
    return None


def _split(line: str, separator: str | None) -> list[str]:
    """Fields of a line; a separator at the very end ends the last field."""
    if separator is None:
        return line.replace('"', " ").split()
    fields = [field.strip().strip('"').strip() for field in line.split(separator)]
    if len(fields) > 1 and not fields[-1]:
        fields.pop()
    return fields


def _table(
    record: RecordFile, start: int, count: int
) -> tuple[NDArray[np.float64], list[int], list[str], list[str]]:
    """All rows: the numbers (rows, count), the line of each, first and last column as text."""
    separator = _separator(record.lines[start])
    block = record.lines[start:]
    quoted = any('"' in line for line in block)
    if (
        separator is not None
        and not quoted
        and {line.count(separator) for line in block} == {count - 1}
    ):
        # The usual CSV, in one go: the numbers may keep the blanks around them.
        tokens = separator.join(block).split(separator)
        rows = list(range(start, len(record.lines)))
    else:
        tokens, rows = _ragged(record, start, count, separator)
    values = convert(record, tokens, _LineOfRow(rows, count))
    return values.reshape(len(rows), count), rows, tokens[::count], tokens[count - 1 :: count]


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
