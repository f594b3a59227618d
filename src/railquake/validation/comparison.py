"""What a comparison says: quantities beside their references, pictures, or why it could not run.

A comparison is a plain module of this package, listed in `railquake.validation.registry`:

``TITLE``
    What is held against what, in a line: the title of its section in the documentation.
``SOURCE``
    Where the reference numbers come from (Markdown).
``WHAT``
    What is compared, and under which conditions (Markdown).
``WHY``
    Why this tolerance and no other (Markdown).
``NEEDS``
    Optional tuple: names of extras (``"fem"``) and ``"data"``, the folder of reference data.
    Without them the comparison is skipped, and the reason said.
``FILES``
    Optional tuple of files that must lie in the folder of data, relative to it.
``SLOW``
    Optional; true where it takes longer than a minute.
``compare(data)``
    Gets the folder of data, or None where the module does not need it, and returns an `Outcome`.
    Whatever it raises is a failed comparison; `Unavailable` a skipped one.

An example::

    from railquake.validation.comparison import Outcome, Picture, relative

    TITLE = "Carts against springs"
    ...

    def compare(data: Path | None) -> Outcome:
        found = frequency()
        return Outcome(
            results=(relative("first frequency", "Hz", reference=1.0, ours=found, tolerance=1e-3),),
            pictures=(Picture("cart", "A cart.", lambda path: draw(found, path)),),
        )
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

__all__ = [
    "Comparison",
    "Outcome",
    "Picture",
    "Result",
    "Unavailable",
    "absolute",
    "at_most",
    "of_peak",
    "relative",
]

Kind = Literal["relative", "of peak", "absolute", "at most"]


class Unavailable(Exception):
    """A comparison cannot run here: what is missing, and how to get it, on one line."""


@dataclass(frozen=True)
class Result:
    """One compared quantity.

    Attributes
    ----------
    quantity : str
        What, and where it matters under which conditions.
    unit : str
        Of the values; empty for a pure number.
    reference : float or None
        Theirs; of a history its peak.  None where ours has only to stay below the tolerance.
    ours : float
    difference : float
        For ``relative`` over the reference, for ``of peak`` the largest of the history over the
        reference's peak; for ``absolute`` and ``at most`` in the unit of the values.
    tolerance : float
        The difference allowed, in the same measure.
    kind : {"relative", "of peak", "absolute", "at most"}
    """

    quantity: str
    unit: str
    reference: float | None
    ours: float
    difference: float
    tolerance: float
    kind: Kind

    @property
    def agrees(self) -> bool:
        """Whether the difference is within the tolerance; never for a value that is no number."""
        return bool(self.difference <= self.tolerance)

    @property
    def verdict(self) -> str:
        """In a word: ``agrees`` or ``outside``."""
        return "agrees" if self.agrees else "outside"


@dataclass(frozen=True)
class Picture:
    """A plot of a comparison, drawn only where a page is written.

    Attributes
    ----------
    name : str
        Of the file, without its ending; the comparison's name goes before it.
    caption : str
        One or two sentences (Markdown).
    draw : callable
        Writes the PNG to the path it gets.
    """

    name: str
    caption: str
    draw: Callable[[Path], object]


@dataclass(frozen=True)
class Outcome:
    """What a comparison found.

    Attributes
    ----------
    results : tuple of Result
        At least one.
    pictures : tuple of Picture
    note : str
        What the numbers mean for a user (Markdown), below the table of the page.
    """

    results: tuple[Result, ...]
    pictures: tuple[Picture, ...] = ()
    note: str = ""


class Comparison(Protocol):
    """The names that every comparison's module has; the optional ones are described above."""

    TITLE: str
    SOURCE: str
    WHAT: str
    WHY: str

    @staticmethod
    def compare(data: Path | None) -> Outcome:
        """Run it."""
        ...


def relative(
    quantity: str, unit: str, *, reference: float, ours: float, tolerance: float
) -> Result:
    """One value, its difference over the reference.

    Raises
    ------
    ValueError
        If the reference is zero: it has no relative difference.
    """
    if reference == 0.0:
        raise ValueError(f"{quantity}: nothing can be relative to a reference of 0")
    difference = abs(ours - reference) / abs(reference)
    return _result(quantity, unit, reference, ours, difference, tolerance, "relative")


def absolute(
    quantity: str, unit: str, *, reference: float, ours: float, tolerance: float
) -> Result:
    """One value, its difference in the unit of the values."""
    return _result(quantity, unit, reference, ours, abs(ours - reference), tolerance, "absolute")


def at_most(quantity: str, unit: str, *, ours: float, bound: float) -> Result:
    """A value that must not exceed a bound, such as an error by itself."""
    return _result(quantity, unit, None, ours, ours, bound, "at most")


def of_peak(
    quantity: str, unit: str, *, reference: ArrayLike, ours: ArrayLike, tolerance: float
) -> Result:
    """A whole history: its largest difference over the reference's largest absolute value.

    Raises
    ------
    ValueError
        If the histories differ in shape, are empty, or the reference is zero throughout.
    """
    theirs, own = np.asarray(reference, dtype=float), np.asarray(ours, dtype=float)
    if theirs.shape != own.shape or theirs.size == 0:
        raise ValueError(f"{quantity}: histories of shapes {theirs.shape} and {own.shape}")
    peak = float(np.abs(theirs).max())
    if peak == 0.0:
        raise ValueError(f"{quantity}: the reference is 0 throughout")
    difference = float(np.abs(own - theirs).max()) / peak
    ours_peak = float(np.abs(own).max())
    return _result(quantity, unit, peak, ours_peak, difference, tolerance, "of peak")


def _result(
    quantity: str,
    unit: str,
    reference: float | None,
    ours: float,
    difference: float,
    tolerance: float,
    kind: Kind,
) -> Result:
    if not (math.isfinite(tolerance) and tolerance >= 0.0):
        raise ValueError(f"{quantity}: a tolerance must be finite and not negative")
    return Result(
        quantity,
        unit,
        None if reference is None else float(reference),
        float(ours),
        float(difference),
        float(tolerance),
        kind,
    )
