"""Use entries of the catalogue for imported components that agree with them in name and figures."""

import re
from dataclasses import dataclass

from pydantic import ValidationError

from calm.assemble.component_forces import drag_of
from calm.exchange import model
from calm.exchange.design_writer import figure_text
from calm.files import Anchor, Catalogue, Rigid
from calm.files.components import FLEXIBLE_KINDS, KINDS, Component

_TOLERANCE = 0.05
"""Share by which size, net force and drag may differ from those of a catalogue entry."""

_COMMON_WORDS = 0.5  # share of the words of a name that an entry must have, two at least


@dataclass(frozen=True)
class CatalogueMatch:
    """Name a component, as the file has it, and the catalogue entry used in its place."""

    name: str
    entry: str


def match_catalogue_entries(design: model.ImportedDesign) -> tuple[CatalogueMatch, ...]:
    """Use catalogue entries for the components whose name and figures agree with one.

    A component is of the same kind, shares half the words of its name, and is within `_TOLERANCE`
    in diameter, length, net force, normal drag and stiffness, as far as both give them.
    """
    catalogue = Catalogue.load()
    entries = {id: entry for id, entry in catalogue.all().items() if isinstance(entry, Component)}
    matched: dict[str, CatalogueMatch] = {}
    for component in design.components():
        model = _model(component)
        if model is None or component.entry:
            continue
        for id, entry in entries.items():
            if _alike(component.name, f"{id} {entry.name or ''}") and _agree(
                model, entry, sizeless="drag_area" in component.guesses
            ):
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


def _alike(name: str, other: str) -> bool:
    words, others = (
        set(re.findall(r"[a-z]+|\d+(?:[./]\d+)?", text.lower())) for text in (name, other)
    )
    shared = words & others
    return len(shared) >= 2 and len(shared) >= _COMMON_WORDS * len(words)


def _agree(one: Component, other: Component, *, sizeless: bool) -> bool:
    """Return whether two agree in figures; one that is `sizeless` in the file, in net force."""
    pairs: list[tuple[float | None, float | None]] = [(one.net_buoyancy, other.net_buoyancy)]
    if sizeless:
        if not isinstance(other, Rigid):
            return False
    elif one.kind != other.kind or isinstance(one, Anchor):
        return False
    else:
        sizes = ("diameter", "length", "stiffness")
        pairs += [(getattr(one, key, None), getattr(other, key, None)) for key in sizes]
        # at 1 m/s across it [N], of a cable or chain per metre
        pairs.append((drag_of(one)[0], drag_of(other)[0]))
    given = [(a, b) for a, b in pairs if a is not None and b is not None]
    return all(abs(a - b) <= _TOLERANCE * max(abs(a), abs(b)) for a, b in given)
