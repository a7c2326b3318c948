"""Replacement of imported components by catalogue entries with matching names and values."""

import re
from dataclasses import dataclass
from math import inf

from pydantic import ValidationError

from calm.assemble.component_forces import drag_of
from calm.exchange import model
from calm.exchange.design_writer import figure_text
from calm.files import Anchor, Catalogue, Rigid
from calm.files.components import FLEXIBLE_KINDS, KINDS, Component

_TOLERANCE = 0.05
"""Relative tolerance in size, net buoyancy and drag when a component is matched to a catalogue
entry.
"""

_COMMON_WORDS = 0.5  # share of the words of a name that an entry must contain, at least two words
_GRADE = re.compile(r"\b(?:g|gr|grade)[ -]?(\d{1,3})\b", re.I)


@dataclass(frozen=True)
class CatalogueMatch:
    """Name of an imported component, and the catalogue entry that replaces it."""

    name: str
    entry: str


def match_catalogue_entries(design: model.ImportedDesign) -> tuple[CatalogueMatch, ...]:
    """Replace imported components by catalogue entries with similar names and values.

    Similar names share at least two words, and half the words in the component's name. Kind, grade,
    sizes, net buoyancy, drag, stiffness and loads must agree if known, within `_TOLERANCE`. For a
    component without a size, only grade and net buoyancy are compared. Of several entries, the
    entry with the most similar name is used.
    """
    catalogue = Catalogue.load()
    entries = {id: entry for id, entry in catalogue.all().items() if isinstance(entry, Component)}
    matched: dict[str, CatalogueMatch] = {}
    for component in design.components():
        model = _model(component)
        if model is None or component.entry:
            continue
        ranks = {
            id: _likeness(component.name, id, entry.name or "") for id, entry in entries.items()
        }
        for id in sorted((id for id, rank in ranks.items() if rank), key=lambda id: -ranks[id]):
            if _values_agree(model, entries[id], sizeless="drag_area" in component.guesses):
                component.entry = id
                matched[id + component.name] = CatalogueMatch(component.name, id)
                break
    return tuple(matched.values())


def _model(component: model.ImportedComponent) -> Component | None:
    per_metre = component.kind in FLEXIBLE_KINDS
    fields = {
        key: figure_text(key, value, per_metre=per_metre, in_kilograms=False)
        for key, value in component.figures.items()
    }
    try:
        return KINDS[component.kind].model_validate({"kind": component.kind, **fields})
    except ValidationError:
        return None


def _likeness(name: str, id: str, other: str) -> float:
    """Rate the similarity of a component name to the id and name of a catalogue entry.

    Return inf if the name is equal to the id or name of the entry, and 0 if they are not similar.
    Otherwise, return the number of shared words divided by the number of all different words.
    """
    if name.casefold() in (id, other.casefold()):
        return inf
    grades = [set(_GRADE.findall(text)) for text in (name, f"{id} {other}")]
    if all(grades) and not grades[0] & grades[1]:
        return 0.0
    words, others = (
        set(re.findall(r"[a-z]+|\d+(?:[./]\d+)?", text.lower())) for text in (name, f"{id} {other}")
    )
    shared = words & others
    similar = len(shared) >= 2 and len(shared) >= _COMMON_WORDS * len(words)
    return len(shared) / len(words | others) if similar else 0.0


def _values_agree(one: Component, other: Component, *, sizeless: bool) -> bool:
    pairs: list[tuple[float | None, float | None]] = [(one.net_buoyancy, other.net_buoyancy)]
    if sizeless:
        if not isinstance(other, Rigid):
            return False
    elif one.kind != other.kind or isinstance(one, Anchor):
        return False
    else:
        keys = ("diameter", "length", "stiffness", "breaking_load", "working_load")
        pairs += [(getattr(one, key, None), getattr(other, key, None)) for key in keys]
        # normal drag at 1 m/s [N], per metre for a cable or chain
        pairs.append((drag_of(one)[0], drag_of(other)[0]))
    given = [(a, b) for a, b in pairs if a is not None and b is not None]
    return all(abs(a - b) <= _TOLERANCE * max(abs(a), abs(b)) for a, b in given)
