"""Pictures of one component by itself: modes, ground motion, hinge, creep laws."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly import vehicle_matrices
from railquake.physics import creep
from railquake.physics.vehicle import fixed_wheelset_modes
from railquake.plots.section import body_boxes, draw_body
from railquake.plots.style import BLUE, GREEN, GREY, ORANGE, RED, figure, label, legend, plain, save

if TYPE_CHECKING:
    from railquake.inputs.motion import GroundMotion
    from railquake.inputs.vehicle import Vehicle

__all__ = [
    "write_creep_picture",
    "write_hinge_picture",
    "write_modes_picture",
    "write_motion_picture",
]

Array = np.ndarray[Any, np.dtype[np.float64]]


def write_modes_picture(vehicle: Vehicle, labels: Sequence[str], path: Path) -> Path:
    """Draw the first six modes with the wheelset fixed, each body as a box (a sketch)."""
    matrices = vehicle_matrices(vehicle)
    frequencies, shapes = fixed_wheelset_modes(matrices.mass, matrices.stiffness)
    heights = {body.name: body.height for body in vehicle.bodies}
    boxes = body_boxes(vehicle)
    count = min(6, len(frequencies))
    made, axes = figure(9.0, 6.4, 2, 3, squeeze=False)
    for k, ax in enumerate(np.ravel(axes)):
        if k >= count:
            ax.set_visible(False)
            continue
        shape = np.append(shapes[:, k], np.zeros(3)).reshape(-1, 3)
        scale = 0.35 / max(np.abs(shape[:, :2]).max(), 1.3 * np.abs(shape[:, 2]).max())
        for i, body in enumerate(matrices.bodies):
            height = heights[body]
            lift = 0.9 if boxes[body][1] > 1.0 else 0.0
            draw_body(ax, (0.0, -height - lift), 0.0, boxes[body], color="#bbbbbb", linewidth=1.0)
            y, z, roll = scale * shape[i]
            centre = (y + lift * np.sin(roll), z - height - lift * np.cos(roll))
            draw_body(ax, centre, roll, boxes[body], color=(BLUE, ORANGE, GREEN, RED)[i % 4])
        ax.set_aspect("equal")
        ax.set_xlim(-2.2, 2.2)
        ax.set_ylim(0.4, -4.9)
        label(ax, title=plain(f"{labels[k]}: {frequencies[k]:.3f} Hz"))
    made.suptitle(plain(f"{vehicle.name}: modes, wheelset fixed"), fontsize=10, x=0.01, ha="left")
    return save(made, path)


def write_motion_picture(motion: GroundMotion, path: Path) -> Path:
    """Draw acceleration, velocity, displacement and the 5 % response spectrum."""
    from railquake.inputs.motion import response_spectrum
    from railquake.inputs.motion.motion import cumulative_trapezoid

    made, axes = figure(8.5, 9.0, 4)
    velocity = motion.velocity()
    for ax, values, text in (
        (axes[0], motion.acceleration, "acceleration, m/s²"),
        (axes[1], velocity, "velocity, m/s"),
        (axes[2], cumulative_trapezoid(velocity, motion.dt), "displacement, m"),
    ):
        ax.plot(motion.time, values, color=BLUE, linewidth=0.7)
        ax.set_xlim(0.0, motion.time[-1])
        label(ax, "time, s" if ax is axes[2] else "", text)
    periods = np.geomspace(max(0.03, 2.0 * motion.dt), 5.0, 150)
    axes[3].loglog(periods, response_spectrum(motion, periods).psa / 9.80665, color=RED)
    label(axes[3], "period, s", "pseudo-acc., g", "Response spectrum, 5 % damping")
    made.suptitle(
        plain(f"{motion.name}: PGA {motion.pga:.3f} m/s², PGV {motion.pgv:.3f} m/s"),
        fontsize=10,
        x=0.01,
        ha="left",
    )
    return save(made, path)


def write_hinge_picture(rotation: Array, moment: Array, path: Path) -> Path:
    """Draw a loop of moment against rotation."""
    made, ax = figure(6.0, 4.6)
    ax.plot(1e3 * np.asarray(rotation), 1e-6 * np.asarray(moment), color=BLUE, linewidth=0.9)
    ax.axhline(0.0, color=GREY, linewidth=0.6)
    ax.axvline(0.0, color=GREY, linewidth=0.6)
    label(ax, "rotation, mrad", "moment, MN m")
    return save(made, path)


def write_creep_picture(slope: float, limit: float, path: Path) -> Path:
    """Draw the creep laws: force over mu N against the lateral creepage, no spin.

    ``slope`` is f22, N; ``limit`` is mu N, N.
    """
    made, ax = figure(6.0, 4.2)
    creepage = np.linspace(0.0, 5.0 * limit / slope, 400)
    for name, law, colour in (
        ("Coulomb cap", creep.reduction_coulomb, GREY),
        ("Shen-Hedrick-Elkins", creep.reduction_shen_hedrick_elkins, BLUE),
        ("Carter", creep.reduction_carter, ORANGE),
        ("Polach", creep.reduction_polach, GREEN),
    ):
        force = [slope * xi * law(slope * xi, limit) / limit for xi in creepage]
        ax.plot(creepage, force, color=colour, label=name)
    label(ax, "lateral creepage, 1", "force / (friction times load), 1")
    legend(ax, loc="lower right")
    return save(made, path)
