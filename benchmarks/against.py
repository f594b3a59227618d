"""How fast this working tree is beside a former commit: CPU time, both taking turns.

    python benchmarks/against.py 8dd65a1              # some minutes, of which two compile
    python benchmarks/against.py HEAD~1 --rounds 11

Each of the two is a process of its own with an empty cache, told in turn to do the same work, so
that a busy machine troubles them alike; only public names are used, so that older commits can be
measured.  What is printed are medians, and the median of the ratios of each round.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
ROWS = 64  # of a study abreast
SECONDS = 10  # of motion


def scenario(seed: int) -> dict[str, Any]:
    """A train on the Berkeley pier under a synthetic motion."""
    return {
        "vehicle": {"preset": "bart"},
        "support": {"preset": "bart-berkeley"},
        "wheelrail": {"preset": "bart"},
        "motion": {"synthetic": {"seed": seed, "duration": f"{SECONDS} s"}},
    }


def single() -> float:
    """CPU nanoseconds of a time step of one run."""
    import railquake as rq

    begin = time.process_time()
    response = rq.simulate(rq.scenario(synthetic=scenario(21)["motion"]["synthetic"]))
    return (time.process_time() - begin) / response.steps * 1e9


def abreast(substeps: int) -> float:
    """CPU nanoseconds of a time step of one row of a study."""
    import railquake as rq

    tables = {
        "base": {**scenario(0), "solver": {"substeps": substeps}},
        "axes": {"motion.synthetic.seed": list(range(ROWS))},
    }
    with tempfile.TemporaryDirectory() as folder:
        begin = time.process_time()
        table = rq.Study.from_dict(tables).run(Path(folder) / "study", jobs=1)
        spent = time.process_time() - begin
    return spent / (len(table) * SECONDS / float(table["dt_s"].iloc[0])) * 1e9


WORK: dict[str, Callable[[], float]] = {
    "single": single,
    "abreast, one step for all": lambda: abreast(1),
    "abreast, ten substeps": lambda: abreast(10),
}
SHARING = (["single"], ["abreast, one step for all", "abreast, ten substeps"])  # what is compiled


def serve() -> None:
    """Do what is asked, a line each; the first time, nothing is compiled yet."""
    for line in sys.stdin:
        begin = time.process_time()
        rate = WORK[line.rstrip("\n")]()
        print(rate, time.process_time() - begin, flush=True)


class Side:
    """One of the two source trees, in a process of its own with an empty cache."""

    def __init__(self, source: Path, cache: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, __file__, "--serve"],
            env={**os.environ, "PYTHONPATH": str(source), "RAILQUAKE_CACHE_DIR": cache},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def ask(self, work: str) -> tuple[float, float]:
        """Nanoseconds of a step, and seconds of all."""
        assert self.process.stdin is not None and self.process.stdout is not None
        self.process.stdin.write(work + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline()
        if not answer:
            sys.exit("a process ended early: what it printed stands above")
        rate, seconds = answer.split()
        return float(rate), float(seconds)


def compare(revision: str, rounds: int) -> None:
    """Print what both took."""
    with tempfile.TemporaryDirectory() as folder:
        former = Path(folder) / "former"
        subprocess.run(["git", "clone", "--quiet", str(ROOT), str(former)], check=True)
        subprocess.run(["git", "-C", str(former), "checkout", "--quiet", revision], check=True)
        for group in SHARING:
            with tempfile.TemporaryDirectory() as one, tempfile.TemporaryDirectory() as other:
                take_turns(Side(former / "src", one), Side(ROOT / "src", other), group, rounds)


def take_turns(old: Side, new: Side, group: list[str], rounds: int) -> None:
    """Print what the first time took, most of it to compile, then what a step takes."""
    say("the first time, compiling", "s", [(old.ask(group[0])[1], new.ask(group[0])[1])])
    for work in group:
        old.ask(work), new.ask(work)
        say(work, "ns", [(old.ask(work)[0], new.ask(work)[0]) for _ in range(rounds)])


def say(what: str, unit: str, pairs: list[tuple[float, float]]) -> None:
    """Print medians of both, and of their ratio."""
    a, b = (statistics.median(side) for side in zip(*pairs, strict=True))
    ratio = statistics.median(b / a for a, b in pairs)
    print(f"{what:27} {a:8.1f} {unit:2}  now {b:8.1f} {unit:2}  ratio {ratio:.3f}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("revision", nargs="?", help="the commit to be beside")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--serve", action="store_true", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.serve:
        serve()
    elif arguments.revision is None:
        parser.error("a commit is needed, such as HEAD~1")
    else:
        compare(arguments.revision, arguments.rounds)


if __name__ == "__main__":
    main()
