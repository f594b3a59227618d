"""Workers of a Dask cluster behind `concurrent.futures.Executor`."""

from __future__ import annotations

import logging
import socket
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

from railquake.errors import InputError
from railquake.messages import first_line, reason
from railquake.run.assess import physics
from railquake.study.batches import refuse_other_physics

__all__ = ["cluster_executor"]

PATIENCE_S = 5.0  # for a scheduler to answer
RETRIES = 3  # of a batch whose worker died


@contextmanager
def cluster_executor(address: str, say: Callable[[str], None]) -> Iterator[tuple[Executor, int]]:
    """Executor on the workers of a scheduler, and the number of their threads.

    Parameters
    ----------
    address : str
        ``"tcp://host:8786"``.
    say : callable
        Called with a line if there is no worker yet.

    Raises
    ------
    InputError
        If Dask is not installed, the scheduler does not answer, or a worker has other physics.
    """
    try:
        parts = urlsplit(address)
        host, port = parts.hostname, parts.port
    except ValueError:
        host = port = None
    if not host or not port:
        raise InputError(
            f'--scheduler: must be an address such as tcp://host:8786, found "{address}"'
        )
    try:
        import distributed
    except ImportError:
        raise InputError(
            "--scheduler: needs Dask's distributed; install railquake[cluster]"
        ) from None
    try:  # a plain connection fails quickly where the client would try for long
        socket.create_connection((host, port), timeout=PATIENCE_S).close()
    except OSError as error:
        raise InputError(
            f"--scheduler: no scheduler answers at {address} ({reason(error)}); start "
            "one with: dask scheduler"
        ) from None
    for name in ("distributed", "distributed.client"):
        logging.getLogger(name).setLevel(logging.CRITICAL)  # one line says it all
    client = _connected(distributed.Client, address)
    with client:
        if not client.nthreads():
            say(f"no worker has joined {address} yet; waiting for one")
            client.wait_for_workers(1)
        _refuse_other_physics(client)
        threads = sum(client.nthreads().values())
        executor = client.get_executor(pure=False, retries=RETRIES)
        try:
            yield executor, threads
        finally:
            executor.shutdown(wait=False)


def _refuse_other_physics(client: Any) -> None:
    """Refuse a worker that would give other numbers; those that join later are asked by batch."""
    found = client.run(physics, on_error="return")
    older = "that this version of railquake cannot ask for"  # it has no such function
    refuse_other_physics(
        {name: told if isinstance(told, str) else older for name, told in found.items()}, physics()
    )


def _connected(connect: Any, address: str) -> Any:
    """A client of the scheduler; from a thread of its own, as it may try for ever."""
    found: list[Any] = []

    def attempt() -> None:
        try:
            found.append(connect(address, timeout=PATIENCE_S, set_as_default=False))
        except Exception as error:
            found.append(error)

    thread = threading.Thread(target=attempt, daemon=True)
    thread.start()
    thread.join(3.0 * PATIENCE_S)
    if not found or isinstance(found[0], Exception):
        said = f" ({first_line(found[0]) or type(found[0]).__name__})" if found else ""
        raise InputError(f"--scheduler: what answers at {address} is no Dask scheduler{said}")
    return found[0]
