"""Wheels on rails: profiles and where they stand, material, friction, restitution, creep law."""

from __future__ import annotations

import os
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from railquake.errors import InputError
from railquake.inputs.layers import FromPreset
from railquake.inputs.marks import AsText, File, KnownLaw, Label, OneOf
from railquake.inputs.model import Flag, InputModel, Name, Text, inconsistent
from railquake.inputs.toml import is_path
from railquake.inputs.units import (
    NonNegativeNumber,
    Number,
    PositiveAngle,
    PositiveLength,
    PositiveNumber,
    PositivePressure,
    PositiveSpeed,
)
from railquake.laws import CREEP_LAWS, RESTITUTION_LAWS

if TYPE_CHECKING:
    from railquake.inputs.profile import Profile

LEAST_LEAN = 0.0125
"""Of a rail's head away from the track's middle that is spoken of: half of the usual 1:40 [rad]."""

ProfilePoint = tuple[Number, Number]


class LineSegment(InputModel):
    """A straight piece of a profile; (y, z) in the profile's unit."""

    kind: Literal["line"]
    start: ProfilePoint
    end: ProfilePoint


class ArcSegment(InputModel):
    """A circular piece of a profile; (y, z) in the profile's unit."""

    kind: Literal["arc"]
    start: ProfilePoint
    end: ProfilePoint
    centre: ProfilePoint
    radius: PositiveNumber
    concave: Annotated[Flag, Field(description="Whether the body is hollow there")] = False


class PolynomialSegment(InputModel):
    """A piece z = c0 + c1 y + c2 y^2 + ... of a profile, in the profile's unit."""

    kind: Literal["polynomial"]
    coefficients: Annotated[tuple[Number, ...], Field(min_length=1)]
    y_start: Number
    y_end: Number


ProfileSegment = Annotated[
    LineSegment | ArcSegment | PolynomialSegment, Field(discriminator="kind")
]


class ProfileSpec(InputModel):
    """Where a profile comes from: a built-in name, a file, or segments drawn here.

    In a case file a text stands for the first two: ``wheel = "s1002"``, ``rail = "my.prr"``.
    """

    builtin: Annotated[Name | None, Field(description="A profile defined by a standard")] = None
    file: Annotated[Name | None, File(), Field(description="A .prw, .prr or CSV file")] = None
    segments: Annotated[
        tuple[ProfileSegment, ...], Field(description="Lines, arcs, polynomials, end to end")
    ] = ()
    unit: Annotated[
        Literal["m", "cm", "mm", "in", "inch", "ft"], Field(description="Unit of the segments")
    ] = "m"
    mirror: Annotated[
        Flag, Field(description="The segments draw one half, from the axis of symmetry")
    ] = False

    @model_validator(mode="after")
    def _has_one_origin(self) -> ProfileSpec:
        given = (self.builtin is not None) + (self.file is not None) + bool(self.segments)
        if given != 1:
            raise inconsistent(
                "give one of builtin, file and segments, found "
                + ("none of them" if given == 0 else "more than one")
            )
        return self

    def _as_written(self, data: dict[str, Any]) -> dict[str, Any]:
        """Turn the values into what a case file has: of a name or a file only that."""
        kept = data if self.segments else ("builtin", "file")
        return super()._as_written({key: value for key, value in data.items() if key in kept})

    def profile(self, kind: Literal["wheel", "rail"], name: str) -> Profile:
        """Make the profile.

        Parameters
        ----------
        kind : {"wheel", "rail"}
            What it is a section of.
        name : str
            What to call it where it is drawn from segments.

        Returns
        -------
        Profile

        Raises
        ------
        InputError
            If there is no such built-in profile or file, it is of the other kind, or its
            pieces do not make a profile.
        """
        from railquake.inputs import profile as profiles

        if self.builtin is not None:
            made = profiles.builtin_profile(self.builtin)
        elif self.file is not None:
            made = profiles.read_profile(self.file, kind)
        else:
            rows = [segment.model_dump() for segment in self.segments]
            segments = profiles.segments_from_table(rows, self.unit, self.mirror)
            made = profiles.profile_from_segments(kind, name, segments)
        if made.kind != kind:
            raise InputError(f'profile "{made.name}" is a {made.kind}, where a {kind} is needed')
        return made


def spec_from_text(text: str) -> dict[str, str]:
    """Tell the name of a built-in profile from the path of a file.

    Parameters
    ----------
    text : str
        ``"s1002"`` or ``"wheels/mine.prw"``; a path has a folder or an ending.
    """
    return {"file": text} if is_path(text) else {"builtin": text}


class WheelRail(FromPreset):
    """A pair of wheels on a pair of rails.

    Profiles are those of the right-hand wheel and rail, y outward; the left-hand ones are their
    mirror images.
    """

    section: ClassVar[str] = "wheelrail"

    name: Annotated[Name, Label(), Field(description="What to call the pair")]
    summary: Annotated[Text, Label(), Field(description="One line for lists")] = ""
    source: Annotated[Text, Label(), Field(description="Where the values come from")] = ""
    note: Annotated[Text, Label(), Field(description="How far the values can be trusted")] = ""
    wheel: Annotated[
        ProfileSpec, AsText(spec_from_text), Field(description="Wheel: name, file or segments")
    ]
    rail: Annotated[
        ProfileSpec, AsText(spec_from_text), Field(description="Rail: name, file or segments")
    ]
    running_circle: Annotated[
        PositiveLength, Field(description="Running circles from the wheelset's centre [m]")
    ]
    rail_centre: Annotated[
        PositiveLength | None,
        OneOf("gauge"),
        Field(description="Origins of the rail profiles from the track's centre [m]"),
    ] = None
    gauge: Annotated[
        PositiveLength | None,
        OneOf("gauge"),
        Field(description="Between the gauge faces; gives rail_centre from the profile [m]"),
    ] = None
    gauge_height: Annotated[
        PositiveLength, Field(description="How far below the crown the gauge is measured [m]")
    ] = 0.014
    rolling_radius: Annotated[PositiveLength, Field(description="At the running circle [m]")]
    youngs_modulus: Annotated[PositivePressure, Field(description="Of wheel and rail [Pa]")]
    poisson_ratio: Annotated[NonNegativeNumber, Field(lt=0.5, description="Of both [1]")]
    friction: Annotated[NonNegativeNumber, Field(le=2.0, description="Coefficient mu [1]")]
    restitution: Annotated[
        NonNegativeNumber, Field(le=1.0, description="Coefficient c_r of the normal law [1]")
    ]
    restitution_law: Annotated[
        str,
        KnownLaw(RESTITUTION_LAWS),
        Field(
            description="calibrated: a free impact rebounds at exactly the coefficient; "
            "constant-hysteresis: without memory"
        ),
    ] = "hunt-crossley"
    onset_rate_bound: Annotated[
        PositiveSpeed,
        Field(description="Least approach rate at an onset, for laws that remember it [m/s]"),
    ] = 0.1
    speed_bound: Annotated[
        PositiveSpeed, Field(description="Least train speed in the creepages [m/s]")
    ] = 1.0
    creep_law: Annotated[
        str,
        KnownLaw(CREEP_LAWS),
        Field(description="How Kalker's linear forces saturate (she: Shen-Hedrick-Elkins)"),
    ] = "she"
    flange_creep_law: Annotated[
        str,
        KnownLaw(CREEP_LAWS),
        Field(description="The same on flanges, whose spin is large (fastsim: a law for that)"),
    ] = "fastsim"
    reference_roll: Annotated[
        PositiveAngle, Field(description="Relative roll at which slide-off begins [rad]")
    ]
    slide_off_limit: Annotated[
        PositiveLength,
        Field(lt=0.13, description="Displacement of a bearing wheel that counts as derailed [m]"),
    ] = 0.070

    @model_validator(mode="after")
    def _fits_together(self) -> WheelRail:
        if (self.gauge is None) == (self.rail_centre is None):
            found = "found neither" if self.gauge is None else "found both"
            raise inconsistent(f"give either gauge or rail_centre, {found}")
        if self.restitution_law == "calibrated" and self.restitution == 0.0:
            raise inconsistent(
                'must be above 0 with restitution_law = "calibrated" (no damping makes an impact '
                "stick), found 0",
                "restitution",
            )
        return self

    def wheel_profile(self) -> Profile:
        """Make the right-hand wheel's profile, y = 0 on the running circle.

        Returns
        -------
        Profile

        Raises
        ------
        InputError
            See :meth:`ProfileSpec.profile`.
        """
        return self.wheel.profile("wheel", f"{self.name} wheel")

    def rail_profile(self) -> Profile:
        """Make the right-hand rail's profile.

        Returns
        -------
        Profile

        Raises
        ------
        InputError
            See :meth:`ProfileSpec.profile`.
        """
        return self.rail.profile("rail", f"{self.name} rail")

    def doubts(self) -> tuple[str, ...]:
        """Sentences on what looks wrong with the profiles, though it can be computed with.

        Raises
        ------
        InputError
            If there is no such rail.
        """
        lean = _outward_lean(self.rail, _stamp(self.rail.file))
        if lean < LEAST_LEAN:
            return ()
        which = self.rail.file or f"{self.name} rail"
        return (
            f"the rail {which} leans away from the track's middle by {1e3 * lean:.3g} mrad, and "
            "rails are canted towards it: y must point outward from the track (mirror y)",
        )

    def rail_half_distance(self, rail: Profile | None = None) -> float:
        """Distance of the rail profile's origin from the track's centre [m].

        Parameters
        ----------
        rail : Profile, optional
            The profile, if it was made already.

        Returns
        -------
        float
            `rail_centre`, or what gives the gauge at `gauge_height` below the crown.

        Raises
        ------
        InputError
            If the rail's gauge face does not reach that height.
        """
        if self.rail_centre is not None:
            return self.rail_centre
        from railquake.inputs.profile import face_offset

        assert self.gauge is not None  # one of the two is there, by the validator above
        rail = self.rail_profile() if rail is None else rail
        return 0.5 * self.gauge - face_offset(rail, self.gauge_height)


def _stamp(path: str | None) -> tuple[int, int]:
    """When a file was changed, and its size: what is remembered of it holds as long as these."""
    try:
        found = os.stat(path or "")
    except (OSError, ValueError):
        return 0, 0  # reading it says what is wrong
    return found.st_mtime_ns, found.st_size


@lru_cache(maxsize=64)
def _outward_lean(rail: ProfileSpec, stamp: tuple[int, int]) -> float:
    from railquake.inputs.profile import outward_lean

    return outward_lean(rail.profile("rail", "rail"))
