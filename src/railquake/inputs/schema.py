"""The JSON Schema of a case file, with which an editor completes and checks it."""

from __future__ import annotations

from typing import Any

from railquake.inputs.presets import preset_names
from railquake.inputs.scenario import Scenario


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
    for item in ("Body", "Spring", "Dashpot"):
        definitions[item]["properties"].pop("name")
    for key, item in (("bodies", "Body"), ("springs", "Spring"), ("dashpots", "Dashpot")):
        old = definitions["Vehicle"]["properties"][key]
        definitions["Vehicle"]["properties"][key] = {
            "description": old.get("description", "") + ", by name",
            "type": "object",
            "additionalProperties": {"$ref": f"#/$defs/{item}"},
        }
    for key in ("wheel", "rail"):
        old = definitions["WheelRail"]["properties"][key]
        definitions["WheelRail"]["properties"][key] = {
            "description": old.get("description", ""),
            "anyOf": [{"type": "string"}, {"$ref": "#/$defs/ProfileSpec"}],
        }
    pier = definitions.pop("Pier")
    for other in ("AtGrade", "PrescribedTrack"):
        pier["properties"] = {**definitions.pop(other)["properties"], **pier["properties"]}
    pier["properties"]["kind"] = {"enum": ["pier", "at-grade", "prescribed"]}
    definitions["Support"] = {**pier, "title": "Support"}
    schema["properties"]["support"] = {"$ref": "#/$defs/Support"}
    for kind, title in (("vehicle", "Vehicle"), ("support", "Support"), ("wheelrail", "WheelRail")):
        definitions[title]["properties"]["preset"] = {
            "type": "string",
            "description": "A built-in set or the path of a TOML file; keys beside it win",
            "examples": list(preset_names(kind)),
        }
    schema.pop("required", None)
    schema.pop("description", None)
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema"
    schema["title"] = "railquake case file"
    return schema
