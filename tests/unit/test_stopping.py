"""Ctrl-C and a request to terminate: heard at any time, and answered in one way."""

import signal
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
