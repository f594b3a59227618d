"""From a response to one flat row: every measure that `railquake.measures` declares."""

from __future__ import annotations

import platform
from collections.abc import Callable, Mapping
from functools import cache
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as installed_version
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake import measures
from railquake.inputs.ground_motion import jma_intensity
from railquake.inputs.support import Pier
from railquake.march.compiler import source_hash
from railquake.march.rows_constant import STAGES
from railquake.measures import (
    AttributeOf,
    EventTime,
    Place,
    StateRow,
    StateTime,
    WorkedOut,
    housner,
)
from railquake.physics import derailment
from railquake.physics.oscillator import pseudo_velocity
from railquake.run import spectral
from railquake.run.doubts import doubts

if TYPE_CHECKING:
    from railquake.run.response import Response

__all__ = ["assess", "physics", "versions"]


def assess(response: Response) -> dict[str, Any]:
    """Measures of one run, by the names of ``summary.json``.

    Parameters
    ----------
    response : Response

    Returns
    -------
    dict
        Flat but for ``versions``: numbers in the units that their names carry, None where
        something did not happen.  The keys are those of `measures.MEASURES`, in their order.
    """
    row = {}
    for measure in measures.MEASURES:
        found = _read(response, measure.place)
        # a text may be a mapping, `versions`
        is_plain = found is None or measure.value is str
        row[measure.key] = found if is_plain else measure.value(found)
    return row


def _read(response: Response, place: Place) -> Any:
    """What stands at a measure's place."""
    match place:
        case StateRow(name):
            return _row(response, name)
        case StateTime(name):
            return _time(_row(response, name))
        case EventTime(event):
            return _time(_first_time(response, event))
        case AttributeOf(path):
            return attrgetter(path)(response)
        case WorkedOut(function):
            return _WORKED_OUT[function](response)


# All that is known here of the state's rows: that each has a name.


def _row(response: Response, name: str) -> float:
    """Last value of a row of the state."""
    return float(response.end[getattr(response.system.layout.state, name), 0])


def _first_time(response: Response, event: str) -> float:
    """When an event first held, s; negative: never."""
    first = response.system.layout.state.FIRST_TIME
    return float(response.end[first + getattr(derailment, event), 0])


def _time(at: float) -> float | None:
    return at if at >= 0.0 else None


# --- measures that are made of several things ----------------------------------------------------


def versions() -> dict[str, str]:
    """Versions of all that decides the numbers, and under ``physics`` a hash of its source."""
    return dict(_versions())


def physics() -> str:
    """What decides the numbers of a scenario: a hash of the physics, and the compiler's version."""
    known = _versions()
    return f"{known['physics']} with Numba {known['numba']} and llvmlite {known['llvmlite']}"


@cache
def _versions() -> dict[str, str]:
    found = {"physics": source_hash(), "python": platform.python_version()}
    for package in ("railquake", "numpy", "scipy", "numba", "llvmlite"):
        try:
            found[package] = installed_version(package)
        except PackageNotFoundError:
            found[package] = "unknown"
    return found


def _uplift_ratio(response: Response) -> float:
    return _row(response, "PEAK_ROLL") / response.reference_roll


def _wheel_unloading(response: Response) -> float:
    return 1.0 - min(_load_ratio(response, "LEFT"), _load_ratio(response, "RIGHT"))


def _load_ratio(response: Response, side: str) -> float:
    return _row(response, f"LOWEST_LOAD_{side}") / response.system.static_wheel_load


def _flange_climb(response: Response) -> float:
    return max(_row(response, "PEAK_CLIMB_LEFT"), _row(response, "PEAK_CLIMB_RIGHT"))


def _travel(response: Response, stage: int) -> float | None:
    name = f"PEAK_{STAGES[stage].upper()}_TRAVEL"
    return _row(response, name) if stage < len(response.system.vehicle.stages) else None


def _suspension_travel(response: Response) -> float | None:
    found = (_travel(response, stage) for stage in range(len(STAGES)))
    return max((travel for travel in found if travel is not None), default=None)


def _stop_use(response: Response) -> float | None:
    layout, ends = response.system.layout, np.array(response.system.vehicle.joints.ends)
    travel = response.end[layout.state_blocks["STOP_TRAVEL"], 0]
    tables = np.isfinite(ends)
    return float((travel[tables] / ends[tables]).max()) if tables.any() else None


def _speed(response: Response) -> float:
    return response.steps / max(response.march_s, 1e-9)


def _time_step_error(response: Response) -> float | None:
    return None if response.time_step is None else response.time_step.error


def _hinge_law(response: Response) -> str | None:
    support = response.system.scenario.support
    return support.hinge if isinstance(support, Pier) else None


def _period(response: Response) -> float | None:
    support = response.system.scenario.support
    return spectral.first_period(support) if isinstance(support, Pier) else None


def _spectral_acceleration(response: Response) -> float | None:
    period = _period(response)
    if period is None:
        return None
    return spectral.spectral_acceleration(response.system.ground, period)


def _track_intensity(response: Response) -> float:
    largest = response.end[response.system.layout.state_blocks["PEAK_SWING"], 0]
    found = [pseudo_velocity(float(im), housner.DAMPING) for im in largest]
    return housner.spectral_intensity(found)


def _jma_intensity(response: Response) -> float | None:
    vertical = response.system.scenario.vertical_motion()
    others = () if vertical is None else (vertical,)
    return jma_intensity(response.system.ground, *others)


_WORKED_OUT: Mapping[str, Callable[[Response], Any]] = {
    "derailed": lambda response: response.derailment_mode is not None,
    "flange_climb": _flange_climb,
    "hinge_law": _hinge_law,
    "jma_intensity": _jma_intensity,
    "load_ratio_left": lambda response: _load_ratio(response, "LEFT"),
    "load_ratio_right": lambda response: _load_ratio(response, "RIGHT"),
    "period": _period,
    "primary_travel": lambda response: _travel(response, 0),
    "secondary_travel": lambda response: _travel(response, 1),
    "spectral_acceleration": _spectral_acceleration,
    "spectral_intensity": lambda response: spectral.spectral_intensity(response.system.ground),
    "sequence": lambda response: response.explain(),
    "speed": _speed,
    "suspension_travel": _suspension_travel,
    "time_step_error": _time_step_error,
    "track_intensity": _track_intensity,
    "uplift_ratio": _uplift_ratio,
    "warnings": lambda response: (
        "; ".join((*doubts(response), *response.system.scenario.wheelrail.doubts())) or None
    ),
    "versions": lambda _: versions(),
    "wheel_unloading": _wheel_unloading,
    "stop_use": _stop_use,
}
