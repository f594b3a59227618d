"""The audits of a run, from its rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.march.order import kernel_order
from railquake.physics.energy import EnergyAudit, Works, contact_residual, whole_residual
from railquake.physics.momentum import MomentumAudit
from railquake.physics.vehicle import GRAVITY

if TYPE_CHECKING:
    from railquake.assembly import System

__all__ = ["audit", "momentum_audit"]

Array = np.ndarray[Any, np.dtype[np.float64]]


def audit(system: System, end: Array) -> EnergyAudit:
    """Both balances of one run.

    Parameters
    ----------
    system : System
    end : array, shape (state rows, 1)
    """
    state, blocks = system.layout.state, system.layout.state_blocks
    constants = system.layout.constant_blocks
    first, last, q = system.start[:, 0], end[:, 0], system.constants[:, 0]
    inverse_mass = q[constants["INVERSE_MASS"]]
    structure = system.structure
    order = kernel_order(system.layout.size.DOFS)

    def stored_in_suspension(s: Array) -> float:
        """Elastic energy of the vehicle."""
        x = np.empty(len(order))
        x[order] = s[blocks["VEHICLE_X"]]
        return system.vehicle.elastic_energy(x)

    def stored(s: Array) -> tuple[float, float]:
        """Kinetic and elastic energy."""
        x, v = s[blocks["STRUCTURE_X"]], s[blocks["STRUCTURE_V"]]
        kinetic = 0.5 * float(v @ (structure.mass * v)) if structure.moves else 0.0
        elastic = 0.5 * float(x @ structure.stiffness @ x) if structure.moves else 0.0
        v = s[blocks["VEHICLE_V"]]
        kinetic += 0.5 * float(v @ (v / inverse_mass))
        elastic += stored_in_suspension(s)
        return kinetic, elastic

    kinetic_start, elastic_start = stored(first)
    kinetic_end, elastic_end = stored(last)
    # a vehicle that has left the model took its kinetic energy along
    gone = 0.0
    if last[state.ON_TRACK] == 0.0:
        gone = float(last[state.VEHICLE_ENERGY]) - stored_in_suspension(last)
    kinetic = kinetic_end - kinetic_start + gone
    elastic = elastic_end - elastic_start
    hertz = float(last[state.HERTZ_ENERGY] + last[state.HERTZ_LEFT] - first[state.HERTZ_ENERGY])
    works = Works(
        ground=float(last[state.WORK_GROUND]),
        gravity=float(last[state.WORK_GRAVITY]),
        hinge=float(last[state.HINGE_ENERGY]),
        rayleigh=float(last[state.LOST_RAYLEIGH]),
        dashpots=float(last[state.LOST_DASHPOTS]),
        contact_vehicle=float(last[state.WORK_VEHICLE]),
        contact_track=float(last[state.WORK_TRACK]),
        impact=float(last[state.LOST_IMPACT]),
        creep=float(last[state.LOST_CREEP]),
        spin=float(last[state.SPIN_INPUT]),
        forward=float(last[state.FORWARD_INPUT]),
    )
    # how far each body has fallen; one that has left stays where it was then
    fallen = (last - first)[state.VEHICLE_X + 2 * len(order) // 3 :][: len(order) // 3]
    return EnergyAudit(
        fallen=GRAVITY * float(q[constants["AUDIT_MASS"]] @ fallen),
        kinetic=kinetic,
        elastic=elastic,
        hertz=hertz,
        whole_residual=whole_residual(works, kinetic, elastic, structure.reaction),
        contact_residual=contact_residual(works, hertz),
        **works._asdict(),
    )


def momentum_audit(system: System, end: Array) -> MomentumAudit:
    """Momentum and angular momentum of one run.

    Parameters
    ----------
    system : System
    end : array, shape (state rows, 1)
    """
    state, last = system.layout.state, end[:, 0]
    return MomentumAudit(
        linear_residual=float(last[state.PEAK_LINEAR_LEFT]),
        angular_residual=float(last[state.PEAK_ANGULAR_LEFT]),
        linear_impulse=float(last[state.PEAK_IMPULSE]),
        angular_impulse=float(last[state.PEAK_TURNING]),
        omitted_impulse=float(last[state.PEAK_OMITTED]),
        mass=system.scenario.vehicle.mass,
    )
