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

Schema = dict[str, Any]

_DESCRIPTIONS = {
    "approved": "by whom",
    "at": "distance from the top of the piece, unstretched",
    "angle_step": "how much a cable may turn from one segment to the next, e.g. 1 deg",
    "battery_until": "day on which its battery is empty, e.g. 2027-06-30",
    "body_depth": "depth wanted in a tow for the lower end of this cable, at the tow's speed",
    "breaking_load": "load at which it breaks, e.g. 40 kN",
    "buoyancy": "net force in sea water of 1025 kg/m^3, positive up (per metre of a cable)",
    "buoy_drag": "of a float at the surface: at its draft, or fully immersed",
    "calibrated": "day of its last calibration, e.g. 2026-03-01",
    "cd": "drag coefficient of `drag_area`",
    "checked": "by whom",
    "clamps": "instruments fixed to this piece",
    "cn": "drag coefficient across the axis",
    "codes": "one text, several, or several by name, e.g. {enable: 0123, release: 4567}",
    "columns": "each a name and its unit: depth m, speed m/s, toward deg; or u m/s, v m/s, w m/s",
    "components": "definitions of your own, used only here",
    "count": "how many of it follow one another in the line",
    "ct": "drag coefficient along the axis",
    "current": "a table, one speed for all depths, or a file",
    "cx": "drag coefficient of a sphere",
    "density": "of the water, or of the material of a component",
    "depth": "water depth, e.g. 1100 m; of fouling, how far down it grows",
    "depth_range": "water depth at low and at high water, e.g. [98 m, 104 m]",
    "depth_rating": "deepest it may be used",
    "deployed": "where and when it was deployed, and what of it differs from the design",
    "diameter": "e.g. 12 mm; of a chain, that of its bar",
    "document": "what the title block of a drawing says",
    "drag_area": "area seen by the current, e.g. 0.12 m^2",
    "drag_measurements": "forces measured at several speeds",
    "elongation": "rows of load over breaking load and strain, e.g. [[0.1, 0.03], [0.3, 0.08]]",
    "environments": "named variants, each overriding keys of `environment`",
    "factor": "what the Cn of every cable is multiplied by, e.g. 1.5",
    "finish": "of the surface of a cable",
    "fluid": "what the line is in: a tow may be in air",
    "fouling": "growth on everything from the surface down, for the design check",
    "friction": "along cables, the law; of an anchor, its coefficient on the seabed",
    "grip": "pull at which its clamp slips along the line, e.g. 1 kN",
    "height": "of the tow point above the water, e.g. 4 m",
    "history": "the revisions, and what each changed",
    "inclination": "whether drag follows the inclination of the piece",
    "kn": "drag across the axis at 1 m/s, e.g. 26 N/(m/s)^2",
    "kt": "drag along the axis at 1 m/s",
    "label": "name of the piece in results; the id when there is none",
    "length": "along the line, unstretched; `fit` cuts a cable to reach a depth",
    "length_at": "a length measured under a load, e.g. {load: 2 kN, length: 480 m}",
    "lift": "of a towed body at 1 m/s, positive up",
    "line": "the pieces from the top to the anchor; in a tow, from the ship to the towed body",
    "made_of": "simple shapes whose drags add up",
    "mass": "in air (per metre of a cable or chain)",
    "max_tilt": "tilt beyond which it is not to be trusted",
    "note": "anything worth knowing",
    "opening_load": "of a release, the greatest under which it opens, e.g. 10 kN",
    "permanent_elongation": "of a rope that has been loaded, at every tension, e.g. 4 %",
    "prefer": "id of the definition of the same thing to use in place of this one",
    "releases": "the codes of each release by its serial number",
    "remark": "anything worth knowing of it",
    "role": "what the piece is for",
    "rows": "values, top to bottom",
    "sampling": "how it samples, as people read it, e.g. every 10 min",
    "searched": "fields that no source prints, though they were looked for",
    "serial": "number of the very thing; of a count, a list of as many",
    "source": "where the figures come from",
    "sources": "by field, where a figure comes from that is not of `source`",
    "stiffness": "EA, the force that would double the length, e.g. 4 MN",
    "strouhal": "frequency of the cable times diameter over the speed across it",
    "strumming": "how much vibration raises the Cn of cables",
    "termination": "how the ends of a cable are made, e.g. swaged sockets",
    "thickness": "of the growth all around, e.g. 20 mm",
    "time": "of the profile wanted, e.g. 2026-03-01T06:00",
    "tolerance": "of the depth of the anchor, as a share of the water depth",
    "top_depth": "depth wanted in still water for the top of the line",
    "tow": "what tows the line, in place of an anchor",
    "toward": "direction it flows or goes to, clockwise from north, e.g. 90 deg",
    "use": "id of a component of the catalogue or of `components`",
    "volume": "of water displaced, e.g. 0.9 m^3",
    "warn_tilt": "tilt to be warned of",
    "weight": "in sea water of 1025 kg/m^3 (per metre of a cable or chain)",
    "working_load": "load it may carry in use, e.g. 20 kN",
}


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
    schemas["Assembly"]["properties"]["parts"] = items
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
    measured = {"description": _DESCRIPTIONS["length_at"], **length_at}
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


def _tidy(schema: Any) -> None:
    """Say what fields are, and leave out defaults (in SI) and titles (the names again)."""
    if isinstance(schema, list):
        for part in schema:
            _tidy(part)
    if not isinstance(schema, dict):
        return
    for name, field in schema.get("properties", {}).items():
        field.pop("title", None)
        field.pop("default", None)
        if name in _DESCRIPTIONS and "$ref" not in field:
            field["description"] = _DESCRIPTIONS[name]
    for part in schema.values():
        _tidy(part)
