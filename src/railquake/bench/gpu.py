"""How fast a GPU is: thousands of scenarios of ten seconds, and a sample of them on the CPU.

    railquake bench --device cuda [--json]

A BART car on a Berkeley pier with a Bouc-Wen hinge, all measures and the energy audit on, a million
steps a scenario; `MOTIONS` times `SCALES` distinct scenarios, over and over.
"""

from __future__ import annotations

import platform
import time
from collections.abc import Iterator
from itertools import cycle, islice
from typing import TYPE_CHECKING, Any

from railquake.inputs.scenario import scenario
from railquake.march.compiler import device_name, missing_for_cuda
from railquake.run.assess import versions
from railquake.run.many import simulate_many

if TYPE_CHECKING:
    from railquake.inputs.scenario import Scenario

__all__ = ["print_bench_gpu", "run_bench_gpu"]

MOTION = {"pga": "1.0 g", "ground_frequency": "2.5 Hz", "highpass_frequency": "1.2 Hz"}
MOTIONS = 8
SCALES = 64
COUNTS = (10_000, 100_000)
SAMPLE = 16
COMPARED = (
    "pbd_m",
    "pbv_m_s",
    "pba_m_s2",
    "hinge_rotation_peak_rad",
    "uplift_ratio",
    "lateral_shift_peak_m",
    "energy_dissipated_j",
)


def run_bench_gpu(
    counts: tuple[int, int] = COUNTS, *, sample: int = SAMPLE, **inputs: Any
) -> dict[str, Any]:
    """Measure the GPU.

    Parameters
    ----------
    counts : (int, int)
        Scenarios of the two measurements.
    sample : int
        Scenarios that are compared with the CPU.
    **inputs
        Inputs of the scenarios to change.

    Returns
    -------
    dict
        By the names of ``--json``, all None where no GPU can be used:

        ``gpu_steps_per_s``, ``gpu_steps_per_s_100000``
            Scenario-steps over the time of the whole call, assembly and rows included.
        ``gpu_march_steps_per_s``
            The same steps as in the first over the time that they marched, transfers included.
        ``gpu_sample_deviation``
            Largest relative deviation of the measures `COMPARED` from the CPU's.
        ``gpu_sample_same_status``
            Whether all of the sample ended alike.
    """
    row: dict[str, Any] = {
        "gpu": None,
        "gpu_steps_per_s": None,
        "gpu_steps_per_s_100000": None,
        "gpu_march_steps_per_s": None,
        "gpu_sample_deviation": None,
        "gpu_sample_same_status": None,
        "gpu_missing": missing_for_cuda(),
        "versions": versions(),
    }
    if row["gpu_missing"] is not None:
        return row
    cases = [_case(seed, inputs) for seed in range(MOTIONS)]
    cases = [
        case.with_changes({"motion.scale": 0.6 + 0.8 * k / SCALES})
        for k in range(SCALES)
        for case in cases
    ]
    rows = dict(simulate_many(cases[:sample], device="cuda"))  # compiles, too
    few, many = counts
    deviation, same = _compare(cases[:sample], rows)
    row |= {
        "gpu": device_name(),
        "gpu_steps_per_s": _rate(_repeated(cases, few)),
        "gpu_steps_per_s_100000": _rate(_repeated(cases, many)),
        "gpu_march_steps_per_s": _march_rate(_repeated(cases, few)),
        "gpu_sample_deviation": deviation,
        "gpu_sample_same_status": same,
    }
    return row


def _case(seed: int, inputs: dict[str, Any]) -> Scenario:
    motion = {**MOTION, "duration": "10 s", "seed": seed}
    return scenario(synthetic=motion, **inputs)


def _repeated(cases: list[Scenario], count: int) -> Iterator[Scenario]:
    return islice(cycle(cases), count)


def _rate(cases: Iterator[Scenario]) -> float:
    begin = time.perf_counter()
    steps = sum(row["steps"] for _, row in simulate_many(cases, device="cuda"))
    return float(steps / (time.perf_counter() - begin))


def _march_rate(cases: Iterator[Scenario]) -> float:
    """On one thread, so that no two batches march at once and their times can be added."""
    steps = 0
    spent = 0.0
    for _, row in simulate_many(cases, device="cuda", threads=1):
        steps += row["steps"]
        spent += row["steps"] / row["steps_per_s"]
    return steps / spent


def _compare(cases: list[Scenario], rows: dict[int, Any]) -> tuple[float, bool]:
    deviation = 0.0
    same = True
    for index, known in simulate_many(cases):
        row = rows[index]
        same = same and row["status"] == known["status"]
        for key in COMPARED:
            deviation = max(deviation, abs(row[key] - known[key]) / max(abs(known[key]), 1e-12))
    return deviation, same


ROWS = (
    ("gpu_steps_per_s", "10,000 scenarios of 10 s", "million scenario-steps/s"),
    ("gpu_steps_per_s_100000", "100,000 scenarios of 10 s", "million scenario-steps/s"),
    ("gpu_march_steps_per_s", "... marching alone", "million scenario-steps/s"),
)


def print_bench_gpu(row: dict[str, Any]) -> None:
    """Print the table of `run_bench_gpu`."""
    if row["gpu_missing"] is not None:
        print(f"GPU: not measured ({row['gpu_missing']})")
        return
    print(f"{row['gpu']}, Python {platform.python_version()}")
    for key, text, unit in ROWS:
        print(f"{text:50} {1e-6 * row[key]:15.3f} {unit}")
    text = "largest deviation of a sample from the CPU"
    print(f"{text:50} {row['gpu_sample_deviation']:15.3g}")
    if not row["gpu_sample_same_status"]:
        print("NOT all of the sample ended as on the CPU")
