"""Suites that railquake knows by name."""

from __future__ import annotations

from importlib import resources
from pathlib import Path

from railquake.errors import InputError
from railquake.suite.manifest import read_rows, suite_of_rows
from railquake.suite.model import Suite, SuiteMember

__all__ = ["PAPER_SUITE", "SYNTHETIC_SUITE", "paper_suite", "synthetic_suite"]

PAPER_SUITE = "paper-suite"
"""The 20 records of Gomez and DeJong (2023); the user brings the files."""
SYNTHETIC_SUITE = "synthetic-berkeley"
"""20 synthetic motions from seeds."""


def paper_suite(records: Path | None) -> Suite:
    """The records that Gomez and DeJong (2023) used, with their scale factors.

    Parameters
    ----------
    records : Path or None
        The user's folder of records.

    Raises
    ------
    InputError
        If no folder is given, or a record is missing in it.
    """
    if records is None:
        raise InputError(
            f"suite {PAPER_SUITE}: its 20 records are not part of railquake; give the folder that "
            "holds them with --records (they come from PEER NGA-West2)"
        )
    where = "paper_suite.csv"
    text = (resources.files(__package__) / "data" / where).read_text(encoding="utf-8")
    return suite_of_rows(PAPER_SUITE, where, read_rows(text, where), records)


def synthetic_suite() -> Suite:
    """20 synthetic motions for demonstrations."""
    return Suite(
        SYNTHETIC_SUITE,
        tuple(
            SuiteMember(f"synthetic-{seed:02d}", {"synthetic": {"seed": seed, "duration": 20.0}}, 1)
            for seed in range(1, 21)
        ),
    )
