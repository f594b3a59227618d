"""A ground motion: histories and response spectrum."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.measures import STANDARD_GRAVITY
from railquake.plots.style import (
    BLUE,
    GREY,
    RED,
    blank,
    dress,
    heading,
    label,
    note_peak,
    plain,
    save,
    thinned,
)

if TYPE_CHECKING:
    from railquake.inputs.ground_motion import GroundMotion

__all__ = ["write_motion_picture"]

Array = np.ndarray[Any, np.dtype[np.float64]]

LONGEST_PERIOD = 5.0


def write_motion_picture(motion: GroundMotion, path: Path) -> Path:
    """Draw acceleration, velocity, displacement and the 5 % response spectrum of a motion."""
    from matplotlib.ticker import LogLocator, NullFormatter

    from railquake.inputs.ground_motion import response_spectrum
    from railquake.inputs.ground_motion.motion import cumulative_trapezoid

    made = blank(11.0, 5.4)
    velocity = motion.velocity()
    time = motion.time
    first = None
    for k, (values, unit, text, colour) in enumerate(
        (
            (motion.acceleration, "m/s²", "acceleration, m/s²", GREY),
            (velocity, "m/s", "velocity, m/s", BLUE),
            (cumulative_trapezoid(velocity, motion.dt), "m", "displacement, m", BLUE),
        )
    ):
        ax = made.add_axes((0.075, 0.645 - 0.275 * k, 0.51, 0.215), sharex=first)
        first = dress(ax) if first is None else first
        dress(ax)
        ax.plot(*thinned(time, np.asarray(values)), color=colour, linewidth=0.8)
        note_peak(ax, time, np.asarray(values), unit)
        ax.set_xlim(0.0, time[-1])
        ax.tick_params(labelbottom=k == 2)
        label(ax, "time, s" if k == 2 else "", text)
        ax.yaxis.set_label_coords(-0.105, 0.5)
    ax = dress(made.add_axes((0.66, 0.095, 0.325, 0.765)))
    periods = np.geomspace(max(0.03, 2.0 * motion.dt), LONGEST_PERIOD, 150)
    ordinates = response_spectrum(motion, periods).psa / STANDARD_GRAVITY
    ax.loglog(periods, ordinates, color=RED, linewidth=1.6)
    ax.axhline(motion.pga / STANDARD_GRAVITY, color=GREY, linewidth=0.9, linestyle=":")
    ax.text(LONGEST_PERIOD, motion.pga / STANDARD_GRAVITY, "PGA", fontsize=8, ha="right",
            va="bottom", color="#4d4d4d")  # fmt: skip
    ax.grid(visible=True, which="minor", color="#f2f2f2", linewidth=0.5)
    ax.set_xlim(periods[0], LONGEST_PERIOD)
    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_formatter(NullFormatter())
    label(ax, "period, s", "pseudo-acceleration, g", "Response spectrum, 5 % damping")
    heading(
        made,
        plain(f"Ground motion {motion.name}"),
        f"PGA {motion.pga:.4g} m/s² ({motion.pga / STANDARD_GRAVITY:.3f} g), PGV {motion.pgv:.3g} "
        f"m/s, Arias intensity {motion.arias_intensity:.3g} m/s; {motion.npts} values every "
        f"{1e3 * motion.dt:g} ms; displacement integrated from the velocity",
    )
    return save(made, path)
