"""What a frame notices: each event by itself, when it began, and what it ends."""

import math

import numpy as np
import pytest

import railquake as rq
from railquake.inputs.ground_motion import GroundMotion
from railquake.march import sprung
from railquake.march.events import detect_events
from railquake.march.events import release_train as release
from railquake.march.order import kernel_order
from railquake.march.rows import constant, state
from railquake.physics.derailment import (
    BEYOND_BODY,
    BEYOND_STOP,
    CLIMB,
    FLANGE_CONTACT,
    ONSET,
    OVERTURNED,
    SLIDE_OFF,
    UPLIFT,
)
from stages import stage

NAMES = (
    "flange contact", "uplift", "onset", "flange over", "slide-off", "climb", "overturned",
)  # fmt: skip
STILL = GroundMotion("still", 0.01, np.zeros(3))
PATCHES = slice(state.PATCH_HYSTERESIS, state.FORCE_Y)
FORCES = slice(state.FORCE_Y, state.WHEELSET_FREE)  # on wheelset, track and pier


@pytest.fixture(scope="module")
def system():
    return rq.assemble(rq.scenario(support="at-grade", motion=STILL))


def placed(system, shift=0.0, rise=0.0, roll=0.0, **rows):
    """State of a wheelset that stands there, both treads bearing unless said otherwise."""
    s = system.start.copy()
    s[state.SHIFT], s[state.ROLL] = shift, roll
    s[state.HEIGHT] -= rise
    s[state.ROLL_SIN], s[state.ROLL_COS] = math.sin(roll), math.cos(roll)
    for patch, depth in enumerate((1e-4, -1e-3, 1e-4, -1e-3)):
        s[state.PATCH_PENETRATION + patch] = depth
    s[state.TIME] = 2.5
    for name, value in rows.items():
        s[getattr(state, name)] = value
    return s


def lift(s, *patches):
    for patch in patches:
        s[state.PATCH_PENETRATION + patch] = -1e-4


def holding(system, s):
    detect_events(s, system.constants, 0)
    flags = int(s[state.FLAGS, 0])
    return [name for k, name in enumerate(NAMES) if flags >> k & 1]


def test_nothing_happens_to_a_train_at_rest(system):
    s = placed(system)
    assert holding(system, s) == []
    assert s[state.LEAVING, 0] == s[state.DIVERGED, 0] == s[state.UPLIFTS, 0] == 0.0
    assert np.all(s[state.FIRST_TIME : state.FIRST_TIME + len(NAMES)] == -1.0)
    assert s[state.DERAILED_TIME, 0] == s[state.BEYOND_TIME, 0] == -1.0


@pytest.mark.parametrize("patch", [1, 3])
def test_flange_contact(system, patch):
    s = placed(system)
    s[state.PATCH_PENETRATION + patch] = 1e-6
    assert holding(system, s) == ["flange contact"]
    assert s[state.FIRST_TIME + FLANGE_CONTACT, 0] == 2.5


@pytest.mark.parametrize("patch", [0, 2])
def test_uplift_of_one_side(system, patch):
    s = placed(system)
    lift(s, patch)
    assert holding(system, s) == ["uplift"]
    assert s[state.FIRST_TIME + UPLIFT, 0] == 2.5
    assert s[state.LEAVING, 0] == 0.0


def lifted_and_landed(system, *frames):
    """State after frames, (time, whether a wheel is up)."""
    s = placed(system)
    for time, up in frames:
        now = placed(system)
        if up:
            lift(now, 0)
        s[PATCHES], s[state.TIME] = now[PATCHES], time
        detect_events(s, system.constants, 0)
    return s


def test_uplifts_are_counted_and_their_end_noted(system):
    s = lifted_and_landed(
        system, (1.0, True), (2.0, True), (3.0, False), (4.0, True), (5.0, False), (6.0, False)
    )
    assert s[state.UPLIFTS, 0] == 2.0
    assert s[state.UPLIFT_END, 0] == 5.0
    assert s[state.FIRST_TIME + UPLIFT, 0] == 1.0


def test_a_wheel_that_lifts_again_at_once_has_not_come_back(system):
    """Within 50 ms: an impact that bounces, not a second uplift."""
    s = lifted_and_landed(
        system, (1.0, True), (1.2, False), (1.24, True), (1.3, False), (1.36, True)
    )
    assert s[state.UPLIFTS, 0] == 2.0


def tip(system):
    q = system.constants[:, 0]
    return q[constant.TIP_Y], q[constant.TIP_Z]


def rocked(system, side, roll, over=2e-3, **rows):
    """State with that side's wheels lifted by a roll, the tip of their flange over the crown.

    The roll turns about the wheelset's centre; the tip's height by a rotation of the plane.
    """
    y, z = tip(system)
    s = placed(system, roll=-side * roll, **rows)
    s[state.HEIGHT] = -(z * math.cos(roll) - y * math.sin(roll)) - over
    lift(s, 2 if side > 0.0 else 0)
    return s


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("over", [-1e-4, 1e-4])
def test_onset_is_a_lifted_flange_above_its_rails_crown(system, side, over):
    s = rocked(system, side, 0.01, over)
    found = holding(system, s)
    assert ("onset" in found) == ("flange over" in found) == (over > 0.0)
    assert s[state.PEAK_CLEARANCE, 0] == pytest.approx(over if over > 0.0 else -1e-4, abs=1e-12)
    if over > 0.0:
        assert s[state.FIRST_SIDE + ONSET, 0] == side
        assert s[state.FIRST_ROLL + ONSET, 0] == pytest.approx(-side * 0.01)


def test_a_loaded_flange_above_its_rail_is_no_onset(system):
    s = rocked(system, 1.0, 0.01)
    s[state.PATCH_PENETRATION + 3] = 1e-4
    assert holding(system, s) == ["flange contact", "flange over"]


def crossing(system, side, beyond, roll=0.02, over=2e-3):
    """That side's tip so far outside its rail's middle, the other side bearing."""
    y, z = tip(system)
    across = y * math.cos(roll) + z * math.sin(roll)
    middle = system.constants[constant.RAIL_CENTRE, 0]
    s = rocked(system, side, roll, over)
    s[state.SHIFT] = side * (middle + beyond - across)
    return s


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("beyond", [-1e-4, 1e-4])
def test_a_lifted_flange_that_crosses_its_rail_slides_off(system, side, beyond):
    s = crossing(system, side, beyond)
    assert ("slide-off" in holding(system, s)) == (beyond > 0.0)
    if beyond > 0.0:
        assert s[state.FIRST_SIDE + SLIDE_OFF, 0] == side
        assert s[state.DERAILED_TIME, 0] == 2.5
    # a tip beside the head has crossed nothing
    assert "slide-off" not in holding(system, crossing(system, side, 1e-3, over=-2e-3))


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_flange_that_came_over_under_load_climbs(system, side):
    """What counts is whether it bore as its tip passed the crown."""
    flange = state.PATCH_PENETRATION + (3 if side > 0.0 else 1)
    s = crossing(system, side, -0.02)
    s[flange] = 1e-4
    assert not {"slide-off", "climb"} & set(holding(system, s))
    s[flange] = -1e-4  # it hops on top of the rail
    s[state.SHIFT] = crossing(system, side, 1e-3)[state.SHIFT]
    assert "climb" in holding(system, s)
    assert s[state.FIRST_SIDE + CLIMB, 0] == side
    assert s[state.FIRST_TIME + SLIDE_OFF, 0] == -1.0
    # lifted over the crown, and landed on it later
    s = crossing(system, side, -0.02)
    holding(system, s)
    s[flange] = 1e-4
    s[state.SHIFT] = crossing(system, side, 1e-3)[state.SHIFT]
    assert "slide-off" in holding(system, s)


@pytest.mark.parametrize(("shift", "derails"), [(0.0699, False), (0.0701, True), (-0.0701, True)])
def test_slide_off_by_the_bearing_wheels_displacement(system, shift, derails):
    assert ("slide-off" in holding(system, placed(system, shift=shift))) == derails


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_wheelset_that_rocks_in_place_does_not_slide_off(system, side):
    """At 14 degrees its centre is 136 mm beside its place; the bearing wheel has not moved."""
    roll = math.radians(14.0)
    q = system.constants[:, 0]
    b, r0 = q[constant.HALF_SPACING], q[constant.NOMINAL_RADIUS]
    centre = side * (r0 * math.sin(roll) + b * (1.0 - math.cos(roll)))
    s = placed(system, shift=centre, roll=side * roll)
    s[state.HEIGHT] = -b * math.sin(roll) - r0 * math.cos(roll)
    lift(s, 0 if side > 0.0 else 2)
    assert abs(centre) > 0.12
    assert holding(system, s) == ["uplift", "onset", "flange over"]
    assert s[state.FIRST_DISPLACEMENT + UPLIFT, 0] == pytest.approx(0.0, abs=1e-12)
    assert s[state.FIRST_SIDE + UPLIFT, 0] == -side


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize(("degrees", "over"), [(29.9, False), (30.1, True)])
def test_overturned_by_a_roll_of_30_degrees_on_a_bearing_wheel(system, sign, degrees, over):
    s = placed(system, roll=sign * math.radians(degrees))
    lift(s, 0 if sign > 0.0 else 2)
    assert ("overturned" in holding(system, s)) == over
    if over:
        assert s[state.FIRST_SIDE + OVERTURNED, 0] == sign
    lift(s, 0, 2)
    assert "overturned" not in holding(system, s)  # in the air


def test_a_derailed_train_is_followed_for_half_a_second(system):
    """So that sliding off and overturning together are seen."""
    s = crossing(system, 1.0, 1e-3)
    holding(system, s)
    assert s[state.LEAVING, 0] == 0.0
    for time, leaves in ((2.99, 0.0), (3.0, 1.0)):
        s[state.TIME] = time
        holding(system, s)
        assert s[state.LEAVING, 0] == leaves
    assert s[state.LEFT_TIME, 0] == 3.0


@pytest.mark.parametrize("rows", [
    {"SHIFT": 0.6}, {"ROLL": math.radians(45.1)}, {"HEIGHT": -0.33}, {"FIRST_TIME": 2.4},
])  # fmt: skip
def test_a_train_is_followed_no_further(system, rows):
    """Far off its rails, beyond 45 degrees, fallen beside them, or once both have happened."""
    s = crossing(system, 1.0, 1e-3)
    holding(system, s)
    for name, value in rows.items():
        s[getattr(state, name) + (OVERTURNED if name == "FIRST_TIME" else 0)] = value
    holding(system, s)
    assert s[state.LEAVING, 0] == 1.0


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("beyond", [-0.01, 0.01])
def test_a_linear_cars_model_ends_where_its_centre_of_gravity_is_beyond_the_rail(
    system, side, beyond
):
    q = system.constants
    s = placed(system)
    s[state.TRACK_Y] = 0.3
    mass = system.vehicle.mass[0::3]
    # only the car moves: the whole car's centre by its share
    moved = side * (q[constant.RAIL_CENTRE, 0] + beyond)
    lateral = state.VEHICLE_X + np.argsort(kernel_order(9))[0::3]
    s[lateral, 0] = 0.3
    s[lateral[0], 0] += moved * mass.sum() / mass[0]
    assert holding(system, s) == []  # it is no derailment
    assert s[state.BEYOND_TIME, 0] == (2.5 if beyond > 0.0 else -1.0)
    assert s[state.BEYOND_REASON, 0] == (BEYOND_BODY if beyond > 0.0 else 0.0)
    s[state.TIME] = 3.5
    holding(system, s)
    assert s[state.BEYOND_TIME, 0] == (2.5 if beyond > 0.0 else -1.0)  # the first time is kept


def test_a_car_under_gravity_ends_where_a_stop_is_past_its_table():
    system = rq.assemble(
        rq.scenario(vehicle="bart-under-gravity", support="at-grade", motion=STILL)
    )
    rows, constants = system.layout.state, system.layout.constant
    detect = stage(system, detect_events)
    ends = system.constants[constants.STOP_END :, 0][: system.layout.size.STOPS]
    number = np.flatnonzero(np.isfinite(ends))[1]  # the lateral table of the second bogie
    assert ends[number] == pytest.approx(0.065)
    for travel, reason in ((0.0649, 0.0), (0.0651, BEYOND_STOP)):
        s = system.start.copy()
        s[rows.STOP_TRAVEL + number] = travel
        s[rows.VEHICLE_X] = 2.0  # gravity's moment is in its equations
        detect(s, system.constants, 0)
        assert s[rows.BEYOND_REASON, 0] == reason


@pytest.mark.parametrize(
    ("row", "value"),
    [
        ("U", 5.1),
        ("THETA2", -5.1),
        ("HEIGHT", 5.1),
        ("U", math.nan),
        ("U", -math.inf),
        ("SHIFT", math.nan),
        ("ROLL", math.nan),
        ("HEIGHT", math.nan),
    ],
)
def test_a_state_out_of_bounds_or_no_number_has_diverged(system, row, value):
    s = placed(system, **{row: value})
    detect_events(s, system.constants, 0)
    assert s[state.DIVERGED, 0] == 1.0
    calm = placed(system, U=4.9, THETA2=4.9)
    detect_events(calm, system.constants, 0)
    assert calm[state.DIVERGED, 0] == 0.0
    once = placed(system, DIVERGED=1.0)
    detect_events(once, system.constants, 0)
    assert once[state.DIVERGED, 0] == 1.0  # it does not recover


def test_a_train_that_has_left_gives_no_events(system):
    s = placed(system, shift=0.2, ON_TRACK=0.0)
    lift(s, 0, 2)
    before = s[state.PEAK_CLEARANCE, 0]
    assert holding(system, s) == []
    assert s[state.LEAVING, 0] == 0.0
    assert s[state.PEAK_CLEARANCE, 0] == before


def test_first_times_are_kept(system):
    s = placed(system)
    lift(s, 2)
    detect_events(s, system.constants, 0)
    s[state.TIME] = 3.5
    detect_events(s, system.constants, 0)
    assert s[state.FIRST_TIME + UPLIFT, 0] == 2.5


def moving(system):
    """A car in motion with springs stretched, about to leave."""
    drawn = np.random.default_rng(5)
    s = placed(system, shift=0.2, DASHPOT_POWER=5.0)
    s[state.VEHICLE_X : state.VEHICLE_X + 45, 0] = drawn.normal(size=45)
    s[FORCES] = 1.0
    s[state.HERTZ_ENERGY] = 7.0
    return s


def test_vehicle_energy_is_that_of_its_matrices(system):
    s = moving(system)
    order = kernel_order(9)
    x, v = np.empty(9), np.empty(9)
    x[order] = s[state.VEHICLE_X : state.VEHICLE_X + 9, 0]
    v[order] = s[state.VEHICLE_V : state.VEHICLE_V + 9, 0]
    matrices = system.vehicle
    expected = 0.5 * (x @ matrices.stiffness @ x + v @ (matrices.mass * v))
    assert stage(system, sprung.vehicle_energy)(s, system.constants, 0) == pytest.approx(expected)


def test_release_takes_the_train_out_with_its_energy_on_record(system):
    s = moving(system)
    energy = stage(system, sprung.vehicle_energy)(s, system.constants, 0)
    places = s[state.VEHICLE_X : state.VEHICLE_X + 9].copy()
    detect_events(s, system.constants, 0)
    assert s[state.LEAVING, 0] == 1.0
    stage(system, release)(s, system.constants, 0)
    assert s[state.VEHICLE_ENERGY, 0] == pytest.approx(energy)
    assert s[state.HERTZ_LEFT, 0] == 7.0
    assert s[state.ON_TRACK, 0] == 0.0
    assert np.all(s[state.VEHICLE_X : state.VEHICLE_X + 9] == places)  # it stays where it was
    assert not s[state.VEHICLE_V : state.VEHICLE_STEP].any()  # and moves no more
    assert s[state.DASHPOT_POWER, 0] == 0.0
    assert not s[FORCES].any()


def test_release_leaves_a_train_that_stays_as_it_is(system):
    s = moving(system)
    s[state.LEAVING] = 0.0
    before = s.copy()
    stage(system, release)(s, system.constants, 0)
    assert np.all(s == before)
