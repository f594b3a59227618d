"""Hertz' stiffness, the normal law and what an impact loses."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.inputs.wheelrail import WheelRail
from railquake.physics.hertz import (
    effective_modulus,
    hertz_coefficients,
    hertz_lookup,
    hertz_table,
)
from railquake.physics.impact import RESTITUTION_LAWS, frozen_at_onset, normal_force
from railquake.probe import standing_contact

STEEL = (209.92e9, 0.28)  # CONTACT's steel
PRINTED = RESTITUTION_LAWS["hunt-crossley"].coefficient
CALIBRATED = RESTITUTION_LAWS["calibrated"].coefficient


def test_hertz_of_a_wheel_on_a_rail_crown():
    """physics.md, section 2, Eq. 6: 50 kN, radii 460 and 300 mm."""
    rolling, lateral = 0.5 / 0.460, 0.5 / 0.300
    table = hertz_table(*STEEL)
    k, _, _, _, log_ratio = hertz_lookup(
        lateral, rolling, table.stiffness, table.area, table.along, table.creep, table.spin,
        np.log(table.a_over_b),
    )  # fmt: skip
    assert k == pytest.approx(9.290e10, rel=1e-3)
    assert log_ratio == pytest.approx(math.log(5.709 / 4.294), rel=1e-3)
    assert (50e3 / k) ** (2.0 / 3.0) == pytest.approx(0.06616e-3, rel=1e-3)
    theta = np.array([math.acos((rolling - lateral) / (rolling + lateral))])
    m, n, _ = hertz_coefficients(theta)
    size = (3.0 * 50e3 / (4.0 * effective_modulus(*STEEL) * (rolling + lateral))) ** (1.0 / 3.0)
    assert m[0] * size == pytest.approx(5.709e-3, rel=1e-3)
    assert n[0] * size == pytest.approx(4.294e-3, rel=1e-3)


def test_equal_curvatures_give_a_circle():
    m, n, r = hertz_coefficients(np.array([0.5 * math.pi]))
    assert (m[0], n[0], r[0]) == pytest.approx((1.0, 1.0, 1.0), rel=1e-6)


@pytest.mark.parametrize("load", [5e3, 20e3, 50e3, 100e3, 150e3])
def test_normal_law_of_s1002_on_60e1_at_rest(load):
    """physics.md, section 9: N/delta^1.5 = 1.5e11 within 10 % at y = 0 with CONTACT's steel."""
    pair = WheelRail.from_preset(
        "s1002-60e1", {"youngs_modulus": STEEL[0], "poisson_ratio": STEEL[1]}
    )
    patches = standing_contact(pair, 0.0, load)
    assert [patch.side for patch in patches] == ["left", "right"]
    for patch in patches:
        assert patch.normal_n / patch.approach_m**1.5 == pytest.approx(1.5e11, rel=0.1)


def rebound(alpha, mass=1000.0, stiffness=1e11, speed=0.5):
    """Speed ratio of a mass that falls on the contact, velocity Verlet."""
    dt = 2e-7
    delta, rate, hysteresis = 0.0, speed, 0.0
    force = 0.0
    while True:
        half = rate - 0.5 * dt * force / mass
        delta += dt * half
        if delta <= 0.0:
            return -half / speed
        hysteresis = frozen_at_onset(True, hysteresis, half, alpha, 0.1)
        force, _ = normal_force(delta, half, stiffness, hysteresis)
        rate = half - 0.5 * dt * force / mass


@pytest.mark.parametrize(
    ("restitution", "actual"), [(0.9, 0.909), (0.6, 0.712), (0.3, 0.581), (0.0, 0.488)]
)
def test_printed_law_rebounds_higher_than_its_coefficient(restitution, actual):
    """physics.md, section 2, Eq. 7: rebounds of a free impact."""
    assert rebound(PRINTED(restitution)) == pytest.approx(actual, rel=0.01)


@pytest.mark.parametrize(("restitution", "alpha"), [(0.9, 0.167), (0.6, 0.975), (0.3, 3.09)])
def test_calibrated_law_rebounds_at_its_coefficient(restitution, alpha):
    """physics.md, section 2, Eq. 7."""
    assert CALIBRATED(restitution) == pytest.approx(alpha, rel=5e-3)
    assert rebound(CALIBRATED(restitution)) == pytest.approx(restitution, rel=0.01)


@given(delta=st.floats(0.0, 1e-3), rate=st.floats(-5.0, 5.0), hysteresis=st.floats(0.0, 10.0))
def test_normal_force_never_pulls(delta, rate, hysteresis):
    normal, elastic = normal_force(delta, rate, 1e11, hysteresis)
    assert normal >= 0.0
    assert elastic >= 0.0
    assert (normal - elastic) * rate >= 0.0  # its hysteresis never gives energy


def test_hysteresis_is_frozen_at_the_onset_and_forgotten_when_contact_is_lost():
    first = frozen_at_onset(True, 0.0, 0.5, 0.45, 0.1)
    assert first == pytest.approx(0.9)
    assert frozen_at_onset(True, first, 0.01, 0.45, 0.1) == first
    assert frozen_at_onset(False, first, 0.01, 0.45, 0.1) == 0.0
    assert frozen_at_onset(True, 0.0, 0.001, 0.45, 0.1) == pytest.approx(4.5)  # bounded below
