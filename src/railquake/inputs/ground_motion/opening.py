"""A record's file as lines: read whole, unpacked if need be, and refused if it is no text."""

from __future__ import annotations

import os
import re
import zlib
from pathlib import Path

from railquake.errors import InputError
from railquake.inputs.ground_motion.other_files import binary_kind
from railquake.inputs.ground_motion.text import RecordFile, one_line

__all__ = ["open_record"]

MAX_BYTES = 512 * 1024 * 1024
"""A larger file is refused before it is read: no strong-motion record comes near it."""

MAX_LINE = 4096
"""Longest line, characters; it bounds the work of the header's regular expressions."""

GZIP = b"\x1f\x8b"

_CONTROL = re.compile(rb"[\x00-\x08\x0b\x0e-\x19\x1b-\x1f]")


def open_record(path: str | os.PathLike[str]) -> RecordFile:
    """Read a text file whole, compressed with gzip or not.

    Raises
    ------
    InputError
        If it is missing, not a regular file, not readable, empty, binary or far too large.
    """
    name = one_line(str(path))
    try:
        place = Path(path)
        if not place.exists():
            raise InputError(f"{name}: there is no such file; check the path")
        if place.is_dir():
            raise InputError(f"{name}: is a folder; name one record file in it")
        if not place.is_file():
            raise InputError(f"{name}: is not a regular file")
        if place.stat().st_size > MAX_BYTES:
            raise InputError(f"{name}: over {MAX_BYTES // 2**20} MiB, too large for a record")
        data = place.read_bytes()
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(one_line(f"{name}: cannot be read ({reason})")) from None
    if data.startswith(GZIP):
        data = _decompressed(name, data)
    data = data.rstrip(b"\x1a")  # DOS end-of-file mark of old records
    if not data.strip():
        raise InputError(f"{name}: the file is empty; fetch it again")
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise InputError(f"{name}: UTF-16 text; save it as plain text (UTF-8)")
    if _CONTROL.search(data):
        kind = binary_kind(data)
        if kind is not None:
            raise InputError(f"{name}: is {kind}")
        raise InputError(
            f"{name}: holds binary data, not text; unpack it, or export the record as text"
        )
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = data.decode("latin-1")  # older headers: degree signs, accents
    # Not str.splitlines: it also breaks lines at characters that headers may hold.
    text = text.replace("\r\n", "\n").replace("\r", "\n").replace("\x0c", " ")
    lines = text.split("\n")
    while lines and not lines[-1].strip():
        lines.pop()
    if not lines:
        raise InputError(f"{name}: the file is empty; fetch it again")
    record = RecordFile(name, lines)
    longest = max(range(len(lines)), key=lambda index: len(lines[index]))
    if len(lines[longest]) > MAX_LINE:
        raise record.fault(
            f"has {len(lines[longest])} characters, over {MAX_LINE}; this is not a record of "
            "lines: if all values stand on one line, put one on each",
            longest,
        )
    return record


def _decompressed(name: str, data: bytes) -> bytes:
    """The content of a gzip file, all its members, up to the largest size that is read."""
    parts: list[bytes] = []
    size = 0
    try:
        while data.startswith(GZIP):
            unpacking = zlib.decompressobj(wbits=31)
            part = unpacking.decompress(data, MAX_BYTES + 1 - size)
            size += len(part)
            if size > MAX_BYTES:
                raise InputError(f"{name}: over {MAX_BYTES // 2**20} MiB unpacked, too large")
            if not unpacking.eof:
                raise InputError(f"{name}: the .gz file is cut off; fetch it again")
            parts.append(part)
            data = unpacking.unused_data
    except zlib.error:
        raise InputError(f"{name}: the .gz file is damaged; fetch it again") from None
    if data.strip(b"\x00"):
        raise InputError(f"{name}: bytes follow the end of the .gz file; fetch it again")
    return b"".join(parts)
