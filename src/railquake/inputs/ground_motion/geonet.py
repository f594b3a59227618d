"""GeoNet's (GNS Science, New Zealand) Volumes 1 and 2: .V1A and .V2A, three components a file.

A component: 16 lines of text, 4 of 10 integers, 6 of 10 reals, then arrays of 10 fields of 8
characters a line, each begun on a new line: acceleration in mm/s2; in Volume 2 velocity (mm/s) and
displacement (mm) follow.
"""

from __future__ import annotations

import re
from functools import partial

import numpy as np

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

TEXT_LINES, INTEGER_LINES, REAL_LINES = 16, 4, 6
PER_LINE, FIELD_WIDTH = 10, 8
STEP_REALS = (25, 24)
"""Real headers, counted from 0, that hold the time step: of the data, of the raw record."""

_FIRST = re.compile(r"^\s*(un)?corrected accelerogram\b", re.IGNORECASE)
_POINTS = re.compile(r"Number of points\s+([0-9]{1,9})", re.IGNORECASE)
_DURATION = re.compile(rf"Duration\s+({NUMBER})\s*s", re.IGNORECASE)
_INTERVAL = re.compile(rf"data at\s+({NUMBER})\s*s\w*\s+intervals?", re.IGNORECASE)
_COMPONENT = re.compile(r"^\s*Component\s+(\S+)", re.IGNORECASE)
_PEAK = re.compile(rf"^\s*Acceleration:?\s+peak\s+({NUMBER})\s*(\S+)", re.IGNORECASE)


def is_geonet(record: RecordFile) -> bool:
    """Whether the first line heads an accelerogram and the text gives its peak in mm/s/s."""
    if not _FIRST.match(record.lines[0]):
        return False
    return any(
        (match := _PEAK.match(line)) and match.group(2).lower() == "mm/s/s"
        for line in record.lines[:TEXT_LINES]
    )


def geonet_channels(record: RecordFile, options: Options) -> list[Channel]:
    """All components of the file."""
    starts = [index for index, line in enumerate(record.lines) if _FIRST.match(line)]
    channels = []
    for number, (start, stop) in enumerate(
        zip(starts, [*starts[1:], len(record.lines)], strict=True), 1
    ):
        text = record.lines[start : start + TEXT_LINES]
        component = first_match(_COMPONENT, text)
        label = component.group(1) if component else ""
        channels.append(
            Channel(
                number,
                label,
                partial(_read, record, options, start, stop),
                vertical_by_label(label),
            )
        )
    return channels


def _read(record: RecordFile, options: Options, start: int, stop: int) -> Series:
    lines = record.lines[start : start + TEXT_LINES]
    text = "\n".join(lines)
    points = _POINTS.search(text)
    count = whole_number(record, points.group(1) if points else "", "Number of points", start)
    peak = first_match(_PEAK, lines)
    if peak is None:
        raise record.fault("the header lacks 'Acceleration: peak ... mm/s/s'", start)
    factor = unit_of_file(record, peak.group(2), options)
    first = start + TEXT_LINES + INTEGER_LINES + REAL_LINES
    dt = check_dt(record, _time_step(record, text, start, count), options)
    volume = _FIRST.match(record.lines[start])
    corrected = volume is not None and volume.group(1) is None
    # Volume 2 holds three arrays: were the file to end before, its first would not be whole either.
    arrays = 3 if corrected else 1
    needed, found = arrays * lines_used(count, PER_LINE), stop - first
    if found != needed:
        raise record.fault(
            f"{count} points are announced, which take {needed} lines"
            f"{' of acceleration, velocity and displacement' if corrected else ''}, and {found} "
            "are there; the file is cut off or its header wrong: fetch it again",
            start,
        )
    values = fixed_numbers(record, first, count, FIELD_WIDTH)
    no_marks(record, values)
    notes: tuple[str, ...] = ()
    if not corrected:
        notes += ("uncorrected accelerogram, taken as it is",)
    stated = to_float(peak.group(1))
    if stated is not None:
        notes += peak_note(float(np.max(np.abs(values))), stated, "mm/s2", 0.1)
    return Series(dt, values * factor, notes)


def _time_step(record: RecordFile, text: str, start: int, count: int) -> float:
    """Time step, s: what the text states or, where it does not, a real header that fits."""
    stated = _INTERVAL.search(text)
    length = _DURATION.search(text)
    seconds = (to_float(length.group(1)) if length else None) or 0.0
    if stated is not None:
        steps = [to_float(stated.group(1)) or 0.0]
    else:
        first = start + TEXT_LINES + INTEGER_LINES
        record.line(first + REAL_LINES - 1)
        reals = fixed_numbers(record, first, REAL_LINES * PER_LINE, FIELD_WIDTH)
        steps = [float(reals[place]) for place in STEP_REALS]
    # The duration is that between the first and the last point; some round it to full steps.
    fitting = [
        step for step in steps if step > 0.0 and abs(count * step - seconds) < 1.5 * step + 0.006
    ]
    if fitting:
        return fitting[0]
    raise record.fault(
        f"{count} points and a duration of {seconds:g} s do not agree with a time step of "
        f"{' or '.join(f'{step:g}' for step in steps)} s; the header contradicts itself",
        start,
    )
