"""What a run gave: histories, events, the energy audit and how it ended."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from railquake.march.order import kernel_order
from railquake.physics.derailment import CHATTER, EVENTS, ONSET, UPLIFT
from railquake.physics.energy import EnergyAudit
from railquake.physics.momentum import MomentumAudit
from railquake.run import verdict
from railquake.run.audit import momentum_audit

if TYPE_CHECKING:
    import xarray

    from railquake.assembly import System
    from railquake.run.time_step import TimeStep
    from railquake.run.verdict import Happening

__all__ = ["EVENT_NAMES", "Channel", "Event", "Response", "channels"]

Array = np.ndarray[Any, np.dtype[np.float64]]

EVENT_NAMES = EVENTS


class Channel(NamedTuple):
    """One quantity of a history."""

    name: str
    row: int
    """Of the state."""
    unit: str
    meaning: str
    train: bool
    """Whether it is NaN once the train has left the track."""


def channels(system: System) -> tuple[Channel, ...]:
    """Everything kept in a history: what is declared so, and the bodies' displacements."""
    layout = system.layout
    found = [
        Channel(part.channel, row, part.unit, part.meaning, train)
        for part, row, train in layout.state_parts
        if part.channel is not None
    ]
    place = np.argsort(kernel_order(layout.size.DOFS))
    for i, body in enumerate(system.vehicle.bodies):
        name = body.replace(" ", "_").replace("-", "_")
        for k, (what, unit) in enumerate(
            (("lateral_m", "m"), ("vertical_m", "m"), ("roll_rad", "rad"))
        ):
            row = layout.state.VEHICLE_X + int(place[3 * i + k])
            meaning = f"{body}, from the undeformed position"
            found.append(Channel(f"{name}_{what}", row, unit, meaning, True))
    return tuple(found)


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
    def momentum(self) -> MomentumAudit:
        """Whether what pushes the train is what moves it."""
        return momentum_audit(self.system, self.end)

    @property
    def status(self) -> str:
        """``safe``, ``onset``, ``derailed``, ``diverged`` or ``not converged``."""
        end, state = self.end[:, 0], self.system.layout.state
        if end[state.DIVERGED] > 0.0:
            return "diverged"
        if end[state.UNCONVERGED] > 0.0:
            return "not converged"
        if self.derailment_mode is not None:
            return "derailed"
        if end[state.FIRST_TIME + ONSET] >= 0.0:
            return "onset"
        return "safe"

    @property
    def _ending(self) -> verdict.Ending:
        return verdict.Ending(self.end, self.system.layout.state)

    @property
    def derailment_mode(self) -> str | None:
        """How it derailed and to which side, such as ``slide-off left``; None if it did not."""
        return verdict.derailment_mode(self._ending)

    @property
    def beyond_model(self) -> str | None:
        """Why the car has been where its model ends; what follows is not to be believed."""
        return verdict.beyond_model(self._ending)

    @property
    def happenings(self) -> tuple[Happening, ...]:
        """Every event when it first held, with its side and where the wheelset was."""
        return verdict.happenings(self._ending)

    def explain(self) -> str:
        """What happened to the train, in sentences; see `verdict.explain`."""
        return verdict.explain(self._ending)

    @property
    def times(self) -> Array:
        """Times of the history, s."""
        frame = self.system.dt * self.system.frame_steps
        times: Array = np.arange(len(self.frames), dtype=float) * frame
        return times

    def channel(self, name: str) -> Array:
        """One channel of the history by its name, shape (frames + 1,)."""
        for k, known in enumerate(channels(self.system)):
            if known.name == name:
                return self.frames[:, k]
        raise KeyError(name)

    @property
    def history(self) -> xarray.Dataset:
        """Histories with names and units; the train's are NaN once it has left the track."""
        import xarray

        variables = {
            kept.name: (
                "time_s",
                self.frames[:, k],
                {"units": kept.unit, "long_name": kept.meaning},
            )
            for k, kept in enumerate(channels(self.system))
        }
        return xarray.Dataset(variables, coords={"time_s": ("time_s", self.times, {"units": "s"})})

    @property
    def events(self) -> tuple[Event, ...]:
        """All events in the order of their beginnings.

        A contact that is lost and made again within `derailment.CHATTER` has not ended.
        """
        flags = np.rint(self.channel("events")).astype(int)
        time = self.times
        found = []
        for k, name in enumerate(EVENT_NAMES):
            holds = (flags >> k) & 1
            change = np.diff(np.concatenate([[0], holds, [0]]))
            begins, ends = np.flatnonzero(change > 0), np.flatnonzero(change < 0)
            apart = (begins[1:] - ends[:-1]) * (time[1] - time[0]) > CHATTER
            begins = begins[np.concatenate([[True], apart])] if len(begins) else begins
            ends = ends[np.concatenate([apart, [True]])] if len(ends) else ends
            for begin, end in zip(begins, ends, strict=True):
                last = float(time[end]) if end < len(time) else float("nan")
                found.append(Event(name, float(time[begin]), last))
        return tuple(sorted(found, key=lambda event: event.begin_s))

    @property
    def worst_frame(self) -> int:
        """Frame with the largest relative roll, or without any uplift the largest shift."""
        roll = np.abs(self.channel("relative_roll_rad"))
        shift = np.abs(self.channel("lateral_shift_m"))
        lifted = self.end[self.system.layout.state.FIRST_TIME + UPLIFT, 0] >= 0.0
        return int(np.nanargmax(roll if lifted else shift))

    @property
    def reference_roll(self) -> float:
        """Relative roll at the onset of slide-off, rad."""
        return float(self.system.constants[self.system.layout.constant.REFERENCE_ROLL, 0])
