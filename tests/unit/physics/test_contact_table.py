"""The contact table as the kernel reads it: one smooth gap, its gradient, mirrored sides."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import railquake as rq
from railquake.assembly.geometry import DISPLACEMENT_AXIS, ROLL_AXIS, running_circle
from railquake.inputs.ground_motion import GroundMotion
from railquake.march import contact
from railquake.march.rows import constant, size, state
from railquake.march.step import find_contact_forces
from railquake.physics.contact_table import axis_nodes, running_point
from railquake.physics.profiles import zone_contact
from stages import stage

WHEELSET = np.array([size.WHEELSET_Y, size.WHEELSET_Z, size.WHEELSET_PHI])
SIDES = {"left": 0, "right": 1}
ZONES = {"tread": 0, "flange": 1}


class Bench:
    """A scenario at grade, of which only the contact is used."""

    def __init__(self, system):
        self.system = system
        self.circle = running_circle(system.scenario.wheelrail)
        self.find_contact_forces = stage(system, find_contact_forces)

    def place(self, shift, height, roll, velocity=(0.0, 0.0, 0.0)):
        """State with the wheelset held there over a level track."""
        s = self.system.start.copy()
        s[state.VEHICLE_X + WHEELSET, 0] = (
            shift,
            height + self.system.constants[constant.WHEELSET_HEIGHT, 0],
            roll,
        )
        s[state.VEHICLE_V + WHEELSET, 0] = velocity
        self.find_contact_forces(s, self.system.constants, self.system.geometry)
        return s

    def patch(self, shift, roll, side, zone):
        """G, dG/dY, dG/dpsi ... in the axes of a right-hand wheel."""
        s = self.place(shift, -1.0, roll)  # well clear
        q, geometry = self.system.constants, self.system.geometry
        return contact.patch_by_table(s, q, geometry, SIDES[side], ZONES[zone], 0)

    def searched(self, shift, roll, zone):
        """The same for a right-hand wheel by the grid method."""
        g = self.system.geometry
        first, last = (g.flange_points, len(g.wheel_y)) if zone == "tread" else (0, g.flange_points)
        return zone_contact(shift, roll, first, last, g)

    def shift(self, displacement, roll, side="right"):
        """Of the wheelset whose wheel of that side stands so on its rail."""
        sign = 1.0 if side == "right" else -1.0
        point = running_point(math.sin(sign * roll), math.cos(roll), self.circle)
        return sign * (displacement - point.reach + self.circle.half_spacing)

    def displacement(self, shift, roll, side):
        """Of a side's wheel on its rail."""
        sign = 1.0 if side == "right" else -1.0
        point = running_point(math.sin(sign * roll), math.cos(roll), self.circle)
        return sign * shift + point.reach - self.circle.half_spacing

    def is_between_nodes(self, shift, roll):
        """Whether all are well inside a cell: on its edge the slope has two values (see below)."""
        displaced = [self.displacement(shift, roll, side) for side in SIDES]
        return abs(math.remainder(roll, 5e-4)) > 1e-6 and all(
            abs(math.remainder(u, 1e-4 if abs(u) < 0.016 else 1e-3)) > 1e-6 for u in displaced
        )


def bench_of(wheelrail):
    still = GroundMotion("still", 0.01, np.zeros(3))
    return Bench(rq.assemble(rq.scenario(wheelrail=wheelrail, support="at-grade", motion=still)))


@pytest.fixture(scope="module")
def bench():
    return bench_of("bart")


shifts = st.floats(-0.02, 0.02)
rolls = st.floats(-0.04, 0.04)


@settings(deadline=None, max_examples=60)
@given(
    shift=shifts, roll=rolls, side=st.sampled_from(list(SIDES)), zone=st.sampled_from(list(ZONES))
)
def test_force_follows_the_gradient_of_the_very_gap(bench, shift, roll, side, zone):
    assume(bench.is_between_nodes(shift, roll))
    h = 1e-7
    _, slope, gap_psi, *_ = bench.patch(shift, roll, side, zone)
    sign = 1.0 if side == "right" else -1.0
    by_shift, by_roll = (
        sign
        * (bench.patch(shift + dy, roll + dp, side, zone)[0]
           - bench.patch(shift - dy, roll - dp, side, zone)[0]) / (2.0 * h)
        for dy, dp in ((h, 0.0), (0.0, h))
    )  # fmt: skip
    # the differences' own error, largest where the flange falls off the rail's steep face
    error = 1e-5 * (1.0 + abs(slope) + abs(gap_psi))
    assert slope == pytest.approx(by_shift, abs=error)
    assert gap_psi == pytest.approx(by_roll, abs=error)


@pytest.mark.parametrize("zone", list(ZONES))
def test_table_holds_the_grids_numbers_at_its_nodes(bench, zone):
    for u in axis_nodes(DISPLACEMENT_AXIS)[[3, 200, 256, 300, 345]]:
        for roll in axis_nodes(ROLL_AXIS)[[5, 180, 214, 240]]:
            shift = bench.shift(u, roll)
            found = bench.patch(shift, roll, "right", zone)
            assert found == pytest.approx(bench.searched(shift, roll, zone), rel=1e-6, abs=1e-9)


def test_table_errs_by_less_than_a_micrometre_where_wheels_run(bench):
    """Between the nodes, where a patch touches or nearly does (a load makes 70 micrometres)."""
    drawn = np.random.default_rng(7)
    checked = 0
    for shift, roll in zip(
        drawn.uniform(-8.5e-3, 8.5e-3, 400), drawn.uniform(-0.004, 0.004, 400), strict=True
    ):
        exact = {zone: bench.searched(shift, roll, zone)[0] for zone in ZONES}
        for zone in ZONES:
            if exact[zone] < min(exact.values()) + 0.2e-3:
                found = bench.patch(shift, roll, "right", zone)[0]
                assert found == pytest.approx(exact[zone], abs=1e-6), (zone, shift, roll)
                checked += 1
    assert checked > 400


@pytest.mark.parametrize("wheelrail", ["bart", "s1002-60e1"])
def test_table_is_near_the_grid_however_far_the_other_wheel_has_lifted(wheelrail):
    """The bearing wheel at any roll up to 30 degrees, anywhere on its rail, flange on top too.

    Away from where the contact jumps, as from the throat to the flange: there the nodes of a cell
    are on both sides of the jump.
    """
    bench = bench_of(wheelrail)
    drawn = np.random.default_rng(11)
    errors = []
    for u, roll in zip(
        drawn.uniform(-0.07, 0.07, 1500), drawn.uniform(0.0, math.radians(30.0), 1500), strict=True
    ):
        shift = bench.shift(u, roll)
        near = {(dy, zone): bench.searched(shift + dy, roll, zone)
                for dy in (-1e-4, 0.0, 1e-4) for zone in ZONES}  # fmt: skip
        zone = min(ZONES, key=lambda zone: near[0.0, zone][0])
        places = [near[dy, zone][3] for dy in (-1e-4, 0.0, 1e-4)]  # height on the rail
        slopes = [math.atan(near[dy, zone][1]) for dy in (-1e-4, 0.0, 1e-4)]
        if max(slopes) - min(slopes) > 0.05 or max(places) - min(places) > 5e-4:
            continue
        exact, found = near[0.0, zone], bench.patch(shift, roll, "right", zone)
        errors.append((
            1e6 * (found[0] - exact[0]),
            math.degrees(math.atan(found[1]) - math.atan(exact[1])),
            100.0 * (found[4] / exact[4] - 1.0),
        ))  # fmt: skip
    assert len(errors) > 1400
    gap, angle, stiffness = np.sqrt(np.mean(np.square(errors), axis=0))
    assert gap < 2.0  # micrometres
    assert angle < 0.2  # degrees
    assert stiffness < 3.0  # per cent


@pytest.mark.parametrize(("zone", "turn"), [("tread", 1e-5), ("flange", 0.02)])
def test_gap_has_no_step_from_cell_to_cell_and_the_force_turns_little(bench, zone, turn):
    """The gap's cubic is smooth along each axis; its cross derivative is only interpolated.

    So on a cell's edge the force's direction steps: on the flange's flank by up to 12 mrad.  No
    step of the gap itself, so no energy comes of it.
    """
    checked = 0
    for u in 1e-4 * np.arange(-85, 96, 5):
        for roll in 5e-4 * np.arange(-8.0, 8.5, 1.5):
            shift = bench.shift(u, roll)
            low = min(bench.patch(shift, roll, "right", z)[0] for z in ZONES)
            for dy, dp in ((1e-9, 0.0), (0.0, 1e-9)):
                ahead = bench.patch(shift + dy, roll + dp, "right", zone)
                behind = bench.patch(shift - dy, roll - dp, "right", zone)
                if ahead[0] > low + 0.2e-3:
                    continue  # not where it bears
                checked += 1
                moved = 2.0 * (dy * ahead[1] + dp * ahead[2])
                assert ahead[0] - behind[0] == pytest.approx(moved, abs=1e-10)
                assert abs(math.atan(ahead[1]) - math.atan(behind[1])) < turn
                # at a constant displacement of the wheel; dG/dpsi steps with the slope
                drop = running_point(math.sin(roll), math.cos(roll), bench.circle).drop
                by_roll = [side[2] + drop * side[1] for side in (ahead, behind)]
                assert by_roll[0] == pytest.approx(by_roll[1], abs=1e-5)
    assert checked > 50


@settings(deadline=None, max_examples=40)
@given(
    shift=st.floats(-9e-3, 9e-3),
    sunk=st.floats(0.0, 2e-4),
    roll=st.floats(-4e-3, 4e-3),
    velocity=st.tuples(*[st.floats(-0.2, 0.2)] * 3),
)
def test_left_is_the_mirror_image_of_right(bench, shift, sunk, roll, velocity):
    assume(bench.is_between_nodes(shift, roll))
    low = min(bench.patch(shift, roll, side, zone)[0] for side in SIDES for zone in ZONES)
    here = bench.place(shift, low + sunk, roll, velocity)[:, 0]
    mirrored = (-velocity[0], velocity[1], -velocity[2])
    there = bench.place(-shift, low + sunk, -roll, mirrored)[:, 0]
    size = 1e-6 * max(abs(here[state.FORCE_Z]), abs(here[state.FORCE_Y]), 1.0)
    for mine, other, sign in (
        (state.FORCE_Y, state.FORCE_Y, -1.0),
        (state.FORCE_Z, state.FORCE_Z, 1.0),
        (state.FORCE_PSI, state.FORCE_PSI, -1.0),
        (state.LOAD_LEFT, state.LOAD_RIGHT, 1.0),
        (state.LATERAL_LEFT, state.LATERAL_RIGHT, -1.0),
        (state.CREEP_POWER, state.CREEP_POWER, 1.0),
        (state.SPIN_POWER, state.SPIN_POWER, 1.0),
        (state.FORWARD_POWER, state.FORWARD_POWER, 1.0),
        (state.AXLE_MOMENT, state.AXLE_MOMENT, 1.0),
    ):
        assert here[mine] == pytest.approx(sign * there[other], abs=size)


def test_level_wheelset_bears_on_two_wheels_lifted_on_one_high_up_on_none(bench):
    """The three regimes of the paper come out by themselves."""
    rest = bench.system.start[:, 0]
    height = rest[state.HEIGHT]
    both = bench.place(0.0, height, 0.0)[:, 0]
    assert both[state.LOAD_LEFT] == pytest.approx(bench.system.static_wheel_load, rel=1e-6)
    assert both[state.LOAD_RIGHT] == pytest.approx(bench.system.static_wheel_load, rel=1e-6)
    half = 0.8721  # m, half the distance of the rails' crowns
    one = bench.place(0.0, height - half * math.sin(5e-3), 5e-3)[:, 0]  # right side down
    assert one[state.LOAD_LEFT] == 0.0
    assert one[state.LOAD_RIGHT] > 0.0
    assert one[state.FORCE_PSI] < 0.0  # the right rail turns it back
    none = bench.place(0.0, height - 1e-3, 0.0)[:, 0]
    assert none[state.LOAD_LEFT] == none[state.LOAD_RIGHT] == none[state.FORCE_Y] == 0.0


@pytest.mark.parametrize("side", list(SIDES))
@pytest.mark.parametrize("zone", list(ZONES))
def test_grid_search_in_the_tables_place_gives_the_same_patch(bench, side, zone):
    s = bench.place(0.0031, -0.391, -0.0012)
    geometry, q = bench.system.geometry, bench.system.constants
    table = contact.patch_by_table(s, q, geometry, SIDES[side], ZONES[zone], 0)
    grid = contact.patch_by_grid(s, q, geometry, SIDES[side], ZONES[zone], 0)
    assert grid[0] == pytest.approx(table[0], abs=2e-6)
    assert grid[1:] == pytest.approx(table[1:], rel=0.02, abs=2e-3)
