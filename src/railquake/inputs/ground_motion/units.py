"""Units of acceleration and time as record files spell them.

This is a closed table on purpose: a spelling that is not in it is an error, never a guess.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from railquake.inputs.ground_motion.motion import STANDARD_GRAVITY

# Spelling after `_plain` -> factor to m/s2.  "/s/s" is folded into "/s2" there.
ACCELERATION = {
    "g": STANDARD_GRAVITY,
    "g's": STANDARD_GRAVITY,
    "mg": 1e-3 * STANDARD_GRAVITY,
    "g/10": 0.1 * STANDARD_GRAVITY,
    "m/s2": 1.0,
    "cm/s2": 0.01,
    "mm/s2": 0.001,
    "gal": 0.01,
    "gals": 0.01,
    "in/s2": 0.0254,
    "inch/s2": 0.0254,
    "ft/s2": 0.3048,
}
"""Factor from each known unit of acceleration to m/s2."""

TIME = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0, "h": 3600.0}
"""Factor from each known unit of time to s."""

# A word or sign between is required: "unit 4" in a station's name states no unit.
_STATEMENT = re.compile(
    r"\bunits?\b\s*(?:(?:of|are|is|in)\b\s*[:=]?|[:=]|(?=\())\s*\(?([^\s,;()]+)", re.IGNORECASE
)


def _plain(text: str) -> str:
    """One spelling per unit: lower case, no blanks, "s" for seconds, "/s2" for "/s/s"."""
    plain = text.strip().lower().replace("\u00b2", "2").strip("'\" \t,;:")
    if plain.endswith(".") or plain.startswith("."):
        plain = plain.strip(".")
    plain = re.sub(r"\s+|\*|\^", "", plain)
    plain = re.sub(r"seconds?|secs?", "s", plain)
    plain = plain.replace("_per_", "/").replace("_", "/")
    plain = re.sub(r"ps2$|ps/s$|ps/2$", "/s2", plain)
    plain = re.sub(r"s-2$", "/s2", plain)
    return re.sub(r"/s/s$|/s/2$|/+s2$", "/s2", plain)


def acceleration_factor(text: str) -> float | None:
    """Factor from the unit spelt `text` to m/s2, or None if the spelling is not known."""
    return ACCELERATION.get(_plain(text))


def time_factor(text: str) -> float | None:
    """Factor from the unit spelt `text` to s, or None if the spelling is not known."""
    return TIME.get(_plain(text))


def known_units() -> str:
    """The units of acceleration that a user may name, for error messages."""
    return "g, m/s2, cm/s2, gal, mm/s2, in/s2, ft/s2, mg, g/10"


def unit_statements(lines: Iterable[str]) -> list[str]:
    """What header lines say after the word "units", in order of appearance."""
    return [match.group(1) for line in lines for match in _STATEMENT.finditer(line)]
