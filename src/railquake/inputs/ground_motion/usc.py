"""USC Volume 1: uncorrected, unevenly sampled pairs of time (s) and acceleration (g/10).

Read only when the caller gives the time step to resample to.  Text lines up to the one on the
RMS acceleration, 100 integers (16 to a line), 50 reals (8 to a line), then pairs in fields of 7
characters behind one blank, five pairs to a line.
"""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from railquake.inputs.ground_motion.motion import MAX_SAMPLES
from railquake.inputs.ground_motion.text import (
    Channel,
    Options,
    RecordFile,
    Series,
    first_match,
    fixed_numbers,
    lines_used,
    unit_of_file,
)

INTEGERS, INTEGERS_PER_LINE = 100, 16
REALS, REALS_PER_LINE = 50, 8
FIELD_WIDTH = 7
LONGEST_STEP = 1.0
"""A longer pause between two samples, s, is a gap (digitisers skip straight stretches)."""

_POINTS = re.compile(r"NO\. OF POINTS\s*=\s*([0-9]{1,9})\b", re.IGNORECASE)
_UNITS = re.compile(r"UNITS ARE SEC AND (\S+)", re.IGNORECASE)
_LAST_TEXT = re.compile(r"\bRMS ACCLN", re.IGNORECASE)


def is_usc(record: RecordFile) -> bool:
    """Whether the first line speaks of uncorrected data of Volume 1."""
    return "UNCORRECTED ACCELEROGRAM DATA OF VOLUME" in record.lines[0].upper()


def usc_channels(record: RecordFile, options: Options) -> list[Channel]:
    """The one channel of a USC Volume 1 file."""
    return [Channel(None, "", lambda: read_usc(record, options))]


def read_usc(record: RecordFile, options: Options) -> Series:
    """Read a USC Volume 1 file and resample it to `options.dt`, which is noted.

    Raises
    ------
    InputError
        If no `dt` is given: uneven samples are not made even in silence.
    """
    if options.dt is None:
        raise record.fault(
            "USC Volume 1: uncorrected and unevenly sampled; use the corrected record (Volume "
            "2), or give dt = 0.005 to have it resampled to that step"
        )
    header = record.lines[:40]
    last = next((i for i, line in enumerate(header) if _LAST_TEXT.search(line)), None)
    points, units = first_match(_POINTS, header), first_match(_UNITS, header)
    if last is None or points is None:
        raise record.fault("the header lacks 'NO. OF POINTS' or 'RMS ACCLN.'")
    factor = unit_of_file(record, units.group(1) if units else None, options)
    count = int(points.group(1))
    if count < 2:
        raise record.fault(f"announces {count} points; a record needs at least two")
    start = last + 1 + lines_used(INTEGERS, INTEGERS_PER_LINE) + lines_used(REALS, REALS_PER_LINE)
    pairs = fixed_numbers(record, start, 2 * count, FIELD_WIDTH, indent=1).reshape(count, 2)
    time, values = pairs[:, 0], pairs[:, 1]
    return resampled_pairs(record, time, values, factor, options.dt)


def resampled_pairs(
    record: RecordFile,
    time: NDArray[np.float64],
    values: NDArray[np.float64],
    factor: float,
    dt: float,
) -> Series:
    """Uneven samples at even steps, by straight lines, which is noted.

    Parameters
    ----------
    record : RecordFile
        For messages.
    time : ndarray, shape (n,)
        s.
    values : ndarray, shape (n,)
        In the file's unit.
    factor : float
        To m/s2.
    dt : float
        Step to resample to, s.
    """
    count = len(time)
    steps = np.diff(time)
    wrong = np.flatnonzero((steps <= 0.0) | (steps > LONGEST_STEP))
    if wrong.size:
        place = int(wrong[0])
        raise record.fault(
            f"time goes from {time[place]:g} to {time[place + 1]:g} s at sample {place + 2}: "
            "a gap or a damaged line"
        )
    length = float(time[-1] - time[0])
    if length / dt > MAX_SAMPLES:
        raise record.fault(f"dt = {dt:g} s would make over {MAX_SAMPLES} samples")
    even = np.arange(int(np.floor(length / dt + 1e-9)) + 1) * dt
    resampled = np.interp(even, time - time[0], values)
    before, after = float(np.max(np.abs(values))), float(np.max(np.abs(resampled)))
    notes = (
        "uncorrected Volume 1 data: no baseline or instrument correction",
        f"resampled from {count} uneven samples to dt = {dt:g} s (linear); "
        f"PGA {before * factor:.5g} m/s2 before, {after * factor:.5g} m/s2 after",
    )
    return Series(dt, resampled * factor, notes)
