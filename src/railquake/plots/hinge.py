"""Moment against rotation of the plastic hinge."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.inputs.support import Pier
from railquake.plots.events import run_title
from railquake.plots.style import BLACK, GREY, blank, dress, heading, label, legend, save, signed

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from railquake.run.response import Response

__all__ = ["write_hinge_loop", "write_hinge_picture"]

Array = np.ndarray[Any, np.dtype[np.float64]]

SHADES = 160  # pieces of the path, each in one colour
PIXELS = 600.0  # about as many as the axes have


def write_hinge_loop(response: Response, path: Path) -> Path:
    """Draw the hinge's path during a run, coloured by time."""
    support = response.system.scenario.support
    assert isinstance(support, Pier)
    rotation = response.channel("hinge_rotation_rad")
    moment = response.channel("base_moment_n_m")
    made, ax = _axes()
    _draw_path(made, ax, response.times, rotation, moment, "time, s")
    if support.hinge == "bouc-wen":
        _initial_stiffness(ax, support.bouc_wen.k0, rotation, moment)
    peak = int(np.argmax(np.abs(rotation)))
    heading(
        made,
        "Moment against rotation of the plastic hinge"
        + ("" if support.hinge == "bouc-wen" else " (elastic: M = k₀ θ)"),
        run_title(response),
        f"largest rotation {signed(1e3 * rotation[peak])} mrad at {response.times[peak]:.2f} s, "
        f"largest moment {1e-6 * np.abs(moment).max():.3g} MN m; at the end "
        f"{signed(1e3 * rotation[-1])} mrad",
    )
    return save(made, path)


def write_hinge_picture(rotation: Array, moment: Array, path: Path) -> Path:
    """Draw moment (N m) against rotation (rad) of a hinge driven along a path."""
    rotation = np.asarray(rotation, dtype=float)
    made, ax = _axes()
    steps = np.arange(1.0, len(rotation) + 1.0)
    _draw_path(made, ax, steps, rotation, np.asarray(moment, dtype=float), "step of the path")
    heading(
        made,
        "Moment against rotation of a hinge along a prescribed path",
        f"largest rotation {1e3 * np.abs(rotation).max():.3g} mrad, largest moment "
        f"{1e-6 * np.abs(moment).max():.3g} MN m",
    )
    return save(made, path)


def _axes() -> tuple[Figure, Axes]:
    made = blank(7.2, 5.4)
    ax = dress(made.add_axes((0.1, 0.1, 0.75, 0.725)))
    ax.axhline(0.0, color=GREY, linewidth=0.6)
    ax.axvline(0.0, color=GREY, linewidth=0.6)
    label(ax, "hinge rotation, mrad", "moment at the base, MN m")
    return made, ax


def _draw_path(
    made: Figure, ax: Axes, times: Array, rotation: Array, moment: Array, text: str
) -> None:
    from matplotlib import colormaps
    from matplotlib.collections import LineCollection
    from matplotlib.colors import ListedColormap, Normalize

    # viridis without its end, which is too pale on white paper
    shades = ListedColormap(colormaps["viridis"](np.linspace(0.0, 0.92, 256)))
    x, y = 1e3 * rotation, 1e-6 * moment
    length = _length(x, y)
    keep = np.flatnonzero(np.diff(np.floor(length), prepend=-1.0) > 0)
    keep = np.unique(np.append(keep, len(x) - 1))
    points, when = np.column_stack([x, y])[keep], times[keep]
    # colours are spread over the time in which the hinge moves
    first, last = np.interp((0.005 * length[-1], 0.995 * length[-1]), length, times)
    if not last > first:
        first, last = float(times[0]), float(times[-1]) + 1e-9
    scale = Normalize(first, last, clip=True)
    shade = np.floor(SHADES * np.clip((when - first) / (last - first), 0.0, 1.0))
    cuts = np.flatnonzero(np.diff(shade)) + 1
    bounds = [0, *cuts.tolist(), len(points)]
    pieces = [points[max(a - 1, 0) : b] for a, b in pairwise(bounds)]
    lines = LineCollection(pieces, cmap=shades, norm=scale, linewidths=1.0, capstyle="round")
    lines.set_array(when[[min(a, len(when) - 1) for a in bounds[:-1]]])
    ax.add_collection(lines)
    ax.autoscale()
    ax.plot(*points[0], "o", color=BLACK, markersize=4.5, label="start", zorder=5)
    ax.plot(
        *points[-1], "o", color="white", markeredgecolor=BLACK, markersize=5.5, label="end",
        zorder=5,
    )  # fmt: skip
    legend(ax)
    bar = made.colorbar(lines, cax=made.add_axes((0.885, 0.1, 0.018, 0.725)), extend="both")
    bar.set_label(text, fontsize=9)
    bar.ax.tick_params(labelsize=8)


def _length(x: Array, y: Array) -> Array:
    """Length of the path up to each point, in pixels."""
    spans = [max(float(np.ptp(values)), 1e-12) / PIXELS for values in (x, y)]
    steps = np.hypot(np.diff(x) / spans[0], np.diff(y) / spans[1])
    return np.concatenate([[0.0], np.cumsum(steps)])


def _initial_stiffness(ax: Axes, k0: float, rotation: Array, moment: Array) -> None:
    """The virgin hinge's stiffness as a thin line, within the frame."""
    limits = ax.get_xlim(), ax.get_ylim()
    reach = min(float(np.abs(rotation).max()), float(np.abs(moment).max()) / k0)
    x = np.array([-reach, reach])
    ax.plot(
        1e3 * x, 1e-6 * k0 * x, color=BLACK, linewidth=0.9, linestyle=":",
        label="initial stiffness", zorder=3,
    )  # fmt: skip
    ax.set_xlim(limits[0])
    ax.set_ylim(limits[1])
    legend(ax)
