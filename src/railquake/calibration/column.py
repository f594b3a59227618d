"""What `railquake calibrate column` is given: a column, its protocol and motions to check with."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from railquake.errors import InputError
from railquake.inputs.layers import with_absolute_paths
from railquake.inputs.marks import Place
from railquake.inputs.model import InputModel, Integer, Name, Text, inconsistent, validated
from railquake.inputs.motion import Motion
from railquake.inputs.support import Pier
from railquake.inputs.toml import read_toml
from railquake.inputs.units import (
    NonNegativeLength,
    PositiveForce,
    PositiveLength,
    PositiveNumber,
    PositivePressure,
    PositiveSecondMomentOfArea,
    Quantity,
)

__all__ = ["Column", "Concrete", "Protocol", "Section", "Steel", "load_column"]

Array = np.ndarray[Any, np.dtype[np.float64]]

Ratio = Annotated[float, Quantity("number", "positive"), Field(lt=1.0)]


class Section(InputModel):
    """An octagonal or circular section with bars on a circle and hoops around them."""

    shape: Annotated[Literal["octagonal", "circular"], Field(description="Outline")]
    diameter: Annotated[PositiveLength, Field(description="Across the flats of an octagon [m]")]
    cover: Annotated[NonNegativeLength, Field(description="To the middle of the hoops [m]")]
    longitudinal_ratio: Annotated[
        Ratio, Field(le=0.15, description="Area of all bars over that of the section")
    ]
    bars: Annotated[Integer, Field(ge=6, le=400, description="Number of bars")] = 32
    transverse_ratio: Annotated[
        Ratio, Field(le=0.1, description="Volume of the hoops over that of the core")
    ]
    confinement_effectiveness: Annotated[
        Ratio, Field(description="Confined share of the core; 0.95 for circular hoops")
    ] = 0.95

    @model_validator(mode="after")
    def _has_a_core(self) -> Section:
        if self.cover > 0.25 * self.diameter:
            raise inconsistent(
                f"must be at most a quarter of the diameter of {self.diameter:g} m, found "
                f"{self.cover:g} m",
                "cover",
            )
        return self


class Concrete(InputModel):
    """Concrete in compression; it bears no tension."""

    strength: Annotated[
        PositivePressure,
        Field(ge=5e6, le=150e6, description="Cylinder strength f'c, expected [Pa]"),
    ]
    peak_strain: Annotated[Ratio, Field(description="Strain at f'c")] = 0.002
    spalling_strain: Annotated[Ratio, Field(description="Strain where the cover is lost")] = 0.006
    youngs_modulus: Annotated[
        PositivePressure | None, Field(description="By default 4700 sqrt(f'c), in MPa [Pa]")
    ] = None

    @model_validator(mode="after")
    def _descends(self) -> Concrete:
        if self.spalling_strain <= self.peak_strain:
            raise inconsistent(
                f"must be above peak_strain = {self.peak_strain:g}, found {self.spalling_strain:g}",
                "spalling_strain",
            )
        return self


class Steel(InputModel):
    """Bars and hoops."""

    yield_strength: Annotated[
        PositivePressure, Field(ge=100e6, le=1.5e9, description="Of the bars, expected [Pa]")
    ]
    hoop_strength: Annotated[
        PositivePressure, Field(ge=100e6, le=1.5e9, description="Yield strength of the hoops [Pa]")
    ]
    youngs_modulus: Annotated[PositivePressure, Field(description="[Pa]")] = 200e9
    hardening: Annotated[Ratio, Field(description="Slope after yield over Young's modulus")] = 0.01
    hoop_ultimate_strain: Annotated[Ratio, Field(description="Strain at largest stress")] = 0.12


class Protocol(InputModel):
    """Cycles of drift, each amplitude some times: by default growing, and then smaller again."""

    drifts: Annotated[
        tuple[PositiveNumber, ...],
        Field(min_length=1, max_length=40, description="Amplitudes over the column's length"),
    ] = (0.0025, 0.005, 0.0075, 0.01, 0.015, 0.02, 0.025, 0.03, 0.035, 0.02, 0.01, 0.005)
    cycles: Annotated[Integer, Field(ge=1, le=10, description="At each amplitude")] = 2
    increment: Annotated[
        Ratio, Field(ge=1e-5, le=1e-2, description="Drift of a step of the protocol")
    ] = 4e-4

    @model_validator(mode="after")
    def _is_within_reach(self) -> Protocol:
        if max(self.drifts) > 0.15:
            raise inconsistent(
                f"must be at most 0.15, found {max(self.drifts):g}; drifts are ratios, so that 1 % "
                "is 0.01",
                "drifts",
            )
        if max(self.drifts) < 4.0 * self.increment:
            raise inconsistent("must be less than a quarter of the largest drift", "increment")
        return self

    def path(self) -> Array:
        """Drift at each step, the virgin state at 0 left out."""
        turns = [0.0]
        for drift in self.drifts:
            turns += [drift, -drift] * self.cycles
        turns.append(0.0)
        pieces = []
        for a, b in pairwise(turns):
            count = max(2, round(abs(b - a) / self.increment))
            pieces.append(np.linspace(a, b, count + 1)[1:])
        path: Array = np.concatenate(pieces)
        return path


class Column(InputModel):
    """A reinforced-concrete cantilever, the pier it stands for and what is done to it.

    Raises
    ------
    InputError
        Naming the field, what was found and what to write.
    """

    name: Annotated[Name, Field(description="What to call the column")]
    source: Annotated[Text, Field(description="Where the values come from")] = ""
    support: Annotated[
        Name, Field(description="Pier whose column, mass and damping are kept: preset or file")
    ] = "bart-berkeley"
    length: Annotated[
        PositiveLength | None, Field(description="By default that of the support [m]")
    ] = None
    axial_load: Annotated[
        PositiveForce | None, Field(description="Compression; by default the weight [N]")
    ] = None
    axial_ratio: Annotated[
        PositiveNumber | None, Field(description="Instead: axial load over f'c Ag")
    ] = None
    youngs_modulus: Annotated[
        PositivePressure | None,
        Field(description="Of the pier's elastic column; by default the concrete's [Pa]"),
    ] = None
    second_moment_of_area: Annotated[
        PositiveSecondMomentOfArea | None,
        Field(description="Of the elastic column; by default the fibre column's, cracked [m4]"),
    ] = None
    plastic_length: Annotated[
        PositiveLength | None,
        Field(description="By default 0.08 L + 0.022 fy d_b (fy in MPa) [m]"),
    ] = None
    section: Section
    concrete: Concrete
    steel: Steel
    protocol: Protocol = Protocol()
    motions: Annotated[
        tuple[Motion, ...], Field(max_length=20, description="To check the fit with")
    ] = ()

    @model_validator(mode="after")
    def _has_one_axial_load(self) -> Column:
        if self.axial_load is not None and self.axial_ratio is not None:
            raise inconsistent("give either axial_load or axial_ratio, found both")
        return self

    def pier(self) -> Pier:
        """The support, at this column's length: the pier with its former column and hinge."""
        return Pier.from_preset(
            self.support, {} if self.length is None else {"length": self.length}
        )


def load_column(path: str | Path) -> Column:
    """Read a column's TOML file.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Column
        Paths in it are absolute.

    Raises
    ------
    InputError
        Naming the file, the field, what was found and what to write.
    """
    data = read_toml(path)
    folder = Path(path).parent
    support = data.get("support")
    if isinstance(support, str) and ("/" in support or "\\" in support or "." in support):
        data["support"] = str((folder / support).absolute())
    motions = data.get("motions")
    if isinstance(motions, list):
        data["motions"] = [
            with_absolute_paths(one, folder, Place((Motion,))) if isinstance(one, dict) else one
            for one in motions
        ]
    column = validated(Column, data, str(path))
    try:
        column.pier()
    except InputError as error:
        raise InputError(f"{path}: {error}") from None
    return column
