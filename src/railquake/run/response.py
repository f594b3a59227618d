"""What a run gave: histories, events, the energy audit and how it ended."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.physics import constant, state
from railquake.physics.energy import EnergyAudit
from railquake.physics.vehicle import kernel_order

if TYPE_CHECKING:
    import xarray

    from railquake.assembly import System
    from railquake.run.time_step import TimeStep

__all__ = ["EVENT_NAMES", "Event", "Response", "channels"]

Array = np.ndarray[Any, np.dtype[np.float64]]

EVENT_NAMES = (
    "flange contact",
    "uplift",
    "onset",
    "flange over",
    "derailed",
    "overturned",
)

# name, state row, unit, what it is
_CHANNELS = (
    ("ground_acceleration_m_s2", state.GROUND, "m/s2", "ground acceleration, lateral"),
    ("ground_acceleration_down_m_s2", state.GROUND_Z, "m/s2", "ground acceleration, down"),
    ("bridge_displacement_m", state.U, "m", "pier top relative to the ground"),
    ("bridge_velocity_m_s", state.U_V, "m/s", "pier top relative to the ground"),
    ("bridge_acceleration_m_s2", state.U_A, "m/s2", "pier top, absolute"),
    ("hinge_rotation_rad", state.THETA1, "rad", "rotation of the plastic hinge, theta_1"),
    ("top_rotation_rad", state.THETA2, "rad", "rotation of the pier's top, theta_2"),
    ("base_moment_n_m", state.MOMENT, "N m", "moment of the hinge"),
    ("hinge_z_rad", state.Z, "rad", "hysteretic rotation z"),
    ("hinge_energy_per_mass", state.EPS, "m2/s2", "hysteretic energy per mass"),
    ("hinge_largest_rotation_rad", state.X_MAX, "rad", "largest hinge rotation so far"),
    ("track_lateral_m", state.TRACK_Y, "m", "track's origin, right"),
    ("track_vertical_m", state.TRACK_Z, "m", "track's origin, down"),
    ("track_roll_rad", state.TRACK_PHI, "rad", "track's roll, right side down"),
    (
        "lateral_shift_m",
        state.SHIFT,
        "m",
        "wheelset relative to the track, right; NaN once it has left the track",
    ),
    ("wheelset_height_m", state.HEIGHT, "m", "wheelset's centre in track axes, down"),
    ("relative_roll_rad", state.ROLL, "rad", "wheelset relative to the track"),
    ("wheel_load_left_n", state.LOAD_LEFT, "N", "vertical load of the left wheels"),
    ("wheel_load_right_n", state.LOAD_RIGHT, "N", "vertical load of the right wheels"),
    ("lateral_force_n", state.FORCE_Y, "N", "of the train on the track"),
    ("lateral_force_filtered_n", state.FILTER + 2, "N", "the same, low-passed"),
    ("wheel_load_left_filtered_n", state.FILTER + 6, "N", "low-passed"),
    ("wheel_load_right_filtered_n", state.FILTER + 10, "N", "low-passed"),
    ("penetration_left_tread_m", state.PATCH + 1, "m", "vertical, left tread; negative: gap"),
    ("penetration_left_flange_m", state.PATCH + state.PATCH_ROWS + 1, "m", "vertical, left flange"),
    (
        "penetration_right_tread_m",
        state.PATCH + 2 * state.PATCH_ROWS + 1,
        "m",
        "vertical, right tread",
    ),
    (
        "penetration_right_flange_m",
        state.PATCH + 3 * state.PATCH_ROWS + 1,
        "m",
        "vertical, right flange",
    ),
    ("events", state.FLAGS, "1", "sum of 2^k over the events k that hold"),
)


def channels(bodies: tuple[str, ...]) -> tuple[tuple[str, int, str, str], ...]:
    """Name, state row, unit and meaning of everything kept in a history."""
    body_channels = []
    place = np.argsort(kernel_order(3 * len(bodies)))
    for i, body in enumerate(bodies):
        name = body.replace(" ", "_").replace("-", "_")
        for k, (what, unit) in enumerate(
            (("lateral_m", "m"), ("vertical_m", "m"), ("roll_rad", "rad"))
        ):
            body_channels.append(
                (
                    f"{name}_{what}",
                    state.VEHICLE + int(place[3 * i + k]),
                    unit,
                    f"{body}, from the undeformed position",
                )
            )
    return _CHANNELS + tuple(body_channels)


@dataclass(frozen=True)
class Event:
    """Something that began or ended during a run.

    Attributes
    ----------
    name : str
        One of `EVENT_NAMES`.
    begin_s, end_s : float
        To the frame (1 ms unless set otherwise); ``end_s`` is NaN if it held to the end.
    """

    name: str
    begin_s: float
    end_s: float


@dataclass(frozen=True)
class Response:
    """Everything that a run gave.

    Attributes
    ----------
    system : System
        What was run.
    end : array, shape (state rows, 1)
        State at the end, with peaks and energies.
    frames : array, shape (frames + 1, channels)
        Channels at the end of each frame; use `history` for names.
    audit : EnergyAudit
    wall_s : float
        Time that the whole run took.
    march_s : float
        Time spent in the kernel, compilation apart.
    time_step : TimeStep, optional
        How the step was chosen, where the scenario left it open.
    """

    system: System
    end: Array
    frames: Array
    audit: EnergyAudit
    wall_s: float
    march_s: float
    time_step: TimeStep | None = None

    @property
    def steps(self) -> int:
        """Time steps marched."""
        return (len(self.frames) - 1) * self.system.frame_steps

    @property
    def status(self) -> str:
        """``safe``, ``onset``, ``derailed``, ``diverged`` or ``not converged``."""
        end = self.end[:, 0]
        if end[state.DIVERGED] > 0.0:
            return "diverged"
        if end[state.UNCONVERGED] > 0.0:
            return "not converged"
        if self.derailment_mode is not None:
            return "derailed"
        if end[state.FIRST_TIME + state.ONSET] >= 0.0:
            return "onset"
        return "safe"

    @property
    def derailment_mode(self) -> str | None:
        """How it derailed: ``slide-off`` or ``overturned``, to the ``left`` or ``right``."""
        end = self.end[:, 0]
        if end[state.ON_TRACK] > 0.0 or end[state.DIVERGED] > 0.0:
            return None
        if end[state.FIRST_TIME + state.DERAILED] >= 0.0:
            return "slide-off right" if end[state.SHIFT] > 0.0 else "slide-off left"
        return "overturned right" if end[state.ROLL] > 0.0 else "overturned left"

    @property
    def times(self) -> Array:
        """Times of the history, s."""
        frame = self.system.dt * self.system.frame_steps
        times: Array = np.arange(len(self.frames), dtype=float) * frame
        return times

    def channel(self, name: str) -> Array:
        """One channel of the history by its name, shape (frames + 1,)."""
        for k, (known, _, _, _) in enumerate(channels(self.system.vehicle.bodies)):
            if known == name:
                return self.frames[:, k]
        raise KeyError(name)

    @property
    def history(self) -> xarray.Dataset:
        """Histories with names and units; the train's are NaN once it has left the track."""
        import xarray

        variables = {
            name: ("time_s", self.frames[:, k], {"units": unit, "long_name": meaning})
            for k, (name, _, unit, meaning) in enumerate(channels(self.system.vehicle.bodies))
        }
        return xarray.Dataset(variables, coords={"time_s": ("time_s", self.times, {"units": "s"})})

    @property
    def events(self) -> tuple[Event, ...]:
        """All events in the order of their beginnings."""
        flags = np.rint(self.channel("events")).astype(int)
        time = self.times
        found = []
        for k, name in enumerate(EVENT_NAMES):
            holds = (flags >> k) & 1
            change = np.diff(np.concatenate([[0], holds, [0]]))
            for begin, end in zip(
                np.flatnonzero(change > 0), np.flatnonzero(change < 0), strict=True
            ):
                last = float(time[end]) if end < len(time) else float("nan")
                found.append(Event(name, float(time[begin]), last))
        return tuple(sorted(found, key=lambda event: event.begin_s))

    @property
    def worst_frame(self) -> int:
        """Frame with the largest relative roll, or without any uplift the largest shift."""
        roll = np.abs(self.channel("relative_roll_rad"))
        shift = np.abs(self.channel("lateral_shift_m"))
        lifted = self.end[state.FIRST_TIME + state.UPLIFT, 0] >= 0.0
        return int(np.nanargmax(roll if lifted else shift))

    @property
    def reference_roll(self) -> float:
        """Relative roll at the onset of slide-off, rad."""
        return float(self.system.constants[constant.REFERENCE_ROLL, 0])
