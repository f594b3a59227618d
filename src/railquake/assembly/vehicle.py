"""The vehicle's matrices (Eq. 1) from its bodies, springs and dashpots."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.stability import fastest_rate
from railquake.march.order import lateral_block
from railquake.physics.suspension import element_matrix, element_row

if TYPE_CHECKING:
    from railquake.inputs.vehicle import Vehicle

__all__ = ["VehicleMatrices", "vehicle_matrices"]

Array = np.ndarray[Any, np.dtype[np.float64]]

DIRECTIONS = {"lateral": (1.0, 0.0), "vertical": (0.0, 1.0)}


@dataclass(frozen=True)
class VehicleMatrices:
    """Eq. 1 of one vehicle.

    Attributes
    ----------
    bodies : tuple of str
        Names in the order of the degrees of freedom (y, z, phi of each); the wheelset stands last.
    mass : array, shape (n,)
        Diagonal of M_v, kg and kg m2.
    damping, stiffness : array, shape (n, n)
    """

    bodies: tuple[str, ...]
    mass: Array
    damping: Array
    stiffness: Array

    @cached_property
    def block(self) -> int:
        """Rows of the first block in the kernel's order; see `lateral_block`."""
        return lateral_block(self.stiffness, self.damping)

    @cached_property
    def fastest_rate(self) -> float:
        """The vehicle's fastest rate where nothing holds its wheelset, 1/s."""
        return fastest_rate(self.mass, self.stiffness, self.damping)


def vehicle_matrices(vehicle: Vehicle) -> VehicleMatrices:
    """Assemble mass, damping and stiffness of a vehicle.

    Parameters
    ----------
    vehicle : Vehicle

    Returns
    -------
    VehicleMatrices
    """
    bodies = sorted(vehicle.bodies, key=lambda body: body.name == vehicle.wheelset)
    number = {body.name: i for i, body in enumerate(bodies)}
    mass = np.array([value for b in bodies for value in (b.mass, b.mass, b.roll_inertia)])
    matrices = []
    for elements, coefficient in ((vehicle.dashpots, "damping"), (vehicle.springs, "stiffness")):
        rows, values = [], []
        for element in elements:
            first, second = (number[name] for name in element.bodies)
            # z points down: a point above a body's centre of gravity has a negative z
            z_first, z_second = (
                bodies[i].height - height
                for i, height in zip((first, second), element.end_heights, strict=True)
            )
            for side in (1.0, -1.0) if element.pair else (1.0,):
                y = side * element.lateral
                rows.append(
                    element_row(
                        len(bodies),
                        first,
                        second,
                        DIRECTIONS[element.direction],
                        (y, z_first),
                        (y, z_second),
                    )
                )
                values.append(getattr(element, coefficient))
        matrices.append(element_matrix(rows, values, 3 * len(bodies)))
    return VehicleMatrices(tuple(b.name for b in bodies), mass, matrices[0], matrices[1])
