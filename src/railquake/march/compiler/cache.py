"""Where machine code and contact tables are kept between processes."""

from __future__ import annotations

import hashlib
import os
import sys
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType

__all__ = ["cache_folder", "code_hash", "source_hash"]

HOUSE = Path(__file__).parents[2]
ROOMS = ("physics", "march")  # whose functions are compiled


def cache_folder() -> Path:
    """Folder for everything that can be made again: machine code and contact tables.

    ``RAILQUAKE_CACHE_DIR`` names another one; otherwise the platform's own place is used.
    """
    named = os.environ.get("RAILQUAKE_CACHE_DIR")
    if named:
        return Path(named)
    if sys.platform == "win32":
        base = Path(os.environ.get("LOCALAPPDATA", Path.home() / "AppData" / "Local"))
    elif sys.platform == "darwin":
        base = Path.home() / "Library" / "Caches"
    else:
        base = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    return base / "railquake"


@cache
def source_hash() -> str:
    """Hash of every source file of physics and march.

    The compiler's own cache looks at the entry function's file alone: an edit of a law in another
    file would go unseen and stale physics would answer.  So the cache's folder is named by this.
    """
    digest = hashlib.sha256()
    for room in ROOMS:
        for path in sorted((HOUSE / room).rglob("*.py")):
            digest.update(str(path.relative_to(HOUSE)).encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def code_hash(function: FunctionType) -> str:
    """Hash of what a function from outside those rooms does, and of what it calls."""
    digest = hashlib.sha256()
    met: set[int] = set()

    def take(code: CodeType) -> None:
        digest.update(code.co_code)
        digest.update(repr(code.co_names).encode())
        for value in code.co_consts:
            if isinstance(value, CodeType):
                take(value)
            else:
                digest.update(repr(value).encode())

    def walk(function: FunctionType) -> None:
        if id(function) in met:
            return
        met.add(id(function))
        take(function.__code__)
        for name in function.__code__.co_names:
            value = function.__globals__.get(name)
            if isinstance(value, FunctionType):
                walk(value)
            elif isinstance(value, int | float):
                digest.update(f"{name}={value!r}".encode())

    walk(function)
    return digest.hexdigest()[:16]
