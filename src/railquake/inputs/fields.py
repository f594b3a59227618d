"""Inputs by their paths: whether ``support.length`` names one, and what it takes."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from railquake.errors import InputError
from railquake.inputs.layers import has_presets
from railquake.inputs.marks import AsText, File, Place, mark_of, models_in, parts_of
from railquake.inputs.scenario import Scenario
from railquake.inputs.toml import is_path
from railquake.inputs.units import Quantity, Sign, to_si
from railquake.messages import did_you_mean, shown

__all__ = ["Input", "input_at"]

Kind = Literal["number", "integer", "flag", "text", "any"]


@dataclass(frozen=True)
class Input:
    """One input of a scenario.

    Attributes
    ----------
    field_path : str
        As in an override: ``"vehicle.speed"``.
    kind : {"number", "integer", "flag", "text", "any"}
        What it takes; ``any`` for tables and the like.
    dimension : str or None
        Of a number, a key of `units.DIMENSIONS`.
    sign : {"any", "non-negative", "positive"}
        Of a number.
    file : {"no", "always", "with an ending"}
        Whether a text that it takes is the path of a file: always, or if it is no name.
    """

    field_path: str
    kind: Kind
    dimension: str | None = None
    sign: Sign = "any"
    file: Literal["no", "always", "with an ending"] = "no"

    def in_si(self, value: Any, where: str) -> Any:
        """The value as the scenario holds it.

        Parameters
        ----------
        value : object
            As written in a file.
        where : str
            For the message.

        Raises
        ------
        InputError
            If it is of another kind, has a wrong unit or sign.
        """
        if self.kind == "number":
            return to_si(value, self.dimension or "number", where, sign=self.sign)
        wanted: dict[str, tuple[type, str]] = {
            "integer": (int, "a whole number"),
            "flag": (bool, "true or false"),
            "text": (str, "a text"),
        }
        if self.kind in wanted:
            kind, name = wanted[self.kind]
            if not isinstance(value, kind) or (isinstance(value, bool) and kind is int):
                raise InputError(f"{where}: must be {name}, found {shown(value)}")
        return value

    def absolute(self, value: Any, folder: Path) -> Any:
        """The value with its path, if it is one, absolute; relative ones start from a folder."""
        if not isinstance(value, str) or self.file == "no":
            return value
        if self.file == "with an ending" and not is_path(value):
            return value
        return str((folder / value).absolute())


def input_at(path: str, where: str) -> Input:
    """Find the input that a path names.

    Parameters
    ----------
    path : str
        ``"support.hinge"``, ``"vehicle.bodies.car.mass"``.
    where : str
        For the message.

    Returns
    -------
    Input

    Raises
    ------
    InputError
        If it names none; says which name was nearest.
    """
    steps = path.split(".")
    if steps[:2] == ["motion", "synthetic"] and len(steps) > 2:
        return _synthetic(path, steps[2:], where)
    place, one_of_many = Place((Scenario,)), False
    for depth, step in enumerate(steps):
        if steps[1:] == ["preset"] and depth == 1 and has_presets(place):
            return Input(path, "text", file="with an ending")
        if not place.models:
            here = ".".join(steps[:depth])
            raise InputError(f'{where}: "{path}" names no input; {here} holds no others')
        if not place.by_name and step not in place.names():
            known = [key for key in place.names() if not (one_of_many and key == "name")]
            known += ["preset"] if depth == 1 and has_presets(place) else []
            advice = did_you_mean(step, known)
            raise InputError(f'{where}: "{path}" names no input; "{step}" is unknown, {advice}')
        field = place.field(step)  # None for a name, and for a table of a law from outside
        place, one_of_many = place.below(step), place.by_name
    return Input(path, "any") if field is None else _leaf(path, field)


def _synthetic(path: str, rest: list[str], where: str) -> Input:
    from railquake.inputs.ground_motion.synthetic import DIMENSIONS

    known = ["seed", *DIMENSIONS]
    if len(rest) != 1 or rest[0] not in known:
        advice = did_you_mean(rest[0], known)
        raise InputError(f'{where}: "{path}" names no input; "{rest[0]}" is unknown, {advice}')
    if rest[0] == "seed":
        return Input(path, "integer")
    return Input(path, "number", DIMENSIONS[rest[0]] or "number", "positive")


def _leaf(path: str, field: FieldInfo) -> Input:
    quantity = mark_of(field, Quantity)
    if quantity is not None:
        return Input(path, "number", quantity.dimension, quantity.sign)
    if mark_of(field, AsText) is not None:
        return Input(path, "any", file="with an ending")
    if mark_of(field, File) is not None:
        return Input(path, "text", file="always")
    kinds = _kinds(field.annotation)
    if models_in(field.annotation):
        return Input(path, "any")
    if bool in kinds:
        return Input(path, "flag")
    if kinds == {int}:
        return Input(path, "integer")
    return Input(path, "text" if kinds == {str} else "any")


def _kinds(annotation: Any) -> set[type]:
    """Plain types of an annotation; those of a literal's values."""
    found: set[type] = set()
    for part in parts_of(annotation):
        while get_origin(part) is Annotated:
            part = get_args(part)[0]
        if get_origin(part) is Literal:
            found |= {type(value) for value in get_args(part)}
        elif isinstance(part, type) and part is not type(None):
            found.add(part)
    return found
