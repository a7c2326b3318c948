"""The `line` of a mooring file: items expanded into pieces, overrides applied, labels resolved."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import replace

from calm.errors import Problem
from calm.files.catalogue import Assembly, Catalogue, Entry, define
from calm.files.components import Anchor, Body, Cable, Chain, Component, Cylinder, Sphere
from calm.files.explain import about_quantity, shown, unknown
from calm.files.fields import LENGTH, POSITIVE_LENGTH, Quantity
from calm.files.mooring import Clamp, Piece
from calm.files.overrides import contradicted
from calm.files.section import Section
from calm.units import QuantityError

MOST_PIECES = 10_000
"""Pieces a line may have, after assemblies and counts are expanded."""

_COUNT = Quantity("number", at_least=1, at_most=MOST_PIECES)
_ITEM_KEYS = frozenset({"use", "label", "count", "length", "top_depth", "clamps"})
_ASSEMBLY_KEYS = frozenset({"use", "label", "count"})
_CLAMP_KEYS = frozenset({"use", "label", "at"})


class LineReader:
    """Expands line items; mistakes are added to `problems`, things worth telling to `notices`."""

    def __init__(self, catalogue: Catalogue, problems: list[Problem], notices: list[str]) -> None:
        self._catalogue = catalogue
        self._problems = problems
        self._notices = notices
        self._defined: dict[str, Component | Assembly | None] = {}
        self._assemblies: dict[str, tuple[Piece, ...]] = {}
        self._open: list[str] = []

    def check(self, ids: Iterable[str]) -> None:
        """Look at definitions whether the line uses them or not."""
        for id in ids:
            entry = self._catalogue.entry(id)
            if entry is not None:
                definition = self._defined[id] = define(entry, entry.section, self._problems)
                if isinstance(definition, Assembly):
                    self._assembly(entry, entry.section)

    def read(self, section: Section, key: str) -> tuple[Piece, ...]:
        """The pieces of the list of items under a key; those with mistakes are left out."""
        pieces: list[Piece] = []
        items = self._items(section, key)
        for number, item in enumerate(items, 1):
            pieces += self._item(item)
            if max(number, len(pieces)) > MOST_PIECES:
                self._refuse(item, (), f"the line has more than {MOST_PIECES} pieces")
                return ()
        return tuple(pieces)

    def _items(self, section: Section, key: str) -> list[Section]:
        """The items of a list, each a mapping."""
        found = section.data[key]
        if not isinstance(found, (list, tuple)):
            self._refuse(section, (key,), f"`{key}` must be a list of items")
            return []
        items = []
        for i, item in enumerate(found[: MOST_PIECES + 1]):
            if isinstance(item, dict):
                items.append(Section.of(section.document, (*section.location, key, i), item))
            else:
                message = f"`{shown(item)}` is no item; write `{{use: {shown(item) or '…'}}}`"
                self._refuse(section, (key, i), message)
        return items

    def _item(self, item: Section) -> tuple[Piece, ...]:
        count = self._count(item)
        entry = self._entry(item)
        definition = self._definition(entry, item, _ITEM_KEYS) if entry else None
        if entry is None or definition is None:
            self._clamps(item, None)
            return ()
        if isinstance(definition, Assembly):
            once = self._assembly(entry, item)
        else:
            once = self._piece(definition, item)
        if len(once) * count > MOST_PIECES:
            message = f"{count} times makes more than {MOST_PIECES} pieces"
            self._refuse(item, ("count",), message)
            return ()
        return once * count

    def _piece(self, component: Component, item: Section) -> tuple[Piece, ...]:
        length: float | None
        fit_top_depth = None
        if isinstance(component, (Cable, Chain)):
            if item.data.get("length") == "fit":
                length = None
                fit_top_depth = self._quantity(item, "top_depth", LENGTH, "`length: fit` needs it")
            else:
                need = "a cable or chain needs it"
                length = self._quantity(item, "length", POSITIVE_LENGTH, need) or math.nan
        else:
            length = component.length
        if "top_depth" in item.data and item.data.get("length") != "fit":
            self._refuse(item, ("top_depth",), "`top_depth` goes with `length: fit`", key=True)
        if isinstance(component, Anchor) and "clamps" in item.data:
            self._refuse(item, ("clamps",), "nothing can be clamped on an anchor", key=True)
        clamps = self._clamps(item, length)
        place = item.problem((), "")
        use = item.data["use"]
        label = self._label(item)
        piece = Piece(
            0, use, label, component, length, fit_top_depth, clamps, place.line, place.column
        )
        return (piece,)

    def _clamps(self, item: Section, length: float | None) -> tuple[Clamp, ...]:
        """The clamps of an item, none beyond its length where that is known."""
        clamps = []
        for clamp in self._items(item, "clamps") if "clamps" in item.data else ():
            entry = self._entry(clamp)
            component = self._definition(entry, clamp, _CLAMP_KEYS) if entry else None
            at = self._quantity(clamp, "at", LENGTH, "the distance from the top of the piece")
            if at is not None and length is not None and at > length:
                message = f"`at: {shown(clamp.data['at'])}` is beyond the piece, {length:g} m long"
                self._refuse(clamp, ("at",), message)
            if isinstance(component, (Sphere, Cylinder, Body)) and at is not None:
                clamps.append(Clamp(clamp.data["use"], self._label(clamp), component, at))
            elif component is not None and at is not None:
                message = f"a component of kind {component.kind} cannot be clamped on a line"
                self._refuse(clamp, ("use",), message)
        return tuple(clamps)

    def _assembly(self, entry: Entry, item: Section) -> tuple[Piece, ...]:
        """The pieces of an assembly, all at the place of the item that uses it."""
        if entry.id in self._open:
            self._refuse(item, ("use",), f"assembly `{entry.id}` contains itself")
            return ()
        if entry.id not in self._assemblies:
            self._open.append(entry.id)
            self._assemblies[entry.id] = self.read(entry.section, "parts")
            self._open.pop()
        place = item.problem((), "")
        prefix = f"{self._label(item)} " if "label" in item.data else ""
        return tuple(
            replace(piece, label=prefix + piece.label, line=place.line, column=place.column)
            for piece in self._assemblies[entry.id]
        )

    def _entry(self, item: Section) -> Entry | None:
        """The catalogue entry that an item uses."""
        use = item.data.get("use")
        if not isinstance(use, str):
            message = "`use` must be the id of a component" if "use" in item.data else None
            self._refuse(item, ("use",), message or "`use` is missing")
            return None
        entry = self._catalogue.entry(use)
        if entry is None:
            near = self._catalogue.nearest(use)
            offer = f"; did you mean {near}?" if near else " (`calm catalog list` shows all)"
            self._refuse(item, ("use",), f"`use: {shown(use)}`: no such component{offer}")
            return None
        hidden = self._catalogue.hidden(use)
        if hidden:
            notice = f"{use}: defined in {entry.place}, which hides that of {hidden.place}"
            if notice not in self._notices:
                self._notices.append(notice)
        return entry

    def _definition(
        self, entry: Entry, item: Section, item_keys: frozenset[str]
    ) -> Component | Assembly | None:
        """What an item uses, the item's overrides applied."""
        if entry.id not in self._defined:
            self._defined[entry.id] = define(entry, entry.section, self._problems)
        definition = self._defined[entry.id]
        if isinstance(definition, Assembly):
            for key in item.data.keys() - _ASSEMBLY_KEYS:
                message = unknown(f"`{key}` cannot be set on an assembly", key, _ASSEMBLY_KEYS)
                self._refuse(item, (key,), message, key=True)
            return definition
        own_keys = item_keys
        if not isinstance(definition, (Cable, Chain)):
            own_keys = item_keys - {"length"}
        overriding = {key: value for key, value in item.data.items() if key not in own_keys}
        if definition is None or not overriding:
            return definition
        if "kind" in overriding:
            message = "`kind` cannot be overridden; define a component of your own"
            self._refuse(item, ("kind",), message, key=True)
            return None
        void = contradicted(definition.kind, entry.section.data.keys(), overriding.keys())
        override = Section.of(item.document, item.location, overriding)
        section = override.over(entry.section, dropping=void)
        component = define(entry, section, self._problems, also_allowed=item_keys)
        if isinstance(component, Assembly) or component is None:
            return None
        if "mass" in overriding and component.net_buoyancy == definition.net_buoyancy:
            self._notices.append(
                f"line {item.problem((), '').line}: `mass` of {entry.id} is overridden, its net "
                "force in water is not; override that too if it changes"
            )
        return component

    def _count(self, item: Section) -> int:
        text = item.data.get("count", "1")
        try:
            count = _COUNT.read(text)
            if count != int(count):
                raise QuantityError("must be a whole number")
        except QuantityError as error:
            self._refuse(item, ("count",), about_quantity("count", text, error))
            return 1
        return int(count)

    def _quantity(self, item: Section, key: str, kind: Quantity, need: str) -> float | None:
        if key not in item.data:
            self._refuse(item, (), f"`{key}` is missing: {need}")
            return None
        try:
            return kind.read(item.data[key])
        except QuantityError as error:
            self._refuse(item, (key,), about_quantity(key, item.data[key], error))
            return None

    def _label(self, item: Section) -> str:
        label = item.data.get("label", item.data["use"])
        if not isinstance(label, str):
            self._refuse(item, ("label",), "`label` must be plain text")
        return str(label)

    def _refuse(
        self, section: Section, location: tuple[str | int, ...], message: str, *, key: bool = False
    ) -> None:
        self._problems.append(section.problem(location, message, key=key))


def numbered(pieces: Iterable[Piece]) -> tuple[Piece, ...]:
    """The pieces with their index, and labels that occur more than once numbered down the line."""
    pieces = tuple(pieces)
    labels = [[piece.label, *(clamp.label for clamp in piece.clamps)] for piece in pieces]
    total = Counter(label for group in labels for label in group)
    seen: Counter[str] = Counter()

    def numbered_label(text: str) -> str:
        if total[text] == 1:
            return text
        seen[text] += 1
        while f"{text} {seen[text]}" in total:
            seen[text] += 1
        return f"{text} {seen[text]}"

    return tuple(
        replace(
            piece,
            index=index,
            label=numbered_label(piece.label),
            clamps=tuple(
                replace(clamp, label=numbered_label(clamp.label)) for clamp in piece.clamps
            ),
        )
        for index, piece in enumerate(pieces)
    )
