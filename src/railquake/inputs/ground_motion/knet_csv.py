"""NIED's K-NET and KiK-net records as CSV: lines "#name, value", then time stamps and components.

The last line with a "#" names the columns and their units, "#Time, NS(gal), EW(gal), UD(gal)"; the
first column holds dates with times of day, or seconds.
"""

from __future__ import annotations

import datetime
import re
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
    check_not_cut,
    convert,
    no_marks,
    peak_note,
    shown,
    to_float,
    unit_of_file,
)

HEADER_LINES = 60

_COLUMN = re.compile(r"\s*([A-Za-z0-9-]{1,12})\s*[(\[]([^()\[\]]{1,20})[)\]]\s*")
_STAMP = re.compile(
    r"([0-9]{4})[-/]([0-9]{1,2})[-/]([0-9]{1,2})[ T]+"
    r"([0-9]{1,2}):([0-9]{2}):([0-9]{2})(\.[0-9]+)?Z?"
)


def is_knet_csv(record: RecordFile) -> bool:
    """Whether lines with "#" give a station or origin and name columns with units."""
    header = _header_lines(record)
    if not header or _columns(header[-1]) is None:
        return False
    names = " ".join(line.lower() for line in header)
    return "origin time" in names or "station code" in names or "sampling freq" in names


def knet_csv_channels(record: RecordFile, options: Options) -> list[Channel]:
    """The components beside the time."""
    names = _columns(_header_lines(record)[-1])
    assert names is not None, "is_knet_csv comes first"
    return [
        Channel(number, name, partial(_read, record, options, number), vertical_by_label(name))
        for number, (name, _) in enumerate(names, 1)
    ]


def _header_lines(record: RecordFile) -> list[str]:
    lines = record.lines[:HEADER_LINES]
    stop = next((i for i, line in enumerate(lines) if not line.startswith("#")), len(lines))
    return lines[:stop]


def _columns(line: str) -> list[tuple[str, str]] | None:
    """Name and unit of each column behind the time, or None for another line."""
    first, *others = line.lstrip("#").split(",")
    matches = [_COLUMN.fullmatch(cell) for cell in others]
    if "time" not in first.lower() or not matches or None in matches:
        return None
    return [(match.group(1), match.group(2)) for match in matches if match]


def _read(record: RecordFile, options: Options, number: int) -> Series:
    header = _header_lines(record)
    names = _columns(header[-1])
    assert names is not None, "is_knet_csv comes first"
    entries = {
        " ".join(name.lower().split()): value.strip()
        for name, comma, value in (line.lstrip("#").partition(",") for line in header[:-1])
        if comma
    }
    factor = unit_of_file(record, names[number - 1][1], options)
    start, width = len(header), len(names) + 1
    stamps: list[str] = []
    ends: list[str] = []
    tokens: list[str] = []
    for index, line in enumerate(record.lines[start:], start):
        cells = [cell.strip() for cell in line.split(",")]
        while len(cells) > width and not cells[-1]:
            cells.pop()
        if len(cells) != width:
            raise record.fault(
                f"has {len(cells)} cells, {width} are named above; the file is damaged or cut off",
                index,
            )
        stamps.append(cells[0])
        tokens.append(cells[number])
        ends.append(cells[-1])
    if len(tokens) < 2:
        raise record.fault("holds fewer than two rows of values")
    values = convert(record, tokens, range(start, len(record.lines)))
    check_not_cut(record, ends)
    dt = check_dt(record, _time_step(record, entries, _seconds(record, stamps, start)), options)
    length = re.match(NUMBER, entries.get("duration time(s)", entries.get("duration time", "")))
    if length and abs(float(length.group(0)) - len(values) * dt) > 0.5 * dt:
        raise record.fault(
            f"{length.group(0)} s at {dt:g} s make {float(length.group(0)) / dt:.0f} values and "
            f"the file has {len(values)}; it is cut off or its header wrong: fetch it again"
        )
    no_marks(record, values)
    notes: tuple[str, ...] = ()
    peak = float(np.max(np.abs(values))) * factor * 100.0
    stated = [to_float(cell) for cell in entries.get("max. acc. (gal)", "").split(",")]
    if len(stated) == len(names) and stated[number - 1] is not None:
        notes = peak_note(peak, stated[number - 1] or 0.0, "gal", 0.1)
    elif len(stated) == 1 and stated[0] is not None:
        notes = peak_note(peak, stated[0], "gal", 0.1)
    return Series(dt, values * factor, notes)


def _seconds(record: RecordFile, stamps: list[str], start: int) -> NDArray[np.float64]:
    """Time of each row from the first one, s."""
    times = []
    for index, stamp in enumerate(stamps, start):
        match = _STAMP.fullmatch(stamp)
        number = to_float(stamp)
        if match is None and number is None:
            raise record.fault(
                f"{shown(stamp)} is no time; '2024/08/08 16:43:00.01' or seconds are expected",
                index,
            )
        if match is None:
            times.append(number or 0.0)
            continue
        year, month, day, hour, minute, second = (int(text) for text in match.groups()[:6])
        try:
            days = datetime.date(year, month, day).toordinal()
        except ValueError:
            raise record.fault(f"{shown(stamp)} is no date", index) from None
        if not times:
            first_day = days
        whole = (days - first_day) * 86400 + hour * 3600 + minute * 60 + second
        times.append(whole + float(match.group(7) or 0.0))
    return np.array(times) - times[0]


def _time_step(record: RecordFile, entries: dict[str, str], time: NDArray[np.float64]) -> float:
    """Time step, s: the one that the header states, which the stamps must keep."""
    freq = next((text for name, text in entries.items() if name.startswith("sampling freq")), "")
    match = re.match(NUMBER, freq)
    mean = float(time[-1] - time[0]) / (len(time) - 1)
    if not mean > 0.0:
        raise record.fault("the time stamps do not increase")
    dt = float(f"{mean:.6g}")
    if match:
        rate = float(match.group(0))
        if not rate > 0.0:
            raise record.fault(f"the sampling frequency is {shown(freq)}; it must be over zero")
        dt = 1.0 / rate
    # Stamps are printed to a hundredth or thousandth of a second.
    drift = np.abs(time - dt * np.arange(len(time)))
    if float(np.max(drift)) > 0.5 * dt + 1e-9:
        place = int(np.argmax(drift > 0.5 * dt + 1e-9))
        raise record.fault(
            f"the time stamp of sample {place + 1} is {time[place]:g} s after the first, steps of "
            f"{dt:g} s make {place * dt:g} s: a gap, or a wrong sampling frequency"
        )
    return dt
