"""The JSON Schema of a case file, with which an editor completes and checks it."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from railquake.inputs.layers import FromPreset, preset_names
from railquake.inputs.marks import AsText, ByName, marked, models_in
from railquake.inputs.scenario import Scenario
from railquake.inputs.support import SUPPORTS, SupportKind


def json_schema() -> dict[str, Any]:
    """JSON Schema of a case file, for editors.

    Returns
    -------
    dict
        Looser than the checks of :func:`load_scenario`: a preset may supply any value, so nothing
        is required, and what fits together is not checked.
    """
    schema = Scenario.model_json_schema()
    definitions = schema["$defs"]
    for definition in definitions.values():
        definition.pop("required", None)
    sections = [model for f in Scenario.model_fields.values() for model in models_in(f.annotation)]
    for model in sections:
        _as_written(definitions, model)
    _join_supports(schema, definitions)
    for model in sections:
        if issubclass(model, FromPreset):
            title = "Support" if issubclass(model, SupportKind) else model.__name__
            definitions[title]["properties"]["preset"] = {
                "type": "string",
                "description": "A built-in set or the path of a TOML file; keys beside it win",
                "examples": list(preset_names(model.section)),
            }
    schema.pop("required", None)
    schema.pop("description", None)
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["title"] = "railquake case file"
    return schema


def _as_written(definitions: dict[str, Any], model: type[BaseModel]) -> None:
    """Describe things by their names, and tables for which a text may stand, as a case has them."""
    properties = definitions[model.__name__]["properties"]
    for key in marked(model, ByName):
        (item,) = models_in(model.model_fields[key].annotation)
        definitions[item.__name__]["properties"].pop("name")
        properties[key] = {
            "description": properties[key].get("description", "") + ", by name",
            "type": "object",
            "additionalProperties": {"$ref": f"#/$defs/{item.__name__}"},
        }
    for key in marked(model, AsText):
        (item,) = models_in(model.model_fields[key].annotation)
        properties[key] = {
            "description": properties[key].get("description", ""),
            "anyOf": [{"type": "string"}, {"$ref": f"#/$defs/{item.__name__}"}],
        }


def _join_supports(schema: dict[str, Any], definitions: dict[str, Any]) -> None:
    """One table for all kinds of support: an editor need not know what goes with which kind."""
    first, *others = (definitions.pop(model.__name__) for model in SUPPORTS.values())
    for other in others:
        first["properties"] = {**other["properties"], **first["properties"]}
    first["properties"]["kind"] = {"enum": list(SUPPORTS)}
    first["additionalProperties"] = False
    for table, model in next(iter(SUPPORTS.values())).added_tables().items():
        own = model.model_json_schema()
        definitions.update(own.pop("$defs", {}))
        own.pop("required", None)
        first["properties"][table] = own
    definitions["Support"] = {**first, "title": "Support"}
    schema["properties"]["support"] = {"$ref": "#/$defs/Support"}
