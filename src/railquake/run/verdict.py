"""What happened to the train: events in their order, how it derailed, and both in sentences.

All of it was stored when it happened (`march.events`), so it is there for every run, with or
without a history.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from railquake.physics.derailment import (
    BEYOND,
    CLIMB,
    COMBINED_WITHIN,
    DERAILMENTS,
    EVENTS,
    FLANGE_CONTACT,
    FLANGE_OVER,
    ONSET,
    OVERTURNED,
    SLIDE_OFF,
    UPLIFT,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from railquake.march.rows import Numbers

__all__ = ["Ending", "Happening", "beyond_model", "derailment_mode", "explain", "happenings"]

Array = np.ndarray[Any, np.dtype[np.float64]]


class Ending(NamedTuple):
    """State of a run at its end."""

    end: Array
    """Shape (state rows, 1)."""
    state: Numbers
    """Its rows by their names."""


class Happening(NamedTuple):
    """An event when it first held."""

    event: str
    """One of `derailment.EVENTS`."""
    time_s: float
    side: str
    """``left`` or ``right``: the wheels that lift or touch, or where the train goes."""
    displacement_m: float
    """Of the bearing wheel on its rail, right."""
    roll_rad: float
    """Relative roll."""


def _number(ending: Ending, row: str, event: int = 0) -> float:
    return float(ending.end[getattr(ending.state, row) + event, 0])


def _first(ending: Ending, event: int) -> Happening | None:
    time = _number(ending, "FIRST_TIME", event)
    if time < 0.0:
        return None
    return Happening(
        EVENTS[event],
        time,
        "right" if _number(ending, "FIRST_SIDE", event) > 0.0 else "left",
        _number(ending, "FIRST_DISPLACEMENT", event),
        _number(ending, "FIRST_ROLL", event),
    )


def happenings(ending: Ending) -> tuple[Happening, ...]:
    """Every event that happened, when it first did, in the order of their times."""
    found = [_first(ending, event) for event in range(len(EVENTS))]
    return tuple(sorted((one for one in found if one), key=lambda one: one.time_s))


def derailment_mode(ending: Ending) -> str | None:
    """How the train derailed and to which side, such as ``slide-off left``; None if it did not.

    ``slide-off``, ``climb``, ``overturned``, or ``combined``: one of the first two, and overturning
    within half a second of it.
    """
    if _number(ending, "DIVERGED") > 0.0:
        return None
    found = [one for event in DERAILMENTS if (one := _first(ending, event))]
    if not found:
        return None
    first = min(found, key=lambda one: one.time_s)
    is_combined = any(
        one.event == EVENTS[OVERTURNED] != first.event
        and one.time_s - first.time_s <= COMBINED_WITHIN
        for one in found
    )
    return f"{'combined' if is_combined else first.event} {first.side}"


def beyond_model(ending: Ending) -> str | None:
    """Why the car has been where its model ends; None if it has not."""
    reason = int(_number(ending, "BEYOND_REASON"))
    return BEYOND[reason - 1] if reason else None


_SENTENCES: dict[int, Callable[[Happening], str]] = {
    FLANGE_CONTACT: lambda one: f"the {one.side} flange touches its rail",
    UPLIFT: lambda one: f"{one.side} wheels lift",
    ONSET: lambda one: f"onset: the lifted {one.side} flange is above its rail",
    FLANGE_OVER: lambda one: f"the loaded {one.side} flange is on top of its rail",
    SLIDE_OFF: lambda one: f"slides off to the {one.side}",
    CLIMB: lambda one: f"climbs off to the {one.side}",
    OVERTURNED: lambda one: f"overturns to the {one.side}",
}


def explain(ending: Ending) -> str:
    """What happened to the train, in sentences.

    Returns
    -------
    str
        Such as ``5.34 s left wheels lift; 5.52 s onset: the lifted left flange is above its rail;
        6.96 s slides off to the left.``
    """
    found = list(happenings(ending))
    onset = next((one for one in found if one.event == EVENTS[ONSET]), None)
    over = next((one.time_s for one in found if one.event == EVENTS[OVERTURNED]), math.inf)
    told = [
        (one.time_s, _SENTENCES[EVENTS.index(one.event)](one))
        for one in found
        # a lifted flange above its rail is the onset, told already; what a car does that has
        # overturned is no news
        if (one.event != EVENTS[FLANGE_OVER] or onset is None or one.time_s < onset.time_s)
        and one.time_s <= over
    ]
    beyond = beyond_model(ending)
    if beyond is not None:
        told.append((_number(ending, "BEYOND_TIME"), f"the model ends: {beyond}"))
    mode = derailment_mode(ending)
    lifted = any(one.event == EVENTS[UPLIFT] for one in found)
    back = _number(ending, "UPLIFT_END")
    if mode is None and lifted and back >= 0.0 and not _is_up(ending):
        told.append((back, "back on both rails"))
    told.sort(key=lambda one: one[0])
    sentences = [f"{time:.2f} s {what}" for time, what in told]
    if mode is not None and mode.startswith("combined"):
        sentences.append("both together")
    if not lifted and mode is None:
        sentences.append("no wheel lifts")
    return "; ".join(sentences) + "."


def _is_up(ending: Ending) -> bool:
    """Whether a wheel is off its rail at the record's end."""
    return bool(int(_number(ending, "FLAGS")) >> UPLIFT & 1)
