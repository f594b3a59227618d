"""A vehicle's cross-section: rigid bodies joined by springs and dashpots between their points."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Annotated, ClassVar, Literal

from pydantic import Field, model_validator

from railquake.inputs.layers import FromPreset
from railquake.inputs.marks import ByName, Label, OneOf
from railquake.inputs.model import (
    Flag,
    InputModel,
    Integer,
    Name,
    Text,
    inconsistent,
)
from railquake.inputs.units import (
    Length,
    NonNegativeDamping,
    NonNegativeForce,
    NonNegativeLength,
    NonNegativeSpeed,
    PositiveLength,
    PositiveMass,
    PositiveNumber,
    PositiveRollInertia,
    PositiveRotationalStiffness,
    PositiveSpeed,
    PositiveStiffness,
)
from railquake.messages import did_you_mean

Direction = Literal["lateral", "vertical"]
Kinematics = Literal["finite", "linear"]


class Body(InputModel):
    """A rigid body with three freedoms: lateral, vertical and roll about its centre of gravity."""

    name: Annotated[Name, Field(description="Unique among the vehicle's bodies")]
    mass: Annotated[PositiveMass, Field(description="Mass [kg]")]
    roll_inertia: Annotated[
        PositiveRollInertia, Field(description="Inertia about the longitudinal axis [kg m2]")
    ]
    height: Annotated[
        PositiveLength, Field(description="Height of the centre of gravity above the rails [m]")
    ]


class _Element(InputModel):
    """What springs, dashpots and stops have in common: two points, a direction between them."""

    name: Annotated[Name, Field(description="Unique among the vehicle's elements of its kind")]
    bodies: Annotated[tuple[Name, Name], Field(description="The two bodies, by name")]
    direction: Annotated[Direction, Field(description="The direction it acts in")]
    lateral: Annotated[
        Length, Field(description="y of both attachments, right of the vehicle's centre [m]")
    ]
    height: Annotated[
        Length | None,
        OneOf("height"),
        Field(description="Height of both attachments above the rails [m]"),
    ] = None
    heights: Annotated[
        tuple[Length, Length] | None,
        OneOf("height"),
        Field(description="Heights of the two attachments, where they differ [m]"),
    ] = None
    pair: Annotated[
        Flag, Field(description="Whether an equal one stands at -lateral; values are per side")
    ] = True

    @model_validator(mode="after")
    def _joins_two_points(self) -> _Element:
        _refuse_one_body(self.bodies)
        if (self.height is None) == (self.heights is None):
            found = "found neither" if self.height is None else "found both"
            raise inconsistent(
                f"give either height (of both ends) or heights = [one, other], {found}"
            )
        return self

    @property
    def end_heights(self) -> tuple[float, float]:
        """Heights of the attachments on the first and on the second body above the rails [m]."""
        if self.heights is not None:
            return self.heights
        assert self.height is not None  # one of the two is there, by the validator above
        return self.height, self.height


class Spring(_Element):
    """A linear spring between a point of one body and a point of another."""

    stiffness: Annotated[PositiveStiffness, Field(description="Stiffness per side [N/m]")]


class Dashpot(_Element):
    """A dashpot between a point of one body and a point of another."""

    damping: Annotated[
        NonNegativeDamping, Field(description="Damping per side, up to the knee [N s/m]")
    ]
    knee: Annotated[
        PositiveSpeed | None, Field(description="Rate beyond which another damping holds [m/s]")
    ] = None
    damping_beyond: Annotated[
        NonNegativeDamping, Field(description="Damping per side beyond the knee [N s/m]")
    ] = 0.0

    def without_effect(self) -> set[str]:
        """Fields that do not tell two dashpots apart: those of a knee where there is none."""
        none = {"knee", "damping_beyond"} if self.knee is None else set()
        return super().without_effect() | none

    @model_validator(mode="after")
    def _has_a_knee(self) -> Dashpot:
        if self.knee is None and self.damping_beyond > 0.0:
            raise inconsistent("needs a knee: from which rate on?", "damping_beyond")
        return self


class Stop(_Element):
    """A bump stop: a force over the travel of one body against another, no force in between.

    Either a gap and the stiffness beyond it, or a table.  Where the table ends, its last slope
    goes on.
    """

    gap: Annotated[
        NonNegativeLength | None,
        OneOf("travel"),
        Field(description="Free travel to either side [m]"),
    ] = None
    stiffness: Annotated[
        PositiveStiffness | None, Field(description="Stiffness beyond the gap, per side [N/m]")
    ] = None
    travel: Annotated[
        tuple[NonNegativeLength, ...] | None,
        OneOf("travel"),
        Field(description="Table: travel, from zero on [m]"),
    ] = None
    force: Annotated[
        tuple[NonNegativeForce, ...] | None,
        Field(description="Table: force at each travel, per side [N]"),
    ] = None
    travel_factor: Annotated[
        PositiveNumber, Field(description="Times all travels, gap too: how much they matter")
    ] = 1.0
    force_factor: Annotated[
        PositiveNumber, Field(description="Times all forces, stiffness too: how much they matter")
    ] = 1.0
    damping: Annotated[
        NonNegativeDamping, Field(description="Damping per side while it bears [N s/m]")
    ] = 0.0
    one_sided: Annotated[
        Flag,
        Field(
            description="Whether it bears only where the first body moves right or down against "
            "the second; an equal one at -lateral bears left or down"
        ),
    ] = False

    @model_validator(mode="after")
    def _has_a_table(self) -> Stop:
        if (self.gap is None) == (self.travel is None):
            found = "neither" if self.gap is None else "both"
            raise inconsistent(f"give either gap and stiffness, or travel and force; found {found}")
        if self.gap is not None and self.stiffness is None:
            raise inconsistent("is needed beside gap", "stiffness")
        if self.travel is not None:
            _refuse_bad_table(self.travel, self.force or ())
        return self

    @property
    def force_over_travel(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Travel [m] and force [N]; beyond the last point its last slope goes on."""
        travel, force = self.travel, self.force
        if self.gap is not None:
            assert self.stiffness is not None  # by the validator above
            start = (0.0,) if self.gap > 0.0 else ()
            travel = (*start, self.gap, self.gap + 1.0)
            force = (*start, 0.0, self.stiffness)
        assert travel is not None and force is not None  # by the validator above
        return (
            tuple(self.travel_factor * value for value in travel),
            tuple(self.force_factor * value for value in force),
        )

    @property
    def longest(self) -> float | None:
        """Travel at which the table ends [m]; a gap with a stiffness has no end."""
        return None if self.travel is None else self.travel_factor * self.travel[-1]


def _refuse_bad_table(travel: tuple[float, ...], force: tuple[float, ...]) -> None:
    """Refuse a table of a stop that falls, or does not begin at zero."""
    if len(force) != len(travel):
        raise inconsistent(
            f"needs as many values as travel ({len(travel)}), found {len(force)}", "force"
        )
    if len(travel) < 2:
        raise inconsistent("needs two values or more", "travel")
    if travel[0] != 0.0 or force[0] != 0.0:
        raise inconsistent(
            f"table must begin with no force at no travel, found {force[0]:g} N at {travel[0]:g} m",
            "force",
        )
    for before, after in pairwise(travel):
        if after <= before:
            raise inconsistent(f"must rise, found {before:g} m, then {after:g} m", "travel")
    for (before, after), at in zip(pairwise(force), travel[1:], strict=True):
        if after < before:
            raise inconsistent(
                f"must not fall: {before:g} N, then {after:g} N at {at:g} m", "force"
            )
    if force[-1] == force[-2]:
        raise inconsistent("must rise at its end, since its last slope goes on", "force")


class AntiRollBar(InputModel):
    """A torsion spring between two bodies, which only their relative roll twists."""

    name: Annotated[Name, Field(description="Unique among the vehicle's anti-roll bars")]
    bodies: Annotated[tuple[Name, Name], Field(description="The two bodies, by name")]
    stiffness: Annotated[
        PositiveRotationalStiffness, Field(description="Stiffness, all bars together [N m/rad]")
    ]

    @model_validator(mode="after")
    def _joins_two_bodies(self) -> AntiRollBar:
        _refuse_one_body(self.bodies)
        return self


class Vehicle(FromPreset):
    """A vehicle: any bodies, and the springs, dashpots, stops and anti-roll bars between them.

    The whole vehicle is lumped on one cross-section; the body called `wheelset` carries `axles`
    wheels on each side.  In a case file the bodies, springs and dashpots are tables with the
    name as key (``[vehicle.bodies.car]``), so that one value of a preset can be overridden.

    Raises
    ------
    InputError
        If names repeat or are unknown, or a body is not held by springs in both directions.
    """

    section: ClassVar[str] = "vehicle"

    name: Annotated[Name, Label(), Field(description="What to call the vehicle")]
    summary: Annotated[Text, Label(), Field(description="One line for lists")] = ""
    source: Annotated[Text, Label(), Field(description="Where the values come from")] = ""
    note: Annotated[Text, Label(), Field(description="How far the values can be trusted")] = ""
    bodies: Annotated[tuple[Body, ...], ByName(), Field(min_length=1, description="Rigid bodies")]
    springs: Annotated[
        tuple[Spring, ...], ByName(), Field(description="Springs between bodies")
    ] = ()
    dashpots: Annotated[
        tuple[Dashpot, ...], ByName(), Field(description="Dashpots between bodies")
    ] = ()
    stops: Annotated[tuple[Stop, ...], ByName(), Field(description="Bump stops")] = ()
    anti_roll_bars: Annotated[
        tuple[AntiRollBar, ...], ByName(), Field(description="Anti-roll bars")
    ] = ()
    kinematics: Annotated[
        Kinematics,
        Field(
            description="Finite rotations with gravity and stops; or linear about the undeformed "
            "position without gravity's moments, as the paper's car"
        ),
    ] = "finite"
    wheelset: Annotated[Name, Field(description="The body that carries the wheels")] = "wheelset"
    axles: Annotated[
        Integer, Field(ge=1, le=1000, description="Wheels on each side that share the load")
    ]
    speed: Annotated[NonNegativeSpeed, Field(description="Speed along the track [m/s]")]
    axle_inertia: Annotated[
        PositiveRollInertia | None,
        Field(description="Of one wheelset about its axle; else 0.3 m r^2, an estimate [kg m2]"),
    ] = None

    @model_validator(mode="after")
    def _assembles(self) -> Vehicle:
        names = [body.name for body in self.bodies]
        _refuse_repeats("bodies", names)
        _refuse_repeats("springs", [spring.name for spring in self.springs])
        _refuse_repeats("dashpots", [dashpot.name for dashpot in self.dashpots])
        _refuse_repeats("stops", [stop.name for stop in self.stops])
        _refuse_repeats("anti_roll_bars", [bar.name for bar in self.anti_roll_bars])
        if self.wheelset not in names:
            advice = did_you_mean(self.wheelset, names)
            raise inconsistent(f'no body is called "{self.wheelset}"; {advice}', "wheelset")
        for key, group in self._elements():
            for element in group:
                for name in element.bodies:
                    if name not in names:
                        raise inconsistent(
                            f'no body is called "{name}"; {did_you_mean(name, names)}',
                            f"{key}.{element.name}.bodies",
                        )
        for direction in ("lateral", "vertical"):
            held = _connected(
                self.wheelset, [s.bodies for s in self.springs if s.direction == direction]
            )
            loose = [name for name in names if name not in held]
            if loose:
                raise inconsistent(
                    f"is not joined to the wheelset by {direction} springs; add one",
                    f"bodies.{loose[0]}",
                )
        return self

    def inertia_about_axle(self, radius: float) -> float:
        """Give `axle_inertia`, or its estimate from the rolling radius [kg m2].

        Parameters
        ----------
        radius : float
            m.

        Returns
        -------
        float
        """
        if self.axle_inertia is not None:
            return self.axle_inertia
        (wheelset,) = (body for body in self.bodies if body.name == self.wheelset)
        return 0.3 * wheelset.mass / self.axles * radius**2

    @model_validator(mode="after")
    def _fits_its_kinematics(self) -> Vehicle:
        if self.kinematics == "linear":
            bent = [dashpot.name for dashpot in self.dashpots if dashpot.knee is not None]
            for key, names in (("stops", [stop.name for stop in self.stops]), ("dashpots", bent)):
                if names:
                    what = "has a knee, which" if key == "dashpots" else "is a stop, which"
                    raise inconsistent(
                        f'{what} no linear car can have; take kinematics = "finite"',
                        f"{key}.{names[0]}",
                    )
            return self
        axle = next(body.height for body in self.bodies if body.name == self.wheelset)
        heaviest = max(self.bodies, key=lambda body: body.mass)
        low = [(f"bodies.{heaviest.name}.height", heaviest.height)]
        for key, group in self._elements():
            low += [
                (f"{key}.{element.name}.height", min(element.end_heights))
                for element in group
                if isinstance(element, _Element)
            ]
        for place, height in low:
            if height < axle - 1e-9:
                raise inconsistent(
                    f"{height:g} m lies below the axle, which is {axle:g} m above the rails; "
                    "heights are measured from the rails upwards",
                    place,
                )
        return self

    def _elements(self) -> tuple[tuple[str, tuple[_Element | AntiRollBar, ...]], ...]:
        """All that joins bodies, by the name of its field."""
        return (
            ("springs", self.springs),
            ("dashpots", self.dashpots),
            ("stops", self.stops),
            ("anti_roll_bars", self.anti_roll_bars),
        )

    def without_effect(self) -> set[str]:
        """Fields that do not tell two vehicles apart.

        Linear ones without stops and bars are what vehicles were before there was a choice: rows
        of older studies stay theirs.
        """
        linear = {"kinematics"} if self.kinematics == "linear" else set()
        none = {key for key in ("stops", "anti_roll_bars") if not getattr(self, key)}
        return super().without_effect() | linear | none

    @property
    def mass(self) -> float:
        """Mass of all bodies together [kg]."""
        return sum(body.mass for body in self.bodies)


def _refuse_one_body(bodies: tuple[str, str]) -> None:
    if bodies[0] == bodies[1]:
        raise inconsistent(f'joins "{bodies[0]}" to itself; name two bodies', "bodies")


def _refuse_repeats(key: str, names: list[str]) -> None:
    for name in names:
        if names.count(name) > 1:
            raise inconsistent(f'the name "{name}" is used twice; names must differ', key)


def _connected(start: str, joints: Iterable[tuple[str, str]]) -> set[str]:
    """All bodies that can be reached from one along the joints."""
    joints = list(joints)
    reached, frontier = {start}, {start}
    while frontier:
        ends = {b for a, b in joints if a in frontier} | {a for a, b in joints if b in frontier}
        frontier = ends - reached
        reached |= frontier
    return reached
