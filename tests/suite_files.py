"""The paper's twenty records, for tests that run them; see ``../shared/records/paper_suite``."""

import csv
from pathlib import Path

import numpy as np

from railquake.inputs.ground_motion import GroundMotion, read_motion

# The manifest's order; named here so that the tests' names do not need the files.
RECORDS = (
    "RSN006_IMPVALLH2", "RSN020_NCALIFH1", "RSN159_IMPVALLH2", "RSN161_IMPVALLH2",
    "RSN169_IMPVALLH1", "RSN169_IMPVALLH2", "RSN170_IMPVALLH1", "RSN170_IMPVALLH2",
    "RSN171_IMPVALLH1", "RSN173_IMPVALLH2", "RSN174_IMPVALLH1", "RSN174_IMPVALLH2",
    "RSN178_IMPVALLH1", "RSN180_IMPVALLH1", "RSN181_IMPVALLH1", "RSN182_IMPVALLH1",
    "RSN182_IMPVALLH2", "RSN183_IMPVALLH1", "RSN183_IMPVALLH2", "RSN185_IMPVALLH2",
)  # fmt: skip

# Hazard levels of the paper relative to 5 % in 50 years: 50, 10, 5 and 2 % in 50 years.
LEVELS = (0.21, 0.74, 1.0, 1.38)


def record_path(shared: Path, record: str) -> Path:
    """File of a record."""
    return shared / "records" / "paper_suite" / f"{record}.AT2"


def scale_factor(shared: Path, record: str) -> float:
    """The study's scale factor of a record, for 5 % in 50 years."""
    with open(shared / "records" / "paper_suite" / "manifest.csv", newline="") as file:
        factors = {row["file"]: float(row["scale_factor"]) for row in csv.DictReader(file)}
    return factors[f"{record}.AT2"]


def strong_part(path: Path, before: float, after: float) -> GroundMotion:
    """The record from ``before`` to ``after`` seconds around its peak."""
    motion = read_motion(path)
    peak = int(np.argmax(np.abs(motion.acceleration)))
    first = max(0, peak - round(before / motion.dt))
    last = peak + round(after / motion.dt)
    return GroundMotion(motion.name, motion.dt, motion.acceleration[first:last])
