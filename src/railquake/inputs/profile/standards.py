"""S1002 wheel and 60E1 rail from the standards' own definitions."""

from __future__ import annotations

import math
from collections.abc import Callable

from railquake.errors import InputError
from railquake.inputs.profile.segments import (
    Arc,
    Line,
    Point,
    Polynomial,
    Segment,
    profile_from_segments,
    turned,
)
from railquake.inputs.profile.shape import Profile, ProfileKind

_MM = 1e-3

# S1002, flange height 28 mm, flange thickness 32.5 mm (EN 13715 and UIC 510-2): zones by their
# letters, millimetres, y outward from the running circle, z down.
_S1002_A = (1.364323640, -0.066666667)
_S1002_B = (
    0.0,
    -3.358537058e-02,
    1.565681624e-03,
    -2.810427944e-05,
    5.844240864e-08,
    -1.562379023e-08,
    5.309217349e-15,
    -5.957839843e-12,
    2.646656573e-13,
)
_S1002_C = (
    -4.320221063e03,
    -1.038384026e03,
    -1.065501873e02,
    -6.051367875e00,
    -2.054332446e-01,
    -4.169739389e-03,
    -4.687195829e-05,
    -2.252755540e-07,
)
_Y_AB, _Y_BC, _Y_CD, _Y_DE = 32.15796, -26.0, -35.0, -38.426669071
_Y_EF, _Y_FG, _Y_GH, _Y_BACK = -39.764473993, -49.662510381, -62.764705882, -70.0
_Y_RIM = 60.0

# 60E1 (EN 13674-1), millimetres: radii of the head and where they change.
_R_CROWN, _R_SHOULDER, _R_CORNER = 300.0, 80.0, 13.0
_Y_CROWN, _Y_SHOULDER = 10.25, 26.05
_SIDE_SLOPE = 1.0 / 20.0
_HEAD_DEPTH = 37.5
_CANT = 1.0 / 40.0


def builtin_profile(name: str, spacing: float = 1e-4) -> Profile:
    """Draw a profile that is defined by a standard.

    Parameters
    ----------
    name : {"s1002", "60e1"}
        ``s1002``: wheel, EN 13715 / UIC 510-2, flange height 28 mm, thickness 32.5 mm, from the
        back of the flange (y = -70 mm) to 60 mm; y = 0 on the running circle.
        ``60e1``: head of the rail of EN 13674-1 (UIC 60), canted 1:40 towards the track's
        centre, origin at its highest point after canting.
    spacing : float
        Greatest distance between neighbouring points [m].

    Returns
    -------
    Profile

    Raises
    ------
    InputError
        For another name.
    """
    if name.lower() not in _BUILDERS:
        raise InputError(
            f'unknown profile "{name}"; built in are {", ".join(BUILTIN_PROFILES)}, or give a file'
        )
    kind, build = _BUILDERS[name.lower()]
    return profile_from_segments(kind, name.lower(), build(), spacing)


def _s1002_segments() -> list[Segment]:
    def on_arc(y: float, centre: Point, radius: float, side: float) -> Point:
        return y, centre[1] + side * math.sqrt(radius**2 - (y - centre[0]) ** 2)

    # Centres (mm) and radii of the arcs: H back of flange, G tip, F face, D throat.
    centre_h, radius_h = (-49.5, 9.519259302), 20.5
    centre_g, radius_g = (-55.0, 16.0), 12.0
    centre_f, radius_f = (-58.558326413, 8.834924130), 20.0
    centre_d, radius_d = (-26.210665, 16.446), 13.0
    back = on_arc(_Y_BACK, centre_h, radius_h, 1.0)
    tip_back = on_arc(_Y_GH, centre_g, radius_g, 1.0)
    tip_face = on_arc(_Y_FG, centre_g, radius_g, 1.0)
    flank_low = on_arc(_Y_EF, centre_f, radius_f, 1.0)
    flank_high = on_arc(_Y_DE, centre_d, radius_d, -1.0)
    throat = on_arc(_Y_CD, centre_d, radius_d, -1.0)
    taper = _S1002_A[0] + _S1002_A[1] * _Y_AB, _S1002_A[0] + _S1002_A[1] * _Y_RIM
    return [
        _arc(back, tip_back, centre_h, radius_h),
        _arc(tip_back, tip_face, centre_g, radius_g),
        _arc(tip_face, flank_low, centre_f, radius_f),
        _line(flank_low, flank_high),  # 70 degrees, zone E
        _arc(flank_high, throat, centre_d, radius_d, concave=True),
        _polynomial(_S1002_C, _Y_CD, _Y_BC),
        _polynomial(_S1002_B, _Y_BC, _Y_AB),
        _line((_Y_AB, taper[0]), (_Y_RIM, taper[1])),
    ]


def _rail_60e1_segments() -> list[Segment]:
    # One half, from the crown outward, on the rail's own axis.  Each centre lies on the normal
    # where its neighbour ends, which makes the outline tangent-continuous.
    def normal_at(y: float, centre: Point, radius: float) -> tuple[float, float]:
        sine = (y - centre[0]) / radius
        return sine, -math.sqrt(1.0 - sine**2)

    def along(centre: Point, normal: Point, radius: float) -> Point:
        return centre[0] + radius * normal[0], centre[1] + radius * normal[1]

    crown_centre = (0.0, _R_CROWN)
    normal = normal_at(_Y_CROWN, crown_centre, _R_CROWN)
    crown_end = along(crown_centre, normal, _R_CROWN)
    shoulder_centre = along(crown_end, normal, -_R_SHOULDER)
    normal = normal_at(_Y_SHOULDER, shoulder_centre, _R_SHOULDER)
    shoulder_end = along(shoulder_centre, normal, _R_SHOULDER)
    corner_centre = along(shoulder_end, normal, -_R_CORNER)
    side = math.hypot(1.0, _SIDE_SLOPE)
    corner_end = along(corner_centre, (1.0 / side, -_SIDE_SLOPE / side), _R_CORNER)
    foot = corner_end[0] + _SIDE_SLOPE * (_HEAD_DEPTH - corner_end[1]), _HEAD_DEPTH

    # Canting turns the head towards the track's centre (negative y): the top of the rail is then
    # the point whose tangent rose at 1:40, and it becomes the origin.
    tilt = math.atan(_CANT)
    cosine, sine = math.cos(tilt), math.sin(tilt)
    top = _R_CROWN * sine, _R_CROWN * (1.0 - cosine)

    def placed(point: Point, half: float) -> Point:
        y, z = half * point[0] - top[0], point[1] - top[1]
        return y * cosine + z * sine, z * cosine - y * sine

    def half_head(half: float) -> list[Segment]:
        ends = [placed(point, half) for point in ((0.0, 0.0), crown_end, shoulder_end)]
        corner, bottom = placed(corner_end, half), placed(foot, half)
        return [
            _arc(ends[0], ends[1], placed(crown_centre, half), _R_CROWN),
            _arc(ends[1], ends[2], placed(shoulder_centre, half), _R_SHOULDER),
            _arc(ends[2], corner, placed(corner_centre, half), _R_CORNER),
            _line(corner, bottom),
        ]

    gauge_side = [turned(segment) for segment in reversed(half_head(-1.0))]
    return [*gauge_side, *half_head(1.0)]


def _metres(point: Point) -> Point:
    return point[0] * _MM, point[1] * _MM


def _line(start: Point, end: Point) -> Line:
    return Line(_metres(start), _metres(end))


def _arc(start: Point, end: Point, centre: Point, radius: float, concave: bool = False) -> Arc:
    return Arc(_metres(start), _metres(end), _metres(centre), radius * _MM, concave)


def _polynomial(coefficients: tuple[float, ...], y_start: float, y_end: float) -> Polynomial:
    scaled = tuple(value * _MM ** (1 - power) for power, value in enumerate(coefficients))
    return Polynomial(scaled, y_start * _MM, y_end * _MM)


_BUILDERS: dict[str, tuple[ProfileKind, Callable[[], list[Segment]]]] = {
    "s1002": ("wheel", _s1002_segments),
    "60e1": ("rail", _rail_60e1_segments),
}
BUILTIN_PROFILES: tuple[str, ...] = tuple(_BUILDERS)
