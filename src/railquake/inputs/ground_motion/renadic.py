"""RENADIC (Universidad de Chile): uncorrected Volume 1 in blocks, pairs of time and acceleration.

A component: lines of text up to the one on the RMS acceleration, 100 integers (16 to a line), 50
reals (8 to a line), then pairs of time (s) and acceleration (g/10) in fields of 7 characters, five
pairs to a line, and an end mark "/&".
"""

from __future__ import annotations

import re
from functools import partial

import numpy as np

from railquake.inputs.ground_motion.motion import STANDARD_GRAVITY
from railquake.inputs.ground_motion.orientation import vertical_by_label
from railquake.inputs.ground_motion.text import (
    NUMBER,
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    first_match,
    fixed_numbers,
    lines_used,
    no_marks,
    peak_note,
    to_float,
    unit_of_file,
    whole_number,
)
from railquake.inputs.ground_motion.usc import (
    INTEGERS,
    INTEGERS_PER_LINE,
    REALS,
    REALS_PER_LINE,
    resampled_pairs,
)

FIELD_WIDTH, PAIRS_PER_LINE = 7, 5
HEADER_LINES = 40
TIME_DIGIT = 1.1e-3
"""Times are printed to the millisecond: steps may differ by one of it."""

_FIRST = re.compile(r"^\s*UNCORRECTED ACCELEROGRAM DATA\b", re.IGNORECASE)
_UNITS = re.compile(r"UNITS OF UNCOR\w* ACC\w* ARE SEC AND ([^\s.,]+)", re.IGNORECASE)
_PEAK = re.compile(rf"\bMAX\s*=\s*({NUMBER})\s*G\b", re.IGNORECASE)
_POINTS = re.compile(r"NO\. OF POINTS\s*=\s*([0-9]{1,9})\b", re.IGNORECASE)
_CHANNEL = re.compile(r"^\s*CHAN\s+([0-9]{1,4})\s*:\s*([^(]*?)\s*(?:\(|$)", re.IGNORECASE)
_LAST_TEXT = re.compile(r"\bRMS ACC", re.IGNORECASE)


def is_renadic(record: RecordFile) -> bool:
    """Whether the first line heads uncorrected data and a line gives its units."""
    if not _FIRST.match(record.lines[0]):
        return False
    return any(_UNITS.search(line) for line in record.lines[:HEADER_LINES])


def renadic_channels(record: RecordFile, options: Options) -> list[Channel]:
    """All components of the file."""
    channels: list[Channel] = []
    for start, line in enumerate(record.lines):
        if _FIRST.match(line):
            text = record.lines[start : start + HEADER_LINES]
            found = first_match(_CHANNEL, text)
            number = int(found.group(1)) if found else len(channels) + 1
            label = found.group(2) if found else ""
            read = partial(_read, record, options, start)
            channels.append(Channel(number, label, read, vertical_by_label(label)))
    return channels


def _read(record: RecordFile, options: Options, start: int) -> Series:
    header = record.lines[start : start + HEADER_LINES]
    last = next((i for i, line in enumerate(header) if _LAST_TEXT.search(line)), None)
    if last is None:
        raise record.fault("the header lacks the line 'RMS ACCEL ...'", start)
    text = "\n".join(header[: last + 1])
    points, units, peak = (pattern.search(text) for pattern in (_POINTS, _UNITS, _PEAK))
    count = whole_number(record, points.group(1) if points else "", "NO. OF POINTS", start)
    factor = unit_of_file(record, units.group(1) if units else None, options)
    first = (
        start + last + 1
        + lines_used(INTEGERS, INTEGERS_PER_LINE) + lines_used(REALS, REALS_PER_LINE)
    )  # fmt: skip
    pairs = fixed_numbers(record, first, 2 * count, FIELD_WIDTH).reshape(count, 2)
    after = first + lines_used(2 * count, PAIRS_PER_LINE * 2)
    if after < len(record.lines) and not re.match(r"\s*(?:/&|$)", record.lines[after]):
        raise record.fault(f"more follows after the {count} points announced", after)
    time, values = pairs[:, 0], pairs[:, 1]
    no_marks(record, values)
    stated = to_float(peak.group(1)) if peak else None
    in_g = float(np.max(np.abs(values))) * factor / STANDARD_GRAVITY
    remarks = () if stated is None else peak_note(in_g, stated, "g", 0.001)
    steps = np.diff(time)
    dt = float(f"{(time[-1] - time[0]) / (count - 1):.6g}")
    if dt > 0.0 and float(np.max(np.abs(steps - dt))) <= min(TIME_DIGIT, 0.45 * dt):
        dt = check_dt(record, dt, options)
        notes = ("uncorrected Volume 1 data: no baseline or instrument correction", *remarks)
        return Series(dt, values * factor, notes)
    if options.dt is None:
        raise record.fault(
            "RENADIC Volume 1: unevenly sampled; give dt = 0.005 to have it resampled to that step",
            start,
        )
    series = resampled_pairs(record, time, values, factor, options.dt)
    return Series(series.dt, series.acceleration, (*series.notes, *remarks))
