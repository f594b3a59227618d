"""Tangential contact force: Kalker's linear theory and its saturation (Eq. 8 of the paper).

In the section there is no longitudinal motion, so F_x = 0 and ::

    F_y   = -f22 xi_y - f23 xi_sp                     (linear, Eq. 8)
    f22   = G a b C22(a/b, nu)        f23 = G (a b)^1.5 C23(a/b, nu)
    xi_y  = v_t / V        xi_sp = sin(contact angle from the axle) / rolling radius

v_t is the lateral velocity of the wheel relative to the rail in the contact plane.  Friction
bounds the force at mu N; a *law* says how it gets there: it returns the factor by which the linear
force is reduced, as a function of tau = abs(linear force) / (mu N), with slope 1 at tau = 0, so
that Kalker's initial slope is kept exactly.  (The relative roll rate adds nothing to the spin: its
axis x lies in the contact plane, so it has no part about the contact normal.)

Each law is a file of this folder with its publication; a new one is found by lying here.
"""

from collections.abc import Callable
from typing import NamedTuple

from railquake.laws import CREEP_LAWS

__all__ = ["CREEP_LAWS", "CreepLaw", "LinearForce", "linear_force", "saturation"]


class CreepLaw(NamedTuple):
    """How friction bounds Kalker's linear force."""

    name: str
    saturation: Callable[[float, float], float]
    """(linear force, mu N) -> factor in (0, 1] by which the linear force is reduced."""
    source: str


class LinearForce(NamedTuple):
    """Kalker's linear lateral force by its causes, N."""

    creep: float
    spin: float


def linear_force(
    f22: float, f23: float, sliding: float, inverse_speed: float, spin: float
) -> LinearForce:
    """Eq. 8: the linear lateral force of one contact.

    Parameters
    ----------
    f22, f23 : float
        Creep coefficients, N and N m.
    sliding : float
        v_t of the wheel relative to the rail, m/s.
    inverse_speed : float
        1/V, s/m.
    spin : float
        xi_sp, 1/m; or, with f23/r in the place of f23, xi_sp r.
    """
    return LinearForce(-f22 * sliding * inverse_speed, -f23 * spin)


def saturation(linear: float, limit: float) -> float:
    """Slot of the creep law: factor by which ``linear`` is reduced where friction gives ``limit``.

    Both in N.
    """
    raise NotImplementedError("a creep law is chosen when a kernel is bound")
