"""One physics, two ways to run it: uncompiled, and compiled for this machine."""

import numpy as np
import pytest

import railquake as rq
from railquake.inputs.ground_motion import GroundMotion
from railquake.march.compiler import PYTHON
from railquake.run.response import channels

# 35 ms of a jolt that the wheels cannot follow
JOLT = GroundMotion("jolt", 5e-3, 28.0 * np.array([0.3, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0]))


@pytest.mark.parametrize(
    ("case", "flange"),
    [
        ({"hinge": "bouc-wen"}, False),
        ({"hinge": "elastic"}, False),
        ({"support": "at-grade", "wheelrail": {"preset": "bart", "friction": 0.05}}, True),
    ],
    ids=["bouc-wen", "elastic", "at grade, into the flange"],
)
def test_every_channel_is_the_same(case, flange):
    system = rq.assemble(rq.scenario(motion=JOLT, dt="2e-5 s", **case))
    compiled, plain = rq.simulate(system), rq.simulate(system, target=PYTHON)
    deepest = max(plain.channel(f"penetration_{side}_flange_m").max() for side in ("left", "right"))
    assert (deepest > 0.0) == flange
    for name, *_ in channels(system):
        expected = plain.channel(name)
        error = np.abs(compiled.channel(name) - expected).max()
        assert error <= 1e-9 * np.abs(expected).max(), name
