"""Reference pages made from what they describe, so that they cannot drift.

Input models, presets, measures, the rows of state and constants, the slots of the march.
"""

import sys
import typing
from types import SimpleNamespace

from pydantic_core import PydanticUndefined

from railquake.inputs import motion, solver, support, vehicle, wheelrail
from railquake.inputs.ground_motion import SyntheticParameters
from railquake.inputs.layers import FromPreset
from railquake.inputs.marks import AsText, ByName, KnownLaw, marked, models_in
from railquake.inputs.presets import list_presets
from railquake.inputs.schema import json_schema as schema
from railquake.inputs.units import DIMENSIONS, UNIT_DEFINITIONS, Quantity

__all__ = ["case_file", "channels", "measures", "presets", "rows", "schema", "slots"]

# What the page adds to the title and the words of some kinds of support.
KINDS_OF_SUPPORT = {
    "pier": ("", ", the default. `preset` as above."),
    "at-grade": (
        ", no structure",
        ". A pier's keys beside it are left out without complaint, so that one case serves for "
        "both.",
    ),
    "prescribed": (", known motion", "."),
}
TABLES_OF_SUPPORTS = {"bouc_wen": "See [Bouc-Wen hinge](../theory/boucwen.md)."}


def supports():
    """The section of every kind of support, and those of its tables."""
    for kind, model in support.SUPPORTS.items():
        title, note = KINDS_OF_SUPPORT.get(kind, (f", {kind}", "."))
        yield f"[support]{title}", model, f'With `kind = "{kind}"`{note}'
        for key, field in model.model_fields.items():
            for table in models_in(field.annotation):
                yield f"[support.{key}]", table, TABLES_OF_SUPPORTS.get(key, "")


def parts_of_vehicles():
    """The sections of what a vehicle has several of, each by its name."""
    for key in marked(vehicle.Vehicle, ByName):
        field = vehicle.Vehicle.model_fields[key]
        for part in models_in(field.annotation):
            yield f"[vehicle.{key}.NAME]", part, f"{field.description}, one table for each."


# Where each model stands in a case file, and what the page says of it.
SECTIONS = (
    ("[vehicle]", vehicle.Vehicle, "`preset` is a built-in name or a file; keys beside it win."),
    *parts_of_vehicles(),
    *supports(),
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
# These are named by their table.
NAMED = [
    item
    for _, model, _ in SECTIONS
    for key in marked(model, ByName)
    for item in models_in(model.model_fields[key].annotation)
]


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
        if isinstance(mark, KnownLaw):
            return " or ".join(f'`"{law}"`' for law in mark.family.built_in())
        if isinstance(mark, AsText):
            return "text or table"
    origin, arguments = typing.get_origin(annotation), typing.get_args(annotation)
    if origin is typing.Annotated:
        return form(arguments[0], arguments[1:])
    if origin is typing.Literal:
        return " or ".join(f'`"{choice}"`' for choice in arguments)
    if origin is tuple:
        return "list"
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
    if issubclass(model, FromPreset):
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
    from railquake.march.rows import USUAL
    from railquake.run.response import channels as known

    bodies = ("car", "bogie", "wheelset")
    usual = SimpleNamespace(layout=USUAL, vehicle=SimpleNamespace(bodies=bodies))
    rows = [(f"`{found.name}`", found.unit, found.meaning) for found in known(usual)]
    return table(("channel", "unit", "what"), rows)


def measures(kind):
    """Every measure of a kind."""
    from railquake.measures import of_kind, printed

    rows = [
        (f"`{m.key}`", printed(m.unit), ", ".join(dict.fromkeys((m.short, m.caption))), m.meaning)
        for m in of_kind(kind)
    ]
    return table(("key", "unit", "name", "what"), rows)


def row_lines(declared):
    """Lines of a table of rows: each declaration, and below a block its parts."""
    from railquake.measures import printed

    for row in declared:
        count = f"`{row.rows}`" if isinstance(row.rows, str) else str(row.rows)
        train = ("train's" if row.train else "", "leaves" if row.released else "")
        by_itself = row.parts and row.parts[0].name == row.name
        channel = f"`{row.parts[0].channel}`" if by_itself and row.parts[0].channel else ""
        said = ", ".join(filter(None, train))
        yield f"`{row.name}`", count, printed(row.unit), row.meaning, channel, said
        for part in () if by_itself else row.parts:
            channel = f"`{part.channel}`" if part.channel else ""
            yield f"... `{part.name}`", "", printed(part.unit), part.meaning, channel, ""


def rows():
    """Every row of state and constants."""
    from railquake.laws import HINGE_LAWS
    from railquake.march.rows import USUAL, hinge_parts
    from railquake.march.rows_constant import CONSTANT_GROUPS
    from railquake.march.rows_state import STATE_GROUPS

    head = ("row", "rows", "unit", "meaning", "history", "train")
    size = USUAL.size
    lines = [
        "# Rows",
        "",
        "All that a run keeps: the state `S[row, lane]` and the constants `Q[row, lane]`. A lane",
        "is a scenario. This page is made from the declarations: `march/rows_state.py`,",
        "`march/rows_constant.py`, the measures that have a row of their own, and the fields of",
        "the hinge laws' states and parameters.",
        "",
        "- *rows*: how many; a name is a size of the run, such as `DOFS`, three for each body. The",
        "  parts of a block that have names of their own stand below it.",
        "- *history*: the channel that shows it, see [histories](../measures.md#histories).",
        '- *train*: "train\'s": its channel is NaN once the train has left; "leaves": it is set to',
        "  zero then.",
        "",
        f"A car of three bodies on a pier with the Bouc-Wen hinge has {size.STATE_ROWS} rows of",
        f"state and {size.CONSTANT_ROWS} of constants.",
        "",
        "```python",
        "system = rq.assemble(case)",
        "state = system.layout.state  # numbers of the rows of this run",
        "system.start[state.LOAD_LEFT, 0]  # N",
        'system.layout.state_blocks["VEHICLE_X"]  # a slice',
        "```",
        "",
    ]
    for title, groups, fields, columns in (
        ("State", STATE_GROUPS, lambda law: type(law.virgin), 6),
        ("Constants", CONSTANT_GROUPS, lambda law: law.parameter_fields, 4),
    ):
        lines += [f"## {title}", ""]
        laws = {
            f"hinge law {name}": (hinge_parts("HINGE", fields(HINGE_LAWS[name])),)
            for name in HINGE_LAWS.built_in()
        }
        for name, declared in {**groups, **laws}.items():
            shown = [line[:columns] for line in row_lines(declared) if line[1] != "0"]
            # a heading of its own: two groups may have one name
            lines += [f"### {title}: {name}", ""]
            lines += [table(head[:columns], shown)] if shown else ["None.", ""]
    return "\n".join(lines)


def reference(function):
    """A function's name, linked where the reference has it."""
    name = f"{function.__module__}.{function.__name__}"
    known = function.__name__ in getattr(sys.modules.get(function.__module__), "__all__", ())
    shown = name.removeprefix("railquake.")
    return f"{{py:func}}`{shown} <{name}>`" if known else f"`{shown}`"


def summary(function):
    """First line of a docstring, without what is said of the slot itself."""
    first = (function.__doc__ or "").strip().splitlines()[0]
    return first.partition(": ")[2] if first.startswith("Slot of ") else first


def slots():
    """Every slot of the march, and what may stand there."""
    from railquake.laws import HINGE_LAWS
    from railquake.march.slots import SLOTS

    lines = [
        "# Slots",
        "",
        "What may be swapped. The march and the physics call a slot by its neutral name, which by",
        "itself only raises `NotImplementedError`; [`bind`](../theory/kernel.md) puts what was",
        "chosen in its place. This page is made from `SLOTS` in {py:mod}`railquake.march.slots`.",
        "",
        table(
            ("slot", "decided by", "what may stand there"),
            [
                (slot.name, slot.decided_by, ", ".join(f"`{name}`" for name in slot.names()))
                for slot in SLOTS
            ],
        ),
        "Laws from outside the package join those of creep, restitution and hinge by",
        "{py:meth}`Family.add <railquake.laws.Family.add>`; `examples/own_laws.py` has two.",
        "",
    ]
    for slot in SLOTS:
        title = f"{slot.name[0].upper()}{slot.name[1:]}"
        lines += [f"## {title}", "", f"Decided by {slot.decided_by}.", ""]
        neutral = [(reference(function), summary(function)) for function in slot.functions]
        lines += [table(("neutral name", "what it does"), neutral)]
        chosen = [
            (f"`{name}`", reference(law), summary(law), slot.source(name))
            for name in slot.names()
            for law in slot.laws(name).values()
            if law.__doc__  # those made to read and write rows have nothing to say
        ]
        lines += [table(("choice", "what stands there", "which", "source"), chosen)]
        if slot.name != "hinge law":
            continue
        lines += ["`solver.hinge_solve`, and that many run abreast, change it further:", ""]
        further = [
            (f"`{name}`", when, reference(instead))
            for name in slot.names()
            for when, instead in (
                ("linearised", HINGE_LAWS[name].linearised),
                *(("abreast", law) for law in HINGE_LAWS[name].abreast.values()),
            )
            if instead is not None
        ]
        lines += [table(("law", "where", "what stands there instead"), further)]
    return "\n".join(lines)
