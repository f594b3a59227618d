"""The command that measures speed."""

from __future__ import annotations

from typing import Annotated

import typer

from railquake.cli.application import app
from railquake.cli.shared import Json, print_json

Device = Annotated[
    str, typer.Option("--device", help="cpu; or cuda for a GPU alone, beside a sample on the CPU.")
]


@app.command()
def bench(as_json: Json = False, device: Device = "cpu") -> None:
    """Measure how fast it is on this machine, beside OpenSees where that is installed.

    Example: railquake bench --json
    """
    from railquake.run.gpu import require_known

    require_known(device)
    if device == "cuda":
        from railquake.bench.gpu import print_bench_gpu, run_bench_gpu

        gpu = run_bench_gpu()
        if as_json:
            print_json(gpu)
        else:
            print_bench_gpu(gpu)
        return
    from railquake.bench.speed import print_bench, run_bench

    row = run_bench()
    if as_json:
        print_json(row)
    else:
        print_bench(row)
