"""Forces of one patch: what they do to the wheel is what is stored, lost, crept and spun."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.physics.march import patch_forces

K, CREEP, SPIN = 9e10, 6e10, 4e11  # of the order of the presets'
CLOSED, OPEN = st.floats(1e-7, 3e-4), st.floats(-1e-2, 0.0)  # penetration, m


@st.composite
def patches(draw, penetration=CLOSED):
    """Arguments of `patch_forces`: a touching wheel in any motion."""
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
        "inverse_speed": draw(st.sampled_from([1.0, 1.0 / 22.0])),
    }


@given(patches())
def test_power_on_the_wheel_is_stored_lost_crept_and_spun(p):
    _, q_y, q_z, q_psi, stored, lost, crept, spun = patch_forces(**p)
    power = q_y * p["shift_v"] + q_z * p["height_v"] + q_psi * p["roll_v"]
    cosine = 1.0 / math.hypot(1.0, p["slope"])
    delta = p["penetration"] * cosine
    # stored = 2/5 K delta^2.5 grows by 5/2 stored / delta times the approach's rate
    rate = cosine * (p["height_v"] - p["slope"] * p["shift_v"] - p["gap_psi"] * p["roll_v"])
    storing = 2.5 * stored / delta * rate
    assert stored == pytest.approx(0.4 * K * delta**2.5)
    size = abs(storing) + lost + crept + abs(spun) + abs(q_psi * p["roll_v"])
    assert power == pytest.approx(-storing - lost - crept + spun, abs=1e-9 * size + 1e-12)


@given(patches())
def test_impact_and_creep_never_give_energy(p):
    *_, lost, crept, _ = patch_forces(**p)
    assert lost >= 0.0
    assert crept >= 0.0


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
    assert patch_forces(**p) == pytest.approx((0.0,) * 8)


def test_friction_opposes_the_sliding_and_spin_climbs_the_flange():
    still = {
        "penetration": 5e-5, "slope": 0.0, "gap_psi": -0.8, "arm_z": 0.4, "stiffness": K,
        "creep": CREEP, "spin": SPIN, "shift_v": 0.0, "height_v": 0.0, "roll_v": 0.0,
        "roll_sin": 0.0, "roll_cos": 1.0, "hysteresis": 4.5, "alpha_r": 0.45,
        "onset_bound": 0.1, "friction": 0.3, "inverse_speed": 1.0 / 22.0,
    }  # fmt: skip
    assert patch_forces(**still)[1] == 0.0
    assert patch_forces(**{**still, "shift_v": 0.01})[1] < 0.0
    # on a right-hand flange the rail rises outwards (slope < 0); omega = -V/r about y gives the
    # spin sin(gamma)/r about the normal into the rail, and Kalker's force has its negative sign
    flange = patch_forces(**{**still, "slope": -1.0, "gap_psi": -0.4})
    tangential = (flange[1] - flange[2]) / math.sqrt(2.0)
    assert tangential > 0.0
