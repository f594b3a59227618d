"""Suites that railquake knows by name."""

from __future__ import annotations

import os
import re
from importlib import resources
from pathlib import Path

from railquake.errors import InputError
from railquake.files import is_file
from railquake.suite.manifest import SuiteRow, read_rows, suite_of_rows
from railquake.suite.model import Suite, SuiteMember

__all__ = ["PAPER_SUITE", "SYNTHETIC_SUITE", "paper_suite", "synthetic_suite"]

PAPER_SUITE = "paper-suite"
"""The 20 records of Gomez and DeJong (2023); the user brings the files."""
SYNTHETIC_SUITE = "synthetic-berkeley"
"""20 synthetic motions that meet the 5 % in 50 years spectrum of Berkeley in the mean."""
SAME_PGA = 0.005
"""Relative difference in PGA below which a record of the same RSN is the component meant."""


def _data(name: str) -> str:
    return (resources.files(__package__) / "data" / name).read_text(encoding="utf-8")


def paper_suite(records: Path | None) -> Suite:
    """The records that Gomez and DeJong (2023) used, with their scale factors.

    A record is looked for under the name in the table (RSN006_IMPVALLH2.AT2), else among the
    files with its RSN in their name, as PEER gives them out (RSN6_IMPVALL.I_I-ELC270.AT2): of the
    two components the one with the PGA that the table states.

    Parameters
    ----------
    records : Path or None
        The user's folder of records.

    Returns
    -------
    Suite

    Raises
    ------
    InputError
        If no folder is given, or records are missing: the first is named, all are counted.
    """
    if records is None:
        raise InputError(
            f"suite {PAPER_SUITE}: its 20 records are not part of railquake; give the folder that "
            "holds them with --records (download them from PEER NGA-West2, ngawest2.berkeley.edu)"
        )
    rows = read_rows(_data("paper_suite.csv"), f"suite {PAPER_SUITE}")
    if records.is_dir():
        rows = tuple(_found(row, records) for row in rows)
    return suite_of_rows(PAPER_SUITE, rows, records, _missing)


def _found(row: SuiteRow, records: Path) -> SuiteRow:
    """The row, with the name that its record has in the folder."""
    if is_file(records / row.file):
        return row
    from railquake.inputs.ground_motion import STANDARD_GRAVITY, read_motion

    pga = float(row.cells["pga_g"]) * STANDARD_GRAVITY
    name = re.compile(rf"rsn0*{row.cells['rsn']}[^0-9].*\.at2", re.IGNORECASE)
    for file in sorted(os.listdir(records)):
        if name.fullmatch(file):
            try:
                motion = read_motion(records / file)
            except InputError:
                continue  # the row stays without its record, which is then named
            if abs(motion.pga - pga) <= SAME_PGA * pga:
                return SuiteRow(row.place, file, row.scale_factor, row.cells | {"name": row.label})
    return row


def _missing(rows: list[SuiteRow], count: int, records: Path) -> str:
    first = rows[0]
    others = f" ({len(rows)} of {count} are missing)" if len(rows) > 1 else ""
    what = f"RSN {first.cells['rsn']}, {first.cells['event']}, {first.cells['station']}"
    return (
        f"suite {PAPER_SUITE}: {first.file} ({what}) is not in {records}{others}; download it from "
        "PEER NGA-West2 (ngawest2.berkeley.edu) by its RSN"
    )


def synthetic_suite() -> Suite:
    """20 synthetic motions from seeds; `railquake.suite.synthetic` has how they were made.

    Returns
    -------
    Suite
        With scale factors of 1: each motion's own PGA is that of the 5 % level.
    """
    header, *rows = _data("synthetic_berkeley.csv").split()
    names = header.split(",")
    members = []
    for row in rows:
        cells = dict(zip(names, row.split(","), strict=True))
        seed = int(cells.pop("seed"))
        table = {"seed": seed} | {name: float(text) for name, text in cells.items()}
        members.append(SuiteMember(f"synthetic-{seed:03d}", {"synthetic": table}, 1.0))
    return Suite(SYNTHETIC_SUITE, tuple(members))
