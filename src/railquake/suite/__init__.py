"""Suites of ground motions and the hazard that they are to represent."""

from __future__ import annotations

import difflib
import os
from pathlib import Path

from railquake.errors import InputError
from railquake.suite.built_in import PAPER_SUITE, SYNTHETIC_SUITE, paper_suite, synthetic_suite
from railquake.suite.hazard import Hazard, TargetSpectrum, hazard_names, load_hazard, read_hazard
from railquake.suite.manifest import read_manifest
from railquake.suite.model import Suite, SuiteMember
from railquake.suite.selection import Selection, manifest_text, select_records
from railquake.suite.spectra import SuiteSpectra, spectral_acceleration, suite_spectra

__all__ = [
    "SUITES",
    "Hazard",
    "Selection",
    "Suite",
    "SuiteMember",
    "SuiteSpectra",
    "TargetSpectrum",
    "hazard_names",
    "load_hazard",
    "load_suite",
    "manifest_text",
    "read_hazard",
    "select_records",
    "spectral_acceleration",
    "suite_spectra",
]

SUITES = (PAPER_SUITE, SYNTHETIC_SUITE)
"""Names of the suites that are built in."""


def load_suite(name_or_path: str | Path, records: Path | None = None) -> Suite:
    """Load a suite by its name or from its manifest.

    Parameters
    ----------
    name_or_path : str or Path
        One of `SUITES`, or the path of a manifest: a CSV with the columns file and scale_factor.
    records : Path, optional
        The folder that holds the records; by default the manifest's own.

    Returns
    -------
    Suite

    Raises
    ------
    InputError
        One line: if no such suite or manifest is known, a row of it is wrong, or records are
        missing (the first is named, all are counted).
    """
    name = os.fspath(name_or_path)
    if name == PAPER_SUITE:
        return paper_suite(records)
    if name == SYNTHETIC_SUITE:
        return synthetic_suite()
    if not (name.lower().endswith((".csv", ".txt")) or os.sep in name or Path(name).exists()):
        near = difflib.get_close_matches(name, SUITES, 1)
        hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(SUITES)}"
        raise InputError(f'suite "{name}": is not known; {hint}; or give a manifest, suite.csv')
    return read_manifest(Path(name), records)
