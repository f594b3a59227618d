"""How fast it is: one table, measured in one run, beside OpenSees.

    railquake bench [--json]

Each rate is the best of several repetitions on one core.  The coupled rates are for a BART car on
a Berkeley pier under a strong synthetic motion, all measures and the energy audit on.
"""

from __future__ import annotations

import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any

from railquake.errors import InputError
from railquake.fem.pier import time_opensees_pier
from railquake.inputs.scenario import scenario
from railquake.march.compiler import lockstep_target
from railquake.run.assess import versions
from railquake.run.many import simulate_many
from railquake.run.simulate import simulate

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario

__all__ = ["print_bench", "run_bench"]

MOTION = {"seed": 18, "duration": "20 s", "pga": "1.0 g", "ground_frequency": "1.8 Hz"}
OPENSEES_STEPS = 20_000


def _case(**inputs: Any) -> Scenario:
    return scenario(synthetic={**MOTION, **inputs.pop("motion", {})}, **inputs)


def _rate(case: Scenario, repeats: int) -> tuple[float, float]:
    """Best and median steps per second of whole runs, compilation and assembly apart."""
    simulate(case)
    rates = []
    for _ in range(repeats):
        response = simulate(case)
        rates.append(response.steps / response.march_s)
    return max(rates), statistics.median(rates)


def _lockstep_rate(threads: int, repeats: int, motion: dict[str, Any], **inputs: Any) -> float:
    """Best steps per second of a batch, assembly included: two dozen scenarios to a lane."""
    count = 24 * lockstep_target().lanes * threads
    cases = [
        _case(motion={**motion, "seed": 18 + k}, scale=0.6 + 0.8 * k / count, **inputs)
        for k in range(count)
    ]
    list(simulate_many(cases[:1], threads=1))
    rates = []
    for _ in range(repeats):
        begin = time.perf_counter()
        steps = sum(row["steps"] for _, row in simulate_many(cases, threads=threads))
        rates.append(steps / (time.perf_counter() - begin))
    return max(rates)


def _opensees_rate(repeats: int, steps: int) -> float | None:
    case = _case()
    ground = case.ground_motion()
    try:
        spent = [
            time_opensees_pier(case.support, ground.acceleration, ground.dt, 5e-4, steps)  # type: ignore[arg-type]
            for _ in range(repeats)
        ]
    except InputError:  # not installed
        return None
    return steps / min(spent)


def _command_seconds(cache: str | None, repeats: int = 1, duration: str = "40 s") -> float:
    """Median wall time of ``railquake run`` in a process of its own, files and pictures written."""
    case = _case(motion={"duration": duration})
    environment = dict(os.environ)
    if cache is not None:
        environment["RAILQUAKE_CACHE_DIR"] = cache
    times = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "case.toml"
        path.write_text(case.to_toml())
        command = [sys.executable, "-m", "railquake", "run", str(path), "--out", f"{folder}/out"]
        for _ in range(repeats):
            begin = time.perf_counter()
            subprocess.run(command, env=environment, check=True, capture_output=True)
            times.append(time.perf_counter() - begin)
    return statistics.median(times)


def _import_seconds(repeats: int = 5) -> float:
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        subprocess.run([sys.executable, "-c", "import railquake"], check=True)
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()


def run_bench(*, repeats: int = 5, seconds: bool = True, short: bool = False) -> dict[str, Any]:
    """Measure everything.

    Parameters
    ----------
    repeats : int
        Runs of each kind, of which the best counts.
    seconds : bool
        Whether to time whole processes, too (a minute or so).
    short : bool
        One second of motion only, to see that it works.

    Returns
    -------
    dict
        Rates in steps per second by the names of ``--json``; None for what could not be measured.
    """
    motion = {"duration": "6 s"} if short else {}
    scalar, median = _rate(_case(motion=motion), repeats)
    elastic, _ = _rate(_case(motion=motion, hinge="elastic"), repeats)
    grid_motion = {"duration": "6 s"}
    grid, _ = _rate(_case(motion=grid_motion, contact="grid"), max(1, repeats // 2))
    lockstep = _lockstep_rate(1, max(1, repeats // 2), motion)
    two = _lockstep_rate(2, max(1, repeats // 2), motion)
    one_step = _lockstep_rate(1, max(1, repeats // 2), motion, substeps=1)
    opensees = _opensees_rate(max(1, repeats // 2), 500 if short else OPENSEES_STEPS)
    row: dict[str, Any] = {
        "scalar_steps_per_s": scalar,
        "scalar_median_steps_per_s": median,
        "lockstep_steps_per_s": lockstep,
        "lockstep_two_threads_steps_per_s": two,
        "lockstep_one_step_for_all_steps_per_s": one_step,
        "lockstep_over_scalar": lockstep / scalar,
        "two_threads_over_one": two / lockstep,
        "gpu_steps_per_s": None,
        "elastic_steps_per_s": elastic,
        "grid_steps_per_s": grid,
        "opensees_pier_steps_per_s": opensees,
        "scalar_over_opensees": None if opensees is None else scalar / opensees,
    }
    if seconds:
        with tempfile.TemporaryDirectory() as cache:
            row["first_result_s"] = _command_seconds(cache)
            row["warm_command_s"] = _command_seconds(cache, 3)
        row["import_s"] = _import_seconds()
    return {**row, "processor": _processor(), "versions": versions()}


RATES = (
    ("scalar_steps_per_s", "one run: Bouc-Wen, table contact, one core"),
    ("scalar_median_steps_per_s", "... median of the repetitions"),
    ("lockstep_steps_per_s", "many abreast, Bouc-Wen, one core"),
    ("lockstep_two_threads_steps_per_s", "... two threads"),
    ("lockstep_one_step_for_all_steps_per_s", "... one core, structure and bodies every step"),
    ("gpu_steps_per_s", "many on a GPU"),
    ("elastic_steps_per_s", "one run, elastic hinge"),
    ("grid_steps_per_s", "one run, Bouc-Wen, grid contact"),
    ("opensees_pier_steps_per_s", "OpenSees, the pier alone, its own Bouc-Wen"),
)
TIMES = (
    ("first_result_s", "first run of a 40 s motion, compiling included"),
    ("warm_command_s", "the same again, from command to files"),
    ("import_s", "import railquake, the interpreter's start included"),
)
MISSING = {
    "gpu_steps_per_s": "not measured (no GPU; railquake bench --device cuda where there is one)",
    "opensees_pier_steps_per_s": "not measured (pip install railquake[bench])",
}


def print_bench(row: dict[str, Any]) -> None:
    """Print the table of `run_bench`."""
    print(f"{row['processor']}, Python {platform.python_version()}")
    print(f"{'':50} {'million steps/s':>15} {'to one run':>11}")
    for key, text in RATES:
        value = row.get(key)
        if value is None:
            print(f"{text:50} {MISSING.get(key, 'not measured')}")
            continue
        ratio = value / row["scalar_steps_per_s"]
        print(f"{text:50} {1e-6 * value:15.3f} {ratio:11.3g}")
    print(f"{'':50} {'s':>15}")
    for key, text in TIMES:
        value = row.get(key)
        if value is not None:
            print(f"{text:50} {value:15.3g}")
