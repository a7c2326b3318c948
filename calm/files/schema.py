"""The JSON Schema of the mooring file, for editors that complete and check while one types.

It is made from the models that read the file. It knows the keys, the kinds and that a quantity has
a unit; what needs the catalogue or several fields at once is left to the reader.
"""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

from calm.files.catalogue import Assembly
from calm.files.components import KINDS
from calm.files.environment import EnvironmentKeys, TowEnvironmentKeys, UniformCurrent
from calm.files.fields import LENGTH
from calm.files.line import MOST_PIECES
from calm.files.logbook import Equipment, LengthAt
from calm.files.reader import MooringKeys
from calm.files.schema_words import EXAMPLES, MEANINGS

Schema = dict[str, Any]


def mooring_schema() -> Schema:
    """The JSON Schema (draft 2020-12) of a mooring file."""
    models: list[type[BaseModel]] = [MooringKeys, EnvironmentKeys, TowEnvironmentKeys, Assembly]
    models += [*KINDS.values(), Equipment, LengthAt]
    UniformCurrent.model_rebuild()  # a default is written by its model, which pydantic builds late
    names, definitions = models_json_schema(
        [(model, "validation") for model in models], ref_template="#/$defs/{model}"
    )
    refs = {model: names[(model, "validation")] for model in models}
    schemas: dict[str, Schema] = definitions["$defs"]
    component = {"oneOf": [refs[model] for model in (*KINDS.values(), Assembly)]}
    fields = _fields([schemas[kind.__name__] for kind in KINDS.values()])
    fields |= schemas.pop("Equipment")["properties"]
    schemas |= {"Clamp": _clamp(fields), "Item": _item(fields, refs[LengthAt])}
    items = {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/Item"}}
    schemas["Assembly"]["properties"]["parts"] = dict(items)
    variant = {key: value for key, value in schemas["EnvironmentKeys"].items() if key != "required"}
    top = schemas.pop("MooringKeys")
    top["properties"] |= {
        "environment": {"type": "object"},
        "line": items,
        "components": {"type": ["object", "null"], "additionalProperties": component},
        "environments": {
            "type": ["object", "null"],
            "additionalProperties": {"anyOf": [refs[TowEnvironmentKeys], variant]},
        },
    }
    # Only a tow may do without an environment, or without a depth in it; a variant always may.
    top["required"] = ["line"]
    top["if"] = {"required": ["tow"]}
    top["then"] = {"properties": {"environment": refs[TowEnvironmentKeys]}}
    top["else"] = {
        "properties": {"environment": refs[EnvironmentKeys]},
        "required": ["environment"],
    }
    schema = {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        **top,
        "title": "CALM mooring file",
        "$defs": schemas,
    }
    _tidy(schema)
    return schema


def _item(fields: Schema, length_at: Schema) -> Schema:
    fit = {"anyOf": [{"const": "fit"}, LENGTH.json_schema()]}
    count = {"type": "integer", "minimum": 1, "maximum": MOST_PIECES}
    clamps = {"type": "array", "items": {"$ref": "#/$defs/Clamp"}}
    depths = {"top_depth": LENGTH.json_schema(), "body_depth": LENGTH.json_schema()}
    measured = {"description": MEANINGS["length_at"], **length_at}
    own = {"count": count, "length": fit, "length_at": measured, **depths, "clamps": clamps}
    return _mapping("A piece of the line; other fields override the component's.", fields | own)


def _clamp(fields: Schema) -> Schema:
    schema = _mapping("An instrument fixed to a piece.", fields | {"at": LENGTH.json_schema()})
    schema["required"].append("at")
    return schema


def _mapping(description: str, properties: Schema) -> Schema:
    text = {"type": "string"}
    return {
        "type": "object",
        "description": description,
        "properties": {"use": text, "label": {"type": ["string", "number"]}, **properties},
        "required": ["use"],
        "additionalProperties": False,
    }


def _fields(schemas: list[Schema]) -> Schema:
    """Every field that can be overridden; where kinds differ, either form."""
    forms: dict[str, list[Schema]] = {}
    for schema in schemas:
        for name, form in schema["properties"].items():
            if name != "kind" and form not in forms.setdefault(name, []):
                forms[name].append(form)
    return {
        name: found[0] if len(found) == 1 else {"anyOf": found} for name, found in forms.items()
    }


def _tidy(schema: Any, model: str = "") -> None:
    """Say what fields are, with an example, and leave out defaults (in SI) and titles."""
    if isinstance(schema, list):
        for part in schema:
            _tidy(part, model)
    if not isinstance(schema, dict):
        return
    for name, field in schema.get("properties", {}).items():
        field.pop("title", None)
        field.pop("default", None)
        for keyword, words in (("description", MEANINGS), ("examples", EXAMPLES)):
            said = words.get(f"{model}.{name}", words.get(name))
            if said is not None:
                field[keyword] = [said] if keyword == "examples" else said
    for name, part in schema.items():
        if name == "$defs":
            for model_of_part, definition in part.items():
                _tidy(definition, model_of_part)
        elif name != "examples":
            _tidy(part, model)
