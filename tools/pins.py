"""Every pinned number, old against new: whether a change of the code has changed what it computes.

The numbers lie in ``tests/pins``; ``tests/pinned.py`` says what they are of, how they are made and
how far two of them may be apart.

    python tools/pins.py                  compares all groups: make pins
    python tools/pins.py --only plain     one group; may be given again
    python tools/pins.py --exact          to the last bit: on one machine, before and after
    python tools/pins.py --write          pins what the code gives now

Ends with 1 if a number is out of bounds, and with 2 if nothing was compared.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

import pinned  # noqa: E402

SHARED = Path(os.environ.get("RAILQUAKE_SHARED") or ROOT.parent / "shared")
LISTED = 20  # numbers out of bounds that are shown of a group
WORST = 6  # measures whose largest differences are


def make(group: str, records: Path, threads: int) -> dict[str, Any]:
    """Rows of a group by the runs' names, as the code gives them now."""
    if group == "suite":
        return pinned.make_suite(records, threads)
    return getattr(pinned, f"make_{group}")(threads)


def report(group: str, known: dict[str, Any], found: dict[str, Any], exact: bool) -> int:
    """Print how a group differs; the number of measures out of bounds."""
    differences = pinned.compare(group, known, found, exact)
    beyond = [d for d in differences if d.excess > 1.0]
    differing = {d.run for d in differences}
    print(f"  {len(known)} runs, {len(known.keys() - differing)} the same to the last bit")
    for lifting in (False, True):
        worst: dict[str, tuple[float, str]] = {}
        for d in differences:
            relative = d.relative
            if relative is None or lifts(known, d.run) != lifting:
                continue
            if relative > worst.get(d.measure, (0.0, ""))[0]:
                worst[d.measure] = relative, d.run
        if worst:
            what = "where wheels lift" if lifting else "where none lifts"
            print(f"  largest relative differences {what}:")
        for measure, (relative, run) in sorted(worst.items(), key=lambda m: -m[1][0])[:WORST]:
            print(f"    {relative:8.1e}  {measure}  ({run})")
    for d in beyond[:LISTED]:
        print(f"  OUT OF BOUNDS  {d}")
    if len(beyond) > LISTED:
        print(f"  ... {len(beyond)} in all, of {len({d.run for d in beyond})} runs")
    return len(beyond)


def lifts(rows: dict[str, Any], run: str) -> bool:
    """Whether wheels lift in a pinned run."""
    return run in rows and pinned.lifts(rows[run])


def main() -> int:
    """Compare or pin, as the command line says; the exit status."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--write", action="store_true", help="pin what the code gives now")
    parser.add_argument("--exact", action="store_true", help="allow no difference at all")
    parser.add_argument("--only", action="append", choices=pinned.GROUPS, help="one group")
    parser.add_argument(
        "--records",
        type=Path,
        default=SHARED / "records" / "paper_suite",
        help="folder of the paper's records",
    )
    parser.add_argument("--threads", type=int, default=os.cpu_count() or 1)
    options = parser.parse_args()
    beyond, compared = 0, 0
    for group in options.only or pinned.GROUPS:
        if group == "suite" and not options.records.is_dir():
            print(f"{group}: left out (no records at {options.records})", flush=True)
            continue
        begin = time.perf_counter()
        found = make(group, options.records, options.threads)
        print(f"{group}: {len(found)} runs in {time.perf_counter() - begin:.0f} s", flush=True)
        if options.write:
            pinned.write(group, found)
        else:
            beyond += report(group, pinned.read(group), found, options.exact)
        compared += 1
    if not options.write and compared:
        print(f"{beyond} numbers out of bounds" if beyond else "all within the bounds")
    return 2 if not compared else int(beyond > 0)


if __name__ == "__main__":
    sys.exit(main())
