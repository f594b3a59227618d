"""The only room that names the compiler.

`target`   where a kernel may run
`bind`     an entry function with the chosen laws in its slots, for a target
`cpu`      compiled for the processor's vectors
`cuda`     compiled for a GPU
`cache`    where machine code is kept
"""

from railquake.march.compiler.bind import Kernel, bind
from railquake.march.compiler.cache import cache_folder, source_hash
from railquake.march.compiler.cpu import lockstep_target, vector_doubles, vector_instructions
from railquake.march.compiler.cuda import (
    copy_to_device,
    device_name,
    device_stream,
    missing_for_cuda,
    ptx,
)
from railquake.march.compiler.target import CUDA, PYTHON, SCALAR, Target

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
