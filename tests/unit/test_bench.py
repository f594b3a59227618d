"""The benchmark runs and names its figures; it is never timed here."""

import numpy as np
import pytest

from railquake import bench
from railquake.inputs._model import validated
from railquake.inputs.motion import read_motion
from railquake.inputs.presets import resolved_section
from railquake.inputs.support import Pier


def test_every_figure_has_its_name():
    row = bench.run_bench(repeats=1, seconds=False, short=True)
    for key in ("scalar_steps_per_s", "elastic_steps_per_s", "grid_steps_per_s"):
        assert row[key] > 0.0
    assert "opensees_pier_steps_per_s" in row
    assert row["processor"]


def test_the_pier_that_opensees_is_timed_with_is_ours(shared):
    """Peak and its time from the first lines of oracles/dyn_hinge.csv."""
    pytest.importorskip("opensees")
    section = resolved_section("support", {"preset": "bart-berkeley", "bouc_wen": {"m": 1.0}})
    motion = read_motion(shared / "records" / "paper_suite" / "RSN181_IMPVALLH1.AT2")
    top: list[float] = []
    bench.opensees_pier(
        validated(Pier, section, "support"), motion.acceleration, motion.dt, 5e-4, 13_000,
        gravity=9.81 / 9.80665, history=top.append,
    )  # fmt: skip
    peak = int(np.argmax(np.abs(top)))
    assert abs(top[peak]) == pytest.approx(0.0163325802, rel=1e-6)
    assert 5e-4 * (peak + 1) == pytest.approx(6.1265)
