"""An entry function with the chosen laws in its slots, for a target.

`bind` takes an entry function of the march, follows the plain functions that it calls, puts what
was chosen at assembly in the place of the slots and the numbers of the run's rows in the place of
``state``, ``constant`` and ``size``, and compiles the set.  The physics knows nothing of this:
under the target `PYTHON` the very same source runs in the interpreter, where a debugger and a
coverage tool can see it.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

from railquake.march.compiler import cpu, cuda
from railquake.march.compiler.cache import (
    HOUSE,
    cache_folder,
    check_compiler,
    code_hash,
    source_hash,
)
from railquake.march.compiler.target import CUDA, Target
from railquake.march.rows import USUAL, Layout, Numbers

__all__ = ["Kernel", "bind"]

Law = Callable[..., Any]


@dataclass(frozen=True)
class Kernel:
    """A bound entry function.

    Attributes
    ----------
    call : callable
        The compiled function (or the plain one, for the target ``PYTHON``).
    folder : Path or None
        Where its machine code is kept between processes.
    """

    call: Callable[..., Any]
    folder: Path | None

    @property
    def is_cached(self) -> bool:
        """Whether a call can start at once, without compiling first."""
        return self.folder is None or any(self.folder.glob("*.nbc"))


def bind(
    entry: Law,
    target: Target,
    laws: Mapping[Law, Law] | None = None,
    layout: Layout | None = None,
) -> Kernel:
    """Compile ``entry`` and all plain functions that it calls.

    Parameters
    ----------
    entry : function
        For example `frames.march`.
    target : Target
    laws : mapping of function to function, optional
        What to put in the place of functions wherever they are called: laws in slots, see
        `slots.chosen`.
    layout : Layout, optional
        Numbers of the rows, instead of the usual run's.

    Returns
    -------
    Kernel

    Raises
    ------
    InputError
        If the environment keeps the compiler from working.
    """
    chosen = tuple((_label(slot), _label(law)) for slot, law in (laws or {}).items())
    rows = USUAL if layout is None else layout
    key = repr((_label(entry), target.name, chosen, rows.key))
    return _bind_cached(entry, target, key, _Frozen(laws or {}), _Held(rows))


def _label(function: Law) -> str:
    """What tells two functions apart, in this process and in the next."""
    assert isinstance(function, FunctionType)
    place = Path(function.__code__.co_filename)
    name = f"{function.__module__}.{function.__qualname__}"
    return name if place.is_relative_to(HOUSE) else f"{name} {code_hash(function)}"


class _Frozen(dict[Any, Any]):
    """A mapping that ``functools.cache`` accepts; ``key`` already tells two of them apart."""

    def __hash__(self) -> int:  # type: ignore[override]
        return 0


@dataclass(frozen=True, eq=False)
class _Held:
    layout: Layout

    def __hash__(self) -> int:
        return 0

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Held)


@cache
def _bind_cached(
    entry: Law, target: Target, key: str, laws: Mapping[Law, Law], held: _Held
) -> Kernel:
    if target.compiled:
        check_compiler()
    rebuilt = _rebuild(entry, target, laws, held.layout, {})
    if target is CUDA:
        return Kernel(cuda.launcher(rebuilt), None)
    if not target.compiled:
        return Kernel(rebuilt, None)
    variant = hashlib.sha256(key.encode()).hexdigest()[:12]
    folder = cache_folder() / "kernels" / source_hash() / f"{target.name}-{variant}"
    return Kernel(cpu.compile_entry(rebuilt, folder, target.lanes), folder)


def _rebuild(
    function: Law,
    target: Target,
    laws: Mapping[Law, Law],
    layout: Layout,
    done: dict[Law, Law],
) -> Law:
    """Copy of ``function`` whose globals hold what was chosen instead."""
    return _copy(function, _globals(function, target, laws, layout, done))


def _globals(
    function: Law,
    target: Target,
    laws: Mapping[Law, Law],
    layout: Layout,
    done: dict[Law, Law],
) -> dict[str, Any]:
    """Those of its globals that a function uses, with what was chosen instead."""
    assert isinstance(function, FunctionType)
    names: dict[str, Any] = {}
    for name in function.__code__.co_names:
        value = function.__globals__.get(name)
        if isinstance(value, Numbers):
            numbers = layout.numbers(value.kind)
            names[name] = numbers.module if target.compiled else numbers
        elif isinstance(value, FunctionType):
            law = laws.get(value, value)
            if law.__code__ is function.__code__:
                law = value  # a law that wraps the one it stands for
            if law not in done:
                used = _globals(law, target, laws, layout, done)
                done[law] = _finish(law, used, target, layout)
            names[name] = done[law]
    return names


def _copy(function: Law, names: Mapping[str, Any]) -> Law:
    """The same function with other globals."""
    assert isinstance(function, FunctionType)
    copy = FunctionType(
        function.__code__,
        {**function.__globals__, **names},
        function.__name__,
        function.__defaults__,
        function.__closure__,
    )
    copy.__module__ = function.__module__
    copy.__qualname__ = function.__qualname__
    copy.__doc__ = function.__doc__
    return copy


def _finish(function: Law, names: Mapping[str, Any], target: Target, layout: Layout) -> Law:
    """One called function as the target wants it, with these globals."""
    if not target.compiled:
        return _copy(function, names)
    compiler = cuda if target is CUDA else cpu
    rows = {"own_state": layout.size.STATE_ROWS, "own_constants": layout.size.CONSTANT_ROWS}
    if function.__name__ in rows:
        return compiler.own_memory(rows[function.__name__], layout.size.LANES)
    key = (function, target.name, *_dependences(function, names))
    if key not in _called:
        copy = _copy(function, names)
        on_device = target is CUDA
        _called[key] = (
            cuda.compile_for_device(copy) if on_device else cpu.compile_called(copy, target.lanes)
        )
    return _called[key]


# Called functions that are compiled already, by all that they depend on.  The kernels of one
# process differ in a law or in some rows: what they have in common is compiled once.
_called: dict[tuple[Any, ...], Law] = {}


def _dependences(function: Law, names: Mapping[str, Any]) -> Iterator[tuple[Any, ...]]:
    """What a function takes from outside: other functions, rows' numbers, fixed values."""
    assert isinstance(function, FunctionType)
    used = function.__code__.co_names
    for name in used:
        value = names.get(name, function.__globals__.get(name))
        if isinstance(value, ModuleType) and name in names:
            rows = vars(value)
            yield (name, *((row, rows[row]) for row in used if row in rows))
        elif name in names or isinstance(value, bool | int | float | tuple):
            yield name, value
