"""COSMOS strong-motion format, version 1.20 and its kin: one or more channels in one file.

A channel: the lines of text announced in its first line, integer headers, real headers and
comments, each announced with count and Fortran format, then a line such as
"7000  acceleration pts, approx   70 secs, units=cm/sec2(04),Format=(8F10.5)", the values, and an
end mark "/&".  The time step is real header 62, in milliseconds.

COSMOS (2001), "COSMOS strong motion data format", COSMOS, Richmond, California.
"""

from __future__ import annotations

import re
from functools import partial

import numpy as np

from railquake.inputs.ground_motion.text import (
    NUMBER,
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    fixed_numbers,
    free_numbers,
    lines_used,
    peak_note,
    shown,
    unit_of_file,
)

STEP_HEADER = 62
"""Number of the real header that holds the time step, ms."""
PEAK_HEADER = 64
"""Number of the real header that holds the peak of the data."""

_FIRST = re.compile(r"\(Format v[0-9.]+ with\s+([0-9]{1,3})\s+text lines\)", re.IGNORECASE)
_HEADERS = re.compile(
    r"^\s*([0-9]{1,4})\s+(?:Integer|Real)-header values follow on\s+([0-9]{1,4})\s+lines?.*"
    r"Format\s*=\s*\(([0-9]{1,3})[IFEG]([0-9]{1,2})(?:\.[0-9]+)?\)",
    re.IGNORECASE,
)
_COMMENTS = re.compile(r"^\s*([0-9]{1,4})\s+Comment line", re.IGNORECASE)
_DATA = re.compile(
    r"^\s*([0-9]{1,9})\s+(\w+)\s+(?:pts|points|values)\b(.*?)units\s*=\s*([^\s,(]+)\s*"
    r"(?:\(\s*[0-9]+\s*\))?\s*,\s*Format\s*=\s*\(\s*[0-9]{1,3}[FEGI]([0-9]{1,2})(?:\.[0-9]+)?\s*\)",
    re.IGNORECASE,
)
_LENGTH = re.compile(rf"approx\s+({NUMBER})\s*sec", re.IGNORECASE)
_CHANNEL = re.compile(r"\bSta\s+Chan?\s*:?\s*([0-9]{1,4})\s*:\s*(.*?)(?:\s*\(|$)", re.IGNORECASE)
_MISSING = re.compile(rf"unknown/unspecified\s*:\s*{NUMBER}\s*,\s*({NUMBER})", re.IGNORECASE)


def is_cosmos(record: RecordFile) -> bool:
    """Whether the first line announces the text lines of a COSMOS header."""
    return _FIRST.search(record.lines[0]) is not None


def cosmos_channels(record: RecordFile, options: Options) -> list[Channel]:
    """All acceleration channels of the file.

    Raises
    ------
    InputError
        If there are none, or a header cannot be read.
    """
    starts = [index for index, line in enumerate(record.lines) if _FIRST.search(line)]
    channels: list[Channel] = []
    kinds: list[str] = []
    for start, stop in zip(starts, [*starts[1:], len(record.lines)], strict=True):
        data = next(
            (
                (index, match)
                for index in range(start, stop)
                if (match := _DATA.match(record.lines[index]))
            ),
            None,
        )
        if data is None:
            raise record.fault(
                "no line '... acceleration pts, ... units=..., Format=(...)' follows this "
                "header; the file is cut off or its layout unknown",
                start,
            )
        index, match = data
        kinds.append(match.group(2))
        if not match.group(2).lower().startswith("accel"):
            continue
        number, label = _number_and_label(record, start, index)
        channels.append(
            Channel(number, label, partial(_read, record, options, start, index, match))
        )
    if not channels:
        raise record.fault(f"holds {', '.join(sorted(set(kinds)))[:80]}, not acceleration")
    return channels


def _number_and_label(record: RecordFile, start: int, index: int) -> tuple[int | None, str]:
    for line in record.lines[start:index]:
        match = _CHANNEL.search(line)
        if match:
            return int(match.group(1)), " ".join(match.group(2).split())
    return None, ""


def _read(
    record: RecordFile, options: Options, start: int, index: int, match: re.Match[str]
) -> Series:
    first = record.lines[start]
    count, unit, width = int(match.group(1)), match.group(4), int(match.group(5))
    if count < 2 or width < 2:
        raise record.fault(f"announces {count} points in fields of {width} characters", index)
    if unit.lower().startswith(("count", "volt", "mvolt")):
        raise record.fault(
            f"the data are in {shown(unit)}, not in units of acceleration; use the processed "
            "(V1 or V2) file",
            index,
        )
    factor = unit_of_file(record, unit, options, index)
    reals, line = _real_headers(record, start)
    dt = _time_step(record, reals, line, options)
    length = _LENGTH.search(match.group(3))
    if length:
        seconds = float(length.group(1).replace("D", "E"))
        if abs(count * dt - seconds) > max(1.0 + dt, 0.02 * seconds):
            raise record.fault(
                f"{count} points at {dt:g} s make {count * dt:g} s, the line says about "
                f"{seconds:g} s; the header contradicts itself",
                index,
            )
    values = fixed_numbers(record, index + 1, count, width)
    after = index + 1 + lines_used(count, max(1, len(record.lines[index + 1].rstrip()) // width))
    if after < len(record.lines) and not record.lines[after].lstrip().startswith("/&"):
        raise record.fault(
            f"more follows after the {count} values announced, no end mark '/&'", after
        )
    _no_missing(record, start, index, values, width)
    notes: tuple[str, ...] = ()
    if re.match(r"\s*(uncorrected|raw)\b", first, re.IGNORECASE):
        notes += ("uncorrected (raw) acceleration, taken as it is",)
    if len(reals) >= PEAK_HEADER and reals[PEAK_HEADER - 1] > -990.0:
        peak = float(np.max(np.abs(values)))
        notes += peak_note(peak, float(reals[PEAK_HEADER - 1]), unit, 0.01)
    return Series(dt, values * factor, notes)


def _real_headers(record: RecordFile, start: int) -> tuple[list[float], int]:
    """The real headers and the index of the line that announces them."""
    match = _FIRST.search(record.lines[start])
    assert match is not None, "start is such a line"
    index = start + int(match.group(1))
    values: list[float] = []
    for kind in ("integer", "real"):
        announced = _HEADERS.match(record.line(index))
        if announced is None:
            raise record.fault(f"the {kind} headers should be announced here", index)
        count, lines, _, width = (int(text) for text in announced.groups())
        record.line(index + lines)
        if kind == "integer":
            index += 1 + lines
            continue
        # Some writers let a value grow over its field; blanks then still part the values.
        block = record.lines[index + 1 : index + 1 + lines]
        if sum(len(line.split()) for line in block) == count:
            values = free_numbers(record, index + 1, index + 1 + lines).tolist()
        else:
            values = fixed_numbers(record, index + 1, count, max(width, 1)).tolist()
    return values, index


def _time_step(record: RecordFile, reals: list[float], line: int, options: Options) -> float:
    if len(reals) < STEP_HEADER or reals[STEP_HEADER - 1] <= 0.0:
        if options.dt is not None:
            return check_dt(record, options.dt, options)
        raise record.fault(
            f"real header {STEP_HEADER} (the time step in ms) is missing; give dt", line
        )
    return check_dt(record, 1e-3 * reals[STEP_HEADER - 1], options, line)


def _no_missing(record: RecordFile, start: int, index: int, values: np.ndarray, width: int) -> None:
    """Refuse data in which the header's mark for missing values occurs."""
    mark = -999.0
    for line in record.lines[start:index]:
        match = _MISSING.search(line)
        if match:
            mark = float(match.group(1).replace("D", "E"))
            break
    place = np.flatnonzero(values == mark)
    if mark != 0.0 and place.size:
        per_line = max(1, len(record.lines[index + 1].rstrip()) // width)
        raise record.fault(
            f"sample {int(place[0]) + 1} is {mark:g}, the mark of a missing value: the record "
            "has a gap",
            index + 1 + int(place[0]) // per_line,
        )
