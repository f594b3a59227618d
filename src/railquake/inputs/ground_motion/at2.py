"""PEER .AT2 files: a few header lines, NPTS and DT, then the values in any layout.

Dialects: any number of header lines; "NPTS= 4000, DT= .0050 SEC," in any case; the older
"4000 .0050 NPTS, DT"; any line ends; numbers without a leading zero.
"""

from __future__ import annotations

import re

from railquake.inputs.ground_motion import units as unit_table
from railquake.inputs.ground_motion.text import (
    NUMBER,
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    free_numbers,
    shown,
    unit_of_file,
)

HEADER_LINES = 60
"""The line with NPTS and DT is looked for within this many lines."""

_WORDS = re.compile(r"\bnpts\b.*\bdt\b", re.IGNORECASE)
_NEW = re.compile(
    rf"\bnpts\s*[=:]\s*({NUMBER}).*?\bdt\s*[=:]\s*({NUMBER})\s*([a-z]*)", re.IGNORECASE
)
_OLD = re.compile(rf"^\s*({NUMBER})\s*,?\s+({NUMBER})\s*,?\s*npts\s*,?\s*dt\b", re.IGNORECASE)
_SHAPE = re.compile(r"^[+-]?[0-9]*\.([0-9]*)(?:[eEdD]([+-]?[0-9]*))?$")


def is_at2(record: RecordFile) -> bool:
    """Whether a line near the top speaks of NPTS and DT."""
    return _header_line(record) is not None


def at2_channels(record: RecordFile, options: Options) -> list[Channel]:
    """The one channel of an AT2 file."""
    return [Channel(None, "", lambda: read_at2(record, options))]


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
    values = free_numbers(record, index + 1)
    if values.size != npts:
        raise record.fault(_wrong_count(record, npts, int(values.size)))
    _check_last(record)
    header = "; ".join(line.strip() for line in record.lines[:index] if line.strip())
    notes = (f"header: {header[:200]}",) if header else ()
    return Series(dt, values * factor, notes)


def _header_line(record: RecordFile) -> int | None:
    for index, line in enumerate(record.lines[:HEADER_LINES]):
        if _WORDS.search(line):
            return index
    return None


def _npts_and_dt(record: RecordFile, index: int, options: Options) -> tuple[int, float]:
    line = record.lines[index]
    match = _NEW.search(line) or _OLD.search(line)
    if match is None:
        raise record.fault(
            f"NPTS and DT cannot be read from {shown(line.strip())}; "
            "'NPTS= 4000, DT= .0050 SEC' or '4000 .0050 NPTS, DT' is expected",
            index,
        )
    count_text, dt_text = match.group(1), match.group(2)
    if not re.fullmatch(r"\+?[0-9]{1,9}", count_text) or int(count_text) < 2:
        raise record.fault(
            f"NPTS is {shown(count_text)}; a whole number of at least 2 is needed", index
        )
    unit = match.group(3) if match.re is _NEW else ""
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
    if _cut_token(record) is not None:
        message += f", the last of them cut off (line {len(record.lines)})"
    return message + "; the file is cut off or its header wrong: fetch it again"


def _check_last(record: RecordFile) -> None:
    """A file of the right count may still end inside its last number."""
    cut = _cut_token(record)
    if cut is not None:
        raise record.fault(
            f"the last value, {shown(cut)}, is cut off; fetch the file again",
            len(record.lines) - 1,
        )


def _cut_token(record: RecordFile) -> str | None:
    """The file's last number if it has fewer digits than ten printed alike before it."""
    tokens = " ".join(record.lines[-13:]).split()[-11:]
    if len(tokens) < 11:
        return None
    shapes = []
    for token in tokens:
        match = _SHAPE.match(token)
        shapes.append(match and (len(match.group(1)), len(match.group(2) or "")))
    last, before = shapes[-1], set(shapes[:-1])
    if len(before) != 1 or None in before:
        return None
    usual = before.pop()
    assert usual is not None
    # Without an exponent, printing often drops trailing zeros: that is no sign of a cut.
    if usual[1] == 0:
        return None
    short = last is None or last[0] < usual[0] or last[1] < usual[1]
    return tokens[-1] if short else None
