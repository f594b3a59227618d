"""Published parameter sets, one TOML file each, and how a case file builds on them.

A table with ``preset = "name"`` (built in) or ``preset = "my/file.toml"`` (beside the case file)
starts from that file's values; the keys beside it win.  A preset file may itself build on another
one.  Every built-in set carries its `source` and a `note` on how far it can be trusted.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from railquake.errors import InputError
from railquake.inputs import layers
from railquake.inputs.layers import preset_names
from railquake.inputs.marks import Place
from railquake.inputs.scenario import Scenario
from railquake.messages import did_you_mean

__all__ = ["KINDS", "PresetInfo", "list_presets", "preset_names", "preset_path", "resolved_section"]

_PLACE = Place((Scenario,))
KINDS = tuple(key for key in Scenario.model_fields if layers.has_presets(_PLACE.below(key)))
"""Sections of a case file of which there are presets."""


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
    return layers.preset_path(kind, name)


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
    """Lay a section of a case over the preset it names, see `layers.resolved`.

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
    return layers.resolved(kind, _PLACE.below(kind), table, folder, where)
