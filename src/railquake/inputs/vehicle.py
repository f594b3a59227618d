"""A vehicle's cross-section: rigid bodies joined by springs and dashpots between their points."""

from __future__ import annotations

from collections.abc import Iterable
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
    NonNegativeSpeed,
    PositiveLength,
    PositiveMass,
    PositiveRollInertia,
    PositiveStiffness,
)
from railquake.messages import did_you_mean

Direction = Literal["lateral", "vertical"]


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
    """What springs and dashpots have in common: two points, and the direction between them."""

    name: Annotated[Name, Field(description="Unique among the vehicle's springs or dashpots")]
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
        if self.bodies[0] == self.bodies[1]:
            raise inconsistent(f'joins "{self.bodies[0]}" to itself; name two bodies', "bodies")
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
    """A linear dashpot between a point of one body and a point of another."""

    damping: Annotated[NonNegativeDamping, Field(description="Damping per side [N s/m]")]


class Vehicle(FromPreset):
    """A vehicle: any bodies, and the springs and dashpots between them.

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
        if self.wheelset not in names:
            advice = did_you_mean(self.wheelset, names)
            raise inconsistent(f'no body is called "{self.wheelset}"; {advice}', "wheelset")
        elements: tuple[tuple[str, tuple[_Element, ...]], ...] = (
            ("springs", self.springs),
            ("dashpots", self.dashpots),
        )
        for key, group in elements:
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

    @property
    def mass(self) -> float:
        """Mass of all bodies together [kg]."""
        return sum(body.mass for body in self.bodies)


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
