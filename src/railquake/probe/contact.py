"""One wheelset that stands still on two rails."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from scipy.optimize import brentq

from railquake.assembly.geometry import FLOOR, STEEPEST, build_geometry
from railquake.errors import InputError
from railquake.physics.hertz import effective_modulus, hertz_coefficients, hertz_lookup
from railquake.physics.profiles import Geometry, zone_extremum

if TYPE_CHECKING:
    from railquake.inputs.wheelrail import WheelRail

__all__ = ["Patch", "StandingWheelset", "standing_contact", "standing_wheelset"]

REACH = 0.05  # roll up to which the wheelset's is looked for, rad
DEEPEST = 5e-3  # approach, m

_Zone = tuple[float, ...]  # of physics.profiles.zone_extremum
_Side = Sequence[_Zone]  # tread and flange


@dataclass(frozen=True)
class Patch:
    """A contact patch of a standing wheelset.

    Attributes
    ----------
    side : str
    y_m, z_m : float
        Contact point in track coordinates, right and down from the rail crowns' midpoint.
    angle_rad : float
        Of the contact plane from the plane of the track, positive where it falls towards the
        middle of the track as a flange's does.
    approach_m : float
        Normal to the contact plane.
    normal_n : float
        Normal force.
    a_m, b_m : float
        Semi-axes of Hertz' ellipse, along the rolling direction and across.
    """

    side: str
    y_m: float
    z_m: float
    angle_rad: float
    approach_m: float
    normal_n: float
    a_m: float
    b_m: float


@dataclass(frozen=True)
class StandingWheelset:
    """A wheelset that stands still on two rails.

    Attributes
    ----------
    shift, height : float
        Of its centre, to the right and down from the rail crowns' midpoint, m.
    roll : float
        rad, right side down.
    patches : list of Patch
        Left side first.
    """

    shift: float
    height: float
    roll: float
    patches: list[Patch]


def standing_contact(wheelrail: WheelRail, shift: float, load: float) -> list[Patch]:
    """Patches of a `standing_wheelset`, left side first."""
    return standing_wheelset(wheelrail, shift, load).patches


def standing_wheelset(wheelrail: WheelRail, shift: float, load: float) -> StandingWheelset:
    """Height, roll and contact of one wheelset that stands still, without friction.

    Both are found such that each wheel bears the load: the height at which a side does so is
    known for any roll, and the roll is the one at which both sides ask for the same height.

    Parameters
    ----------
    wheelrail : WheelRail
    shift : float
        Lateral shift to the right, m.
    load : float
        Vertical load of each wheel, N.

    Returns
    -------
    StandingWheelset

    Raises
    ------
    InputError
        If the wheelset cannot stand there under that load.
    """
    geometry = build_geometry(wheelrail)

    def unevenness(psi: float) -> float:
        left, right = _zones(geometry, shift, psi)
        return _height(geometry, left, shift, load) - _height(geometry, right, shift, load)

    if unevenness(-REACH) * unevenness(REACH) > 0.0:
        raise InputError(
            f"at a shift of {1e3 * shift:g} mm the wheelset does not stand on both rails; take a "
            "smaller one"
        )
    psi = float(brentq(unevenness, -REACH, REACH, xtol=1e-14))
    left, right = _zones(geometry, shift, psi)
    z = _height(geometry, left, shift, load)
    modulus = effective_modulus(wheelrail.youngs_modulus, wheelrail.poisson_ratio)
    patches = []
    for name, sign, side in (("left", -1.0, left), ("right", 1.0, right)):
        for zone in side:
            approach, normal = _normal(zone, z, geometry)
            if normal <= 0.0:
                continue
            if _is_beside_rail(zone):
                raise InputError(
                    f"at a shift of {1e3 * shift:g} mm the wheelset stands beside the {name} "
                    "rail; take a smaller one"
                )
            patches.append(_patch(name, sign, zone, approach, normal, modulus))
    return StandingWheelset(shift, z, psi, patches)


def _zones(geometry: Geometry, shift: float, psi: float) -> tuple[_Side, _Side]:
    """Where the wheels come nearest to their rails, left and right."""
    parts = ((geometry.flange_points, len(geometry.wheel_y)), (0, geometry.flange_points))
    left, right = (
        [zone_extremum(sign * shift, sign * psi, first, last, geometry) for first, last in parts]
        for sign in (-1.0, 1.0)
    )
    return left, right


def _height(geometry: Geometry, side: _Side, shift: float, load: float) -> float:
    """Z at which a side bears the load."""
    low = min(zone[0] for zone in side)

    def excess(z: float) -> float:
        total = 0.0
        for zone in side:
            _, normal = _normal(zone, z, geometry)
            total += normal / math.hypot(1.0, zone[1])
        return total - load

    if excess(low + DEEPEST) < 0.0:
        raise InputError(
            f"a load of {load:g} N presses the wheel more than {1e3 * DEEPEST:g} mm into the rail "
            f"at a shift of {1e3 * shift:g} mm; take a smaller load or shift"
        )
    return float(brentq(excess, low, low + DEEPEST, xtol=1e-15))


def _is_beside_rail(zone: _Zone) -> bool:
    """Whether a zone lies on what the profile is continued with beside the drawn rail head."""
    _, slope, _, _, rail_z, _, _, _ = zone
    return abs(slope) > 0.99 * STEEPEST or rail_z > 0.99 * FLOOR


def _patch(
    name: str, sign: float, zone: _Zone, approach: float, normal: float, modulus: float
) -> Patch:
    """A zone's patch with its ellipse after Hertz."""
    _, slope, _, place, rail_z, lateral, rolling, _ = zone
    total = lateral + rolling
    theta = np.array([math.acos((rolling - lateral) / total)])
    m, n, _ = hertz_coefficients(theta)
    size = (3.0 * normal / (4.0 * modulus * total)) ** (1.0 / 3.0)
    return Patch(
        name,
        float(sign * place),
        float(rail_z),
        -math.atan(slope),
        float(approach),
        float(normal),
        float(m[0] * size),
        float(n[0] * size),
    )


def _normal(zone: _Zone, z: float, geometry: Geometry) -> tuple[float, float]:
    """Approach and normal force of a zone with the wheelset's centre at ``z``."""
    gap, slope, _, _, _, lateral, rolling, _ = zone
    approach = max(z - gap, 0.0) / math.hypot(1.0, slope)
    stiffness, *_ = hertz_lookup(
        lateral, rolling, geometry.hertz_stiffness, geometry.hertz_area, geometry.hertz_along,
        geometry.hertz_creep, geometry.hertz_spin, geometry.hertz_log_ratio,
    )  # fmt: skip
    return approach, stiffness * approach**1.5
