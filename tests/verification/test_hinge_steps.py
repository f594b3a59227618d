"""What the solver's tolerance costs in the hinge; the set compared is the one that ships."""

import pytest

from railquake.inputs.solver import Solver
from railquake.inputs.support import Pier
from railquake.march.compiler import PYTHON
from railquake.validation.hinge_steps import SETS, deviation, hinge_of, numbers


@pytest.mark.parametrize("name", SETS)
def test_what_the_solvers_tolerance_costs_falls_with_its_square(name):
    """The history's increments are far longer than those of a run, so this is an upper bound."""
    default = Solver().newton_tolerance
    coarse, fine = (deviation(name, factor * default, PYTHON) for factor in (1.0, 0.1))
    assert coarse < default**2
    assert fine < 0.02 * coarse


def test_the_set_that_ships_is_the_set_of_the_numbers():
    ships = Pier.from_preset("bart-berkeley").bouc_wen
    assert hinge_of(numbers("hinge")) == ships.model_copy(update={"m": 1.0})
