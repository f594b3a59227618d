"""Tables laid over one another: a preset's values below, a case's own above, overrides on top.

What belongs to which key, such as that one of two excludes the other, is said by the marks of the
models' fields (`railquake.inputs.marks`).
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any, ClassVar, TypeVar

from railquake.errors import InputError
from railquake.inputs.marks import AsText, File, Place, holds
from railquake.inputs.model import InputModel, validated
from railquake.inputs.toml import is_path, read_toml, split_override
from railquake.messages import did_you_mean, toml_type

__all__ = [
    "FromPreset",
    "Overrides",
    "has_presets",
    "merged",
    "preset_names",
    "preset_path",
    "resolved",
    "with_absolute_paths",
    "with_overrides",
]

Overrides = Iterable[str] | Mapping[str, Any]
_DEEPEST_CHAIN = 8
_FOLDER = resources.files("railquake.inputs") / "presets"

Preset = TypeVar("Preset", bound="FromPreset")


class FromPreset(InputModel):
    """Base of the models of which parameter sets are published."""

    section: ClassVar[str]
    """Its section of a case file, and the folder of its presets."""

    @classmethod
    def from_preset(
        cls: type[Preset], preset: str, overrides: Mapping[str, Any] | None = None
    ) -> Preset:
        """Make one from a preset.

        Parameters
        ----------
        preset : str
            A built-in name or the path of a TOML file.
        overrides : mapping, optional
            Values to change, as they would stand in the case file's table.

        Raises
        ------
        InputError
            If there is no such preset or the values do not go together.
        """
        table = resolved(cls.section, Place((cls,)), {"preset": preset, **(overrides or {})})
        return validated(cls, table, cls.section)


def has_presets(place: Place) -> bool:
    """Whether what stands somewhere may build on a preset."""
    return not place.by_name and any(issubclass(model, FromPreset) for model in place.models)


@cache
def preset_names(kind: str) -> tuple[str, ...]:
    """Names of the built-in presets of a kind, in order of the alphabet.

    Parameters
    ----------
    kind : str
        Section of the case file.
    """
    files = (entry.name for entry in (_FOLDER / kind).iterdir())
    return tuple(sorted(name[: -len(".toml")] for name in files if name.endswith(".toml")))


def preset_path(kind: str, name: str) -> Path:
    """Path of a built-in preset's file.

    Parameters
    ----------
    kind : str
        Section of the case file.
    name : str
        Name of the preset.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If there is no such preset; lists those there are.
    """
    names = preset_names(kind)
    if name not in names:
        raise InputError(
            f'unknown {kind} preset "{name}"; {did_you_mean(name, names)}; '
            "a file is written with its ending, e.g. my-set.toml"
        )
    return Path(str(_FOLDER / kind / f"{name}.toml"))


def resolved(
    kind: str,
    place: Place,
    table: Mapping[str, Any],
    folder: Path | None = None,
    where: str | None = None,
) -> dict[str, Any]:
    """Lay a section of a case over the preset it names.

    Parameters
    ----------
    kind : str
        Which section it is.
    place : Place
        What may stand there.
    table : mapping
        The section, with or without ``preset``.
    folder : Path, optional
        Folder against which the section's paths are resolved; the working folder by default.
    where : str, optional
        File and section for messages.

    Returns
    -------
    dict
        The whole section without ``preset``, its paths absolute; not yet validated.

    Raises
    ------
    InputError
        If there is no such preset, its file cannot be read, or presets build on each other in a
        circle.
    """
    where = kind if where is None else where
    return _resolved(kind, place, table, Path.cwd() if folder is None else folder, where, 0)


def _resolved(
    kind: str, place: Place, table: Mapping[str, Any], folder: Path, where: str, depth: int
) -> dict[str, Any]:
    own = with_absolute_paths(table, folder, place)
    preset = own.pop("preset", None)
    if preset is None:
        return own
    if not isinstance(preset, str):
        raise InputError(
            f"{where}.preset: must be a name or a path, found {toml_type(preset)}; "
            f'write e.g. preset = "{preset_names(kind)[0]}"'
        )
    if depth == _DEEPEST_CHAIN:
        raise InputError(f"{where}.preset: presets build on each other without end")
    try:
        path = Path(preset) if is_path(preset) else preset_path(kind, preset)
        base = read_toml(path)
    except InputError as error:
        raise InputError(f"{where}.preset: {error}") from None
    below = _resolved(kind, place, base, path.parent, str(path), depth + 1)
    return merged(below, own, place)


def with_absolute_paths(table: Mapping[str, Any], folder: Path, place: Place) -> dict[str, Any]:
    """Make the paths of files in a table, and in those inside it, absolute.

    Parameters
    ----------
    table : mapping
        A section of a case, or all of them.
    folder : Path
        What its relative paths start from.
    place : Place
        What may stand there.

    Returns
    -------
    dict
        A copy, in which a text that stands for a table has become that table.
    """
    result = dict(table)
    for key, value in table.items():
        if isinstance(value, os.PathLike):
            value = os.fspath(value)
        is_preset = key == "preset" and has_presets(place)
        as_text = place.mark(key, AsText)
        if as_text is not None and isinstance(value, str):
            value = as_text.read(value)
        if isinstance(value, str) and value:
            if place.mark(key, File) is not None or (is_preset and is_path(value)):
                result[key] = str((folder / value).absolute())
            elif is_preset:
                result[key] = value
        elif isinstance(value, Mapping | list | tuple) and _names_files(place.below(key)):
            result[key] = _inside(value, folder, place.below(key))
    return result


def _names_files(place: Place) -> bool:
    return has_presets(place) or any(holds(model, File) for model in place.models)


def _inside(value: Any, folder: Path, place: Place) -> Any:
    if isinstance(value, Mapping):
        return with_absolute_paths(value, folder, place)
    one = Place(place.models)
    return [
        with_absolute_paths(item, folder, one) if isinstance(item, Mapping) else item
        for item in value
    ]


def merged(base: Mapping[str, Any], over: Mapping[str, Any], place: Place) -> dict[str, Any]:
    """Lay one table over another, table by table.

    Parameters
    ----------
    base : mapping
        What is overridden.  A list of tables with names may be overridden by a table of tables.
    over : mapping
        What wins.
    place : Place
        What may stand there.

    Returns
    -------
    dict
        New; the arguments are left alone.
    """
    result = dict(base)
    for group in place.alternatives():
        if any(key in over for key in group):
            for key in group:
                result.pop(key, None)
    for key, value in over.items():
        old = base.get(key)
        if isinstance(value, Mapping) and isinstance(old, list | tuple) and _all_named(old):
            old = {item["name"]: item for item in old}
        whole = place.mark(key, AsText) is not None
        if isinstance(value, Mapping) and isinstance(old, Mapping) and not whole:
            result[key] = merged(old, value, place.below(key))
        else:
            result[key] = value
    return result


def _all_named(items: Sequence[Any]) -> bool:
    return all(isinstance(i, Mapping) and isinstance(i.get("name"), str) for i in items)


def with_overrides(
    data: Mapping[str, Any], overrides: Overrides, place: Place, where: str = "--set"
) -> dict[str, Any]:
    """Override single values of a case by their paths.

    Parameters
    ----------
    data : mapping
        The case's tables.
    overrides : iterable of str, or mapping
        ``"motion.scale=1.5"``: the value is read as TOML, or, where it is none, as a text
        (``"support.length=7 m"``).  Or paths and values: ``{"motion.scale": 1.5}``.
    place : Place
        What may stand there.
    where : str
        What to call their origin in messages.

    Returns
    -------
    dict
        New; the arguments are left alone.

    Raises
    ------
    InputError
        If there is no path, or it leads through something that is not a table.
    """
    pairs = overrides.items() if isinstance(overrides, Mapping) else map(split_override, overrides)
    result = dict(data)
    # Presets first, so that the order in which values are given does not matter.
    for path, value in sorted(pairs, key=lambda pair: not pair[0].endswith(".preset")):
        steps = [step.strip() for step in path.split(".")]
        if not all(steps):
            raise InputError(
                f'{where}: "{path}" is no path of a value; write e.g. motion.scale=1.5'
            )
        section = steps[0]
        if steps[1:] == ["preset"] and _is_whole(result.get(section), place.below(section)):
            result[section] = {}
        over: Any = value
        for step in reversed(steps):
            over = {step: over}
        _refuse_inside_a_value(result, steps, f"{where}: {path}")
        result = merged(result, over, place)
    return result


def _refuse_inside_a_value(tables: Mapping[str, Any], steps: list[str], where: str) -> None:
    here: Any = tables
    for depth, step in enumerate(steps[:-1]):
        if not isinstance(here, Mapping):
            return
        here = here.get(step, {})
        listed = isinstance(here, list | tuple) and _all_named(here)
        if not isinstance(here, Mapping) and not listed:
            raise InputError(
                f"{where}: {'.'.join(steps[: depth + 1])} is not a table, "
                "so nothing inside it can be set"
            )


def _is_whole(section: Any, place: Place) -> bool:
    """Whether a section needs no preset: its values would hide all of one set over it."""
    if not isinstance(section, Mapping) or "preset" in section:
        return False
    return "name" in section or not has_presets(place.of_kind(section))
