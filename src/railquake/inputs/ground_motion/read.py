"""`read_motion`: a record file of any known format to a `GroundMotion`."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from railquake.inputs.ground_motion import (
    at2,
    columns,
    cosmos,
    csmip,
    dyna,
    geonet,
    jma_csv,
    knet,
    knet_csv,
    listed,
    nsmn,
    renadic,
    smc,
    usc,
)
from railquake.inputs.ground_motion.motion import STANDARD_GRAVITY, GroundMotion
from railquake.inputs.ground_motion.opening import open_record
from railquake.inputs.ground_motion.other_files import not_a_record, why_no_numbers
from railquake.inputs.ground_motion.text import (
    Channel,
    Options,
    RecordFile,
    one_line,
    shown,
)

PLAUSIBLE_PGA = 3.0 * STANDARD_GRAVITY
"""Above this, m/s2, a record is refused unless `allow_high_pga`: the unit is likely wrong."""
POSSIBLE_PGA = 100.0 * STANDARD_GRAVITY
"""Above this, m/s2, it is refused in any case."""
PLAUSIBLE_DT = (1e-5, 0.5)
"""Shortest and longest time step of a record, s."""


@dataclass(frozen=True)
class _Format:
    name: str
    detect: Callable[[RecordFile], bool]
    channels: Callable[[RecordFile, Options], list[Channel]]
    uncorrected: bool = True
    """Whether it may be that of a file headed as uncorrected (Volume 1)."""


# In this order: the sharper marks first, columns of numbers last.
_FORMATS = (
    _Format("K-NET", knet.is_knet, knet.knet_channels),
    _Format("K-NET CSV", knet_csv.is_knet_csv, knet_csv.knet_csv_channels),
    _Format("JMA CSV", jma_csv.is_jma_csv, jma_csv.jma_csv_channels),
    _Format("COSMOS", cosmos.is_cosmos, cosmos.cosmos_channels),
    _Format("USGS SMC", smc.is_smc, smc.smc_channels),
    _Format("USC Volume 1", usc.is_usc, usc.usc_channels),
    _Format("RENADIC Volume 1", renadic.is_renadic, renadic.renadic_channels),
    _Format("ESM/AFAD DYNA", dyna.is_dyna, dyna.dyna_channels),
    _Format("AFAD three columns", nsmn.is_nsmn, nsmn.nsmn_channels),
    _Format("GeoNet V1A/V2A", geonet.is_geonet, geonet.geonet_channels),
    _Format("CSMIP V2", csmip.is_csmip, csmip.csmip_channels, uncorrected=False),
    _Format("PEER AT2", at2.is_at2, at2.at2_channels, uncorrected=False),
    _Format("list of values", listed.is_listed, listed.listed_channels, uncorrected=False),
    _Format(
        "columns",
        lambda r: columns.first_row(r) is not None,
        columns.column_channels,
        uncorrected=False,
    ),
)

FORMATS = tuple(entry.name for entry in _FORMATS)
"""Names of the formats that `read_motion` tells apart."""


@dataclass(frozen=True)
class RecordContents:
    """What a record file holds, its numbers not read yet.

    Parameters
    ----------
    format : str
        One of `FORMATS`.
    channels : tuple of (int or None, str)
        Number and label of each channel; a file of one component may give neither.
    vertical : tuple of (bool or None)
        Whether the header says that each is a vertical component; None where it does not tell.
    """

    format: str
    channels: tuple[tuple[int | None, str], ...]
    vertical: tuple[bool | None, ...] = ()


def record_contents(path: str | os.PathLike[str]) -> RecordContents:
    """Tell a record file's format and list its channels.

    Raises
    ------
    InputError
        If the file is of no known format or its header is damaged.
    """
    record = open_record(path)
    entry = _format_of(record)
    found = entry.channels(record, Options())
    return RecordContents(
        entry.name,
        tuple((channel.number, channel.label) for channel in found),
        tuple(channel.vertical for channel in found),
    )


def read_motion(
    path: str | os.PathLike[str],
    *,
    channel: int | str | None = None,
    units: str | None = None,
    dt: float | None = None,
    allow_high_pga: bool = False,
) -> GroundMotion:
    """Read one component of ground motion; the format is told by the content.

    Parameters
    ----------
    path : path
        PEER AT2, CSMIP/CESMD V2, COSMOS v1.20, USGS SMC, K-NET and KiK-net (also as CSV), JMA CSV,
        ESM/ITACA and AFAD (DYNA 1.2), AFAD in three columns, GeoNet V1A and V2A, RENADIC, USC
        Volume 1 (only with `dt`), "NPTS DT" and a list of values, or plain columns (time and
        acceleration, blanks, tabs, commas or semicolons); each also compressed as .gz.
    channel : int or str, optional
        Which component of a file with several: its number in the file, or its label ("UP").
        Columns of a table are counted from 1 behind the time column, or named.
    units : str, optional
        Unit of acceleration, where the file does not state it: "g", "m/s2", "cm/s2", "gal" ...
        It never overrides what the file states.
    dt : float, optional
        Time step, s, where the file does not state it; for unevenly sampled files the step to
        resample to.  It never overrides what the file states.
    allow_high_pga : bool
        Take a record with a PGA over 3 g for what it is.

    Returns
    -------
    GroundMotion
        In m/s2 and s.  `notes` says what was done to the numbers and in which format they came.

    Raises
    ------
    InputError
        One line that names the file, the fault (with its line where it has one) and the remedy.
    """
    record = open_record(path)
    options = Options(channel, units, _given_dt(record, dt))
    entry = _format_of(record)
    chosen = _choose(record, entry.channels(record, options), channel)
    series = chosen.read()
    if not PLAUSIBLE_DT[0] <= series.dt <= PLAUSIBLE_DT[1]:
        raise record.fault(
            f"a time step of {series.dt:g} s is implausible for a record "
            f"({PLAUSIBLE_DT[0]:g} to {PLAUSIBLE_DT[1]:g} s); check the header or the time column"
        )
    if series.acceleration.size < 2:
        raise record.fault("holds fewer than two samples")
    peak = float(np.max(np.abs(series.acceleration)))
    if not peak <= (POSSIBLE_PGA if allow_high_pga else PLAUSIBLE_PGA):
        remedy = (
            "the unit or the values are wrong"
            if allow_high_pga
            else "check its unit, or say allow_high_pga = true if it is real"
        )
        limit = (POSSIBLE_PGA if allow_high_pga else PLAUSIBLE_PGA) / STANDARD_GRAVITY
        raise record.fault(f"PGA is {peak / STANDARD_GRAVITY:.4g} g, over {limit:g} g; {remedy}")
    plain = Path(path).name.removesuffix(".gz")
    name = one_line(Path(plain).stem)
    if chosen.title:
        name = one_line(f"{name} {chosen.title}")
    notes = (f"format: {entry.name}", *series.notes)
    return GroundMotion(
        name, series.dt, series.acceleration, record.path, tuple(map(one_line, notes))
    )


def _given_dt(record: RecordFile, dt: float | None) -> float | None:
    if dt is None:
        return None
    try:
        value = float(dt)
    except (TypeError, ValueError):
        raise record.fault(f"dt = {shown(str(dt))} is not a number of seconds") from None
    if not PLAUSIBLE_DT[0] <= value <= PLAUSIBLE_DT[1]:
        raise record.fault(
            f"dt = {value:g} s was given; {PLAUSIBLE_DT[0]:g} to {PLAUSIBLE_DT[1]:g} s is possible"
        )
    return value


def _format_of(record: RecordFile) -> _Format:
    marked = not_a_record(record)
    if marked is not None:
        raise record.fault(marked)
    headed = record.lines[0].lstrip().upper().startswith("UNCORRECTED ACCELEROGRAM")
    for entry in _FORMATS:
        if headed and not entry.uncorrected:
            raise record.fault(
                "is an uncorrected (Volume 1) accelerogram of a layout that is not read; use the "
                "corrected one (Volume 2, .V2)"
            )
        if entry.detect(record):
            return entry
    reason = why_no_numbers(record) or (
        "no header that tells the time step and no row of numbers was found"
    )
    raise record.fault(f"is none of the known formats ({', '.join(FORMATS)}): {reason}")


def _choose(record: RecordFile, channels: list[Channel], wanted: int | str | None) -> Channel:
    """The channel asked for, or the only one."""
    listing = ", ".join(channel.title for channel in channels[:24] if channel.title)
    if wanted is None:
        if len(channels) == 1:
            return channels[0]
        raise record.fault(
            f"holds {len(channels)} channels ({listing}); say which: channel = 1 for example"
        )
    text = " ".join(str(wanted).split()).lower()
    found = [c for c in channels if text in (str(c.number), c.label.lower(), c.title.lower())]
    if not found and len(channels) == 1 and channels[0].number is None and text == "1":
        found = channels
    if len(found) == 1:
        return found[0]
    if found:
        raise record.fault(
            f"channel {shown(text)} is there {len(found)} times ({listing}); split the file"
        )
    offer = f"it holds {listing}" if listing else "it holds a single channel: leave channel out"
    raise record.fault(f"has no channel {shown(text)}; {offer}")
