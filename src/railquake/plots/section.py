"""The wheel-rail section at its worst moment, and the car above it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.geometry import rail_centre
from railquake.plots.style import BLUE, GREEN, GREY, ORANGE, RED, figure, label, plain, save

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from railquake.inputs.vehicle import Vehicle
    from railquake.response import Response

__all__ = ["body_boxes", "draw_body", "draw_section"]

Array = np.ndarray[Any, np.dtype[np.float64]]


def body_boxes(vehicle: Vehicle) -> dict[str, tuple[float, float]]:
    """Half width and half height with which each body is drawn, m: a sketch, no dimension."""
    boxes = {}
    heaviest = max(body.mass for body in vehicle.bodies)
    for body in vehicle.bodies:
        if body.name == vehicle.wheelset:
            boxes[body.name] = (1.0, 0.08)
        elif body.mass == heaviest:
            boxes[body.name] = (1.45, 1.25)
        else:
            boxes[body.name] = (1.1, 0.12)
    return boxes


def draw_body(
    ax: Axes, centre: tuple[float, float], roll: float, box: tuple[float, float], **style: Any
) -> None:
    """Outline of a body, y right, z down, turned by its roll (right side down)."""
    half_width, half_height = box
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]], dtype=float) * (
        half_width,
        half_height,
    )
    sine, cosine = np.sin(roll), np.cos(roll)
    y = centre[0] + corners[:, 0] * cosine - corners[:, 1] * sine
    z = centre[1] + corners[:, 0] * sine + corners[:, 1] * cosine
    ax.plot(y, z, **style)


def draw_section(response: Response, path: Path) -> Path:
    """Write the section at `Response.worst_frame`: car, left and right wheel on their rails."""
    frame = response.worst_frame
    made, axes = figure(10.0, 3.6, 1, 3, width_ratios=[1.0, 1.25, 1.25])
    _draw_car(axes[0], response, frame)
    for ax, side in ((axes[1], "left"), (axes[2], "right")):
        _draw_contact(ax, response, frame, side)
    time = float(response.times[frame])
    roll = float(np.degrees(response.channel("relative_roll_rad")[frame]))
    shift = 1e3 * float(response.channel("lateral_shift_m")[frame])
    side = "right" if shift > 0.0 else "left"
    made.suptitle(
        plain(
            f"{response.system.ground.name}, worst moment, {time:.3f} s: wheelset "
            f"{abs(shift):.1f} mm to the {side}, roll on the track {roll:+.2f}° "
            f"(slide-off begins at {np.degrees(response.reference_roll):.2f}°)"
        ),
        fontsize=9,
        x=0.01,
        ha="left",
    )
    return save(made, path)


def _draw_car(ax: Axes, response: Response, frame: int) -> None:
    vehicle = response.system.scenario.vehicle
    boxes = body_boxes(vehicle)
    colours = (BLUE, ORANGE, GREEN, RED)
    origin = float(response.channel("track_lateral_m")[frame])
    for body, colour in zip(vehicle.bodies, colours, strict=False):
        name = body.name.replace(" ", "_").replace("-", "_")
        y = float(response.channel(f"{name}_lateral_m")[frame]) - origin
        z = float(response.channel(f"{name}_vertical_m")[frame]) - body.height
        roll = float(response.channel(f"{name}_roll_rad")[frame])
        lift = 0.9 if boxes[body.name][1] > 1.0 else 0.0  # the box reaches from floor to roof
        draw_body(
            ax, (y + lift * np.sin(roll), z - lift * np.cos(roll)), roll, boxes[body.name],
            color=colour, linewidth=1.4,
        )  # fmt: skip
        ax.plot(y, z, "+", color=colour, markersize=6)
    tilt = float(response.channel("track_roll_rad")[frame])
    deck = np.array([-1.8, 1.8])
    ax.plot(deck * np.cos(tilt), deck * np.sin(tilt) + 0.02, color="black", linewidth=2.0)
    ax.set_aspect("equal")
    ax.invert_yaxis()
    label(ax, "y, m", "z, m", "Car (boxes: sketch, +: c.g.)")


def _draw_contact(ax: Axes, response: Response, frame: int, side: str) -> None:
    pair = response.system.scenario.wheelrail
    wheel = pair.wheel.profile("wheel", "wheel")
    rail = pair.rail.profile("rail", "rail")
    sign = 1.0 if side == "right" else -1.0
    crown = float(rail.z.min())
    rail_y = sign * (rail_centre(pair, rail) + rail.y)
    ax.fill(1e3 * rail_y, 1e3 * (rail.z - crown), color="#d9d9d9")
    ax.plot(1e3 * rail_y, 1e3 * (rail.z - crown), color="#555555", linewidth=1.0)
    psi = float(response.channel("relative_roll_rad")[frame])
    y = sign * (pair.running_circle + wheel.y)
    z = pair.rolling_radius + wheel.z
    sine, cosine = np.sin(psi), np.cos(psi)
    place_y = float(response.channel("lateral_shift_m")[frame]) + y * cosine - z * sine
    place_z = float(response.channel("wheelset_height_m")[frame]) + y * sine + z * cosine
    ax.plot(1e3 * place_y, 1e3 * place_z, color=BLUE, linewidth=1.5)
    touching = [
        zone
        for zone in ("tread", "flange")
        if response.channel(f"penetration_{side}_{zone}_m")[frame] > 0.0
    ]
    load = 1e-3 * float(response.channel(f"wheel_load_{side}_n")[frame])
    state = " and ".join(touching) + " in contact" if touching else "off the rail"
    centre = 1e3 * sign * rail_centre(pair, rail)
    ax.set_xlim(centre - 95.0, centre + 95.0)
    lifted = 1e3 * float(np.interp(0.0, wheel.y, place_z))
    ax.set_ylim(60.0, min(-75.0, lifted - 60.0))
    ax.set_aspect("equal")
    ax.axhline(0.0, color=GREY, linewidth=0.5, linestyle=":")
    label(ax, "y in the track, mm", "z, mm", f"{side.capitalize()}: {state}; {load:.0f} kN")
