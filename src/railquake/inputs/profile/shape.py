"""The cross-section of a wheel or a rail as points with their curvature."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from railquake.errors import InputError

ProfileKind = Literal["wheel", "rail"]

_FACE_DEPTHS = (0.015, 0.0175, 0.02, 0.0225, 0.025, 0.0275)  # where a head's faces are steep [m]
_CROWN_HALF_WIDTH = 0.01


@dataclass(frozen=True, eq=False)
class Profile:
    """Points of the right-hand wheel's or rail's cross-section.

    Parameters
    ----------
    kind : {"wheel", "rail"}
        What it is a section of.
    name : str
        What to call it in messages and pictures.
    y : (n,) array
        Lateral coordinates [m], positive outward; 0 on the running circle (wheel) or at the
        rail's own reference.
    z : (n,) array
        Vertical coordinates [m], positive down.
    curvature : (n,) array
        Curvature [1/m]; positive where the body is convex, that is, bulges towards the other
        body (tread crown, flange tip, rail head), negative where it is concave (flange throat).

    Raises
    ------
    InputError
        If the arrays differ in length, hold fewer than 3 points or a value that is not finite,
        repeat a point, or run from the field side to the gauge side.

    Notes
    -----
    Points follow each other along the outline from the gauge side (back of the flange first) to
    the field side.  The arrays are copies and read-only.
    """

    kind: ProfileKind
    name: str
    y: NDArray[np.float64]
    z: NDArray[np.float64]
    curvature: NDArray[np.float64]

    def __post_init__(self) -> None:
        if self.kind not in get_args(ProfileKind):
            raise InputError(f'profile {self.name}: kind is "{self.kind}"; use "wheel" or "rail"')
        for field in ("y", "z", "curvature"):
            values = np.array(getattr(self, field), dtype=np.float64)  # a copy, ours to lock
            if values.ndim != 1:
                raise InputError(f"profile {self.name}: {field} is not a plain list of numbers")
            if not np.isfinite(values).all():
                at = int(np.flatnonzero(~np.isfinite(values))[0])
                raise InputError(
                    f"profile {self.name}: {field} of point {at + 1} is {values[at]}; "
                    "every coordinate must be a finite number"
                )
            values.setflags(write=False)
            object.__setattr__(self, field, values)
        if not (self.y.size == self.z.size == self.curvature.size):
            raise InputError(
                f"profile {self.name}: y, z and curvature have {self.y.size}, {self.z.size} and "
                f"{self.curvature.size} values; they must be equally many"
            )
        if self.y.size < 3:
            raise InputError(f"profile {self.name}: {self.y.size} points; at least 3 are needed")
        steps = np.hypot(np.diff(self.y), np.diff(self.z))
        if not (steps > 0.0).all():
            at = int(np.flatnonzero(steps <= 0.0)[0])
            raise InputError(f"profile {self.name}: point {at + 2} repeats point {at + 1}")
        if self.y[0] >= self.y[-1]:
            raise InputError(
                f"profile {self.name}: starts at y = {self.y[0]:g} m and ends at "
                f"{self.y[-1]:g} m; order the points from the gauge side to the field side"
            )

    @property
    def arc_length(self) -> NDArray[np.float64]:
        """Length [m] along the chords from the first point to each point, (n,)."""
        steps = np.hypot(np.diff(self.y), np.diff(self.z))
        return np.concatenate(([0.0], np.cumsum(steps)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Profile):
            return NotImplemented
        return self._key() == other._key()

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[Any, ...]:
        arrays = (self.y, self.z, self.curvature)
        return (self.kind, self.name, *(values.tobytes() for values in arrays))


def flange_tip(profile: Profile) -> tuple[float, float]:
    """Lowest point of a wheel: the tip of its flange.

    Parameters
    ----------
    profile : Profile
        A wheel.

    Returns
    -------
    (float, float)
        ``y`` and ``z`` of the lowest point [m]; the middle one where several are equally low.

    Raises
    ------
    InputError
        If it is a rail, or the lowest point is an end of the profile.
    """
    if profile.kind != "wheel":
        raise InputError(f"profile {profile.name}: a rail has no flange; a wheel is needed")
    lowest = np.flatnonzero(profile.z == profile.z.max())
    at = int(lowest[lowest.size // 2])
    if lowest[0] == 0 or lowest[-1] == profile.z.size - 1:
        raise InputError(
            f"profile {profile.name}: its lowest point is one of its ends, so it shows no flange "
            "tip; give the wheel from the back of the flange to the rim, with z pointing down"
        )
    return float(profile.y[at]), float(profile.z[at])


def point_at_height(
    profile: Profile, height: float, side: Literal["gauge", "field"] = "gauge"
) -> float:
    """Lateral position where a profile passes a height, seen from its crown or flange tip.

    Parameters
    ----------
    profile : Profile
        A rail is followed from its highest point, a wheel from its flange tip.
    height : float
        Vertical coordinate ``z`` [m], positive down, in the profile's own axes.
    side : {"gauge", "field"}
        The side to follow the outline on.

    Returns
    -------
    float
        ``y`` [m] of the first crossing, by linear interpolation between the points.

    Raises
    ------
    InputError
        If the outline does not reach this height on that side.
    """
    start = int(np.argmin(profile.z) if profile.kind == "rail" else np.argmax(profile.z))
    if side == "gauge":
        y, z = profile.y[start::-1], profile.z[start::-1]
    else:
        y, z = profile.y[start:], profile.z[start:]
    above = z - height
    crossings = np.flatnonzero(above[:-1] * above[1:] <= 0.0)
    if crossings.size == 0:
        raise InputError(
            f"profile {profile.name}: its {side} side does not reach z = {height:g} m "
            f"(it spans {z.min():g} to {z.max():g} m)"
        )
    at = int(crossings[0])
    if above[at] == above[at + 1]:  # lies along the height: its nearest point
        return float(y[at])
    share = above[at] / (above[at] - above[at + 1])
    return float(y[at] + share * (y[at + 1] - y[at]))


def face_offset(rail_profile: Profile, depth: float = 0.014) -> float:
    """Lateral position of a rail's gauge face.

    Parameters
    ----------
    rail_profile : Profile
        A rail.
    depth : float
        How far below the rail's highest point the gauge is measured [m].

    Returns
    -------
    float
        ``y`` [m] of the gauge face in the profile's own axes (normally negative).  A rail whose
        origin stands at ``gauge / 2 - face_offset(rail)`` from the track's centre gives the gauge.

    Raises
    ------
    InputError
        If it is a wheel, or the gauge face ends above that depth.
    """
    if rail_profile.kind != "rail":
        raise InputError(f"profile {rail_profile.name}: a wheel has no gauge face; give a rail")
    return point_at_height(rail_profile, float(rail_profile.z.min()) + depth, "gauge")


def outward_lean(rail_profile: Profile) -> float:
    """How far a rail's head leans away from the track's middle.

    Parameters
    ----------
    rail_profile : Profile
        A rail.

    Returns
    -------
    float
        Radians, positive where its top leans outward, as that of a canted rail does whose outline
        is mirrored; the smaller of what the middle between both faces and what the running
        surface shows, so that wear on one side is not taken for it.  0 where the outline does not
        show both, or they contradict each other.

    Raises
    ------
    InputError
        If it is a wheel.
    """
    if rail_profile.kind != "rail":
        raise InputError(f"profile {rail_profile.name}: a wheel has no head; give a rail")
    top = float(rail_profile.z.min())
    try:
        middles = [
            0.5 * sum(point_at_height(rail_profile, top + d, side) for side in ("gauge", "field"))
            for d in _FACE_DEPTHS
        ]
    except InputError:  # it ends above
        return 0.0
    of_faces = -float(np.polyfit(_FACE_DEPTHS, middles, 1)[0])
    y, z = rail_profile.y, rail_profile.z
    crown = (np.abs(y - middles[0]) < _CROWN_HALF_WIDTH) & (z < top + _FACE_DEPTHS[0])
    if crown.sum() < 3:
        return 0.0
    of_crown = float(np.polyfit(y[crown], z[crown], 1)[0])
    if of_faces * of_crown <= 0.0:
        return 0.0
    return min(of_faces, of_crown, key=abs)
