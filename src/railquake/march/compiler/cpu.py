"""Kernels on the processor: how wide its vectors are, and what is compiled for them."""

from __future__ import annotations

import gc
import hashlib
import os
import pickle
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from railquake.errors import InputError
from railquake.march.compiler.cache import drop, keep, kept, source_hash
from railquake.march.compiler.target import Target

__all__ = [
    "compile_called",
    "compile_entry",
    "lockstep_target",
    "own_memory",
    "vector_doubles",
    "vector_instructions",
]

Law = Callable[..., Any]

# Reassociation and contraction let LLVM use fused multiply-adds and vectors.  "nnan" and "ninf"
# are left out on purpose: with them a test for a diverged state would be optimised away.
FASTMATH = frozenset({"contract", "arcp", "nsz", "reassoc"})


@cache
def lockstep_target() -> Target:
    """Target that runs scenarios abreast: one to each double of the vectors that the compiler uses.

    Two such vectors to a stage are no faster: their state leaves the first-level cache.  But where
    vectors hold two doubles only, two of them are.
    """
    return Target("lockstep", compiled=True, lanes=max(vector_doubles(), 4))


@cache
def vector_doubles() -> int:
    """Doubles in the vectors that the compiler uses on this machine.

    They may be fewer than the machine has room for.  So it is asked, by a loop that it vectorises.
    """
    code = _loop_in_assembly()
    return next((doubles for doubles in (8, 4, 2) if vector_instructions(code, doubles)), 1)


@cache
def _preferred_width() -> str:
    """Attribute of a function whose vectors are to be as wide as the processor's.

    For many processors with AVX-512 LLVM keeps to 256 bits, since wider vectors slowed the clock of
    the first of them; a step of eight scenarios takes three quarters of the time that two steps of
    four do (`benchmarks/vector_width.py`).  Where it does not, ``RAILQUAKE_VECTOR_BITS=256``.
    """
    bits = os.environ.get("RAILQUAKE_VECTOR_BITS") or "512"
    if bits not in ("256", "512"):
        raise InputError(f"RAILQUAKE_VECTOR_BITS is {bits!r}; it can be 256 or 512")
    return f'"prefer-vector-width"="{bits}"'


def vector_instructions(code: str, doubles: int) -> int:
    """Instructions in assembly (x86-64 or arm64) on vectors of so many doubles."""
    return len(re.findall(VECTORS[doubles], code, re.MULTILINE))


VECTORS = {
    8: r"^\s+v\w+pd\b.*%zmm\d",
    4: r"^\s+v\w+pd\b.*%ymm\d",
    2: r"^\s+v?\w+pd\b.*%xmm\d|^\s.*\.2d\b|^\s.*\bz\d+\.d\b",  # SSE, NEON, SVE
}

_LOOP = """
define void @thrice(double* noalias %x, i64 %n) WIDTH {
entry:
  %some = icmp sgt i64 %n, 0
  br i1 %some, label %loop, label %exit
loop:
  %i = phi i64 [0, %entry], [%next, %loop]
  %place = getelementptr double, double* %x, i64 %i
  %value = load double, double* %place
  %product = fmul double %value, 3.0
  store double %product, double* %place
  %next = add nsw i64 %i, 1
  %more = icmp slt i64 %next, %n
  br i1 %more, label %loop, label %exit
exit:
  ret void
}
"""


def _loop_in_assembly() -> str:
    """A loop over an array of doubles as the compiler translates it for its processor."""
    import llvmlite.binding
    import numba  # noqa: F401  whole before its parts: another thread may be importing it as well
    from numba.core.compiler_lock import global_compiler_lock
    from numba.core.registry import cpu_target

    with global_compiler_lock:
        library = cpu_target.target_context.codegen().create_library("width")
        loop = llvmlite.binding.parse_assembly(_LOOP.replace("WIDTH", _preferred_width()))
        library.add_llvm_module(loop)
        library.finalize()
        return str(library.get_asm_str())


def compile_entry(function: Law, folder: Path, lanes: int) -> Law:
    """Compile an entry function, kept on disk in ``folder``.

    Without counting references to arrays (``_nrt``): it makes none but `own_memory`, and the
    counts would be kept in every step.
    """
    import numba

    dispatcher = numba.njit(nogil=True, **_options())(function)
    _keep_on_disk(dispatcher, folder)
    dispatcher.compile = _undisturbed(dispatcher.compile, vectors=lanes > 1)
    entry: Law = dispatcher
    return entry


def _options() -> dict[str, Any]:
    return {"error_model": "numpy", "fastmath": set(FASTMATH), "_nrt": False}


def _undisturbed(compile_for: Law, *, vectors: bool) -> Law:
    """Compile with loops as vectors or not, and without a collection of garbage meanwhile.

    One scenario has no lanes.  What is left are short loops over rows, which are to be unrolled:
    as vectors they must be gathered, and a step takes a third longer.  The compiler makes millions
    of small objects, nearly all of which live until it ends: to look through them again and again
    takes a tenth of its time.
    """

    def compiled(signature: Any) -> Any:
        import numba.core.config
        from numba.core.compiler_lock import global_compiler_lock

        config: Any = numba.core.config

        with global_compiler_lock:
            former = config.LOOP_VECTORIZE
            config.LOOP_VECTORIZE = former and int(vectors)
            collects = gc.isenabled()
            gc.disable()
            try:
                return compile_for(signature)
            finally:
                config.LOOP_VECTORIZE = former
                if collects:
                    gc.enable()

    return compiled


def own_memory(rows: int, lanes: int) -> Law:
    """Function that gives a compiled entry an array of its own, shape (rows, lanes).

    It lies on the stack: its row stride is known, and that nothing else points there.  With lanes
    the entry is one whose vectors are to be wide.
    """
    import numba  # whole before its parts: another thread may be importing it as well
    from llvmlite import ir
    from numba.core import types

    kind = types.Array(types.float64, 2, "C")

    def typed(typing_context: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            if lanes > 1:
                # the set's own `add` knows none that has a value
                set.add(builder.function.attributes, _preferred_width())
            with builder.goto_entry_block():
                place = builder.alloca(ir.ArrayType(ir.DoubleType(), rows * lanes))
                place.align = 64
            array = context.make_array(kind)(context, builder)
            word = context.get_value_type(types.intp)
            context.populate_array(
                array,
                data=builder.bitcast(place, ir.DoubleType().as_pointer()),
                shape=[word(rows), word(lanes)],
                strides=[word(8 * lanes), word(8)],
                itemsize=word(8),
                meminfo=None,
            )
            return array._getvalue()

        return kind(), generate

    law: Law = numba.extending.intrinsic(typed)
    return law


def compile_called(function: Law, lanes: int) -> Law:
    """Compile one called function so that it dissolves into its caller."""
    if function.__name__ in _instructions():
        return _instructions()[function.__name__]

    # Called from compiled code only: wrappers for Python and C would take a quarter of the time.
    options = {**_options(), "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    if "lanes" in function.__code__.co_varnames[: function.__code__.co_argcount]:
        # loops over lanes must be seen together with the arrays' making, or they are compiled for
        # any row stride: half as fast
        return _njit(options | {"inline": "always"})(function)
    law = _njit(options | {"forceinline": True})(function)
    if lanes == 1:  # abreast a step takes a fifth longer with it
        law.get_call_template = _whatever_values(law.get_call_template)
    return law


def _njit(options: dict[str, Any]) -> Any:
    import numba

    return numba.njit(**options)


def _whatever_values(template_for: Law) -> Law:
    """Types of a call without the values of its literal integers.

    A law would be compiled once for each side and each patch that it is called with.  Once it has
    dissolved into its caller the values are known there all the same.
    """

    def for_types(arguments: Any, named: Any) -> Any:
        from numba.core import types

        plain: Law = types.unliteral
        return template_for(
            tuple(plain(kind) for kind in arguments),
            {name: plain(kind) for name, kind in named.items()},
        )

    return for_types


@cache
def _instructions() -> dict[str, Law]:
    """Compiled counterparts of `elementary.bits_of`, `float_of`, `floor_of` and `larger_of`."""
    from llvmlite import ir
    from numba.core import types
    from numba.extending import intrinsic

    def cast(kind: Any, result: Any) -> Law:
        def typed(typing_context: Any, value: Any) -> Any:
            def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
                return builder.bitcast(arguments[0], context.get_value_type(result))

            return result(kind), generate

        law: Law = intrinsic(typed)
        return law

    def floor_typed(typing_context: Any, value: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            name = "llvm.floor"
            floor = builder.module.declare_intrinsic(name, [ir.DoubleType()])
            return builder.call(floor, arguments)

        return types.float64(types.float64), generate

    double = ir.DoubleType()

    def larger_typed(typing_context: Any, a: Any, b: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            largest = builder.module.declare_intrinsic(
                "llvm.maxnum", [double], ir.FunctionType(double, [double, double])
            )
            # one instruction, whatever it gives for NaN
            return builder.call(largest, arguments, fastmath=("nnan",))

        return types.float64(types.float64, types.float64), generate

    return {
        "floor_of": intrinsic(floor_typed),
        "larger_of": intrinsic(larger_typed),
        "bits_of": cast(types.float64, types.int64),
        "float_of": cast(types.int64, types.float64),
    }


def _keep_on_disk(dispatcher: Any, folder: Path) -> None:
    """Give the dispatcher an on-disk cache in ``folder``, which the variant alone names."""
    import numba
    from numba.core import caching, serialize

    dumps: Any = serialize.dumps

    class Locator(caching._CacheLocator):
        def __init__(self, py_file: str) -> None:
            self._py_file = py_file

        def get_cache_path(self) -> str:
            return str(folder)

        def get_source_stamp(self) -> str:
            return source_hash()

        def get_disambiguator(self) -> None:
            return None

        @classmethod
        def from_function(cls, py_func: Law, py_file: str) -> Locator:
            return cls(py_file)

    class Implementation(caching.CompileResultCacheImpl):
        _locator_classes = [Locator]  # type: ignore[list-item]  # noqa: RUF012

    class VariantCache(caching.FunctionCache):
        """One file for a signature, and no index: what is read is checked first."""

        _impl_class = Implementation

        def _index_key(self, signature: Any, codegen: Any) -> tuple[Any, ...]:
            # The stock key hashes the entry's closure and bytecode, but not the laws bound to its
            # globals; the folder's name covers those.
            return numba.__version__, signature, codegen.magic_tuple()

        def _file(self, key: tuple[Any, ...]) -> Path:
            digest = hashlib.sha256(repr(key).encode()).hexdigest()[:16]
            return folder / f"{self._impl.filename_base}.{digest}.nbc"

        def _load_overload(self, signature: Any, context: Any) -> Any:
            key = self._index_key(signature, context.codegen())
            content = kept(self._file(key))
            if content is None:
                return None
            try:
                found, data = pickle.loads(content)
                return self._impl.rebuild(context, data) if found == key else None
            except Exception:  # whatever another version of a library makes of it
                drop(self._file(key))
                return None

        def _save_overload(self, signature: Any, data: Any) -> None:
            if self._impl.check_cachable(data):
                key = self._index_key(signature, data.codegen)
                keep(self._file(key), dumps((key, self._impl.reduce(data))))

        def flush(self) -> None:
            """Nothing to empty: there is no index."""

    variant: Any = VariantCache
    dispatcher._cache = variant(dispatcher.py_func)
