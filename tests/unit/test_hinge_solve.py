"""`solver.hinge_solve`: left out, as suits the engine; named, the same on every one."""

from dataclasses import replace

import numpy as np
import pytest

import railquake as rq
from railquake.march.compiler import PYTHON
from railquake.physics.hinge import bouc_wen
from railquake.run import many

TIMINGS = ("wall_s", "steps_per_s", "versions")
YIELDING = {"seed": 3, "duration": "3 s", "pga": "1 g", "highpass_frequency": "0.6 Hz"}


def case(**solver):
    return rq.scenario(synthetic=YIELDING, **solver)


def told(row):
    """A row but for what no run repeats."""
    return {key: value for key, value in row.items() if key not in TIMINGS}


@pytest.fixture(scope="module")
def alone():
    """Rows of the case by itself, by what it says."""
    return {
        how: rq.assess(rq.simulate(case() if how is None else case(hinge_solve=how)))
        for how in (None, "newton", "linearised")
    }


def test_the_hinge_yields(alone):
    """Else nothing would be solved here."""
    row = alone[None]
    elastic = case().support.bouc_wen.k0 * row["hinge_rotation_peak_rad"]
    assert row["base_moment_peak_n_m"] < 0.9 * elastic


def test_a_run_by_itself_iterates_unless_told_otherwise(alone):
    assert told(alone[None]) == told(alone["newton"])
    assert told(alone[None]) != told(alone["linearised"])


def test_one_correction_is_within_what_is_documented(alone):
    """docs/sensitivity.md: below 1e-4 % of PBD and PBV."""
    for key in ("pbd_m", "pbv_m_s", "hinge_rotation_peak_rad"):
        assert alone["linearised"][key] == pytest.approx(alone["newton"][key], rel=1e-6)
    for key in ("uplift_ratio", "wheel_load_peak_n", "lateral_force_filtered_peak_n"):
        assert alone["linearised"][key] == pytest.approx(alone["newton"][key], rel=1e-4)


def test_newton_named_gives_among_many_the_row_of_a_run_by_itself(alone):
    rows = dict(rq.simulate_many([case(), case(hinge_solve="newton"), case()], threads=1))
    assert told(rows[1]) == told(alone["newton"])
    assert told(rows[0]) == told(rows[2]) != told(rows[1])


def test_linearised_named_goes_abreast_like_nothing_named(alone):
    rows = dict(rq.simulate_many([case(), case(hinge_solve="linearised")], threads=1))
    assert told(rows[0]) == told(rows[1])
    assert rows[0]["substeps"] > alone["linearised"]["substeps"] == 1


@pytest.mark.parametrize(
    ("how", "law"),
    [(None, bouc_wen.advance), ("newton", bouc_wen.advance),
     ("linearised", bouc_wen.advance_linearised)],
)  # fmt: skip
def test_what_stands_in_the_slot_of_a_run_by_itself(how, law):
    system = rq.assemble(case() if how is None else case(hinge_solve=how))
    march = system.kernel(PYTHON).call
    step = march.__globals__["run_frame"].__globals__["step"]
    moved = step.__globals__["advance_structure"].__globals__["move_structure"]
    assert moved.__globals__["advance"].__code__ is law.__code__


@pytest.mark.parametrize(("how", "by_itself"), [(None, 0), ("linearised", 0), ("newton", 1)])
def test_only_newton_is_run_by_itself(monkeypatch, how, by_itself):
    """Of a study, too, whose engine is this one."""
    system = rq.assemble(case() if how is None else case(hinge_solve=how))
    short = rq.simulate(replace(system, drive=system.drive[:3]))
    called = []

    def simulate(of):
        called.append(of)
        return short

    monkeypatch.setattr(many, "simulate", simulate)
    row = dict(rq.simulate_many([system.scenario], threads=1))[0]
    assert len(called) == by_itself
    assert np.isfinite(row["pbd_m"])
