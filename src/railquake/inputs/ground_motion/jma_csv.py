"""The Japan Meteorological Agency's strong-motion CSV (Shift_JIS): three components, no time.

Six lines "NAME = value" (SITE CODE, LAT., LON., SAMPLING RATE, UNIT, INITIAL TIME), a line that
names the columns, "NS,EW,UD", then rows that may end in empty cells.
"""

from __future__ import annotations

import re
from functools import partial

from railquake.inputs.ground_motion.orientation import vertical_by_label
from railquake.inputs.ground_motion.text import (
    NUMBER,
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    check_not_cut,
    convert,
    first_match,
    no_marks,
    unit_of_file,
)

HEADER_LINES = 12

_SITE = re.compile(r"^\s*SITE CODE\s*=", re.IGNORECASE)
_RATE = re.compile(rf"^\s*SAMPLING (?:RATE|FREQ\w*)\s*=\s*({NUMBER})\s*Hz", re.IGNORECASE)
_UNIT = re.compile(r"^\s*UNIT\s*=\s*([^\s,(]+)", re.IGNORECASE)


def is_jma_csv(record: RecordFile) -> bool:
    """Whether the first line gives a site's code and a line names NS, EW, UD."""
    return _SITE.match(record.lines[0]) is not None and _names(record) is not None


def jma_csv_channels(record: RecordFile, options: Options) -> list[Channel]:
    """The components."""
    found = _names(record)
    assert found is not None, "is_jma_csv comes first"
    index, names = found
    return [
        Channel(
            number,
            name,
            partial(_read, record, options, index, number, len(names)),
            vertical_by_label(name),
        )
        for number, name in enumerate(names, 1)
    ]


def _cells(line: str) -> list[str]:
    cells = [cell.strip() for cell in line.split(",")]
    while cells and not cells[-1]:
        cells.pop()
    return cells


def _names(record: RecordFile) -> tuple[int, list[str]] | None:
    for index, line in enumerate(record.lines[:HEADER_LINES]):
        cells = _cells(line)
        if {cell.upper() for cell in cells} in ({"NS", "EW", "UD"}, {"X", "Y", "Z"}):
            return index, cells
    return None


def _read(record: RecordFile, options: Options, index: int, number: int, width: int) -> Series:
    header = record.lines[:index]
    rate, unit = first_match(_RATE, header), first_match(_UNIT, header)
    if rate is None or not float(rate.group(1)) > 0.0:
        raise record.fault("the header's SAMPLING RATE cannot be read; '100Hz' is an example")
    dt = check_dt(record, 1.0 / float(rate.group(1)), options)
    factor = unit_of_file(record, unit.group(1) if unit else None, options)
    tokens: list[str] = []
    ends: list[str] = []
    commas = record.line(index + 1).count(",")
    for place, line in enumerate(record.lines[index + 1 :], index + 1):
        cells = _cells(line)
        if len(cells) != width or line.count(",") != commas:
            raise record.fault(
                f"has {len(cells)} values and {line.count(',')} commas, not {width} and {commas}; "
                "the file is damaged or cut off",
                place,
            )
        tokens.append(cells[number - 1])
        ends.append(cells[-1])
    if len(tokens) < 2:
        raise record.fault("holds fewer than two rows of values")
    values = convert(record, tokens, range(index + 1, len(record.lines)))
    check_not_cut(record, ends)
    no_marks(record, values)
    return Series(dt, values * factor)
