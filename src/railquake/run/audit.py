"""The energy audit of a run, from its rows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from railquake.march.order import kernel_order
from railquake.physics.energy import EnergyAudit, Works, contact_residual, whole_residual

if TYPE_CHECKING:
    from railquake.assembly import System

__all__ = ["audit"]

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
    return EnergyAudit(
        kinetic=kinetic,
        elastic=elastic,
        hertz=hertz,
        whole_residual=whole_residual(works, kinetic, elastic, structure.reaction),
        contact_residual=contact_residual(works, hertz),
        **works._asdict(),
    )
