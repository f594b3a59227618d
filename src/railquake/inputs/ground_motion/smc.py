"""USGS SMC files: 11 lines of text, 48 integers, 50 reals, comments, then the values.

The values of an accelerogram are in cm/s2, in fields of 10 characters, eight to a line and with
no blank between; the sampling rate is real header 2, the number of values integer header 17.

The layout is that of the U.S. Geological Survey's National Strong-Motion Program ("SMC format").
"""

from __future__ import annotations

import re

import numpy as np

from railquake.inputs.ground_motion.text import (
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    fixed_numbers,
    peak_note,
    unit_of_file,
)

TEXT_LINES = 11
INTEGERS, INTEGERS_PER_LINE, INTEGER_WIDTH = 48, 8, 10
REALS, REALS_PER_LINE, REAL_WIDTH = 50, 5, 15
VALUE_WIDTH = 10

_FIRST = re.compile(
    r"^\s*([1-6])\s+(?:UN)?(?:CORRECTED|PROCESSED|VELOCITY|DISPLACEMENT|RESPONSE)", re.IGNORECASE
)
_COMPONENT = re.compile(r"component\s*=\s*(.*\S)", re.IGNORECASE)


def is_smc(record: RecordFile) -> bool:
    """Whether the file starts as an SMC file: its type, then a line with an asterisk."""
    if len(record.lines) < 2 or not _FIRST.match(record.lines[0]):
        return False
    return record.lines[1].lstrip().startswith("*")


def smc_channels(record: RecordFile, options: Options) -> list[Channel]:
    """The one channel of an SMC file."""
    label = ""
    for line in record.lines[:TEXT_LINES]:
        match = _COMPONENT.search(line)
        if match:
            label = " ".join(match.group(1).split())
    return [Channel(None, label, lambda: read_smc(record, options))]


def read_smc(record: RecordFile, options: Options) -> Series:
    """Read an SMC accelerogram.

    Raises
    ------
    InputError
        If it is a velocity, displacement or spectrum, or headers and values do not agree.
    """
    first = _FIRST.match(record.lines[0])
    assert first is not None, "is_smc comes first"
    kind = int(first.group(1))
    if kind not in (1, 2):
        raise record.fault(f"is an SMC file of type {kind}; an accelerogram (1 or 2) is needed", 0)
    start = TEXT_LINES
    integers = fixed_numbers(record, start, INTEGERS, INTEGER_WIDTH)
    start += INTEGERS // INTEGERS_PER_LINE
    reals = fixed_numbers(record, start, REALS, REAL_WIDTH)
    start += REALS // REALS_PER_LINE
    count = int(integers[16]) if abs(integers[16]) < 1e9 else -1
    if count < 2 or count != integers[16]:
        raise record.fault(
            f"integer header 17 (number of values) is {integers[16]:g}; at least 2 is needed",
            TEXT_LINES + 2,
        )
    rate = float(reals[1])
    if not 0.0 < rate < 1e6:
        raise record.fault(
            f"real header 2 (samples a second) is {rate:g}; the record cannot be used",
            TEXT_LINES + INTEGERS // INTEGERS_PER_LINE,
        )
    dt = check_dt(record, 1.0 / rate, options)
    factor = unit_of_file(record, "cm/s2", options)
    while record.line(start).startswith("|"):
        start += 1
    values = fixed_numbers(record, start, count, VALUE_WIDTH)
    after = start + -(-count // max(1, len(record.lines[start].rstrip()) // VALUE_WIDTH))
    if after < len(record.lines):
        raise record.fault(f"more follows after the {count} values announced", after)
    notes: tuple[str, ...] = ()
    if kind == 1:
        notes += ("uncorrected accelerogram, taken as it is",)
    extremes = [abs(float(reals[place])) for place in (29, 31) if abs(reals[place]) < 1e30]
    if extremes:
        notes += peak_note(float(np.max(np.abs(values))), max(extremes), "cm/s2", 0.01)
    return Series(dt, values * factor, notes)
