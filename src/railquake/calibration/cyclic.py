"""Loops to fit to: of a fibre column, or measured and read from a CSV file, and their checks."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

import numpy as np

from railquake.errors import InputError
from railquake.files import read_file
from railquake.inputs.units import number_of, to_si
from railquake.messages import did_you_mean, unreadable

__all__ = ["Kind", "Loop", "check_loop", "read_loop", "resampled"]

Array = np.ndarray[Any, np.dtype[np.float64]]
Kind = Literal["force-displacement", "moment-rotation"]

FEWEST = 20  # points
POINTS_PER_PEAK = 100  # of a resampled path, over the largest rotation
MOST = 6000  # points of a resampled path
EFFECTIVE = 0.75  # of the largest moment: where the effective stiffness is taken
TURN = 0.05  # of the largest rotation: smaller turns are noise
ROTATIONS = (5e-4, 0.25)  # rad: peaks of tests on columns, from first cracking to collapse
MOMENTS = (1e2, 1e10)  # N m
# Peak moment over length cubed, Pa.  It is the same for a model of any size: (0.03 to 0.5) f'c
# (D / L)^3 with f'c of 15 to 100 MPa and D / L from 1/12 to 1/1.5 spans 260 Pa to 15 MPa.
INTENSITIES = (2e2, 2e7)

_RATIOS = {"%": 0.01, "percent": 0.01, "per cent": 0.01, "rad": 1.0, "mrad": 1e-3}
_TONS = ("tonf", "ton", "tons", "t", "tonf m", "ton m", "t m")

# words that name a column, and the dimension of its values
_AXES: dict[Kind, tuple[tuple[tuple[str, ...], str], tuple[tuple[str, ...], str]]] = {
    "force-displacement": (
        (("displacement", "disp", "deflection", "drift", "u", "delta", "d"), "length"),
        (("force", "load", "shear", "f", "p", "v"), "force"),
    ),
    "moment-rotation": (
        (("rotation", "rot", "theta", "x"), "angle"),
        (("moment", "m"), "moment"),
    ),
}


@dataclass(frozen=True)
class Loop:
    """Base moment along a path of a column's chord rotation, from the virgin state.

    Attributes
    ----------
    name : str
    chord : array, shape (n,)
        Displacement of the top over the length, rad; or the hinge's own rotation, where
        ``flexibility`` is 0.
    moment : array, shape (n,)
        At the base, N m.
    flexibility : float
        Chord rotation of the elastic column per moment, rad/(N m).
    """

    name: str
    chord: Array
    moment: Array
    flexibility: float

    @property
    def hinge_rotation(self) -> Array:
        """What the elastic column leaves of the chord's rotation to the hinge, rad."""
        rotation: Array = self.chord - self.flexibility * self.moment
        return rotation

    @cached_property
    def initial_stiffness(self) -> float:
        """Slope of the first branch up to a quarter of the largest moment, N m/rad of chord."""
        return _first_slope(self.chord, self.moment)

    @cached_property
    def effective_stiffness(self) -> float:
        """Secant where three quarters of the largest moment are first reached, N m/rad."""
        size = np.abs(self.moment)
        at = int(np.argmax(size >= EFFECTIVE * np.nanmax(size)))
        return abs(float(self.moment[at] / self.chord[at])) if self.chord[at] else np.inf


def read_loop(
    path: str | Path,
    kind: Kind = "force-displacement",
    *,
    length: float | None = None,
    flexibility: float = 0.0,
    rotation_unit: str | None = None,
    moment_unit: str | None = None,
) -> Loop:
    """Read a measured loop.

    Parameters
    ----------
    path : str or Path
        CSV with a first line that names two columns and their units, such as
        ``displacement_mm,force_kN`` or ``rotation [rad],moment [kN m]``; others are ignored.
        Tabs or semicolons may part them; a drift may be in per cent of the length.
    kind : {"force-displacement", "moment-rotation"}
    length : float, optional
        From the base to the load, m; a force-displacement loop needs it.
    flexibility : float
        Chord rotation of the specimen's elastic column per moment, rad/(N m): what is not the
        hinge's.  Of a moment-rotation loop it is not used.
    rotation_unit, moment_unit : str, optional
        Units of displacement or rotation and of force or moment, where the first line has none.

    Returns
    -------
    Loop
        Resampled at equal steps of its path.

    Raises
    ------
    InputError
        If the file cannot be read, or what it holds is no such loop: see `check_loop`.
    """
    if kind not in _AXES:
        raise InputError(f'--kind: unknown kind "{kind}"; {did_you_mean(kind, list(_AXES))}')
    if kind == "force-displacement":
        if length is None:
            raise InputError(
                f"{path}: a loop of force and displacement needs the length from the base to the "
                'load; write e.g. --length "2.4 m"'
            )
        to_si(length, "length", "--length", sign="positive")
    lines = _lines(path)
    names = lines[0][1]
    found = _columns(path, lines, kind, (rotation_unit, moment_unit), length)
    values = []
    for number, cells in lines[1:]:
        row = []
        for index, factor in found:
            cell = cells[index].strip() if index < len(cells) else ""
            value = number_of(cell)
            if value is None:
                raise InputError(
                    f'{path}, line {number}: {names[index]}: "{cell[:40]}" is {_no_number(cell)}'
                )
            if not math.isfinite(value):
                raise InputError(
                    f"{path}, line {number}: {names[index]}: must be a finite number, found {cell}"
                )
            row.append(factor * value)
        values.append(row)
    if len(values) < FEWEST:
        raise InputError(
            f"{path}: holds {len(values)} points; a loop needs at least {FEWEST}, and some "
            "hundred are better"
        )
    table = np.array(values)
    rotation, moment = table[:, 0], table[:, 1]
    if kind == "force-displacement":
        assert length is not None
        rotation, moment = rotation / length, moment * length
    else:
        flexibility = 0.0
    labels = tuple(names[index] for index, _ in found)
    check_loop(str(path), rotation, moment, labels, length, flexibility)
    rotation, moment = resampled(rotation, moment)
    return Loop(Path(path).stem, rotation, moment, flexibility)


def check_loop(
    where: str,
    rotation: Array,
    moment: Array,
    labels: tuple[str, ...] = ("rotation", "moment"),
    length: float | None = None,
    flexibility: float = 0.0,
) -> None:
    """Refuse what is no loop, has its columns swapped or is in other units.

    Parameters
    ----------
    where : str
        The file, for messages.
    rotation, moment : array, shape (n,)
        Chord or hinge rotation, rad, and base moment, N m.
    labels : (str, str)
        What the columns are called.
    length : float, optional
        Of a force-displacement loop, m.
    flexibility : float
        Of the elastic column, rad/(N m).

    Raises
    ------
    InputError
        Naming what was found: too few turns (no loop); energy gained instead of dissipated
        (columns swapped, or one with the wrong sign); rotations, moments or a stiffness that no
        column has (wrong units).
    """
    peak_rotation, peak_moment = float(np.abs(rotation).max()), float(np.abs(moment).max())
    if peak_rotation == 0.0 or peak_moment == 0.0:
        still = labels[0] if peak_rotation == 0.0 else labels[1]
        raise InputError(f"{where}: {still} is zero throughout")
    turns = _turns(rotation)
    if turns < 2:
        kind = "grows or falls throughout" if turns == 0 else "turns only once"
        raise InputError(
            f"{where}: is no loop: {labels[0]} {kind}; a cyclic test that goes to and fro at "
            "least once is needed"
        )
    work = float(np.sum(0.5 * (moment[1:] + moment[:-1]) * np.diff(rotation)))
    # what is still stored at the end, at most, counts as not dissipated
    lost = work / (peak_rotation * peak_moment)
    rises = float(rotation @ moment)
    if rises < 0.0:
        raise InputError(
            f"{where}: {labels[1]} falls where {labels[0]} grows: one of them has the other's "
            "sign reversed; turn it"
        )
    if lost < 0.0:
        raise InputError(
            f"{where}: the loop gains energy instead of dissipating it ({lost:.3g} of the largest "
            f"{labels[0]} times {labels[1]}): the two columns are swapped, or the rows run "
            "backwards"
        )
    _check_size(where, peak_rotation, peak_moment, labels, length)
    start = abs(float(rotation[0])) / peak_rotation
    if start > 0.1:
        raise InputError(
            f"{where}: must begin at rest, found {labels[0]} of {start:.0%} of its peak in the "
            "first row; the fit follows the specimen from its virgin state"
        )
    stiffness = Loop(where, rotation, moment, flexibility).effective_stiffness
    if stiffness * flexibility >= 1.0:
        raise InputError(
            f"{where}: at three quarters of its largest moment the loop's stiffness is "
            f"{stiffness:.3g} N m/rad, above that of the elastic column alone, 3 E I / L = "
            f"{1.0 / flexibility:.3g} N m/rad, so that nothing is left to a hinge: the units, "
            "--length, --young or --inertia are wrong"
        )


def _check_size(
    where: str,
    peak_rotation: float,
    peak_moment: float,
    labels: tuple[str, ...],
    length: float | None,
) -> None:
    what = "drift (displacement over length)" if length is not None else "rotation"
    if not ROTATIONS[0] <= peak_rotation <= ROTATIONS[1]:
        raise InputError(
            f"{where}: {labels[0]}: the largest {what} would be {peak_rotation:.3g} rad; tests "
            f"reach {ROTATIONS[0]:g} to {ROTATIONS[1]:g}: the unit is another"
            + (" (or --length is)" if length is not None else "")
            + _factor(peak_rotation, ROTATIONS)
        )
    if length is not None:
        intensity = peak_moment / length**3
        if not INTENSITIES[0] <= intensity <= INTENSITIES[1]:
            raise InputError(
                f"{where}: {labels[1]}: the largest is {peak_moment / length:.3g} N, a base moment "
                f"of {peak_moment:.3g} N m on a column of {length:g} m, which no concrete column "
                "has: the unit is another (or --length is)" + _factor(intensity, INTENSITIES)
            )
    elif not MOMENTS[0] <= peak_moment <= MOMENTS[1]:
        raise InputError(
            f"{where}: {labels[1]}: the largest is {peak_moment:.3g} N m, which no column has: the "
            "unit is another" + _factor(peak_moment, MOMENTS)
        )


def _factor(value: float, valid: tuple[float, float]) -> str:
    """A usual slip that would explain it."""
    slips = [
        factor
        for factor in (1e-3, 1e3, 1e-2, math.pi / 180.0, 1e6, 1e-6, 25.4e-3)
        if valid[0] <= factor * value <= valid[1]
    ]
    return f" (times {slips[0]:.4g} it would do)" if slips else ""


def resampled(rotation: Array, moment: Array) -> tuple[Array, Array]:
    """The loop at equal steps of its path, so that slow and fast parts of a test count alike."""
    peak = float(np.abs(rotation).max())
    way = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(rotation)))])
    count = min(max(round(POINTS_PER_PEAK * way[-1] / peak), 2 * FEWEST), MOST)
    # a hold, where only the moment changes, ends a step of no length; its last point counts
    keep = np.append(np.diff(way) > 0.0, True)
    at = np.linspace(0.0, way[-1], count + 1)
    return np.interp(at, way[keep], rotation[keep]), np.interp(at, way[keep], moment[keep])


def _turns(rotation: Array) -> int:
    """Reversals, those smaller than 5 % of the peak left out."""
    limit = TURN * float(np.abs(rotation).max())
    extreme, direction, turns = float(rotation[0]), 0, 0
    for value in rotation:
        move = float(value) - extreme
        if direction == 0:
            if abs(move) > limit:
                direction, extreme = (1 if move > 0.0 else -1), float(value)
        elif move * direction > 0.0:
            extreme = float(value)
        elif abs(move) > limit:
            direction, extreme = -direction, float(value)
            turns += 1
    return turns


def _first_slope(rotation: Array, moment: Array) -> float:
    """Through the origin, up to a quarter of the largest moment."""
    peak = float(np.abs(moment).max())
    beyond = np.flatnonzero(np.abs(moment) > 0.25 * peak)
    end = int(beyond[0]) + 1
    x, m = rotation[:end], moment[:end]
    square = float(x @ x)
    slope = float(x @ m) / square if square > 0.0 else 0.0
    # a first branch that goes the wrong way is noise: the secant at the largest rotation then
    at = int(np.argmax(np.abs(rotation)))
    return slope if slope > 0.0 else abs(float(moment[at] / rotation[at]))


def _lines(path: str | Path) -> list[tuple[int, list[str]]]:
    try:
        text = read_file(path).decode("utf-8-sig")
        lines = [
            (number, [cell.strip() for cell in row])
            for number, row in enumerate(_rows(text), start=1)
            if any(cell.strip() for cell in row) and not row[0].lstrip().startswith("#")
        ]
    except OSError as error:
        raise unreadable(path, error) from None
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: is not a CSV text file: {error}") from None
    if not lines:
        raise InputError(f"{path}: is empty")
    return lines


def _rows(text: str) -> Iterator[list[str]]:
    """Rows of cells, parted by what stands most often in the first line that is no remark."""
    lines = text.splitlines()
    head = next((line for line in lines if line.strip() and not line.lstrip().startswith("#")), "")
    # a comma may stand in a name ("force, kN"): tabs and semicolons go before it
    separator = next((mark for mark in ("\t", ";") if mark in head), ",")
    return csv.reader(lines, delimiter=separator)


def _no_number(cell: str) -> str:
    """What a cell is that is no number, and what to do."""
    if re.fullmatch(r"[+-]?[0-9.]*,[0-9]+(?:[eE][+-]?[0-9]+)?", cell):
        return "a number with a decimal comma; write decimal points"
    if re.search(r"[0-9]:[0-9]{2}|[0-9]{4}-[0-9]{2}-[0-9]{2}", cell):
        return "a date or time of day, no number"
    return "no number"


def _columns(
    path: str | Path,
    lines: list[tuple[int, list[str]]],
    kind: Kind,
    units: tuple[str | None, str | None],
    length: float | None,
) -> list[tuple[int, float]]:
    """Index and factor to SI of the column of rotation and of that of moment."""
    number, header = lines[0]
    axes = _AXES[kind]
    found = []
    for (words, dimension), given, option in zip(
        axes, units, ("--rotation-unit", "--moment-unit"), strict=True
    ):
        matches = [
            (index, unit)
            for index, cell in enumerate(header)
            for name, unit in [_name_and_unit(cell)]
            if name in words
        ]
        if len(matches) != 1:
            how = "no column" if not matches else "more than one column"
            raise InputError(
                f"{path}, line {number}: {how} for the {words[0]} among {', '.join(header)[:80]}; "
                f"the first line must name the columns with their units, such as "
                f"{_example(kind)}"
            )
        index, unit = matches[0]
        unit = given or unit
        if unit is None:
            raise InputError(
                f'{path}, line {number}: "{header[index]}" has no unit; write it behind the name, '
                f"such as {_example(kind)}, or give {option}"
            )
        where = f"{path}, line {number}: {header[index]}"
        if unit.lower() in _TONS:
            raise InputError(
                f"{where}: {unit} may be 9.807 kN (metric) or 8.896 kN (US); write tf for the "
                "metric one, or convert the forces to kN"
            )
        if dimension == "length" and length is not None and unit.lower() in _RATIOS:
            # a drift is displacement over length
            found.append((index, _RATIOS[unit.lower()] * length))
            continue
        found.append((index, to_si(f"1 {unit}", dimension, where, sign="positive")))
    return found


def _name_and_unit(cell: str) -> tuple[str, str | None]:
    """``force_kN``, ``force [kN]``, ``force (kN)``, ``force, kN`` or ``force kN``."""
    match = re.fullmatch(
        r"\s*([A-Za-z]+)\s*(?:[_,\s]\s*([^\s\[\(].*?)|\[(.*?)\]|\((.*?)\))?\s*", cell
    )
    if match is None:
        return cell.strip().lower(), None
    unit = match[2] or match[3] or match[4]
    if unit is not None:
        unit = unit.strip().replace("_", " ") or None
    return match[1].lower(), unit


def _example(kind: Kind) -> str:
    return (
        "displacement_mm,force_kN" if kind == "force-displacement" else "rotation_rad,moment_kN_m"
    )
