"""CSMIP/CESMD Volume 2 (.V2): up to many channels of corrected data in one file.

Each channel: text lines with its number, integer and real headers, then acceleration, velocity
and displacement, each behind a line such as
"3251 POINTS OF ACCEL DATA EQUALLY SPACED AT  .020 SEC.  (UNITS: CM/SEC/SEC)".
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
    fixed_numbers,
    peak_note,
    shown,
    unit_of_file,
)

FIELD_WIDTH = 10
"""Width of a value where the file does not print its format: 8F10.3."""

HEADER_LINES = 200
"""The first channel's data are announced within this many lines."""

_DATA = re.compile(
    rf"^\s*([0-9]{{1,9}})\s+POINTS OF ACCEL\w*\s+DATA\s+EQUALLY[ -]SPACED\s+AT\s+({NUMBER})\s*"
    r"SEC\b(.*)$",
    re.IGNORECASE,
)
_UNITS = re.compile(r"(?:UNITS\s*[:=]|\bIN\b)\s*([^\s(),]+)", re.IGNORECASE)
_FORMAT = re.compile(r"\(\s*[0-9]+[FE]([0-9]{1,2})\.[0-9]+\s*\)", re.IGNORECASE)
_CHANNEL = re.compile(
    r"\bCHAN\s+([0-9]{1,4})\s*:\s*(.*?)(?:\s{2,}|\s*\bFROM\b.*|\s*)$", re.IGNORECASE
)
_PEAK = re.compile(rf"PEAK\s+ACCELERATION\s*=\s*({NUMBER})\s*CM/SEC", re.IGNORECASE)
_END = re.compile(r"^\s*/&")


def is_csmip(record: RecordFile) -> bool:
    """Whether a line announces evenly spaced acceleration points, or the first line says so."""
    if record.lines[0].lstrip().upper().startswith("CORRECTED ACCELEROGRAM"):
        return True
    return any(_DATA.match(line) for line in record.lines[:HEADER_LINES])


def csmip_channels(record: RecordFile, options: Options) -> list[Channel]:
    """All channels of the file.

    Raises
    ------
    InputError
        If no acceleration data are found.
    """
    channels: list[Channel] = []
    begin = 0
    for index, line in enumerate(record.lines):
        if _END.match(line):
            begin = index + 1
        match = _DATA.match(line)
        if match:
            number, label = _number_and_label(record, begin, index)
            channels.append(
                Channel(
                    number,
                    label,
                    partial(_read, record, options, begin, index, match),
                    vertical_by_label(label),
                )
            )
    if not channels:
        raise record.fault(
            "is headed as a corrected accelerogram (CSMIP V2), but no line '... POINTS OF ACCEL "
            "DATA EQUALLY SPACED AT ...' follows; the file is cut off or of another volume"
        )
    return channels


def _number_and_label(record: RecordFile, begin: int, index: int) -> tuple[int | None, str]:
    # The last mention is the tidy one, by itself or at the end of its line.
    for line in reversed(record.lines[begin:index]):
        match = _CHANNEL.search(line)
        if match:
            return int(match.group(1)), " ".join(match.group(2).split())
    return None, ""


def _read(
    record: RecordFile, options: Options, begin: int, index: int, match: re.Match[str]
) -> Series:
    count, rest = int(match.group(1)), match.group(3)
    if count < 2:
        raise record.fault(f"announces {count} points; a record needs at least two", index)
    dt = check_dt(record, float(match.group(2).replace("D", "E")), options, index)
    units = _UNITS.search(rest)
    factor = unit_of_file(record, units.group(1) if units else None, options, index)
    layout = _FORMAT.search(rest)
    width = int(layout.group(1)) if layout else FIELD_WIDTH
    if width < 2:
        raise record.fault(f"the format {shown(rest.strip())} cannot be read", index)
    values = fixed_numbers(record, index + 1, count, width)
    notes: tuple[str, ...] = ()
    header = "\n".join(record.lines[begin:index])
    peak = _PEAK.search(header)
    if peak:
        stated = float(peak.group(1).replace("D", "E"))
        in_cm = float(np.max(np.abs(values))) * factor * 100.0
        notes = peak_note(in_cm, stated, "cm/s2", 0.01)
    return Series(dt, values * factor, notes)
