"""The vehicle's matrices (Eq. 1) from its bodies, springs and dashpots."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.joints import NO_JOINTS, Joints, Suspension, joints_of
from railquake.assembly.stability import fastest_rate
from railquake.assembly.stages import Stage, stages_of
from railquake.errors import InputError
from railquake.march.order import lateral_block
from railquake.physics.suspension import element_matrix, element_row, roll_row
from railquake.physics.vehicle import GRAVITY, fixed_wheelset_modes

if TYPE_CHECKING:
    from railquake.inputs.vehicle import Body, Vehicle

__all__ = ["VehicleMatrices", "bodies_of", "refuse_unstable", "sag_of", "vehicle_matrices"]

Array = np.ndarray[Any, np.dtype[np.float64]]

DIRECTIONS = {"lateral": (1.0, 0.0), "vertical": (0.0, 1.0)}


@dataclass(frozen=True)
class VehicleMatrices:
    """Eq. 1 of one vehicle: as it is, or of a car with finite rotations at rest under gravity.

    Attributes
    ----------
    bodies : tuple of str
        Names in the order of the degrees of freedom (y, z, phi of each); the wheelset stands last.
    mass : array, shape (n,)
        Diagonal of M_v, kg and kg m2.
    damping, stiffness : array, shape (n, n)
    without_gravity : array, shape (n, n)
        Stiffness without gravity's moments.
    joints : Joints
        None of a linear car.
    stages : tuple of Stage
        Primary and secondary suspension, as many as there are.
    """

    bodies: tuple[str, ...]
    mass: Array
    damping: Array
    stiffness: Array
    without_gravity: Array
    joints: Joints = NO_JOINTS
    stages: tuple[Stage, ...] = ()

    @property
    def is_finite(self) -> bool:
        """Whether its bodies turn by any angle."""
        return bool(self.joints.joined.elements)

    @property
    def kinematics(self) -> str:
        """What stands in the slot of that name; a body without joints has no use for them."""
        return "finite" if self.is_finite else "linear"

    @cached_property
    def block(self) -> int:
        """Rows of the first block in the kernel's order; see `lateral_block`."""
        return lateral_block(self.stiffness, self.damping)

    @cached_property
    def weight(self) -> Array:
        """Generalised forces of gravity, shape (n,)."""
        weight = GRAVITY * self.mass
        weight[0::3] = 0.0
        weight[2::3] = 0.0
        return weight

    @cached_property
    def suspension(self) -> Suspension:
        """The joints at work."""
        return Suspension(self.mass, self.joints)

    @cached_property
    def states(self) -> tuple[tuple[Array, Array], ...]:
        """Stiffness and damping where no stop bears; and where all do, if there are any."""
        free = (self.stiffness, self.damping)
        if not self.joints.stops:
            return (free,)
        return free, Suspension(self.mass, self.joints.engaged()).tangents()

    @cached_property
    def fastest_rate(self) -> float:
        """The vehicle's fastest rate where nothing holds its wheelset, 1/s."""
        return max(fastest_rate(self.mass, *matrices) for matrices in self.states)

    def held_by(self, x: Array) -> Array:
        """Generalised forces, shape (n,), that hold the weightless vehicle at ``x``."""
        held: Array = -self.suspension.pulls(x) if self.is_finite else self.stiffness @ x
        return held

    def elastic_energy(self, x: Array) -> float:
        """Stored in springs and stops, J."""
        return self.suspension.energy(x) if self.is_finite else 0.5 * float(x @ self.stiffness @ x)


def vehicle_matrices(vehicle: Vehicle) -> VehicleMatrices:
    """Assemble mass, damping and stiffness of a vehicle; its joints too if it turns by any angle.

    Parameters
    ----------
    vehicle : Vehicle

    Returns
    -------
    VehicleMatrices
    """
    bodies = bodies_of(vehicle)
    linear = replace(_linear_matrices(vehicle, bodies), stages=stages_of(vehicle, bodies))
    return linear if vehicle.kinematics == "linear" else _with_gravity(linear, vehicle, bodies)


def _linear_matrices(vehicle: Vehicle, bodies: list[Body]) -> VehicleMatrices:
    """Springs, dashpots and anti-roll bars about the undeformed position, gravity left out."""
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
        if coefficient == "stiffness":
            for bar in vehicle.anti_roll_bars:
                rows.append(roll_row(len(bodies), *(number[name] for name in bar.bodies)))
                values.append(bar.stiffness)
        matrices.append(element_matrix(rows, values, 3 * len(bodies)))
    names = tuple(body.name for body in bodies)
    return VehicleMatrices(names, mass, matrices[0], matrices[1], without_gravity=matrices[1])


def bodies_of(vehicle: Vehicle) -> list[Body]:
    """In the order of the degrees of freedom: the wheelset stands last."""
    return sorted(vehicle.bodies, key=lambda body: body.name == vehicle.wheelset)


def sag_of(stiffness: Array, weight: Array) -> Array:
    """A linear suspension's own compression under the bodies' weight, wheelset held."""
    sag = np.zeros(len(weight))
    if len(weight) > 3:
        try:
            sag[:-3] = np.linalg.solve(stiffness[:-3, :-3], weight[:-3])
        except np.linalg.LinAlgError:
            raise InputError(
                "vehicle: its springs do not hold every motion of its bodies; check "
                "springs.*.lateral: vertical springs in the middle hold no roll"
            ) from None
    return sag


def _with_gravity(linear: VehicleMatrices, vehicle: Vehicle, bodies: list[Body]) -> VehicleMatrices:
    """A car with finite rotations, linearised where it stands."""
    joints = joints_of(vehicle, bodies, sag_of(linear.stiffness, linear.weight))
    if not joints.joined.elements:
        return linear  # a body alone
    stiffness, damping = Suspension(linear.mass, joints).tangents()
    return replace(linear, joints=joints, stiffness=stiffness, damping=damping)


def refuse_unstable(vehicle: VehicleMatrices) -> None:
    """Refuse a car that falls over by its own weight.

    Raises
    ------
    InputError
        Which mode it is, and what roll stiffness would hold it.
    """
    if not vehicle.is_finite:
        return
    frequencies, shapes = fixed_wheelset_modes(vehicle.mass, vehicle.stiffness)
    if frequencies[0] > 0.0:
        return
    shape = shapes[:, 0]
    energy = (vehicle.mass[:-3] * shape**2).reshape(-1, 3).sum(axis=1)
    body = int(np.argmax(energy))
    joined = [
        (upper, lower)
        for _, upper, lower in vehicle.joints.joined.elements
        if body in (upper, lower)
    ]
    upper, lower = max(joined, key=joined.count)
    turn = np.zeros(len(vehicle.mass))
    turn[[3 * upper + 2, 3 * lower + 2]] = 1.0, -1.0
    turn = turn[:-3]
    # the stiffness k for which K + k t t^T has a mode of no frequency
    needed = -1.0 / float(turn @ np.linalg.solve(vehicle.stiffness[:-3, :-3], turn))
    more = (
        f"about {needed:.2g} N m/rad more roll stiffness between {vehicle.bodies[upper]} and "
        f"{vehicle.bodies[lower]} would just hold it: springs farther apart or an anti-roll bar"
        if needed > 0.0
        else "stiffer springs, farther apart, are needed"
    )
    raise InputError(
        f"vehicle: {vehicle.bodies[body]} falls over by its own weight (lowest mode "
        f'{frequencies[0]:.3g} Hz, unstable); {more}; or take kinematics = "linear", which '
        "leaves gravity's moments out"
    )
