"""How a study's cost grows: rows per second, one and two threads, and memory.

    python benchmarks/study_scaling.py            # 1,000 and 10,000 rows; some minutes
    python benchmarks/study_scaling.py --memory   # 100,000 rows as well; half an hour or more

Motions of one second, 101 samples.  Ratios are of the same execution: the two sizes and the two
numbers of threads take turns, so that a busy machine troubles them alike.
"""

from __future__ import annotations

import argparse
import resource
import shutil
import statistics
import tempfile
import time
from pathlib import Path
from typing import Any

import railquake as rq

MOTION = {"duration": "1 s", "dt": "0.01 s", "pga": "0.6 g", "highpass_frequency": "1.2 Hz"}


def study(rows: int, dt: str) -> rq.Study:
    """A study of motions from seeds, at two speeds with two hinges."""
    tables: dict[str, Any] = {
        "base": {
            "vehicle": {"preset": "bart"},
            "support": {"preset": "bart-berkeley"},
            "wheelrail": {"preset": "bart"},
            "motion": {"synthetic": {**MOTION, "seed": 0}},
            "solver": {"dt": dt},
        },
        "axes": {
            "motion.synthetic.seed": list(range(rows // 4)),
            "vehicle.speed": ["80 km/h", "240 km/h"],
            "support.hinge": ["elastic", "bouc-wen"],
        },
    }
    return rq.Study.from_dict(tables)


def seconds(rows: int, jobs: int, dt: str) -> float:
    """Wall time of a study."""
    folder = Path(tempfile.mkdtemp())
    begin = time.perf_counter()
    try:
        table = study(rows, dt).run(folder / "study", jobs=jobs)
    finally:
        shutil.rmtree(folder)
    assert len(table) == rows and not (table["status"] == "failed").any()
    return time.perf_counter() - begin


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=1000, help="the smaller study")
    parser.add_argument("--dt", default="1e-5 s", help="time step")
    parser.add_argument("--rounds", type=int, default=3, help="of the smaller study")
    parser.add_argument("--memory", action="store_true", help="100 times as many rows, too")
    arguments = parser.parse_args()
    rows, dt = arguments.rows, arguments.dt
    seconds(32, 2, dt)  # compiles or loads the kernels, builds the contact table
    one, two = [], []
    for _ in range(arguments.rounds):
        one.append(seconds(rows, 1, dt) / rows)
        two.append(seconds(rows, 2, dt) / rows)
    ten = seconds(10 * rows, 2, dt) / (10 * rows)
    two.append(seconds(rows, 2, dt) / rows)
    a, b = statistics.median(one), statistics.median(two)
    print(f"{rows:7} rows, one thread:  {1.0 / a:8.1f} rows/s")
    print(f"{rows:7} rows, two threads: {1.0 / b:8.1f} rows/s, {a / b:.2f} times one")
    print(f"{10 * rows:7} rows, two threads: {1.0 / ten:8.1f} rows/s, {ten / b:.3f} per row")
    if arguments.memory:
        many = seconds(100 * rows, 2, dt) / (100 * rows)
        print(f"{100 * rows:7} rows, two threads: {1.0 / many:8.1f} rows/s, {many / b:.3f} per row")
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    print(f"peak memory of this process {peak:.0f} MB")


if __name__ == "__main__":
    main()
