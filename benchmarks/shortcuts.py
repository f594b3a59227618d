"""What the lockstep engine's shortcuts cost in accuracy, over the paper's suite of 160 runs.

    python benchmarks/shortcuts.py RECORDS [RUNS]

RECORDS is the folder of the paper's records.  Each row is one shortcut more, against the reference:
the single engine, which iterates the hinge and evaluates everything in every step, at 1e-5 s.
Prints the largest difference of each measure in per cent, and how many runs end with another status
or beyond the bars (0.3 % of the peaks, 2 % of the uplift ratio).
"""

import sys
from itertools import product
from pathlib import Path

import railquake as rq
from railquake.suite import load_suite

LEVELS = (0.21, 0.74, 1.0, 1.38)
PEAKS = ("pbd_m", "pbv_m_s", "pba_m_s2", "hinge_rotation_peak_rad")
BAR, UPLIFT_BAR = 0.003, 0.02


def suite_cases(records, **solver):
    """20 records at four levels, elastic and Bouc-Wen, coupled, 80 km/h."""
    members = load_suite("paper-suite", records).members
    return [
        rq.scenario(
            motion={**member.motion, "scale": level * member.scale_factor}, hinge=hinge, **solver
        )
        for member, level, hinge in product(members, LEVELS, ("elastic", "bouc-wen"))
    ]


def rows_of(cases, **how):
    rows = dict(rq.simulate_many(cases, **how))
    return [rows[k] for k in range(len(cases))]


def compare(name, reference, rows):
    changes = {
        key: max(abs(b[key] / a[key] - 1.0) for a, b in zip(reference, rows, strict=True))
        for key in (*PEAKS, "uplift_ratio")
    }
    beyond = sum(
        max(abs(b[key] / a[key] - 1.0) for key in PEAKS) > BAR
        or abs(b["uplift_ratio"] / a["uplift_ratio"] - 1.0) > UPLIFT_BAR
        or a["status"] != b["status"]
        for a, b in zip(reference, rows, strict=True)
    )
    shown = "".join(f"{100.0 * change:10.4f}" for change in changes.values())
    print(f"{name:42}{shown}{beyond:9d} of {len(rows)}", flush=True)


def main():
    if len(sys.argv) < 2 or not Path(sys.argv[1]).is_dir():
        print("errors of the shortcuts: not measured (name the folder of the paper's records)")
        return
    runs = int(sys.argv[2]) if len(sys.argv) > 2 else None

    def cases_with(**solver):
        return suite_cases(Path(sys.argv[1]), **solver)[:runs]

    cases = cases_with()
    heads = "".join(f"{head:>10}" for head in ("PBD", "PBV", "PBA", "hinge", "uplift"))
    print(f"{'largest difference, %':42}{heads}   beyond the bars")
    reference = rows_of(cases, hinge_solve="newton")
    one_step = cases_with(substeps=1)
    compare("linearised hinge solve", reference, rows_of(one_step, refresh_steps=1))
    compare("... and refreshed every 10 steps", reference, rows_of(one_step))
    compare("... as structure, bodies", reference, rows_of(cases))
    elastic = slice(0, None, 2)
    compare("... the elastic half by itself", reference[elastic], rows_of(cases[elastic]))
    finer = cases_with(history_step="1e-4 s")
    compare("frames of 1 ms against 0.1 ms", rows_of(finer), rows_of(cases))
    long = cases_with(dt="1e-4 s")
    compare("all of them and steps of 1e-4 s", reference, rows_of(long))


if __name__ == "__main__":
    main()
