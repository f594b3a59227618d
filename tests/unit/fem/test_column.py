"""The fibre column against mechanics by hand, and its refusals."""

import importlib.util
import os

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.fem.column import (
    ConcreteLaw,
    FibreColumn,
    Fibres,
    SteelLaw,
    push_column,
    shake_column,
)

if importlib.util.find_spec("opensees") is None and not os.environ.get("CI"):
    pytest.skip("needs OpenSees: pip install railquake[fem]", allow_module_level=True)

LENGTH = 6.0
AXIAL = 2.5e6


def column(**changes):
    """A square section of 1 m in 40 strips, eight bars in two rows."""
    edges = np.linspace(-0.5, 0.5, 41)
    law = ConcreteLaw(30e6, 0.002, 0.006, 25.7e9)
    values = {
        "length": LENGTH,
        "plastic_length": 0.6,
        "axial_load": AXIAL,
        "cover": Fibres(np.zeros(0), np.zeros(0)),
        "core": Fibres(0.5 * (edges[1:] + edges[:-1]), np.full(40, 1.0 / 40.0)),
        "bars": Fibres(np.array([-0.42, 0.42]), np.array([5e-3, 5e-3])),
        "unconfined": law,
        "confined": ConcreteLaw(30e6, 0.002, 0.02, 25.7e9),
        "steel": SteelLaw(400e6, 200e9, 1e-4),
    }
    return FibreColumn(**{**values, **changes})


def test_first_stiffness_is_that_of_the_uncracked_section():
    """3 E I / L^3 with bars transformed; concrete's tangent falls a little under axial load."""
    moment, top = push_column(column(), np.array([1e-5]))
    concrete = 1.0 / 12.0 * (1.0 - 1.0 / 40.0**2)
    stiffness = 25.7e9 * concrete + 200e9 * 1e-2 * 0.42**2
    assert moment[0] / LENGTH / 1e-5 == pytest.approx(3.0 * stiffness / LENGTH**3, rel=0.06)
    assert top[0] == pytest.approx(1.5 * 1e-5 / LENGTH, rel=0.02)


def test_largest_moment_is_that_of_a_stress_block():
    """Axial load on a block of concrete at f'c and both rows of bars at yield."""
    path = np.linspace(0.0, 0.02, 101)[1:] * LENGTH
    moment, _ = push_column(column(), path)
    # both rows yield: compression in the concrete balances the axial load alone
    depth = AXIAL / (0.85 * 30e6)
    block = 5e-3 * 400e6 * 2 * 0.42 + AXIAL * 0.5 * (1.0 - depth)
    assert np.abs(moment).max() == pytest.approx(block, rel=0.05)


def test_mirrored_path_gives_mirrored_moments():
    path = np.concatenate([np.linspace(0.0, 0.06, 40)[1:], np.linspace(0.06, -0.03, 40)[1:]])
    there, turned = push_column(column(), path)
    back, turned_back = push_column(column(), -path)
    assert np.allclose(there, -back, rtol=0.0, atol=1e-6 * np.abs(there).max())
    assert np.allclose(turned, -turned_back, rtol=0.0, atol=1e-6 * np.abs(turned).max())


def test_weak_motion_is_that_of_a_linear_oscillator():
    """Little rotational inertia: a mass on the first stiffness, 5 % damped, in resonance."""
    mass, step = 2.5e5, 0.005
    stiffness = push_column(column(), np.array([1e-6]))[0][0] / LENGTH / 1e-6
    omega = np.sqrt(stiffness / mass)
    time = step * np.arange(401)
    acceleration = 1e-3 * np.sin(omega * time)
    found, moment = shake_column(
        column(), mass=mass, rotational_inertia=1.0, damping=(2.0 * 0.05 * omega, 0.0),
        acceleration=acceleration, dt=step, step=step,
    )  # fmt: skip
    # from rest under -a sin(w t): u = a/(2 zeta w^2) [cos wt - e^(-zeta w t)(...)], built up
    damped = omega * np.sqrt(1.0 - 0.05**2)
    static = 1e-3 / (2.0 * 0.05 * omega**2)
    decay = np.exp(-0.05 * omega * time)
    exact = static * (
        np.cos(omega * time)
        - decay * (np.cos(damped * time) + 0.05 * omega / damped * np.sin(damped * time))
    )
    assert np.abs(found - exact).max() < 0.02 * np.abs(exact).max()
    assert moment[200] * found[200] > 0.0


def test_axial_load_that_crushes_is_refused():
    with pytest.raises(InputError, match="cannot carry its axial load of 4e"):
        push_column(column(axial_load=40e6), np.array([1e-3]))


def test_failing_section_names_the_drift():
    brittle = ConcreteLaw(30e6, 0.002, 0.0021, 25.7e9)
    weak = column(confined=brittle, axial_load=20e6)
    with pytest.raises(
        InputError, match=r"bears its axial load no longer at a drift of .*%, step \d+"
    ):
        push_column(weak, np.linspace(0.0, 0.5, 60)[1:])


def test_without_opensees_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "opensees.openseespy", None)
    with pytest.raises(InputError, match=r"pip install railquake\[fem\]"):
        push_column(column(), np.array([1e-3]))
