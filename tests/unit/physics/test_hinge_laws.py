"""What all laws of the hinge have in common."""

import math

import numpy as np
import pytest

from railquake.march.compiler import PYTHON, bind
from railquake.physics import hinge
from railquake.physics.hinge import HINGE_LAWS, Answer, follow
from railquake.physics.impact import RESTITUTION_LAWS


def followed(law, path, substeps=1):
    moment, states = np.zeros(len(path)), np.zeros((len(path), 1))
    run = bind(follow, PYTHON, {hinge.advance: law}).call
    return run(np.array(path), 0.0, (0.0,), None, substeps, moment, states), moment, states


@pytest.mark.parametrize(
    ("misses", "solved"), [((), 5), ((2,), 2), ((0,), 0), ((4,), 4), ((1, 3), 1)]
)
def test_a_path_is_solved_up_to_the_first_step_that_is_not(misses, solved):
    """What is solved again further on does not count."""
    path = [1.0, 2.0, 3.0, 4.0, 5.0]

    def law(x, state, parameters, free_step, flexibility):
        missed = 1.0 if any(path[k] == x + free_step for k in misses) else 0.0
        return Answer(free_step, 2.0 * (x + free_step), 2.0, missed, (x,))

    found, moment, states = followed(law, path)
    assert found == solved
    assert moment.tolist() == [2.0, 4.0, 6.0, 8.0, 10.0]
    assert states[:, 0].tolist() == [0.0, 1.0, 2.0, 3.0, 4.0]  # the whole path all the same


def test_no_number_is_not_solved_either():
    def law(x, state, parameters, free_step, flexibility):
        moment = math.nan if x + free_step > 2.5 else 1.0
        return Answer(free_step, moment, 0.0, 0.0, state)

    assert followed(law, [1.0, 2.0, 3.0, 2.0])[0] == 2


def test_parts_of_a_step_end_where_the_step_does():
    steps = []

    def law(x, state, parameters, free_step, flexibility):
        steps.append(free_step)
        return Answer(free_step, x + free_step, 1.0, 0.0, state)

    solved, moment, _ = followed(law, [0.3, -0.3], substeps=3)
    assert solved == 2
    assert moment == pytest.approx([0.3, -0.3], abs=1e-15)
    assert steps == pytest.approx([0.1] * 3 + [-0.2] * 3, abs=1e-15)


def test_an_elastic_hinge_is_never_damaged():
    law = HINGE_LAWS["elastic"]
    answer = law.advance(0.0, law.virgin, law.parameter_fields(2.0), 0.5, 0.0)
    assert answer.moment == 1.0
    assert law.damage(answer.state, law.parameter_fields(2.0)) == 0.0
    assert law.standing(answer.state) is answer.state


def test_no_finite_loss_makes_an_impact_stick():
    """Of the calibrated law."""
    assert RESTITUTION_LAWS["calibrated"].coefficient(0.0) == math.inf
    assert RESTITUTION_LAWS["calibrated"].coefficient(1.0) == 0.0
