"""Kalker's coefficients and the laws that bound the linear force by friction."""

import csv

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from railquake.physics.creep import CREEP_LAWS
from railquake.physics.creep.kalker import kalker_coefficients
from railquake.probe import creep_force

LAWS = sorted(name for name in CREEP_LAWS if CREEP_LAWS[name].saturation is not None)


@pytest.mark.parametrize("poisson", [0.0, 0.25, 0.5])
def test_coefficients_are_kalkers_own_at_the_nodes_of_his_table(shared, poisson):
    """To the last digit; but at a/b 10, the mean of his and CONTACT's, C23 2 % apart."""
    with open(shared / "oracles" / "kalker_table.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    for row in rows:
        ratio = float(row["ratio"]) if row["part"] == "a/b<=1" else 1.0 / float(row["ratio"])
        found = kalker_coefficients(np.array([ratio]), poisson)
        for name, value in zip(("C11", "C22", "C23"), found, strict=True):
            near = 0.01 if ratio > 9.0 else 1e-9
            assert value[0] == pytest.approx(float(row[f"{name}_nu{poisson:g}"]), rel=near)


def contacts_coefficients(shared):
    with open(shared / "oracles" / "contact_linear_coefficients_flange.csv") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


@pytest.mark.parametrize("name", ["C11", "C22", "C23"])
def test_coefficients_are_contacts_from_treads_to_flanges(shared, name):
    """Within 1 % from a/b 0.1 to 20."""
    rows = contacts_coefficients(shared)
    ratio = np.array([float(row["a_over_b"]) for row in rows])
    theirs = np.array([float(row[name]) for row in rows])
    found = dict(zip(("C11", "C22", "C23"), kalker_coefficients(ratio, 0.28), strict=True))[name]
    assert found == pytest.approx(theirs, rel=0.01)


def test_coefficients_beyond_the_table_keep_poissons_proportions_and_the_last_slope():
    at_ten, beyond = (np.array(kalker_coefficients(np.array([r, r]), 0.28)) for r in (10.0, 15.0))
    other_ten, other = (np.array(kalker_coefficients(np.array([r, r]), 0.45)) for r in (10.0, 15.0))
    assert other / beyond == pytest.approx(other_ten / at_ten)
    eighteen, twenty, last = (
        np.concatenate(kalker_coefficients(np.array([r]), 0.3)) for r in (18.0, 20.0, 40.0)
    )
    slope = np.log(twenty / eighteen) / np.log(20.0 / 18.0)
    assert last == pytest.approx(twenty * 2.0**slope)


@pytest.mark.parametrize("law", LAWS)
def test_slope_at_zero_creepage_is_kalkers(law):
    factor = CREEP_LAWS[law].saturation
    for tau in (1e-6, 1e-5):
        assert factor(tau, 1.0) == pytest.approx(1.0, abs=tau)
    assert factor(0.0, 1.0) == 1.0


@pytest.mark.parametrize("law", LAWS)
@given(linear=st.floats(-1e7, 1e7), limit=st.floats(0.0, 1e6))
def test_force_never_exceeds_friction_and_opposes_the_creepage(law, linear, limit):
    force = linear * CREEP_LAWS[law].saturation(linear, limit)
    assert abs(force) <= limit * (1.0 + 1e-12) + 1e-12
    assert force * linear >= 0.0


@pytest.mark.parametrize("law", LAWS)
def test_force_grows_with_the_creepage_and_reaches_friction(law):
    tau = np.linspace(0.0, 50.0, 2000)
    force = np.array([t * CREEP_LAWS[law].saturation(t, 1.0) for t in tau])
    assert np.all(np.diff(force) > -1e-12)
    assert force[-1] == pytest.approx(1.0, abs=0.02)  # Polach's gets there slowly


def test_shen_hedrick_elkins_slides_from_three_times_the_limit():
    factor = CREEP_LAWS["she"].saturation
    assert factor(3.0, 1.0) == pytest.approx(1.0 / 3.0, rel=1e-12)
    assert 1.5 * factor(1.5, 1.0) == pytest.approx(1.5 - 0.75 + 0.125, rel=1e-12)


@pytest.mark.parametrize("law", sorted(CREEP_LAWS))
def test_force_stays_within_its_stated_deviation_from_contact(shared, law):
    """Each law's largest deviation without spin, as the theory page states it (F over mu N)."""
    stated = {"she": 0.03, "coulomb": 0.26, "carter": 0.045, "polach": 0.055, "fastsim": 0.038}
    with open(shared / "oracles" / "contact_creep.csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    worst = 0.0
    for row in rows:
        if float(row["phi_1_per_m"]) != 0.0:
            continue
        load = 1e3 * float(row["N_kN"])
        axes = (1e-3 * float(row["a_mm"]), 1e-3 * float(row["b_mm"]))
        creepages = (0.0, float(row["upsilon_y"]), 0.0)
        force = creep_force(axes, load, creepages, 0.3, 82e9, 0.28, law).lateral
        worst = max(worst, abs(force / (0.3 * load) - float(row["Fy_over_muN"])))
    assert worst < stated[law]
