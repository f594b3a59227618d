"""Inputs by their paths: whether ``support.length`` names one, and what it takes."""

from __future__ import annotations

import types
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from railquake.errors import InputError
from railquake.inputs.model import InputModel
from railquake.inputs.presets import KINDS
from railquake.inputs.scenario import Scenario
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
    """

    field_path: str
    kind: Kind
    dimension: str | None = None
    sign: Sign = "any"

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
    models: list[type[BaseModel]] = [Scenario]
    for depth, step in enumerate(steps):
        last = depth == len(steps) - 1
        if depth == 1 and step == "preset" and steps[0] in KINDS and last:
            return Input(path, "text")
        found = [model.model_fields[step] for model in models if step in model.model_fields]
        if not found:
            known = list(dict.fromkeys(key for model in models for key in model.model_fields))
            if depth == 1 and steps[0] in KINDS:
                known.append("preset")
            advice = did_you_mean(step, known)
            raise InputError(f'{where}: "{path}" names no input; "{step}" is unknown, {advice}')
        named = any(step in getattr(model, "_tables_by_name", ()) for model in models)
        models = [model for field in found for model in _models(field)]
        if last:
            return _leaf(path, found[0], bool(models))
        if named:
            return _in_named(path, models, steps[depth + 1 :], where)
        if not models:
            here = ".".join(steps[: depth + 1])
            raise InputError(f'{where}: "{path}" names no input; {here} holds no others')
    raise AssertionError("a path has at least one step")


def _in_named(path: str, models: list[type[BaseModel]], rest: list[str], where: str) -> Input:
    """An input of one of several things with names: ``bodies.car.mass``."""
    if len(rest) == 1:
        return Input(path, "any")
    known = [key for model in models for key in model.model_fields if key != "name"]
    for model in models:
        if len(rest) == 2 and rest[1] in model.model_fields:
            return _leaf(path, model.model_fields[rest[1]], False)
    advice = did_you_mean(rest[1], known)
    raise InputError(f'{where}: "{path}" names no input; "{rest[1]}" is unknown, {advice}')


def _synthetic(path: str, rest: list[str], where: str) -> Input:
    from railquake.inputs.ground_motion.synthetic import DIMENSIONS

    known = ["seed", *DIMENSIONS]
    if len(rest) != 1 or rest[0] not in known:
        advice = did_you_mean(rest[0], known)
        raise InputError(f'{where}: "{path}" names no input; "{rest[0]}" is unknown, {advice}')
    if rest[0] == "seed":
        return Input(path, "integer")
    return Input(path, "number", DIMENSIONS[rest[0]] or "number", "positive")


def _leaf(path: str, field: FieldInfo, has_models: bool) -> Input:
    quantity = _quantity(field)
    if quantity is not None:
        return Input(path, "number", quantity.dimension, quantity.sign)
    kinds = _kinds(field.annotation)
    if has_models and path not in ("wheelrail.wheel", "wheelrail.rail"):
        return Input(path, "any")
    if bool in kinds:
        return Input(path, "flag")
    if kinds == {int}:
        return Input(path, "integer")
    return Input(path, "text" if kinds == {str} else "any")


def _quantity(field: FieldInfo) -> Quantity | None:
    """How a number is marked, in the field's own annotation or that of one alternative."""
    for mark in field.metadata:
        if isinstance(mark, Quantity):
            return mark
    for part in _parts(field.annotation):
        if get_origin(part) is Annotated:
            for mark in get_args(part)[1:]:
                if isinstance(mark, Quantity):
                    return mark
    return None


def _parts(annotation: Any) -> list[Any]:
    """The alternatives of a union."""
    if get_origin(annotation) in (Union, types.UnionType):
        return [part for a in get_args(annotation) for part in _parts(a)]
    return [annotation]


def _kinds(annotation: Any) -> set[type]:
    """Plain types of an annotation; those of a literal's values."""
    found: set[type] = set()
    for part in _parts(annotation):
        while get_origin(part) is Annotated:
            part = get_args(part)[0]
        if get_origin(part) is Literal:
            found |= {type(value) for value in get_args(part)}
        elif isinstance(part, type) and part is not type(None):
            found.add(part)
    return found


def _models(field: FieldInfo) -> list[type[BaseModel]]:
    found: list[type[BaseModel]] = []

    def look(annotation: Any) -> None:
        if isinstance(annotation, type) and issubclass(annotation, InputModel):
            found.append(annotation)
        elif not isinstance(annotation, str | Mapping):
            for part in get_args(annotation):
                look(part)

    look(field.annotation)
    return found
