"""Where machine code and contact tables are kept between processes."""

from __future__ import annotations

import hashlib
import logging
import os
import sys
from contextlib import suppress
from functools import cache
from pathlib import Path
from types import CodeType, FunctionType

from railquake.errors import InputError
from railquake.files import whole_file
from railquake.messages import reason

__all__ = [
    "cache_folder",
    "check_compiler",
    "code_hash",
    "compiler_fault",
    "drop",
    "keep",
    "kept",
    "source_hash",
]

LOG = logging.getLogger("railquake")
NOWHERE = Path(os.devnull)  # no folder can be made in it
DIGEST = 32  # bytes before a kept file's content
HOUSE = Path(__file__).parents[2]
ROOMS = ("physics", "march")  # whose functions are compiled


def cache_folder() -> Path:
    """Folder for everything that can be made again: machine code and contact tables.

    ``RAILQUAKE_CACHE_DIR`` names another one; otherwise the platform's own place is used.  Where
    there is none, a place at which no folder can be.
    """
    named = os.environ.get("RAILQUAKE_CACHE_DIR")
    if named:
        return Path(named).absolute()
    if sys.platform == "win32":
        base = _set_to_absolute("LOCALAPPDATA") or _below_home("AppData", "Local")
    elif sys.platform == "darwin":
        base = _below_home("Library", "Caches")
    else:  # an empty or a relative path counts as none, as the XDG specification says
        base = _set_to_absolute("XDG_CACHE_HOME") or _below_home(".cache")
    return (base or NOWHERE) / "railquake"


def _set_to_absolute(variable: str) -> Path | None:
    """The absolute path that a variable of the environment is set to."""
    path = Path(os.environ.get(variable, ""))
    return path if path.is_absolute() else None


def _below_home(*names: str) -> Path | None:
    """A path in the user's home folder; None if the system knows of none."""
    if sys.platform == "win32":
        home: Path | None = Path.home()
    else:
        home = _set_to_absolute("HOME") or _listed_home()
    return None if home is None else home.joinpath(*names)


def _listed_home() -> Path | None:
    """The home folder in the system's list of users, which many a container does without."""
    import pwd

    try:
        return Path(pwd.getpwuid(os.getuid()).pw_dir)
    except KeyError:
        return None


def keep(path: Path, content: bytes) -> None:
    """Keep a file below the cache's folder, with a digest by which damage is noticed.

    A cache that cannot be used costs time in each process, nothing more: that is said once.
    """
    top = _top(path)
    try:
        for folder in reversed([at for at in path.parents if not os.path.exists(at)]):
            folder.mkdir(mode=0o700, exist_ok=True)
        if not _is_trusted(top, path.parent):
            return
        with whole_file(path, durable=True) as part:
            part.chmod(0o600)
            part.write_bytes(_digest(top, path, content) + content)
    except OSError as error:
        if NOWHERE in path.parents:
            _say("there is no home folder for the cache; name one in RAILQUAKE_CACHE_DIR")
        else:
            _say(f"the cache {top} cannot be written ({reason(error)})")


def kept(path: Path) -> bytes | None:
    """What `keep` has kept; None if nothing is there, or nothing that can be trusted.

    What is damaged is deleted.
    """
    top = _top(path)
    if not os.path.exists(path) or not _is_trusted(top, path.parent, path):
        return None
    try:
        raw = path.read_bytes()
    except OSError:
        return None
    content = raw[DIGEST:]
    if raw[:DIGEST] == _digest(top, path, content):
        return content
    drop(path)
    return None


def drop(path: Path) -> None:
    """Delete a kept file that is damaged, so that it is made again."""
    LOG.warning("railquake: %s: is damaged; it is made again", path)
    with suppress(OSError):
        path.unlink()


def _top(path: Path) -> Path:
    """The cache's folder, if the file is below it; else the file's own."""
    top = cache_folder()
    return top if path.is_relative_to(top) else path.parent


def _digest(top: Path, path: Path, content: bytes) -> bytes:
    """Of the content and of its place: one file in the place of another is damage, too."""
    digest = hashlib.blake2b(str(path.relative_to(top).as_posix()).encode(), digest_size=DIGEST)
    digest.update(content)
    return digest.digest()


def _is_trusted(top: Path, folder: Path, *files: Path) -> bool:
    """Whether nobody else can have put something into a folder of the cache; if not, says so.

    What is loaded is run: machine code.
    """
    if sys.platform == "win32":
        return True  # the user's own folder is closed to others
    own = os.geteuid()
    levels = [level for level in (folder, *folder.parents) if level.is_relative_to(top)]
    for place in (*reversed(levels), *files):
        try:
            found = place.stat()
        except OSError:
            return False
        if found.st_uid != own:
            _say(f"{place} belongs to another user, so nothing is loaded from it")
            return False
        if found.st_mode & 0o022:
            _say(
                f"{place} can be written by others (mode {found.st_mode & 0o777:o}), so nothing is "
                f"loaded from it; delete {top}, or name another folder in RAILQUAKE_CACHE_DIR"
            )
            return False
    return True


@cache
def _say(what: str) -> None:
    """Say once why machine code and tables are made in this process."""
    LOG.warning("railquake: %s; machine code and tables are made in memory", what)


def check_compiler() -> None:
    """Refuse an environment in which the compiler cannot work.

    Raises
    ------
    InputError
        Naming the variable.
    """
    fault = compiler_fault()
    if fault is not None:
        raise InputError(fault)


def compiler_fault() -> str | None:
    """Why the compiler cannot work in this environment; None if it can."""
    if _number("NUMBA_DISABLE_JIT", 0) != 0:
        return (
            "NUMBA_DISABLE_JIT is set: the physics and contact tables need Numba's compiler; unset "
            "it (from Python, simulate(case, target=PYTHON) runs the march uncompiled without it)"
        )
    if _number("NUMBA_NUM_THREADS", 1) < 1:
        found = os.environ["NUMBA_NUM_THREADS"]
        return f"NUMBA_NUM_THREADS is {found}: Numba wants at least 1; set that, or unset it"
    return None


def _number(variable: str, usual: int) -> int:
    try:
        return int(os.environ.get(variable) or usual)
    except ValueError:
        return usual  # as Numba does


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
