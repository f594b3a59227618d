"""Lanes of a batch on a GPU: thousands of scenarios, a thread each.

The contact tables and, in a batch, each distinct motion are on the device once.  States go there
and back with every chunk of frames, and nothing is kept of a run but its lane: memory does not grow
with the number of scenarios.
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.errors import InputError
from railquake.march.compiler import CUDA, copy_to_device, device_stream, missing_for_cuda
from railquake.memory import Bounded
from railquake.physics.profiles import Geometry

if TYPE_CHECKING:
    from railquake.assembly import System

__all__ = ["DeviceLanes", "require_device", "require_known"]

Array = np.ndarray[Any, np.dtype[np.float64]]

# Two threads' batches fill the largest GPU: at 255 registers a multiprocessor holds 256 threads.
MOST_LANES = 16_384
FIRST_LANES = 64
MOTION_BYTES = 2 * 1024**3  # of the motions of one batch
CHUNK = 200  # frames that are run at once
GEOMETRIES = 8  # kept on the device


def require_known(device: str) -> None:
    """Refuse a device that is neither ``cpu`` nor ``cuda``.

    Raises
    ------
    InputError
    """
    if device not in ("cpu", "cuda"):
        raise InputError(f'device: must be cpu or cuda, found "{device}"')


def require_device() -> None:
    """Refuse where no GPU can be used.

    Raises
    ------
    InputError
        If numba-cuda is not installed or there is no GPU.
    """
    missing = missing_for_cuda()
    if missing is not None:
        raise InputError(f"device: cuda cannot be used: {missing}")


class DeviceLanes:
    """What `many.Lanes` asks for, on the GPU.

    Parameters
    ----------
    system : System
        Any of the systems that are to run; they share kernel and contact table.
    refresh_steps : int
        See `simulate_many`.
    """

    most = MOST_LANES
    compiling: str | None = "compiling for the GPU (in each process; about half a minute) ..."

    def __init__(self, system: System, refresh_steps: int) -> None:
        self.kernel = system.kernel(CUDA)
        self.stream = device_stream()
        self.geometry = _on_device(system.geometry, self.stream)
        self.refresh_steps = refresh_steps
        self.motions = _Motions(system.drive.shape[1], self.stream)
        self.taken: dict[int, _Motion] = {}  # by lane
        self.constants_changed = True
        self.states = np.zeros((0, len(system.start)))
        self.constants = np.zeros((0, len(system.constants)))
        self.frames_row = system.layout.state.FRAMES
        self.first, self.frames = np.zeros((2, 0), dtype=np.int64)
        self._widen(FIRST_LANES)

    def _widen(self, lanes: int) -> None:
        """Make room for lanes up to this number."""

        def wider(array: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
            more = np.zeros((lanes - len(array), *array.shape[1:]), dtype=array.dtype)
            return np.concatenate([array, more])

        self.states, self.constants = wider(self.states), wider(self.constants)
        self.first, self.frames = wider(self.first), wider(self.frames)
        self.on_device = [
            copy_to_device(array, self.stream)
            for array in (self.states, self.constants, self.first, self.frames)
        ]

    @property
    def is_full(self) -> bool:
        """Whether there is no room for another motion."""
        return self.motions.bytes_in_use >= MOTION_BYTES

    def load(self, lane: int, system: System) -> System:
        """Give a lane a system; returns it with what it shares with other lanes."""
        if lane >= len(self.states):
            self._widen(min(self.most, max(2 * len(self.states), lane + 1)))
        motion = self.motions.take(system)
        self.taken[lane] = motion
        self.states[lane] = system.start[:, 0]
        self.constants[lane] = system.constants[:, 0]
        self.constants_changed = True
        return replace(system, drive=motion.system.drive, ground=motion.system.ground)

    def release(self, lane: int) -> None:
        """Leave a lane idle."""
        self.motions.give_back(self.taken.pop(lane))

    def march(self, left: dict[int, int]) -> None:
        """Run the lanes for a while, each no further than the frames that are ``left`` to it."""
        self.frames[:] = 0
        for lane, frames in left.items():
            self.frames[lane] = min(frames, CHUNK)
            self.first[lane] = self.taken[lane].first
        states, constants, first, count = self.on_device
        states.copy_to_device(self.states, self.stream)
        if self.constants_changed:
            constants.copy_to_device(self.constants, self.stream)
            self.constants_changed = False
        first.copy_to_device(self.first, self.stream)
        count.copy_to_device(self.frames, self.stream)
        self.kernel.call(
            len(self.states),
            self.stream,
            states,
            constants,
            self.geometry,
            self.motions.on_device(),
            first,
            count,
            self.refresh_steps,
        )
        states.copy_to_host(self.states, self.stream)
        self.stream.synchronize()

    def frames_done(self, lane: int) -> int:
        """Frames that a lane has behind it."""
        return int(self.states[lane, self.frames_row])

    def state(self, lane: int) -> Array:
        """State of a lane, shape (state rows, 1)."""
        return self.states[lane][:, np.newaxis]


@dataclass
class _Motion:
    system: System  # one of those that have it
    first: int  # row of the drive at which it begins
    users: int = 0  # lanes


class _Motions:
    """Motions of a batch, one after the other, each distinct one once."""

    def __init__(self, columns: int, stream: Any) -> None:
        self.stream = stream
        self.known: dict[bytes, _Motion] = {}
        self.drive = np.zeros((0, columns))
        self.end = 0  # rows filled
        self.used = 0  # rows of motions that lanes have
        self.sent = 0  # rows that are on the device
        self.copy: Any = None

    @property
    def bytes_in_use(self) -> int:
        """Size of the motions that lanes have."""
        return self.used * self.drive.shape[1] * self.drive.itemsize

    def take(self, system: System) -> _Motion:
        """The system's motion, noted as used once more."""
        digest = hashlib.blake2b(system.drive.tobytes(), digest_size=16)
        digest.update(system.ground.acceleration.tobytes())
        key = digest.digest()
        motion = self.known.get(key)
        if motion is None:
            rows = len(system.drive)
            if self.end + rows > len(self.drive):
                self._make_room(rows)
            motion = self.known[key] = _Motion(system, self.end)
            self.drive[self.end : self.end + rows] = system.drive
            self.end += rows
        if motion.users == 0:
            self.used += len(system.drive)
        motion.users += 1
        return motion

    def give_back(self, motion: _Motion) -> None:
        """A lane has no more use of a motion."""
        motion.users -= 1
        if motion.users == 0:
            self.used -= len(motion.system.drive)

    def _make_room(self, rows: int) -> None:
        """Forget motions that no lane uses; double the room where that is too little."""
        self.known = {key: motion for key, motion in self.known.items() if motion.users}
        needed = rows + self.used
        room = len(self.drive)
        self.drive = np.zeros((room if 2 * needed <= room else 2 * needed, self.drive.shape[1]))
        self.end = 0
        for motion in self.known.values():
            motion.first = self.end
            self.end += len(motion.system.drive)
            self.drive[motion.first : self.end] = motion.system.drive
        self.copy = None

    def on_device(self) -> Any:
        """All motions on the device."""
        if self.copy is None:
            self.copy = copy_to_device(self.drive, self.stream)
        elif self.sent < self.end:
            new = slice(self.sent, self.end)
            self.copy[new].copy_to_device(self.drive[new], self.stream)
        self.sent = self.end
        return self.copy


_GEOMETRIES: Bounded[int, tuple[Geometry, Geometry]] = Bounded(GEOMETRIES)


def _on_device(geometry: Geometry, stream: Any) -> Geometry:
    """Profiles and contact table on the device, for all batches that have them."""

    def copied() -> tuple[Geometry, Geometry]:
        arrays = {
            name: copy_to_device(value, stream)
            for name, value in geometry._asdict().items()
            if isinstance(value, np.ndarray)
        }
        copy = geometry._replace(**arrays)
        stream.synchronize()
        return geometry, copy

    # an identity that is not used again while the table is kept here
    return _GEOMETRIES.get(id(geometry.table), copied)[1]
