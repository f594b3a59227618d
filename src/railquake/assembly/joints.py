"""The joints of a car with finite rotations: which there are, and their constants by rows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from railquake.march.compiler import PYTHON, bind
from railquake.march.order import kernel_order
from railquake.march.rows import UNJOINED, Joined, layout_of
from railquake.march.slots import joining
from railquake.march.step import find_free_accelerations, find_vehicle_energy
from railquake.physics.hinge import HINGE_LAWS
from railquake.physics.joint import JointSpring, Sides, Tie

if TYPE_CHECKING:
    from railquake.inputs.vehicle import AntiRollBar, Stop, Vehicle
    from railquake.march.rows import Layout

__all__ = ["NO_JOINTS", "Joints", "Suspension", "fill_joints", "joints_of"]

Array = np.ndarray[Any, np.dtype[np.float64]]

STEP = 1e-5  # m, rad and per s: of the differences that give tangents
NO_SPRING = JointSpring(*[0.0] * len(JointSpring._fields))


class _Place(NamedTuple):
    """Two bodies by their numbers, and where on the section a joint is attached to them."""

    upper: int
    lower: int
    y: float  # m
    upper_height: float  # above the rails, m
    lower_height: float


@dataclass(frozen=True)
class Joints:
    """All joints of a car.

    Attributes
    ----------
    joined : Joined
    ties : tuple of Tie
        Of each element.
    gaps : tuple of (float, float)
    springs : tuple of JointSpring
    sides : tuple of Sides
        Of each stop.
    ramps : tuple of array, shape (n, 2)
        Travel, m, and change of stiffness, N/m, of each stop.
    ends : tuple of float
        Travel at which each stop's table ends, m; infinite without an end.
    stops : tuple of str
        Name of each stop.
    knees : tuple of (float, float, float)
    """

    joined: Joined
    ties: tuple[Tie, ...]
    gaps: tuple[tuple[float, float], ...]
    springs: tuple[JointSpring, ...]
    sides: tuple[Sides, ...]
    ramps: tuple[Array, ...]
    ends: tuple[float, ...]
    stops: tuple[str, ...]
    knees: tuple[tuple[float, float, float], ...]

    def engaged(self) -> Joints:
        """The same with a spring for every stop, as stiff as that becomes, borne all the time."""
        steep = []
        stops = [element for element in self.joined.elements if element[0].endswith("stop")]
        for (kind, _, _), side, ramp in zip(stops, self.sides, self.ramps, strict=True):
            lateral = kind.startswith("lateral")
            stiffest = float(ramp[:, 1].cumsum().max())
            steep.append(
                NO_SPRING._replace(
                    **{"ky" if lateral else "kz": stiffest, "cy" if lateral else "cz": side.damping}
                )
            )
        elements = tuple(
            ("spring", upper, lower) if kind.endswith("stop") else (kind, upper, lower)
            for kind, upper, lower in self.joined.elements
        )
        return replace(
            self, joined=Joined(elements, 0), springs=(*self.springs, *steep), sides=(), ramps=(),
            ends=(), stops=(),
        )  # fmt: skip


NO_JOINTS = Joints(UNJOINED, (), (), (), (), (), (), (), ())


def joints_of(vehicle: Vehicle, bodies: list[Any], sag: Array) -> Joints:
    """Joints of a vehicle.

    Springs and dashpots between the same points are one joint.

    Parameters
    ----------
    vehicle : Vehicle
    bodies : list of Body
        In the order of the degrees of freedom.
    sag : array, shape (3 * bodies,)
        Displacements under gravity of a linear car, by which its joints would have to be shortened
        so that it stands as drawn: what they bear at rest.
    """
    number = {body.name: k for k, body in enumerate(bodies)}
    springs = _springs(vehicle, number)
    borne = {place: _loaded(spring, place, bodies, sag) for place, spring in springs.items()}
    elements = [("spring", place) for place in borne]
    sides, ramps, ends, names, knees = [], [], [], [], []
    for stop in vehicle.stops:
        for place, sign in _places(stop, number):
            elements.append((f"{stop.direction} stop", place))
            sides.append(_sides(stop, sign))
            ramps.append(_ramps(stop))
            ends.append(stop.longest or np.inf)
            names.append(stop.name)
    for dashpot in vehicle.dashpots:
        if dashpot.knee is not None:
            for place, _ in _places(dashpot, number):
                elements.append((f"{dashpot.direction} knee", place))
                knees.append((dashpot.knee, dashpot.damping, dashpot.damping_beyond))
    heights = [body.height for body in bodies]
    # z points down: a point above a body's centre of gravity has a negative z
    ties = tuple(
        Tie(
            place.y, heights[place.upper] - place.upper_height,
            place.y, heights[place.lower] - place.lower_height,
        )
        for _, place in elements
    )  # fmt: skip
    joined = Joined(
        tuple((kind, place.upper, place.lower) for kind, place in elements),
        max((len(ramp) for ramp in ramps), default=0),
    )
    gaps = tuple((0.0, place.lower_height - place.upper_height) for _, place in elements)
    return Joints(
        joined, ties, gaps, tuple(borne.values()), tuple(sides), tuple(ramps), tuple(ends),
        tuple(names), tuple(knees),
    )  # fmt: skip


class Suspension:
    """The joints at work: the stages of the march, for one vehicle that is held somewhere.

    Parameters
    ----------
    mass : array, shape (n,)
        Of the vehicle.
    joints : Joints
    """

    def __init__(self, mass: Array, joints: Joints) -> None:
        bodies = len(mass) // 3
        self._layout = layout_of(HINGE_LAWS["elastic"], bodies, joined=joints.joined)
        self._order = kernel_order(len(mass))
        self._mass = mass
        self._state = np.zeros((self._layout.size.STATE_ROWS, 1))
        constants = np.zeros(self._layout.size.CONSTANT_ROWS)
        constants[self._layout.constant_blocks["INVERSE_MASS"]] = 1.0 / mass[self._order]
        fill_joints(constants, joints, self._layout)
        self._constants = constants[:, None]
        laws = joining(joints.joined)
        self._accelerate = bind(find_free_accelerations, PYTHON, laws, self._layout).call
        self._energy = bind(find_vehicle_energy, PYTHON, laws, self._layout).call

    def pulls(self, x: Array, v: Array | None = None) -> Array:
        """Generalised forces, shape (n,), on bodies displaced by ``x`` and moving with ``v``."""
        self._place(x, v)
        self._accelerate(self._state, self._constants)
        found = np.empty(len(x))
        found[self._order] = self._state[self._layout.state_blocks["VEHICLE_A"], 0]
        return found * self._mass

    def energy(self, x: Array) -> float:
        """Stored in springs and stops of bodies displaced by ``x``, J."""
        self._place(x, None)
        return float(self._energy(self._state, self._constants))

    def tangents(self) -> tuple[Array, Array]:
        """Stiffness and damping about rest, gravity in the stiffness, each of shape (n, n)."""
        n = len(self._mass)
        stiffness, damping = np.empty((2, n, n))
        rest = np.zeros(n)
        for k, unit in enumerate(STEP * np.eye(n)):
            stiffness[:, k] = (self.pulls(-unit) - self.pulls(unit)) / (2.0 * STEP)
            damping[:, k] = (self.pulls(rest, -unit) - self.pulls(rest, unit)) / (2.0 * STEP)
        return 0.5 * (stiffness + stiffness.T), 0.5 * (damping + damping.T)

    def _place(self, x: Array, v: Array | None) -> None:
        blocks = self._layout.state_blocks
        self._state[blocks["VEHICLE_X"], 0] = x[self._order]
        self._state[blocks["VEHICLE_V"], 0] = 0.0 if v is None else v[self._order]


def _places(element: Any, number: dict[str, int]) -> Iterator[tuple[_Place, float]]:
    """Where an element stands; and the side, 1 right and -1 left."""
    upper, lower = (number[name] for name in element.bodies)
    for side in (1.0, -1.0) if element.pair else (1.0,):
        yield _Place(upper, lower, side * element.lateral, *element.end_heights), side


def _springs(vehicle: Vehicle, number: dict[str, int]) -> dict[_Place, JointSpring]:
    """Springs, dashpots without a knee and anti-roll bars, added up where they share a place."""
    found: dict[_Place, JointSpring] = {}

    def add(place: _Place, field: str, value: float) -> None:
        there = found.get(place, NO_SPRING)
        found[place] = there._replace(**{field: getattr(there, field) + value})

    for spring in vehicle.springs:
        for place, _ in _places(spring, number):
            add(place, "ky" if spring.direction == "lateral" else "kz", spring.stiffness)
    for dashpot in vehicle.dashpots:
        if dashpot.knee is None:
            for place, _ in _places(dashpot, number):
                add(place, "cy" if dashpot.direction == "lateral" else "cz", dashpot.damping)
    for bar in vehicle.anti_roll_bars:
        add(_place_of_bar(bar, number, found, vehicle), "kr", bar.stiffness)
    return found


def _place_of_bar(
    bar: AntiRollBar, number: dict[str, int], found: dict[_Place, JointSpring], vehicle: Vehicle
) -> _Place:
    """A bar is felt anywhere between its bodies: with a spring that is there, if there is one."""
    upper, lower = (number[name] for name in bar.bodies)
    for place in found:
        if {place.upper, place.lower} == {upper, lower}:
            return place
    height = next(body.height for body in vehicle.bodies if body.name == bar.bodies[1])
    return _Place(upper, lower, 0.0, height, height)


def _loaded(spring: JointSpring, place: _Place, bodies: list[Any], sag: Array) -> JointSpring:
    """With what it bears at rest."""
    upper, lower = (sag[3 * k : 3 * k + 3] for k in (place.upper, place.lower))
    upper_z = bodies[place.upper].height - place.upper_height
    lower_z = bodies[place.lower].height - place.lower_height
    y = upper[0] - upper_z * upper[2] - (lower[0] - lower_z * lower[2])
    z = upper[1] + place.y * upper[2] - (lower[1] + place.y * lower[2])
    return spring._replace(ny=spring.ky * y, nz=spring.kz * z, nr=spring.kr * (upper[2] - lower[2]))


def _sides(stop: Stop, sign: float) -> Sides:
    if not stop.one_sided:
        return Sides(1.0, 1.0, stop.damping)
    right = sign > 0.0 or stop.direction == "vertical"
    return Sides(float(right), float(not right), stop.damping)


def _ramps(stop: Stop) -> Array:
    """Travel at which the stiffness changes, and by how much."""
    travel, force = (np.array(values) for values in stop.force_over_travel)
    slopes = np.diff(force) / np.diff(travel)
    changes = np.diff(slopes, prepend=0.0)
    kept = changes != 0.0
    return np.column_stack([travel[:-1][kept], changes[kept]])


def fill_joints(q: Array, joints: Joints, layout: Layout) -> None:
    """Their constants."""
    blocks, ramps = layout.constant_blocks, joints.joined.ramps
    q[blocks["TIES"]] = np.array(joints.ties).ravel()
    q[blocks["GAPS"]] = np.array(joints.gaps).ravel()
    q[blocks["SPRINGS"]] = np.array(joints.springs).ravel()
    q[blocks["STOP_SIDES"]] = np.array(joints.sides).ravel()
    q[blocks["STOP_END"]] = joints.ends
    q[blocks["KNEES"]] = np.array(joints.knees).ravel()
    padded = np.zeros((len(joints.ramps), ramps, 2))
    for number, ramp in enumerate(joints.ramps):
        padded[number, : len(ramp)] = ramp
    q[blocks["RAMP_TRAVEL"]] = padded[:, :, 0].ravel()
    q[blocks["RAMP_SLOPE"]] = padded[:, :, 1].ravel()
