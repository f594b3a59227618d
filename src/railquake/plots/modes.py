"""Modes of a vehicle with its wheelset fixed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly import vehicle_matrices
from railquake.physics.vehicle import fixed_wheelset_modes
from railquake.plots.outline import Outline, body_colours, outlines, placed
from railquake.plots.style import BLACK, GREY, blank, heading, plain, save

if TYPE_CHECKING:
    from railquake.inputs.vehicle import Vehicle

__all__ = ["write_modes_picture"]

DRAWN = 6  # modes
LARGEST = 0.42  # displacement of any point of an outline that a mode is drawn with, m


@dataclass(frozen=True)
class _Car:
    """What is drawn of a vehicle in every one of its modes.

    Attributes
    ----------
    bodies : tuple of str
        In the order of the rows of a mode's shape.
    wheelset : str
    outlines, colours, heights : mapping
        By body.
    inertia : array, shape (bodies, 3)
        Masses, and moment of inertia about the roll axis.
    """

    bodies: tuple[str, ...]
    wheelset: str
    outlines: Mapping[str, Outline]
    colours: Mapping[str, str]
    heights: Mapping[str, float]
    inertia: Any

    @property
    def tallest(self) -> float:
        """Height of the highest point."""
        return max(self.heights[name] - self.outlines[name].z.min() for name in self.outlines)

    @property
    def widest(self) -> float:
        """Largest distance of a point from the middle."""
        return max(float(np.abs(outline.y).max()) for outline in self.outlines.values())


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
    car = _Car(
        tuple(matrices.bodies), vehicle.wheelset, outlines(vehicle), body_colours(vehicle),
        {body.name: body.height for body in vehicle.bodies}, matrices.mass.reshape(-1, 3),
    )  # fmt: skip
    count = min(DRAWN, len(frequencies))
    columns = min(3, count)
    rows = -(-count // columns)
    made = blank(3.2 * columns + 0.2, 3.3 * rows + 0.45)
    for k in range(count):
        ax = made.add_axes(
            (
                (0.1 + 3.2 * (k % columns)) / made.get_figwidth(),
                (0.05 + 3.3 * (rows - 1 - k // columns)) / made.get_figheight(),
                3.0 / made.get_figwidth(),
                2.95 / made.get_figheight(),
            )
        )
        # the wheelset, which is fixed, stands last
        _draw_mode(ax, car, np.append(shapes[:, k], np.zeros(3)).reshape(-1, 3))
        name = f"  {labels[k]}" if labels is not None else ""
        ax.set_title(plain(f"{k + 1}{name}, {frequencies[k]:.3f} Hz"), fontsize=10, loc="center")
    heading(
        made,
        plain(f"{vehicle.name}: natural modes with the wheelset fixed"),
        "amplitudes not to scale, outlines are sketches; "
        "⊙ where the body that moves most stands still",
    )
    return save(made, path)


def _draw_mode(ax: Any, car: _Car, shape: Any) -> None:
    """One mode: its bodies at rest and displaced."""
    # the heaviest body that takes part moves to the right, or up
    lead = int(np.argmax((car.inertia * shape**2).sum(axis=1)))
    way = shape[lead, 0] if abs(shape[lead, 0]) > abs(shape[lead, 1]) else -shape[lead, 1]
    scale = LARGEST / _largest(car, shape) * (-1.0 if way < 0.0 else 1.0)
    for i, name in enumerate(car.bodies):
        y, z, roll = scale * shape[i]
        fixed = name == car.wheelset
        centre = (0.0, -car.heights[name])
        placed(ax, car.outlines[name], centre, 0.0, colour="#9a9a9a", fill=0.0, linewidth=0.9,
               cross=False)  # fmt: skip
        placed(
            ax, car.outlines[name], (y, centre[1] + z), roll,
            colour=GREY if fixed else car.colours[name],
            linewidth=1.0 if fixed else 1.6, fill=0.3 if fixed else 0.13, cross=not fixed,
        )  # fmt: skip
        if i == lead and not fixed and abs(roll) > 1e-6 * LARGEST:
            _mark_pole(ax, centre[1] + y / roll, car.tallest)
    ax.plot([-1.2 * car.widest, 1.2 * car.widest], [0.0, 0.0], color=BLACK, linewidth=1.2)
    ax.set_aspect("equal")
    ax.set_xlim(-car.widest - 0.45, car.widest + 0.45)
    ax.set_ylim(0.15, -car.tallest - 0.5)
    ax.set_axis_off()


def _largest(car: _Car, shape: Any) -> float:
    """Largest displacement of any point of an outline."""
    largest = 0.0
    for name, (y, z, roll) in zip(car.bodies, shape, strict=True):
        outline = car.outlines[name]
        moved = np.hypot(y - roll * outline.z, z + roll * outline.y)
        largest = max(largest, float(moved.max()))
    return largest


def _mark_pole(ax: Any, z: float, tallest: float) -> None:
    """The point of a body that stands still, if it is in the picture."""
    if -tallest - 0.3 < z < 0.3:
        ax.plot(0.0, z, "o", color="white", markersize=6.5, markeredgecolor=BLACK, zorder=6)
        ax.plot(0.0, z, ".", color=BLACK, markersize=3.5, zorder=7)
