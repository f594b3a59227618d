"""DYNA 1.2, the text format of ESM and ITACA, and of AFAD since 2016: one component a file.

Lines "KEY: value" (64 in full), among them SAMPLING_INTERVAL_S, NDATA, UNITS, STREAM and the peak
PGA_CM/S^2; then one value a line.
"""

from __future__ import annotations

import re

import numpy as np

from railquake.inputs.ground_motion.orientation import vertical_by_label, vertical_by_seed_code
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

HEADER_LINES = 120
"""The first value is looked for within this many lines."""

_PEAK = "pga_cm/s^2"


def is_dyna(record: RecordFile) -> bool:
    """Whether lines near the top state the interval and the number of data as DYNA does."""
    names = {line.partition(":")[0].strip().upper() for line in record.lines[:HEADER_LINES]}
    return {"SAMPLING_INTERVAL_S", "NDATA"} <= names


def dyna_channels(record: RecordFile, options: Options) -> list[Channel]:
    """The one component of the file."""
    stream = _header(record)[0].get("stream", "")
    vertical = vertical_by_seed_code(stream)
    if vertical is None:
        vertical = vertical_by_label(stream)
    return [Channel(None, stream, lambda: read_dyna(record, options), vertical)]


def read_dyna(record: RecordFile, options: Options) -> Series:
    """Read a DYNA file.

    Raises
    ------
    InputError
        If it holds no acceleration, the header lacks an entry, or the number of values is not
        NDATA.
    """
    header, start = _header(record)
    kind = header.get("data_type", "acceleration") or "acceleration"
    if not kind.lower().startswith("acc"):
        raise record.fault(f"holds {shown(kind.lower())}, not acceleration (DATA_TYPE)")
    interval = header.get("sampling_interval_s", "")
    if not re.fullmatch(NUMBER, interval):
        raise record.fault(f"SAMPLING_INTERVAL_S is {shown(interval)}; a number of s is needed")
    dt = check_dt(record, to_float(interval) or 0.0, options)
    count = whole_number(record, header.get("ndata", ""), "NDATA")
    factor = unit_of_file(record, header.get("units") or None, options)
    values = free_numbers(record, start)
    if values.size != count:
        raise record.fault(
            f"NDATA is {count} and the file has {values.size} values; it is cut off or its header "
            "wrong: fetch it again"
        )
    check_not_cut(record, last_tokens(record, start))
    no_marks(record, values)
    notes: tuple[str, ...] = ()
    if header.get("baseline_correction", "").upper() == "BASELINE NOT REMOVED":
        notes += ("the header says that the baseline is not removed",)
    stated = header.get(_PEAK, "")
    if re.fullmatch(NUMBER, stated):
        peak = float(np.max(np.abs(values))) * factor * 100.0
        notes += peak_note(peak, to_float(stated) or 0.0, "cm/s2", 0.001)
    return Series(dt, values * factor, notes)


def _header(record: RecordFile) -> tuple[dict[str, str], int]:
    """Entries by key in lower case, and the index of the first value's line."""
    for index, line in enumerate(record.lines[:HEADER_LINES]):
        fields = line.split()
        if fields and all(re.fullmatch(NUMBER, field) for field in fields):
            return key_values(record.lines[:index]), index
    raise record.fault(f"no value stands within {HEADER_LINES} lines; the file is cut off")
