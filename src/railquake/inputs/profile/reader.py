"""Profiles from files: SIMPACK ``.prw`` and ``.prr``, and plain CSV.

A measured outline is noisy, and curvature is its second derivative.  Both coordinates are
therefore fitted, as functions of the length along the chords, by natural cubic smoothing splines
that damp features shorter than a stated length, and resampled.
"""

from __future__ import annotations

import csv
import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from railquake.errors import InputError
from railquake.files import read_file
from railquake.inputs.profile.shape import Profile, ProfileKind
from railquake.inputs.units import number_of
from railquake.messages import reason

_FloatArray = NDArray[np.float64]
_Header = dict[str, tuple[str, int]]  # by key: what is written, and the line that it stands on

MIN_POINTS = 10
MAX_POINTS = 20_000
MAX_FILE_BYTES = 10_000_000
# A wheel or rail head is some 70 to 150 mm wide; anything else is a wrong unit.
WIDTH_RANGE = (0.02, 0.5)
MAX_LENGTH = 2.0
LARGEST_NUMBER = 1e9  # of a profile's file, whatever it is: products of larger ones may overflow
# A rail's working part, where the outline must not fold under itself, ends this far below the
# crown; a wheel's begins at the flange tip.
WORKING_DEPTH = 0.014
_CSV_UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "inch": 0.0254}
# y_mm, y mm, y (mm), y [mm]; capitals mean nothing
_HEAD = re.compile(
    r"(?P<axis>[A-Za-z]+)(?:\s*[_\s]\s*(?P<unit>[^\s\[(].*)|\s*_?[\[(](?P<in_brackets>.*)[\])])?"
)


@dataclass(frozen=True)
class _Table:
    """Points as read [m], and the line each stands on."""

    y: _FloatArray
    z: _FloatArray
    lines: NDArray[np.int64]


def read_profile(
    path: str | Path,
    kind: ProfileKind,
    spacing: float = 1e-4,
    smoothing_length: float = 1e-3,
) -> Profile:
    """Read a wheel or rail profile from a file.

    Parameters
    ----------
    path : str or Path
        ``.prw`` (wheel) or ``.prr`` (rail) of SIMPACK; any other name is read as CSV.

        SIMPACK: ``!`` begins a comment, ``key = value`` lines, points between ``point.begin``
        and ``point.end``, lengths divided by ``units.len.f``; ``mirror.y`` and ``mirror.z`` are
        carried out.  After that, ``y`` must point outward and ``z`` down.
        CSV: a header naming ``y`` and ``z`` with units (``y_mm,z_mm`` or ``y (mm),z (mm)``; m,
        cm, mm, in, inch), then one point a line, ``y`` outward, ``z`` down, with commas,
        semicolons or tabs between; lines that begin with ``#`` are comments.
    kind : {"wheel", "rail"}
        What the file must hold.
    spacing : float
        Greatest distance between the points of the result along the outline [m].
    smoothing_length : float
        Features shorter than this length [m] are taken for noise: the splines minimise
        ``integral (fit - data)^2 ds + smoothing_length^4 integral fit''^2 ds``.  An arc of radius
        R loses about ``(smoothing_length / R)^4`` of its curvature; a sharp corner is rounded over
        a few times this length, and so is the curvature at both ends of the profile.  0
        interpolates.

    Returns
    -------
    Profile
        Ordered from the gauge side to the field side.

    Raises
    ------
    InputError
        Naming file and line: unreadable, no table of points, missing units, the wrong kind or
        orientation, too few points, a value that is not finite, a repeated point, an outline
        that folds back on itself.
    """
    path = Path(path)
    for label, value in (("spacing", spacing), ("smoothing_length", smoothing_length)):
        if not math.isfinite(value) or value < 0.0 or (label == "spacing" and value == 0.0):
            raise InputError(f"{path}: {label} is {value} m; it must be positive")
    text = _read_text(path)
    suffix = path.suffix.lower()
    table = (
        _parse_simpack(path, text, kind) if suffix in (".prw", ".prr") else _parse_csv(path, text)
    )
    if table.y.size and table.y[0] > table.y[-1]:
        table = _Table(table.y[::-1], table.z[::-1], table.lines[::-1])
    _check_points(path, table)
    _check_orientation(path, table, kind)
    _check_folds(path, table, kind)
    y, z, curvature = _fit(table, kind, spacing, smoothing_length)
    return Profile(kind, path.stem, y, z, curvature)


def _read_text(path: Path) -> str:
    try:
        data = read_file(path, MAX_FILE_BYTES)
    except OSError as error:
        raise InputError(f"{path}: {reason(error)}; check the name of the profile file") from None
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise InputError(f"{path}: UTF-16 text; save it as plain text (UTF-8)")
    return data.decode("utf-8-sig", errors="replace")


def _parse_simpack(path: Path, text: str, kind: ProfileKind) -> _Table:
    header, rows, lines = _simpack_lines(path, text)
    _check_simpack_kind(path, header, kind)
    _check_simpack_keys(path, header)
    points = np.array(rows, dtype=np.float64).reshape(-1, 2) / _simpack_unit(path, header)
    y = -points[:, 0] if _header_number(path, header, "mirror.y") == 1.0 else points[:, 0]
    z = -points[:, 1] if _header_number(path, header, "mirror.z") == 1.0 else points[:, 1]
    return _Table(y, z, np.array(lines, dtype=np.int64))


def _simpack_lines(path: Path, text: str) -> tuple[_Header, list[tuple[float, float]], list[int]]:
    """Header, points as they are written, and the line of each point."""
    header: _Header = {}
    rows: list[tuple[float, float]] = []
    lines: list[int] = []
    state = "before"
    for number, raw in enumerate(text.splitlines(), start=1):
        line = raw.split("!", 1)[0].strip()
        if not line:
            continue
        if line == "point.begin":
            if state != "before":
                raise InputError(f"{path}, line {number}: a second point.begin; one table is read")
            state = "inside"
        elif line == "point.end":
            if state != "inside":
                raise InputError(f"{path}, line {number}: point.end without point.begin")
            state = "after"
        elif state == "inside":
            rows.append(_simpack_point(path, number, line))
            lines.append(number)
        elif "=" in line:
            key, value = (part.strip() for part in line.split("=", 1))
            header.setdefault(key, (value, number))
    if state == "before":
        raise InputError(f"{path}: no point.begin, so no table of points; is it a SIMPACK profile?")
    if state == "inside":
        raise InputError(f"{path}: no point.end; the table is cut short")
    return header, rows, lines


def _simpack_point(path: Path, number: int, line: str) -> tuple[float, float]:
    if line in ("spline.end", "header.begin"):
        raise InputError(f"{path}, line {number}: no point.end; the table is cut short")
    fields = line.split()
    if len(fields) not in (2, 3):
        raise InputError(
            f"{path}, line {number}: {len(fields)} values; a point is y, z and perhaps a weight"
        )
    return _number(path, number, fields[0]), _number(path, number, fields[1])


def _check_simpack_kind(path: Path, header: _Header, kind: ProfileKind) -> None:
    """The header's type counts, and the file's name where it has none."""
    stated_type = _header_number(path, header, "type")
    expected = "wheel" if path.suffix.lower() == ".prw" else "rail"
    if stated_type is not None:
        expected = "wheel" if stated_type == 1.0 else "rail"
    if expected != kind:
        raise InputError(f"{path}: holds a {expected} profile where a {kind} is needed")


def _check_simpack_keys(path: Path, header: _Header) -> None:
    """Refuse what would move or cut the points."""
    for key in ("shift.y", "shift.z", "rotate"):
        if _header_number(path, header, key):
            raise InputError(
                f"{path}, line {header[key][1]}: {key} is not zero, which is not supported; apply "
                "it to the points and set it to 0"
            )
    for axis in ("y", "z"):
        low = _header_number(path, header, f"bound.{axis}.min")
        high = _header_number(path, header, f"bound.{axis}.max")
        if low is not None and high is not None and low < high:
            raise InputError(
                f"{path}, line {header[f'bound.{axis}.min'][1]}: bound.{axis} cuts the profile, "
                "which is not supported; remove the points outside and set min above max"
            )


def _simpack_unit(path: Path, header: _Header) -> float:
    """Lengths of the file per metre."""
    units = _header_number(path, header, "units.len.f")
    if units is None:
        raise InputError(
            f"{path}: units.len.f is missing; it gives the lengths per metre (mm: 1000)"
        )
    if units < 1.0 / LARGEST_NUMBER:
        raise InputError(
            f"{path}, line {header['units.len.f'][1]}: units.len.f is {units:g}; "
            f"it must be {'positive' if units <= 0.0 else 'the lengths per metre (mm: 1000)'}"
        )
    return units


def _header_number(path: Path, header: _Header, key: str) -> float | None:
    if key not in header:
        return None
    value, number = header[key]
    return _number(path, number, value)


def _parse_csv(path: Path, text: str) -> _Table:
    columns: tuple[int, int] | None = None
    scales, between = (1.0, 1.0), ","
    rows: list[tuple[float, float]] = []
    lines: list[int] = []
    for number, raw in enumerate(text.splitlines(), start=1):
        line = raw.strip()
        if not line or line.startswith("#"):
            continue
        if columns is None:
            between = next((mark for mark in ";\t" if mark in line), ",")
        try:
            fields = [field.strip() for field in next(csv.reader([line], delimiter=between))]
        except (csv.Error, StopIteration):
            raise InputError(f"{path}, line {number}: not a line of a CSV file") from None
        if columns is None:
            columns, scales = _csv_header(path, number, fields)
            continue
        if len(fields) <= max(columns):
            raise InputError(f"{path}, line {number}: {len(fields)} values; the header names more")
        y, z = (_number(path, number, fields[column]) for column in columns)
        rows.append((y * scales[0], z * scales[1]))
        lines.append(number)
    if columns is None:
        raise InputError(f"{path}: empty; a header such as y_mm,z_mm and points are needed")
    points = np.array(rows, dtype=np.float64).reshape(-1, 2)
    return _Table(points[:, 0], points[:, 1], np.array(lines, dtype=np.int64))


def _csv_header(
    path: Path, number: int, fields: list[str]
) -> tuple[tuple[int, int], tuple[float, float]]:
    columns: list[int] = []
    scales: list[float] = []
    for axis in ("y", "z"):
        heads = [_HEAD.fullmatch(field) for field in fields]
        found = [i for i, head in enumerate(heads) if head and head["axis"].lower() == axis]
        if len(found) != 1:
            raise InputError(
                f"{path}, line {number}: no table of points; the header must name one {axis} "
                "column with its unit, such as y_mm,z_mm"
            )
        head = heads[found[0]]
        assert head is not None  # it was found
        unit = (head["unit"] or head["in_brackets"] or "").strip().lower()
        if unit not in _CSV_UNITS:
            given = f'has the unit "{unit}"' if unit else "has no unit"
            raise InputError(
                f"{path}, line {number}: column {axis} {given}; name it {axis}_mm (or "
                f"{', '.join(other for other in _CSV_UNITS if other != 'mm')})"
            )
        columns.append(found[0])
        scales.append(_CSV_UNITS[unit])
    return (columns[0], columns[1]), (scales[0], scales[1])


def _number(path: Path, line: int, text: str) -> float:
    value = number_of(text)
    if value is None:
        raise InputError(f'{path}, line {line}: "{text[:40]}" is not a number')
    if not math.isfinite(value):
        raise InputError(f'{path}, line {line}: "{text[:40]}" is not a finite number')
    if abs(value) > LARGEST_NUMBER:
        raise InputError(
            f'{path}, line {line}: "{text[:40]}" is beyond any profile; the file is damaged'
        )
    return value


def _check_points(path: Path, table: _Table) -> None:
    count = table.y.size
    if not MIN_POINTS <= count <= MAX_POINTS:
        raise InputError(
            f"{path}: {count} points; between {MIN_POINTS} and {MAX_POINTS} are needed"
        )
    with np.errstate(over="ignore", invalid="ignore"):
        steps = np.hypot(np.diff(table.y), np.diff(table.z))
        width, length = np.ptp(table.y), steps.sum()
    if (steps == 0.0).any():
        at = int(np.flatnonzero(steps == 0.0)[0])
        first, second = sorted((int(table.lines[at]), int(table.lines[at + 1])))
        raise InputError(
            f"{path}, line {second}: repeats the point of line {first}; remove one of them"
        )
    if not (WIDTH_RANGE[0] <= width <= WIDTH_RANGE[1] and length <= MAX_LENGTH):
        raise InputError(
            f"{path}: {width * 1e3:.4g} mm wide and {length * 1e3:.4g} mm along the outline, which "
            "is no wheel or rail head; check the unit"
        )


def _check_orientation(path: Path, table: _Table, kind: ProfileKind) -> None:
    last = table.y.size - 1
    if kind == "wheel":
        tip = int(np.argmax(table.z))
        if tip in (0, last):
            raise InputError(
                f"{path}: the lowest point is an end of the profile, so there is no flange tip; a "
                "wheel is needed, from the back of its flange to the rim, with z pointing down"
            )
        if table.y[tip] >= 0.0:
            raise InputError(
                f"{path}: the flange tip is at y = {table.y[tip] * 1e3:+.4g} mm (line "
                f"{table.lines[tip]}); y must point outward from the running circle, so that the "
                "flange is at negative y: mirror y"
            )
    elif int(np.argmin(table.z)) in (0, last):
        raise InputError(
            f"{path}: the highest point is an end of the profile; a rail's whole head is needed, "
            "with z pointing down"
        )


def _check_folds(path: Path, table: _Table, kind: ProfileKind) -> None:
    y, z = table.y, table.z
    dy, dz = np.diff(y), np.diff(z)
    turns_back = dy[1:] * dy[:-1] + dz[1:] * dz[:-1] < 0.0
    if turns_back.any():
        at = int(np.flatnonzero(turns_back)[0]) + 1
        raise InputError(
            f"{path}, line {table.lines[at]}: the outline folds back at this point; put the points "
            "in the order in which they follow each other"
        )
    if kind == "wheel":
        working = np.arange(y.size - 1) >= int(np.argmax(z))
    else:
        working = np.minimum(z[1:], z[:-1]) < z.min() + WORKING_DEPTH
    undercut = working & (dy <= 0.0)
    if undercut.any():
        at = int(np.flatnonzero(undercut)[0]) + 1
        raise InputError(
            f"{path}, line {table.lines[at]}: y goes back from {y[at - 1] * 1e3:.6g} to "
            f"{y[at] * 1e3:.6g} mm on the running surface; y must keep increasing there"
        )
    crossing = _first_crossing(y, z)
    if crossing is not None:
        first, second = crossing
        raise InputError(
            f"{path}, line {table.lines[second]}: the outline crosses itself here and at line "
            f"{table.lines[first]}"
        )


def _first_crossing(y: _FloatArray, z: _FloatArray) -> tuple[int, int] | None:
    """Numbers of two chords that cross, if there are any."""
    dy, dz = np.diff(y), np.diff(z)
    low, high = np.minimum(y[1:], y[:-1]), np.maximum(y[1:], y[:-1])
    order = np.argsort(low)
    # Chords sorted by where they begin in y: only those that begin before this one ends can
    # cross it, which are few on an outline that is nearly a function of y.
    sorted_low = low[order]
    ends = np.searchsorted(sorted_low, high[order], side="right")
    for rank, i in enumerate(order):
        others = order[rank + 1 : ends[rank]]
        others = others[np.abs(others - i) > 1]
        if others.size == 0:
            continue
        side_start = dy[i] * (z[others] - z[i]) - dz[i] * (y[others] - y[i])
        side_end = dy[i] * (z[others + 1] - z[i]) - dz[i] * (y[others + 1] - y[i])
        mine_start = dy[others] * (z[i] - z[others]) - dz[others] * (y[i] - y[others])
        mine_end = dy[others] * (z[i + 1] - z[others]) - dz[others] * (y[i + 1] - y[others])
        hit = (side_start * side_end < 0.0) & (mine_start * mine_end < 0.0)
        if hit.any():
            j = int(others[np.flatnonzero(hit)[0]])
            return min(int(i), j), max(int(i), j)
    return None


def _fit(
    table: _Table, kind: ProfileKind, spacing: float, smoothing_length: float
) -> tuple[_FloatArray, _FloatArray, _FloatArray]:
    from scipy.interpolate import CubicSpline, make_smoothing_spline  # slow to import

    y, z = table.y, table.z
    # Exports crowd their points at the ends (down to tens of nanometres), where rounding alone
    # would decide the slope; of such a crowd one point is enough.
    keep = _thinned(y, z, 0.2 * spacing)
    y, z = y[keep], z[keep]
    steps = np.hypot(np.diff(y), np.diff(z))
    along = np.concatenate(([0.0], np.cumsum(steps)))
    if smoothing_length > 0.0:
        # Weights that stand for ds; lengths in units of the smoothing length condition the fit.
        weight = np.empty_like(along)
        weight[1:-1] = 0.5 * (steps[1:] + steps[:-1])
        weight[0], weight[-1] = 0.5 * steps[0], 0.5 * steps[-1]
        scaled = along / smoothing_length
        weight /= smoothing_length
        fits = [make_smoothing_spline(scaled, values, w=weight, lam=1.0) for values in (y, z)]
        unit = smoothing_length
    else:
        fits = [CubicSpline(along, values, bc_type="natural") for values in (y, z)]
        unit = 1.0
    # The fit is a little longer than the chords: the first sampling finds how many points it takes.
    count = max(2, math.ceil(along[-1] / spacing))
    at = np.linspace(0.0, along[-1], count + 1) / unit
    widest = float(np.hypot(*(np.diff(fit(at)) for fit in fits)).max())
    count = max(count, math.ceil(1.001 * count * widest / spacing))
    at = np.linspace(0.0, along[-1], count + 1) / unit
    new_y, new_z = (np.asarray(fit(at)) for fit in fits)
    y1, z1 = (np.asarray(fit.derivative(1)(at)) for fit in fits)
    y2, z2 = (np.asarray(fit.derivative(2)(at)) for fit in fits)
    bend = (y1 * z2 - z1 * y2) / np.hypot(y1, z1) ** 3
    return new_y, new_z, bend if kind == "rail" else -bend


def _thinned(y: _FloatArray, z: _FloatArray, least: float) -> NDArray[np.int64]:
    """Numbers of the points that are at least this far apart; the ends always stay."""
    kept = [0]
    for i in range(1, y.size - 1):
        far_back = math.hypot(y[i] - y[kept[-1]], z[i] - z[kept[-1]]) >= least
        far_end = math.hypot(y[i] - y[-1], z[i] - z[-1]) >= least
        if far_back and far_end:
            kept.append(i)
    kept.append(y.size - 1)
    return np.array(kept, dtype=np.int64)
