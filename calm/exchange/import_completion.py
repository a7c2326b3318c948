"""Complete an imported design: an anchor that holds, entries of the catalogue, an environment."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from calm.assemble.line_arrays import drag_of
from calm.case import Mooring, load
from calm.errors import CalmError
from calm.exchange.design import Design, ImportedComponent, one_line, refused
from calm.exchange.design_writer import figure_text, mooring_text, quoted
from calm.files import Anchor, Assembly, Catalogue, Rigid
from calm.files.components import FLEXIBLE_KINDS, KINDS, Component
from calm.files.definition import CATALOGUE_DENSITY, STANDARD_GRAVITY
from calm.files.yaml_document import read_document
from calm.physics.materials import STEEL_DENSITY
from calm.quantities import rounded

_TOLERANCE = 0.05
"""Share by which size, net force and drag may differ from those of a catalogue entry."""

_COMMON_WORDS = 0.5  # share of the words of a name that an entry must have, two at least
_BARE = re.compile(r"(?![-*%\s])[\w .+\-/^*()%]*(?<!\s)|-\d[^:#,]*")  # needs no quotes
_HOLDS = 1e8  # N: holds whatever is tied to it
_IN_WATER = (1.0 - CATALOGUE_DENSITY / STEEL_DENSITY) * STANDARD_GRAVITY  # N of a kilogram of steel
_DIGITS = 2  # that a guessed weight keeps
_LEAST = 100.0  # N of a guessed weight


def secure_anchor(design: Design, environment: list[str] | None, output: Path) -> None:
    """Give the anchor a weight where the file gives none, or one that the line would lift.

    The shape of the line does not depend on it. The weight is what `calm check` asks for in this
    current. A line without an equilibrium is left to `calm run`, which says so.

    Parameters
    ----------
    design : whose anchor is changed
    environment : lines in place of the water of the design
    output : path of the mooring file to come
    """
    anchor = design.items[-1].component if design.items and design.tow is None else None
    if anchor is None or anchor.kind != "anchor":
        return
    mass, weight = anchor.figures.get("mass"), anchor.figures.get("weight")
    given = weight if weight is not None or mass is None else _IN_WATER * float(mass)
    pull, required = _pull(design, anchor, environment, output)
    if isinstance(given, float) and (pull is None or pull <= given):
        return
    anchor.figures.pop("mass", None)
    anchor.guesses.pop("mass", None)
    if pull is None:
        anchor.figures["weight"], reason = _HOLDS, "the file gives no weight; this holds anything"
    else:
        anchor.figures["weight"] = rounded(max(required, _LEAST), _DIGITS, up=True)
        reason = (
            "the file gives no weight; 1.5 × (V + H/0.6) in this current"
            if given is None
            else f"the file's {given:.5g} N would be lifted: the line pulls up with {pull:.5g} N"
        )
    anchor.guesses["weight"] = reason


def _pull(
    design: Design, anchor: ImportedComponent, environment: list[str] | None, output: Path
) -> tuple[float | None, float]:
    """Return the upward pull of the line, and the weight that holds it [N]."""
    figures = dict(anchor.figures)
    anchor.figures.pop("mass", None)
    anchor.figures["weight"] = _HOLDS
    try:
        mooring = load(output, text=mooring_text(design, "", environment)[0])
        assert isinstance(mooring, Mooring)
        anchored = mooring.solve().anchor
    except CalmError:
        return None, 0.0
    finally:
        anchor.figures = figures
    return anchored.vertical, anchored.required_weight


@dataclass(frozen=True)
class CatalogueMatch:
    """Name a component, as the file has it, and the catalogue entry used in its place."""

    name: str
    entry: str


def match_catalogue_entries(design: Design) -> tuple[CatalogueMatch, ...]:
    """Use catalogue entries for the components whose name and figures agree with one.

    A component is of the same kind, shares half the words of its name, and is within `_TOLERANCE`
    in diameter, length, net force, normal drag and stiffness, as far as both give them.
    """
    catalogue = Catalogue.load()
    entries = {
        id: entry for id, entry in catalogue.all().items() if not isinstance(entry, Assembly)
    }
    matched: dict[str, CatalogueMatch] = {}
    for component in design.components():
        model = _model(component)
        if model is None or component.entry:
            continue
        for id, entry in entries.items():
            sizeless = "drag_area" in component.guesses
            if _alike(component.name, f"{id} {entry.name or ''}") and (
                _weighs_alike(model, entry) if sizeless else _agree(model, entry)
            ):
                component.entry = id
                matched[id + component.name] = CatalogueMatch(component.name, id)
                break
    return tuple(matched.values())


def _model(component: ImportedComponent) -> Component | None:
    per_metre = component.kind in FLEXIBLE_KINDS
    fields = {
        key: figure_text(key, value, per_metre=per_metre, in_kilograms=False)
        for key, value in component.figures.items()
    }
    try:
        return KINDS[component.kind].model_validate({"kind": component.kind, **fields})
    except ValidationError:
        return None


def _alike(name: str, other: str) -> bool:
    words, others = _words(name), _words(other)
    shared = words & others
    return len(shared) >= 2 and len(shared) >= _COMMON_WORDS * len(words)


def _words(text: str) -> set[str]:
    return set(re.findall(r"[a-z]+|\d+(?:[./]\d+)?", text.lower()))


def _weighs_alike(one: Component, other: Component) -> bool:
    """Return whether a component without a size in the file has the net force of an entry."""
    if not isinstance(other, Rigid):
        return False
    a, b = one.net_buoyancy, other.net_buoyancy
    return abs(a - b) <= _TOLERANCE * max(abs(a), abs(b))


def _agree(one: Component, other: Component) -> bool:
    if one.kind != other.kind or isinstance(one, Anchor) or isinstance(other, Anchor):
        return False
    pairs = [(one.net_buoyancy, other.net_buoyancy)]
    for key in ("diameter", "length", "stiffness"):
        values = getattr(one, key, None), getattr(other, key, None)
        if values[0] is not None and values[1] is not None:
            pairs.append((values[0], values[1]))
    pairs.append((_drag(one), _drag(other)))
    return all(abs(a - b) <= _TOLERANCE * max(abs(a), abs(b)) for a, b in pairs)


def _drag(component: Component) -> float:
    """Return the drag at 1 m/s across it [N], of a cable or chain per metre."""
    return drag_of(component, getattr(component, "length", 1.0))[0]


def environment_lines(path: Path, output: Path) -> list[str]:
    """Return the `environment` of a file, its paths relative to the folder of the mooring file.

    InputError: the file cannot be read, or has no `environment`.
    """
    found = read_document(path).data.get("environment")
    if not isinstance(found, dict) or not found:
        raise refused(path, "has no `environment`")
    current = found.get("current")
    if isinstance(current, dict) and isinstance(current.get("file"), str):
        target = os.path.join(path.parent, current["file"])
        found["current"] = {**current, "file": os.path.relpath(target, str(output.parent))}
    return [f"environment:  # that of {one_line(path.name)}", *_lines(found, "  ")]


def _lines(value: dict[str, Any], indent: str) -> list[str]:
    lines: list[str] = []
    for key, each in value.items():
        if isinstance(each, dict) and each:
            lines += [f"{indent}{key}:", *_lines(each, indent + "  ")]
        elif isinstance(each, list) and any(isinstance(row, (list, dict)) for row in each):
            lines.append(f"{indent}{key}:")
            lines += [f"{indent}  - {_flow(row)}" for row in each]
        else:
            lines.append(f"{indent}{key}: {_flow(each)}")
    return lines


def _flow(value: Any) -> str:
    if isinstance(value, list):
        return f"[{', '.join(_flow(each) for each in value)}]"
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key}: {_flow(each)}' for key, each in value.items())}}}"
    return "null" if value is None else _scalar(str(value))


def _scalar(text: str) -> str:
    """Return a text as it stands where it is a figure or a word, with quotes elsewhere."""
    return text if _BARE.fullmatch(text) else quoted(text)
