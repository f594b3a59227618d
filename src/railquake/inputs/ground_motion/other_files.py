"""Files that are no record, or of a layout that is not read: what each one is, for the message."""

from __future__ import annotations

import re

from railquake.inputs.ground_motion.text import RecordFile

__all__ = ["binary_kind", "not_a_record", "why_no_numbers"]

_STAMP = re.compile(r"^\W*[0-9]{2,4}[-/.][0-9]{1,2}[-/.][0-9]{1,4}[ T]+[0-9]{1,2}:[0-9]{2}")
_CLOCK = re.compile(r"^\W*[0-9]{1,2}:[0-9]{2}(?::[0-9]{2})?(?:\.[0-9]+)?\s*[;,\s]")
_COMMA = re.compile(
    r"^\s*[+-]?[0-9]+,[0-9]+(?:[eE][+-]?[0-9]+)?(?:[;\s]\s*[+-]?[0-9]+(?:,[0-9]+)?(?:[eE][+-]?[0-9]+)?)*;?\s*$"
)
_SPECTRA = re.compile(r"^\s*Response and Fourier amplitude spectra", re.IGNORECASE)
_SAC_VERSION_AT, _SAC_VERSIONS = 304, (6, 7)


def binary_kind(data: bytes) -> str | None:
    """What a file that is no text is, and what to do with it; None where that cannot be told."""
    if data.startswith(b"PK\x03\x04"):
        return "a zip archive; unpack it and name one record file"
    if data.startswith((b"BZh", b"\xfd7zXZ", b"7z\xbc\xaf")):
        return "a compressed file; unpack it first (of these only .gz is read)"
    if re.match(rb"[0-9]{6}[DRQM][ \x00][A-Z0-9 ]{5}", data) or data.startswith(b"MS\x03"):
        return (
            "miniSEED, which holds counts without their scale; remove the instrument's response "
            "(with its StationXML) and export the record as text"
        )
    version = data[_SAC_VERSION_AT : _SAC_VERSION_AT + 4]
    for order in ("little", "big"):
        if len(version) == 4 and int.from_bytes(version, order) in _SAC_VERSIONS:
            return "a binary SAC file, which does not state its unit; export the record as text"
    if data.startswith((b"\x89HDF", b"CDF\x01", b"CDF\x02")):
        return "an HDF5 or NetCDF file; export the record as text"
    if data.startswith(b"MATLAB"):
        return "a MATLAB file; export the record as text"
    return None


def not_a_record(record: RecordFile) -> str | None:
    """What a text file is, if its first line shows that it holds no accelerogram."""
    first = record.lines[0].lstrip().lower()
    if _SPECTRA.match(first):
        return (
            "holds response and Fourier spectra (CSMIP/CESMD Volume 3), no accelerogram; use the "
            "corrected record (Volume 2, .V2)"
        )
    if first.startswith("<"):
        kind = "StationXML" if any("StationXML" in line for line in record.lines[:5]) else "XML"
        return f"is {kind}, no record; name the record's own file"
    if first.startswith("{"):
        return "is JSON, no record; name the record's own file"
    if any("summary of peer ground motion" in line.lower() for line in record.lines[:10]):
        return "is PEER's report of a search, no record; give it as the manifest of a suite"
    return None


def why_no_numbers(record: RecordFile) -> str | None:
    """Why no line holds numbers only: dates and times of day, or decimal commas."""
    lines = [line for line in record.lines[:200] if line.strip()]
    body = [line.replace('"', "") for line in lines[-20:]]
    if any(_STAMP.match(line) or _CLOCK.match(line) for line in body):
        return (
            "its first column holds dates or times of day; write the time as seconds from the "
            "start, or leave the column out and give dt"
        )
    if any(_COMMA.match(line) for line in body):
        return "its numbers have decimal commas; write decimal points"
    return None
