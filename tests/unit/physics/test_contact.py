"""Hertz' stiffness, the normal law and what an impact loses."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from railquake.inputs.wheelrail import WheelRail
from railquake.physics.hertz import (
    effective_modulus,
    hertz_coefficients,
    hertz_lookup,
    hertz_table,
)
from railquake.physics.impact import RESTITUTION_LAWS, frozen_at_onset, normal_force
from railquake.physics.impact.constant_hysteresis import REFERENCE_RATE
from railquake.probe import standing_contact

STEEL = (209.92e9, 0.28)  # CONTACT's steel
PRINTED = RESTITUTION_LAWS["hunt-crossley"].coefficient
CALIBRATED = RESTITUTION_LAWS["calibrated"].coefficient
CONSTANT = RESTITUTION_LAWS["constant-hysteresis"]


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


def rebound(alpha, mass=1000.0, stiffness=1e11, speed=0.5, law=frozen_at_onset):
    """Speed ratio of a mass that falls on the contact, velocity Verlet."""
    dt = 2e-7
    delta, rate, hysteresis = 0.0, speed, 0.0
    force = 0.0
    while True:
        half = rate - 0.5 * dt * force / mass
        delta += dt * half
        if delta <= 0.0:
            return -half / speed
        hysteresis = law(True, hysteresis, half, alpha, 0.1)
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


# --- a law without memory ------------------------------------------------------------------------


@pytest.mark.parametrize("restitution", [0.7, 0.0])
@pytest.mark.parametrize("speed", [0.05, 0.5, 1.0, 3.0])
def test_constant_hysteresis_rebounds_by_the_first_integral(restitution, speed):
    """With u = chi/K v: u - ln(1 + u) on the way in is -u - ln(1 - u) on the way out."""
    alpha = CONSTANT.coefficient(restitution)
    lost = alpha / REFERENCE_RATE
    u = lost * speed
    there = u - math.log(1.0 + u)
    back = brentq(lambda x: -x - math.log(1.0 - x) - there, 1e-9, 1.0 - 1e-9)
    found = rebound(alpha, speed=speed, law=CONSTANT.hysteresis)
    assert found == pytest.approx(back / u, rel=0.01)


def test_constant_hysteresis_loses_as_hunt_and_crossley_say():
    """Hunt and Crossley (1975): e = 1 - a v for a small rate v, and a = (1 - c_r)/v_r here.

    For steel, bronze and ivory they report a from 0.08 to 0.32 s/m.
    """
    alpha = CONSTANT.coefficient(0.7)
    a = 2.0 / 3.0 * CONSTANT.hysteresis(True, 0.0, 0.05, alpha, 0.1)
    assert a == pytest.approx(0.3)
    assert 0.08 < a < 0.32
    found = rebound(alpha, speed=0.05, law=CONSTANT.hysteresis)
    assert 1.0 - found == pytest.approx(0.05 * a, rel=0.03)


def test_at_the_reference_rate_a_free_impact_is_the_printed_laws():
    alpha = PRINTED(0.7)
    assert CONSTANT.coefficient(0.7) == alpha
    printed = rebound(alpha, speed=REFERENCE_RATE)
    assert rebound(alpha, speed=REFERENCE_RATE, law=CONSTANT.hysteresis) == pytest.approx(printed)


@given(held=st.floats(0.0, 50.0), rate=st.floats(-5.0, 5.0), bound=st.floats(1e-3, 1.0))
def test_constant_hysteresis_remembers_nothing(held, rate, bound):
    """A force of indentation and rate alone: of no onset, of no bound on its rate."""
    assert CONSTANT.hysteresis(True, held, rate, 0.45, bound) == 0.45 / REFERENCE_RATE
    assert CONSTANT.hysteresis(False, held, rate, 0.45, bound) == 0.0


@given(
    size=st.floats(1e-6, 1e-3),
    held=st.floats(0.0, 2e-3),
    frequency=st.floats(1.0, 1000.0),
    restitution=st.floats(0.0, 1.0),
)
def test_constant_hysteresis_gains_no_energy_in_any_cycle(size, held, frequency, restitution):
    """Work done on the contact in a cycle of indentation, lost and regained or held throughout."""
    t = np.linspace(0.0, 1.0, 401) / frequency
    delta = held + size * np.sin(2.0 * np.pi * frequency * t)
    rate = np.gradient(delta, t)
    alpha = CONSTANT.coefficient(restitution)
    power = []
    for d, v in zip(delta, rate, strict=True):
        lost = CONSTANT.hysteresis(d > 0.0, 0.0, v, alpha, 0.1)
        normal, elastic = normal_force(max(d, 0.0), v, 1e11, lost)
        assert normal >= 0.0
        power.append((normal - elastic) * v)
    assert np.trapezoid(power, t) >= 0.0


def test_a_hit_within_a_held_contact_loses_what_the_rate_of_the_hit_says():
    """After a soft onset the frozen law multiplies the force of a hit at 0.5 m/s by 3.25."""
    soft = 0.01
    frozen = frozen_at_onset(True, 0.0, soft, 0.45, 0.1)
    constant = CONSTANT.hysteresis(True, 0.0, soft, 0.45, 0.1)
    hits = []
    for held, law in ((frozen, frozen_at_onset), (constant, CONSTANT.hysteresis)):
        normal, elastic = normal_force(1e-4, 0.5, 1e11, law(True, held, 0.5, 0.45, 0.1))
        hits.append(normal / elastic)
    assert hits == pytest.approx([3.25, 1.225])
