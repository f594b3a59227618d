"""Fits: known parameters come back; what a loop does not show is said."""

from itertools import pairwise

import numpy as np
import pytest

from railquake.calibration.cyclic import Loop
from railquake.calibration.fit import Variable, fit_hinge
from railquake.calibration.loop import column_flexibility, drive_hinge
from railquake.errors import InputError

MASS = 262914.0


@pytest.fixture
def loop(known_hinge, cycles):
    flexibility = column_flexibility(44.8e9, 0.16425, 6.0)
    return Loop("made", cycles, response_along(known_hinge, cycles, flexibility), flexibility)


def response_along(hinge, path, flexibility):
    """Moment with steps so fine that they do not matter."""
    return drive_hinge(hinge, path, flexibility, substeps=40)


def test_round_trip_recovers_the_parameters(known_hinge, loop):
    fit = fit_hinge(loop, mass=MASS, starts=3)
    assert fit.misfit.over_peak < 2e-3
    found = {p.name: p for p in fit.parameters}
    assert found["k0"].value == pytest.approx(known_hinge.k0, rel=0.03)
    # capacity: k0 [beta0 (1 + eta0)]^(-1/n) = 2e9 x 2.5e-3
    assert found["capacity"].value == pytest.approx(5e6, rel=0.03)
    assert found["alpha"].value == pytest.approx(0.03, rel=0.05)
    assert fit.hinge.n == pytest.approx(1.6, rel=0.05)
    assert fit.hinge.eta0 == pytest.approx(0.3, abs=0.05)
    assert fit.hinge.sigma == pytest.approx(0.005, rel=0.05)
    assert fit.hinge.rho_p == pytest.approx(0.35, rel=0.05)
    assert fit.hinge.eps_p == pytest.approx(0.2, rel=0.05)
    # damage is counted in units of the loop's end: phi, delta_k, delta_f scale with xu
    scale = fit.hinge.xu / known_hinge.xu
    assert found["energy_share"].value < 0.05
    assert fit.hinge.phi == pytest.approx(1.2 * scale, rel=0.1)
    assert fit.hinge.delta_k == pytest.approx(3.0 * scale, rel=0.1)
    assert fit.hinge.delta_f == pytest.approx(0.4 * scale, rel=0.1)
    assert all(p.determined for p in fit.parameters)


def test_fitted_hinge_foretells_another_path(known_hinge, loop):
    fit = fit_hinge(loop, mass=MASS, starts=2)
    rng = np.random.default_rng(5)
    turns = 0.018 * rng.uniform(-1.0, 1.0, 30)
    path = np.concatenate([np.linspace(a, b, 60)[1:] for a, b in pairwise(turns)])
    path = np.concatenate([np.linspace(0.0, turns[0], 60)[1:], path])
    expected, found = (response_along(h, path, loop.flexibility) for h in (known_hinge, fit.hinge))
    assert np.abs(found - expected).max() < 0.03 * np.abs(expected).max()


def test_pinching_is_not_determined_by_a_loop_without_it(known_hinge, loop, cycles):
    full = known_hinge.model_copy(update={"rho_p": 0.0})
    moment = response_along(full, cycles, loop.flexibility)
    rng = np.random.default_rng(1)
    noisy = moment + 0.01 * np.abs(moment).max() * rng.standard_normal(len(moment))
    fit = fit_hinge(Loop("full", cycles, noisy, loop.flexibility), mass=MASS, starts=2)
    found = {p.name: p for p in fit.parameters}
    assert found["rho_p"].value < 0.03
    loose = [name for name in ("sigma", "u", "eps_p") if not found[name].determined]
    assert loose, "a pinching that is not there cannot have a place"
    assert found["k0"].determined and found["capacity"].determined


def test_standard_errors_cover_noise(known_hinge, loop):
    """Over independent noise the capacity scatters as its standard error says."""
    clean = loop.moment
    rng = np.random.default_rng(3)
    places, errors = [], []
    for _ in range(6):
        noise = 0.02 * np.abs(clean).max() * rng.standard_normal(len(clean))
        fit = fit_hinge(Loop("n", loop.chord, clean + noise, loop.flexibility), mass=MASS, starts=1)
        capacity = fit.parameters[1]
        assert capacity.name == "capacity"
        places.append(capacity.scaled)
        errors.append(capacity.scaled_error)
    ratio = np.std(places, ddof=1) / np.mean(errors)
    assert 0.3 < ratio < 3.0  # six draws


def test_same_seed_same_answer(loop):
    short = Loop("short", loop.chord[:200], loop.moment[:200], loop.flexibility)
    first, second = (fit_hinge(short, mass=MASS, starts=2, seed=7) for _ in range(2))
    assert first.hinge == second.hinge


def test_a_loop_that_no_hinge_follows_is_refused():
    rng = np.random.default_rng(0)
    x = np.tile([0.01, -0.01], 40) * rng.uniform(0.5, 1.0, 80)
    moment = np.where(rng.uniform(size=80) > 0.5, 1.0, -1.0) * 1e6
    moment[0] = 1e6
    loop = Loop("noise", x, moment, 0.0)
    with pytest.raises(InputError, match=r"noise: no hinge follows this loop \(misfit \d+%"):
        fit_hinge(loop, mass=MASS, starts=1)


@pytest.mark.parametrize("scale", ["log", "linear"])
def test_scaled_variables_there_and_back(scale):
    variable = Variable("x", 0.5, 8.0, scale)
    assert variable.value(0.0) == pytest.approx(0.5) and variable.value(1.0) == pytest.approx(8.0)
    assert variable.value(variable.scaled(3.0)) == pytest.approx(3.0)
    assert variable.scaled(100.0) == 1.0 and variable.scaled(0.01) == 0.0
