"""What a law of restitution without memory changes: the tables of docs/theory/contact.md.

    python benchmarks/restitution_memory.py

Built-in synthetic motions under which wheels lift, each run by every law: some minutes.
"""

import railquake as rq

LAWS = ("hunt-crossley", "constant-hysteresis")
DURATION = "8 s"
CASES = {
    "`bart` on `bart-berkeley`, elastic hinge": {"vehicle": "bart", "hinge": "elastic"},
    "`bart-under-gravity` on the same": {"vehicle": "bart-under-gravity", "hinge": "elastic"},
}
MOTIONS = tuple(
    (f"seed {seed}, {pga} g", {"seed": seed, "pga": f"{pga} g", "duration": DURATION})
    for seed, pga in ((2, 0.8), (3, 1.0), (8, 1.2), (5, 1.6), (6, 2.0))
)
HEADER = (
    "| | law | status | uplift | off the rail, ms | uplifts | load, kN | lateral, kN "
    "| low-passed, kN |"
)


def row(case, synthetic, law):
    scenario = rq.scenario(
        **case, synthetic=synthetic, wheelrail={"preset": "bart", "restitution_law": law}
    )
    return rq.assess(rq.simulate(scenario))


def main():
    for name, case in CASES.items():
        print(f"\n{name}\n\n{HEADER}\n|---|---|---|---|---|---|---|---|---|")
        for title, synthetic in MOTIONS:
            for law in LAWS:
                found = row(case, synthetic, law)
                print(
                    f"| {title} | `{law}` | {found['status']} | {found['uplift_ratio']:.3f} "
                    f"| {1e3 * found['off_rail_time_s']:.0f} "
                    f"| {found['uplifts']} "
                    f"| {1e-3 * found['wheel_load_peak_n']:.0f} "
                    f"| {1e-3 * found['lateral_force_peak_n']:.0f} "
                    f"| {1e-3 * found['lateral_force_filtered_peak_n']:.0f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
