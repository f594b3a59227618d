"""The tables of docs/sensitivity.md: what results owe to choices, two runs and a suite.

    python tools/sensitivity.py --records FOLDER                 every table
    python tools/sensitivity.py --records FOLDER --only counts   one; may be given again

Prints Markdown.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from suite import HINGES, factors

import railquake as rq

# --- two runs, one choice changed at a time -----------------------------------------------------

A = {"record": "RSN181_IMPVALLH1", "scale": 1.81, "hinge": "bouc-wen"}
B = {"record": "RSN182_IMPVALLH2", "scale": 2.5, "hinge": "elastic"}

STEPS: dict[str, dict[str, Any]] = {
    "1e-4 s": {"solver.dt": 1e-4},
    "4e-5 s": {"solver.dt": 4e-5},
    "2e-5 s": {"solver.dt": 2e-5},
    "**1e-5 s**": {},
    "5e-6 s": {"solver.dt": 5e-6},
    '`contact = "grid"`': {"solver.contact": "grid"},
}
SOLVES: dict[str, dict[str, Any]] = {
    '`hinge_solve = "linearised"`': {"solver.hinge_solve": "linearised"},
    "`newton_tolerance = 1e-8`": {"solver.newton_tolerance": 1e-8},
}
WHEEL_ON_RAIL: dict[str, dict[str, Any]] = {
    "restitution 0": {"wheelrail.restitution": 0.0},
    "restitution 0.6": {"wheelrail.restitution": 0.6},
    "**restitution 0.7**": {},
    "0.7, calibrated": {"wheelrail.restitution_law": "calibrated"},
    "0.7, constant hysteresis": {"wheelrail.restitution_law": "constant-hysteresis"},
    "restitution 1": {"wheelrail.restitution": 1.0},
    "creep `coulomb`": {"wheelrail.creep_law": "coulomb"},
    "creep `carter`": {"wheelrail.creep_law": "carter"},
    "creep `polach`": {"wheelrail.creep_law": "polach"},
    "flange creep `she`": {"wheelrail.flange_creep_law": "she"},
    "friction 0.2": {"wheelrail.friction": 0.2},
    "friction 0.4": {"wheelrail.friction": 0.4},
}
STRUCTURE: dict[str, dict[str, Any]] = {
    "elastic hinge": {"support.hinge": "elastic"},
    "damping 1 %": {"support.damping_ratio": 0.01},
    '`damping_of = "column"`': {"support.damping_of": "column"},
    '`damping_of = "tangent"`': {"support.damping_of": "tangent"},
    "P-delta": {"support.p_delta": True},
    "decoupled": {"support.coupled": False},
    "decoupled, elastic": {"support.coupled": False, "support.hinge": "elastic"},
    "0.01 km/h": {"vehicle.speed": "0.01 km/h"},
    "240 km/h": {"vehicle.speed": "240 km/h"},
}

# --- how many derail ----------------------------------------------------------------------------

LATERAL, VERTICAL = "vehicle.stops.lateral", "vehicle.stops.vertical"
COUNTS: dict[str, dict[str, Any]] = {
    "as it is": {},
    "lateral stops' travel x 0.5": {f"{LATERAL}.travel_factor": 0.5},
    "lateral stops' travel x 1.5": {f"{LATERAL}.travel_factor": 1.5},
    "vertical stops' gap 20 mm": {f"{VERTICAL}.gap": "20 mm"},
    "vertical stops' gap 60 mm": {f"{VERTICAL}.gap": "60 mm"},
    "vertical stops' stiffness 2.5 MN/m": {f"{VERTICAL}.stiffness": "2.5 MN/m"},
    "vertical stops' stiffness 10 MN/m": {f"{VERTICAL}.stiffness": "10 MN/m"},
    "anti-roll bar x 0.5": {"vehicle.anti_roll_bars.secondary.stiffness": "0.072385 MN m/rad"},
    "anti-roll bar x 2": {"vehicle.anti_roll_bars.secondary.stiffness": "0.28954 MN m/rad"},
    "secondary dashpots x 0.5": {
        f"vehicle.dashpots.secondary-{way}.damping": 34136.0 for way in ("lateral", "vertical")
    },
    "secondary dashpots x 2": {
        f"vehicle.dashpots.secondary-{way}.damping": 136544.0 for way in ("lateral", "vertical")
    },
    "friction 0.2": {"wheelrail.friction": 0.2},
    "friction 0.4": {"wheelrail.friction": 0.4},
    '`damping_of = "column"`': {"support.damping_of": "column"},
    '`damping_of = "tangent"`': {"support.damping_of": "tangent"},
    "restitution without memory": {"wheelrail.restitution_law": "constant-hysteresis"},
    "flange creep `she`": {"wheelrail.flange_creep_law": "she"},
}
PROFILE = "profiles S1002 and 60E1, standard gauge"
LEVELS = {"5 %": 1.0, "2 %": 1.38}
STEP = 2e-5  # s


def single(records: Path, run: dict[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """A run with other values."""
    step = changes.get("solver.dt", 1e-5)
    case = rq.scenario(
        record=records / f"{run['record']}.AT2", scale=run["scale"], hinge=run["hinge"], dt=step
    )
    rest = {key: value for key, value in changes.items() if key != "solver.dt"}
    return rq.assess(rq.simulate(case.with_changes(rest) if rest else case))


def against(
    records: Path, run: dict[str, Any], choices: dict[str, dict[str, Any]]
) -> Iterator[str]:
    """Lines of a table: differences to the run as it is, peaks."""
    base = single(records, run, {})
    for name, changes in choices.items():
        row = single(records, run, changes) if changes else base
        change = [100.0 * (row[key] / base[key] - 1.0) for key in ("pbd_m", "pbv_m_s")]
        loads = [
            1e-3 * row[key]
            for key in (
                "wheel_load_peak_n",
                "lateral_force_peak_n",
                "lateral_force_filtered_peak_n",
            )
        ]
        ends = row["derailment_mode"] or row["status"]
        yield (
            f"| {name} | {change[0]:.3f} | {change[1]:.3f} | {row['uplift_ratio']:.4g} | "
            + " | ".join(f"{value:.1f}" for value in loads)
            + f" | {ends} |"
        )


def counts(records: Path) -> Iterator[str]:
    """How many of the suite's runs derail with each choice."""
    for name, changes in {**COUNTS, PROFILE: {}}.items():
        pair = {"wheelrail": "s1002-60e1"} if name == PROFILE else {}
        cases, levels = [], []
        for said, level in LEVELS.items():
            for file_name, factor in factors(records).items():
                for hinge in HINGES:
                    case = rq.scenario(
                        record=records / file_name, scale=level * factor, hinge=hinge, dt=STEP,
                        vehicle="bart-under-gravity", **pair,
                    )  # fmt: skip
                    cases.append(case.with_changes(changes) if changes else case)
                    levels.append(said)
        rows = dict(rq.simulate_many(cases))
        cells = []
        for said in LEVELS:
            chosen = [rows[k] for k, level in enumerate(levels) if level == said]
            modes = Counter(str(row["derailment_mode"]).split()[0] for row in chosen
                            if row.get("derailment_mode"))  # fmt: skip
            listed = ", ".join(f"{count} {mode}" for mode, count in sorted(modes.items()))
            cells.append(f"{modes.total()} ({listed})" if listed else "0")
            cells.append(str(sum(row["status"] == "onset" for row in chosen)))
        beyond = sum(bool(row.get("beyond_model")) for row in rows.values())
        yield f"| {name} | " + " | ".join(cells) + f" | {beyond} |"


TABLES: dict[str, Callable[[Path], Iterator[str]]] = {
    "steps, A": lambda records: against(records, A, {**STEPS, **SOLVES}),
    "steps, B": lambda records: against(records, B, STEPS),
    "wheel on rail, B": lambda records: against(records, B, WHEEL_ON_RAIL),
    "structure, A": lambda records: against(records, A, STRUCTURE),
    "counts": counts,
}


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--records", type=Path, required=True)
    parser.add_argument("--only", action="append", choices=TABLES)
    given = parser.parse_args()
    for name in given.only or TABLES:
        print(f"\n{name}", flush=True)
        for line in TABLES[name](given.records):
            print(line, flush=True)


if __name__ == "__main__":
    main()
