"""The paper's suite with other cars: whether its runs end well, and alike.

    python tools/suite.py --records FOLDER                 all cars, abreast: make suite
    python tools/suite.py --records FOLDER --halved        and with half the time step
    python tools/suite.py --records FOLDER --single        and by themselves
    python tools/suite.py --records FOLDER --only manchester

Twenty records at four hazard levels (50, 10, 5 and 2 % in 50 years), elastic and Bouc-Wen on the
pier, 160 runs a car; `manchester` runs on S1002 and 60E1, at grade as well.  Says of each set how
its runs ended, by level and mode, how far the balances are from closing, and which end otherwise
with half the step or by themselves.

Ends with 1 if a run diverged, a balance is out of bounds, or more than 2 % end otherwise.
"""

from __future__ import annotations

import argparse
import csv
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import railquake as rq

LEVELS = {0.21: "50 %", 0.74: "10 %", 1.0: "5 %", 1.38: "2 %"}
HINGES = ("elastic", "bouc-wen")
STEP = 1e-5  # s
CONTACT_GAIN = 0.01  # of all that is dissipated
MOMENTUM = 1e-4  # of the largest impulse
OTHERWISE = 0.02  # of the runs

SETS: dict[str, dict[str, Any]] = {
    "bart": {"vehicle": "bart"},
    "bart-under-gravity": {"vehicle": "bart-under-gravity"},
    "manchester": {"vehicle": "manchester", "wheelrail": "s1002-60e1"},
    "manchester at grade": {
        "vehicle": "manchester", "wheelrail": "s1002-60e1", "support": "at-grade",
    },
}  # fmt: skip


def factors(records: Path) -> dict[str, float]:
    """The study's factor of each record, by its file, for 5 % in 50 years."""
    with open(records / "manifest.csv", newline="", encoding="utf-8") as file:
        return {row["file"]: float(row["scale_factor"]) for row in csv.DictReader(file)}


def cases(records: Path, changes: dict[str, Any], step: float) -> dict[tuple[str, float, str], Any]:
    """The set's scenarios by record, level and hinge."""
    hinges = ("",) if "support" in changes else HINGES
    return {
        (Path(name).stem, level, hinge): rq.scenario(
            record=records / name, scale=level * factor, dt=step,
            **({"hinge": hinge} if hinge else {}), **changes,
        )
        for name, factor in factors(records).items()
        for level in LEVELS
        for hinge in hinges
    }  # fmt: skip


def abreast(scenarios: dict[Any, Any]) -> dict[Any, dict[str, Any]]:
    """Rows of all, in lockstep."""
    keys = list(scenarios)
    return {keys[k]: row for k, row in rq.simulate_many(scenarios.values())}


def by_themselves(scenarios: dict[Any, Any]) -> dict[Any, dict[str, Any]]:
    """Rows of all, each run alone, two at a time."""
    with ThreadPoolExecutor(2) as pool:
        rows = pool.map(lambda case: rq.assess(rq.simulate(case)), scenarios.values())
        return dict(zip(scenarios, rows, strict=True))


def ending(row: dict[str, Any]) -> str:
    """Status, and the mode without its side."""
    mode = row.get("derailment_mode")
    return str(mode).split()[0] if mode else str(row["status"])


def tell(name: str, rows: dict[Any, dict[str, Any]], seconds: float) -> list[str]:
    """Print how a set's runs ended; what is out of bounds."""
    print(f"\n{name}: {len(rows)} runs in {seconds:.0f} s")
    for level, said in LEVELS.items():
        ends = Counter(ending(row) for key, row in rows.items() if key[1] == level)
        lifted = sum(row["off_rail_time_s"] > 0.0 for key, row in rows.items() if key[1] == level)
        listed = ", ".join(f"{count} {what}" for what, count in sorted(ends.items()))
        print(f"  {said:5} in 50 years: {listed}; wheels lift in {lifted}")
    beyond = [row for row in rows.values() if row["beyond_model"]]
    for reason, count in Counter(row["beyond_model"] for row in beyond).items():
        print(f"  beyond the model in {count}: {reason}")
    out = []
    for key, row in rows.items():
        if row["status"] not in ("safe", "onset", "derailed"):
            out.append(f"{name} {key}: {row['status']} {row.get('error', '')}")
            continue
        if row["contact_gain"] > CONTACT_GAIN:
            out.append(
                f"{name} {key}: the contact gains {row['contact_gain']:.2%} of what is dissipated"
            )
        for measure in ("linear_momentum_residual", "angular_momentum_residual"):
            if abs(row[measure]) > MOMENTUM:
                out.append(f"{name} {key}: {measure} {row[measure]:.1e}")
    worst = {
        measure: max(abs(row[measure]) for row in rows.values() if row["status"] != "failed")
        for measure in (
            "energy_residual", "contact_gain", "linear_momentum_residual",
            "angular_momentum_residual", "gravity_work_residual",
        )
    }  # fmt: skip
    print("  largest residuals: " + ", ".join(f"{m} {v:.1e}" for m, v in worst.items()))
    return out


def compare(name: str, how: str, rows: dict[Any, Any], others: dict[Any, Any]) -> list[str]:
    """Print which runs end otherwise; what is out of bounds."""
    differing = [key for key in rows if ending(rows[key]) != ending(others[key])]
    print(f"  {how}: {len(differing)} of {len(rows)} end otherwise")
    for key in differing:
        one, other = rows[key], others[key]
        print(f"    {key}: {ending(one)} -> {ending(other)}; uplift {one['uplift_ratio']:.2f} -> "
              f"{other['uplift_ratio']:.2f}; {one['sequence']} | {other['sequence']}")  # fmt: skip
    if len(differing) > OTHERWISE * len(rows):
        return [f"{name}, {how}: {len(differing)} of {len(rows)} end otherwise"]
    return []


def main() -> int:
    """Run the sets."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--records", type=Path, required=True)
    parser.add_argument("--only", action="append", choices=SETS)
    parser.add_argument("--halved", action="store_true")
    parser.add_argument("--single", action="store_true")
    given = parser.parse_args()
    out: list[str] = []
    for name in given.only or SETS:
        changes = SETS[name]
        began = time.perf_counter()
        rows = abreast(cases(given.records, changes, STEP))
        out += tell(name, rows, time.perf_counter() - began)
        if given.halved:
            halved = abreast(cases(given.records, changes, 0.5 * STEP))
            out += compare(name, "half the step", rows, halved)
        if given.single:
            alone = by_themselves(cases(given.records, changes, STEP))
            out += compare(name, "by itself", rows, alone)
    for line in out:
        print(f"OUT OF BOUNDS  {line}")
    return 1 if out else 0


if __name__ == "__main__":
    sys.exit(main())
