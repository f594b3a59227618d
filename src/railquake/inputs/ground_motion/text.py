"""What all readers of record files share: the file as lines, numbers out of lines, and faults."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from railquake.errors import InputError
from railquake.inputs.ground_motion import units as unit_table

LARGEST = 1e100
"""A larger number is taken for damage; sums and squares of the others cannot overflow."""

NUMBER = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eEdD][+-]?[0-9]+)?"
"""Regular expression of one decimal number, Fortran's D exponent included."""

_OF_NUMBERS = b"0123456789eEdD.+- \t"
_NOT_IN_NUMBERS = re.compile(r"[^0-9eEdD.+\- \t]")
_SHAPE = re.compile(r"^[+-]?[0-9]*\.([0-9]*)(?:[eEdD]([+-]?[0-9]*))?$")


@dataclass(frozen=True)
class Series:
    """One component as a reader hands it over, before any check of its size.

    Parameters
    ----------
    dt : float
        Time step, s.
    acceleration : ndarray, shape (n,)
        Acceleration, m/s2.
    notes : tuple of str
        Remarks for the user.
    """

    dt: float
    acceleration: NDArray[np.float64]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Channel:
    """A component that a file offers; its numbers are only read when `read` is called.

    Parameters
    ----------
    number : int or None
        The number that the file gives it.
    label : str
        What the file calls it ("90 DEG", "UP").
    read : callable
        Returns the `Series`, or raises `InputError`.
    vertical : bool or None
        Whether the header says that it is a vertical component; None where it does not tell.
    """

    number: int | None
    label: str
    read: Callable[[], Series]
    vertical: bool | None = None

    @property
    def title(self) -> str:
        """Number and label in one piece."""
        parts = [] if self.number is None else [str(self.number)]
        return ": ".join([*parts, self.label] if self.label else parts)


@dataclass(frozen=True)
class Options:
    """What the caller says beside the file; see `read_motion`."""

    channel: int | str | None = None
    units: str | None = None
    dt: float | None = None


@dataclass(frozen=True)
class RecordFile:
    """A text file as a list of lines; `lines[0]` is line 1 in messages."""

    path: str
    lines: list[str]

    def fault(self, message: str, line: int | None = None) -> InputError:
        """An `InputError` that names the file and, if given, the line (counted from 0 here)."""
        place = "" if line is None else f", line {line + 1}"
        return InputError(one_line(f"{self.path}{place}: {message}"))

    def line(self, index: int) -> str:
        """The line at an index, or a fault if the file ends before it."""
        if index >= len(self.lines):
            raise self.fault(f"the file ends after line {len(self.lines)}, inside its header")
        return self.lines[index]


def one_line(message: str) -> str:
    """`message` with line breaks and other unprintable characters made harmless."""
    return "".join(c if c.isprintable() else " " for c in message)


def shown(token: str) -> str:
    """A piece of a file, short enough for a message."""
    return f"'{token}'" if len(token) <= 32 else f"'{token[:29]}...'"


def bad_number(token: str) -> str:
    """What to say about a piece of text that should be a number."""
    plain = token.strip()
    if "*" in plain:
        stars = plain[plain.index("*") :]
        return f"{shown(stars)} stands for a number that did not fit its field; repair the record"
    if plain.lower().lstrip("+-") in {"nan", "inf", "infinity", "1.#qnan", "1.#ind", "1.#inf"}:
        return f"{shown(plain)} is not a finite number; repair or cut the record"
    if re.fullmatch(NUMBER, plain):
        return f"{shown(plain)} is beyond any measurement; the file is damaged"
    if not plain:
        return "a value is missing (empty field)"
    return f"{shown(plain)} is not a number; the file is damaged, cut off or of another format"


def to_float(token: str) -> float | None:
    """One decimal number from ASCII text, or None: not 'nan', not '1_000', not infinite."""
    plain = token.strip()
    if not plain or not plain.isascii() or _NOT_IN_NUMBERS.search(plain):
        return None
    try:
        value = float(plain.replace("D", "E").replace("d", "e"))
    except ValueError:
        return None
    return value if abs(value) <= LARGEST else None


def convert(record: RecordFile, tokens: Sequence[str], lines: Sequence[int]) -> NDArray[np.float64]:
    """Turn tokens into numbers, or name the first bad one.

    Parameters
    ----------
    record : RecordFile
        For messages.
    tokens : sequence of str
        The numbers as text.
    lines : sequence of int
        The index of the line of each token; only looked at when there is a fault.
    """
    # The one pass over the characters keeps float() from taking 'nan', '1_000' or foreign digits.
    joined = " ".join(tokens)
    if joined.isascii() and not joined.encode().translate(None, _OF_NUMBERS):
        if "d" in joined or "D" in joined:
            tokens = [token.replace("D", "E").replace("d", "e") for token in tokens]
        try:
            values = np.fromiter(map(float, tokens), np.float64, len(tokens))
        except ValueError:
            pass
        else:
            if values.size == 0 or np.max(np.abs(values)) <= LARGEST:
                return values
    for place, token in enumerate(tokens):
        if to_float(token) is None:
            line = lines[place]
            first = place
            while first > 0 and lines[first - 1] == line:
                first -= 1
            # Asterisks fill their field, so they may be glued to the number before them.
            glued = to_float(token.split("*")[0]) is not None
            message = f"value {place - first + 1 + glued}: {bad_number(token)}"
            raise record.fault(message, line)
    raise record.fault("the values cannot be read as numbers")  # pragma: no cover


def free_numbers(record: RecordFile, start: int, stop: int | None = None) -> NDArray[np.float64]:
    """All numbers of some lines, separated by blanks."""
    rows = [line.split() for line in record.lines[start:stop]]
    tokens = [token for row in rows for token in row]
    return convert(record, tokens, _LineOf(start, [len(row) for row in rows]))


def fixed_numbers(
    record: RecordFile, start: int, count: int, width: int, *, indent: int = 0
) -> NDArray[np.float64]:
    """`count` numbers in fields of `width` characters, as many to a line as there are.

    The fields are right-justified, so a line whose length is no multiple of the width was cut.

    Raises
    ------
    InputError
        If the file ends before `count` numbers, or a field is not a finite number.
    """
    tokens: list[str] = []
    per_line: list[int] = []
    index = start
    while len(tokens) < count:
        if index >= len(record.lines):
            raise record.fault(
                f"{count} values are announced and the file ends after {len(tokens)}; "
                "it is cut off: fetch it again"
            )
        line = record.lines[index].rstrip()[indent:]
        fields = [line[at : at + width] for at in range(0, len(line), width)]
        if not fields:
            raise record.fault(
                f"an empty line where value {len(tokens) + 1} of {count} should be", index
            )
        if len(fields[-1]) != width and to_float(fields[-1]) is not None:
            raise record.fault(
                f"value {len(fields)}: {shown(fields[-1])} does not fill its field of {width} "
                "characters; the line is cut off",
                index,
            )
        tokens += fields
        per_line.append(len(fields))
        index += 1
    values = convert(record, tokens, _LineOf(start, per_line))
    if len(values) != count:
        raise record.fault(
            f"{count} values are announced and the data's last line holds {len(values) - count} "
            "more; the header and the data do not belong together",
            index - 1,
        )
    return values


def lines_used(count: int, per_line: int) -> int:
    """Lines that `count` fields take."""
    return -(-count // per_line)


class _LineOf(Sequence[int]):
    """Line index of each token, worked out only when a fault has to be told."""

    def __init__(self, start: int, per_line: list[int]) -> None:
        self._ends = np.cumsum(per_line) if per_line else np.zeros(0, dtype=np.int64)
        self._start = start

    def __len__(self) -> int:
        return int(self._ends[-1]) if self._ends.size else 0

    def __getitem__(self, place: int) -> int:  # type: ignore[override]
        return self._start + int(np.searchsorted(self._ends, place, side="right"))


def unit_of_file(
    record: RecordFile, stated: str | None, options: Options, line: int | None = None
) -> float:
    """Factor to m/s2 from what the file states and what the caller says.

    Either is enough; both must agree.  Nothing is assumed when neither speaks.
    """
    given: float | None = None
    if options.units is not None:
        given = unit_table.acceleration_factor(str(options.units))
        if given is None:
            raise record.fault(
                f"units = {shown(str(options.units))} is not a known unit of acceleration; "
                f"use one of {unit_table.known_units()}"
            )
    if stated is None:
        if given is None:
            raise record.fault(
                'the file does not say in which units it is; give units = "g" (or one of '
                f"{unit_table.known_units()})"
            )
        return given
    factor = unit_table.acceleration_factor(stated)
    if factor is None:
        raise record.fault(
            f"{shown(stated)} is not a known unit of acceleration "
            f"({unit_table.known_units()}); convert the record first",
            line,
        )
    if given is not None and abs(given - factor) > 1e-9 * factor:
        raise record.fault(
            f"the file states {shown(stated)} but units = {shown(str(options.units))} was given; "
            "leave units out, or correct the file",
            line,
        )
    return factor


def check_dt(record: RecordFile, dt: float, options: Options, line: int | None = None) -> float:
    """The file's time step, s, checked by itself and against the caller's `dt`."""
    if not (np.isfinite(dt) and dt > 0.0):
        raise record.fault(f"the time step is {dt:g} s; it must be over zero", line)
    if options.dt is not None and abs(options.dt - dt) > 1e-6 * dt:
        raise record.fault(
            f"the file states a time step of {dt:g} s but dt = {options.dt:g} s was given; leave "
            "dt out, and resample the motion afterwards if another step is wanted",
            line,
        )
    return dt


def peak_note(peak: float, stated: float, unit: str, resolution: float) -> tuple[str, ...]:
    """A remark when the header's own peak and that of the data differ, else nothing."""
    if abs(abs(stated) - peak) <= max(0.01 * peak, resolution):
        return ()
    return (f"the header gives a peak of {abs(stated):g} {unit}, the data have {peak:g} {unit}",)


def first_match(pattern: re.Pattern[str], lines: Sequence[str]) -> re.Match[str] | None:
    """What a pattern finds in the first line that holds it."""
    return next((match for line in lines if (match := pattern.search(line))), None)


def key_values(lines: Sequence[str]) -> dict[str, str]:
    """Header lines "KEY : value" by key in lower case; the first of two alike counts."""
    entries: dict[str, str] = {}
    for line in lines:
        key, colon, value = line.partition(":")
        if colon:
            entries.setdefault(" ".join(key.lower().split()), value.strip())
    return entries


def whole_number(record: RecordFile, text: str, name: str, line: int | None = None) -> int:
    """A count of at least two that a header states."""
    if not re.fullmatch(r"[0-9]{1,9}", text) or int(text) < 2:
        raise record.fault(
            f"the header's {name} is {shown(text)}; a whole number of at least 2 is needed", line
        )
    return int(text)


MARKS = (999.0, 9999.0, 99999.0, 999999.0, 999.9, 9999.9, 32768.0)
"""What stands for missing values, in size; they are no measurements in any unit."""


def no_marks(record: RecordFile, values: NDArray[np.float64]) -> None:
    """Refuse values, in the file's unit, among which marks of missing ones stand.

    A value such as -999 is a mark where it follows another or is twice all others.
    """
    size = np.abs(values)
    marked = np.isin(size, MARKS)
    if not marked.any():
        return
    others = float(np.max(size[~marked])) if not marked.all() else 0.0
    places = np.flatnonzero(marked & ((size > 2.0 * others) | np.append(False, marked[:-1])))
    if places.size:
        raise record.fault(
            f"sample {int(places[0]) + 1} is {values[places[0]]:g}, a mark of a missing value: the "
            "record has a gap; fill or cut it first"
        )


def cut_token(record: RecordFile) -> str | None:
    """The file's last number if it has fewer digits than ten printed alike before it."""
    tokens = " ".join(record.lines[-13:]).split()[-11:]
    if len(tokens) < 11:
        return None
    shapes = []
    for token in tokens:
        match = _SHAPE.match(token)
        shapes.append(match and (len(match.group(1)), len(match.group(2) or "")))
    last, before = shapes[-1], set(shapes[:-1])
    if len(before) != 1 or None in before:
        return None
    usual = before.pop()
    assert usual is not None
    # Without an exponent, printing often drops trailing zeros: that is no sign of a cut.
    if usual[1] == 0:
        return None
    short = last is None or last[0] < usual[0] or last[1] < usual[1]
    return tokens[-1] if short else None


FEWEST_ALIKE, MOST_ALIKE = 20, 2000
"""So many numbers of as many decimals show that trailing zeros are not dropped."""


def cut_decimal(tokens: Sequence[str]) -> str | None:
    """The last number if it has fewer decimals than all before it, which have equally many."""
    shapes = [_SHAPE.match(token) for token in tokens[-MOST_ALIKE:]]
    if len(shapes) <= FEWEST_ALIKE or any(shape is None for shape in shapes[:-1]):
        return None
    usual = {(len(shape.group(1)), shape.group(2)) for shape in shapes[:-1] if shape}
    (decimals, power), *others = usual
    if others or power is not None or decimals == 0:
        return None
    last = shapes[-1]
    short = last is None or (last.group(2) is None and len(last.group(1)) < decimals)
    return tokens[-1] if short else None


def check_not_cut(record: RecordFile, tokens: Sequence[str]) -> None:
    """Refuse a last number that has fewer digits than those before it.

    A zero on a line of its own is a whole one: it was appended to see free vibration.
    """
    last = record.lines[-1].split()
    if len(last) == 1 and to_float(last[0]) == 0.0:
        return
    cut = cut_token(record) or cut_decimal(tokens)
    if cut is not None:
        raise record.fault(
            f"the last value, {shown(cut)}, is cut off; fetch the file again",
            len(record.lines) - 1,
        )


def last_tokens(record: RecordFile, start: int) -> list[str]:
    """The numbers of the last lines from line `start` on, as text."""
    first = max(start, len(record.lines) - MOST_ALIKE)
    return [token for line in record.lines[first:] for token in line.split()]
