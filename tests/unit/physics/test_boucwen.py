"""The hinge against OpenSees' histories, its tangent against finite differences."""

import csv
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from railquake.inputs.hinge import BoucWenHinge
from railquake.inputs.model import validated
from railquake.inputs.presets import resolved_section
from railquake.inputs.support import Pier
from railquake.march.compiler import SCALAR, bind
from railquake.physics.hinge import bouc_wen
from railquake.probe import run_hinge

# Parameters from the first lines of each file.
GENERIC = BoucWenHinge(
    m=1.0, Fy=1.0, xu=10.0, alpha=0.05, k0=1.0, n=1.5, eta0=0.0, beta0=1.0, rho_eps=0.1,
    rho_x=0.2, phi=0.5, delta_k=0.4, delta_f=0.1, sigma=1.0, u=2.0, eps_p=1.0, rho_p=0.3,
)  # fmt: skip


def state(z, eps, x_max, z_step=0.0):
    """A state of which nothing is known of degradation and pinching."""
    return bouc_wen.LAW.virgin._replace(z=z, eps=eps, x_max=x_max, z_step=z_step)


def berkeley(**changes):
    section = resolved_section("support", {"preset": "bart-berkeley", "bouc_wen": changes})
    return validated(Pier, section, "support").bouc_wen


def oracle(shared, name):
    with open(shared / "oracles" / name) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


@pytest.mark.parametrize(
    ("name", "hinge"), [("dev_generic.csv", GENERIC), ("dev_hinge.csv", berkeley(m=1.0))]
)
def test_moment_follows_opensees_at_every_step(shared, name, hinge):
    expected = oracle(shared, name)
    rows = run_hinge(hinge, expected["x"])
    assert rows[:, 0] == pytest.approx(expected["F"], abs=1e-9 * np.abs(expected["F"]).max())
    assert rows[:, 2] == pytest.approx(expected["damage_own"], abs=1e-9)


def test_compiled_law_gives_what_the_plain_one_gives():
    parameters = bouc_wen.parameters(berkeley(), 1e-10, 50)
    compiled = bind(bouc_wen.advance, SCALAR).call
    begun = state(3e-4, 2e-4, 1.5e-3, z_step=-1e-4)
    for step in (1e-5, -1e-5, 1e-3):
        arguments = (1e-3, begun, parameters, step, 0.0)
        found, expected = compiled(*arguments), bouc_wen.advance(*arguments)
        assert found[:-1] == pytest.approx(expected[:-1], rel=1e-12)
        assert found.state == pytest.approx(expected.state, rel=1e-12)


def moment_and_tangent(hinge, x, z, eps, x_max, step):
    parameters = bouc_wen.parameters(hinge, 1e-14, 300)
    found = bouc_wen.advance(x, state(z, eps, x_max), parameters, step, 0.0)
    return found.moment, found.tangent


@settings(max_examples=200, deadline=None)
@given(
    x=st.floats(-8e-3, 8e-3),
    share=st.floats(-0.95, 0.95),
    eps=st.floats(0.0, 3e-3),
    beyond=st.sampled_from([0.0, 3e-3]),
    step=st.floats(2e-6, 3e-4),
    sign=st.sampled_from([-1.0, 1.0]),
)
def test_tangent_is_consistent(x, share, eps, beyond, step, sign):
    """Loading, unloading and new largest rotations, away from the kinks between them."""
    hinge = berkeley(rho_eps=0.5)
    z = share * (1.0 / hinge.beta0) ** (1.0 / hinge.n)
    x_max = abs(x) + beyond
    step *= sign
    h = 1e-8
    signs = {math.copysign(1.0, (step + d) * (z + step)) for d in (-h, h)}
    kinks = {abs(x + step + d) > x_max for d in (-h, 0.0, h)}
    if len(signs) > 1 or len(kinks) > 1 or abs(z + step) < 3e-6 or abs(z) < 3e-6:
        return
    if (z + step) * z < 0.0:
        return  # z changes its sign within the step
    ahead, _ = moment_and_tangent(hinge, x, z, eps, x_max, step + h)
    behind, _ = moment_and_tangent(hinge, x, z, eps, x_max, step - h)
    _, tangent = moment_and_tangent(hinge, x, z, eps, x_max, step)
    assert tangent == pytest.approx((ahead - behind) / (2.0 * h), abs=1e-6 * hinge.k0)


def test_undamaged_moment_of_the_preset_is_capped_at_19_mn_m():
    """physics.md, section 3: the undamaged moment is capped at 19.0 MN m."""
    hinge = berkeley(rho_x=0.0, alpha=1e-9, rho_p=0.0)
    moments = run_hinge(hinge, np.linspace(0.0, 0.05, 2000))[:, 0]
    assert moments[-1] == pytest.approx(19.0e6, rel=5e-3)


def test_odd_and_fractional_pinching_exponents_are_fine_on_the_negative_side():
    path = np.concatenate([np.linspace(0.0, -8e-3, 100), np.linspace(-8e-3, 8e-3, 200)])
    for u in (1.0, 2.5, 3.0):
        assert np.isfinite(run_hinge(berkeley(u=u), path)).all()


def test_a_mirrored_path_gives_the_mirrored_moment():
    path = np.concatenate([np.linspace(0.0, 5e-3, 80), np.linspace(5e-3, -7e-3, 150)])
    there, back = run_hinge(berkeley(), path), run_hinge(berkeley(), -path)
    assert there[:, 0] == pytest.approx(-back[:, 0], rel=1e-12)


def test_closed_cycles_never_give_energy_back():
    path = np.concatenate(
        [np.linspace(0.0, 4e-3, 100), np.linspace(4e-3, -4e-3, 200), np.linspace(-4e-3, 0.0, 100)]
    )
    for amplitude in (0.2, 1.0, 2.0):
        x = amplitude * path
        moment = run_hinge(berkeley(), x)[:, 0]
        work = 0.5 * np.sum((moment[1:] + moment[:-1]) * np.diff(x))
        assert work > 0.0


def test_elastic_hinge_is_k0_times_the_rotation():
    hinge = berkeley()
    x = np.array([0.0, 1e-3, -2e-3])
    assert run_hinge(hinge, x, elastic=True)[:, 0] == pytest.approx(hinge.k0 * x, rel=1e-14)


def test_within_a_structure_the_step_satisfies_both_structure_and_hinge():
    hinge = berkeley()
    parameters = bouc_wen.parameters(hinge, 1e-12, 50)
    flexibility, free = 2e-11, 3e-4
    begun = state(3e-4, 1e-4, 1.2e-3)
    dx = bouc_wen.advance(1e-3, begun, parameters, free, flexibility).step
    alone = bouc_wen.advance(1e-3, begun, parameters, dx, 0.0)
    assert dx == pytest.approx(free - flexibility * alone.moment, rel=1e-9)


def test_the_linearised_step_errs_less_than_a_thousandth_at_small_steps():
    parameters = bouc_wen.parameters(berkeley(), 1e-12, 50)
    begun = state(3e-4, 1e-4, 1.2e-3)
    flexibility = 2e-11
    moment = bouc_wen.advance(1e-3, begun, parameters, 0.0, 0.0).moment
    free = flexibility * moment + 1e-6  # the rest of the structure is nearly in balance
    exact = bouc_wen.advance(1e-3, begun, parameters, free, flexibility)
    once = bouc_wen.advance_linearised(1e-3, begun, parameters, free, flexibility)
    assert abs(exact.step) < 2e-6
    assert once.state.z - begun.z == pytest.approx(exact.state.z - begun.z, rel=1e-3)
