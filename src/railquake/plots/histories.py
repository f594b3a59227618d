"""Histories of a run: ground, bridge, hinge, wheelset and the bodies of the vehicle."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from railquake.inputs.support import AtGrade, Pier
from railquake.plots.events import (
    draw_events,
    leaves,
    legend_of_shades,
    run_title,
    shade,
    strip_height,
    verdict,
)
from railquake.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    RED,
    SKY,
    heading,
    label,
    legend,
    note_peak,
    plain,
    remark,
    save,
    stack,
    thinned,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from railquake.run.response import Response

__all__ = ["write_histories"]

Row = tuple[str, float, str, str, str]  # channel, factor, unit, y label, colour

GROUND: Row = ("ground_acceleration_m_s2", 1.0, "m/s²", "ground\nacceleration\nm/s²", GREY)
BRIDGE: tuple[Row, ...] = (
    ("bridge_displacement_m", 1e3, "mm", "bridge\ndisplacement\nmm", BLUE),
    ("bridge_velocity_m_s", 1.0, "m/s", "bridge\nvelocity\nm/s", BLUE),
    ("bridge_acceleration_m_s2", 1.0, "m/s²", "bridge accel.,\nabsolute\nm/s²", BLUE),
    ("hinge_rotation_rad", 1e3, "mrad", "hinge\nrotation\nmrad", PURPLE),
)
TRACK: tuple[Row, ...] = (
    ("track_lateral_m", 1e3, "mm", "track\ndisplacement\nmm", BLUE),
    ("track_roll_rad", 1e3, "mrad", "track\nroll\nmrad", BLUE),
)
SHIFT: Row = ("lateral_shift_m", 1e3, "mm", "wheelset\nshift on track\nmm", RED)
BODY_COLOURS = (BLUE, ORANGE, GREEN, PURPLE, SKY, RED)


def write_histories(response: Response, path: Path) -> Path:
    """Draw the histories of a run, one below the other, under a strip of its events."""
    support = response.system.scenario.support
    rows = [GROUND] if response.system.ground.pga > 0.0 else []
    if isinstance(support, Pier):
        rows += BRIDGE
    elif not isinstance(support, AtGrade):
        rows += TRACK
    rows.append(SHIFT)
    made, axes = stack([strip_height(response)] + [0.95] * (len(rows) + 2), left=1.25, gaps=0.24)
    times = response.times
    span = (0.0, float(times[-1]))
    draw_events(axes[0], response, span)
    for ax, (name, factor, unit, text, colour) in zip(axes[1:], rows, strict=False):
        values = factor * response.channel(name)
        ax.plot(*thinned(times, values), color=colour, linewidth=0.8)
        note_peak(ax, times, values, unit)
        label(ax, y=text)
        shade(ax, response)
    _vertical_ground(response, axes[1], rows)
    track = response.channel("track_lateral_m")
    for ax, what, text in (
        (axes[-2], "lateral", "bodies,\nlateral to track\nmm"),
        (axes[-1], "roll", "bodies,\nroll\ndegrees"),
    ):
        for body, colour in zip(response.system.vehicle.bodies, BODY_COLOURS, strict=False):
            name = body.replace(" ", "_").replace("-", "_")
            if what == "lateral":
                values = 1e3 * (response.channel(f"{name}_lateral_m") - track)
            else:
                values = np.degrees(response.channel(f"{name}_roll_rad"))
            ax.plot(*thinned(times, values), color=colour, linewidth=0.9, label=plain(body))
        label(ax, y=text)
        shade(ax, response)
    legend(axes[-2])
    left = leaves(response)
    if left is not None:
        right_half = left > 0.6 * span[1]
        axes[-1].annotate(
            "the train has left the track", (left, 0.06), xytext=(-5 if right_half else 5, 0),
            xycoords=axes[-1].get_xaxis_transform(), textcoords="offset points", fontsize=8,
            color=BLACK, ha="right" if right_half else "left",
        )  # fmt: skip
    label(axes[-1], "time, s")
    axes[0].set_xlim(*span)
    heading(
        made,
        "Ground, bridge and train",
        run_title(response),
        verdict(response) + legend_of_shades(response),
    )
    return save(made, path)


def _vertical_ground(response: Response, ax: Axes, rows: list[Row]) -> None:
    """Add the ground's vertical acceleration where there is one."""
    down = response.channel("ground_acceleration_down_m_s2")
    if rows[0] is GROUND and np.any(down):
        ax.plot(*thinned(response.times, -down), color=ORANGE, linewidth=0.6, zorder=1.5)
        remark(ax, "grey: lateral, orange: vertical (up)")
