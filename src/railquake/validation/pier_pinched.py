"""The pier with a strongly pinched and degrading hinge, live against OpenSees."""

from __future__ import annotations

from pathlib import Path

from railquake.validation import pier_records
from railquake.validation.comparison import Outcome

TITLE = "The pier with strong pinching and degradation, five records, OpenSees run live"
SOURCE = """OpenSees (Python wheel `opensees`) with its material `DegradingPinchedBW`, run by the
comparison itself."""
WHAT = f"""{pier_records.SETTINGS} The column is `bart-berkeley`'s; its hinge is none that anybody
measured but a set that exercises every term of the law within its valid range: 85 % of the
stiffness lost to pinching within 4 mrad (`rho_p` 0.85, `sigma` 0.004, `u` 2, `eps_p` 0.02), damage
by energy and by rotation (`rho_eps` 0.03, `rho_x` 0.25, `phi` 0.8), stiffness and strength lost
with it (`delta_k` 6, `delta_f` 0.3), unequal unloading (`eta0` 0.2), `alpha` 0.02.

OpenSees' material has traps that the set and the settings avoid. It takes `(x/sigma)^u` without
absolute values, which is wrong for odd and no number for fractional `u` where x is negative: `u`
is even here. Its tolerance on z is absolute: it is set to 1e-12, where z is of order 5e-4. Its
tangent forgets the damage's change at a new largest rotation, and is an unloading one for a zero
increment: that costs iterations but no accuracy, since Newton's method is carried to the end."""
WHY = """The same equations in the same steps: 0.1 % of each history's peak, with the solver as it
is by default. Pinching sets in within a few steps here, and where it does the default tolerance of
Newton's method (1e-4 of a yielded hinge's z) may be felt: by less than 1e-4 in the moment of a
single step. That nothing else is left is shown by the run with Newton's method carried to 1e-6,
which must agree within 1e-6."""

NEEDS = ("fem", "data")
FILES = pier_records.FILES
SLOW = True
TOLERANCE = 1e-3
PINCHED = {
    "alpha": 0.02, "eta0": 0.2, "rho_eps": 0.03, "rho_x": 0.25, "phi": 0.8, "delta_k": 6.0,
    "delta_f": 0.3, "sigma": 0.004, "u": 2.0, "eps_p": 0.02, "rho_p": 0.85,
}  # fmt: skip


def compare(data: Path | None) -> Outcome:
    """Run the five records."""
    pier = {"preset": "bart-berkeley", "bouc_wen": PINCHED}
    return pier_records.compare_pier(data, pier, TOLERANCE)
