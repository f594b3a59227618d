"""What carries the track: a pier, the ground itself, or a motion known beforehand."""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field

from railquake.errors import InputError
from railquake.inputs.hinge import BoucWenHinge
from railquake.inputs.model import Flag, InputModel, Name, Text, validated
from railquake.inputs.units import (
    Length,
    PositiveLength,
    PositiveMass,
    PositivePressure,
    PositiveRollInertia,
    PositiveSecondMomentOfArea,
    Quantity,
)
from railquake.messages import unreadable

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_DampingRatio = Annotated[float, Quantity("number", "non-negative")]


class Pier(InputModel):
    """A single column with a hinge at its base and the track on a rigid offset at its top."""

    kind: Literal["pier"] = "pier"
    name: Annotated[Name, Field(description="What to call the pier")]
    summary: Annotated[Text, Field(description="One line for lists")] = ""
    source: Annotated[Text, Field(description="Where the values come from")] = ""
    note: Annotated[Text, Field(description="How far the values can be trusted")] = ""
    youngs_modulus: Annotated[PositivePressure, Field(description="Of the column [Pa]")]
    second_moment_of_area: Annotated[
        PositiveSecondMomentOfArea, Field(description="Of the column's (cracked) section [m4]")
    ]
    length: Annotated[PositiveLength, Field(description="From the hinge to the top [m]")]
    mass: Annotated[PositiveMass, Field(description="Mass at the top [kg]")]
    rotational_inertia: Annotated[
        PositiveRollInertia, Field(description="Rotational inertia at the top [kg m2]")
    ]
    base_rotational_inertia: Annotated[
        PositiveRollInertia, Field(description="Rotational inertia above the hinge [kg m2]")
    ] = 1.0
    track_offset: Annotated[
        Length, Field(description="Track's centre right of the column's axis [m]")
    ] = 0.0
    track_height: Annotated[
        Length, Field(description="Rail crowns above the column's top node [m]")
    ] = 0.0
    hinge: Annotated[
        Literal["bouc-wen", "elastic"],
        Field(description="Law of the hinge; elastic takes its stiffness from bouc_wen.k0"),
    ] = "bouc-wen"
    bouc_wen: Annotated[BoucWenHinge, Field(description="Parameters of the hinge")]
    coupled: Annotated[Flag, Field(description="Whether the train's forces act on the pier")] = True
    damping_ratio: Annotated[
        _DampingRatio, Field(lt=1.0, description="Rayleigh, first two initial modes [1]")
    ] = 0.02
    p_delta: Annotated[Flag, Field(description="Whether gravity acts on the displaced column")] = (
        False
    )

    @classmethod
    def from_preset(cls, preset: str, overrides: Mapping[str, Any] | None = None) -> Pier:
        """Make a pier from a preset.

        Parameters
        ----------
        preset : str
            A built-in name or the path of a TOML file.
        overrides : mapping, optional
            Values to change, as they would stand in the case file's table.

        Returns
        -------
        Pier

        Raises
        ------
        InputError
            If there is no such preset or the values do not make a pier.
        """
        from railquake.inputs.presets import resolved_section

        table = resolved_section("support", {"preset": preset, **(overrides or {})})
        return validated(cls, table, "support")


class AtGrade(InputModel):
    """No structure: the track moves with the ground."""

    kind: Literal["at-grade"] = "at-grade"


class PrescribedTrack(InputModel):
    """A track whose motion is known, from a CSV file.

    Columns ``t_s, y_m`` and optionally ``z_m`` and ``roll_rad``: the motion of the track relative
    to the frame in which the ground motion is zero.
    """

    kind: Literal["prescribed"] = "prescribed"
    file: Annotated[Name, Field(description="CSV file with columns t_s, y_m[, z_m, roll_rad]")]

    def track_motion(self) -> TrackMotion:
        """Read the file.

        Returns
        -------
        TrackMotion

        Raises
        ------
        InputError
            See :func:`read_track_motion`.
        """
        return read_track_motion(self.file)


Support = Annotated[Pier | AtGrade | PrescribedTrack, Field(discriminator="kind")]


@dataclass(frozen=True)
class TrackMotion:
    """Motion of the track at equal time steps, relative to the ground's frame.

    Parameters
    ----------
    dt : float
        Time step [s].
    y, z : (n,) array
        Lateral (right) and vertical (down) displacement [m].
    roll : (n,) array
        Rotation about the forward axis, right side down [rad].
    """

    dt: float
    y: NDArray[np.float64]
    z: NDArray[np.float64]
    roll: NDArray[np.float64]


def read_track_motion(path: str | Path) -> TrackMotion:
    """Read the motion of a track from a CSV file.

    Parameters
    ----------
    path : str or Path
        File with a first line naming the columns ``t_s``, ``y_m`` and optionally ``z_m`` and
        ``roll_rad``, and then at least two lines at equal time steps, beginning at 0.

    Returns
    -------
    TrackMotion
        Missing columns are zero; the arrays are read-only.

    Raises
    ------
    InputError
        Naming file and line, if the file cannot be read, a column or number is missing, not
        finite or unknown, or the time steps differ.
    """
    import numpy as np

    known = ("t_s", "y_m", "z_m", "roll_rad")
    try:
        with Path(path).open(encoding="utf-8-sig", newline="") as file:
            lines = [
                (number, [cell.strip() for cell in row])
                for number, row in enumerate(csv.reader(file), start=1)
                if any(cell.strip() for cell in row)
            ]
    except OSError as error:
        raise unreadable(path, error) from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: is not a CSV text file: {error}") from error
    header = lines[0][1] if lines else []
    if header[:2] != ["t_s", "y_m"] or set(header) - set(known) or len(set(header)) < len(header):
        raise InputError(
            f"{path}, line {lines[0][0] if lines else 1}: the first line must name the columns "
            f"t_s,y_m and optionally z_m,roll_rad, found {','.join(header)[:60]!r}"
        )
    rows: list[list[float]] = []
    for number, cells in lines[1:]:
        if len(cells) != len(header):
            raise InputError(
                f"{path}, line {number}: {len(cells)} values for {len(header)} columns"
            )
        try:
            values = [float(cell) for cell in cells]
        except ValueError:
            raise InputError(f"{path}, line {number}: holds something that is no number") from None
        if not all(math.isfinite(value) for value in values):
            raise InputError(f"{path}, line {number}: holds a value that is not finite")
        rows.append(values)
    if len(rows) < 2:
        raise InputError(f"{path}: holds {len(rows)} time steps; at least two are needed")
    table = np.array(rows, dtype=np.float64)
    time = table[:, 0]
    dt = float((time[-1] - time[0]) / (len(rows) - 1))
    if dt <= 0.0 or abs(time[0]) > 1e-3 * dt:
        raise InputError(
            f"{path}: t_s must begin at 0 and grow, found {time[0]:g} ... {time[-1]:g}"
        )
    uneven = np.flatnonzero(np.abs(np.diff(time) - dt) > 1e-3 * dt)
    if uneven.size:
        at = int(uneven[0])
        raise InputError(
            f"{path}, line {lines[at + 2][0]}: the time step is {time[at + 1] - time[at]:g} s "
            f"where it is {dt:g} s on average; steps must be equal (resample the motion)"
        )
    table.setflags(write=False)
    zeros = np.zeros(len(rows))
    zeros.setflags(write=False)
    columns = {name: table[:, index] for index, name in enumerate(header)}
    return TrackMotion(
        dt, columns["y_m"], columns.get("z_m", zeros), columns.get("roll_rad", zeros)
    )
