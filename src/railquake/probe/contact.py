"""One wheelset that stands still on two rails."""

from __future__ import annotations

import math
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

    def zones(psi: float) -> list[list[tuple[float, ...]]]:
        found = []
        for sign in (-1.0, 1.0):
            side: list[tuple[float, ...]] = []
            for first, last in (
                (geometry.flange_points, len(geometry.wheel_y)),
                (0, geometry.flange_points),
            ):
                side.append(zone_extremum(sign * shift, sign * psi, first, last, geometry))
            found.append(side)
        return found

    def height(side: list[tuple[float, ...]]) -> float:
        """Z at which the side bears the load."""
        low = min(zone[0] for zone in side)

        def excess(z: float) -> float:
            total = 0.0
            for zone in side:
                _, normal = _normal(zone, z, geometry)
                total += normal / math.hypot(1.0, zone[1])
            return total - load

        if excess(low + 5e-3) < 0.0:
            raise InputError(
                f"a load of {load:g} N presses the wheel more than 5 mm into the rail at a shift "
                f"of {1e3 * shift:g} mm; take a smaller load or shift"
            )
        return float(brentq(excess, low, low + 5e-3, xtol=1e-15))

    def unevenness(psi: float) -> float:
        left, right = zones(psi)
        return height(left) - height(right)

    reach = 0.05
    if unevenness(-reach) * unevenness(reach) > 0.0:
        raise InputError(
            f"at a shift of {1e3 * shift:g} mm the wheelset does not stand on both rails; take a "
            "smaller one"
        )
    psi = float(brentq(unevenness, -reach, reach, xtol=1e-14))
    left, right = zones(psi)
    z = height(left)
    modulus = effective_modulus(wheelrail.youngs_modulus, wheelrail.poisson_ratio)
    patches = []
    for name, sign, side in (("left", -1.0, left), ("right", 1.0, right)):
        for zone in side:
            approach, normal = _normal(zone, z, geometry)
            if normal <= 0.0:
                continue
            _, slope, _, place, rail_z, lateral, rolling, _ = zone
            if abs(slope) > 0.99 * STEEPEST or rail_z > 0.99 * FLOOR:  # beside the drawn rail head
                raise InputError(
                    f"at a shift of {1e3 * shift:g} mm the wheelset stands beside the {name} "
                    "rail; take a smaller one"
                )
            total = lateral + rolling
            theta = np.array([math.acos((rolling - lateral) / total)])
            m, n, _ = hertz_coefficients(theta)
            size = (3.0 * normal / (4.0 * modulus * total)) ** (1.0 / 3.0)
            patches.append(
                Patch(
                    name,
                    float(sign * place),
                    float(rail_z),
                    -math.atan(slope),
                    float(approach),
                    float(normal),
                    float(m[0] * size),
                    float(n[0] * size),
                )
            )
    return StandingWheelset(shift, z, psi, patches)


def _normal(zone: tuple[float, ...], z: float, geometry: Geometry) -> tuple[float, float]:
    """Approach and normal force of a zone with the wheelset's centre at ``z``."""
    gap, slope, _, _, _, lateral, rolling, _ = zone
    approach = max(z - gap, 0.0) / math.hypot(1.0, slope)
    stiffness, _, _ = hertz_lookup(
        lateral, rolling, geometry.hertz_stiffness, geometry.hertz_area, geometry.hertz_creep,
        geometry.hertz_spin,
    )  # fmt: skip
    return approach, stiffness * approach**1.5
