"""USGS SMC files: 11 lines of text, 48 integers, 50 reals, comments, then the values.

The values of an accelerogram are in cm/s2, in fields of 10 characters, eight to a line and with
no blank between, or, as some converters write them, in fields of 14 (5E14.7), five to a line.  The
sampling rate is real header 2, the number of values integer header 17; integer header 13 is the
angle of the sensor from the vertical, 18 the flag of problems.

The layout is that of the U.S. Geological Survey's National Strong-Motion Program ("SMC format").
"""

from __future__ import annotations

import re

import numpy as np

from railquake.inputs.ground_motion.orientation import vertical_by_label
from railquake.inputs.ground_motion.text import (
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    fixed_numbers,
    peak_note,
    shown,
    unit_of_file,
)

TEXT_LINES = 11
INTEGERS, INTEGERS_PER_LINE, INTEGER_WIDTH = 48, 8, 10
REALS, REALS_PER_LINE, REAL_WIDTH = 50, 5, 15
VALUE_WIDTH, WIDE_VALUE = 10, 14
FROM_VERTICAL_HEADER, FLAG_HEADER = 13, 18

_FIRST = re.compile(
    r"^\s*([0-6])\s+(?:(?:UN)?(?:CORRECTED|PROCESSED|KNOWN)|VELOCITY|DISPLACEMENT|RESPONSE)",
    re.IGNORECASE,
)
_WIDE_LINE = re.compile(r"(?:[ +-]{1,2}[0-9]?\.[0-9]{7,8}E[+-][0-9]{2}){1,5}", re.IGNORECASE)
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
    return [Channel(None, label, lambda: read_smc(record, options), _vertical(record, label))]


def _vertical(record: RecordFile, label: str) -> bool | None:
    """From the sensor's angle, else from the label."""
    integers = fixed_numbers(record, TEXT_LINES, INTEGERS, INTEGER_WIDTH)
    angle = integers[FROM_VERTICAL_HEADER - 1]
    if angle in (0.0, 180.0):
        # A label with an azimuth ("360") is the surer sign where the two disagree.
        return vertical_by_label(label) is not False
    return False if angle == 90.0 else vertical_by_label(label)


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
        remedy = "; if it is one, correct the first line" if kind == 0 else ""
        raise record.fault(
            f"is an SMC file of type {kind} ({shown(first.group(0).strip())}); an accelerogram (1 "
            f"or 2) is needed{remedy}",
            0,
        )
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
    wide = _WIDE_LINE.fullmatch(record.line(start).rstrip()) is not None
    width = WIDE_VALUE if wide else VALUE_WIDTH
    values = fixed_numbers(record, start, count, width)
    after = start + -(-count // max(1, len(record.lines[start].rstrip()) // width))
    if after < len(record.lines):
        raise record.fault(f"more follows after the {count} values announced", after)
    notes: tuple[str, ...] = ()
    if kind == 1:
        notes += ("uncorrected accelerogram, taken as it is",)
    if wide:
        notes += ("values in fields of 14 characters (5E14.7), not the usual 10",)
    if integers[FLAG_HEADER - 1] == 1.0:
        notes += ("the agency flags a problem with this record; see the comments in the file",)
    extremes = [abs(float(reals[place])) for place in (29, 31) if abs(reals[place]) < 1e30]
    if extremes:
        notes += peak_note(float(np.max(np.abs(values))), max(extremes), "cm/s2", 0.01)
    return Series(dt, values * factor, notes)
