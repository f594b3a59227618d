"""Reading the axes of a study file, and how they are sampled."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from railquake.errors import InputError
from railquake.inputs.fields import Input, input_at
from railquake.inputs.units import to_si
from railquake.messages import did_you_mean, shown, toml_type
from railquake.study.axes import Axis, DistributionAxis, ListAxis, Variant, VariantAxis
from railquake.study.distributions import DISTRIBUTIONS, METHODS, Sampling

__all__ = ["parse_axes", "parse_sampling"]

MOST_SAMPLES = 10_000_000


def parse_axes(tables: Any, folder: Path, where: str) -> tuple[Axis, ...]:
    """Read the section ``[axes]``.

    Parameters
    ----------
    tables : mapping
        Lists, lists of named variants and distributions by path.
    folder : Path
        What relative paths of files start from.
    where : str
        File and section for messages.

    Raises
    ------
    InputError
        Naming the axis, what was found and what to write.
    """
    if not isinstance(tables, Mapping):
        raise InputError(f"{where}: must be a table, found {toml_type(tables)}")
    axes: list[Axis] = []
    taken: dict[str, str] = {}
    for path, value in _flat(tables):
        here = f"{where}.{path}"
        axis = _axis(path, value, folder, here)
        new = axis.paths if isinstance(axis, VariantAxis) else {axis.path}
        if any(other.column == axis.column for other in axes):
            raise InputError(f"{here}: there is an axis {axis.column} already; join their values")
        for name in sorted(new):
            if name in taken:
                raise InputError(
                    f"{here}: {name} is set by the axis {taken[name]} already; an input belongs "
                    "to one axis"
                )
            taken[name] = axis.column
        axes.append(axis)
    return tuple(axes)


def _flat(tables: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Axes by their paths, whether these are written as one key or as tables in tables."""
    for key, value in tables.items():
        path = f"{prefix}{key}"
        if isinstance(value, Mapping) and "distribution" not in value:
            yield from _flat(value, f"{path}.")
        else:
            yield path, value


def _axis(path: str, value: Any, folder: Path, where: str) -> Axis:
    if isinstance(value, Mapping):
        return _distribution_axis(path, value, where)
    if not isinstance(value, list | tuple):
        raise InputError(
            f"{where}: must be a list of values, named variants or a distribution, found "
            f"{toml_type(value)}; write e.g. [{shown(value)}]"
        )
    if not value:
        raise InputError(f"{where}: the list is empty, so there is nothing to run")
    if all(isinstance(item, Mapping) and "name" in item and "set" in item for item in value):
        return _variant_axis(path, value, folder, where)
    if all(isinstance(item, Mapping) and {"name", "set"} & set(item) for item in value):
        raise InputError(
            f'{where}: each variant needs name and set, as in name = "elastic", '
            'set = { "support.hinge" = "elastic" }'
        )
    known = input_at(path, where)
    values = [_value(known, item, folder, where) for item in value]
    for k, one in enumerate(values):
        if one in values[:k]:
            raise InputError(f"{where}: the value {shown(value[k])} is there twice; take one out")
    kind = known.kind
    if kind == "any" and all(isinstance(item, str) for item in values):
        kind = "text"
    return ListAxis(path, tuple(values), kind)


def _value(known: Input, value: Any, folder: Path, where: str) -> Any:
    """A value in SI units, its path absolute."""
    if isinstance(value, Path):
        value = str(value)
    return known.absolute(known.in_si(value, where), folder)


def _variant_axis(name: str, items: Sequence[Any], folder: Path, where: str) -> VariantAxis:
    variants: list[Variant] = []
    for item in items:
        label, changes = item["name"], item["set"]
        if not isinstance(label, str) or not label.strip():
            raise InputError(f"{where}: a variant's name must be a text, found {toml_type(label)}")
        here = f"{where}.{label}"
        _refuse_unknown(item, ("name", "set"), here)
        if label in [variant.name for variant in variants]:
            raise InputError(f"{where}: two variants are called {label}; names must differ")
        if not isinstance(changes, Mapping):
            raise InputError(
                f"{here}.set: must be a table of paths and values, found {toml_type(changes)}; "
                'write e.g. set = { "support.hinge" = "elastic" }'
            )
        known = {path: input_at(path, here) for path, _ in _leaves(changes)}
        values = {path: _value(known[path], v, folder, here) for path, v in _leaves(changes)}
        variants.append(Variant(label, values))
    return VariantAxis(name, tuple(variants))


def _leaves(changes: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for key, value in changes.items():
        if isinstance(value, Mapping):
            yield from _leaves(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def _distribution_axis(path: str, table: Mapping[str, Any], where: str) -> DistributionAxis:
    known = input_at(path, where)
    name = table["distribution"]
    if not isinstance(name, str) or name not in DISTRIBUTIONS:
        advice = did_you_mean(name, DISTRIBUTIONS)
        raise InputError(f"{where}: unknown distribution {shown(name)}; {advice}")
    if known.kind not in ("number", "integer"):
        raise InputError(f"{where}: takes no numbers, so it has no distribution; write a list")
    if (known.kind == "integer") != (name == "integers"):
        wanted = "integers" if known.kind == "integer" else "one of real numbers"
        raise InputError(f"{where}: the distribution must be {wanted}, found {shown(name)}")
    wanted_parameters = DISTRIBUTIONS[name].parameters
    given = [key for key in table if key != "distribution"]
    _refuse_unknown(given, wanted_parameters, where)
    for key in wanted_parameters:
        if key not in given:
            raise InputError(f"{where}: {key} is missing; {name} has {_listed(wanted_parameters)}")
    parameters: dict[str, float] = {}
    for key, kind in wanted_parameters.items():
        value, here = table[key], f"{where}.{key}"
        if known.kind == "integer":
            parameters[key] = known.in_si(value, here)
        else:
            dimension = known.dimension if kind == "value" else "number"
            parameters[key] = to_si(value, dimension or "number", here)
    fault = DISTRIBUTIONS[name].fault(**parameters)
    if fault is not None:
        raise InputError(f"{where}: {fault}")
    return DistributionAxis(path, name, parameters, known.kind)


def _refuse_unknown(keys: Iterable[str], known: Collection[str], where: str) -> None:
    for key in keys:
        if key not in known:
            raise InputError(f"{where}: unknown key {key}; {did_you_mean(key, known)}")


def _listed(names: Mapping[str, Any]) -> str:
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last


def parse_sampling(table: Any, axes: Sequence[Axis], where: str) -> Sampling | None:
    """Read the section ``[sampling]``.

    Parameters
    ----------
    table : mapping or None
        With ``method``, ``count`` and ``seed``.
    axes : sequence of Axis
        Of the study.
    where : str
        File and section for messages.

    Raises
    ------
    InputError
        If it is missing where distributions are to be sampled, there where none are, or wrong.
    """
    example = 'method = "latin-hypercube", count = 64, seed = 1'
    wanted = [axis.path for axis in axes if isinstance(axis, DistributionAxis)]
    if table is None:
        if wanted:
            raise InputError(f"{where}: is missing, {wanted[0]} is to be sampled; write {example}")
        return None
    if not isinstance(table, Mapping):
        raise InputError(f"{where}: must be a table, found {toml_type(table)}; write {example}")
    if not wanted:
        raise InputError(f"{where}: no axis is a distribution, so there is nothing to sample")
    _refuse_unknown(table, ("method", "count", "seed"), where)
    method = table.get("method", METHODS[0])
    if method not in METHODS:
        advice = did_you_mean(method, METHODS)
        raise InputError(f"{where}.method: unknown method {shown(method)}; {advice}")
    numbers = {"count": table.get("count"), "seed": table.get("seed", 0)}
    for key, least, most in (("count", 1, MOST_SAMPLES), ("seed", 0, 2**63 - 1)):
        value = numbers[key]
        whole = isinstance(value, int) and not isinstance(value, bool)
        if not whole or not least <= value <= most:
            found = "nothing" if value is None else shown(value)
            raise InputError(
                f"{where}.{key}: must be a whole number from {least} to {most}, found {found}"
            )
    count = int(numbers["count"] or 0)
    if method == "sobol" and count & (count - 1):
        below = 2 ** int(math.log2(count))
        raise InputError(
            f"{where}.count: must be a power of two for sobol, found {count}; take {below} or "
            f"{2 * below}"
        )
    return Sampling(method, count, int(numbers["seed"] or 0))
