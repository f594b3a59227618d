"""Kernels on an NVIDIA GPU, a thread a scenario."""

from __future__ import annotations

import importlib
import importlib.util
from collections.abc import Callable
from functools import cache
from threading import Lock
from typing import Any

__all__ = [
    "compile_for_device",
    "copy_to_device",
    "device_name",
    "device_stream",
    "launcher",
    "missing_for_cuda",
    "own_memory",
    "ptx",
]

Law = Callable[..., Any]
cuda: Any = None  # see `_import_cuda`

THREADS = 32  # of a block: one warp, so that few scenarios reach all multiprocessors, too


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


def compile_for_device(function: Law) -> Law:
    """Compile one function called by a kernel on the GPU; in the simulator it stays as it is."""
    own = _device_functions().get(function.__name__)
    if own is not None:
        return own
    if _is_simulator():
        return function
    law: Law = _import_cuda().jit(device=True, forceinline=True)(function)
    return law


def own_memory(rows: int, lanes: int) -> Law:
    """Function that gives a thread an array of its own; see `cpu.own_memory`."""
    if _is_simulator():
        import numpy as np

        return lambda: np.empty((rows, lanes))
    # a thread's memory must be made in the kernel itself
    law: Law = _import_cuda().jit(device=True, inline="always")(_own_memory(rows, lanes))
    return law


def _own_memory(ROWS: int, LANES: int) -> Law:
    def own() -> Any:
        return cuda.local.array((ROWS, LANES), "float64")

    return own


@cache
def _device_functions() -> dict[str, Law]:
    """What takes the place of `frames.thread_number` and of the elementary functions."""
    jit = _import_cuda().jit
    if _is_simulator():
        return {"thread_number": jit(_thread_number, device=True)}
    return {
        "thread_number": jit(_thread_number, device=True, forceinline=True),
        "floor_of": jit(_floor_of, device=True, forceinline=True),
        "bits_of": jit(_bits_of, device=True, forceinline=True),
        "float_of": jit(_float_of, device=True, forceinline=True),
    }


def _thread_number() -> Any:
    return cuda.grid(1)


def _floor_of(x: float) -> Any:
    return cuda.libdevice.floor(x)


def _bits_of(x: float) -> Any:
    return cuda.libdevice.double_as_longlong(x)


def _float_of(bits: int) -> Any:
    return cuda.libdevice.longlong_as_double(bits)


_LAUNCHING = Lock()  # the compiler takes one thread at a time, and so does the simulator


def launcher(function: Law) -> Law:
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


def ptx(kernel: Any, arguments: tuple[Any, ...], capability: tuple[int, int]) -> str:
    """Assembly of a kernel of the target `CUDA`; no GPU is needed.

    Parameters
    ----------
    kernel : compiler.Kernel
    arguments : tuple
        Arguments of the entry function; only their types matter.
    capability : (int, int)
        Compute capability of the GPU that it is for, such as (9, 0).
    """
    from types import SimpleNamespace
    from unittest.mock import patch

    typeof = importlib.import_module("numba").typeof

    signature = tuple(typeof(argument) for argument in arguments)
    function = kernel.call.dispatcher.py_func
    # the functions that it calls would ask for the GPU that is there
    device = SimpleNamespace(compute_capability=capability)
    with patch("numba.cuda.dispatcher.get_current_device", lambda: device):
        code, _ = _import_cuda().compile_ptx(function, signature, cc=capability)
    return str(code)
