"""Components of an imported design that the catalogue has too."""

from __future__ import annotations

import re
from dataclasses import dataclass

from pydantic import ValidationError

from calm.assemble.line import drag_of
from calm.exchange.design import Design, ImportedComponent
from calm.exchange.writing import figure_text
from calm.files import Anchor, Assembly, Catalogue, Rigid
from calm.files.components import FLEXIBLE_KINDS, KINDS
from calm.files.components import ImportedComponent as Model

TOLERANCE = 0.05
"""Share by which size, net force and drag may differ from those of a catalogue entry."""

_COMMON_WORDS = 0.5  # share of the words of a name that an entry must have, two at least


@dataclass(frozen=True)
class CatalogueMatch:
    """A component, by its name in the file, and the catalogue entry used in its place."""

    name: str
    entry: str


def match(design: Design) -> tuple[CatalogueMatch, ...]:
    """Use catalogue entries for the components whose name and figures agree with one.

    A component is of the same kind, shares half the words of its name, and is within `TOLERANCE` in
    diameter, length, net force, normal drag and stiffness, as far as both give them.
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


def _model(component: ImportedComponent) -> Model | None:
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


def _weighs_alike(one: Model, other: Model) -> bool:
    """Whether a component without a size in the file has the net force of an entry."""
    if not isinstance(other, Rigid):
        return False
    a, b = one.net_buoyancy, other.net_buoyancy
    return abs(a - b) <= TOLERANCE * max(abs(a), abs(b))


def _agree(one: Model, other: Model) -> bool:
    if one.kind != other.kind or isinstance(one, Anchor) or isinstance(other, Anchor):
        return False
    pairs = [(one.net_buoyancy, other.net_buoyancy)]
    for key in ("diameter", "length", "stiffness"):
        values = getattr(one, key, None), getattr(other, key, None)
        if values[0] is not None and values[1] is not None:
            pairs.append((values[0], values[1]))
    pairs.append((_drag(one), _drag(other)))
    return all(abs(a - b) <= TOLERANCE * max(abs(a), abs(b)) for a, b in pairs)


def _drag(component: Model) -> float:
    """At 1 m/s across it [N], of a cable or chain per metre."""
    return drag_of(component, getattr(component, "length", 1.0))[0]
