"""JSON Schema of the mooring file, for completion and checks in text editors.

Conditions that involve the catalogue or several keys are checked only by the reader.
"""

from collections.abc import Iterable
from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import models_json_schema

from calm.files.catalogue import Assembly
from calm.files.components import KINDS, Component
from calm.files.definition import LENGTH, quantity_of
from calm.files.environment import EnvironmentKeys, TowEnvironmentKeys, UniformCurrent
from calm.files.item_keys import ClampKeys, ItemKeys
from calm.files.reader import MooringKeys

Schema = dict[str, Any]

_NO_FORM = ("description", "examples", "default", "title")
"""Keys in the JSON Schema of a field that do not restrict the value of the field."""


def mooring_schema() -> Schema:
    """Return the JSON Schema (draft 2020-12) of a mooring file."""
    models: list[type[BaseModel]] = [MooringKeys, EnvironmentKeys, TowEnvironmentKeys, Assembly]
    models += [*KINDS.values(), ItemKeys, ClampKeys]
    UniformCurrent.model_rebuild()  # pydantic builds models late, but needs this one for a default
    names, definitions = models_json_schema(
        [(model, "validation") for model in models], ref_template="#/$defs/{model}"
    )
    refs = {model: names[(model, "validation")] for model in models}
    schemas: dict[str, Schema] = definitions["$defs"]
    fields = _fields(KINDS.values(), schemas)
    completed = {"type": "object", "properties": fields, "additionalProperties": False}
    component = {"oneOf": [*(refs[model] for model in (*KINDS.values(), Assembly)), completed]}
    schemas |= {"Clamp": schemas.pop("ClampKeys"), "Item": schemas.pop("ItemKeys")}
    own = schemas["Item"]["properties"]
    own["length"] = fields["length"] | {"anyOf": [{"const": "fit"}, LENGTH.json_schema()]}
    own["clamps"]["items"] = {"$ref": "#/$defs/Clamp"}
    for part in ("Clamp", "Item"):  # other fields override the component
        schemas[part]["properties"] = fields | schemas[part]["properties"]
        del schemas[part]["title"]
    schemas["Item"]["required"] = ["use"]
    items = {"type": "array", "minItems": 1, "items": {"$ref": "#/$defs/Item"}}
    parts = schemas["Assembly"]["properties"]
    parts["parts"] = items | _words_of(parts["parts"])
    variant = {key: value for key, value in schemas["EnvironmentKeys"].items() if key != "required"}
    top = schemas.pop("MooringKeys")
    known = top["properties"]
    forms: dict[str, Schema] = {
        "environment": {"type": "object"},
        "line": items,
        "components": {"type": ["object", "null"], "additionalProperties": component},
        "environments": {
            "type": ["object", "null"],
            "additionalProperties": {"anyOf": [refs[TowEnvironmentKeys], variant]},
        },
    }
    known |= {name: form | _words_of(known[name]) for name, form in forms.items()}
    # Only a tow may have no environment, or one without a depth. A variant may always have no
    # depth.
    del top["required"]
    top["oneOf"] = [{"required": ["line"]}, {"required": ["legs"]}]
    leg = schemas["LegKeys"]["properties"]
    leg["line"] = items | _words_of(leg["line"])
    top["if"] = {"required": ["tow"]}
    water = _words_of(known["environment"])
    top["then"] = {"properties": {"environment": refs[TowEnvironmentKeys] | water}}
    top["else"] = {
        "properties": {"environment": refs[EnvironmentKeys] | water},
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


def _words_of(form: Schema) -> Schema:
    return {key: form[key] for key in ("description", "examples") if key in form}


def _fields(kinds: Iterable[type[Component]], schemas: Schema) -> Schema:
    """Merge the schemas of the component fields of all kinds.

    If a field has different schemas in different kinds, any of these schemas is allowed.
    """
    forms: dict[str, list[Schema]] = {}
    words: dict[str, Schema] = {}
    for kind in kinds:
        for name, schema in schemas[kind.__name__]["properties"].items():
            form = {key: part for key, part in schema.items() if key not in _NO_FORM}
            quantity = quantity_of(kind.model_fields[name])
            if quantity and "anyOf" in form and {"type": "null"} not in form["anyOf"]:
                form = quantity.json_schema()
            words.setdefault(name, _words_of(schema))
            if name != "kind" and form not in forms.setdefault(name, []):
                forms[name].append(form)
    return {
        name: (found[0] if len(found) == 1 else {"anyOf": found}) | words[name]
        for name, found in forms.items()
        if found
    }


def _tidy(schema: Any) -> None:
    if isinstance(schema, list):
        for part in schema:
            _tidy(part)
    if isinstance(schema, dict):
        for field in schema.get("properties", {}).values():
            field.pop("title", None)
            field.pop("default", None)  # defaults are in SI units
        for name, part in schema.items():
            if name != "examples":
                _tidy(part)
