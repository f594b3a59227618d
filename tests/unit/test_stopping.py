"""Ctrl-C and a request to terminate: heard at any time, and answered in one way."""

import signal
import subprocess
import sys
import time
from types import ModuleType

import pytest

from railquake.__main__ import main
from railquake.cli.stopping import StopRequested, stop_requests_heard

REQUESTS = pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])


def listening():
    return signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM), sys.unraisablehook


def test_signals_are_given_back(monkeypatch, capsys):
    before = listening()
    monkeypatch.setattr(sys, "argv", ["railquake", "presets"])
    assert main() == 0
    assert listening() == before


@REQUESTS
def test_stop_while_the_commands_are_imported_is_a_clean_one(monkeypatch, capsys, number):
    class Slow(ModuleType):
        def __getattr__(self, name: str) -> object:
            signal.raise_signal(number)
            raise AssertionError("nobody listened")

    before = listening()
    monkeypatch.setitem(sys.modules, "railquake.cli", Slow("railquake.cli"))
    assert main() == 130
    assert capsys.readouterr().err == "railquake: stopped; nothing is half-written\n"
    assert listening() == before


@REQUESTS
def test_request_that_a_destructor_swallows_is_made_again(number):
    class Deaf:
        def __del__(self) -> None:
            signal.raise_signal(number)

    def work() -> None:
        one = Deaf()
        del one  # Python drops what is raised here
        time.sleep(10.0)

    with stop_requests_heard(), pytest.raises(StopRequested):
        work()


def test_request_that_is_to_be_ignored_is_left_alone():
    former = signal.signal(signal.SIGTERM, signal.SIG_IGN)
    try:
        with stop_requests_heard():
            signal.raise_signal(signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, former)


DEAF = """
import ctypes, sys
from pathlib import Path
from railquake.cli.stopping import stop_requests_heard
from railquake.files import whole_folder

mutex = ctypes.create_string_buffer(128)
with stop_requests_heard(), whole_folder(Path(sys.argv[1]) / "above" / "out") as part:
    (part / "half").write_text("half")
    print("ready", flush=True)
    for _ in range(2):  # the second time it waits for itself, and no signal ends that
        ctypes.CDLL(None).pthread_mutex_lock(mutex)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="a mutex of zeros is Linux's")
@REQUESTS
def test_a_library_that_does_not_come_back_is_left_within_two_seconds(tmp_path, number):
    command = [sys.executable, "-c", DEAF, str(tmp_path)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, text=True, **pipes) as process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(1.0)  # until it waits
        begin = time.monotonic()
        process.send_signal(number)
        _, complaint = process.communicate(timeout=60)
        took = time.monotonic() - begin
    assert process.returncode == 130
    assert complaint == "railquake: stopped; nothing is half-written\n"
    assert took < 2.0
    assert list(tmp_path.iterdir()) == []
