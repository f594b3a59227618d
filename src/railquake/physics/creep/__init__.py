"""Tangential contact force: Kalker's linear theory and its saturation (Eq. 8 of the paper).

::

    F_x   = -f11 xi_x                    F_y = -f22 xi_y - f23 xi_sp          (linear, Eq. 8)
    f11   = G a b C11(a/b, nu)           f22 = G a b C22      f23 = G (a b)^1.5 C23
    xi_x  = (V - w r)/V                  xi_y = v_t / V
    xi_sp = sin(contact angle from the axle) w / V

w is the axle's rate and r the contact point's distance from it (`axle`); where the train is slower
than a bound, that bound stands for the V that divides, and a standing train has neither spin nor
longitudinal creepage.  v_t is the lateral velocity of the wheel relative to the rail in the contact
plane.  (The relative roll rate adds nothing to the spin: its axis x lies in the contact plane, so
it has no part about the contact normal.)  Friction bounds the force at mu N; a *law* says how it
gets there.  Most reduce the magnitude of the linear force by a factor of tau = abs(linear force) /
(mu N), with slope 1 at tau = 0, so that Kalker's initial slope is kept exactly.  Where spin is
large, as on a flange, the force turns as well: such a law is given the linear force by its causes
and gives the bounded one.

Each law is a file of this folder with its publication; a new one is found by lying here.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from railquake.laws import CREEP_LAWS

__all__ = [
    "CREEP_LAWS",
    "BoundedForce",
    "CreepLaw",
    "LawTable",
    "LinearForce",
    "bound_on_flange",
    "bound_on_tread",
    "bounded_force",
    "flange_saturation",
    "linear_force",
    "magnitude",
    "reduced",
    "saturation",
]

Array = np.ndarray[Any, np.dtype[np.float64]]


class LinearForce(NamedTuple):
    """Kalker's linear force on the wheel by its causes, N."""

    along: float  # F_x, by longitudinal creepage
    creep: float  # F_y, by lateral creepage
    spin: float  # F_y, by spin


class BoundedForce(NamedTuple):
    """The same once friction bounds it."""

    along: float
    creep: float
    spin: float
    share: float  # its magnitude over the linear force's: what is left of Kalker's slope


class LawTable(NamedTuple):
    """A table that is made once for a material."""

    size: int
    """Numbers in it."""
    nodes: Callable[[float], Array]
    """Poisson's ratio -> what ``fill`` needs to know of its nodes."""
    fill: Callable[[Array, Array], None]
    """(nodes, table to fill); it is compiled."""


class CreepLaw(NamedTuple):
    """How friction bounds Kalker's linear force: by its magnitude alone, or by its causes."""

    name: str
    saturation: Callable[[float, float], float] | None
    """(magnitude of the linear force, mu N) -> factor in (0, 1] by which all of it is reduced."""
    source: str
    bound: Callable[[LinearForce, float, float, Array], BoundedForce] | None = None
    """(linear force, mu N, log(a/b), table) -> force, instead of `saturation`."""
    table: LawTable | None = None
    """What ``bound`` reads."""


def linear_force(
    f11: float, f22: float, f23: float, creepages: tuple[float, float, float]
) -> LinearForce:
    """Eq. 8: the linear force of one contact.

    Parameters
    ----------
    f11, f22, f23 : float
        Creep coefficients, N, N and N m.
    creepages : (float, float, float)
        xi_x, xi_y and xi_sp (1/m).
    """
    along, lateral, spin = creepages
    return LinearForce(-f11 * along, -f22 * lateral, -f23 * spin)


def magnitude(force: LinearForce) -> float:
    """Of the vector (F_x, F_y), N."""
    across = force.creep + force.spin
    return math.sqrt(force.along * force.along + across * across)


def reduced(force: LinearForce, factor: float) -> BoundedForce:
    """The force with all its parts multiplied."""
    return BoundedForce(factor * force.along, factor * force.creep, factor * force.spin, factor)


def saturation(linear: float, limit: float) -> float:
    """Slot of the creep law: factor by which ``linear`` is reduced where friction gives ``limit``.

    Both in N; a magnitude, of either sign.
    """
    raise NotImplementedError("a creep law is chosen when a kernel is bound")


def flange_saturation(linear: float, limit: float) -> float:
    """Slot of the flange's creep law; see `saturation`."""
    raise NotImplementedError("a creep law is chosen when a kernel is bound")


def bound_on_tread(
    linear: LinearForce, limit: float, log_ratio: float, table: Array
) -> BoundedForce:
    """Slot of the creep law: the force where friction gives ``limit``, its direction kept.

    Parameters
    ----------
    linear : LinearForce
    limit : float
        mu N, N.
    log_ratio : float
        log(a/b) of the ellipse.
    table : array
        Of the law, where it has one.
    """
    return reduced(linear, saturation(magnitude(linear), limit))


def bound_on_flange(
    linear: LinearForce, limit: float, log_ratio: float, table: Array
) -> BoundedForce:
    """Slot of the flange's creep law; see `bound_on_tread`."""
    return reduced(linear, flange_saturation(magnitude(linear), limit))


def bounded_force(
    law: CreepLaw, linear: LinearForce, limit: float, log_ratio: float, table: Array
) -> BoundedForce:
    """What a law by itself makes of a linear force; parameters as of `bound_on_tread`."""
    if law.bound is not None:
        return law.bound(linear, limit, log_ratio, table)
    assert law.saturation is not None  # a law has one of the two
    return reduced(linear, law.saturation(magnitude(linear), limit))
