"""Marks of fields: what else than its type there is to a field, said where the field is.

``file: Annotated[Name, File()]`` names a file: its path starts from the folder of the case, its
content counts in a scenario's hash, an axis of a study may set it.  All that follow the marks find
them by walking the models (`Place`), so that a new field needs no entry elsewhere.
"""

from __future__ import annotations

import types
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic.fields import FieldInfo
from pydantic_core import PydanticCustomError, core_schema

from railquake.laws import Family
from railquake.messages import shown

__all__ = [
    "AsText",
    "ByName",
    "File",
    "KnownLaw",
    "Label",
    "OneOf",
    "Place",
    "Samples",
    "alternatives",
    "holds",
    "mark_of",
    "marked",
    "models_in",
    "parts_of",
]

Mark = TypeVar("Mark")


@dataclass(frozen=True)
class File:
    """The field holds the path of a file."""


@dataclass(frozen=True)
class ByName:
    """The field is a list of things with names.

    A case file may write it as a table of tables, ``{"car": {...}}`` for
    ``[{"name": "car", ...}]``, so that one of them can be overridden by its name.
    """


@dataclass(frozen=True)
class OneOf:
    """Of the fields of a model with the same mark one is given.

    An override of one takes the others out of what it overrides.
    """

    what: str


@dataclass(frozen=True)
class AsText:
    """A text may stand for the field's table.

    What the table holds belongs together: an override replaces all of it.
    """

    read: Callable[[str], Mapping[str, Any]]
    """From the text to the table."""


@dataclass(frozen=True)
class Label:
    """The field is for people: nothing that is computed depends on it."""


@dataclass(frozen=True)
class Samples:
    """The field is a long list of numbers, which is shown by its hash alone."""


@dataclass(frozen=True, eq=False)
class KnownLaw:
    """The field is the name of a law of a family, see `railquake.laws`."""

    family: Family[Any]

    def __get_pydantic_core_schema__(
        self, _source: Any, _handler: GetCoreSchemaHandler
    ) -> core_schema.CoreSchema:
        """Validate by looking into the family, which laws from outside may have joined."""

        def validate(value: Any) -> str:
            if not isinstance(value, str):
                raise PydanticCustomError("inconsistent", "must be a text, found {found}",
                                          {"found": shown(value)})  # fmt: skip
            if value not in self.family:
                raise PydanticCustomError(
                    "inconsistent",
                    "there is no {found}; known: {known}",
                    {"found": shown(value), "known": self.family.listed()},
                )
            return value

        return core_schema.no_info_plain_validator_function(
            validate, serialization=core_schema.plain_serializer_function_ser_schema(str)
        )

    def __get_pydantic_json_schema__(
        self, _schema: core_schema.CoreSchema, _handler: GetJsonSchemaHandler
    ) -> dict[str, Any]:
        """Tell editors the laws of the package."""
        return {"enum": list(self.family.built_in()), "type": "string"}


def parts_of(annotation: Any) -> list[Any]:
    """The alternatives of a union, or what is no union by itself."""
    if get_origin(annotation) in (Union, types.UnionType):
        return [part for a in get_args(annotation) for part in parts_of(a)]
    return [annotation]


def mark_of(field: FieldInfo, kind: type[Mark]) -> Mark | None:
    """The mark of a kind on a field, or on one alternative of its type; None without."""
    marks = list(field.metadata)
    for part in parts_of(field.annotation):
        if get_origin(part) is Annotated:
            marks += get_args(part)[1:]
    return next((mark for mark in marks if isinstance(mark, kind)), None)


def marked(model: type[BaseModel], kind: type[Mark]) -> Mapping[str, Mark]:
    """The fields of a model that have a mark of a kind, and these marks."""
    key: Any = kind
    return _marked(model, key)


@cache  # walked once: every validation asks
def _marked(model: Any, kind: Any) -> Mapping[str, Any]:
    found = ((name, mark_of(field, kind)) for name, field in model.model_fields.items())
    return MappingProxyType({name: mark for name, mark in found if mark is not None})


@cache
def alternatives(model: type[BaseModel]) -> tuple[tuple[str, ...], ...]:
    """Groups of fields of which a model takes one."""
    groups: dict[str, list[str]] = {}
    for name, mark in marked(model, OneOf).items():
        groups.setdefault(mark.what, []).append(name)
    return tuple(tuple(names) for names in groups.values())


def models_in(annotation: Any) -> list[type[BaseModel]]:
    """All models that a value of a type may be, or hold."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    if get_origin(annotation) is Literal:
        return []
    return [model for part in get_args(annotation) for model in models_in(part)]


@cache
def _below(model: type[BaseModel], key: str) -> tuple[type[BaseModel], ...]:
    field = model.model_fields.get(key)
    return () if field is None else tuple(models_in(field.annotation))


@cache
def holds(model: type[BaseModel], *kinds: type) -> bool:
    """Whether a model, or one inside it, has a field with a mark of one of some kinds."""
    if any(marked(model, kind) for kind in kinds):
        return True
    return any(holds(below, *kinds) for key in model.model_fields for below in _below(model, key))


@dataclass(frozen=True)
class Place:
    """A place in the tables of a case: which models may stand there.

    Attributes
    ----------
    models : tuple of type
        Empty where plain values stand.
    by_name : bool
        Whether it holds not one of them but several, by their names.
    """

    models: tuple[type[BaseModel], ...] = ()
    by_name: bool = False

    def fields(self) -> Iterator[tuple[str, FieldInfo]]:
        """Names and fields of all models; a name may come more than once."""
        if not self.by_name:
            for model in self.models:
                yield from model.model_fields.items()

    def tables(self) -> dict[str, type[BaseModel]]:
        """Tables that laws from outside have brought, see `InputModel.added_tables`."""
        found: dict[str, type[BaseModel]] = {}
        for model in () if self.by_name else self.models:
            found |= getattr(model, "added_tables", dict)()
        return found

    def names(self) -> list[str]:
        """All keys that may be written here."""
        return list(dict.fromkeys((*(name for name, _ in self.fields()), *self.tables())))

    def field(self, key: str) -> FieldInfo | None:
        """The field with a name, of the first model that has it."""
        return next((field for name, field in self.fields() if name == key), None)

    def mark(self, key: str, kind: type[Mark]) -> Mark | None:
        """The mark of a kind on a field; None without."""
        if self.by_name:
            return None
        found = (marked(model, kind).get(key) for model in self.models)
        return next((mark for mark in found if mark is not None), None)

    def alternatives(self) -> list[tuple[str, ...]]:
        """Groups of keys of which one is written."""
        if self.by_name:
            return []
        return [group for model in self.models for group in alternatives(model)]

    def of_kind(self, table: Mapping[str, Any]) -> Place:
        """The place with the one model that a table chooses by its ``kind``, or leaves to be."""
        kinds = {m.model_fields["kind"].default: m for m in self.models if "kind" in m.model_fields}
        if not kinds:
            return self
        chosen = table.get("kind", self.models[0].model_fields["kind"].default)
        return Place(tuple(model for kind, model in kinds.items() if kind == chosen))

    def below(self, key: str) -> Place:
        """The place of a key's value."""
        if self.by_name:
            return Place(self.models)
        models = [found for model in self.models for found in _below(model, key)]
        if not models and key in (tables := self.tables()):
            models = [tables[key]]
        return Place(tuple(models), self.mark(key, ByName) is not None)
