"""All that one run needs: vehicle, support, wheels and rails, ground motion, solver."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, ValidationError, model_validator

from railquake.errors import InputError
from railquake.inputs.identity import fingerprint, hash_of_fingerprints
from railquake.inputs.layers import (
    Overrides,
    has_presets,
    resolved,
    with_absolute_paths,
    with_overrides,
)
from railquake.inputs.marks import Place
from railquake.inputs.model import (
    InputModel,
    field_path,
    inconsistent,
    one_line,
)
from railquake.inputs.motion import Motion
from railquake.inputs.solver import Solver
from railquake.inputs.support import SUPPORTS, Support, SupportKind, of_its_kind
from railquake.inputs.toml import dumps, is_path, read_toml
from railquake.inputs.vehicle import Vehicle
from railquake.inputs.wheelrail import WheelRail
from railquake.messages import refuse_unknown, toml_type

if TYPE_CHECKING:
    from railquake.inputs.ground_motion import GroundMotion

_SUGGESTIONS = {
    "vehicle": '[vehicle] preset = "bart"',
    "support": '[support] preset = "bart-berkeley" or kind = "at-grade"',
    "wheelrail": '[wheelrail] preset = "bart"',
    "motion": '[motion] record = "record.AT2"',
}


class Scenario(InputModel):
    """All inputs of one run, checked and in SI units.

    Raises
    ------
    InputError
        By the constructor and all functions that make one, in one line: file, field, what was
        found, what to write.
    """

    vehicle: Annotated[Vehicle, Field(description="The train's cross-section")]
    support: Annotated[Support, Field(description="What carries the track")]
    wheelrail: Annotated[WheelRail, Field(description="Wheels on rails")]
    motion: Annotated[
        Motion | None, Field(description="The ground's motion; only a prescribed track needs none")
    ] = None
    solver: Annotated[Solver, Field(description="Time stepping")] = Solver()

    @model_validator(mode="after")
    def _has_motion(self) -> Scenario:
        if self.motion is None and self.support.needs_motion:
            raise inconsistent(f"missing; write e.g. {_SUGGESTIONS['motion']}", "motion")
        return self

    def ground_motion(self) -> GroundMotion:
        """Read or make the lateral ground motion and scale it.

        Returns
        -------
        GroundMotion
            Positive to the right.  At rest, if the track is prescribed and no motion is given.

        Raises
        ------
        InputError
            If the record's file cannot be used.
        """
        if self.motion is not None:
            return self.motion.lateral_motion()
        return self.support.ground_at_rest()

    def vertical_motion(self) -> GroundMotion | None:
        """Read the vertical ground motion and scale it.

        Returns
        -------
        GroundMotion or None
            Positive UP, as recorded; None if the scenario has none.

        Raises
        ------
        InputError
            If its file cannot be used.
        """
        return None if self.motion is None else self.motion.vertical_motion()

    def with_changes(self, changes: Overrides) -> Scenario:
        """Make another scenario that differs in some values.

        Parameters
        ----------
        changes : iterable of str, or mapping
            Paths and values: ``{"vehicle.speed": "240 km/h"}`` or ``["motion.scale=1.5"]``;
            relative paths of files start from the working folder.

        Returns
        -------
        Scenario

        Raises
        ------
        InputError
            If a path or value is wrong.
        """
        return scenario_from_dict(self.to_dict(), overrides=changes, where="scenario")

    def with_step(self, step: float) -> Scenario:
        """Make the same scenario with another time step, s; all of it, unless it says otherwise."""
        changes = {"dt": step, "substeps": self.solver.substeps or 1}
        return self.model_copy(update={"solver": self.solver.model_copy(update=changes)})

    def to_dict(self) -> dict[str, Any]:
        """Return the tables of a case file that gives this scenario, all values in SI units."""
        return self.table()

    def to_toml(self) -> str:
        """Write a case file that gives this scenario again.

        Returns
        -------
        str
            Without presets, all values in SI units; paths of files are absolute.
        """
        return dumps(self.to_dict())

    def content_hash(self) -> str:
        """Fingerprint of all that decides the results.

        Names, sources, notes and the paths of files do not count; the content of the files does.

        Returns
        -------
        str
            64 hexadecimal digits.

        Raises
        ------
        InputError
            If a file that the scenario names cannot be read.
        """
        return hash_of_fingerprints(
            {name: fingerprint(getattr(self, name)) for name in type(self).model_fields}
        )


def load_scenario(path: str | Path, overrides: Overrides = ()) -> Scenario:
    """Read a case file.

    Parameters
    ----------
    path : str or Path
        TOML file; relative paths in it start from its folder.
    overrides : iterable of str, or mapping
        Values to change: ``["motion.scale=1.5"]`` or ``{"motion.scale": 1.5}``; paths of files
        in them start from the case file's folder, too.

    Returns
    -------
    Scenario

    Raises
    ------
    InputError
        Naming the file and the line or field, what was found and what to write.
    """
    folder = Path(path).absolute().parent
    return scenario_from_dict(read_toml(path), folder, overrides=overrides, where=str(path))


def scenario_from_dict(
    data: Mapping[str, Any],
    folder: str | Path | None = None,
    *,
    overrides: Overrides = (),
    where: str = "scenario",
) -> Scenario:
    """Make a scenario from the tables of a case file.

    Parameters
    ----------
    data : mapping
        The tables, with or without presets.
    folder : str or Path, optional
        What relative paths start from; the working folder by default.
    overrides : iterable of str, or mapping
        Values to change, see :func:`load_scenario`.
    where : str
        What to call the tables in messages.

    Returns
    -------
    Scenario

    Raises
    ------
    InputError
        Naming the field, what was found and what to write.
    """
    base = Path.cwd() if folder is None else Path(folder)
    place = Place((Scenario,))
    tables = with_overrides(data, overrides, place, f"{where}: --set")
    sections = list(Scenario.model_fields)
    refuse_unknown(tables, sections, f"{where}: ")
    for key, value in tables.items():
        if not isinstance(value, Mapping):
            advice = f"; write e.g. {_SUGGESTIONS[key]}" if key in _SUGGESTIONS else ""
            raise InputError(f"{where}: {key}: must be a table, found {toml_type(value)}{advice}")
    whole: dict[str, Any] = {}
    for key, field in Scenario.model_fields.items():
        below, table = place.below(key), tables.get(key)
        if table is None:
            if field.is_required():
                raise InputError(f"{where}: {key}: missing; write e.g. {_SUGGESTIONS[key]}")
        elif has_presets(below):
            whole[key] = resolved(key, below, table, base, f"{where}: {key}")
        else:
            whole[key] = with_absolute_paths(table, base, below)
    whole["support"] = of_its_kind(whole["support"], f"{where}: support")
    try:
        return Scenario.model_validate(whole)
    except ValidationError as error:
        origin = _preset_at_fault(error, whole, tables)
        raise InputError(f"{where}: {one_line(error, whole)}{origin}") from None


def _preset_at_fault(
    error: ValidationError, whole: Mapping[str, Any], tables: Mapping[str, Any]
) -> str:
    """Name the preset's file if the wrong value is not in the case itself."""
    steps = field_path(error.errors(include_url=False)[0], whole).split(".")
    preset = tables.get(steps[0], {}).get("preset")
    if not isinstance(preset, str | os.PathLike) or not is_path(os.fspath(preset)):
        return ""
    here: Any = tables
    for step in steps:
        if not isinstance(here, Mapping) or step not in here:
            return f" (in {os.fspath(preset)})"
        here = here[step]
    return ""


def scenario(
    vehicle: str | Path | Mapping[str, Any] | Vehicle = "bart",
    support: str | Path | Mapping[str, Any] | SupportKind = "bart-berkeley",
    wheelrail: str | Path | Mapping[str, Any] | WheelRail = "bart",
    *,
    record: str | Path | None = None,
    motion: GroundMotion | Motion | Mapping[str, Any] | None = None,
    synthetic: Mapping[str, Any] | None = None,
    vertical: str | Path | GroundMotion | None = None,
    scale: float | None = None,
    channel: int | str | None = None,
    units: str | None = None,
    allow_high_pga: bool | None = None,
    speed: str | float | None = None,
    hinge: str | None = None,
    coupled: bool | None = None,
    damping_ratio: float | None = None,
    **solver: Any,
) -> Scenario:
    """Make a scenario in Python.

    Parameters
    ----------
    vehicle, support, wheelrail : str, Path, mapping or model
        The name of a preset, the path of a preset's file, a table as in a case file, or the
        model itself.  A support may also be ``"at-grade"``.
    record : str or Path, optional
        The record's file.
    motion : GroundMotion, Motion or mapping, optional
        A motion in memory, or a table as in a case file; instead of `record`.
    synthetic : mapping, optional
        Parameters of a synthetic motion; instead of `record`.
    vertical : str, Path or GroundMotion, optional
        The vertical component, positive up.
    scale : float, optional
        Factor on the motion.
    channel, units, allow_high_pga : optional
        How to read the record; see :class:`Motion`.
    speed : str or float, optional
        The train's speed, ``"80 km/h"`` or m/s.
    hinge, coupled, damping_ratio : optional
        Values of the pier.
    **solver
        Values of :class:`Solver`: ``dt="2e-5 s"``, ``contact="grid"``.

    Returns
    -------
    Scenario

    Raises
    ------
    InputError
        Naming the field, what was found and what to write.

    Examples
    --------
    >>> s = scenario(record="RSN181.AT2", scale=1.81, speed="80 km/h", hinge="elastic")
    >>> s.support.hinge
    'elastic'
    """
    pier = {"hinge": hinge, "coupled": coupled, "damping_ratio": damping_ratio}
    if isinstance(support, str) and _needs_nothing(support):
        support = {"kind": support}
    how = {"channel": channel, "units": units, "allow_high_pga": allow_high_pga, "scale": scale}
    from_motion = _motion_table(record, motion, synthetic, vertical)
    tables: dict[str, Any] = {
        "vehicle": _table(vehicle, {"speed": speed}),
        "support": _table(support, pier),
        "wheelrail": _table(wheelrail, {}),
    }
    from_motion.update((key, value) for key, value in how.items() if value is not None)
    if from_motion:
        tables["motion"] = from_motion
    if solver:
        tables["solver"] = solver
    return scenario_from_dict(tables)


def _needs_nothing(kind: str) -> bool:
    """Whether a text is a kind of support that has no values, such as ``at-grade``."""
    fields = SUPPORTS[kind].model_fields.values() if kind in SUPPORTS else None
    return fields is not None and not any(field.is_required() for field in fields)


def _table(
    section: str | Path | Mapping[str, Any] | InputModel, values: Mapping[str, Any]
) -> dict[str, Any]:
    if isinstance(section, InputModel):
        table = section.model_dump(exclude_none=True)
    elif isinstance(section, Mapping):
        table = dict(section)
    else:
        table = {"preset": section}
    table.update((key, value) for key, value in values.items() if value is not None)
    return table


def _motion_table(
    record: str | Path | None,
    motion: GroundMotion | Motion | Mapping[str, Any] | None,
    synthetic: Mapping[str, Any] | None,
    vertical: str | Path | GroundMotion | None,
) -> dict[str, Any]:
    table: dict[str, Any] = {}
    if isinstance(motion, Motion):
        table = motion.model_dump(exclude_none=True)
    elif isinstance(motion, Mapping):
        table = dict(motion)
    elif motion is not None:
        table = {
            "name": motion.name,
            "dt": motion.dt,
            "acceleration": motion.acceleration.tolist(),
        }
    if record is not None:
        table["record"] = os.fspath(record)
    if synthetic is not None:
        table["synthetic"] = dict(synthetic)
    if isinstance(vertical, str | os.PathLike):
        table["vertical"] = os.fspath(vertical)
    elif vertical is not None:
        dt = table.setdefault("dt", vertical.dt)
        if not math.isclose(float(dt), vertical.dt, rel_tol=1e-9):
            raise InputError(
                f"scenario: motion.dt: the components' time steps differ, {dt:g} and "
                f"{vertical.dt:g} s; resample one of them"
            )
        table["vertical_acceleration"] = vertical.acceleration.tolist()
    return table
