"""A vehicle's modes in words."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from railquake.assembly.vehicle import VehicleMatrices
from railquake.physics.vehicle import fixed_wheelset_modes

if TYPE_CHECKING:
    from railquake.inputs.vehicle import Vehicle

__all__ = ["mode_labels"]


def mode_labels(vehicle: Vehicle, matrices: VehicleMatrices) -> list[str]:
    """What each mode with the wheelset fixed looks like.

    The heaviest body is the car body.  A mode is named by the body with the largest share of its
    kinetic energy; lateral and roll together are a sway, lower if the body turns about a point
    below its centre of gravity (it leans the way it moves) and upper otherwise.
    """
    frequencies, shapes = fixed_wheelset_modes(matrices.mass, matrices.stiffness)
    names = matrices.bodies[:-1]
    masses = [body.mass for body in vehicle.bodies]
    heaviest = vehicle.bodies[int(np.argmax(masses))].name
    labels = []
    for k in range(len(frequencies)):
        energy = (matrices.mass[:-3] * shapes[:, k] ** 2).reshape(-1, 3)
        body = int(np.argmax(energy.sum(axis=1)))
        y, _, roll = shapes[3 * body : 3 * body + 3, k]
        name = "Carbody" if names[body] == heaviest else names[body].capitalize()
        if energy[body, 1] > energy[body, 0] + energy[body, 2]:
            labels.append(f"{name} bounce")
        elif names[body] == heaviest:
            labels.append(f"{name} {'lower' if y * roll > 0.0 else 'upper'} sway")
        else:
            labels.append(f"{name} {'roll' if energy[body, 2] > energy[body, 0] else 'lateral'}")
    return labels
