"""Ctrl-C and a request to terminate: heard from the first import on, and answered in one way."""

from __future__ import annotations

import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import Any, NoReturn

__all__ = ["STOPPED", "STOPPED_TEXT", "StopRequested", "stop_requests_heard"]

STOPPED = 130
"""Exit status after Ctrl-C."""

STOPPED_TEXT = "stopped; nothing is half-written"

AGAIN_S = 0.05  # until a request that nobody heard is made again


class StopRequested(KeyboardInterrupt):
    """Ctrl-C or a request to terminate.

    A class of its own: once a KeyboardInterrupt as such has left code that was made from text, as
    that of a dataclass is while its module is imported, CPython ends by the signal and not with the
    exit status that the program gives.
    """


@contextmanager
def stop_requests_heard() -> Iterator[None]:
    """Raise `StopRequested` in the main thread where Ctrl-C or a request to terminate comes."""
    complaints = sys.unraisablehook

    def stop(number: int, _: Any) -> NoReturn:
        def ask_again(unheard: Any) -> None:
            # raised in a destructor, where Python drops it; what else destructors report now comes
            # of work left half done, the compiler's above all
            if issubclass(unheard.exc_type, StopRequested):
                threading.Timer(AGAIN_S, _wake_main_thread, [number]).start()

        sys.unraisablehook = ask_again
        raise StopRequested

    former = {}
    with suppress(ValueError):  # not in the main thread
        for number in (signal.SIGINT, signal.SIGTERM):
            if signal.getsignal(number) != signal.SIG_IGN:  # as nohup asks for
                former[number] = signal.signal(number, stop)
    try:
        yield
    finally:
        sys.unraisablehook = complaints
        for number, handler in former.items():
            signal.signal(number, handler)


def _wake_main_thread(number: int) -> None:
    """Send it a signal, from another thread."""
    main = threading.main_thread().ident
    if sys.platform == "win32" or main is None:
        signal.raise_signal(number)  # heard when it comes back from what it waits for
    else:
        signal.pthread_kill(main, number)
