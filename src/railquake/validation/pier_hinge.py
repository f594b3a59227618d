"""The pier with its degrading hinge, live against OpenSees."""

from __future__ import annotations

from pathlib import Path

from railquake.validation import pier_records
from railquake.validation.comparison import Outcome

TITLE = "The pier with its degrading hinge, five records, OpenSees run live"
SOURCE = """OpenSees (Python wheel `opensees`) with its material `DegradingPinchedBW`, run by the
comparison itself."""
WHAT = pier_records.SETTINGS + " The pier and its hinge are `bart-berkeley` as it ships."
WHY = """The same equations in the same steps. The bar is 0.1 % of each history's peak; a tenth of
it is asked for. What is left comes from the solver's own tolerance of z, 1e-4 of a yielded hinge,
whose error goes with the square."""

NEEDS = ("fem", "data")
FILES = pier_records.FILES
SLOW = True
TOLERANCE = 1e-4


def compare(data: Path | None) -> Outcome:
    """Run the five records."""
    return pier_records.compare_pier(data, {"preset": "bart-berkeley"}, TOLERANCE)
