"""Whether vectors of 512 bits pay on this processor: a study abreast with them and with 256.

    python benchmarks/vector_width.py          # some minutes: each width compiles its own kernel

Both take turns, each in a process of its own, on one core; CPU time of a time step of one row, the
least of each process, and the median of the ratios.  Where 256 bits are faster, set
RAILQUAKE_VECTOR_BITS=256.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time

WIDTHS = ("256", "512")
SECONDS = 10
ROWS = 8
STEP = 1e-5


def nanoseconds() -> float:
    """Least CPU time of a time step of one row in four batches."""
    import railquake as rq

    scenarios = [
        rq.scenario(
            synthetic={"seed": 18, "duration": f"{SECONDS} s"}, scale=1.5 + 0.1 * k, dt=STEP
        )
        for k in range(ROWS)
    ]
    spent = []
    for _ in range(5):  # the first compiles or loads
        begin = time.process_time()
        list(rq.simulate_many(scenarios, threads=1))
        spent.append(time.process_time() - begin)
    return min(spent[1:]) / (ROWS * SECONDS / STEP) * 1e9


def in_a_process(bits: str, cache: str) -> float:
    """The same in a process whose vectors are so wide."""
    given = {"RAILQUAKE_VECTOR_BITS": bits, "RAILQUAKE_CACHE_DIR": cache}
    found = subprocess.run(
        [sys.executable, __file__, "--once"],
        env={**os.environ, **given},
        capture_output=True,
        text=True,
        check=True,
    )
    return float(found.stdout)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--once", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.once:
        print(nanoseconds())
        return
    with tempfile.TemporaryDirectory() as cache:
        pairs = [
            tuple(in_a_process(bits, cache) for bits in WIDTHS) for _ in range(arguments.rounds)
        ]
    for bits, found in zip(WIDTHS, zip(*pairs, strict=True), strict=True):
        print(f"{bits} bits {statistics.median(found):7.1f} ns a step")
    print(f"time with 512 over time with 256: {statistics.median(b / a for a, b in pairs):.3f}")


if __name__ == "__main__":
    main()
