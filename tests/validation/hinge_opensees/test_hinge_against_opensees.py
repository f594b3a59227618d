"""The hinge's law, step by step, against OpenSees (see readme.md)."""

import re
from pathlib import Path

import numpy as np
import pytest

from railquake.assembly.statics import UNKNOWN_DEGRADATION
from railquake.assembly.system import hinge_parameters
from railquake.inputs.hinge import BoucWenHinge
from railquake.inputs.solver import Solver
from railquake.inputs.support import Pier
from railquake.physics.boucwen import advance
from railquake.physics.kernel import PYTHON, SCALAR, bind
from reference_numbers import columns

HERE = Path(__file__).parent
TOLERANCE = 1e-9  # of the peak, at every step

# OpenSees' names, where they differ from the published ones
NAMES = {
    "ko": "k0", "eta": "eta0", "beta": "beta0", "rhoeps": "rho_eps", "rhox": "rho_x",
    "deltak": "delta_k", "deltaf": "delta_f", "epsp": "eps_p", "rhop": "rho_p",
}  # fmt: skip


def hinge_of(path):
    """The hinge of the file's header."""
    line = next(line for line in path.read_text().splitlines() if line.startswith("# parameters:"))
    values = {NAMES.get(key, key): float(value) for key, value in re.findall(r"(\w+)=(\S+)", line)}
    return BoucWenHinge(**values)


def drive(law, parameters, path):
    """Moments along the rotations, with the guesses and the memory that the pier's step uses."""
    x = z = z_step = eps = x_max = 0.0
    known = UNKNOWN_DEGRADATION
    moments = []
    for target in path:
        dx, z_new, eps, x_max, moment, _, correction, *known = law(
            x, z, z + z_step, eps, x_max, *known, target - x, 0.0, *parameters
        )
        assert abs(correction) <= parameters[-2]
        x, z, z_step = x + dx, z_new, z_new - z
        moments.append(moment)
    return np.array(moments)


def deviation(name, tolerance, target):
    """Largest error of the moment over the peak; ``tolerance`` of z as in `Solver`."""
    path = HERE / f"{name}.csv"
    history = columns(path)
    parameters = hinge_parameters(hinge_of(path), tolerance, 50)
    moments = drive(bind(advance, target).call, parameters, history["x"])
    return np.abs(moments - history["F"]).max() / np.abs(history["F"]).max()


@pytest.mark.parametrize("target", [PYTHON, SCALAR], ids=["plain", "compiled"])
@pytest.mark.parametrize("name", ["generic", "hinge"])
def test_every_step_agrees(name, target):
    assert deviation(name, 1e-6, target) < TOLERANCE


@pytest.mark.parametrize("name", ["generic", "hinge"])
def test_what_the_solvers_tolerance_costs_falls_with_its_square(name):
    """The history's increments are far longer than those of a run, so this is an upper bound."""
    default = Solver().newton_tolerance
    coarse, fine = (deviation(name, factor * default, PYTHON) for factor in (1.0, 0.1))
    assert coarse < default**2
    assert fine < 0.02 * coarse


def test_the_set_that_ships_is_the_set_of_the_numbers():
    ships = Pier.from_preset("bart-berkeley").bouc_wen
    assert hinge_of(HERE / "hinge.csv") == ships.model_copy(update={"m": 1.0})


@pytest.mark.parametrize("name", ["generic", "hinge"])
def test_the_numbers_here_are_those_of_the_source(shared, name):
    source = columns(shared / "oracles" / f"dev_{name}.csv")
    for column, values in columns(HERE / f"{name}.csv").items():
        np.testing.assert_array_equal(values, source[column])
