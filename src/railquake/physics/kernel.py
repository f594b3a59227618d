"""The one place that names the compiler.

``bind`` takes an entry function of the physics, follows the plain functions that it calls, swaps
the laws and the constants that were chosen at assembly, and compiles the set for a target.  The
physics files themselves know nothing of this: under the target ``PYTHON`` the very same source
runs in the interpreter, where a debugger and a coverage tool can see it.
"""

from __future__ import annotations

import hashlib
import importlib
import importlib.util
import os
import re
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from threading import Lock
from types import FunctionType
from typing import Any

__all__ = [
    "CUDA",
    "PYTHON",
    "SCALAR",
    "Kernel",
    "Target",
    "bind",
    "cache_folder",
    "copy_to_device",
    "device_name",
    "device_stream",
    "lockstep_target",
    "missing_for_cuda",
    "ptx",
    "source_hash",
    "vector_doubles",
    "vector_instructions",
]

Law = Callable[..., Any]
cuda: Any = None  # see `_import_cuda`

# Reassociation and contraction let LLVM use fused multiply-adds and vectors.  "nnan" and "ninf"
# are left out on purpose: with them a test for a diverged state would be optimised away.
FASTMATH = frozenset({"contract", "arcp", "nsz", "reassoc"})


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
THREADS = 32  # of a block: one warp, so that few scenarios reach all multiprocessors, too


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

    They may be fewer than the machine has room for: LLVM keeps to 256 bits on many processors with
    AVX-512, where wider vectors slow the clock.  So it is asked, by a loop that it vectorises.
    """
    code = _loop_in_assembly()
    return next((doubles for doubles in (8, 4, 2) if vector_instructions(code, doubles)), 1)


def vector_instructions(code: str, doubles: int) -> int:
    """Instructions in assembly (x86-64 or arm64) on vectors of so many doubles."""
    return len(re.findall(VECTORS[doubles], code, re.MULTILINE))


VECTORS = {
    8: r"^\s+v\w+pd\b.*%zmm\d",
    4: r"^\s+v\w+pd\b.*%ymm\d",
    2: r"^\s+v?\w+pd\b.*%xmm\d|^\s.*\.2d\b|^\s.*\bz\d+\.d\b",  # SSE, NEON, SVE
}

_LOOP = """
define void @thrice(double* noalias %x, i64 %n) {
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
    from numba.core.compiler_lock import global_compiler_lock
    from numba.core.registry import cpu_target

    with global_compiler_lock:
        library = cpu_target.target_context.codegen().create_library("width")
        library.add_llvm_module(llvmlite.binding.parse_assembly(_LOOP))
        library.finalize()
        return str(library.get_asm_str())


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
    """Hash of every physics source file.

    The compiler's own cache looks at the entry function's file alone: an edit of a law in another
    file would go unseen and stale physics would answer.  So the cache's folder is named by this.
    """
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(path.name.encode())
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def bind(
    entry: Law,
    target: Target,
    laws: Mapping[Law, Law] | None = None,
    constants: Mapping[str, int] | None = None,
) -> Kernel:
    """Compile ``entry`` and all physics functions that it calls.

    Parameters
    ----------
    entry : function
        For example ``march.march``.
    target : Target
    laws : mapping of function to function, optional
        Laws to put in the place of others wherever they are called (a creep law, a hinge ...).
    constants : mapping of str to int, optional
        Module constants to replace, by name, such as ``{"DOF_COUNT": 6}``.

    Returns
    -------
    Kernel
    """
    chosen = tuple(
        (original.__qualname__, law.__qualname__) for original, law in (laws or {}).items()
    )
    key = repr((entry.__qualname__, target.name, chosen, sorted((constants or {}).items())))
    return _bind_cached(entry, target, key, _Frozen(laws or {}), _Frozen(constants or {}))


class _Frozen(dict[Any, Any]):
    """A mapping that ``functools.cache`` accepts; ``key`` already tells two of them apart."""

    def __hash__(self) -> int:  # type: ignore[override]
        return 0


@cache
def _bind_cached(
    entry: Law, target: Target, key: str, laws: Mapping[Law, Law], constants: Mapping[str, int]
) -> Kernel:
    done: dict[Law, Law] = {}
    rebuilt = _rebuild(entry, target, laws, constants, done)
    if target is CUDA:
        return Kernel(_launcher(rebuilt), None)
    if not target.compiled:
        return Kernel(rebuilt, None)
    import numba

    variant = hashlib.sha256(key.encode()).hexdigest()[:12]
    folder = cache_folder() / "kernels" / source_hash() / f"{target.name}-{variant}"
    dispatcher = numba.njit(nogil=True, error_model="numpy", fastmath=set(FASTMATH))(rebuilt)
    _keep_on_disk(dispatcher, folder)
    return Kernel(dispatcher, folder)


def _rebuild(
    function: Law,
    target: Target,
    laws: Mapping[Law, Law],
    constants: Mapping[str, int],
    done: dict[Law, Law],
) -> Law:
    """Copy of ``function`` whose globals hold the bound laws and constants instead."""
    assert isinstance(function, FunctionType)
    names = function.__globals__.copy()
    for name in function.__code__.co_names:
        value = names.get(name)
        if name in constants:
            names[name] = constants[name]
        elif isinstance(value, FunctionType) and value.__module__.startswith(__package__ + "."):
            law = laws.get(value, value)
            if law.__code__ is function.__code__:
                law = value  # a law that wraps the one it stands for
            if law not in done:
                done[law] = _finish(_rebuild(law, target, laws, constants, done), target)
            names[name] = done[law]
    copy = FunctionType(
        function.__code__, names, function.__name__, function.__defaults__, function.__closure__
    )
    copy.__module__ = function.__module__
    copy.__qualname__ = function.__qualname__
    copy.__doc__ = function.__doc__
    return copy


def _finish(function: Law, target: Target) -> Law:
    """Compile one called function so that it dissolves into its caller."""
    if target is CUDA:
        return _on_device(function)
    if not target.compiled:
        return function
    import numba

    if function.__name__ in _instructions():
        return _instructions()[function.__name__]

    # without counting references to arrays ("_nrt"): a law neither makes nor keeps any
    options: dict[str, Any] = {"error_model": "numpy", "fastmath": set(FASTMATH), "_nrt": False}
    if "lanes" in function.__code__.co_varnames[: function.__code__.co_argcount]:
        # loops over lanes must be seen together with the arrays' making, or they are compiled for
        # any row stride: half as fast
        options["inline"] = "always"
    else:
        options["forceinline"] = True
    law: Law = numba.njit(**options)(function)
    return law


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


def _import_cuda() -> Any:
    """Module ``numba.cuda``, also as this module's ``cuda`` (where its simulator looks for it)."""
    global cuda
    if cuda is None:
        from numba import cuda as imported

        cuda = imported
    return cuda


def _is_simulator() -> bool:
    from numba.cuda.core import config

    return bool(config.ENABLE_CUDASIM)


def _on_device(function: Law) -> Law:
    """Compile one function called by a kernel on the GPU; in the simulator it stays as it is."""
    own = _device_functions().get(function.__name__)
    if own is not None:
        return own
    if _is_simulator():
        return function
    law: Law = _import_cuda().jit(device=True, forceinline=True)(function)
    return law


@cache
def _device_functions() -> dict[str, Law]:
    """What takes the place of `march.thread_number`, `march.own_rows`, `elementary.floor_of`."""
    jit = _import_cuda().jit
    if _is_simulator():
        return {"thread_number": jit(_thread_number, device=True)}
    return {
        "thread_number": jit(_thread_number, device=True, forceinline=True),
        "floor_of": jit(_floor_of, device=True, forceinline=True),
        "bits_of": jit(_bits_of, device=True, forceinline=True),
        "float_of": jit(_float_of, device=True, forceinline=True),
        # a thread's memory must be made in the kernel itself
        "own_rows": jit(_own_rows, device=True, inline="always"),
    }


def _thread_number() -> Any:
    return cuda.grid(1)


def _own_rows(rows: int) -> Any:
    return cuda.local.array((rows, 1), "float64")


def _floor_of(x: float) -> Any:
    return cuda.libdevice.floor(x)


def _bits_of(x: float) -> Any:
    return cuda.libdevice.double_as_longlong(x)


def _float_of(bits: int) -> Any:
    return cuda.libdevice.longlong_as_double(bits)


_LAUNCHING = Lock()  # the compiler takes one thread at a time, and so does the simulator


def _launcher(function: Law) -> Law:
    """The kernel on the GPU; the number of threads and the stream come before its arguments."""
    dispatcher = _import_cuda().jit(function)

    def launch(threads: int, stream: Any, *arguments: Any) -> None:
        with _LAUNCHING:
            dispatcher[-(-threads // THREADS), THREADS, stream](*arguments)

    launch.dispatcher = dispatcher  # type: ignore[attr-defined]
    return launch


def missing_for_cuda() -> str | None:
    """What keeps the target `CUDA` from running here, in words; None if nothing does."""
    if importlib.util.find_spec("numba_cuda") is None:
        return "numba-cuda is not installed; pip install railquake[gpu]"
    if _import_cuda().is_available():
        return None
    nvvm: Any = importlib.import_module("numba.cuda.cudadrv.nvvm")
    if not nvvm.is_available():
        return "numba-cuda finds no compiler for the GPU; pip install railquake[gpu]"
    return "no NVIDIA GPU answers here, or its driver is missing; run on the CPU instead"


def device_name() -> str:
    """The GPU's name."""
    if _is_simulator():
        return "simulator"
    name = _import_cuda().get_current_device().name
    return name.decode() if isinstance(name, bytes) else str(name)


def device_stream() -> Any:
    """A new queue of work on the GPU."""
    return _import_cuda().stream()


def copy_to_device(array: Any, stream: Any) -> Any:
    """A copy of an array in the GPU's memory.

    It has ``copy_to_device(host, stream)`` and ``copy_to_host(host, stream)``, and slices.
    """
    return _import_cuda().to_device(array, stream=stream)


def ptx(kernel: Kernel, arguments: tuple[Any, ...], capability: tuple[int, int]) -> str:
    """Assembly of a kernel of the target `CUDA`; no GPU is needed.

    Parameters
    ----------
    kernel : Kernel
    arguments : tuple
        Arguments of the entry function; only their types matter.
    capability : (int, int)
        Compute capability of the GPU that it is for, such as (9, 0).
    """
    from types import SimpleNamespace
    from unittest.mock import patch

    typeof = importlib.import_module("numba").typeof

    signature = tuple(typeof(argument) for argument in arguments)
    function = kernel.call.dispatcher.py_func  # type: ignore[attr-defined]
    # the functions that it calls would ask for the GPU that is there
    device = SimpleNamespace(compute_capability=capability)
    with patch("numba.cuda.dispatcher.get_current_device", lambda: device):
        code, _ = _import_cuda().compile_ptx(function, signature, cc=capability)
    return str(code)


def _keep_on_disk(dispatcher: Any, folder: Path) -> None:
    """Give the dispatcher an on-disk cache in ``folder``, which the variant alone names."""
    from numba.core import caching

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
        _impl_class = Implementation

        def _index_key(self, signature: Any, codegen: Any) -> tuple[Any, ...]:
            # The stock key hashes the entry's closure and bytecode, but not the laws bound to its
            # globals; the folder's name covers those.
            return signature, codegen.magic_tuple()

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return  # an unwritable cache costs a compilation in each process, nothing more
    variant: Any = VariantCache
    dispatcher._cache = variant(dispatcher.py_func)
