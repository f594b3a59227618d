"""Where a kernel may run."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["CUDA", "PYTHON", "SCALAR", "Target"]


@dataclass(frozen=True)
class Target:
    """Where a kernel runs.

    Attributes
    ----------
    name : str
        Part of the key of the on-disk cache.
    compiled : bool
        False leaves the functions to the interpreter.
    lanes : int
        Scenarios abreast.  With one, branches may skip work.
    """

    name: str
    compiled: bool
    lanes: int = 1


PYTHON = Target("python", compiled=False)
SCALAR = Target("scalar", compiled=True)
CUDA = Target("cuda", compiled=True)  # a thread a scenario
