"""Outlines of a vehicle's bodies: sketches, because an input holds no outer dimensions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.plots.style import BLUE, GREEN, ORANGE, PURPLE, SKY, filled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from railquake.inputs.vehicle import Vehicle

__all__ = ["Outline", "body_colours", "box", "outlines", "placed", "turned"]

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class Outline:
    """Closed outline of a body about its centre of gravity, y right, z down, m."""

    y: Array
    z: Array


def box(left: float, right: float, top: float, bottom: float, corner: float = 0.0) -> Outline:
    """A rectangle, its upper corners rounded."""
    angle = np.linspace(0.0, 0.5 * np.pi, 7) if corner > 0.0 else np.zeros(1)
    aside, above = corner * (1.0 - np.cos(angle)), corner * (1.0 - np.sin(angle))
    y = np.concatenate([[left, right], right - aside, (left + aside)[::-1], [left]])
    z = np.concatenate([[bottom, bottom], top + above, (top + above)[::-1], [bottom]])
    return Outline(y, z)


def outlines(vehicle: Vehicle) -> dict[str, Outline]:
    """How each body is drawn.

    The heaviest body is a car from just above its springs to as far above its centre of gravity;
    the wheelset two wheels on an axle; any other body a beam as wide as what hangs on it.
    """
    heaviest = max(vehicle.bodies, key=lambda body: body.mass).name
    made = {}
    for body in vehicle.bodies:
        joints = [
            (abs(element.lateral), height)
            for element in (*vehicle.springs, *vehicle.dashpots)
            for name, height in zip(element.bodies, element.end_heights, strict=True)
            if name == body.name
        ]
        wide = max([lateral for lateral, _ in joints], default=0.9)
        if body.name == vehicle.wheelset:
            made[body.name] = _wheelset(body.height)
        elif body.name == heaviest:
            floor = max([height for _, height in joints], default=0.5 * body.height) + 0.12
            half = max(body.height - floor, 0.4)
            made[body.name] = box(-1.5, 1.5, -half, half, corner=0.28)
        else:
            made[body.name] = box(-wide - 0.08, wide + 0.08, -0.11, 0.11)
    return made


def _wheelset(radius: float, half_spacing: float = 0.8) -> Outline:
    """Two wheels on an axle, without profiles."""
    axle, tyre = 0.07, 0.06
    a, b = half_spacing - tyre, half_spacing + tyre
    y = np.array([-b, -a, -a, a, a, b, b, a, a, -a, -a, -b, -b])
    z = np.array([-1, -1, 0, 0, -1, -1, 1, 1, 0, 0, 1, 1, -1.0]) * radius
    z[[2, 3]] = -axle
    z[[8, 9]] = axle
    return Outline(y, z)


def turned(y: Array, z: Array, roll: float) -> tuple[Array, Array]:
    """Points turned by a roll, right side down."""
    sine, cosine = np.sin(roll), np.cos(roll)
    return y * cosine - z * sine, y * sine + z * cosine


def placed(
    ax: Axes, outline: Outline, centre: tuple[float, float], roll: float, *, colour: str,
    fill: float = 0.15, cross: bool = True, **style: Any,
) -> None:  # fmt: skip
    """Draw an outline with its centre of gravity, turned by its roll (right side down)."""
    y, z = turned(outline.y, outline.z, roll)
    if fill > 0.0:
        filled(ax, centre[0] + y, centre[1] + z, facecolor=colour, alpha=fill)
    ax.plot(centre[0] + y, centre[1] + z, color=colour, **({"linewidth": 1.3} | style))
    if cross:
        ax.plot(*centre, "+", color=colour, markersize=6, markeredgewidth=1.2)


def body_colours(vehicle: Vehicle) -> dict[str, str]:
    """A colour for each body."""
    palette = (BLUE, ORANGE, GREEN, PURPLE, SKY)
    return {body.name: palette[i % len(palette)] for i, body in enumerate(vehicle.bodies)}
