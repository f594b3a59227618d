"""Forces of one patch: what they do to the wheel is what is stored, lost, crept and spun."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.march.compiler import PYTHON, bind
from railquake.march.contact import add_patch, add_wheels
from railquake.march.rows import constant, size, state
from railquake.march.slots import chosen
from railquake.physics import patch
from railquake.physics.patch import Contact, WheelMotion
from railquake.physics.profiles import Patch

K, ALONG, CREEP, SPIN = 9e10, 7e10, 6e10, 1.6e11  # of the order of the presets'
LAWS = chosen(
    {"creep law": "she", "flange creep law": "carter", "restitution law": "hunt-crossley"}
)
NO_TABLE = np.zeros(1)
GEOMETRY = SimpleNamespace(tread_law=NO_TABLE, flange_law=NO_TABLE)
bound_forces = bind(patch.patch_forces, PYTHON, LAWS).call
bear = bind(add_patch, PYTHON, LAWS).call
CLOSED, OPEN = st.floats(1e-7, 3e-4), st.floats(-1e-2, 0.0)  # penetration, m


@st.composite
def patches(draw, penetration=CLOSED):
    """What `patch_forces` is given: a touching wheel in any motion."""
    psi = draw(st.floats(-0.1, 0.1))
    return {
        "penetration": draw(penetration),
        "slope": draw(st.floats(-2.5, 2.5)),
        "gap_psi": draw(st.floats(-1.0, 1.0)),
        "arm_z": draw(st.floats(0.2, 0.5)),
        "stiffness": K,
        "creep": CREEP,
        "spin": SPIN,
        "shift_v": draw(st.floats(-0.5, 0.5)),
        "height_v": draw(st.floats(-0.5, 0.5)),
        "roll_v": draw(st.floats(-0.5, 0.5)),
        "roll_sin": math.sin(psi),
        "roll_cos": math.cos(psi),
        "hysteresis": draw(st.sampled_from([0.0, 0.3, 4.5])),
        "alpha_r": draw(st.sampled_from([0.0, 0.45, 1.5])),
        "onset_bound": 0.1,
        "friction": draw(st.sampled_from([0.0, 0.3])),
        "speed": draw(st.sampled_from([0.0, 0.3, 22.0])),
        "axle_rate": draw(st.floats(-5.0, 60.0)),
        "zone": draw(st.sampled_from([0, 1])),
    }


def patch_forces(
    penetration, slope, gap_psi, arm_z, stiffness, creep, spin, shift_v, height_v, roll_v,
    roll_sin, roll_cos, hysteresis, alpha_r, onset_bound, friction, speed, axle_rate, zone=0,
):  # fmt: skip
    """The forces, with the wheelset's centre at the height of the track's origin.

    The bound of the speed in the creepages is 1 m/s.
    """
    return bound_forces(
        penetration,
        Patch(0.0 - penetration, slope, gap_psi, arm_z, stiffness, ALONG, creep, spin, 0.0),
        WheelMotion(0.0, shift_v, height_v, roll_v, roll_sin, roll_cos, axle_rate),
        hysteresis,
        Contact(alpha_r, onset_bound, friction, 1.0 / max(speed, 1.0), speed),
        zone,
        NO_TABLE,
    )


@given(patches())
def test_power_on_the_wheel_is_stored_lost_crept_and_spun(p):
    _, q_y, q_z, q_psi, stored, lost, crept, spun, forward, *_ = patch_forces(**p)
    power = q_y * p["shift_v"] + q_z * p["height_v"] + q_psi * p["roll_v"]
    cosine = 1.0 / math.hypot(1.0, p["slope"])
    delta = p["penetration"] * cosine
    # stored = 2/5 K delta^2.5 grows by 5/2 stored / delta times the approach's rate
    rate = cosine * (p["height_v"] - p["slope"] * p["shift_v"] - p["gap_psi"] * p["roll_v"])
    storing = 2.5 * stored / delta * rate
    assert stored == pytest.approx(0.4 * K * delta**2.5)
    size = abs(storing) + lost + crept + abs(spun) + forward + abs(q_psi * p["roll_v"])
    assert power == pytest.approx(-storing - lost - crept + spun + forward, abs=1e-9 * size + 1e-12)


@given(patches())
def test_impact_and_creep_never_give_energy(p):
    *_, lost, crept, _, forward, _, _ = patch_forces(**p)
    assert lost >= 0.0
    assert crept >= forward >= 0.0


@given(patches())
def test_force_acts_at_the_contact_point_and_friction_bounds_it(p):
    _, q_y, q_z, q_psi, *_ = patch_forces(**p)
    sine, cosine = (
        p["slope"] / math.hypot(1.0, p["slope"]),
        1.0 / math.hypot(1.0, p["slope"]),
    )
    normal = sine * q_y - cosine * q_z  # out of the rail, z being down
    tangential = cosine * q_y + sine * q_z
    assert normal >= -1e-9 * (abs(q_y) + abs(q_z)) - 1e-12
    assert abs(tangential) <= p["friction"] * normal + 1e-9 * (abs(q_y) + abs(q_z)) + 1e-12
    arm_y = -p["gap_psi"] - p["slope"] * p["arm_z"]  # from dG/dpsi = -(arm_y + tan(gamma) arm_z)
    size = (abs(arm_y) + p["arm_z"]) * (abs(q_y) + abs(q_z))
    assert q_psi == pytest.approx(arm_y * q_z - p["arm_z"] * q_y, abs=1e-9 * size + 1e-12)


@given(patches(OPEN))
def test_an_open_patch_bears_nothing_and_forgets(p):
    assert patch_forces(**p) == pytest.approx((0.0,) * 11)


def test_friction_opposes_the_sliding_and_spin_climbs_the_flange():
    still = {
        "penetration": 5e-5, "slope": 0.0, "gap_psi": -0.8, "arm_z": 0.4, "stiffness": K,
        "creep": CREEP, "spin": SPIN, "shift_v": 0.0, "height_v": 0.0, "roll_v": 0.0,
        "roll_sin": 0.0, "roll_cos": 1.0, "hysteresis": 4.5, "alpha_r": 0.45,
        "onset_bound": 0.1, "friction": 0.3, "speed": 22.0, "axle_rate": 55.0,
    }  # fmt: skip
    assert patch_forces(**still)[1] == 0.0
    assert patch_forces(**{**still, "shift_v": 0.01})[1] < 0.0
    # on a right-hand flange the rail rises outwards (slope < 0); omega = -V/r about y gives the
    # spin sin(gamma)/r about the normal into the rail, and Kalker's force has its negative sign
    flange = patch_forces(**{**still, "slope": -1.0, "gap_psi": -0.4})
    tangential = (flange[1] - flange[2]) / math.sqrt(2.0)
    assert tangential > 0.0


@pytest.mark.parametrize("side", [0, 1])
def test_patches_of_a_wheel_add_up_for_all_axles_in_the_tracks_axes(side):
    """Tread and flange at once: forces mirrored on the left, loads and powers summed."""
    s = np.zeros((size.STATE_ROWS, 1))
    q = np.zeros((size.CONSTANT_ROWS, 1))
    s[[state.HEIGHT, state.SHIFT_V, state.HEIGHT_V, state.ROLL_V], 0] = (-0.39, 0.02, 0.03, -0.04)
    psi = 0.01
    s[[state.ROLL_SIN, state.ROLL_COS], 0] = math.sin(psi), math.cos(psi)
    s[[state.ON_TRACK, state.TRACK_COS, state.NEAR, state.NEAR + 1]] = 1.0
    q[constant.AXLES], q[constant.FRICTION], q[constant.INVERSE_SPEED] = 4.0, 0.3, 1.0 / 22.0
    q[constant.SPEED], s[state.AXLE_RATE] = 22.0, 56.0
    q[constant.ALPHA_R], q[constant.ONSET_BOUND] = 0.45, 0.1
    sign = 1.0 if side == 1 else -1.0
    expected, about_axle = np.zeros(8), np.zeros(2)
    for zone, (slope, gap_psi, sunk) in enumerate(((0.01, -0.87, 6e-5), (-0.9, -0.5, 4e-5))):
        gap, rail_z = -0.39 - sunk, 0.001 + 0.004 * zone
        bear(
            s,
            q,
            GEOMETRY,
            side,
            zone,
            Patch(gap, slope, gap_psi, rail_z, K, ALONG, CREEP, SPIN, 0.0),
            0,
        )
        one = patch_forces(
            sunk, slope, gap_psi, rail_z + 0.39, K, CREEP, SPIN, sign * 0.02, 0.03, sign * -0.04,
            sign * math.sin(psi), math.cos(psi), 0.0, 0.45, 0.1, 0.3, 22.0, 56.0, zone,
        )  # fmt: skip
        _, y, z, turning, *powers = one[:9]
        about_axle += one[9:]
        expected += 4.0 * np.array([sign * y, z, sign * turning, *powers])
        number = 2 * side + zone
        assert s[state.PATCH_PENETRATION + number, 0] == pytest.approx(sunk)
        assert s[state.PATCH_HYSTERESIS + number, 0] == one[0] > 0.0
    add_wheels(s, q, 0)
    assert s[state.FORCE_Y : state.FORWARD_POWER + 1, 0] == pytest.approx(expected, rel=1e-9)
    assert s[[state.AXLE_MOMENT, state.AXLE_DAMPING], 0] == pytest.approx(about_axle)  # of one
    assert s[state.LOAD_LEFT + side, 0] == pytest.approx(-expected[1])
    assert s[state.LATERAL_LEFT + side, 0] == pytest.approx(-expected[0])
    assert s[state.LOAD_RIGHT - side, 0] == s[state.LATERAL_RIGHT - side, 0] == 0.0
    s[state.ON_TRACK] = 0.0  # a train that has left presses no more
    bear(s, q, GEOMETRY, side, 0, Patch(-0.3901, 0.01, -0.87, 0.001, K, ALONG, CREEP, SPIN, 0.0), 0)
    add_wheels(s, q, 0)
    assert not s[state.FORCE_Y : state.FORWARD_POWER + 1].any()


@given(patches())
def test_without_a_limit_the_tangential_force_is_kalkers(p):
    """F_y = -f22 v/V - f23 sin(gamma - psi) w/V, F_x = -f11 (V - w r)/V."""
    p = {**p, "friction": 1e13, "hysteresis": 0.01}
    _, q_y, q_z, *_, moment, damping = patch_forces(**p)
    angle = math.atan(p["slope"])
    psi = math.atan2(p["roll_sin"], p["roll_cos"])
    delta = p["penetration"] * math.cos(angle)
    arm_y = -p["gap_psi"] - p["slope"] * p["arm_z"]
    sideways = p["shift_v"] - p["roll_v"] * p["arm_z"]
    downwards = p["height_v"] + p["roll_v"] * arm_y
    sliding = sideways * math.cos(angle) + downwards * math.sin(angle)
    inverse_speed = 1.0 / max(p["speed"], 1.0)
    expected = -CREEP * delta * sliding * inverse_speed
    expected -= SPIN * delta**1.5 * math.sin(angle - psi) * p["axle_rate"] * inverse_speed
    found = q_y * math.cos(angle) + q_z * math.sin(angle)
    assert found == pytest.approx(expected, rel=1e-5, abs=1e-3 + 1e-9 * (abs(q_y) + abs(q_z)))
    # the axle's line and the contact point, by vectors
    along_axle = arm_y * math.cos(psi) + p["arm_z"] * math.sin(psi)
    across = np.array([arm_y, p["arm_z"]]) - along_axle * np.array([math.cos(psi), math.sin(psi)])
    radius = math.copysign(np.linalg.norm(across), across[1])
    f11 = ALONG * delta * inverse_speed
    assert damping == pytest.approx(f11 * radius**2, rel=1e-5)
    slip = p["speed"] - p["axle_rate"] * radius
    assert moment == pytest.approx(radius * f11 * slip, rel=1e-5, abs=1e-3)


def test_a_standing_train_has_neither_spin_nor_longitudinal_creepage():
    standing = {
        "penetration": 5e-5, "slope": -1.0, "gap_psi": -0.4, "arm_z": 0.4, "stiffness": K,
        "creep": CREEP, "spin": SPIN, "shift_v": 0.0, "height_v": 0.0, "roll_v": 0.0,
        "roll_sin": 0.0, "roll_cos": 1.0, "hysteresis": 4.5, "alpha_r": 0.45,
        "onset_bound": 0.1, "friction": 0.3, "speed": 0.0, "axle_rate": 0.0,
    }  # fmt: skip
    _, q_y, q_z, *_, moment, _ = patch_forces(**standing)
    assert q_y == pytest.approx(q_z)  # nothing but the normal force, at 45 degrees
    assert moment == 0.0
    # fading below the bound of 1 m/s: a tenth of the speed, a tenth of both
    slow, slower = (
        patch_forces(**{**standing, "friction": 1e9, "speed": v, "axle_rate": v / 0.3})
        for v in (0.1, 0.01)
    )
    assert slow[1] - q_y == pytest.approx(10.0 * (slower[1] - q_y), rel=1e-6)
    assert slow[9] == pytest.approx(10.0 * slower[9], rel=1e-6)
