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
from railquake.physics.derailment import FLANGE_CONTACT, UPLIFT
from stages import stage

NAMES = ("flange contact", "uplift", "onset", "flange over", "derailed", "overturned")
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
    assert np.all(s[state.FIRST_TIME : state.FIRST_TIME + 6] == -1.0)


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


def test_uplifts_are_counted_and_their_end_noted(system):
    s = placed(system)
    for time, up in (
        (1.0, True),
        (2.0, True),
        (3.0, False),
        (4.0, True),
        (5.0, False),
        (6.0, False),
    ):
        now = placed(system)
        if up:
            lift(now, 0)
        s[PATCHES], s[state.TIME] = now[PATCHES], time
        detect_events(s, system.constants, 0)
    assert s[state.UPLIFTS, 0] == 2.0
    assert s[state.UPLIFT_END, 0] == 5.0
    assert s[state.FIRST_TIME + UPLIFT, 0] == 1.0


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_onset_at_the_reference_roll(system, sign):
    limit = system.constants[constant.REFERENCE_ROLL, 0]
    assert holding(system, placed(system, roll=sign * 0.999 * limit)) == []
    assert holding(system, placed(system, roll=sign * 1.001 * limit))[0] == "onset"


def tip(system):
    q = system.constants[:, 0]
    return q[constant.TIP_Y], q[constant.TIP_Z]


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("over", [-1e-4, 1e-4])
def test_flange_is_over_when_its_tip_is_above_the_crown(system, sign, over):
    """Turned about the wheelset's centre; the tip's height by a rotation of the plane."""
    y, z = tip(system)
    roll = 0.01
    # the lifted side is the left one for a positive roll (right side down)
    highest = -y * math.sin(roll) + z * math.cos(roll)
    s = placed(system, roll=sign * roll)
    s[state.HEIGHT] = -highest - over
    found = holding(system, s)
    assert ("flange over" in found) == (over > 0.0)
    expected = over if over > 0.0 else -1.0
    assert s[state.PEAK_CLEARANCE, 0] == pytest.approx(max(over, expected), abs=1e-12)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize("beyond", [-1e-4, 1e-4])
def test_derailed_when_the_tip_crosses_the_rails_middle_above_it(system, sign, beyond):
    y, z = tip(system)
    roll = 0.02
    middle = system.constants[constant.RAIL_CENTRE, 0]
    # right side up (negative roll), sliding to the right: the right tip crosses its rail
    across = y * math.cos(roll) + z * math.sin(roll)
    s = placed(system, shift=sign * (middle + beyond - across), roll=-sign * roll)
    s[state.HEIGHT] = -(z * math.cos(roll) - y * math.sin(roll)) - 2e-3
    assert ("derailed" in holding(system, s)) == (beyond > 0.0)
    assert s[state.LEAVING, 0] == (1.0 if beyond > 0.0 else 0.0)
    low = placed(system, shift=sign * (middle + 1e-3 - across), roll=-sign * roll)
    low[state.HEIGHT] = -(z * math.cos(roll) - y * math.sin(roll)) + 2e-3
    assert "derailed" not in holding(system, low)  # a tip beside the head has crossed nothing


@pytest.mark.parametrize(("shift", "derails"), [(0.1269, False), (0.1271, True), (-0.1271, True)])
def test_derailed_by_a_shift_of_127_mm(system, shift, derails):
    assert ("derailed" in holding(system, placed(system, shift=shift))) == derails


@pytest.mark.parametrize(("degrees", "over"), [(44.9, False), (45.1, True), (-45.1, True)])
def test_overturned_by_a_roll_of_45_degrees(system, degrees, over):
    s = placed(system, roll=math.radians(degrees))
    assert ("overturned" in holding(system, s)) == over


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize(("beyond", "rolled", "over"), [
    (0.01, 1.1, True), (-0.01, 1.1, False), (0.01, 0.9, False),
])  # fmt: skip
def test_overturned_when_the_centre_of_gravity_is_outside_the_lower_contact(
    system, side, beyond, rolled, over
):
    q = system.constants
    s = placed(system, roll=side * rolled * q[constant.REFERENCE_ROLL, 0])
    s[state.TRACK_Y] = 0.3
    mass = system.vehicle.mass[0::3]
    # only the car moves: the whole car's centre by its share
    moved = side * (q[constant.RAIL_CENTRE, 0] + beyond)
    lateral = state.VEHICLE_X + np.argsort(kernel_order(9))[0::3]
    s[lateral, 0] = 0.3
    s[lateral[0], 0] += moved * mass.sum() / mass[0]
    assert ("overturned" in holding(system, s)) == over


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
