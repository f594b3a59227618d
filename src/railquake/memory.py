"""What has been made is kept for a while: one bounded store that threads may share."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable
from threading import RLock
from typing import Generic, TypeVar, cast

__all__ = ["Bounded"]

Key = TypeVar("Key", bound=Hashable)
Value = TypeVar("Value")

_MISSING = object()  # None may be a value


class _Turn:
    """Who makes the value of a key, and how many want it."""

    def __init__(self) -> None:
        self.lock = RLock()  # whoever makes a value may ask for it in doing so
        self.wanted = 0


class Bounded(Generic[Key, Value]):
    """The values used last, by key.

    Threads may share it.  Of those that ask for the same key at once one makes the value and the
    others wait for it; where making it fails, whoever waited tries in turn.  Different keys are
    made at the same time.

    Parameters
    ----------
    most : int
        Values kept; the one that was not used for longest leaves.

    Examples
    --------
    >>> squares = Bounded[int, int](2)
    >>> squares.get(3, lambda: 9)
    9
    >>> squares.get(3, lambda: 0)  # known
    9
    """

    def __init__(self, most: int) -> None:
        self.most = most
        self._kept: OrderedDict[Key, Value] = OrderedDict()
        self._turns: dict[Key, _Turn] = {}
        self._lock = RLock()  # a value that leaves may, in its destructor, come back here

    def get(self, key: Key, make: Callable[[], Value]) -> Value:
        """The value of a key; made now if it is not known.

        Parameters
        ----------
        key : hashable
            An `id` may stand for an object only where the value keeps that object alive.
        make : callable
            What it raises is passed on, and nothing is kept.
        """
        with self._lock:
            known = self._known(key)
            if known is not _MISSING:
                return cast(Value, known)
            turn = self._turns.setdefault(key, _Turn())
            turn.wanted += 1
        try:
            with turn.lock:
                with self._lock:
                    known = self._known(key)
                if known is not _MISSING:  # another thread has made it meanwhile
                    return cast(Value, known)
                return self.put(key, make())
        finally:
            with self._lock:
                turn.wanted -= 1
                if not turn.wanted:
                    del self._turns[key]

    def put(self, key: Key, value: Value) -> Value:
        """Keep a value, in the place of a former one; gives it back."""
        with self._lock:
            self._kept[key] = value
            self._kept.move_to_end(key)
            while len(self._kept) > self.most:
                self._kept.popitem(last=False)
        return value

    def forget(self, key: Key) -> None:
        """Let a value go, if it is kept."""
        with self._lock:
            self._kept.pop(key, None)

    def clear(self) -> None:
        """Let all go."""
        with self._lock:
            self._kept.clear()

    def __len__(self) -> int:
        return len(self._kept)

    def __contains__(self, key: object) -> bool:
        return key in self._kept

    def _known(self, key: Key) -> object:
        if key not in self._kept:
            return _MISSING
        self._kept.move_to_end(key)
        return self._kept[key]
