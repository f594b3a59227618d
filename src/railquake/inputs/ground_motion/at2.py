"""PEER .AT2 files: a few header lines, NPTS and DT, then the values in any layout.

Dialects: any number of header lines; "NPTS= 4000, DT= .0050 SEC," in any case and order; the older
"4000 .0050 NPTS, DT"; any line ends; numbers without a leading zero; an end mark behind the values.
The second line ends in the component: an azimuth, or "UP", "DWN", "V".
"""

from __future__ import annotations

import re
from dataclasses import replace

from railquake.inputs.ground_motion import units as unit_table
from railquake.inputs.ground_motion.orientation import vertical_by_label
from railquake.inputs.ground_motion.text import (
    NUMBER,
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    check_not_cut,
    cut_token,
    free_numbers,
    last_tokens,
    no_marks,
    shown,
    unit_of_file,
)

HEADER_LINES = 60
"""The line with NPTS and DT is looked for within this many lines."""

_WORDS = re.compile(r"\bnpts\b.*\bdt\b|\bdt\b.*\bnpts\b", re.IGNORECASE)
_NEW = re.compile(
    rf"\bnpts\s*[=:]\s*({NUMBER}).*?\bdt\s*[=:]\s*({NUMBER})\s*([a-z]*)", re.IGNORECASE
)
_TURNED = re.compile(
    rf"\bdt\s*[=:]\s*({NUMBER})\s*([a-z]*)[\s,;]*npts\s*[=:]\s*({NUMBER})", re.IGNORECASE
)
_END = re.compile(r"^[\W_]*(?:end\b|eof\b|/&|$)", re.IGNORECASE)
_OLD = re.compile(rf"^\s*({NUMBER})\s*,?\s+({NUMBER})\s*,?\s*npts\s*,?\s*dt\b", re.IGNORECASE)


def is_at2(record: RecordFile) -> bool:
    """Whether a line near the top speaks of NPTS and DT."""
    return _header_line(record) is not None


def at2_channels(record: RecordFile, options: Options) -> list[Channel]:
    """The one channel of an AT2 file."""
    return [Channel(None, "", lambda: read_at2(record, options), _vertical(record))]


def _vertical(record: RecordFile) -> bool | None:
    """From the last field of the second line, "EARTHQUAKE, date, station, 090"."""
    fields = record.line(1).split(",") if len(record.lines) > 1 else []
    return vertical_by_label(fields[-1]) if len(fields) > 2 else None


def read_at2(record: RecordFile, options: Options) -> Series:
    """Read a PEER AT2 file.

    Raises
    ------
    InputError
        If the header is incomplete, the unit unknown, or the number of values is not NPTS.
    """
    index = _header_line(record)
    assert index is not None, "is_at2 comes first"
    npts, dt = _npts_and_dt(record, index, options)
    factor = _factor(record, index, options)
    stop = _end_of_values(record, index + 1)
    _no_text_behind(record, index + 1, stop, npts)
    values = free_numbers(record, index + 1, stop)
    body = record if stop == len(record.lines) else replace(record, lines=record.lines[:stop])
    if values.size != npts:
        raise record.fault(_wrong_count(body, npts, int(values.size)))
    check_not_cut(body, last_tokens(body, index + 1))
    no_marks(record, values)
    header = "; ".join(line.strip() for line in record.lines[:index] if line.strip())
    notes = (f"header: {header[:200]}",) if header else ()
    return Series(dt, values * factor, notes)


def _end_of_values(record: RecordFile, start: int) -> int:
    """Index behind the last line of values: end marks ("*** End Data ***") are none."""
    stop = len(record.lines)
    while stop > start and _END.match(record.lines[stop - 1]):
        stop -= 1
    return stop


def _no_text_behind(record: RecordFile, start: int, stop: int, npts: int) -> None:
    """Refuse words behind all the values as what they are, not as damaged numbers."""
    first = stop
    while first > start and re.search(r"[A-Za-z]{3}", record.lines[first - 1]):
        first -= 1
    if first < stop and sum(len(line.split()) for line in record.lines[start:first]) == npts:
        text = shown(record.lines[first].strip())
        raise record.fault(f"the text {text} stands behind the {npts} values; remove it", first)


def _header_line(record: RecordFile) -> int | None:
    for index, line in enumerate(record.lines[:HEADER_LINES]):
        if _WORDS.search(line):
            return index
    return None


def _npts_and_dt(record: RecordFile, index: int, options: Options) -> tuple[int, float]:
    line = record.lines[index]
    match = _NEW.search(line) or _OLD.search(line) or _TURNED.search(line)
    if match is None:
        raise record.fault(
            f"NPTS and DT cannot be read from {shown(line.strip())}; "
            "'NPTS= 4000, DT= .0050 SEC' or '4000 .0050 NPTS, DT' is expected",
            index,
        )
    count_text, dt_text, unit = {
        _NEW: lambda: match.group(1, 2, 3),
        _OLD: lambda: (*match.group(1, 2), ""),
        _TURNED: lambda: match.group(3, 1, 2),
    }[match.re]()
    if not re.fullmatch(r"\+?[0-9]{1,9}", count_text) or int(count_text) < 2:
        raise record.fault(
            f"NPTS is {shown(count_text)}; a whole number of at least 2 is needed", index
        )
    factor = unit_table.time_factor(unit) if unit else 1.0
    if factor is None:
        raise record.fault(f"DT is in {shown(unit)}; seconds are expected", index)
    dt = float(dt_text.replace("D", "E").replace("d", "e")) * factor
    if not dt > 0.0:
        raise record.fault(f"DT is {dt_text} s; the time step must be over zero", index)
    return int(count_text), check_dt(record, dt, options, index)


def _factor(record: RecordFile, index: int, options: Options) -> float:
    """Factor to m/s2 from the header's words "units of ..."."""
    header = record.lines[: index + 1]
    for place, line in enumerate(header):
        kind = re.search(r"\b(velocity|displacement)\b\s+time\s+(?:series|history)", line, re.I)
        if kind:
            raise record.fault(
                f"holds a {kind.group(1).lower()}, not an acceleration; use the .AT2 file", place
            )
    stated = unit_table.unit_statements(header)
    factors = {unit_table.acceleration_factor(text) for text in stated}
    if len(factors) > 1:
        raise record.fault(
            f"the header names different units ({', '.join(map(shown, stated[:4]))}); correct it"
        )
    return unit_of_file(record, stated[0] if stated else None, options)


def _wrong_count(record: RecordFile, npts: int, found: int) -> str:
    if found > npts:
        return (
            f"NPTS is {npts} and the file has {found} values; "
            "correct NPTS, or fetch the record again"
        )
    message = f"NPTS is {npts} and the file has only {found} values"
    if cut_token(record) is not None:
        message += f", the last of them cut off (line {len(record.lines)})"
    return message + "; the file is cut off or its header wrong: fetch it again"
