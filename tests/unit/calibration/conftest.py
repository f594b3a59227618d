"""Shared by the tests of calibration."""

import importlib.util
import os
from itertools import pairwise

import numpy as np
import pytest

from railquake.inputs.hinge import BoucWenHinge


@pytest.fixture
def opensees():
    """OpenSees; without it the test skips, but not in CI."""
    if importlib.util.find_spec("opensees") is None:
        message = "needs OpenSees: pip install railquake[fem]"
        if os.environ.get("CI"):
            pytest.fail(message)
        pytest.skip(message)


@pytest.fixture
def known_hinge():
    """A hinge that degrades and pinches, with the damage index at 1 at 0.02 rad."""
    return BoucWenHinge(
        Fy=5e6, xu=0.02, alpha=0.03, k0=2e9, n=1.6, eta0=0.3, beta0=(2.5e-3) ** -1.6 / 1.3,
        rho_eps=0.0, rho_x=1.0, phi=1.2, delta_k=3.0, delta_f=0.4, sigma=0.005, u=2.0, eps_p=0.2,
        rho_p=0.35, m=262914.0,
    )  # fmt: skip


@pytest.fixture
def cycles():
    """Rotations of growing cycles, two at each amplitude, up to 0.02 rad."""
    turns = [0.0]
    for amplitude in (0.003, 0.006, 0.01, 0.015, 0.02):
        turns += [amplitude, -amplitude] * 2
    pieces = [
        np.linspace(a, b, max(2, round(abs(b - a) / 8e-4)) + 1)[1:] for a, b in pairwise(turns)
    ]
    return np.concatenate(pieces)
