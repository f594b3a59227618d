"""Forces between train and track: vertical loads, lateral force and their ratio."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.physics.derailment import least_load
from railquake.plots.events import (
    draw_events,
    leaves,
    legend_of_shades,
    run_title,
    shade,
    strip_height,
    train_span,
    verdict,
)
from railquake.plots.style import (
    BLACK,
    BLUE,
    GREY,
    ORANGE,
    RED,
    heading,
    label,
    legend,
    remark,
    save,
    stack,
    thinned,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from railquake.run.response import Response

__all__ = ["write_wheel_loads"]

Array = np.ndarray[Any, np.dtype[np.float64]]


def write_wheel_loads(response: Response, path: Path) -> Path:
    """Draw vertical loads, lateral force and Y/Q, as they are and low-passed."""
    made, axes = stack([strip_height(response), 1.75, 1.55, 1.35], left=1.25, gaps=0.36)
    span = train_span(response)
    left = leaves(response)
    shown = response.times <= (span[1] if left is None else left)
    times = response.times[shown]
    static = response.system.static_wheel_load
    corner = response.system.scenario.solver.lateral_force_filter
    friction = float(response.system.constants[response.system.layout.constant.FRICTION, 0])
    draw_events(axes[0], response, span)

    def channel(name: str) -> Array:
        return 1e-3 * response.channel(name)[shown]

    loads = {side: channel(f"wheel_load_{side}_n") for side in ("left", "right")}
    smooth = {side: channel(f"wheel_load_{side}_filtered_n") for side in ("left", "right")}
    for side, colour in (("left", BLUE), ("right", ORANGE)):
        _thin(axes[1], times, loads[side], colour)
        _thick(axes[1], times, smooth[side], colour, f"{side} wheels")
    axes[1].axhline(1e-3 * static, color=BLACK, linewidth=0.9, linestyle=":", label="at rest")
    highest = max(2.2e-3 * static, 1.15 * max(float(np.nanmax(v)) for v in smooth.values()))
    axes[1].set_ylim(-0.06 * highest, highest)
    _note_cut(axes[1], max(float(np.nanmax(v)) for v in loads.values()), highest)
    label(axes[1], y="vertical load\nof one side, kN")
    legend(axes[1])

    lateral, lateral_smooth = channel("lateral_force_n"), channel("lateral_force_filtered_n")
    _thin(axes[2], times, lateral, GREY)
    _thick(axes[2], times, lateral_smooth, RED, "of all wheels")
    limit = 2e-3 * static * friction
    for sign in (-1.0, 1.0):
        text = "friction × weight" if sign > 0.0 else None
        axes[2].axhline(sign * limit, color=BLACK, linewidth=0.9, linestyle=":", label=text)
    reach = 1.2 * max(limit, float(np.nanmax(np.abs(lateral_smooth))))
    axes[2].set_ylim(-reach, reach)
    _note_cut(axes[2], float(np.nanmax(np.abs(lateral))), reach)
    label(axes[2], y="lateral force\nto the right, kN")
    legend(axes[2])

    total = smooth["left"] + smooth["right"]
    enough = total > least_load(2e-3 * static)
    ratio = np.where(enough, lateral_smooth / np.where(enough, total, 1.0), np.nan)
    _thick(axes[3], times, ratio, RED, "Y/Q of the whole section")
    for sign in (-1.0, 1.0):
        text = "friction" if sign > 0.0 else None
        axes[3].axhline(sign * friction, color=BLACK, linewidth=0.9, linestyle=":", label=text)
    reach = 1.2 * max(friction, float(np.nanmax(np.abs(ratio))), 1e-3)
    axes[3].set_ylim(-reach, reach)
    largest = float(response.end[response.system.layout.state.PEAK_DERAILMENT_COEFFICIENT, 0])
    remark(axes[3], f"largest on the wheels of one side: {largest:.2f}")
    label(axes[3], "time, s", "lateral force over\nvertical load, 1")
    legend(axes[3])
    for ax in axes[1:]:
        shade(ax, response)
    axes[0].set_xlim(*span)
    heading(
        made,
        f"Forces of the train on the track: as they are (thin), low-passed at {corner:.3g} Hz "
        "(thick)",
        run_title(response),
        verdict(response) + legend_of_shades(response),
    )
    return save(made, path)


def _thin(ax: Axes, times: Array, values: Array, colour: str) -> None:
    ax.plot(*thinned(times, values), color=colour, linewidth=0.5, alpha=0.45)


def _thick(ax: Axes, times: Array, values: Array, colour: str, text: str) -> None:
    ax.plot(*thinned(times, values), color=colour, linewidth=1.3, label=text)


def _note_cut(ax: Axes, peak: float, limit: float) -> None:
    """Say so where impacts reach beyond the axes (they may be ten times the static load)."""
    if peak > limit:
        remark(ax, f"impacts beyond the frame, up to {peak:.0f} kN")
