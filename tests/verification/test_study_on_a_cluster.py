"""A study on a Dask cluster of two processes, one of which is killed: the same table."""

import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

import railquake as rq
from railquake.study import open_results
from study_files import many, untimed

distributed = pytest.importorskip("distributed")

SEEDS = 80


def free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


@pytest.fixture
def cluster(tmp_path):
    """Address of a scheduler with two worker processes, and their process ids."""
    address = f"tcp://127.0.0.1:{free_port()}"
    dask = [sys.executable, "-m", "distributed.cli.dask_scheduler"]
    source = str(Path(rq.__file__).absolute().parents[1])
    quiet = {
        "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "cwd": tmp_path,
        "env": {**os.environ, "PYTHONPATH": source},
    }  # fmt: skip
    processes = [subprocess.Popen(
        [*dask, "--host", "127.0.0.1", "--port", address.rpartition(":")[2], "--no-dashboard"],
        **quiet,
    )]  # fmt: skip
    worker = [
        sys.executable, "-m", "distributed.cli.dask_worker", address, "--nthreads", "1",
        "--no-nanny", "--no-dashboard", "--local-directory", str(tmp_path),
    ]  # fmt: skip
    processes += [subprocess.Popen(worker, **quiet) for _ in range(2)]
    try:
        with distributed.Client(address, timeout=60, set_as_default=False) as client:
            client.wait_for_workers(2, timeout=60)
            yield address, list(client.run(os.getpid).values())
    finally:
        for process in processes:
            process.kill()
            process.wait()


def test_a_killed_worker_leaves_no_trace(cluster, tmp_path):
    address, workers = cluster
    study = rq.Study.from_dict(many(SEEDS))
    local = study.run(tmp_path / "local", jobs=2)
    killed = []

    def kill_one(progress):
        if 0 < progress.done < progress.total and not killed:
            os.kill(workers[0], signal.SIGKILL)
            killed.append(progress.done)

    table = study.run(tmp_path / "cluster", scheduler=address, progress=kill_one)
    assert killed and killed[0] < len(table)
    assert untimed(table).equals(untimed(local))


def test_a_study_that_was_begun_here_goes_on_there(cluster, tmp_path):
    address, _ = cluster
    study = rq.Study.from_dict(many(8))
    whole = study.run(tmp_path / "local")
    study.run(tmp_path / "mixed", shard=(1, 2))
    table = study.run(tmp_path / "mixed", scheduler=address)
    assert untimed(table).equals(untimed(whole))
    assert open_results(tmp_path / "mixed").missing == 0
