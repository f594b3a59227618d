"""What the comparisons with CONTACT's normal contact share: its numbers, and our level wheelset."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from railquake.assembly.geometry import build_geometry
from railquake.inputs.wheelrail import WheelRail
from railquake.physics.hertz import effective_modulus, hertz_coefficients
from railquake.physics.profiles import Geometry, rail_at, zone_contact, zone_extremum
from railquake.validation.reference import columns, numbers_beside, toml

__all__ = [
    "CONFORMAL",
    "HERTZIAN_TOLERANCE",
    "SETTINGS",
    "SOURCE",
    "State",
    "departure",
    "geometry",
    "lobe_case",
    "numbers",
    "patches",
    "states",
]

SOURCE = """CONTACT (Vollebregt; Kalker's exact half-space theory), S1002 wheel on UIC60 rail, 1:40,
gauge 1435 mm, zero roll, frictionless, steel E 209.92 GPa, nu 0.28. The files beside the module
hold the columns used here of the reference data's `contact_normal.csv` and
`contact_normal_lobes.csv`, whose first lines give every setting."""
SETTINGS = """The left wheel of a level wheelset, shifted sideways and pressed down until the total
normal force is CONTACT's. CONTACT's profiles are drawn points; ours are the standards' own
definitions, within 0.05 mm of them."""

CONFORMAL = 0.4
"""Departure from a parabola, above which a contact is called nearly conformal; see `departure`."""
NEAR = 0.012
"""From the contact's place, m: where the wheel's outline is looked at."""
HERTZIAN_TOLERANCE = 0.05
"""Of the approach, where the contact is not nearly conformal; the stated ones are within it."""


@dataclass(frozen=True)
class State:
    """One of CONTACT's results with a single patch, and ours.

    Attributes
    ----------
    name : str
        Shift and load, and whether it is nearly conformal.
    shift, load : float
        mm to the right, towards which the left wheel's flange goes where negative; kN, normal.
    conformal : bool
        From the profiles, see `departure`.
    tolerance : dict
        ``approach`` relative, ``place`` in mm, ``angle`` in rad.
    theirs, ours : dict
        ``approach`` and ``place`` in mm (``place`` of the pressure's centre), ``angle`` in rad.
    """

    name: str
    shift: float
    load: float
    conformal: bool
    tolerance: dict[str, float]
    theirs: dict[str, float]
    ours: dict[str, float]


@cache
def geometry() -> Geometry:
    """The pair of profiles."""
    return build_geometry(WheelRail.from_preset("s1002-60e1"))


@cache
def numbers(file: str) -> dict[str, Any]:
    """Columns of one of CONTACT's files."""
    return columns(numbers_beside("contact_states", file))


@cache
def _tolerances() -> dict[str, Any]:
    return toml(numbers_beside("contact_states", "tolerances.toml"))


def lobe_case() -> dict[str, float]:
    """Shift, load and tolerances of the contact with two lobes."""
    return dict(_tolerances()["lobes"])


def _zones(pair: Geometry) -> tuple[tuple[int, int], tuple[int, int]]:
    """Wheel points of the tread and of the flange."""
    return (pair.flange_points, len(pair.wheel_y)), (0, pair.flange_points)


def patches(
    shift: float, load: float, flange_offset: float = 0.0, roll: float = 0.0
) -> list[tuple[float, float, float, float]]:
    """Share, approach (m), place (m) and angle (rad) of the left wheel's tread and flange.

    The left wheel is the mirror image of the right one, with which the physics deals.

    Parameters
    ----------
    shift : float
        m, to the right.
    load : float
        Total normal force, N.
    flange_offset : float
        Height by which the flange's side of the profiles is moved apart, m.
    roll : float
        Of the wheelset, left side down, rad.
    """
    pair = geometry()
    zones = []
    for (first, last), offset in zip(_zones(pair), (0.0, flange_offset), strict=True):
        found = zone_contact(-shift, roll, first, last, pair)
        place = zone_extremum(-shift, roll, first, last, pair)[3]
        zones.append((found.gap + offset, math.atan(found.slope), found.stiffness, place))

    def forces(height: float) -> list[float]:
        return [k * max((height - g) * math.cos(angle), 0.0) ** 1.5 for g, angle, k, _ in zones]

    low = min(zone[0] for zone in zones)
    height = float(brentq(lambda z: sum(forces(z)) - load, low, low + 1e-3, xtol=1e-12))
    return [
        (force / load, (height - gap) * math.cos(angle), -place, -angle)
        for force, (gap, angle, _, place) in zip(forces(height), zones, strict=True)
    ]


def departure(shift: float, load: float, roll: float = 0.0) -> float:
    """How far the gap under Hertz' ellipse is from the parabola that Hertz assumes.

    The largest difference over the ellipse's width between the undeformed gap of the profiles,
    normal to the contact plane, and the parabola of the curvatures at the point of first contact;
    over the parabola's height at the ellipse's edge.  It needs nothing of CONTACT's results.
    """
    pair = geometry()
    modulus = effective_modulus(209.92e9, 0.28)
    deepest = min(
        (zone_extremum(-shift, roll, first, last, pair) for first, last in _zones(pair)),
        key=lambda zone: zone[0],
    )
    gap, slope, _, place, _, lateral, rolling, _ = deepest
    total = lateral + rolling
    _, n, _ = hertz_coefficients(np.array([math.acos((rolling - lateral) / total)]))
    half_width = float(n[0]) * (3.0 * load / (4.0 * modulus * total)) ** (1.0 / 3.0)
    along = np.linspace(-half_width, half_width, 201)
    cosine = 1.0 / math.hypot(1.0, slope)
    y = place + along * cosine
    sine, cosine_of_roll = math.sin(roll), math.cos(roll)
    wheel_y = pair.wheel_y * cosine_of_roll - pair.wheel_z * sine
    wheel_z = pair.wheel_y * sine + pair.wheel_z * cosine_of_roll
    near = np.abs(wheel_y - shift - place) < NEAR
    wheel = PchipInterpolator(wheel_y[near], wheel_z[near])
    rail = [
        rail_at(at, pair.rail_start, pair.rail_step, pair.rail_z, pair.rail_slope)[0] for at in y
    ]
    separation = (np.array(rail) - wheel(y + shift) - gap) * cosine
    parabola = lateral * along**2
    return float(np.abs(separation - parabola).max() / parabola.max())


@cache
def states() -> tuple[State, ...]:
    """All of CONTACT's results with a single patch.

    Raises
    ------
    ValueError
        If a contact that is not nearly conformal has a tolerance above `HERTZIAN_TOLERANCE`, or
        ours bears on two patches.
    """
    table = numbers("normal.csv")
    cases = sorted(_tolerances()["single"], key=lambda case: case["load"])
    found = []
    for row, (shift, load) in enumerate(zip(table["y_ws_mm"], table["N_kN"], strict=True)):
        tolerance = next(
            (case for case in cases if case["shift"] == shift and case["load"] >= load), None
        )
        if tolerance is None:  # two lobes
            continue
        normal = 1e3 * table["Fn_total_kN"][row]
        conformal = departure(1e-3 * shift, normal) > CONFORMAL
        name = f"shift {shift:g} mm, {load:g} kN" + (", nearly conformal" if conformal else "")
        if tolerance["approach"] > HERTZIAN_TOLERANCE and not conformal:
            raise ValueError(f"{name}: a tolerance of {tolerance['approach']:g} needs a reason")
        share, approach, place, angle = max(patches(1e-3 * shift, normal))
        if share < 0.9999:
            raise ValueError(f"{name}: a second patch bears {1.0 - share:.2%}")
        found.append(
            State(
                name,
                float(shift),
                float(load),
                conformal,
                tolerance,
                {
                    "approach": float(table["pen_mm"][row]),
                    "place": float(table["y_pressure_cog_track_mm"][row]),
                    "angle": float(table["angle_rad"][row]),
                },
                {"approach": 1e3 * approach, "place": 1e3 * place, "angle": angle},
            )
        )
    return tuple(found)
