"""The command that measures speed."""

from __future__ import annotations

from railquake.cli.application import app
from railquake.cli.shared import Json, print_json


@app.command()
def bench(as_json: Json = False) -> None:
    """Measure how fast it is on this machine, beside OpenSees where that is installed.

    Example: railquake bench --json
    """
    from railquake.bench import print_bench, run_bench

    row = run_bench()
    if as_json:
        print_json(row)
    else:
        print_bench(row)
