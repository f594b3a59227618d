"""What a car with finite rotations, gravity and stops costs beside the paper's linear car.

    python benchmarks/cars.py          # a minute or two, more where nothing is compiled

Studies of one core, in turns in one process, so that a busy machine troubles both alike; CPU time
of a time step of one row, and the median of the ratios.  The bar is 0.8 of the linear car's rate.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from pathlib import Path
from typing import Any

import railquake as rq

CARS = ("bart", "bart-under-gravity")
SECONDS = 10
ROWS = 64


def nanoseconds(car: str) -> float:
    """CPU time of a time step of one row of a study abreast."""
    tables: dict[str, Any] = {
        "base": {
            "vehicle": {"preset": car},
            "support": {"preset": "bart-berkeley"},
            "wheelrail": {"preset": "bart"},
            "motion": {"synthetic": {"seed": 0, "duration": f"{SECONDS} s"}},
            "solver": {"substeps": 10},
        },
        "axes": {"motion.synthetic.seed": list(range(ROWS))},
    }
    with tempfile.TemporaryDirectory() as folder:
        begin = time.process_time()
        table = rq.Study.from_dict(tables).run(Path(folder) / "study", jobs=1)
        spent = time.process_time() - begin
    assert not (table["status"] == "failed").any()
    return spent / (ROWS * SECONDS / float(table["dt_s"].iloc[0])) * 1e9


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    for car in CARS:
        nanoseconds(car)  # compiles or loads the kernels
    pairs = [tuple(nanoseconds(car) for car in CARS) for _ in range(rounds)]
    for car, found in zip(CARS, zip(*pairs, strict=True), strict=True):
        print(f"{car:20} {statistics.median(found):7.1f} ns a step")
    print(f"rate over the linear car's: {statistics.median(a / b for a, b in pairs):.3f}")


if __name__ == "__main__":
    main()
