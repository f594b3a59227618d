"""How close the wheelset came to sliding off: its roll on the track against the onset."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.measures import named
from railquake.plots.events import (
    draw_events,
    legend_of_shades,
    peak_roll,
    run_title,
    shade,
    strip_height,
    train_span,
    verdict,
)
from railquake.plots.style import (
    BLACK,
    BLUE,
    RED,
    heading,
    label,
    remark,
    save,
    signed,
    stack,
    thinned,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from railquake.run.response import Response

__all__ = ["write_relative_roll"]

Array = np.ndarray[Any, np.dtype[np.float64]]

FURTHEST = 3.0  # onsets: what is beyond is seen in the close-up
CLOSE_UP = 0.6  # seconds before and after the worst moment


def write_relative_roll(response: Response, path: Path) -> Path:
    """Draw the relative roll of a run, and its worst moment in close-up."""
    made, axes = stack(
        [strip_height(response), 2.3, 2.0], left=1.25, right=0.75, gaps=(0.1, 0.6), share=False
    )
    strip, whole, close = axes
    times = response.times
    roll = np.degrees(response.channel("relative_roll_rad"))
    onset = float(np.degrees(response.reference_roll))
    peak = float(np.degrees(peak_roll(response)))
    span = train_span(response)
    draw_events(strip, response, span)
    strip.set_xlim(*span)
    strip.tick_params(labelbottom=False)

    shown = times <= span[1]
    whole.plot(*thinned(times[shown], roll[shown]), color=BLUE, linewidth=1.0)
    reach = onset * min(max(1.35, 1.15 * peak / onset), FURTHEST)
    whole.set_xlim(*span)
    whole.set_ylim(-reach, reach)
    _onset_lines(whole, onset, written=True)
    label(whole, y="roll of wheelset\non track, degrees")
    _ratio_axis(whole, onset)

    worst = response.worst_frame
    window = (times >= times[worst] - CLOSE_UP) & (times <= times[worst] + CLOSE_UP)
    close.plot(times[window], roll[window], color=BLUE, linewidth=1.2)
    close.plot(times[worst], roll[worst], "o", color=BLACK, markersize=4.0, zorder=5)
    low, high = float(np.nanmin(roll[window])), float(np.nanmax(roll[window]))
    margin = 0.12 * max(high - low, 1e-6)
    close.set_ylim(low - margin, high + margin)
    close.set_xlim(max(0.0, times[worst] - CLOSE_UP), min(span[1], times[worst] + CLOSE_UP))
    _onset_lines(close, onset, written=False)
    label(close, "time, s", "the same around\nthe worst moment,\ndegrees")
    shift = 1e3 * float(response.channel("lateral_shift_m")[worst])
    remark(
        close,
        f"the band above in close-up; worst moment {times[worst]:.3f} s: {signed(roll[worst])}°, "
        f"wheelset {abs(shift):.1f} mm to the {'right' if shift > 0.0 else 'left'}",
    )
    _ratio_axis(close, onset)
    for ax in (whole, close):
        shade(ax, response)
    whole.axvspan(*close.get_xlim(), color=BLUE, alpha=0.07, linewidth=0.0, zorder=0.4)
    heading(
        made,
        "Roll of the wheelset on the track (right side down) against the onset of slide-off",
        run_title(response),
        verdict(response) + legend_of_shades(response),
    )
    return save(made, path)


def _onset_lines(ax: Axes, onset: float, *, written: bool) -> None:
    low, high = ax.get_ylim()
    for sign in (-1.0, 1.0):
        ax.axhline(sign * onset, color=RED, linewidth=1.1, linestyle="--")
        beyond = sorted((sign * onset, sign * 10.0 * max(abs(low), abs(high), onset)))
        ax.axhspan(*beyond, color=RED, alpha=0.08, linewidth=0.0)
    ax.set_ylim(low, high)
    if written:
        ax.text(
            0.01, onset, f"onset of slide-off, {onset:.3f}°", color=RED, fontsize=8, ha="left",
            va="bottom", transform=ax.get_yaxis_transform(),
        )  # fmt: skip


def _ratio_axis(ax: Axes, onset: float) -> None:
    """The same scale in onsets, on the right."""
    ratio = ax.twinx()
    ratio.spines[["top", "left"]].set_visible(False)
    low, high = ax.get_ylim()
    ratio.set_ylim(low / onset, high / onset)
    ratio.tick_params(labelsize=8)
    uplift = named("uplift_ratio")
    ratio.set_ylabel(f"{uplift.short}, {uplift.unit}", fontsize=9)
