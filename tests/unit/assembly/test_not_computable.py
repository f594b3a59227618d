"""Inputs, each of them possible, that cannot be assembled: one line, whatever went wrong inside."""

from types import SimpleNamespace

import numpy as np
import pytest

import railquake as rq
from railquake.assembly import assemble
from railquake.assembly.rest import loaded_hinge
from railquake.errors import InputError
from railquake.inputs.ground_motion import GroundMotion

STILL = GroundMotion("still", 1e-3, np.zeros(4))


@pytest.mark.parametrize("restitution", [1e-3, 0.01, 0.029])
def test_a_restitution_too_small_to_be_calibrated(restitution):
    wheels = {"preset": "bart", "restitution": restitution, "restitution_law": "calibrated"}
    with pytest.raises(InputError, match=r"wheelrail\.restitution: .* cannot be reached"):
        assemble(rq.scenario(motion=STILL, wheelrail=wheels))


@pytest.mark.parametrize(
    "answer", [-1.0, float("nan")], ids=["pushes the wrong way", "not a number"]
)
def test_a_hinge_whose_answer_has_no_bracket(answer):
    def advance(x, state, parameters, step, _):
        moment = answer * 1e9 if x + step > 0.5 else x + step
        return SimpleNamespace(step=step, moment=moment, tangent=1.0, state=state)

    law = SimpleNamespace(virgin=None, advance=advance, standing=lambda state: state)
    with pytest.raises(InputError, match="cannot carry the standing train: a moment of 1 N m"):
        loaded_hinge(law, SimpleNamespace(k0=1.0), 1.0)
    with pytest.raises(InputError, match="cannot carry"):
        loaded_hinge(law, SimpleNamespace(k0=1.0), float("nan"))


@pytest.mark.parametrize(
    "pier",
    [{"length": 1e300}, {"length": 1e-300}, {"track_offset": 1e300}, {"youngs_modulus": 1e-300}],
)
def test_numbers_that_overflow_on_the_way_to_the_equilibrium(pier):
    with pytest.raises(InputError, match="too large or too small|no equilibrium"):
        assemble(rq.scenario(motion=STILL, support={"preset": "bart-berkeley", **pier}))
