"""Energy audit: two balances that must close on every run.

*Whole* ::

    ground + gravity = kinetic + elastic (suspension, column) + hinge
                       + dashpots + Rayleigh - contact work on what moves by its own

and *contact* ::

    - contact work on vehicle and track = change of Hertz energy + impact + creep - spin - forward

Each work is taken with the trapezoid on the forces as applied (the track feels those of the step
before).  ``hinge`` is the integral of M d(theta_1): it is defined, its split into stored and lost
is not.  The train's forward motion pays for ``spin``, the lateral work of the spin creepage, and
for ``forward``, what longitudinal creepage loses (net of what the axle gathers as it turns).
In a decoupled run the contact's work on the moving track is input and no part of the whole.
"""

from dataclasses import dataclass
from typing import NamedTuple

__all__ = [
    "EnergyAudit",
    "Works",
    "contact_residual",
    "kinetic_and_elastic",
    "whole_residual",
]


class Works(NamedTuple):
    """What has been added up during a run, J; see `EnergyAudit`."""

    ground: float
    gravity: float
    hinge: float
    rayleigh: float
    dashpots: float
    contact_vehicle: float
    contact_track: float
    impact: float
    creep: float
    spin: float
    forward: float


def kinetic_and_elastic(x: float, v: float, force: float, inverse_mass: float) -> float:
    """Energy of one degree of freedom that ``force`` = (K x)_i holds, J; added up over all."""
    return 0.5 * (x * force + v * v / inverse_mass)


def whole_residual(works: Works, kinetic: float, elastic: float, reaction: float) -> float:
    """What is left of the whole balance; ``reaction`` is 1 where the train acts on the pier."""
    applied = works.contact_vehicle + reaction * works.contact_track
    return (
        works.ground
        + works.gravity
        - kinetic
        - elastic
        - works.hinge
        - works.rayleigh
        - works.dashpots
        + applied
    )


def contact_residual(works: Works, hertz: float) -> float:
    """What is left of the contact's balance; positive is loss, negative is gain."""
    return (
        -works.contact_vehicle
        - works.contact_track
        - hertz
        - works.impact
        - works.creep
        + works.spin
        + works.forward
    )


@dataclass(frozen=True)
class EnergyAudit:
    """All energies in J since the start.

    Attributes
    ----------
    ground, gravity : float
        Work of the effective ground forces and of gravity.
    fallen : float
        The latter once more, from the bodies' heights at both ends.
    kinetic, elastic : float
        Change of kinetic energy, and of elastic energy of suspension and column.
    hinge, rayleigh, dashpots : float
        Integral of the hinge's moment; losses to structural damping and to the dashpots.
    contact_vehicle, contact_track : float
        Work of the contact forces on the vehicle and on the track.
    hertz : float
        Change of the elastic energy stored in the contacts.
    impact, creep, spin, forward : float
        Lost to the normal force's hysteresis and to creepage; brought in by spin and by the
        train's forward motion against longitudinal creepage.
    whole_residual, contact_residual : float
        What is left of each balance; of the contact's, positive is loss and negative is gain.
    """

    ground: float
    gravity: float
    fallen: float
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
    forward: float
    whole_residual: float
    contact_residual: float

    @property
    def dissipated(self) -> float:
        """Dashpots, Rayleigh, hinge, impact, creep without what forward motion pays, J."""
        return self.dashpots + self.rayleigh + self.hinge + self.lost_in_contact

    @property
    def lost_in_contact(self) -> float:
        """To impact and to creep, without what the train's forward motion pays, J."""
        return self.impact + self.creep - self.forward

    @property
    def whole_relative(self) -> float:
        """Whole balance's residual over what is dissipated."""
        return self.whole_residual / max(self.dissipated, 1e-9)

    @property
    def contact_relative(self) -> float:
        """Contact balance's residual over what impact and creep lose."""
        return self.contact_residual / max(self.lost_in_contact, 1e-9)

    @property
    def gravity_relative(self) -> float:
        """Gravity's work less that from the bodies' heights, over what is dissipated."""
        return (self.gravity - self.fallen) / max(self.dissipated, 1e-9)

    @property
    def forward_share(self) -> float:
        """What forward motion pays for, by spin and longitudinal creepage, over creep's loss."""
        return (abs(self.spin) + abs(self.forward)) / max(self.creep, 1e-9)
