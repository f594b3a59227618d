"""Many runs in lockstep: each gives its own row, whatever runs beside it."""

import os
import platform
import re
import subprocess
import sys

import numpy as np
import pytest

import railquake as rq
from railquake.assembly.system import System
from railquake.march.compiler import lockstep_target, vector_doubles, vector_instructions
from railquake.march.compiler.bind import _bind_cached
from railquake.run import many

SHORT = {"seed": 3, "duration": "2 s", "pga": "0.6 g", "highpass_frequency": "0.6 Hz"}
TIMINGS = ("wall_s", "steps_per_s", "versions")


def mixed():
    """Twelve scenarios of all kinds: more than a batch has lanes."""
    strong = {**SHORT, "pga": "1.5 g", "duration": "3 s", "dt": "0.004 s"}
    return [
        rq.scenario(synthetic=SHORT),
        rq.scenario(synthetic=strong),
        rq.scenario(synthetic=SHORT, hinge="elastic"),
        rq.scenario(synthetic={**strong, "seed": 4}, speed="0.01 km/h"),
        rq.scenario(synthetic=SHORT, coupled=False),
        rq.scenario(synthetic=SHORT, support="at-grade"),
        rq.scenario(synthetic={**SHORT, "seed": 5}, vehicle="bart-2023-runs"),
        rq.scenario(synthetic={**SHORT, "duration": "1.8 s"}, speed="240 km/h"),
        rq.scenario(synthetic=SHORT, support={"preset": "bart-berkeley", "length": "8 m"}),
        rq.scenario(synthetic=SHORT, scale=2.0),
        rq.scenario(synthetic=SHORT, scale=-1.0, hinge="elastic"),
        rq.scenario(synthetic=strong, vehicle="bart-under-gravity"),
    ]


def untimed(row):
    return {key: value for key, value in row.items() if key not in TIMINGS}


@pytest.fixture(scope="module")
def rows():
    return dict(rq.simulate_many(mixed(), threads=2))


def test_every_scenario_has_one_row(rows):
    assert sorted(rows) == list(range(12))
    assert {row["status"] for row in rows.values()} <= {"safe", "onset", "derailed"}


def test_a_row_does_not_depend_on_its_neighbours(rows):
    backwards = dict(rq.simulate_many(mixed()[::-1], threads=1))
    for index, row in rows.items():
        assert untimed(backwards[11 - index]) == untimed(row)
    alone = dict(rq.simulate_many(mixed()[1:2], threads=1))
    assert untimed(alone[0]) == untimed(rows[1])


def test_a_run_that_diverges_ends_with_that_frame_whatever_its_neighbours():
    hopeless = rq.scenario(synthetic=SHORT, scale=100.0, allow_high_pga=True)
    brief = rq.scenario(synthetic={**SHORT, "duration": "0.9 s", "highpass_frequency": "1.3 Hz"})
    alone = dict(rq.simulate_many([hopeless], threads=1))[0]
    assert alone["status"] == "diverged"
    assert untimed(dict(rq.simulate_many([brief, hopeless], threads=1))[1]) == untimed(alone)
    single = rq.assess(rq.simulate(hopeless))
    assert single["status"] == "diverged"
    assert single["steps"] == alone["steps"]
    assert 0.0 < alone["steps"] * alone["dt_s"] < 1.0


def test_rows_are_those_of_single_runs(rows):
    for index, case in enumerate(mixed()):
        single = rq.assess(rq.simulate(case))
        assert set(single) == set(rows[index])
        assert single["status"] == rows[index]["status"]
        assert single["steps"] == rows[index]["steps"]
        for key in ("pbd_m", "pbv_m_s", "pba_m_s2", "hinge_rotation_peak_rad"):
            assert rows[index][key] == pytest.approx(single[key], rel=3e-3), (index, key)
        assert rows[index]["uplift_ratio"] == pytest.approx(single["uplift_ratio"], rel=0.02)
        for key in ("flange_contact_first_s", "uplift_first_s"):
            assert rows[index][key] == pytest.approx(single[key], abs=2e-3), (index, key)
        assert abs(rows[index]["energy_residual"]) < 1e-3
        for row in (single, rows[index]):
            assert row["linear_momentum_residual"] < 1e-4, index
            assert row["angular_momentum_residual"] < 1e-4, index
            assert abs(row["gravity_work_residual"]) < 1e-9, index


def test_an_impossible_scenario_is_a_row_and_the_others_finish():
    cases = mixed()[:2]
    cases.insert(1, cases[0].with_changes({"solver.dt": "4.9e-4 s"}))
    rows = dict(rq.simulate_many(cases, threads=1))
    assert rows[1]["status"] == "failed"
    assert "solver.dt" in rows[1]["error"]
    assert rows[0]["status"] == rows[2]["status"] == "safe"


@pytest.mark.parametrize("stage", ["assemble", "assess"])
def test_an_unforeseen_fault_is_a_row_and_the_others_finish(monkeypatch, stage):
    real = getattr(many, stage)
    met = []

    def faulty(given):
        met.append(given)
        if len(met) == 2:
            raise ZeroDivisionError("nobody\nforesaw this")
        return real(given)

    monkeypatch.setattr(many, stage, faulty)
    rows = dict(rq.simulate_many(mixed()[:3], threads=1))
    status = [row["status"] for row in rows.values()]
    assert sorted(status) == ["failed", "safe", "safe"]
    error = next(row["error"] for row in rows.values() if row["status"] == "failed")
    assert error == "unexpected: ZeroDivisionError: nobody foresaw this"


def test_the_grid_method_is_run_by_the_single_engine():
    case = rq.scenario(synthetic={**SHORT, "duration": "1.7 s", "dt": "0.01 s"}, contact="grid")
    rows = dict(rq.simulate_many([case], threads=1))
    assert untimed(rows[0]) == untimed(rq.assess(rq.simulate(case)))


def test_scenarios_are_drawn_as_they_are_needed_and_leaving_early_is_fine():
    drawn = []

    def endless():
        while True:
            drawn.append(1)
            yield rq.scenario(synthetic=SHORT)

    results = rq.simulate_many(endless(), threads=2)
    assert next(results)[1]["status"] == "safe"
    results.close()
    assert len(drawn) < 200


def test_what_is_slow_takes_longer_steps_at_next_to_no_loss():
    """Without the hinge's first-order step, that is."""
    cases = [
        rq.scenario(synthetic={**SHORT, "pga": "1.2 g"}, hinge="elastic", speed=speed)
        for speed in ("80 km/h", "0.01 km/h")
    ]
    assert [rq.assemble(case).with_substeps(10).substeps for case in cases] == [10, 2]
    longer = dict(rq.simulate_many(cases, threads=1))
    all_alike = [case.with_changes({"solver.substeps": 1}) for case in cases]
    together = dict(rq.simulate_many(all_alike, threads=1))
    for k in range(2):
        assert longer[k]["status"] == together[k]["status"]
        assert longer[k]["steps"] == together[k]["steps"]
        for key in ("pbd_m", "pbv_m_s", "pba_m_s2", "wheel_load_peak_n", "uplift_ratio"):
            assert longer[k][key] == pytest.approx(together[k][key], rel=1e-4), (k, key)
        assert longer[k]["energy_residual"] == pytest.approx(0.0, abs=1e-5)
        assert longer[k]["contact_energy_residual"] == pytest.approx(
            together[k]["contact_energy_residual"], abs=3e-3
        )


@pytest.mark.parametrize("wrong", [{"threads": 0}, {"refresh_steps": 0}])
def test_numbers_below_one_are_refused(wrong):
    with pytest.raises(rq.InputError, match="at least 1"):
        rq.simulate_many([], **wrong)


def test_an_error_in_the_callers_scenarios_reaches_the_caller():
    def broken():
        yield rq.scenario(synthetic=SHORT)
        raise ValueError("mine")

    with pytest.raises(ValueError, match="mine"):
        list(rq.simulate_many(broken(), threads=1))


def test_compiled_code_uses_wide_vectors(tmp_path, monkeypatch):
    """The speed rests on it, and a stray branch in a stage silently loses it."""
    doubles = vector_doubles()
    assert doubles > 1
    monkeypatch.setenv("RAILQUAKE_CACHE_DIR", str(tmp_path))  # compile here and now
    _bind_cached.cache_clear()
    system: System = rq.assemble(rq.scenario(synthetic=SHORT))
    try:
        target = lockstep_target()
        made = system.kernel(target).call
        lanes = np.zeros(target.lanes, dtype=np.int64)
        made(
            np.repeat(system.start, target.lanes, axis=1),
            np.repeat(system.constants, target.lanes, axis=1),
            system.geometry, system.drive, (lanes, lanes), 0, target.lanes, 10,
        )  # fmt: skip
        code = next(iter(made.inspect_asm().values()))
    finally:
        _bind_cached.cache_clear()
    # two vectors of two doubles do what one of four does
    assert vector_instructions(code, doubles) > 1500
    if doubles == 4:
        # a store of single lanes is slow: a frame may have some, the peaks of every step none
        single = re.findall(r"^\tvmaskmovpd\t.*\)\s*$", code, re.MULTILINE)
        assert len(single) < 13


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="names of x86 processors")
@pytest.mark.parametrize(
    ("processor", "doubles"),
    [
        ("generic", 2),
        ("x86-64-v3", 4),
        ("skylake-avx512", 8),  # LLVM by itself would keep to 256 bits
        ("icelake-server", 8),
        ("znver3", 4),
        ("znver4", 8),
    ],
)
def test_lanes_are_as_many_as_the_compilers_own_vectors_hold(processor, doubles):
    assert asked({"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": ""}).stdout.split() == [
        str(doubles), str(max(doubles, 4))
    ]  # fmt: skip


@pytest.mark.skipif(platform.machine() not in ("x86_64", "AMD64"), reason="names of x86 processors")
def test_vectors_can_be_kept_to_256_bits():
    named = {"NUMBA_CPU_NAME": "skylake-avx512", "NUMBA_CPU_FEATURES": ""}
    assert asked({**named, "RAILQUAKE_VECTOR_BITS": "256"}).stdout.split() == ["4", "4"]
    refused = asked({**named, "RAILQUAKE_VECTOR_BITS": "1024"})
    assert "RAILQUAKE_VECTOR_BITS is '1024'; it can be 256 or 512" in refused.stderr


def asked(environment):
    """Doubles in a vector, and lanes, in a process with such an environment."""
    program = (
        "from railquake.march.compiler import lockstep_target, vector_doubles;"
        "print(vector_doubles(), lockstep_target().lanes)"
    )
    return subprocess.run(
        [sys.executable, "-c", program],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )


def test_one_by_one_is_the_single_engine():
    cases = mixed()[:2]
    rows = dict(rq.simulate_many(cases, threads=1, hinge_solve="newton"))
    for index, case in enumerate(cases):
        assert untimed(rows[index]) == untimed(rq.assess(rq.simulate(case)))
    with pytest.raises(rq.InputError, match="hinge_solve"):
        rq.simulate_many([], hinge_solve="euler")
