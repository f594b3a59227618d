"""What carries the track: a pier, the ground itself, or a motion known beforehand."""

from __future__ import annotations

import csv
import io
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, get_args

from pydantic import ConfigDict, Field

from railquake.errors import InputError
from railquake.files import read_file
from railquake.inputs.hinge import BoucWenHinge, model_of, table_of
from railquake.inputs.layers import FromPreset
from railquake.inputs.marks import File, KnownLaw, Label
from railquake.inputs.model import Flag, InputModel, Name, Text, nested
from railquake.inputs.motion import motion_of_samples
from railquake.inputs.units import (
    Length,
    PositiveLength,
    PositiveMass,
    PositivePressure,
    PositiveRollInertia,
    PositiveSecondMomentOfArea,
    Quantity,
    number_of,
)
from railquake.laws import HINGE_LAWS
from railquake.messages import did_you_mean, shown, toml_type, unreadable

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from railquake.inputs.ground_motion import GroundMotion

_DampingRatio = Annotated[float, Quantity("number", "non-negative")]


class SupportKind(InputModel):
    """Base of what may carry the track; each kind has its name as the default of ``kind``."""

    needs_motion: ClassVar[bool] = True
    """Whether a scenario must say how the ground moves."""

    def ground_at_rest(self) -> GroundMotion:
        """Make the ground's motion where a scenario gives none; only where none is needed."""
        raise NotImplementedError(f"{type(self).__name__} needs a motion")


class Pier(SupportKind, FromPreset):
    """A single column with a hinge at its base and the track on a rigid offset at its top."""

    # A hinge law from outside may have a table of its own, [support.my_law]: it is held beside the
    # fields.  Nothing else gets so far, see `InputModel._known_and_complete`.
    model_config = ConfigDict(extra="allow")
    section: ClassVar[str] = "support"

    kind: Literal["pier"] = "pier"
    name: Annotated[Name, Label(), Field(description="What to call the pier")]
    summary: Annotated[Text, Label(), Field(description="One line for lists")] = ""
    source: Annotated[Text, Label(), Field(description="Where the values come from")] = ""
    note: Annotated[Text, Label(), Field(description="How far the values can be trusted")] = ""
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
        str,
        KnownLaw(HINGE_LAWS),
        Field(description="Law of the hinge; elastic takes its stiffness from bouc_wen.k0"),
    ] = "bouc-wen"
    bouc_wen: Annotated[BoucWenHinge, Field(description="Parameters of the hinge")]
    coupled: Annotated[Flag, Field(description="Whether the train's forces act on the pier")] = True
    damping_ratio: Annotated[
        _DampingRatio, Field(lt=1.0, description="Rayleigh, first two initial modes [1]")
    ] = 0.02
    damping_of: Annotated[
        Literal["column", "initial", "tangent"],
        Field(
            description="Whose stiffness the part of the damping that goes with stiffness takes: "
            "the column's alone, the hinge's initial one as well, or its tangent as well"
        ),
    ] = "column"
    p_delta: Annotated[Flag, Field(description="Whether gravity acts on the displaced column")] = (
        False
    )

    @classmethod
    def added_tables(cls) -> dict[str, type[InputModel]]:
        """Tables of hinge laws with parameters of their own."""
        found: dict[str, type[InputModel]] = {}
        for law in HINGE_LAWS:
            model, table = model_of(law), table_of(law)
            if model is None:
                continue
            if table in cls.model_fields:
                raise InputError(
                    f"hinge law {shown(law)}: its table [support.{table}] has the name of a key of "
                    "the pier; give the law another name"
                )
            found[table] = model
        return found

    @classmethod
    def _normalised(cls, data: dict[str, Any]) -> dict[str, Any]:
        data = super()._normalised(data)
        tables = cls.added_tables()
        hinge = data.get("hinge")
        if isinstance(hinge, str) and hinge in HINGE_LAWS and table_of(hinge) in tables:
            data.setdefault(table_of(hinge), {})  # what is missing in it is told, or has defaults
        for key, model in tables.items():
            if key in data:
                data[key] = nested(model, key, data[key])
        return data

    def without_effect(self) -> set[str]:
        """Fields that do not tell two piers apart.

        "initial" is what piers were before there was a choice: rows of older studies stay theirs.
        """
        usual = {"damping_of"} if self.damping_of == "initial" else set()
        return super().without_effect() | usual

    @property
    def hinge_parameters(self) -> InputModel:
        """Parameters of the hinge law that is chosen."""
        if model_of(self.hinge) is None:
            return self.bouc_wen
        return getattr(self, table_of(self.hinge))


class AtGrade(SupportKind):
    """No structure: the track moves with the ground."""

    kind: Literal["at-grade"] = "at-grade"


class PrescribedTrack(SupportKind):
    """A track whose motion is known, from a CSV file.

    Columns ``t_s, y_m`` and optionally ``z_m`` and ``roll_rad``: the motion of the track relative
    to the frame in which the ground motion is zero.
    """

    needs_motion: ClassVar[bool] = False

    kind: Literal["prescribed"] = "prescribed"
    file: Annotated[
        Name, File(), Field(description="CSV file with columns t_s, y_m[, z_m, roll_rad]")
    ]

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

    def ground_at_rest(self) -> GroundMotion:
        """Make a ground that does not move, for as long as the track is known."""
        track = self.track_motion()
        return motion_of_samples("at rest", track.dt, (0.0,) * track.y.size)


Support = Annotated[Pier | AtGrade | PrescribedTrack, Field(discriminator="kind")]
"""All kinds of support; the first is meant where a case does not say."""

SUPPORTS: dict[str, type[SupportKind]] = {
    kind.model_fields["kind"].default: kind for kind in get_args(get_args(Support)[0])
}
"""All kinds by their names, as `Support` lists them."""


def of_its_kind(table: dict[str, Any], where: str) -> dict[str, Any]:
    """Settle the kind of support, and leave out what only a pier has from one that is none.

    A case that sets ``kind = "at-grade"`` beside a pier's preset, hinge or coupling (as an axis
    of a study does) means the same train without the pier.

    Raises
    ------
    InputError
        If there is no such kind.
    """
    kind = table.get("kind", next(iter(SUPPORTS)))
    if not isinstance(kind, str) or kind not in SUPPORTS:
        advice = did_you_mean(kind, SUPPORTS)
        raise InputError(f"{where}.kind: unknown kind of support {toml_type(kind)}; {advice}")
    own = _keys(SUPPORTS[kind])
    others = {key for model in SUPPORTS.values() for key in _keys(model)} - own
    builds_on_presets = issubclass(SUPPORTS[kind], FromPreset)
    kept = {key: value for key, value in table.items() if builds_on_presets or key not in others}
    return {"kind": kind, **kept}


def _keys(model: type[InputModel]) -> set[str]:
    return {*model.model_fields, *model.added_tables()}


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
        text = read_file(path).decode("utf-8-sig")
        lines = [
            (number, [cell.strip() for cell in row])
            for number, row in enumerate(csv.reader(io.StringIO(text, newline="")), start=1)
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
        values = [value for value in map(number_of, cells) if value is not None]
        if len(values) < len(cells):
            raise InputError(f"{path}, line {number}: holds something that is no number")
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
