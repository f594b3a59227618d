"""Profiles drawn from straight lines, circular arcs and polynomials.

Position is sampled along each segment, curvature is the segment's own: a contact radius read
from an arc is exact and does not depend on how finely the arc is sampled.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from railquake.errors import InputError
from railquake.inputs.profile.shape import Profile, ProfileKind

Point = tuple[float, float]
_Samples = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]

# Printed tables round coordinates; two segments meet if their ends agree this well [m].
JOINT_TOLERANCE = 2e-5
# Printed centres and radii are rounded too: allowed misfit of an arc's ends, relative and [m].
ARC_TOLERANCE = (1e-3, 5e-6)
_METRES = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "in": 0.0254, "inch": 0.0254, "ft": 0.3048}


@dataclass(frozen=True)
class Line:
    """A straight line between two points ``(y, z)`` [m]."""

    start: Point
    end: Point


@dataclass(frozen=True)
class Arc:
    """A circular arc of less than a half turn between two points [m].

    The two ends and the radius define it; the centre, as printed in a table, tells the side and
    is checked.  `concave` says that the body's outline is hollow there (flange throat); it is
    checked against the geometry.
    """

    start: Point
    end: Point
    centre: Point
    radius: float
    concave: bool = False


@dataclass(frozen=True)
class Polynomial:
    """``z = c0 + c1 y + c2 y^2 + ...`` from `y_start` to `y_end` [m, coefficients in m^(1-k)]."""

    coefficients: tuple[float, ...]
    y_start: float
    y_end: float


Segment = Line | Arc | Polynomial


def profile_from_segments(
    kind: ProfileKind, name: str, segments: Sequence[Segment], spacing: float = 1e-4
) -> Profile:
    """Sample a chain of segments at points close to each other.

    Parameters
    ----------
    kind : {"wheel", "rail"}
        What the outline is a section of; decides which bend counts as convex.
    name : str
        What to call the profile.
    segments : sequence of Line, Arc or Polynomial
        The outline, each segment starting where the one before it ends; from the gauge side to
        the field side, or the other way round (the whole chain is then turned).
    spacing : float
        Greatest distance between neighbouring points along the outline [m].

    Returns
    -------
    Profile
        Ends of segments are always points; at a joint, the curvature is that of the segment
        which begins there (seen from the gauge side).

    Raises
    ------
    InputError
        If the chain is broken, an arc contradicts its centre, radius or `concave`, or a number
        is not finite.
    """
    if not segments:
        raise InputError(f"profile {name}: no segments; at least one is needed")
    if not (math.isfinite(spacing) and spacing > 0.0):
        raise InputError(f"profile {name}: spacing is {spacing} m; it must be positive")
    for number, segment in enumerate(segments, start=1):
        _check_segment(segment, f"profile {name}, segment {number}")
    if _ends(segments[0])[0][0] > _ends(segments[-1])[1][0]:
        chain = [(i + 1, turned(segments[i])) for i in reversed(range(len(segments)))]
    else:
        chain = list(enumerate(segments, start=1))

    # A left-to-right outline has the rail's body below it (larger z) and the wheel's above it.
    convex_sign = 1.0 if kind == "rail" else -1.0
    pieces: list[_Samples] = []
    for number, segment in chain:
        where = f"profile {name}, segment {number}"
        y, z, bend = _sample(segment, spacing, where)
        if pieces:
            gap_y, gap_z = pieces[-1][0][-1] - y[0], pieces[-1][1][-1] - z[0]
            gap = math.hypot(gap_y, gap_z)
            if gap > JOINT_TOLERANCE:
                raise InputError(
                    f"{where}: begins {gap * 1e3:.3g} mm away from its neighbour's end; "
                    "segments must join"
                )
            # What rounding in the source left open is closed along the whole segment: a step of
            # 0.1 um between two points 0.1 mm apart would be a corner of 1 mrad.
            share = np.linspace(1.0, 0.0, y.size)
            y, z = y + share * gap_y, z + share * gap_z
        if isinstance(segment, Arc):
            hollow = bend[0] * convex_sign < 0.0
            if hollow != segment.concave:
                found, given = ("concave", "convex") if hollow else ("convex", "concave")
                raise InputError(
                    f"{where}: the arc is {found} for a {kind} but is given as {given}; "
                    "check its centre, the order of its ends and `concave`"
                )
        pieces.append((y, z, convex_sign * bend))

    # The joint belongs to the segment that begins there, so each piece but the last drops its end.
    trimmed = [tuple(values[:-1] for values in piece) for piece in pieces[:-1]]
    joined = [*trimmed, pieces[-1]]
    y, z, curvature = (np.concatenate([piece[i] for piece in joined]) for i in range(3))
    return Profile(kind, name, y, z, curvature)


def segments_from_table(
    rows: Sequence[Mapping[str, Any]], unit: str = "m", mirror: bool = False
) -> list[Segment]:
    """Read segments from the rows of a table, as a preset or case file holds them.

    Parameters
    ----------
    rows : sequence of mappings
        ``{kind = "line", start = [y, z], end = [y, z]}``;
        ``{kind = "arc", start, end, centre = [y, z], radius, concave = false}``;
        ``{kind = "polynomial", coefficients = [c0, c1, ...], y_start, y_end}``.
    unit : {"m", "cm", "mm", "in", "inch", "ft"}
        Unit of every length in the rows.
    mirror : bool
        The rows draw one half of a section that is symmetric about ``y = 0``, beginning there;
        the other half is added.

    Returns
    -------
    list of Line, Arc or Polynomial
        In metres.

    Raises
    ------
    InputError
        For an unknown unit, kind or key, a missing key, or a value that is not a number.
    """
    if unit not in _METRES:
        raise InputError(
            f'profile segments: unknown unit "{unit}"; use one of {", ".join(_METRES)}'
        )
    scale = _METRES[unit]
    segments = [
        _segment_from_row(row, scale, f"profile segment {number}")
        for number, row in enumerate(rows, start=1)
    ]
    if not mirror or not segments:
        return segments
    (y_first, _), _ = _ends(segments[0])
    if abs(y_first) > JOINT_TOLERANCE:
        raise InputError(
            f"profile segment 1: begins at y = {y_first:g} m; with mirror = true it must begin "
            "on the axis of symmetry, y = 0"
        )
    return [turned(_mirrored(segment)) for segment in reversed(segments)] + segments


def _segment_from_row(row: Mapping[str, Any], scale: float, where: str) -> Segment:
    required: dict[str, tuple[str, ...]] = {
        "line": ("start", "end"),
        "arc": ("start", "end", "centre", "radius"),
        "polynomial": ("coefficients", "y_start", "y_end"),
    }
    if not isinstance(row, Mapping):
        raise InputError(f'{where}: is not a table of keys such as kind = "line"')
    kind = row.get("kind")
    if not isinstance(kind, str) or kind not in required:
        raise InputError(f'{where}: kind is {kind!r}; use "line", "arc" or "polynomial"')
    allowed = {"kind", *required[kind]} | ({"concave"} if kind == "arc" else set())
    unknown = sorted(str(key) for key in row if key not in allowed)
    if unknown:
        raise InputError(f'{where}: unknown key "{unknown[0]}"; use {", ".join(sorted(allowed))}')
    for key in required[kind]:
        if key not in row:
            raise InputError(f'{where}: "{key}" is missing')

    def number(key: str) -> float:
        return _number(row[key], f'{where}: "{key}"') * scale

    def point(key: str) -> Point:
        value = row[key]
        if not isinstance(value, (list, tuple)) or len(value) != 2:
            raise InputError(f'{where}: "{key}" must be two numbers, [y, z]')
        y, z = (_number(item, f'{where}: "{key}"') * scale for item in value)
        return y, z

    if kind == "line":
        return Line(point("start"), point("end"))
    if kind == "arc":
        concave = row.get("concave", False)
        if not isinstance(concave, bool):
            raise InputError(f'{where}: "concave" must be true or false')
        return Arc(point("start"), point("end"), point("centre"), number("radius"), concave)
    values = row["coefficients"]
    if not isinstance(values, (list, tuple)) or not values:
        raise InputError(f'{where}: "coefficients" must be a list of numbers, [c0, c1, ...]')
    coefficients = tuple(
        _number(value, f'{where}: "coefficients"') * scale ** (1 - power)
        for power, value in enumerate(values)
    )
    return Polynomial(coefficients, number("y_start"), number("y_end"))


def _number(value: Any, where: str) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"{where} holds {value!r}, which is not a number")
    return float(value)


def _height(segment: Polynomial, y: float) -> float:
    return float(np.polynomial.polynomial.polyval(y, np.asarray(segment.coefficients)))


def _ends(segment: Segment) -> tuple[Point, Point]:
    if isinstance(segment, Polynomial):
        y0, y1 = segment.y_start, segment.y_end
        return (y0, _height(segment, y0)), (y1, _height(segment, y1))
    return segment.start, segment.end


def turned(segment: Segment) -> Segment:
    """Walk the same segment the other way."""
    if isinstance(segment, Polynomial):
        return replace(segment, y_start=segment.y_end, y_end=segment.y_start)
    return replace(segment, start=segment.end, end=segment.start)


def _mirrored(segment: Segment) -> Segment:
    """Reflect the segment in ``y = 0``."""
    if isinstance(segment, Polynomial):
        signs = [(-1.0) ** power for power in range(len(segment.coefficients))]
        flipped = tuple(sign * c for sign, c in zip(signs, segment.coefficients, strict=True))
        return Polynomial(flipped, -segment.y_start, -segment.y_end)

    def flip(point: Point) -> Point:
        return -point[0], point[1]

    if isinstance(segment, Line):
        return Line(flip(segment.start), flip(segment.end))
    return replace(
        segment, start=flip(segment.start), end=flip(segment.end), centre=flip(segment.centre)
    )


def _check_segment(segment: Segment, where: str) -> None:
    if isinstance(segment, Polynomial):
        numbers: tuple[float, ...] = (*segment.coefficients, segment.y_start, segment.y_end)
    elif isinstance(segment, Arc):
        numbers = (*segment.start, *segment.end, *segment.centre, segment.radius)
    else:
        numbers = (*segment.start, *segment.end)
    if not all(math.isfinite(number) for number in numbers):
        raise InputError(f"{where}: holds a number that is not finite")
    start, end = _ends(segment)
    if math.dist(start, end) == 0.0:
        raise InputError(f"{where}: starts and ends at the same point")
    if isinstance(segment, Arc):
        if segment.radius <= 0.0:
            raise InputError(f"{where}: radius is {segment.radius:g} m; it must be positive")
        allowed = ARC_TOLERANCE[0] * segment.radius + ARC_TOLERANCE[1]
        for label, point in (("start", start), ("end", end)):
            misfit = math.dist(point, segment.centre) - segment.radius
            if abs(misfit) > allowed:
                raise InputError(
                    f"{where}: its {label} is {abs(misfit) * 1e3:.3g} mm off the circle of radius "
                    f"{segment.radius * 1e3:g} mm about its centre; check centre and radius"
                )


def _sample(segment: Segment, spacing: float, where: str) -> _Samples:
    """Points from start to end, with the curvature ``y' z'' - z' y''`` of the walked curve."""
    if isinstance(segment, Line):
        return _sample_line(segment, spacing)
    if isinstance(segment, Arc):
        return _sample_arc(segment, spacing)
    return _sample_polynomial(segment, spacing, where)


def _sample_line(segment: Line, spacing: float) -> _Samples:
    count = max(1, math.ceil(math.dist(segment.start, segment.end) / spacing))
    y = np.linspace(segment.start[0], segment.end[0], count + 1)
    z = np.linspace(segment.start[1], segment.end[1], count + 1)
    return y, z, np.zeros(count + 1)


def _sample_arc(segment: Arc, spacing: float) -> _Samples:
    # The circle of the given radius through both ends, on the given centre's side: it meets its
    # neighbours exactly, which a circle about the rounded centre would miss by micrometres.
    (y0, z0), (y1, z1) = segment.start, segment.end
    chord = math.dist(segment.start, segment.end)
    radius = max(segment.radius, 0.5 * chord)
    along = ((y1 - y0) / chord, (z1 - z0) / chord)
    across = (-along[1], along[0])
    offset = (segment.centre[0] - y0) * across[0] + (segment.centre[1] - z0) * across[1]
    rise = math.copysign(math.sqrt(radius**2 - (0.5 * chord) ** 2), offset)
    half_angle = math.asin(0.5 * chord / radius)
    count = max(1, math.ceil(2.0 * half_angle * radius / spacing))
    angle = np.linspace(-half_angle, half_angle, count + 1)
    # Local axes: t along the chord, w towards the centre.
    t = 0.5 * chord + radius * np.sin(angle)
    w = rise - math.copysign(1.0, rise) * radius * np.cos(angle)
    y = y0 + t * along[0] + w * across[0]
    z = z0 + t * along[1] + w * across[1]
    y[0], z[0], y[-1], z[-1] = y0, z0, y1, z1
    return y, z, np.full(count + 1, math.copysign(1.0 / radius, rise))


def _sample_polynomial(segment: Polynomial, spacing: float, where: str) -> _Samples:
    poly = np.polynomial.Polynomial(np.asarray(segment.coefficients))
    slope = poly.deriv()
    # Equal steps along the outline: invert the arc length, integrated ten times as finely.
    rough = max(50, math.ceil(10.0 * abs(segment.y_end - segment.y_start) / spacing))
    if rough > 10_000_000:
        raise InputError(f"{where}: too long for points {spacing:g} m apart; check its unit")
    fine = np.linspace(segment.y_start, segment.y_end, rough + 1)
    steepness = np.sqrt(1.0 + slope(fine) ** 2)
    steps = 0.5 * (steepness[1:] + steepness[:-1]) * np.abs(np.diff(fine))
    length = np.concatenate(([0.0], np.cumsum(steps)))
    count = max(1, math.ceil(length[-1] / spacing))
    y = np.interp(np.linspace(0.0, length[-1], count + 1), length, fine)
    bend = poly.deriv(2)(y) / (1.0 + slope(y) ** 2) ** 1.5
    direction = math.copysign(1.0, segment.y_end - segment.y_start)
    return y, poly(y), direction * bend
