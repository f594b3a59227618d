"""Place, angle and approach of the contact against CONTACT's exact ones (see readme.md)."""

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from railquake.assembly.geometry import build_geometry
from railquake.inputs.wheelrail import WheelRail
from railquake.physics.profiles import zone_contact, zone_extremum
from reference_numbers import columns, reference

HERE = Path(__file__).parent
CASES = reference(__file__)


@pytest.fixture(scope="module")
def pair():
    return build_geometry(WheelRail.from_preset("s1002-60e1"))


def patches(pair, shift, load):
    """Share, approach, place and angle of the tread's and the flange's patch of the left wheel.

    Level wheelset under a total normal force, as CONTACT had it; the left wheel is the mirror
    image of the right one, with which `zone_contact` deals.
    """
    zones = []
    for first, last in ((pair.flange_points, len(pair.wheel_y)), (0, pair.flange_points)):
        gap, slope, _, _, stiffness, _, _ = zone_contact(-shift, 0.0, first, last, pair)
        place = zone_extremum(-shift, 0.0, first, last, pair)[3]
        zones.append((gap, math.atan(slope), stiffness, place))

    def forces(height):
        return [k * max((height - g) * math.cos(angle), 0.0) ** 1.5 for g, angle, k, _ in zones]

    low = min(zone[0] for zone in zones)
    height = brentq(lambda z: sum(forces(z)) - load, low, low + 1e-3, xtol=1e-12)
    return [
        (force / load, (height - gap) * math.cos(angle), -place, -angle)
        for force, (gap, angle, _, place) in zip(forces(height), zones, strict=True)
    ]


@pytest.mark.parametrize("case", CASES["single"], ids=lambda c: f"{c['shift']:g}mm-{c['load']:g}kN")
def test_a_single_contact_is_where_contact_has_it(pair, case):
    numbers = columns(HERE / "normal.csv")
    rows = np.flatnonzero((numbers["y_ws_mm"] == case["shift"]) & (numbers["N_kN"] <= case["load"]))
    assert rows.size
    for row in rows:
        load = 1e3 * numbers["Fn_total_kN"][row]
        share, approach, place, angle = max(patches(pair, 1e-3 * case["shift"], load))
        assert share == pytest.approx(1.0)
        assert 1e3 * approach == pytest.approx(numbers["pen_mm"][row], rel=case["approach"])
        centre = numbers["y_pressure_cog_track_mm"][row]
        assert 1e3 * place == pytest.approx(centre, abs=case["place"])
        assert angle == pytest.approx(numbers["angle_rad"][row], abs=case["angle"])


def test_tread_and_throat_bear_at_once_where_contact_has_two_lobes(pair):
    case = CASES["lobes"]
    numbers = columns(HERE / "lobes.csv")
    rows = (numbers["y_ws_mm"] == case["shift"]) & (numbers["N_kN"] == case["load"])
    found = patches(pair, 1e-3 * case["shift"], 1e3 * case["load"])
    assert rows.sum() == len(found) == 2
    for (share, _, place, _), expected, centre in zip(
        found, numbers["Fn_share"][rows], numbers["y_cog_planar_mm"][rows], strict=True
    ):
        assert share == pytest.approx(expected, abs=case["share"])
        assert 1e3 * place == pytest.approx(centre, abs=case["place"])


@pytest.mark.parametrize(
    ("here", "source"),
    [("normal.csv", "contact_normal.csv"), ("lobes.csv", "contact_normal_lobes.csv")],
)
def test_the_numbers_here_are_those_of_the_source(shared, here, source):
    theirs = columns(shared / "oracles" / source)
    for column, values in columns(HERE / here).items():
        np.testing.assert_array_equal(values, theirs[column])
