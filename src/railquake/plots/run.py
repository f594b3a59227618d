"""The pictures of a run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.inputs.support import Pier, PrescribedTrack
from railquake.physics import constant
from railquake.plots.section import draw_section
from railquake.plots.style import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    RED,
    figure,
    label,
    legend,
    plain,
    save,
    thinned,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from railquake.response import Response

__all__ = ["write_pictures"]

EVENT_COLOURS = {
    "flange contact": ORANGE,
    "uplift": GREEN,
    "onset": RED,
    "flange over": PURPLE,
    "derailed": "black",
    "overturned": "black",
}


def write_pictures(response: Response, folder: Path) -> list[Path]:
    """Write all pictures of a run as PNG.

    Parameters
    ----------
    response : Response
    folder : Path
        Must exist.

    Returns
    -------
    list of Path
        ``histories.png``, ``wheel-loads.png``, ``relative-roll.png``, ``section.png``, and for a
        pier ``hinge-loop.png``.
    """
    paths = [
        _histories(response, folder / "histories.png"),
        _wheel_loads(response, folder / "wheel-loads.png"),
        _relative_roll(response, folder / "relative-roll.png"),
        draw_section(response, folder / "section.png"),
    ]
    if isinstance(response.system.scenario.support, Pier):
        paths.append(_hinge_loop(response, folder / "hinge-loop.png"))
    return paths


def _title(response: Response) -> str:
    scenario = response.system.scenario
    what: str = scenario.support.kind
    if isinstance(scenario.support, Pier):
        what = f"{scenario.support.hinge} hinge"
        what += "" if scenario.support.coupled else ", decoupled"
    speed = 3.6 * scenario.vehicle.speed
    ground = response.system.ground
    return plain(
        f"{ground.name}, PGA {ground.pga / 9.80665:.2f} g; {scenario.vehicle.name} at "
        f"{speed:.0f} km/h, {what}: {response.status}"
    )


def _plot(ax: Axes, response: Response, name: str, factor: float = 1.0, **style: Any) -> None:
    time, values = thinned(response.times, factor * response.channel(name))
    style.setdefault("linewidth", 0.8)
    ax.plot(time, values, **style)


def _mark_end(ax: Axes, response: Response) -> None:
    """A line where the train leaves the track."""
    for event in response.events:
        if event.name in ("derailed", "overturned"):
            ax.axvline(event.begin_s, color="black", linewidth=0.9, linestyle="--")
            return


def _histories(response: Response, path: Path) -> Path:
    bridge = not isinstance(response.system.scenario.support, PrescribedTrack)
    rows = [
        ("ground_acceleration_m_s2", 1.0, "ground\nacceleration, m/s²", GREY),
        ("lateral_shift_m", 1e3, "wheelset on\nrails, mm", RED),
    ]
    if response.system.scenario.support.kind != "at-grade":
        rows[1:1] = [
            ("bridge_displacement_m", 1e3, "bridge displ.,\nmm", BLUE),
            ("bridge_velocity_m_s", 1.0, "bridge velocity,\nm/s", BLUE),
            ("bridge_acceleration_m_s2", 1.0, "bridge accel.\n(abs.), m/s²", BLUE),
        ]
        if isinstance(response.system.scenario.support, Pier):
            rows.insert(4, ("hinge_rotation_rad", 1e3, "hinge rotation,\nmrad", GREEN))
    if not bridge:
        rows = rows[1:]
    bodies = response.system.vehicle.bodies
    made, axes = figure(8.5, 1.35 * (len(rows) + 1) + 0.6, len(rows) + 1, sharex=True)
    for ax, (name, factor, text, colour) in zip(axes, rows, strict=False):
        _plot(ax, response, name, factor, color=colour)
        label(ax, y=text)
        _mark_end(ax, response)
    for body, colour in zip(bodies, (BLUE, ORANGE, GREEN, RED, PURPLE), strict=False):
        name = body.replace(" ", "_").replace("-", "_")
        _plot(axes[-1], response, f"{name}_roll_rad", 1e3, color=colour, label=plain(body))
    label(axes[-1], "time, s", "roll, mrad")
    legend(axes[-1], loc="upper right", ncols=3)
    _mark_end(axes[-1], response)
    axes[-1].set_xlim(0.0, response.times[-1])
    made.suptitle(_title(response), fontsize=10, x=0.01, ha="left")
    return save(made, path)


def _wheel_loads(response: Response, path: Path) -> Path:
    made, axes = figure(8.5, 7.0, 3, sharex=True)
    static = response.system.static_wheel_load
    for side, colour in (("left", BLUE), ("right", ORANGE)):
        _plot(
            axes[0], response, f"wheel_load_{side}_n", 1e-3, color=colour, alpha=0.35, linewidth=0.5
        )
        _plot(
            axes[0], response, f"wheel_load_{side}_filtered_n", 1e-3, color=colour, linewidth=1.2,
            label=f"{side} wheels, low-passed",
        )  # fmt: skip
    axes[0].axhline(1e-3 * static, color=GREY, linewidth=0.8, linestyle=":", label="static")
    # impacts may be ten times the static load; they are cut off so that the rest can be read
    high = 1e-3 * max(
        3.0 * static,
        float(np.abs(response.channel("wheel_load_left_filtered_n")).max()),
        float(np.abs(response.channel("wheel_load_right_filtered_n")).max()),
    )
    axes[0].set_ylim(-0.05 * high, 1.08 * high)
    label(axes[0], y="wheel load, kN", title="Vertical load on each rail (thin: raw)")
    legend(axes[0], loc="upper right", ncols=3)
    _plot(axes[1], response, "lateral_force_n", 1e-3, color=GREY, alpha=0.5, label="raw")
    _plot(
        axes[1], response, "lateral_force_filtered_n", 1e-3, color=RED, linewidth=1.2,
        label="low-passed",
    )  # fmt: skip
    filtered = 1e-3 * np.abs(response.channel("lateral_force_filtered_n")).max()
    reach = 1.3 * max(filtered, 1e-3 * 0.1 * static)
    axes[1].set_ylim(-reach, reach)
    limit = 2e-3 * static * float(response.system.constants[constant.FRICTION, 0])
    for sign in (-1.0, 1.0):
        axes[1].axhline(sign * limit, color=GREY, linewidth=0.8, linestyle=":")
    label(axes[1], y="lateral force, kN", title="Train on track (dotted: friction times weight)")
    legend(axes[1], loc="upper right", ncols=2)
    weight = 2.0 * static
    total = response.channel("wheel_load_left_filtered_n") + response.channel(
        "wheel_load_right_filtered_n"
    )
    lowest = np.minimum(
        response.channel("wheel_load_left_filtered_n"),
        response.channel("wheel_load_right_filtered_n"),
    )
    axes[2].plot(*thinned(response.times, 1.0 - lowest / static), color=BLUE, linewidth=0.9)
    axes[2].plot(*thinned(response.times, total / weight), color=GREY, linewidth=0.8, label="total")
    axes[2].axhline(1.0, color=RED, linewidth=0.8, linestyle="--")
    axes[2].set_ylim(-0.1, 1.6)
    label(
        axes[2], "time, s", "ratio, 1",
        "Unloading of the lighter side (1: lifted), and total load over weight (grey)",
    )  # fmt: skip
    for ax in axes:
        _mark_end(ax, response)
    axes[2].set_xlim(0.0, response.times[-1])
    made.suptitle(_title(response), fontsize=10, x=0.01, ha="left")
    return save(made, path)


def _relative_roll(response: Response, path: Path) -> Path:
    made, ax = figure(8.5, 4.2, right=0.65)
    onset = np.degrees(response.reference_roll)
    roll = np.degrees(response.channel("relative_roll_rad"))
    ax.plot(*thinned(response.times, roll), color=BLUE, linewidth=1.0)
    for sign in (-1.0, 1.0):
        ax.axhline(sign * onset, color=RED, linewidth=1.0, linestyle="--")
    peak = float(np.nanmax(np.abs(roll)))
    reach = max(1.25 * onset, min(1.15 * peak, 4.0 * onset))
    ax.set_ylim(-reach, reach)
    ax.text(
        0.99, onset + 0.02 * reach, "onset of slide-off", color=RED, fontsize=8, ha="right",
        va="bottom", transform=ax.get_yaxis_transform(),
    )  # fmt: skip
    seen = set()
    bands = {"flange contact": (0.0, 0.03), "uplift": (0.03, 0.06), "onset": (0.06, 0.09)}
    end = response.times[-1]
    for event in response.events:
        colour = EVENT_COLOURS[event.name]
        until = end if np.isnan(event.end_s) else event.end_s
        name = event.name if event.name not in seen else None
        seen.add(event.name)
        if event.name in bands:
            low, high = bands[event.name]
            ax.axvspan(
                event.begin_s, max(until, event.begin_s + 0.001 * end), low, high,
                color=colour, linewidth=0.5, label=name,
            )  # fmt: skip
        elif name is not None:
            ax.axvline(event.begin_s, color=colour, linewidth=1.0, linestyle=":", label=event.name)
    if seen:
        legend(ax, loc="upper left", ncols=len(seen))
    ratio = ax.secondary_yaxis("right", functions=(lambda d: d / onset, lambda r: r * onset))
    ratio.set_ylabel("normalised uplift, 1", fontsize=9)
    ratio.tick_params(labelsize=8)
    ax.set_xlim(0.0, end)
    label(ax, "time, s", "roll of the wheelset on the track, degrees")
    made.suptitle(_title(response), fontsize=10, x=0.01, ha="left")
    return save(made, path)


def _hinge_loop(response: Response, path: Path) -> Path:
    from matplotlib.collections import LineCollection

    made, ax = figure(6.0, 4.6)
    rotation = 1e3 * response.channel("hinge_rotation_rad")
    moment = 1e-6 * response.channel("base_moment_n_m")
    stride = max(1, len(rotation) // 8000)
    points = np.column_stack([rotation[::stride], moment[::stride]])
    segments = np.stack([points[:-1], points[1:]], axis=1)
    lines = LineCollection(list(segments), cmap="viridis", linewidths=0.9)
    lines.set_array(response.times[::stride][:-1])
    ax.add_collection(lines)
    ax.autoscale()
    bar = made.colorbar(lines, ax=ax, pad=0.02)
    bar.set_label("time, s", fontsize=9)
    bar.ax.tick_params(labelsize=8)
    ax.axhline(0.0, color=GREY, linewidth=0.6)
    ax.axvline(0.0, color=GREY, linewidth=0.6)
    label(ax, "hinge rotation, mrad", "moment, MN m")
    made.suptitle(_title(response), fontsize=9, x=0.01, ha="left")
    return save(made, path)
