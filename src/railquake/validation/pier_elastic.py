"""The pier with an elastic hinge, live against OpenSees."""

from __future__ import annotations

from pathlib import Path

from railquake.validation import pier_records
from railquake.validation.comparison import Outcome

TITLE = "The pier with an elastic hinge, five records, OpenSees run live"
SOURCE = "OpenSees (Python wheel `opensees`), run by the comparison itself."
WHAT = pier_records.SETTINGS + " The pier is `bart-berkeley` with the hinge elastic."
WHY = """The same equations in the same steps. The bar is 0.1 % of each history's peak; a tenth of
it is asked for, and what is found is rounding."""

NEEDS = ("fem", "data")
FILES = pier_records.FILES
SLOW = True
TOLERANCE = 1e-4


def compare(data: Path | None) -> Outcome:
    """Run the five records."""
    return pier_records.compare_pier(
        data, {"preset": "bart-berkeley", "hinge": "elastic"}, TOLERANCE
    )
