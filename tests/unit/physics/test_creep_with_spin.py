"""Creep with large spin: Kalker's simplified theory, its table, and all laws beside CONTACT."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from railquake.assembly.geometry import law_table
from railquake.march.compiler import SCALAR, bind
from railquake.physics.creep import LinearForce, magnitude
from railquake.physics.creep.fastsim import Ellipse, bound, simplified_theory
from railquake.physics.creep.kalker import kalker_coefficients
from railquake.validation import creep_with_spin

POISSON = 0.28
integrated = bind(simplified_theory, SCALAR).call


def ellipse(a_over_b):
    return Ellipse(a_over_b, *(float(c[0]) for c in kalker_coefficients([a_over_b], POISSON)))


def theory(along, creep, spin, a_over_b=1.0, grid=(40, 160)):
    return integrated(along, creep, spin, ellipse(a_over_b), *grid)


def by_table(along, creep, spin, a_over_b=1.0, limit=1.0):
    linear = LinearForce(along * limit, creep * limit, spin * limit)
    return bound(linear, limit, math.log(a_over_b), law_table("fastsim", POISSON))


# --- the theory --------------------------------------------------------------------------------


@pytest.mark.parametrize("a_over_b", [0.3, 1.0, 8.0])
def test_small_creepages_give_linear_theory(a_over_b):
    x, y = theory(1e-3, 2e-3, -0.5e-3, a_over_b)
    assert x == pytest.approx(1e-3, rel=0.01)
    assert y == pytest.approx(1.5e-3, rel=0.02)


def test_without_spin_all_slides_at_last_and_along_the_slip():
    """The rigid slip is (f_x/C11, f_y/C22), not (f_x, f_y)."""
    x, y = theory(600.0, 800.0, 0.0, 4.0)
    assert math.hypot(x, y) == pytest.approx(1.0, rel=2e-3)
    shape = ellipse(4.0)
    assert x / y == pytest.approx(600.0 / shape.c11 / (800.0 / shape.c22), rel=1e-3)


def test_pure_spin_that_slides_turns_about_the_middle_and_pushes_nowhere():
    assert theory(0.0, 0.0, 1e4, 3.0) == pytest.approx((0.0, 0.0), abs=1e-2)


@settings(max_examples=30, deadline=None)
@given(st.floats(-9.0, 9.0), st.floats(-9.0, 9.0), st.floats(-9.0, 9.0), st.floats(0.3, 15.0))
def test_mirrored_creepages_give_mirrored_forces(along, creep, spin, a_over_b):
    x, y = theory(along, creep, spin, a_over_b, (12, 24))
    assert math.hypot(x, y) < 1.01
    assert theory(along, -creep, -spin, a_over_b, (12, 24)) == pytest.approx((x, -y), abs=1e-9)
    assert theory(-along, creep, spin, a_over_b, (12, 24)) == pytest.approx((-x, y), abs=1e-9)


# --- the table ---------------------------------------------------------------------------------


def test_table_is_the_theory_between_its_nodes():
    """300 creepages of all sizes: within 0.005 of friction's limit in the mean, 0.07 at most."""
    generator = np.random.default_rng(1)
    off = []
    for _ in range(300):
        way = generator.normal(size=3)
        size = math.exp(generator.uniform(math.log(0.1), math.log(60.0)))
        given = size * way / np.linalg.norm(way)
        ratio = math.exp(generator.uniform(math.log(0.2), math.log(25.0)))
        force = by_table(*given, ratio)
        x, y = theory(*given, ratio)
        off.append(math.hypot(force.along - x, force.creep + force.spin - y))
    assert np.mean(off) < 0.0075
    assert max(off) < 0.07


@given(
    st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), st.floats(-1e6, 1e6), st.floats(0.01, 100.0),
    st.floats(0.0, 1e5),
)  # fmt: skip
def test_friction_bounds_the_force_and_creepage_loses(along, creep, spin, a_over_b, limit):
    force = bound(
        LinearForce(along, creep, spin), limit, math.log(a_over_b), law_table("fastsim", POISSON)
    )
    assert magnitude(force) <= limit * (1.0 + 1e-9) + 1e-12
    assert force.along * along >= 0.0
    assert force.creep * creep >= 0.0


def test_nothing_pressed_bears_nothing_and_a_lost_state_breaks_nothing():
    assert by_table(0.0, 0.0, 0.0)[:3] == (0.0, 0.0, 0.0)
    assert by_table(1.0, 1.0, 1.0, limit=0.0)[:3] == (0.0, 0.0, 0.0)
    table = law_table("fastsim", POISSON)
    for lost in ((math.nan, 0.0, 0.0), (0.0, math.inf, 1.0), (0.0, 0.0, -math.nan)):
        assert not math.isfinite(sum(bound(LinearForce(*lost), 1.0, 0.0, table)))


def test_small_creepages_are_read_from_the_table_as_linear_theory():
    force = by_table(1e-6, -2e-6, 5e-7, 3.7)
    assert force.along == pytest.approx(1e-6, rel=1e-5)
    assert force.creep + force.spin == pytest.approx(-1.5e-6, rel=1e-5)


# --- beside CONTACT ----------------------------------------------------------------------------


def test_force_on_flanges_is_contacts_within_six_hundredths_of_friction():
    """396 rows of combined creepages and spin, a/b 0.3 to 18: 0.06 in the mean, 0.2 everywhere."""
    off = np.abs(creep_with_spin.errors("fastsim"))
    assert len(off) == 396
    assert off.mean(axis=0).max() <= 0.06
    assert off.max() <= 0.2


def test_laws_of_the_magnitude_alone_are_ten_times_as_far_off():
    for law in ("she", "carter", "polach", "coulomb"):
        mean_x, mean_y = np.abs(creep_with_spin.errors(law)).mean(axis=0)
        ours_x, ours_y = np.abs(creep_with_spin.errors("fastsim")).mean(axis=0)
        assert mean_x > 5.0 * ours_x and mean_y > 10.0 * ours_y
