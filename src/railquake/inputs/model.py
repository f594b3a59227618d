"""What all input models share: frozen, no unknown keys, and errors that a person can act on."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, TypeVar

from pydantic import (
    BaseModel,
    ConfigDict,
    StrictBool,
    StrictInt,
    StrictStr,
    StringConstraints,
    ValidationError,
    model_validator,
)
from pydantic_core import PydanticCustomError

from railquake.errors import InputError
from railquake.inputs.marks import AsText, ByName, Label, mark_of, marked
from railquake.inputs.units import Quantity
from railquake.messages import did_you_mean, shown, toml_type

Name = Annotated[str, StringConstraints(strict=True, min_length=1, pattern=r"^\S(.*\S)?$")]
Text = StrictStr
Flag = StrictBool
Integer = StrictInt

ModelType = TypeVar("ModelType", bound="InputModel")


class InputModel(BaseModel):
    """Base of the input models: frozen, strict, with one-line errors.

    Raises
    ------
    InputError
        By the constructor, naming the field, what was found and what to write.
    """

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, hide_input_in_errors=False
    )

    def __init__(self, **data: Any) -> None:
        """Validate the fields; see the class for their meaning."""
        try:
            self.__pydantic_validator__.validate_python(data, self_instance=self)
        except ValidationError as error:
            where = type(self).__name__
            raise InputError(f"{where}: {one_line(error, data)}") from None

    # Nested models are then validated by pydantic itself, which keeps the path of the field.
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @classmethod
    def added_tables(cls) -> dict[str, type[InputModel]]:
        """Tables that stand beside the fields: of laws from outside, each with its model."""
        return {}

    @classmethod
    def _normalised(cls, data: dict[str, Any]) -> dict[str, Any]:
        """Turn other ways of writing the same thing into the fields."""
        for key, mark in marked(cls, AsText).items():
            if isinstance(data.get(key), str):
                data[key] = mark.read(data[key])
        for key in marked(cls, ByName):
            if isinstance(data.get(key), Mapping):
                data[key] = named_list(key, data[key])
        return data

    def table(self) -> dict[str, Any]:
        """Make the table of a case file that gives this again, all values in SI units."""
        return self._as_written(self.model_dump(exclude_none=True))

    def _as_written(self, data: dict[str, Any]) -> dict[str, Any]:
        """Turn the values of the fields into what a case file has."""
        by_name = marked(type(self), ByName)
        for name, value in self:
            if isinstance(value, InputModel):
                data[name] = value._as_written(data[name])
            elif isinstance(value, tuple) and value and isinstance(value[0], InputModel):
                pairs = zip(value, data[name], strict=True)
                data[name] = tuple(item._as_written(table) for item, table in pairs)
            if name in by_name:
                data[name] = {table.pop("name"): table for table in data[name]}
        return data

    def without_effect(self) -> set[str]:
        """Fields on which nothing that is computed depends."""
        return set(marked(type(self), Label))

    @model_validator(mode="before")
    @classmethod
    def _known_and_complete(cls, data: Any) -> Any:
        """Refuse unknown and missing keys with advice, before anything else is looked at."""
        if isinstance(data, cls):
            return data
        if not isinstance(data, Mapping):
            raise PydanticCustomError(
                "table", "must be a table, found {found}", {"found": toml_type(data)}
            )
        data = cls._normalised({key: _plain(value) for key, value in data.items()})
        known = (*cls.model_fields, *cls.added_tables())
        for key in data:
            if key not in known:
                raise PydanticCustomError(
                    "unknown_key",
                    "unknown key; {advice}",
                    {"key": str(key), "advice": did_you_mean(str(key), known)},
                )
        for key, field in cls.model_fields.items():
            if field.is_required() and key not in data:
                quantity = mark_of(field, Quantity)
                advice = "" if quantity is None else f"; write e.g. {key} = {quantity.example}"
                raise PydanticCustomError("missing_key", "missing{advice}",
                                          {"key": key, "advice": advice})  # fmt: skip
        return data


def _plain(value: Any) -> Any:
    """Python's own kind of number for one of numpy's."""
    if type(value).__module__ == "numpy" and getattr(value, "ndim", None) == 0:
        return value.item()
    return value


def named_list(key: str, tables: Mapping[str, Any]) -> list[Any]:
    """Turn a table of tables into a list of tables that carry their names."""
    items: list[Any] = []
    for name, table in tables.items():
        if not isinstance(table, Mapping):
            raise PydanticCustomError(
                "table",
                "must be a table, found {found}",
                {"key": f"{key}.{name}", "found": toml_type(table)},
            )
        items.append({"name": name, **table})
    return items


def field_path(error: Mapping[str, Any], data: object) -> str:
    """Write the path of the field as the case file has it: ``vehicle.bodies.car.mass``.

    Parameters
    ----------
    error : mapping
        One of ``ValidationError.errors()``.
    data : object
        What was validated; gives the names of listed things.
    """
    parts: list[str] = []
    here: Any = data
    for step in error["loc"]:
        if isinstance(step, int):
            name = None
            if isinstance(here, Mapping) and step < len(here):
                name, here = list(here.items())[step]
            elif isinstance(here, list | tuple) and step < len(here):
                here = here[step]
                name = here.get("name") if isinstance(here, Mapping) else None
            else:
                here = None
            if isinstance(name, str):
                parts.append(f".{name}")
            else:
                parts.append(f"[{step}]")
        else:
            if not isinstance(here, Mapping) or (step not in here and here.get("kind") == step):
                continue  # which member of a union was tried, which is no step of the path
            here = here.get(step)
            parts.append(f".{step}")
    key = (error.get("ctx") or {}).get("key")
    if key:
        parts.append(f".{key}")
    return "".join(parts).lstrip(".")


def _reason(error: Mapping[str, Any]) -> str:
    kind, context = error["type"], error.get("ctx") or {}
    found = toml_type(error.get("input"))
    if kind in ("literal_error", "enum"):
        return f"must be {context['expected'].replace(chr(39), chr(34))}, found {found}"
    if kind == "value_error":
        return str(context["error"])
    if kind == "string_unicode":
        return (
            f"must be a text in UTF-8, found {found}; rename the file, or set a locale with UTF-8, "
            "such as LC_ALL=C.UTF-8"
        )
    if kind == "string_type":
        return f"must be a text, found {found}"
    if kind == "string_pattern_mismatch" or kind == "string_too_short":
        return f"must be a name, found {found}"
    if kind == "bool_type":
        return f"must be true or false, found {found}"
    if kind == "int_type":
        return f"must be a whole number, found {found}"
    bounds = {
        "greater_than_equal": ("at least", "ge"),
        "greater_than": ("above", "gt"),
        "less_than_equal": ("at most", "le"),
        "less_than": ("below", "lt"),
    }
    if kind in bounds:
        word, key = bounds[kind]
        return f"must be {word} {context[key]:g}, found {found}"
    if kind == "missing":
        return "missing, the list is too short"
    if kind == "too_long":
        return f"must be a list of {context['max_length']}, found {context['actual_length']}"
    if kind == "too_short":
        return f"must hold at least {context['min_length']}, found {context['actual_length']}"
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        expected = context.get("expected_tags", "a known one").replace(chr(39), chr(34))
        found = shown(context["tag"]) if "tag" in context else "none"
        return f"kind must be one of {expected}, found {found}"
    if kind in ("tuple_type", "list_type"):
        return f"must be a list, found {found}"
    message = str(error["msg"])
    message = message[0].lower() + message[1:]
    plain = kind in ("quantity", "unknown_key", "missing_key", "table", "inconsistent")
    return message if plain else f"{message}, found {found}"


def one_line(error: ValidationError, data: object) -> str:
    """Turn pydantic's report into one line: the first problem, and where the others are.

    Parameters
    ----------
    error : pydantic.ValidationError
        What pydantic found.
    data : object
        What was validated.
    """
    problems = error.errors(include_url=False)
    paths = [field_path(problem, data) for problem in problems]
    text = f"{paths[0]}: {_reason(problems[0])}" if paths[0] else _reason(problems[0])
    others = [path for path in dict.fromkeys(paths) if path not in ("", paths[0])]
    if others:
        text += f" (also wrong: {', '.join(others[:3])}{' ...' if len(others) > 3 else ''})"
    return " ".join(text.split())


def nested(model: type[ModelType], key: str, table: object) -> ModelType:
    """Validate a table inside another one; for use in model validators.

    Parameters
    ----------
    model : type of InputModel
    key : str
        Where the table stands in the other.
    table : object
        The table, or the model itself.
    """
    try:
        return model.model_validate(table)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        path = ".".join(filter(None, (key, field_path(first, table))))
        raise inconsistent(_reason(first), path) from None


def validated(model: type[ModelType], data: object, where: str) -> ModelType:
    """Validate a table into a model.

    Parameters
    ----------
    model : type of InputModel
        The model.
    data : object
        The table.
    where : str
        File (and section) for the message.

    Raises
    ------
    InputError
        Naming the field, what was found and what to write.
    """
    try:
        return model.model_validate(data)
    except ValidationError as error:
        raise InputError(f"{where}: {one_line(error, data)}") from None


def inconsistent(message: str, key: str | None = None) -> PydanticCustomError:
    """Make the error for fields that do not fit together; for use in model validators.

    Parameters
    ----------
    message : str
        What is wrong and what to do.
    key : str, optional
        The field, as a path inside the model.
    """
    context: dict[str, Any] = {"reason": message}
    if key:
        context["key"] = key
    return PydanticCustomError("inconsistent", "{reason}", context)
