"""What stands above columns of numbers: names, units, the time step, the number of rows."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from railquake.inputs.ground_motion import units as unit_table
from railquake.inputs.ground_motion.orientation import vertical_by_label
from railquake.inputs.ground_motion.text import NUMBER, RecordFile, shown, to_float

__all__ = ["Heads", "read_heads", "stated_count", "stated_step", "stated_unit"]

_BRACKETS = re.compile(r"([^()\[\]]*)[(\[]([^()\[\]]*)[)\]]")
_UNITS_LINE = re.compile(r"^\W*units?\s*[:=]\s*(.+)$", re.IGNORECASE)
_UNIT_OF_TIME = r"(ms|s|secs?|seconds?|hz)\b"
_STEP = re.compile(
    r"(?:\b|_)(?:sampl(?:ing|e)[ _]?interval|time[ _]?(?:step|interval)|delta[ _]?t|dt)"
    rf"[ _]*[(\[]?(?:{_UNIT_OF_TIME})?[)\]]?\s*[:=]\s*({NUMBER})\s*(?:{_UNIT_OF_TIME})?",
    re.IGNORECASE,
)
_RATE = re.compile(
    r"\bsampl(?:ing|e)[ _]?(?:rate|freq\w*)[ _]*[(\[]?(?:hz)?[)\]]?\s*[:=]\s*"
    rf"({NUMBER})\s*(?:hz|/s|sps)?",
    re.IGNORECASE,
)
_COUNT = re.compile(
    r"\b(?:ndata|npts|(?:number|no\.?) of (?:data|points|samples|values)(?: points)?)\s*[:=]\s*"
    r"([0-9]{1,9})\b",
    re.IGNORECASE,
)
_TIME_NAME = re.compile(r"t|t[ _]*\W.*|time\b.*|times|zeit\b.*|sec\w*|s", re.IGNORECASE)
_MOTION_NAME = re.compile(r"acc\w*\b.*|a[xyzgh]?|a[ _]\w+|comp\w*.*", re.IGNORECASE)


@dataclass(frozen=True)
class Heads:
    """Names and units of columns.

    Parameters
    ----------
    names : tuple of str
        Empty where there is none.
    units : tuple of (str or None)
        As written.
    certain : tuple of bool
        False for a unit that a name may end in by chance: the g of "a_g" is the ground's, too.
    time : bool or None
        Whether the first column is named as time (True) or as a component (False).
    """

    names: tuple[str, ...]
    units: tuple[str | None, ...]
    certain: tuple[bool, ...]
    time: bool | None


def read_heads(
    record: RecordFile, start: int, count: int, split: Callable[[str], list[str]]
) -> Heads:
    """Names and units of `count` columns whose first row of numbers is line `start`.

    Names stand in the last line above the numbers, if it has so many; units in brackets, behind an
    underscore, or in a line "Units: s, g".
    """
    names, certain = [""] * count, [True] * count
    units: list[str | None] = [None] * count
    named = next((i for i in range(start - 1, -1, -1) if _bare(record.lines[i])), None)
    if named is not None and not any(
        pattern.search(record.lines[named]) for pattern in (_UNITS_LINE, _STEP, _RATE, _COUNT)
    ):
        line = _bare(record.lines[named])
        bracketed = _BRACKETS.findall(line)
        if len(bracketed) == count:
            names = [name.strip(" \t,;:\"'") for name, _ in bracketed]
            units = [unit.strip() or None for _, unit in bracketed]
        else:
            fields = [field.strip("\"' ") for field in split(line)]
            if len(fields) == count:
                names = fields
                found = [_unit_of_name(name, place == 0) for place, name in enumerate(fields)]
                units, certain = [unit for unit, _ in found], [sure for _, sure in found]
    for line in record.lines[:start]:
        match = _UNITS_LINE.match(line)
        listed = re.split(r"[,;\t]", match.group(1)) if match else []
        if len(listed) == count and count > 1:
            units = [text.strip(" ()[]\"'") or None for text in listed]
            certain = [True] * count
    return Heads(tuple(names), tuple(units), tuple(certain), _first_is_time(names[0], units[0]))


def _bare(line: str) -> str:
    return line.strip().strip("#%/!").strip()


def _first_is_time(name: str, unit: str | None) -> bool | None:
    if _TIME_NAME.fullmatch(name) or (unit and unit_table.time_factor(unit) is not None):
        return True
    moves = unit is not None and unit_table.acceleration_factor(unit) is not None
    if moves or (name and vertical_by_label(name) is not None) or _MOTION_NAME.fullmatch(name):
        return False
    return None


def _unit_of_name(name: str, first: bool) -> tuple[str | None, bool]:
    """The unit in a column's name, and whether it is one for certain.

    A single letter behind an underscore may mean something else: "a_g" ground, "acc_h" horizontal.
    """
    match = _BRACKETS.search(name)
    if match:
        return match.group(2).strip() or None, True
    parts = name.split("_")
    for place in range(1, len(parts)):
        unit = "_".join(parts[place:])
        if unit_table.acceleration_factor(unit) is not None:
            return unit, len(unit) > 1
        if first and unit_table.time_factor(unit) is not None:
            return unit, True
    return None, True


def stated_unit(record: RecordFile, start: int) -> str | None:
    """The unit of acceleration that a line above the numbers states by the word "units".

    Raises
    ------
    InputError
        If two different ones are stated.
    """
    words = unit_table.unit_statements(record.lines[:start])
    for line in record.lines[:start]:
        match = _UNITS_LINE.match(line)
        if match:
            words += [word.strip(" ()[]\"'") for word in re.split(r"[,;\t]", match.group(1))]
    known = {unit_table.acceleration_factor(word): word for word in words}
    unknown = known.pop(None, None)
    if len(known) > 1:
        raise record.fault(
            f"the header names different units ({', '.join(map(shown, known.values()))}); correct "
            "it, or name one in the column's head"
        )
    if known:
        return next(iter(known.values()))
    others = [word for word in words if unit_table.time_factor(word) is None]
    return unknown if others else None


def stated_step(lines: Sequence[str]) -> tuple[float, int] | None:
    """The time step, s, that a line states, and the line's index."""
    for index, line in enumerate(lines):
        match = _STEP.search(line)
        if match:
            unit = (match.group(3) or match.group(1) or "s").lower()
            factor = unit_table.time_factor(unit)
            return ((to_float(match.group(2)) or 0.0) * factor, index) if factor else None
        match = _RATE.search(line)
        if match:
            rate = to_float(match.group(1)) or 0.0
            return (1.0 / rate if rate > 0.0 else 0.0), index
    return None


def stated_count(lines: Sequence[str]) -> tuple[int, int] | None:
    """The number of samples that a line states, and the line's index."""
    for index, line in enumerate(lines):
        match = _COUNT.search(line)
        if match:
            return int(match.group(1)), index
    return None
