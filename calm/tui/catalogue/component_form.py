"""The fields that a component of a kind may have, taken from its model, and how each is judged."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from types import UnionType
from typing import Any, Literal, Union, get_args, get_origin

from calm.errors import Problem
from calm.files.catalogue import CatalogueEntry, define
from calm.files.components import KINDS, Component
from calm.files.fields import QuantityField
from calm.files.yaml_document import Document, SourceMapping
from calm.tui.checking import Check, Reading, anything, quantity
from calm.units import DIMENSIONS

_FIRST = ("name", "manufacturer", "role")
_LAST = ("material", "part_number", "note", "source", "date")
_PATH = "the form"
_ID = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
_WORDS = re.compile(r"[^a-z0-9]+")


@dataclass(frozen=True)
class FormField:
    """A key of a component: what it takes, for people, and what judges it."""

    key: str
    needed: bool
    takes: str
    check: Check


def form_fields(kind: str) -> Iterator[FormField]:
    """The keys of a kind that hold one value; those that a component cannot do without first."""
    fields = KINDS[kind].model_fields
    known = [name for name in fields if name not in ("kind", *_FIRST, *_LAST)]
    known.sort(key=lambda name: not fields[name].is_required())
    for name in (*_FIRST, *known, *_LAST):
        info = fields[name]
        made = _form_field(name, info.annotation, info.metadata, needed=info.is_required())
        if made is not None:
            yield made


def _form_field(
    name: str, annotation: Any, metadata: list[Any], *, needed: bool
) -> FormField | None:
    found = next((each for each in metadata if isinstance(each, QuantityField)), None)
    if found is not None:
        units = list(DIMENSIONS[found.dimension].units)[:5]
        takes = DIMENSIONS[found.dimension].noun.removeprefix("a ").removeprefix("an ")
        takes += f" ({', '.join(units)})" if DIMENSIONS[found.dimension].unit else ""
        check = quantity(found, optional=not needed, usual_unit=found.usual_unit)
        return FormField(name, needed, takes, check)
    words = _words(annotation)
    if words:
        return FormField(name, needed, " | ".join(words), _one_of(words))
    if annotation is str or str in _members(annotation):
        return FormField(name, needed, "", anything)
    return None


def _members(annotation: Any) -> tuple[Any, ...]:
    """The types of a union, without annotations."""
    if get_origin(annotation) in (Union, UnionType):
        return tuple(member for each in get_args(annotation) for member in _members(each))
    if hasattr(annotation, "__metadata__"):
        return _members(get_args(annotation)[0])
    return (annotation,)


def _words(annotation: Any) -> tuple[str, ...]:
    """The words that a field may be, where it is one of some words and nothing else."""
    members = [each for each in _members(annotation) if each is not type(None)]
    if members and all(get_origin(each) is Literal for each in members):
        return tuple(word for each in members for word in get_args(each))
    return ()


def _one_of(words: tuple[str, ...]) -> Check:
    def check(text: str) -> Reading:
        tidy = text.strip()
        if not tidy or tidy in words:
            return Reading(tidy)
        near = [word for word in words if word.startswith(tidy.casefold())]
        return Reading(tidy, f"must be {' or '.join(words)}", near[0] if near else None)

    return check


def id_check(own: Collection[str]) -> Check:
    """Whether a text can be the id of a component; `own` are those that the file has already."""

    def check(text: str) -> Reading:
        tidy = text.strip()
        if not tidy:
            return Reading("", "an id is needed")
        if not _ID.fullmatch(tidy):
            offer = _WORDS.sub("-", tidy.casefold()).strip("-")
            return Reading(tidy, "small letters, figures and hyphens", offer or None)
        if tidy in own:
            return Reading(tidy, "is defined in this file already")
        return Reading(tidy)

    return check


def defined(id: str, values: Mapping[str, Any]) -> tuple[Component | None, tuple[Problem, ...]]:
    """The component that values define, and what is wrong with them."""
    section = SourceMapping.of(Document(_PATH, {id: dict(values)}), (id,), dict(values))
    problems: list[Problem] = []
    definition = define(CatalogueEntry(id, None, section), section, problems)
    if definition is None or definition.kind == "assembly":
        return None, tuple(problems)
    return definition, tuple(problems)
