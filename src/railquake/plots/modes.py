"""Modes of a vehicle with its wheelset fixed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from railquake.assembly import vehicle_matrices
from railquake.physics.vehicle import fixed_wheelset_modes
from railquake.plots.outline import body_colours, outlines, placed
from railquake.plots.style import BLACK, GREY, blank, heading, plain, save

if TYPE_CHECKING:
    from railquake.inputs.vehicle import Vehicle

__all__ = ["write_modes_picture"]

DRAWN = 6  # modes
LARGEST = 0.42  # displacement of any point of an outline that a mode is drawn with, m


def write_modes_picture(vehicle: Vehicle, labels: Sequence[str] | None, path: Path) -> Path:
    """Draw the first six modes with the wheelset fixed (the paper's Figure 6, left).

    Parameters
    ----------
    vehicle : Vehicle
    labels : sequence of str or None
        What to call each mode; its number alone without.
    path : Path
        PNG to write.

    Returns
    -------
    Path
    """
    matrices = vehicle_matrices(vehicle)
    frequencies, shapes = fixed_wheelset_modes(matrices.mass, matrices.stiffness)
    heights = {body.name: body.height for body in vehicle.bodies}
    drawn, colours = outlines(vehicle), body_colours(vehicle)
    tallest = max(heights[name] - drawn[name].z.min() for name in drawn)
    widest = max(float(np.abs(drawn[name].y).max()) for name in drawn)
    count = min(DRAWN, len(frequencies))
    columns = min(3, count)
    rows = -(-count // columns)
    made = blank(3.2 * columns + 0.2, 3.3 * rows + 0.45)
    for k in range(count):
        shape = np.append(shapes[:, k], np.zeros(3)).reshape(-1, 3)
        ax = made.add_axes(
            (
                (0.1 + 3.2 * (k % columns)) / made.get_figwidth(),
                (0.05 + 3.3 * (rows - 1 - k // columns)) / made.get_figheight(),
                3.0 / made.get_figwidth(),
                2.95 / made.get_figheight(),
            )
        )
        largest = 0.0
        for i, name in enumerate(matrices.bodies):
            y, z, roll = shape[i]
            outline = drawn[name]
            moved = np.hypot(y - roll * outline.z, z + roll * outline.y)
            largest = max(largest, float(moved.max()))
        scale = LARGEST / largest
        # the heaviest body that takes part moves to the right, or up
        lead = int(np.argmax((matrices.mass.reshape(-1, 3) * shape**2).sum(axis=1)))
        way = shape[lead, 0] if abs(shape[lead, 0]) > abs(shape[lead, 1]) else -shape[lead, 1]
        scale *= -1.0 if way < 0.0 else 1.0
        for i, name in enumerate(matrices.bodies):
            y, z, roll = scale * shape[i]
            fixed = name == vehicle.wheelset
            centre = (0.0, -heights[name])
            placed(ax, drawn[name], centre, 0.0, colour="#9a9a9a", fill=0.0, linewidth=0.9,
                   cross=False)  # fmt: skip
            placed(
                ax, drawn[name], (y, centre[1] + z), roll, colour=GREY if fixed else colours[name],
                linewidth=1.0 if fixed else 1.6, fill=0.3 if fixed else 0.13, cross=not fixed,
            )  # fmt: skip
            if not fixed and abs(roll) > 1e-6 * LARGEST:
                # the point of the body that stands still, if it is in the picture
                below = y / roll
                if i == lead and -tallest - 0.3 < centre[1] + below < 0.3:
                    ax.plot(0.0, centre[1] + below, "o", color="white", markersize=6.5,
                            markeredgecolor=BLACK, zorder=6)  # fmt: skip
                    ax.plot(0.0, centre[1] + below, ".", color=BLACK, markersize=3.5, zorder=7)
        ax.plot([-1.2 * widest, 1.2 * widest], [0.0, 0.0], color=BLACK, linewidth=1.2)
        ax.set_aspect("equal")
        ax.set_xlim(-widest - 0.45, widest + 0.45)
        ax.set_ylim(0.15, -tallest - 0.5)
        ax.set_axis_off()
        name = f"  {labels[k]}" if labels is not None else ""
        ax.set_title(plain(f"{k + 1}{name}, {frequencies[k]:.3f} Hz"), fontsize=10, loc="center")
    heading(
        made,
        plain(f"{vehicle.name}: natural modes with the wheelset fixed"),
        "amplitudes not to scale, outlines are sketches; "
        "⊙ where the body that moves most stands still",
    )
    return save(made, path)
