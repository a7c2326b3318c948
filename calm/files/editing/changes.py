"""Changes to a text by location, each the patches that make it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from difflib import SequenceMatcher

from calm.errors import CalmError
from calm.files.document import Location
from calm.files.editing.data import child_of, nested
from calm.files.editing.items import new_slot, snippet_of, worded_slot
from calm.files.editing.layout import Layout, Value, Worded
from calm.files.editing.lists import Items, items_of
from calm.files.editing.mappings import add_entry, remove_entry, set_scalar, set_value
from calm.files.editing.spans import Patch
from calm.files.nodes import Node

NAMED = ("components", "environments")
"""Sections that hold definitions by name."""


class EditError(CalmError):
    """A change that cannot be made to the text as it stands."""


class Page:
    """A text that ends in a line break, its nodes and its manner."""

    def __init__(self, text: str, root: Node, layout: Layout) -> None:
        self.text = text
        self.root = root
        self.layout = layout

    def node(self, location: Location) -> Node | None:
        """What stands at a location, None where nothing does."""
        node: Node | None = self.root
        for step in location:
            node = child_of(node, step) if node else None
        return node

    def put(self, location: Location, value: Value) -> list[Patch]:
        """A value at a location, with the mappings that lead to it."""
        outer: Node | None = None
        node = self.root
        for depth, step in enumerate(location):
            child = child_of(node, step)
            if child is None:
                new = nested(location[depth:], value)
                if node.kind == "mapping" and (node.keys or outer is None or not depth):
                    name, new_value = next(iter(new.items()))
                    opened = _opens(location[:depth], node)
                    return add_entry(self.text, node, name, new_value, self.layout, open=opened)
                if outer is None or node.kind == "sequence":
                    raise EditError(f"{_shown(location)} cannot be set: there is a list above it")
                return self._set(outer, location[depth - 1], new)
            outer, node = node, child
        assert outer is not None
        return self._set(outer, location[-1], value, open=_opens(location[:-1], outer))

    def _set(
        self, outer: Node, step: str | int, value: Value, *, open: bool = False
    ) -> list[Patch]:
        if outer.kind == "mapping":
            at = [key.data for key in outer.keys].index(step)
            return set_value(self.text, outer, at, value, self.layout, open=open)
        old = outer.children[int(step)]
        if old.kind != "scalar" or not isinstance(value, str):
            raise EditError(f"line {old.line}: only a plain value can be changed here")
        return [set_scalar(old, value, flow=outer.style == "flow")]

    def remove(self, location: Location) -> list[Patch]:
        """A key taken out."""
        outer = self.node(location[:-1])
        assert outer is not None
        at = [key.data for key in outer.keys].index(location[-1])
        return remove_entry(self.text, outer, at)

    def items(self, location: Location) -> Items:
        """The items of the list at a location, which has some."""
        node = self.node(location)
        assert node is not None
        items = items_of(self.text, node)
        if items is None:
            message = f"line {node.line}: this list shares its lines with other things"
            raise EditError(f"{message}; change it in the text")
        return items

    def known(self, location: Location, indices: Iterable[int]) -> list[int]:
        """Indices of items of a list in its order, each once."""
        node = self.node(location)
        count = len(node.children) if node is not None and node.kind == "sequence" else 0
        known = sorted(set(indices))
        for index in known:
            if not 0 <= index < count:
                what = "clamp" if location[-1] == "clamps" else "item"
                raise EditError(f"there is no {what} {index} among {count}")
        return known

    def copy(self, location: Location, indices: Iterable[int]) -> tuple[str, ...]:
        """The text of items of a list by themselves, with their comments."""
        known = self.known(location, indices)
        node = self.node(location)
        if not known or node is None:
            return ()
        items = self.items(location)
        return tuple(snippet_of(items.slots[i], node.children[i], items) for i in known)

    def add(self, location: Location, index: int, values: Sequence[Value]) -> list[Patch]:
        """New items in a list, which may not exist yet."""
        node = self.node(location)
        if node is None or not node.children:
            return self.put(location, values)
        items = self.items(location)
        if isinstance(values, Worded):
            slots = [worded_slot(one, items, self.layout) for one in values.wordings]
        else:
            block = all(child.style == "block" for child in node.children)
            slots = [new_slot(value, items, self.layout, block=block) for value in values]
        for slot in reversed(slots):
            items.insert(index, slot)
        return [items.patch()]

    def rows(self, location: Location, rows: Sequence[Sequence[str | None]]) -> list[Patch]:
        """The rows of a table, those that are there already as they stand."""
        node = self.node(location)
        if node is None or not node.children or not rows or node.kind != "sequence":
            return self.put(location, rows)
        old = [repr(row) for row in node.data]
        new = [repr(list(row)) for row in rows]
        items = self.items(location)
        steps = SequenceMatcher(None, old, new, autojunk=False).get_opcodes()
        for tag, start, end, new_start, new_end in reversed(steps):
            if tag == "equal":
                continue
            for row in reversed(rows[new_start:new_end]):
                items.insert(end, new_slot(row, items, self.layout, block=False))
            for index in reversed(range(start, end)):
                items.remove(index)
        return [items.patch()]


def _opens(location: Location, node: Node) -> bool:
    """Whether definitions are written a key a line: where the others of their section are."""
    if location not in [(name,) for name in NAMED]:
        return False
    return not node.children or any(child.style == "block" for child in node.children)


def _shown(location: Location) -> str:
    return "`" + ".".join(map(str, location)) + "`"
