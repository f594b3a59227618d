"""COSMOS strong-motion format, version 1.20 and its kin: one or more channels in one file.

A channel: the lines of text announced in its first line, integer headers, real headers and
comments, each announced with count and Fortran format, then a line such as
"7000  acceleration pts, approx   70 secs, units=cm/sec2(04),Format=(8F10.5)", the values, and an
end mark, "/&" or "End-of-data for Chan 1 acceleration".  Several parts (acceleration, velocity,
displacement) may stand behind one header.  The time step is real header 62, in milliseconds.

COSMOS (2001), "COSMOS strong motion data format", COSMOS, Richmond, California; its tables, as of
the CESMD: integer header 54 is the sensor's azimuth (400 up, 401 down, 402 vertical), 76 the flag
of problems (1 fixed, 2 not fixed).
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from railquake.inputs.ground_motion.orientation import vertical_by_label
from railquake.inputs.ground_motion.text import (
    NUMBER,
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    fixed_numbers,
    free_numbers,
    peak_note,
    shown,
    unit_of_file,
)

STEP_HEADER = 62
"""Number of the real header that holds the time step, ms."""
PEAK_HEADER = 64
"""Number of the real header that holds the peak of the data."""
AZIMUTH_HEADER = 54
"""Number of the integer header that holds the sensor's orientation."""
FLAG_HEADER = 76
"""Number of the integer header that tells of problems."""
VERTICAL = (400, 401, 402)
"""Up, down, vertical without a sense."""
HORIZONTAL = (500, 501, 600, 601, 700, 701)
"""Radial, transverse, longitudinal, tangential, horizontal of unknown azimuth."""
FLAGS = {
    1: "the agency flags a problem, which it has fixed; see the comments in the file",
    2: "the agency flags a problem that is NOT fixed; see the comments in the file",
}

_FIRST = re.compile(r"\(Format v[0-9.]+ with\s+([0-9]{1,3})\s+text lines\)", re.IGNORECASE)
_FORMAT = r"Format\s*=\s*\(\s*([0-9]{0,3})\s*\(?\s*(?:1P,?)?\s*[0-9]{0,3}[IFEGD]([0-9]{1,2})"
_HEADERS = re.compile(
    r"^\s*([0-9]{1,4})\s+(Integer|Real)-header values follow on\s+([0-9]{1,4})\s+lines?\b.*"
    + _FORMAT,
    re.IGNORECASE,
)
_DATA = re.compile(
    r"^\s*([0-9]{1,9})\s+([a-z][\w .]{0,40}?)\s+(?:pts|points|values)\b(.{0,200}?)"
    r"\bunits\s*=\s*([^,(=]{0,30}?)\s*(?:\(\s*([0-9]{1,3})\s*\))?\s*,?\s*" + _FORMAT,
    re.IGNORECASE,
)
_END = re.compile(r"^\s*(?:/&|end[- ]of[- ]data\b)", re.IGNORECASE)
_LENGTH = re.compile(rf"approx\.?\s+({NUMBER})\s*sec", re.IGNORECASE)
_CHANNEL = re.compile(r"\bSta\s+Chan?\s*:?\s*([0-9]{1,4})\s*:\s*(.*?)(?:\s*\(|$)", re.IGNORECASE)
_MISSING = re.compile(rf"unknown/unspecified\s*:\s*{NUMBER}\s*,\s*({NUMBER})", re.IGNORECASE)
_NOT_MEASURED = ("count", "volt", "mvolt")


@dataclass(frozen=True)
class _Header:
    """One header: where it starts, and what its numbered values are."""

    start: int
    integers: list[float]
    reals: list[float]
    line: int


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
        parts = [
            (index, match)
            for index in range(start, stop)
            if (match := _DATA.match(record.lines[index]))
        ]
        if not parts:
            raise record.fault(
                "no line '... acceleration pts, ... units=..., Format=(...)' follows this "
                "header; the file is cut off or its layout unknown",
                start,
            )
        kinds += [" ".join(match.group(2).split()) for _, match in parts]
        wanted = [(index, match) for index, match in parts if _is_acceleration(match.group(2))]
        number, label = _number_and_label(record, start, parts[0][0])
        for index, match in wanted:
            kind = " ".join(match.group(2).split()) if len(wanted) > 1 else ""
            channels.append(
                Channel(
                    number,
                    " ".join(filter(None, (label, kind))),
                    partial(_read, record, options, start, index, match, stop),
                    _vertical(record, start, label),
                )
            )
    if not channels:
        raise record.fault(f"holds {', '.join(sorted(set(kinds)))[:80]}, not acceleration")
    return channels


def _is_acceleration(kind: str) -> bool:
    """Whether "acceleration", "raw accel." or "uncor acceleration" heads the data."""
    return re.search(r"\bacc(?:el\w*)?\b", kind, re.IGNORECASE) is not None


def _number_and_label(record: RecordFile, start: int, index: int) -> tuple[int | None, str]:
    for line in record.lines[start:index]:
        match = _CHANNEL.search(line)
        if match:
            return int(match.group(1)), " ".join(match.group(2).split())
    return None, ""


def _vertical(record: RecordFile, start: int, label: str) -> bool | None:
    """From the sensor's orientation among the integer headers, else from the label."""
    match = _FIRST.search(record.lines[start])
    assert match is not None, "start is such a line"
    index = start + int(match.group(1))
    announced = _HEADERS.match(record.line(index))
    if announced is not None:
        values = _header_values(record, index, announced)
        azimuth = values[AZIMUTH_HEADER - 1] if len(values) >= AZIMUTH_HEADER else -999.0
        if azimuth in VERTICAL:
            return True
        if azimuth in HORIZONTAL or 1.0 <= azimuth <= 360.0:
            return False
    return vertical_by_label(label)


def _read(
    record: RecordFile,
    options: Options,
    start: int,
    index: int,
    match: re.Match[str],
    stop: int,
) -> Series:
    count, unit, width = int(match.group(1)), match.group(4).strip(), int(match.group(7))
    if count < 2 or width < 2:
        raise record.fault(f"announces {count} points in fields of {width} characters", index)
    if unit.lower().startswith(_NOT_MEASURED):
        raise record.fault(
            f"the data are raw, in {shown(unit)}, not in units of acceleration; use the processed "
            "(V1 or V2) file",
            index,
        )
    factor = unit_of_file(record, unit, options, index)
    header = _header(record, start)
    dt = _time_step(record, header, options)
    length = _LENGTH.search(match.group(3))
    if length:
        seconds = float(length.group(1).replace("D", "E").replace("d", "e"))
        if abs(count * dt - seconds) > max(1.0 + dt, 0.02 * seconds):
            raise record.fault(
                f"{count} points at {dt:g} s make {count * dt:g} s, the line says about "
                f"{seconds:g} s; the header contradicts itself",
                index,
            )
    values, lines = _values(record, index + 1, count, width)
    _check_end(record, lines[-1] + 1, stop, count)
    _no_missing(record, start, index, values, lines)
    notes: tuple[str, ...] = ()
    if re.match(r"\s*(uncorrected|raw)\b", record.lines[start], re.IGNORECASE):
        notes += ("uncorrected (raw) acceleration, taken as it is",)
    flag = header.integers[FLAG_HEADER - 1] if len(header.integers) >= FLAG_HEADER else 0.0
    if flag in FLAGS:
        notes += (FLAGS[int(flag)],)
    if len(header.reals) >= PEAK_HEADER and header.reals[PEAK_HEADER - 1] > -990.0:
        peak = float(np.max(np.abs(values)))
        notes += peak_note(peak, header.reals[PEAK_HEADER - 1], unit, 0.01)
    return Series(dt, values * factor, notes)


def _values(
    record: RecordFile, first: int, count: int, width: int
) -> tuple[NDArray[np.float64], list[int]]:
    """The values from a line on, and the line of each."""
    # One value a line is written in fields of any width, whatever the format says.
    head = record.lines[first : first + min(count, 3)]
    if head and all(len(line.split()) == 1 for line in head):
        block = record.lines[first : first + count]
        end = next((i for i, line in enumerate(block) if _END.match(line)), len(block))
        single = all(len(line.split()) == 1 for line in block[:end])
        if single and len(block[0].rstrip()) <= 2 * width:
            if end < count:
                raise record.fault(
                    f"{count} values are announced and {end} are there, one a line; the file is "
                    "cut off: fetch it again"
                )
            after = first + count
            if after >= len(record.lines) or not _END.match(record.lines[after]):
                raise record.fault(
                    "no end mark '/&' or 'End-of-data' follows the values, one a line; the last "
                    "one may be cut off: fetch the file again",
                    after - 1,
                )
            return free_numbers(record, first, after), list(range(first, after))
    values = fixed_numbers(record, first, count, width)
    per_line: list[int] = []
    index = first
    while len(per_line) < count:
        fields = -(-len(record.lines[index].rstrip()) // width)
        per_line += [index] * fields
        index += 1
    return values, per_line


def _check_end(record: RecordFile, after: int, stop: int, count: int) -> None:
    """Behind the values: an end mark, another part or header, or the file's end."""
    while after < stop and not record.lines[after].strip():
        after += 1
    if after >= stop:
        return
    line = record.lines[after]
    if not (_END.match(line) or _DATA.match(line)):
        raise record.fault(
            f"more follows after the {count} values announced, no end mark '/&' or 'End-of-data'",
            after,
        )


def _header(record: RecordFile, start: int) -> _Header:
    """The integer and real headers, and the line that announces the latter."""
    match = _FIRST.search(record.lines[start])
    assert match is not None, "start is such a line"
    index = start + int(match.group(1))
    found: list[list[float]] = []
    for kind in ("integer", "real"):
        announced = _HEADERS.match(record.line(index))
        if announced is None or announced.group(2).lower() != kind:
            raise record.fault(f"the {kind} headers should be announced here", index)
        found.append(_header_values(record, index, announced))
        line = index
        index += 1 + int(announced.group(3))
    return _Header(start, found[0], found[1], line)


def _header_values(record: RecordFile, index: int, announced: re.Match[str]) -> list[float]:
    count, lines, width = (int(announced.group(place)) for place in (1, 3, 5))
    record.line(index + lines)
    # Some writers let a value grow over its field; blanks then still part the values.
    block = record.lines[index + 1 : index + 1 + lines]
    if sum(len(line.split()) for line in block) == count:
        return list(free_numbers(record, index + 1, index + 1 + lines).tolist())
    return list(fixed_numbers(record, index + 1, count, max(width, 1)).tolist())


def _time_step(record: RecordFile, header: _Header, options: Options) -> float:
    reals = header.reals
    if len(reals) < STEP_HEADER or reals[STEP_HEADER - 1] <= 0.0:
        if options.dt is not None:
            return check_dt(record, options.dt, options)
        raise record.fault(
            f"real header {STEP_HEADER} (the time step in ms) is missing; give dt", header.line
        )
    return check_dt(record, 1e-3 * reals[STEP_HEADER - 1], options, header.line)


def _no_missing(
    record: RecordFile, start: int, index: int, values: NDArray[np.float64], lines: list[int]
) -> None:
    """Refuse data in which the header's mark for missing values occurs."""
    mark = -999.0
    for line in record.lines[start:index]:
        match = _MISSING.search(line)
        if match:
            mark = float(match.group(1).replace("D", "E").replace("d", "e"))
            break
    place = np.flatnonzero(values == mark)
    if mark != 0.0 and place.size:
        raise record.fault(
            f"sample {int(place[0]) + 1} is {mark:g}, the mark of a missing value: the record "
            "has a gap",
            lines[int(place[0])],
        )
