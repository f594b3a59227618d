"""A run's title and its events, as all pictures of a run show them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from railquake.inputs.support import Pier
from railquake.measures import STANDARD_GRAVITY, short_name
from railquake.physics.derailment import DERAILMENTS, EVENTS
from railquake.plots.style import BLACK, FAINT, GREEN, ORANGE, PURPLE, RED, plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from railquake.run.response import Response

EVENT_COLOURS = {
    "flange contact": ORANGE,
    "uplift": GREEN,
    "onset": RED,
    "flange over": PURPLE,
    "slide-off": BLACK,
    "climb": BLACK,
    "overturned": BLACK,
}
EVENT_LABELS = {"onset": "onset of slide-off"}


def run_title(response: Response) -> str:
    """What was run, in one line."""
    scenario = response.system.scenario
    ground = response.system.ground
    support = scenario.support
    if isinstance(support, Pier):
        hinge = "Bouc-Wen" if support.hinge == "bouc-wen" else "elastic"
        where = f"on {support.name}, {hinge} hinge{'' if support.coupled else ', decoupled'}"
    else:
        where = "at grade" if support.kind == "at-grade" else "on a prescribed track"
    train = plain(f"{scenario.vehicle.name} at {3.6 * scenario.vehicle.speed:.3g} km/h {where}")
    if ground.pga == 0.0:
        return train
    return plain(f"{ground.name}, PGA {ground.pga / STANDARD_GRAVITY:.2f} g") + f": {train}"


def verdict(response: Response) -> str:
    """How it ended, in one line."""
    ratio = peak_roll(response) / response.reference_roll
    uplift = f"peak {short_name('uplift_ratio')} {ratio:.3g} (1: onset of slide-off)"
    mode = response.derailment_mode
    if mode is not None:
        return f"derailed, {mode}, at {leaves(response):.2f} s; {uplift}"
    return f"{response.status}; {uplift}"


def peak_roll(response: Response) -> float:
    """Largest relative roll, rad."""
    return float(np.nanmax(np.abs(response.channel("relative_roll_rad"))))


def leaves(response: Response) -> float | None:
    """When the train derailed, s; None if it did not."""
    final = [EVENTS[event] for event in DERAILMENTS]
    times = [one.time_s for one in response.happenings if one.event in final]
    return min(times) if times else None


def train_span(response: Response) -> tuple[float, float]:
    """The time for which there is a train to show, s."""
    end = float(response.times[-1])
    left = leaves(response)
    return 0.0, end if left is None else min(end, 1.04 * left + 0.05)


def spans(response: Response, name: str) -> list[tuple[float, float]]:
    """Beginnings and lengths of one kind of event, s."""
    end = float(response.times[-1])
    left = leaves(response)
    last = end if left is None else left
    found = []
    for event in response.events:
        if event.name == name:
            until = last if np.isnan(event.end_s) else event.end_s
            found.append((event.begin_s, max(until - event.begin_s, 0.0)))
    return found


def draw_events(ax: Axes, response: Response, span: tuple[float, float]) -> None:
    """Draw a strip that shows when each kind of event held; one row a kind."""
    names = [name for name in EVENT_COLOURS if spans(response, name)]
    ax.grid(visible=False, axis="y")
    ax.spines[["left", "bottom"]].set_visible(False)
    ax.tick_params(length=0.0, labelsize=8)
    if not names:
        ax.set_yticks([])
        ax.set_ylim(0.0, 1.0)
        ax.text(
            0.5, 0.5, "no events: neither flange contact nor uplift", fontsize=8, ha="center",
            va="center", color=FAINT, transform=ax.transAxes,
        )  # fmt: skip
        return
    least = 0.002 * (span[1] - span[0])  # so that a chattering contact is seen at all
    for row, name in enumerate(names):
        bars = [(begin, max(length, least)) for begin, length in spans(response, name)]
        ax.broken_barh(bars, (row - 0.36, 0.72), facecolors=EVENT_COLOURS[name], linewidth=0.0)
    ax.set_yticks(range(len(names)), [EVENT_LABELS.get(name, name) for name in names])
    ax.set_ylim(len(names) - 0.5, -0.5)


def strip_height(response: Response) -> float:
    """Height of the strip of events, inches."""
    return 0.17 * max(1, len({event.name for event in response.events}))


def shade(ax: Axes, response: Response) -> None:
    """Shade the times with a wheel off its rail; a line where the train leaves the track."""
    from matplotlib.collections import PolyCollection

    bars = [
        [(begin, 0.0), (begin, 1.0), (begin + length, 1.0), (begin + length, 0.0)]
        for begin, length in spans(response, "uplift")
    ]
    if bars:
        shaded = PolyCollection(
            bars, transform=ax.get_xaxis_transform(), facecolor=GREEN, alpha=0.18,
            edgecolor="none", zorder=0.5,
        )  # fmt: skip
        ax.add_collection(shaded, autolim=False)
    left = leaves(response)
    if left is not None:
        ax.axvline(left, color=BLACK, linewidth=0.9, linestyle="--")


def legend_of_shades(response: Response) -> str:
    """What `shade` shows, for the end of a line."""
    lifted = any(event.name == "uplift" for event in response.events)
    return "; shaded: a wheel off its rail" if lifted else ""
