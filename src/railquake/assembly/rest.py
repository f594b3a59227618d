"""The state from which a run starts: a train that stands, or runs evenly, on its structure."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.optimize import brentq

from railquake.assembly.vehicle import sag_of
from railquake.errors import InputError
from railquake.physics.hinge import HINGE_LAWS, HingeLaw

if TYPE_CHECKING:
    from railquake.assembly.stability import ContactForces
    from railquake.assembly.supports import Structure
    from railquake.assembly.vehicle import VehicleMatrices

__all__ = ["Equilibrium", "LoadedHinge", "Rest", "find_rest", "loaded_hinge", "newton_root"]

Array = np.ndarray[Any, np.dtype[np.float64]]


@dataclass(frozen=True)
class LoadedHinge:
    """A hinge that stands still under a moment.

    Attributes
    ----------
    rotation : float
        rad.
    moment, tangent : float
        N m and N m/rad, as the law gives them there.
    state : named tuple
        Of the law.
    """

    rotation: float
    moment: float
    tangent: float
    state: Any


def loaded_hinge(law: HingeLaw, parameters: Any, moment: float) -> LoadedHinge:
    """A virgin hinge loaded by ``moment``, N m.

    The rotation grows in steps of a hundredth of the elastic answer, so that the result does not
    depend on the path.

    Raises
    ------
    InputError
        If the hinge cannot carry the moment.
    """

    def turned(at: LoadedHinge, by: float) -> LoadedHinge:
        answer = law.advance(at.rotation, at.state, parameters, by, 0.0)
        turned_to = at.rotation + answer.step
        return LoadedHinge(turned_to, answer.moment, answer.tangent, law.standing(answer.state))

    at = LoadedHinge(0.0, 0.0, parameters.k0, law.virgin)
    if moment != 0.0:
        cannot = InputError(
            f"the hinge cannot carry the standing train: a moment of {abs(moment):.3g} N m is "
            "needed; check support.bouc_wen (k0, beta0) and support.track_offset"
        )
        increment = moment / parameters.k0 / 100.0
        if not math.isfinite(moment) or increment == 0.0:
            raise cannot
        for _ in range(20_000):
            after = turned(at, increment)
            if abs(after.moment) >= abs(moment):
                break
            at = after
        else:
            raise cannot
        try:
            last = brentq(lambda by: turned(at, by).moment - moment, 0.0, increment, xtol=1e-18)
        except (ValueError, RuntimeError):  # it pushes the wrong way there, or jumps
            raise cannot from None
        at = turned(at, float(last))
    held = turned(at, 0.0)
    return LoadedHinge(at.rotation, held.moment, held.tangent, at.state)


@dataclass(frozen=True)
class Equilibrium:
    """What stands on what.

    Attributes
    ----------
    vehicle : VehicleMatrices
    structure : Structure
    forces : callable
        See `stability.ContactForces`.
    settlement : float
        Vertical displacement of the wheelset at which the treads bear about their load, m.
    carried : callable
        Track (y, z, phi) -> displacements of a car carried along undeformed.
    """

    vehicle: VehicleMatrices
    structure: Structure
    forces: ContactForces
    settlement: float
    carried: Callable[[Array], Array]


@dataclass(frozen=True)
class Rest:
    """Where everything stands.

    Attributes
    ----------
    structure : array, shape (N,)
    vehicle : array, shape (n,)
    drift : float
        Sideways creep of the whole car, m/s.
    hinge : LoadedHinge
    """

    structure: Array
    vehicle: Array
    drift: float
    hinge: LoadedHinge


def find_rest(of: Equilibrium) -> Rest:
    """Equilibrium of the standing or evenly running train, centred on the track.

    Where the track is tilted by the train's eccentric weight, no position is at rest on
    cylindrical treads: the car then creeps sideways at the small, constant speed at which
    creepage carries the weight's lateral part.  That speed is found with the positions.
    """
    structure = of.structure
    law = HINGE_LAWS[structure.hinge]
    count, _, hinge_at, _ = structure.degrees
    n = len(of.vehicle.mass)
    weight = of.vehicle.weight
    # a car with finite rotations is drawn as it stands
    sag = np.zeros(n) if of.vehicle.is_finite else sag_of(of.vehicle.stiffness, weight)
    secant = structure.parameters.k0

    # first guess: the structure under the weight on its track, the car carried along
    track_map = structure.track_map
    initial = structure.stiffness.copy()
    initial[hinge_at, hinge_at] += secant
    down = track_map.T @ np.array([0.0, weight.sum(), 0.0])
    guess = np.linalg.solve(initial, structure.reaction * down)
    start = np.concatenate([guess, of.carried(track_map @ guess)])
    start[count + 1 :: 3] += of.settlement
    start *= 1e3
    start[n - 3 + count] = 0.0
    for _ in range(50):
        scaled = _Unknowns(of, weight, sag, secant)
        solved = newton_root(scaled.residual, start)
        if solved is None:
            raise InputError(
                "no equilibrium of the standing train was found: wheel and rail may not meet "
                "where the wheels stand (check wheelrail.running_circle, rail_centre, gauge and "
                "friction), or the support may not carry it (check support.length and "
                "track_offset)"
            )
        place, vehicle, drift = scaled.unpacked(solved)
        moment = secant * place[hinge_at]
        hinge = loaded_hinge(law, structure.parameters, moment)
        off = abs(hinge.rotation - place[hinge_at])
        if off <= 1e-12 * max(abs(place[hinge_at]), 1e-6):
            break
        secant = moment / hinge.rotation
        start = solved
    place[hinge_at] = hinge.rotation
    return Rest(place, vehicle, drift, hinge)


@dataclass(frozen=True)
class _Unknowns:
    """The equations of rest for one secant stiffness of the hinge, scaled for Newton's method."""

    of: Equilibrium
    weight: Array
    sag: Array
    secant: float

    def unpacked(self, unknown: Array) -> tuple[Array, Array, float]:
        """Displacements of structure and vehicle, and the drift; the wheelset is centred."""
        count = self.of.structure.degrees[0]
        n = len(self.weight)
        vehicle = self.sag + 1e-3 * unknown[count:]
        drift = 1e-4 * unknown[count + n - 3]
        vehicle[n - 3] = (self.of.structure.track_map @ (1e-3 * unknown[:count]))[0]
        return 1e-3 * unknown[:count], vehicle, float(drift)

    def residual(self, unknown: Array) -> Array:
        """What is out of balance, over the train's weight."""
        structure = self.of.structure
        count, _, hinge_at, _ = structure.degrees
        place, vehicle, drift = self.unpacked(unknown)
        sideways = np.array([1.0, 0.0, 0.0])
        on_wheelset, on_node = self.of.forces(
            vehicle[-3:], drift * sideways, structure.track_map @ place
        )
        out = np.empty(len(unknown))
        out[:count] = structure.stiffness @ place - structure.reaction * on_node
        out[hinge_at] += self.secant * place[hinge_at]
        out[count:] = self.of.vehicle.held_by(vehicle) - self.weight
        out[-3:] -= on_wheelset
        return out / self.weight.sum()


def newton_root(residual: Callable[[Array], Array], start: Array) -> Array | None:
    """Root of a smooth system by Newton's method with halved steps; None if it does not converge.

    General root finders take difference steps that are far too long for an indentation of some
    hundredths of a millimetre among displacements of millimetres.
    """
    x = start
    found = residual(x)
    jacobian = None
    for _ in range(60):
        if np.abs(found).max() < 1e-12:
            return x
        if jacobian is not None:  # the last one serves as long as it cuts the residual to a tenth
            near = x - np.linalg.solve(jacobian, found)
            tried = residual(near)
            if np.linalg.norm(tried) < 0.1 * np.linalg.norm(found):
                x, found = near, tried
                continue
        jacobian = _jacobian(residual, x, found)
        try:
            full = -np.linalg.solve(jacobian, found)
        except np.linalg.LinAlgError:
            return None
        share = 1.0
        while share > 1e-4:
            tried = residual(x + share * full)
            if np.linalg.norm(tried) < np.linalg.norm(found):
                break
            share *= 0.5
        else:
            # no descent: roundoff has been reached, or there is nothing to stand on
            return x if np.abs(found).max() < 1e-8 else None
        x, found = x + share * full, tried
    return x if np.abs(found).max() < 1e-8 else None


def _jacobian(residual: Callable[[Array], Array], x: Array, found: Array) -> Array:
    """Derivatives of the residual, which is ``found`` at ``x``, by forward differences."""
    jacobian = np.empty((len(x), len(x)))
    for k in range(len(x)):
        unit = np.zeros(len(x))
        unit[k] = 1e-6
        jacobian[:, k] = (residual(x + unit) - found) / 1e-6
    return jacobian
