"""The older text format of AFAD, Turkey's strong-motion network: three columns without a time.

Lines "KEY : value", among them NUMBER OF DATA, SAMPLING INTERVAL (sec) and RAW PGA VALUES (gal);
then a line "N-S E-W U-D" and three values a line, in gal.
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
    check_not_cut,
    free_numbers,
    key_values,
    last_tokens,
    no_marks,
    peak_note,
    shown,
    to_float,
    unit_of_file,
    whole_number,
)

HEADER_LINES = 40
COMPONENTS = 3

_NAMES = re.compile(r"^\s*([NEUSWD]-[NEUSWD])\s+([NEUSWD]-[NEUSWD])\s+([NEUSWD]-[NEUSWD])\s*$")
_PEAKS = re.compile(rf"\(([NEUSWD]-[NEUSWD])\)\s*({NUMBER})", re.IGNORECASE)


def is_nsmn(record: RecordFile) -> bool:
    """Whether the interval is stated and a line names three components."""
    lines = record.lines[:HEADER_LINES]
    interval = any(line.strip().upper().startswith("SAMPLING INTERVAL") for line in lines)
    return interval and any(_NAMES.match(line) for line in lines)


def nsmn_channels(record: RecordFile, options: Options) -> list[Channel]:
    """The three components."""
    index, names = _names(record)
    return [
        Channel(
            number,
            name,
            partial(_read, record, options, index, number, name),
            vertical_by_label(name),
        )
        for number, name in enumerate(names, 1)
    ]


def _names(record: RecordFile) -> tuple[int, tuple[str, ...]]:
    found = (
        (index, match.groups())
        for index, line in enumerate(record.lines[:HEADER_LINES])
        if (match := _NAMES.match(line))
    )
    return next(found)


def _read(record: RecordFile, options: Options, index: int, number: int, name: str) -> Series:
    header = key_values(record.lines[:index])
    interval = header.get("sampling interval (sec)", "")
    if not re.fullmatch(NUMBER, interval):
        raise record.fault(f"SAMPLING INTERVAL (sec) is {shown(interval)}; a number of s is needed")
    dt = check_dt(record, to_float(interval) or 0.0, options)
    count = whole_number(record, header.get("number of data", ""), "NUMBER OF DATA")
    stated = next((key for key in header if key.startswith("raw pga values")), "")
    unit = re.search(r"\(([^)]*)\)", stated)
    factor = unit_of_file(record, unit.group(1) if unit else None, options)
    start = index + 1
    for place, line in enumerate(record.lines[start:], start):
        if line.strip() and len(line.split()) != COMPONENTS:
            raise record.fault(
                f"has {len(line.split())} values, the rows above have {COMPONENTS}; the file is "
                "damaged or cut off",
                place,
            )
    table = free_numbers(record, start).reshape(-1, COMPONENTS)
    if len(table) != count:
        raise record.fault(
            f"NUMBER OF DATA is {count} and the file has {len(table)} rows; it is cut off or its "
            "header wrong: fetch it again"
        )
    check_not_cut(record, last_tokens(record, start))
    values = table[:, number - 1]
    no_marks(record, values)
    peaks = {key.upper(): to_float(text) for key, text in _PEAKS.findall(header.get(stated, ""))}
    notes: tuple[str, ...] = ("raw acceleration, taken as it is",)
    peak = peaks.get(name.upper())
    if peak is not None:
        found = float(np.max(np.abs(values))) * factor * 100.0
        notes += peak_note(found, peak, "gal", 0.01)
    return Series(dt, values * factor, notes)
