"""The pier in OpenSees is the pier of the input."""

import numpy as np
import pytest

from railquake.errors import InputError
from railquake.fem.pier import opensees_pier, time_opensees_pier
from railquake.inputs.ground_motion import read_motion
from railquake.inputs.support import Pier


def test_its_peak_and_time_are_those_of_the_reference_run(shared):
    """Peak and its time from the first lines of oracles/dyn_hinge.csv."""
    pytest.importorskip("opensees")
    pier = Pier.from_preset("bart-berkeley", {"bouc_wen": {"m": 1.0}})
    motion = read_motion(shared / "records" / "paper_suite" / "RSN181_IMPVALLH1.AT2")
    history = opensees_pier(
        pier, motion.acceleration, motion.dt, 5e-4, 13_000, gravity=9.81 / 9.80665
    )
    peak = int(np.argmax(np.abs(history.displacement)))
    assert abs(history.displacement[peak]) == pytest.approx(0.0163325802, rel=1e-6)
    assert 5e-4 * (peak + 1) == pytest.approx(6.1265)


def test_without_opensees_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "opensees.openseespy", None)
    pier = Pier.from_preset("bart-berkeley")
    for run in (opensees_pier, time_opensees_pier):
        with pytest.raises(InputError, match=r"pip install railquake\[fem\]"):
            run(pier, np.zeros(3), 0.01, 0.01, 2)
