"""K-NET and KiK-net ASCII files: 17 header lines, then counts with an arbitrary offset.

A header line is a name in 18 characters and a value.  Acceleration is count times the scale
factor ("3920(gal)/6182761"), less the mean of the whole record, as the network itself states
its peaks.
"""

from __future__ import annotations

import re

import numpy as np

from railquake.inputs.ground_motion.orientation import vertical_by_label
from railquake.inputs.ground_motion.text import (
    NUMBER,
    Channel,
    Options,
    RecordFile,
    Series,
    check_dt,
    free_numbers,
    peak_note,
    shown,
    unit_of_file,
)

HEADER_LINES = 17
NAME_WIDTH = 18

# KiK-net numbers its components: 1 to 3 in the borehole, 4 to 6 at the surface, NS, EW, UD.
_DIRECTIONS = {"1": False, "2": False, "3": True, "4": False, "5": False, "6": True}
_SCALE = re.compile(rf"({NUMBER})\s*\(([^)]*)\)\s*/\s*({NUMBER})")
_RATE = re.compile(rf"({NUMBER})\s*Hz", re.IGNORECASE)
_LENGTH = re.compile(rf"({NUMBER})")


def is_knet(record: RecordFile) -> bool:
    """Whether the header's names are there."""
    names = [line[:NAME_WIDTH].strip().lower() for line in record.lines[: HEADER_LINES + 3]]
    return "scale factor" in names or ("origin time" in names and "station code" in names)


def knet_channels(record: RecordFile, options: Options) -> list[Channel]:
    """The one channel of a K-NET file."""
    values = _header(record)[0]
    direction = values.get("dir.", "")
    vertical = _DIRECTIONS.get(direction)
    if vertical is None:
        vertical = vertical_by_label(direction)
    return [Channel(None, direction, lambda: read_knet(record, options), vertical)]


def read_knet(record: RecordFile, options: Options) -> Series:
    """Read a K-NET file; the mean is removed, and noted.

    Raises
    ------
    InputError
        If a header entry is missing or the number of values is not rate times duration.
    """
    header, start = _header(record)
    scale = _SCALE.fullmatch(_entry(record, header, "scale factor"))
    rate = _RATE.fullmatch(_entry(record, header, "sampling freq(hz)"))
    length = _LENGTH.fullmatch(_entry(record, header, "duration time(s)"))
    for name, match in (("Scale Factor", scale), ("Sampling Freq", rate), ("Duration", length)):
        if match is None:
            raise record.fault(
                f"the header's '{name}' cannot be read: '3920(gal)/6182761', "
                "'100Hz' and '30' are examples of the three"
            )
    assert scale is not None
    assert rate is not None
    assert length is not None
    top, bottom, hertz, seconds = (
        float(text.replace("D", "E").replace("d", "e"))
        for text in (scale.group(1), scale.group(3), rate.group(1), length.group(1))
    )
    if not (0.0 < top < 1e9 and 0.0 < bottom < 1e12 and 0.0 < hertz < 1e6 and seconds > 0.0):
        raise record.fault("scale factor, sampling frequency and duration must be over zero")
    factor = unit_of_file(record, scale.group(2), options)
    counts = free_numbers(record, start)
    if abs(counts.size - hertz * seconds) > 0.5:
        raise record.fault(
            f"{hertz:g} Hz for {seconds:g} s make {hertz * seconds:g} values and the file has "
            f"{counts.size}; it is cut off or its header wrong: fetch it again"
        )
    if counts.size < 2:
        raise record.fault("holds fewer than two values")
    dt = check_dt(record, 1.0 / hertz, options)
    mean = float(np.mean(counts))
    native = (counts - mean) * (top / bottom)
    notes: tuple[str, ...] = (f"mean of {mean:.0f} counts removed",)
    stated = re.fullmatch(rf"({NUMBER})", header.get("max. acc. (gal)", ""))
    if stated:
        peak = float(np.max(np.abs(native))) * factor * 100.0
        notes += peak_note(peak, float(stated.group(1).replace("D", "E")), "gal", 0.1)
    return Series(dt, native * factor, notes)


def _header(record: RecordFile) -> tuple[dict[str, str], int]:
    """Header entries by name in lower case, and the index of the first line of counts."""
    entries = {
        line[:NAME_WIDTH].strip().lower(): line[NAME_WIDTH:].strip()
        for line in record.lines[:HEADER_LINES]
    }
    return entries, HEADER_LINES


def _entry(record: RecordFile, header: dict[str, str], name: str) -> str:
    if name not in header:
        raise record.fault(
            f"the K-NET header has no line '{name}' within its {HEADER_LINES} lines; "
            f"found {shown(', '.join(header))}"
        )
    return header[name]
