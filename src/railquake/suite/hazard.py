"""Uniform hazard spectra: what a suite is to represent, with its source.

A uniform hazard spectrum gives, for each period by itself, the spectral acceleration that is
exceeded with the same probability.  The spectra that are built in are data files beside this
module; a file of the user's in the same layout serves as well::

    # Source: who computed it, and how
    # NOTE: what else the reader must know
    period_s,sa_poe10_50yr_g,sa_poe02_50yr_g
    0.1,0.95,1.47
    1.0,0.76,1.41

The heads of the columns tell the probability of exceedance (PoE) in 50 years, in per cent.
"""

from __future__ import annotations

import difflib
import math
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from railquake.errors import InputError
from railquake.files import read_file
from railquake.inputs.ground_motion import STANDARD_GRAVITY
from railquake.messages import unreadable

__all__ = ["Hazard", "TargetSpectrum", "hazard_names", "load_hazard", "read_hazard"]

YEARS = 50
"""Time for which the probabilities are stated, years."""
_COLUMN = re.compile(r"sa_poe([0-9]+(?:\.[0-9]+)?)_50yr_g")
_PREFIX = "hazard_"


@dataclass(frozen=True, eq=False)
class TargetSpectrum:
    """One curve of a hazard: pseudo-spectral acceleration against period, 5 % damping.

    Parameters
    ----------
    name : str
        Of the hazard.
    poe : float
        Probability of exceedance in 50 years, 0 to 1.
    periods : ndarray, shape (n,)
        Increasing, s; read-only.
    ordinates : ndarray, shape (n,)
        Pseudo-spectral acceleration, m/s2; read-only.
    """

    name: str
    poe: float
    periods: NDArray[np.float64]
    ordinates: NDArray[np.float64]

    @property
    def title(self) -> str:
        """Name and level, for pictures."""
        return f"{self.name}, {100.0 * self.poe:g} % in {YEARS} years"

    def at(self, periods: ArrayLike) -> NDArray[np.float64]:
        """Ordinates at periods within the curve, m/s2, interpolated in log-log.

        Raises
        ------
        InputError
            If a period lies outside the curve.
        """
        wanted = np.asarray(periods, dtype=np.float64)
        shortest, longest = float(self.periods[0]), float(self.periods[-1])
        inside = (wanted >= shortest * (1.0 - 1e-12)) & (wanted <= longest * (1.0 + 1e-12))
        if not np.all(inside):
            raise InputError(
                f"hazard {self.name}: is given from {shortest:g} to {longest:g} s; "
                f"{float(np.atleast_1d(wanted[~inside])[0]):g} s is outside"
            )
        return np.asarray(
            np.exp(np.interp(np.log(wanted), np.log(self.periods), np.log(self.ordinates)))
        )


@dataclass(frozen=True, eq=False)
class Hazard:
    """The uniform hazard spectra of a site.

    Parameters
    ----------
    name : str
        As it is called for.
    periods : ndarray, shape (n,)
        Increasing, s; read-only.
    curves : mapping of float to ndarray
        Pseudo-spectral acceleration, m/s2, shape (n,), by the probability of exceedance in 50
        years (0 to 1), most probable first; read-only.
    source : str
        Who computed it, and how.
    note : str
        The file's other remarks: site, damping, component, what is interpolated or approximate.
    """

    name: str
    periods: NDArray[np.float64]
    curves: Mapping[float, NDArray[np.float64]]
    source: str
    note: str

    def target(self, poe: float) -> TargetSpectrum:
        """The curve of one probability of exceedance in 50 years (0 to 1).

        Raises
        ------
        InputError
            If there is none: between levels nothing is interpolated.
        """
        for known, curve in self.curves.items():
            if math.isclose(known, poe, rel_tol=1e-6):
                return TargetSpectrum(self.name, known, self.periods, curve)
        raise InputError(
            f"hazard {self.name}: has no curve for a probability of exceedance of {poe:g} in "
            f"{YEARS} years; known are {', '.join(f'{known:g}' for known in self.curves)}"
        )


@cache
def hazard_names() -> tuple[str, ...]:
    """Names of the hazards that are built in, in order of the alphabet."""
    files = (entry.name for entry in (resources.files(__package__) / "data").iterdir())
    return tuple(
        sorted(
            name.removeprefix(_PREFIX).removesuffix(".csv")
            for name in files
            if name.startswith(_PREFIX)
        )
    )


def load_hazard(name_or_path: str | Path, poe: float) -> TargetSpectrum:
    """One curve of a hazard.

    Parameters
    ----------
    name_or_path : str or Path
        One of `hazard_names`, or the path of a CSV file in the layout shown above.
    poe : float
        Probability of exceedance in 50 years, 0 to 1.

    Raises
    ------
    InputError
        If there is no such hazard or curve, naming those there are, or the file is wrong.
    """
    return read_hazard(name_or_path).target(poe)


def read_hazard(name_or_path: str | Path) -> Hazard:
    """All curves of a hazard.

    Parameters
    ----------
    name_or_path : str or Path
        One of `hazard_names`, or the path of a CSV file in the layout shown above.

    Raises
    ------
    InputError
        If there is no such hazard, naming those there are, or the file is wrong.
    """
    name = os.fspath(name_or_path)
    known = hazard_names()
    if name in known:
        text = (resources.files(__package__) / "data" / f"{_PREFIX}{name}.csv").read_text("utf-8")
        return _parsed(name, f"hazard {name}", text)
    path = Path(name)
    if not (name.lower().endswith(".csv") or os.sep in name or path.exists()):
        near = difflib.get_close_matches(name, known, 1)
        hint = f"did you mean {near[0]}? " if near else ""
        raise InputError(
            f'hazard "{name}": is not known; {hint}known are {", ".join(known)}; '
            "or give a file, hazard.csv"
        )
    try:
        text = read_file(path).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise unreadable(path, error) from None
    return _parsed(path.stem, str(path), text)


def _parsed(name: str, where: str, text: str) -> Hazard:
    remarks: list[str] = []
    rows: list[list[float]] = []
    levels: list[float] = []
    for number, line in enumerate(text.splitlines(), 1):
        place = f"{where}, line {number}"
        if line.startswith("#"):
            _remember(remarks, line)
        elif line.strip() and not levels:
            levels = _levels(line, place)
        elif line.strip():
            rows.append(_ordinates(line, len(levels), place, rows[-1][0] if rows else 0.0))
    if not levels:
        raise InputError(f"{where}: is empty; a header period_s,sa_poe10_50yr_g is needed")
    if len(rows) < 2:
        raise InputError(f"{where}: holds {len(rows)} rows; at least two periods are needed")
    table = np.array(rows)
    table.setflags(write=False)
    order = np.argsort(levels)[::-1]
    curves = {levels[k]: _read_only(STANDARD_GRAVITY * table[:, k + 1]) for k in order}
    sources = [text for text in remarks if text.startswith("Source: ")]
    return Hazard(
        name,
        _read_only(table[:, 0].copy()),
        MappingProxyType(curves),
        " ".join(text.removeprefix("Source: ") for text in sources),
        "; ".join(text for text in remarks if text not in sources),
    )


def _read_only(values: NDArray[np.float64]) -> NDArray[np.float64]:
    values.setflags(write=False)
    return values


def _remember(remarks: list[str], line: str) -> None:
    """Take a remark in; an indented one goes on with the one before."""
    text = line.removeprefix("#").strip()
    if text and remarks and line.startswith("#  "):
        remarks[-1] += f" {text}"
    elif text:
        remarks.append(text)


def _levels(line: str, place: str) -> list[float]:
    """Probabilities of exceedance from the heads of the columns."""
    heads = [cell.strip() for cell in line.split(",")]
    if heads[0] != "period_s":
        raise InputError(f'{place}: the first column must be period_s, found "{heads[0]}"')
    levels: list[float] = []
    for head in heads[1:]:
        match = _COLUMN.fullmatch(head)
        if match is None or not 0.0 < float(match[1]) < 100.0:
            raise InputError(
                f'{place}: column "{head}": sa_poe10_50yr_g is expected for 10 % in {YEARS} years, '
                "in g"
            )
        level = round(0.01 * float(match[1]), 12)
        if level in levels:
            raise InputError(f'{place}: column "{head}": the level is there twice')
        levels.append(level)
    if not levels:
        raise InputError(f"{place}: no curve; a column such as sa_poe10_50yr_g is needed")
    return levels


def _ordinates(line: str, count: int, place: str, last: float) -> list[float]:
    cells = [cell.strip() for cell in line.split(",")]
    if len(cells) != count + 1:
        raise InputError(f"{place}: {len(cells)} cells under {count + 1} columns")
    values: list[float] = []
    for cell in cells:
        try:
            value = float(cell)
        except ValueError:
            value = math.nan
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f'{place}: "{cell}": a finite number over zero is needed')
        values.append(value)
    if values[0] <= last:
        raise InputError(f"{place}: period_s: {values[0]:g} does not exceed {last:g} before it")
    return values
