"""Horizontal or vertical: from what a record's header says, and only then from its file's name.

One vocabulary serves labels, stream codes and names.  Codes are those of the SEED manual (band,
instrument, orientation: "HNZ"), of K-NET and KiK-net ("Dir." 1 to 6, of which 3 and 6 are
vertical), of COSMOS (table of orientations: 400 up, 401 down, 402 vertical) and the words that
agencies write.
"""

from __future__ import annotations

import re
from pathlib import Path

__all__ = ["vertical_by_label", "vertical_by_name", "vertical_by_seed_code"]

_WORDS = re.compile(r"up|down|dwn|dn|vert\w*|ver|vrt|u-?d|ud[12]|[uvz]|v1", re.IGNORECASE)
"""Words that stand for a vertical component where nothing else does."""
_SEED = re.compile(r"[a-z][hlgn][zne123rt]", re.IGNORECASE)
"""Band, instrument (H, L: seismometer; G, N: accelerometer), orientation."""
_AZIMUTH = re.compile(
    r"\b[0-9]{1,3}\s*(?:deg\w*|\u00b0)|\b[ns]\s*[0-9]{1,2}\s*[ew]\b|^\s*[0-9]{1,3}\s*$",
    re.IGNORECASE,
)
_HORIZONTAL = re.compile(
    r"n-?s|e-?w|s-?n|w-?e|[nesw]|north|east|south|west|h[12]|x|y|long\w*|tran\w*|rad\w*",
    re.IGNORECASE,
)
_IN_LABEL = re.compile(r"(?<![\w-])(?:up|down|dwn|vert\w*|vrt|u-?d)(?![\w-])", re.IGNORECASE)
_VOLUME = re.compile(r"\.v[0-3][ac]?", re.IGNORECASE)
_COMPRESSED = ".gz"


def vertical_by_seed_code(code: str) -> bool | None:
    """Whether a stream code such as "HNZ" is of a vertical component; None for no such code."""
    plain = code.strip()
    return plain[-1] in "zZ" if _SEED.fullmatch(plain) else None


def vertical_by_label(label: str) -> bool | None:
    """Whether what a header calls a component stands for a vertical one.

    Parameters
    ----------
    label : str
        "90 DEG", "UP", "N-S", "HNZ", "Chan 3: Vertical".

    Returns
    -------
    bool or None
        None where the label does not tell.
    """
    plain = label.strip(" \t.,;:()'\"")
    if not plain:
        return None
    code = vertical_by_seed_code(plain)
    if code is not None:
        return code
    if _WORDS.fullmatch(plain):
        return True
    if _HORIZONTAL.fullmatch(plain):
        return False
    if _IN_LABEL.search(plain):
        return True
    return False if _AZIMUTH.search(plain) else None


def vertical_by_name(path: Path) -> bool:
    """Whether a record file's name marks a vertical component.

    The last part of the name decides ("ELC-UP", "TCU038-V", "acc_vertical", "A_V1"), its ending
    (".UD2"), or a stream code among its parts ("BK.CMB.BHZ.00").  A letter V elsewhere is a
    station's, and ".V1" a volume.
    """
    name = path.name
    if name.lower().endswith(_COMPRESSED):
        name = name[: -len(_COMPRESSED)]
    stem, suffix = Path(name).stem, Path(name).suffix
    ending = suffix[1:]
    if _VOLUME.fullmatch(suffix):
        ending = ""
    codes = [part for part in re.split(r"[-_. ]+", f"{stem}.{ending}") if _SEED.fullmatch(part)]
    if codes:
        return codes[-1][-1] in "zZ"
    if ending and _WORDS.fullmatch(ending) and len(ending) > 1:
        return True
    parts = re.split(r"[-_.]+", stem)
    while len(parts) > 2 and parts[-1].isdigit() and len(parts[-1]) <= 2:
        parts.pop()  # a location code behind the component: "UP.00"
    last = parts[-1]
    if " " in last:
        last = last.rpartition(" ")[2]
        return len(last) > 1 and _WORDS.fullmatch(last) is not None
    alone = len(parts) == 1
    if _WORDS.fullmatch(last) and not (alone and len(last) == 1):
        return True
    return re.search(r"[0-9a-z]dwn$", last, re.IGNORECASE) is not None
