"""What the momentum audit knows of the car, from the inputs by themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.assembly.vehicle import bodies_of
from railquake.march.order import kernel_order
from railquake.physics.suspension import element_row

if TYPE_CHECKING:
    from collections.abc import Sequence

    from railquake.inputs.vehicle import Body, Dashpot, Spring, Vehicle
    from railquake.march.rows import Layout

__all__ = ["fill_momentum"]

Array = np.ndarray[Any, np.dtype[np.float64]]


def fill_momentum(q: Array, vehicle: Vehicle, rolling_radius: float, layout: Layout) -> None:
    """Constants of the audit; see `march.momentum`.

    Parameters
    ----------
    q : array, shape (constant rows,)
    vehicle : Vehicle
    rolling_radius : float
        At which the wheelset's centre stands above the rails, m.
    layout : Layout
    """
    blocks = layout.constant_blocks
    bodies = bodies_of(vehicle)
    # the pair of profiles decides where the wheelset stands, and the car stands on it
    raised = rolling_radius - bodies[-1].height
    q[layout.constant.AUDIT_AXLES] = vehicle.axles
    q[blocks["AUDIT_MASS"]] = [body.mass for body in bodies]
    q[blocks["AUDIT_INERTIA"]] = [body.roll_inertia for body in bodies]
    q[blocks["AUDIT_HEIGHT"]] = [body.height + raised for body in bodies]
    order = kernel_order(3 * len(bodies))
    springs = [(spring, spring.stiffness) for spring in vehicle.springs]
    dashpots = [(dashpot, dashpot.damping) for dashpot in vehicle.dashpots]
    q[blocks["COUPLE_STIFFNESS"]] = _couple(springs, bodies)[order]
    q[blocks["COUPLE_DAMPING"]] = _couple(dashpots, bodies)[order]


def _couple(elements: Sequence[tuple[Spring | Dashpot, float]], bodies: list[Body]) -> Array:
    """Moment on both bodies together per displacement of each, shape (3 * bodies,).

    A lateral element of a linear car stays level however its ends stand: its two forces, equal and
    opposite, make a couple where these are apart.
    """
    number = {body.name: k for k, body in enumerate(bodies)}
    couple = np.zeros(3 * len(bodies))
    for element, coefficient in elements:
        upper, lower = element.end_heights
        if element.direction == "lateral" and upper != lower:
            first, second = (number[name] for name in element.bodies)
            row = element_row(
                len(bodies),
                first,
                second,
                (1.0, 0.0),
                (0.0, bodies[first].height - upper),
                (0.0, bodies[second].height - lower),
            )
            couple += (2.0 if element.pair else 1.0) * coefficient * (upper - lower) * row
    return couple
