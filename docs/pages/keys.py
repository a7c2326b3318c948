"""Every key of the mooring file, from its JSON Schema."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

from calm.files import mooring_schema
from calm.files.components import KINDS
from pages.markdown import code, table

Schema = Mapping[str, Any]

HEAD = """# Every key

All keys of a mooring file with examples, from its schema (`calm schema`).
[The mooring file](mooring-file.md) explains how the keys work together. Keys in bold are required.

"""
_QUANTITY = "text with its unit"
_SECTIONS = {
    "": "The top level",
    "DocumentKeys": "`document:`",
    "Revision": "`document: history:`, an item",
    "Position": "`position:`",
    "TowKeys": "`tow:`",
    "EnvironmentKeys": "`environment:` of a mooring",
    "TowEnvironmentKeys": "`environment:` of a tow",
    "UniformCurrent": "`current:`, the same at all depths",
    "CurrentFile": "`current:`, from a file",
    "TableKeys": "`current:` or `density:`, a table",
    "SeaWaterKeys": "`density:`, by temperature and salinity",
    "Wind": "`wind:`",
    "Fouling": "`fouling:`",
    "SeabedKeys": "`seabed:`, a plane",
    "SeabedFile": "`seabed:`, a grid",
    "WaveKeys": "`waves:`",
    "SwellKeys": "`waves: swell:`",
    "Item": "`line:`, an item",
    "LengthAt": "`length_at:`",
    "LegKeys": "`legs:`, a leg",
    "EndKeys": "`top:` and `bottom:` of a leg",
    "AnchoredKeys": "`anchor:` of a leg",
    "HeldKeys": "`held:` of a leg",
    "Clamp": "`clamps:`, an item",
    "Definition": "`components:`, keys of every kind",
    "FatigueKeys": "`fatigue:`",
    "EstimatedFigure": "`estimate:`, or one of its items",
    "Sphere": "`kind: sphere`",
    "Cylinder": "`kind: cylinder`",
    "Body": "`kind: body`",
    "Profiler": "`kind: profiler`",
    "SphereShape": "`made_of:`, a sphere",
    "CylinderShape": "`made_of:`, a cylinder",
    "DragMeasurement": "`drag_measurements:`, an item",
    "Displacement": "`hull:`, by its displacement",
    "Cable": "`kind: cable`",
    "Chain": "`kind: chain`",
    "Anchor": "`kind: anchor`",
    "Assembly": "`kind: assembly`",
    "OutputUnits": "`units:`",
    "Solver": "`solver:`",
    "StrummingFactor": "`strumming:`, a factor",
    "ConstantCn": "`strumming:`, one Cn",
    "AmplitudeModel": "`strumming:`, a law by the amplitude",
    "BourgetMarichalKeys": "`strumming:`, the law of Bourget & Marichal",
    "Checks": "`checks:`",
    "SafetyFactors": "`checks: safety_factor:`",
    "MinimumTensions": "`checks: minimum_tension:`",
    "AcceptKeys": "`checks: accept:`, an item",
    "Uncertainty": "`uncertainty:`",
    "ReleaseKeys": "`releases:`, an item",
    "Deployed": "`deployed:`",
    "DeployedItem": "`deployed: items:`, an item",
    "ClockCheck": "`deployed: items: clock:`, the clock of an instrument",
}


def page() -> str:
    """The text of the page.

    Raises
    ------
    KeyError
        The schema has a model that no section is for.
    """
    schema = mooring_schema()
    models: dict[str, Schema] = {"": schema, **schema["$defs"]}
    kinds = [*(kind.__name__ for kind in KINDS.values()), "Assembly"]
    shared = set.intersection(*({*models[kind]["properties"]} - {"kind"} for kind in kinds))
    models["Definition"] = _part(models["Anchor"], shared)
    of_components = {key for kind in kinds for key in models[kind]["properties"]}
    for kind in kinds:
        models[kind] = _part(models[kind], {*models[kind]["properties"]} - shared)
    for place in ("Item", "Clamp"):
        own = {*models[place]["properties"]} - (of_components - {"length"})
        models[place] = _part(models[place], own if place == "Item" else own - {"length"})
    missing = models.keys() - _SECTIONS.keys()
    if missing:
        raise KeyError(f"no section of the page is for {', '.join(sorted(missing))}")
    return HEAD + "\n".join(_section(models[name], title) for name, title in _SECTIONS.items())


def _part(model: Schema, keys: set[str]) -> Schema:
    kept = {key: form for key, form in model["properties"].items() if key in keys}
    return {**model, "properties": kept}


def _section(model: Schema, title: str) -> str:
    required = model.get("required", ())
    rows = [
        (
            f"**{code(key)}**" if key in required else code(key),
            form.get("description", ""),
            ", ".join(dict.fromkeys(_takes(form))),
            code(f"{key}: {_yaml(form.get('examples', [form.get('const')])[0])}"),
        )
        for key, form in model["properties"].items()
    ]
    return f"## {title}\n\n{table(('key', 'meaning', 'value', 'example'), rows)}"


def _takes(form: Schema) -> Iterator[str]:
    """The forms that a value may have, in words."""
    for alternatives in ("anyOf", "oneOf"):
        for alternative in form.get(alternatives, ()):
            yield from _takes(alternative)
    if "$ref" in form:
        yield _SECTIONS[form["$ref"].rpartition("/")[2]].partition(",")[0]
    elif "enum" in form:
        yield from (code(str(value)) for value in form["enum"])
    elif "const" in form and form["const"] != 0:
        yield code(str(form["const"]))
    elif "pattern" in form:
        text = form["pattern"]
        unit = "A-Za-z°µ" in text
        yield "a day" if r"\d{4}" in text else _QUANTITY if unit else "a number or a share in %"
    elif form.get("type") == "array":
        yield "a list"
    elif "object" in form.get("type", ()):
        yield "keys"
    elif form.get("type") == "string" or form.get("type") == ["string", "number"]:
        yield "text"
    elif form.get("type") in ("number", "integer"):
        yield "a number"


def _yaml(value: object) -> str:
    """Format a value as YAML on one line, quoted only if necessary."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_yaml(part)}" for key, part in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_yaml, value)) + "]"
    if isinstance(value, str) and (value[:1] in "*&{[" or value.endswith("*") or ";" in value):
        return json.dumps(value, ensure_ascii=False)
    return f"{value:g}" if isinstance(value, float) else str(value)
