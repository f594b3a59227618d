"""Energy audit: two balances that must close on every run.

*Whole* ::

    ground + gravity = kinetic + elastic (suspension, column) + hinge
                       + dashpots + Rayleigh - contact work on what moves by its own

and *contact* ::

    - contact work on vehicle and track = change of Hertz energy + impact + creep - spin

Each work is taken with the trapezoid on the forces as applied (the track feels those of the step
before).  ``hinge`` is the integral of M d(theta_1): it is defined, its split into stored and lost
is not.  ``spin`` is the lateral work of the spin creepage, paid for by the train's forward motion.
In a decoupled run the contact's work on the moving track is input and no part of the whole.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from railquake.physics import constant, state
from railquake.physics.vehicle import unpacked

__all__ = ["EnergyAudit", "audit"]

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class EnergyAudit:
    """All energies in J since the start.

    Attributes
    ----------
    ground, gravity : float
        Work of the effective ground forces and of gravity.
    kinetic, elastic : float
        Change of kinetic energy, and of elastic energy of suspension and column.
    hinge, rayleigh, dashpots : float
        Integral of the hinge's moment; losses to structural damping and to the dashpots.
    contact_vehicle, contact_track : float
        Work of the contact forces on the vehicle and on the track.
    hertz : float
        Change of the elastic energy stored in the contacts.
    impact, creep, spin : float
        Lost to the normal force's hysteresis and to creepage; brought in by spin.
    whole_residual, contact_residual : float
        What is left of each balance; of the contact's, positive is loss and negative is gain.
    """

    ground: float
    gravity: float
    kinetic: float
    elastic: float
    hinge: float
    rayleigh: float
    dashpots: float
    contact_vehicle: float
    contact_track: float
    hertz: float
    impact: float
    creep: float
    spin: float
    whole_residual: float
    contact_residual: float

    @property
    def dissipated(self) -> float:
        """Dashpots, Rayleigh, hinge, impact and creep together, J."""
        return self.dashpots + self.rayleigh + self.hinge + self.impact + self.creep

    @property
    def whole_relative(self) -> float:
        """Whole balance's residual over what is dissipated."""
        return self.whole_residual / max(self.dissipated, 1e-9)

    @property
    def contact_relative(self) -> float:
        """Contact balance's residual over what impact and creep lose."""
        return self.contact_residual / max(self.impact + self.creep, 1e-9)


def audit(start: Array, end: Array, constants: Array) -> EnergyAudit:
    """Both balances of one run.

    Parameters
    ----------
    start, end : array, shape (state rows, 1)
    constants : array, shape (constant rows, 1)

    Returns
    -------
    EnergyAudit
    """
    first, last, q = start[:, 0], end[:, 0], constants[:, 0]
    dofs = (len(first) - state.VEHICLE) // state.VEHICLE_BLOCKS
    pier_mass = q[constant.M_U : constant.M_U + 3]
    column = unpacked(q[constant.K : constant.K + 6])
    block = constant.VEHICLE + dofs // 3
    inverse_mass = q[block : block + dofs]
    entries = dofs * (dofs + 1) // 2
    suspension = unpacked(q[block + dofs : block + dofs + entries])

    def stored(s: Array) -> tuple[float, float]:
        x, v = s[state.U : state.U + 3], s[state.U_V : state.U_V + 3]
        moves = q[constant.PIER_LOAD] > 0.0
        kinetic = 0.5 * float(v @ (pier_mass * v)) if moves else 0.0
        elastic = 0.5 * float(x @ column @ x) if moves else 0.0
        x = s[state.VEHICLE : state.VEHICLE + dofs]
        v = s[state.VEHICLE + dofs : state.VEHICLE + 2 * dofs]
        kinetic += 0.5 * float(v @ (v / inverse_mass))
        elastic += 0.5 * float(x @ suspension @ x)
        return kinetic, elastic

    kinetic_start, elastic_start = stored(first)
    kinetic_end, elastic_end = stored(last)
    # a vehicle that has left the model took its kinetic energy along
    gone = 0.0
    if last[state.ON_TRACK] == 0.0:
        x = last[state.VEHICLE : state.VEHICLE + dofs]
        gone = float(last[state.VEHICLE_ENERGY]) - 0.5 * float(x @ suspension @ x)
    kinetic = kinetic_end - kinetic_start + gone
    elastic = elastic_end - elastic_start
    hertz = float(last[state.HERTZ_ENERGY] + last[state.HERTZ_LEFT] - first[state.HERTZ_ENERGY])
    total: dict[str, float] = {
        name: float(last[row])
        for name, row in (
            ("ground", state.WORK_GROUND),
            ("gravity", state.WORK_GRAVITY),
            ("hinge", state.HINGE_ENERGY),
            ("rayleigh", state.LOST_RAYLEIGH),
            ("dashpots", state.LOST_DASHPOTS),
            ("contact_vehicle", state.WORK_VEHICLE),
            ("contact_track", state.WORK_TRACK),
            ("impact", state.LOST_IMPACT),
            ("creep", state.LOST_CREEP),
            ("spin", state.SPIN_INPUT),
        )
    }
    applied = total["contact_vehicle"] + float(q[constant.REACTION]) * total["contact_track"]
    whole = (
        total["ground"]
        + total["gravity"]
        - kinetic
        - elastic
        - total["hinge"]
        - total["rayleigh"]
        - total["dashpots"]
        + applied
    )
    contact = (
        -total["contact_vehicle"]
        - total["contact_track"]
        - hertz
        - total["impact"]
        - total["creep"]
        + total["spin"]
    )
    return EnergyAudit(
        kinetic=kinetic,
        elastic=elastic,
        hertz=hertz,
        whole_residual=whole,
        contact_residual=contact,
        **total,
    )
