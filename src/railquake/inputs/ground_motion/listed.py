"""A line "NPTS DT" and the values in any layout: the text of eqsig and of OpenSees' examples.

"400 0.0100", or "0.0100 400", stands alone on the first line of numbers; names and
remarks may stand above it.
"""

from __future__ import annotations

import re

from railquake.inputs.ground_motion import units as unit_table
from railquake.inputs.ground_motion.text import (
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    check_not_cut,
    free_numbers,
    last_tokens,
    no_marks,
    to_float,
    unit_of_file,
    whole_number,
)

HEADER_LINES = 20
LONGEST_STEP = 0.5
"""A larger second number is no time step of a record, s."""

_STEP = r"([0-9]*\.[0-9]+(?:[eE][+-]?[0-9]+)?)"
_HEAD = re.compile(rf"^\s*([0-9]{{1,9}})[\s,]+{_STEP}\s*$")
_TURNED = re.compile(rf"^\s*{_STEP}[\s,]+([0-9]{{1,9}})\s*$")


def is_listed(record: RecordFile) -> bool:
    """Whether the first line of numbers is a count and a step, and others are unlike it."""
    index = _head_line(record)
    if index is None or index + 1 >= len(record.lines):
        return False
    below = [line.split() for line in record.lines[index + 1 : index + 4] if line.strip()]
    # Two numbers a line below are two columns, of which this is the first row, unless the count
    # is that of all values.
    if below and all(len(row) == 2 for row in below):
        tokens = sum(len(line.split()) for line in record.lines[index + 1 :])
        return tokens == int(_count_and_step(record.lines[index])[0])
    return bool(below)


def listed_channels(record: RecordFile, options: Options) -> list[Channel]:
    """The one channel."""
    return [Channel(None, "", lambda: read_listed(record, options))]


def read_listed(record: RecordFile, options: Options) -> Series:
    """Read a list of values headed by their number and time step.

    Raises
    ------
    InputError
        If the number of values is another, or no unit is known.
    """
    index = _head_line(record)
    assert index is not None, "is_listed comes first"
    number, step = _count_and_step(record.lines[index])
    count = whole_number(record, number, "number of values", index)
    dt = check_dt(record, to_float(step) or 0.0, options, index)
    stated = unit_table.unit_statements(record.lines[:index])
    values = free_numbers(record, index + 1)
    if values.size != count:
        raise record.fault(
            f"line {index + 1} announces {count} values at steps of {dt:g} s, and {values.size} "
            "follow; the file is cut off, or that line means something else"
        )
    check_not_cut(record, last_tokens(record, index + 1))
    factor = unit_of_file(record, stated[0] if stated else None, options)
    no_marks(record, values)
    head = record.lines[index].strip()
    note = f"'{head}' in line {index + 1} taken for number and step of the values"
    return Series(dt, values * factor, (note,))


def _head_line(record: RecordFile) -> int | None:
    for index, line in enumerate(record.lines[:HEADER_LINES]):
        fields = line.replace(",", " ").split()
        if fields and all(to_float(field) is not None for field in fields):
            number, step = _count_and_step(line)
            right = number and int(number) >= 2 and 0.0 < (to_float(step) or 0.0) <= LONGEST_STEP
            return index if right else None
    return None


def _count_and_step(line: str) -> tuple[str, str]:
    """The two as written, in this order; empty where the line is another."""
    match = _HEAD.match(line)
    if match:
        return match.group(1), match.group(2)
    match = _TURNED.match(line)
    return (match.group(2), match.group(1)) if match else ("", "")
