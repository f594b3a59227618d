"""Published parameter sets, one TOML file each, and how a case file builds on them.

A table with ``preset = "name"`` (built in) or ``preset = "my/file.toml"`` (beside the case file)
starts from that file's values; the keys beside it win.  A preset file may itself build on another
one.  Every built-in set carries its `source` and a `note` on how far it can be trusted.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

from railquake.errors import InputError
from railquake.inputs.toml import is_path, merged, read_toml
from railquake.inputs.wheelrail import spec_from_text
from railquake.messages import did_you_mean, toml_type

KINDS = ("vehicle", "support", "wheelrail")
_DEEPEST_CHAIN = 8


@dataclass(frozen=True)
class PresetInfo:
    """What a list of presets shows.

    Attributes
    ----------
    kind : str
        ``"vehicle"``, ``"support"`` or ``"wheelrail"``.
    name : str
        As written in a case file.
    summary, source, note : str
        One line; where the values come from; how far they can be trusted.
    path : Path
        The TOML file.
    """

    kind: str
    name: str
    summary: str
    source: str
    note: str
    path: Path


@cache
def preset_names(kind: str) -> tuple[str, ...]:
    """Names of the built-in presets of a kind, in order of the alphabet.

    Parameters
    ----------
    kind : {"vehicle", "support", "wheelrail"}
        Section of the case file.
    """
    folder = resources.files(__package__) / kind
    files = (entry.name for entry in folder.iterdir())
    return tuple(sorted(name[: -len(".toml")] for name in files if name.endswith(".toml")))


def preset_path(kind: str, name: str) -> Path:
    """Path of a built-in preset's file.

    Parameters
    ----------
    kind : {"vehicle", "support", "wheelrail"}
        Section of the case file.
    name : str
        Name of the preset.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If there is no such kind or preset; lists those there are.
    """
    if kind not in KINDS:
        raise InputError(f'unknown kind of preset "{kind}"; {did_you_mean(kind, KINDS)}')
    names = preset_names(kind)
    if name not in names:
        raise InputError(
            f'unknown {kind} preset "{name}"; {did_you_mean(name, names)}; '
            "a file is written with its ending, e.g. my-set.toml"
        )
    return Path(str(resources.files(__package__) / kind / f"{name}.toml"))


def list_presets() -> tuple[PresetInfo, ...]:
    """All built-in presets with their summary, source and note, by kind and name."""
    infos = []
    for kind in KINDS:
        for name in preset_names(kind):
            table = resolved_section(kind, {"preset": name})
            summary, source, note = (
                str(table.get(key, "")).strip() for key in ("summary", "source", "note")
            )
            infos.append(PresetInfo(kind, name, summary, source, note, preset_path(kind, name)))
    return tuple(infos)


def resolved_section(
    kind: str, table: Mapping[str, Any], folder: Path | None = None, where: str | None = None
) -> dict[str, Any]:
    """Lay a section of a case over the preset it names.

    Parameters
    ----------
    kind : {"vehicle", "support", "wheelrail"}
        Which section it is.
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
    return _resolved(kind, table, Path.cwd() if folder is None else folder, where, 0)


def _resolved(
    kind: str, table: Mapping[str, Any], folder: Path, where: str, depth: int
) -> dict[str, Any]:
    own = with_absolute_paths(kind, table, folder)
    preset = own.pop("preset", None)
    if preset is None:
        return own
    if not isinstance(preset, str | os.PathLike):
        raise InputError(
            f"{where}.preset: must be a name or a path, found {toml_type(preset)}; "
            f'write e.g. preset = "{preset_names(kind)[0]}"'
        )
    if depth == _DEEPEST_CHAIN:
        raise InputError(f"{where}.preset: presets build on each other without end")
    preset = os.fspath(preset)
    if is_path(preset):
        path = folder / preset
    else:
        try:
            path = preset_path(kind, preset)
        except InputError as error:
            raise InputError(f"{where}.preset: {error}") from None
    try:
        base = read_toml(path)
    except InputError as error:
        raise InputError(f"{where}.preset: {error}") from None
    return merged(_resolved(kind, base, path.parent, str(path), depth + 1), own)


def with_absolute_paths(kind: str, table: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Make the paths in a section absolute.

    Parameters
    ----------
    kind : str
        Which section it is.
    table : mapping
        The section.
    folder : Path
        What its relative paths start from.

    Returns
    -------
    dict
        A copy.
    """
    result = dict(table)
    if kind == "wheelrail":
        for key in ("wheel", "rail"):
            spec = result.get(key)
            if isinstance(spec, str):
                spec = spec_from_text(spec)
            if isinstance(spec, Mapping):
                result[key] = with_absolute_paths("profile", spec, folder)
    keys = {"profile": ("file",), "support": ("file",), "motion": ("record", "vertical")}
    for key in keys.get(kind, ()):
        value = result.get(key)
        if isinstance(value, os.PathLike):
            value = os.fspath(value)
        if isinstance(value, str) and value:
            result[key] = str((folder / value).absolute())
    return result
