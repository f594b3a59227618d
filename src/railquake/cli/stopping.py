"""Ctrl-C and a request to terminate: heard from the first import on, and answered in one way.

Python hears them in its main thread, between two of its own instructions.  While that waits for
the compiler, or for a long call into a library, a second thread listens: if the command has not
ended in time it takes away what is half-written and ends the process.
"""

from __future__ import annotations

import os
import signal
import socket
import sys
import threading
import time
from collections.abc import Container, Iterator
from contextlib import contextmanager, suppress
from typing import Any, NoReturn

__all__ = ["STOPPED", "STOPPED_TEXT", "StopRequested", "stop_requests_heard"]

STOPPED = 130
"""Exit status after Ctrl-C."""

STOPPED_TEXT = "stopped; nothing is half-written"

AGAIN_S = 0.05  # until a request that nobody heard is made again
GRACE_S = 1.2  # for the command to end by itself


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

    former: dict[signal.Signals, Any] = {}
    with suppress(ValueError):  # not in the main thread
        for number in (signal.SIGINT, signal.SIGTERM):
            if signal.getsignal(number) != signal.SIG_IGN:  # as nohup asks for
                former[number] = signal.signal(number, stop)
    try:
        with _watched(former):
            yield
    finally:
        sys.unraisablehook = complaints
        for number, handler in former.items():
            signal.signal(number, handler)


@contextmanager
def _watched(numbers: Container[int]) -> Iterator[None]:
    """Let a thread see to it that the process ends soon after one of these signals."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    listener, bell = socket.socketpair()
    bell.setblocking(False)
    former = signal.set_wakeup_fd(bell.fileno(), warn_on_full_buffer=False)
    thread = threading.Thread(target=_watch, args=(listener, numbers), daemon=True)
    thread.start()
    try:
        yield
    finally:
        signal.set_wakeup_fd(former)
        bell.close()  # that the thread hears as well
        thread.join()
        listener.close()


def _watch(listener: socket.socket, numbers: Container[int]) -> None:
    """Wait for a signal, and then for the command to end; end the process if it does not."""
    while heard := listener.recv(1):
        if heard[0] in numbers:
            break
    else:
        return  # the command has ended
    begin = time.monotonic()
    while (left := GRACE_S - (time.monotonic() - begin)) > 0.0:
        listener.settimeout(left)
        with suppress(TimeoutError):
            if not listener.recv(64):
                return
    _end_at_once()


def _end_at_once() -> NoReturn:
    from railquake.parts import drop_parts

    drop_parts()
    shown = b"\x1b[?25h\r\x1b[K" if sys.stderr is not None and sys.stderr.isatty() else b""
    with suppress(OSError):  # a progress bar has hidden the cursor
        os.write(2, shown + f"railquake: {STOPPED_TEXT}\n".encode())
    os._exit(STOPPED)


def _wake_main_thread(number: int) -> None:
    """Send it a signal, from another thread."""
    main = threading.main_thread().ident
    if sys.platform == "win32" or main is None:
        signal.raise_signal(number)  # heard when it comes back from what it waits for
    else:
        signal.pthread_kill(main, number)
