"""Many runs on a GPU: the simulator stands for one, and PTX is compiled without one."""

import json
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import railquake as rq
from railquake.bench import gpu as bench_gpu
from railquake.cli.commands import app
from railquake.march import compiler
from railquake.march.compiler import cuda
from railquake.run.many import simulate_many

TIMINGS = ("wall_s", "steps_per_s")
RELATIVE_ALREADY = (
    "energy_residual",
    "contact_energy_residual",
    "gravity_work_residual",
    "linear_momentum_residual",
    "angular_momentum_residual",
)


@pytest.fixture(scope="module")
def simulated():
    script = Path(__file__).resolve().parents[1] / "device_batch.py"
    done = subprocess.run(
        [sys.executable, str(script)],
        env={**os.environ, "NUMBA_ENABLE_CUDASIM": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_rows_from_the_simulated_gpu_are_those_of_the_cpu(simulated):
    assert len(simulated["cuda"]) == len(simulated["cpu"]) == 6
    for index, (row, known) in enumerate(zip(simulated["cuda"], simulated["cpu"], strict=True)):
        assert set(row) == set(known)
        for key in set(known) - set(TIMINGS):
            expected = known[key]
            if isinstance(expected, float):
                tolerance = {"abs": 1e-9} if key in RELATIVE_ALREADY else {"rel": 1e-9}
                expected = pytest.approx(expected, **tolerance)
            assert row[key] == expected, (index, key)


def test_that_batch_holds_impacts_and_uplifts_and_a_yielding_hinge(simulated):
    for row in simulated["cuda"]:
        assert row["off_rail_time_s"] > 0.0
        assert row["detached_time_s"] > 0.0
        assert row["uplifts"] >= 1
        assert row["impact_j"] > 0.0
        assert row["wheel_load_peak_n"] > 5.0 * row["wheel_load_static_n"]
    assert simulated["cuda"][5]["status"] == "onset"
    # the same motion on both hinges
    bouc_wen, elastic = simulated["cuda"][:2]
    assert bouc_wen["hinge_rotation_peak_rad"] > 1.2 * elastic["hinge_rotation_peak_rad"]


def test_a_motion_is_sent_once_and_its_room_is_used_again(simulated):
    motions = simulated["motions"]
    assert motions["rows"] == 2 * motions["rows_of_a_motion"]
    assert motions["shared"]
    assert motions["rows_later"] <= 8 * motions["rows_of_a_motion"]  # of 42 motions
    assert motions["still_there"]


def test_a_study_on_the_simulated_gpu_is_that_of_the_cpu(simulated):
    table, known = simulated["studies"]["cuda"], simulated["studies"]["cpu"]
    assert table["status"] == known["status"] and set(known["status"]) == {"safe"}
    for key in ("pbd_m", "wheel_load_peak_n"):
        assert len(set(known[key])) == 4
        assert table[key] == pytest.approx(known[key], rel=1e-9)


def test_the_kernel_compiles_for_a_gpu_that_is_not_there():
    system = rq.assemble(rq.scenario(synthetic={"seed": 3, "duration": "6 s"}))
    lanes = np.zeros(1, dtype=np.int64)
    arguments = (
        system.start.T.copy(), system.constants.T.copy(), system.geometry, system.drive,
        lanes, lanes, 10,
    )  # fmt: skip
    code = compiler.ptx(system.kernel(compiler.CUDA), arguments, (9, 0))
    assert ".target sm_90" in code
    assert code.count(".visible .entry") == 1
    assert code.count("fma.rn.f64") > 300
    assert ".local" in code  # the thread's own state
    assert "call" not in code.replace("callseq", "")  # all laws dissolved into the kernel


def test_without_numba_cuda_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "numba_cuda", None)
    with pytest.raises(rq.InputError, match=r"pip install railquake\[gpu\]"):
        simulate_many([], device="cuda")


@pytest.fixture
def no_gpu(monkeypatch):
    monkeypatch.setattr(cuda, "_import_cuda", lambda: SimpleNamespace(is_available=lambda: False))


def test_without_a_gpu_one_line_says_so(no_gpu):
    with pytest.raises(rq.InputError, match="no NVIDIA GPU") as caught:
        simulate_many([], device="cuda")
    assert "\n" not in str(caught.value)


def test_without_the_gpus_compiler_the_extra_is_named(no_gpu, monkeypatch):
    monkeypatch.setattr("numba.cuda.cudadrv.nvvm.is_available", lambda: False)
    with pytest.raises(rq.InputError, match=r"no compiler .* pip install railquake\[gpu\]"):
        simulate_many([], device="cuda")


def test_an_unknown_device_is_refused():
    with pytest.raises(rq.InputError, match='device: must be cpu or cuda, found "gpu"'):
        simulate_many([], device="gpu")


def test_the_benchmark_without_a_gpu_says_not_measured_and_is_no_error(no_gpu, capsys):
    with pytest.raises(SystemExit) as ended:
        app(["bench", "--device", "cuda", "--json"])
    assert not ended.value.code
    row = json.loads(capsys.readouterr().out)
    for key in ("gpu_steps_per_s", "gpu_steps_per_s_100000", "gpu_sample_deviation"):
        assert row[key] is None
    bench_gpu.print_bench_gpu(row)
    assert capsys.readouterr().out.startswith("GPU: not measured (no NVIDIA GPU")


def test_the_benchmark_measures_and_compares(monkeypatch, capsys):
    """The CPU in the GPU's place; nothing is timed."""
    on_device = []

    def on_cpu(cases, *, device="cpu", **options):
        on_device.append(device)
        return simulate_many(cases, **options)

    monkeypatch.setattr(bench_gpu, "simulate_many", on_cpu)
    monkeypatch.setattr(bench_gpu, "missing_for_cuda", lambda: None)
    monkeypatch.setattr(bench_gpu, "device_name", lambda: "none")
    row = bench_gpu.run_bench_gpu((2, 3), sample=2, dt="1e-4 s")
    assert on_device == ["cuda", "cpu", "cuda", "cuda", "cuda"]
    for key in ("gpu_steps_per_s", "gpu_steps_per_s_100000", "gpu_march_steps_per_s"):
        assert row[key] > 0.0
    assert row["gpu_sample_deviation"] == 0.0
    assert row["gpu_sample_same_status"]
    bench_gpu.print_bench_gpu(row)
    assert "100,000 scenarios" in capsys.readouterr().out
