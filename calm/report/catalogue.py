"""Components of the catalogue as a list, as cards and as JSON."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

from calm.quantities import QUANTITIES
from calm.report.blocks import Cell, Column, Heading, Pairs, Part, Table

if TYPE_CHECKING:
    from calm.files import Catalogue, Component
    from calm.files.catalogue import Assembly

    Definition = Component | Assembly

_PER_METRE = ("mass", "weight", "buoyancy", "net_buoyancy")
_FIRST = ("name", "kind", "role")
_LAST = ("note", "source", "date")
_HEADING_OF_OTHERS = "other"


def to_list(catalogue: Catalogue, definitions: Mapping[str, Definition]) -> Part:
    """One line for each definition, under the name of its family."""
    columns = (
        Column("id"),
        Column("name"),
        Column("net force\nin water", numeric=True),
        Column("breaking\nload", numeric=True),
    )
    rows: list[tuple[Cell, ...]] = []
    last = None
    for identifier, definition in definitions.items():
        family = _family(catalogue, identifier) or _HEADING_OF_OTHERS
        if family != last:
            rows += [(Cell(),), (Cell(family.upper()),)]
            last = family
        net = _say(definition, "net_buoyancy") if definition.kind != "assembly" else ""
        breaking = "" if definition.breaking_load is None else _say(definition, "breaking_load")
        rows.append(tuple(map(Cell, (identifier, definition.name or "", net, breaking))))
    return Part("", (Table("", columns, tuple(rows), dense=True),))


def to_card(identifier: str, definition: Definition) -> Part:
    """Every figure that a definition gives, in the units people read, and where it comes from."""
    return Part("", (Heading(identifier), Pairs(tuple(_figures(definition)))))


def to_documents(
    catalogue: Catalogue, definitions: Mapping[str, Definition]
) -> list[dict[str, Any]]:
    """An object each: `id`, `family` and every field, SI or degrees, None if absent."""
    return [
        {"id": identifier, "family": _family(catalogue, identifier)}
        | definition.model_dump(mode="json")
        for identifier, definition in definitions.items()
    ]


def _family(catalogue: Catalogue, identifier: str) -> str | None:
    entry = catalogue.entry(identifier)
    return entry.family if entry else None


def _figures(definition: Definition) -> Iterator[tuple[str, str]]:
    fields = [name for name in type(definition).model_fields if name not in (*_FIRST, *_LAST)]
    if definition.kind != "assembly" and not any(
        getattr(definition, given, None) is not None for given in ("buoyancy", "weight")
    ):
        fields.insert(0, "net_buoyancy")
    for name in (*_FIRST, *fields, *_LAST):
        if getattr(definition, name) is not None:
            yield _heading(name), _say(definition, name)


def _heading(name: str) -> str:
    return QUANTITIES[name].heading if name in QUANTITIES else name.replace("_", " ")


def _say(definition: Definition, name: str) -> str:
    value = getattr(definition, name)
    if isinstance(value, tuple):
        return "\n".join(_text(name, member) for member in value)
    per_metre = "/m" if definition.kind in ("cable", "chain") and name in _PER_METRE else ""
    return _text(name, value) + per_metre


def _text(name: str, value: Any) -> str:
    """A field in one line for people, quantities with their unit, what is nested in brackets."""
    if isinstance(value, float) and name in QUANTITIES:
        return QUANTITIES[name].figure(value)
    if isinstance(value, BaseModel):
        value = value.model_dump(exclude_none=True)
    if isinstance(value, Mapping):
        return ", ".join(f"{_heading(key)} {_text(key, member)}" for key, member in value.items())
    if isinstance(value, tuple | list):
        return f"({'; '.join(_text(name, member) for member in value)})"
    return str(value)
