"""Reference pages made from the input models and presets themselves, so that they cannot drift."""

import typing

from pydantic_core import PydanticUndefined

from railquake.inputs import hinge, motion, solver, support, vehicle, wheelrail
from railquake.inputs.ground_motion import SyntheticParameters
from railquake.inputs.presets import list_presets
from railquake.inputs.schema import json_schema as schema
from railquake.inputs.units import DIMENSIONS, UNIT_DEFINITIONS, Quantity

__all__ = ["case_file", "channels", "measures", "presets", "schema"]

# Where each model stands in a case file, and what the page says of it.
SECTIONS = (
    ("[vehicle]", vehicle.Vehicle, "`preset` is a built-in name or a file; keys beside it win."),
    ("[vehicle.bodies.NAME]", vehicle.Body, "One table for each rigid body."),
    ("[vehicle.springs.NAME]", vehicle.Spring, "Between points of two bodies."),
    ("[vehicle.dashpots.NAME]", vehicle.Dashpot, "Between points of two bodies."),
    ("[support]", support.Pier, 'With `kind = "pier"`, the default. `preset` as above.'),
    ("[support.bouc_wen]", hinge.BoucWenHinge, "See [Bouc-Wen hinge](../theory/boucwen.md)."),
    (
        "[support], no structure",
        support.AtGrade,
        'With `kind = "at-grade"`. A pier\'s keys beside it are left out without complaint, so '
        "that one case serves for both.",
    ),
    ("[support], known motion", support.PrescribedTrack, 'With `kind = "prescribed"`.'),
    (
        "[wheelrail]",
        wheelrail.WheelRail,
        "`preset` as above. `wheel` and `rail` are a built-in profile's name, a file, or a table:",
    ),
    (
        "[wheelrail.wheel], [wheelrail.rail]",
        wheelrail.ProfileSpec,
        "One of `builtin`, `file` and `segments`. A segment is a table: `kind` (`line`, `arc`, "
        "`polynomial`), `start`, `end`, and for an arc `centre`, `radius` and `concave`; for a "
        "polynomial `coefficients`, `y_start`, `y_end`. Print the preset `bart` for an example.",
    ),
    ("[motion]", motion.Motion, "One of `record`, `synthetic` and `acceleration`."),
    ("[solver]", solver.Solver, ""),
)
# These may build on a preset; these are named by their table.
PRESET = (vehicle.Vehicle, support.Pier, wheelrail.WheelRail)
NAMED = (vehicle.Body, vehicle.Spring, vehicle.Dashpot)


def table(head, rows):
    """A Markdown table."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += [
        "| " + " | ".join(cell.replace("|", r"\|").replace("\n", " ") for cell in row) + " |"
        for row in rows
    ]
    return "\n".join(lines) + "\n"


def form(annotation, metadata=()):
    """What may be written for a field, in a word and an example."""
    for mark in metadata:
        if isinstance(mark, Quantity):
            what = DIMENSIONS[mark.dimension].name.split(" ", 1)[1]
            sign = "" if mark.sign == "any" else f", {mark.sign}"
            example = "" if mark.dimension == "number" else f"; `{mark.example}`"
            return f"{what.removeprefix('plain ')}{sign}{example}"
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if origin is typing.Annotated:
        return form(arguments[0], arguments[1:])
    if origin is typing.Literal:
        return " or ".join(f'`"{choice}"`' for choice in arguments)
    if origin is tuple:
        return "list"
    if annotation is wheelrail.ProfileSpec:
        return "text or table"
    if origin is dict or hasattr(annotation, "model_fields"):
        return "table"
    if arguments:
        kinds = [form(kind) for kind in arguments if kind is not type(None)]
        return " or ".join(dict.fromkeys(kinds))
    return {bool: "`true` or `false`", int: "whole number", str: "text"}.get(annotation, "number")


def default(field):
    """A field's default as it would be written."""
    value = field.get_default()
    if value is PydanticUndefined:
        return "needed"
    if value is None or value == ():
        return ""
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, str):
        return f'`"{value}"`' if value else ""
    return f"`{value:g}`" if isinstance(value, int | float) else ""


def fields(model):
    """Rows of a model's table."""
    rows = [
        (f"`{name}`", form(field.annotation, field.metadata), default(field), field.description)
        for name, field in model.model_fields.items()
        if not (name == "name" and model in NAMED)
    ]
    if model in PRESET:
        rows.insert(0, ("`preset`", "text", "", "A built-in set, or the path of a TOML file"))
    return [(key, kind, value, text or "") for key, kind, value, text in rows]


def case_file():
    """Every key of a case file."""
    lines = [
        "# The case file",
        "",
        "A case is a TOML file with the sections below; `needed` keys may come from a preset. A",
        "quantity is a text with its unit, or a bare number, which is SI, as the defaults are.",
        "",
        "This page is made from the input models. So is a {download}`JSON Schema",
        "<case.schema.json>`, with which an editor completes and checks a case.",
        "",
        "Relative paths start from the folder of the file in which they are written. On the",
        "command line, `--set section.key=value` changes any of them.",
        "",
    ]
    for title, model, note in SECTIONS:
        lines += [f"## {title.replace('[', '&#91;').replace(']', '&#93;')}", ""]
        lines += [note, ""] if note else []
        lines += [table(("key", "what to write", "default", "meaning"), fields(model))]
    lines += ["## motion.synthetic", "", "A motion from a documented stochastic model,"]
    lines += [
        "{py:mod}`railquake.inputs.ground_motion.synthetic`, where the parameters are explained.",
        "",
    ]
    rows = []
    for name, field in SyntheticParameters.__dataclass_fields__.items():
        value = field.default
        rows.append((f"`{name}`", "" if value is None else f"`{value:g}`"))
    lines += [table(("key", "default, SI"), rows)]
    lines += [
        "Without `pga` and `arias_intensity` the motion is scaled to 0.4 g; `strong_duration` is",
        "0.7 of the duration.",
        "",
        "## Units",
        "",
        "Products, quotients and powers of the units below, with the prefixes `µ` (or `u`), `m`,",
        "`c`, `k`, `M`, `G`: `kg m2`, `MN/m`, `N s/m`, `kip-in`. `g` is a gram, except where an",
        "acceleration is wanted: there it is standard gravity, 9.80665 m/s².",
        "",
    ]
    units = []
    for line in UNIT_DEFINITIONS.strip().splitlines():
        parts = [part.strip() for part in line.split(" = ")]
        if not parts[0].endswith("-"):
            units.append(" ".join(f"`{name}`" for name in (*parts[2:], parts[0])))
    return "\n".join([*lines, ", ".join(units), ""])


def presets():
    """Every preset with its provenance."""
    lines = [
        "# Presets",
        "",
        "The parameter sets that ship, each with its source and how far it can be trusted, as",
        "`railquake presets NAME` prints them. A case changes single values beside `preset = ...`;",
        "a file of your own may build on a preset in the same way.",
        "",
    ]
    for preset in list_presets():
        lines += [f"## {preset.kind} {preset.name}", "", preset.summary + ".", ""]
        lines += ["**Source.** " + preset.source, "", "**How far to trust it.** " + preset.note, ""]
        text = preset.path.read_text(encoding="utf-8").rstrip()
        lines += ["```toml", text, "```", ""]
    return "\n".join(lines)


def channels():
    """Every channel of a history."""
    from railquake.run.response import channels as known

    rows = [
        (f"`{name}`", unit, text) for name, _, unit, text in known(("car", "bogie", "wheelset"))
    ]
    return table(("channel", "unit", "what"), rows)


def measures(kind):
    """Every measure of a kind."""
    from railquake.measures import of_kind, printed

    rows = [
        (f"`{m.key}`", printed(m.unit), ", ".join(dict.fromkeys((m.short, m.caption))), m.meaning)
        for m in of_kind(kind)
    ]
    return table(("key", "unit", "name", "what"), rows)
