"""Edit a YAML text at a location: compute the text patches, and the data after the change."""

import re
from collections.abc import Iterable, Mapping, Sequence
from difflib import SequenceMatcher
from typing import Any, NamedTuple
from unicodedata import category

from calm.errors import CalmError
from calm.files.composition import Node
from calm.files.editing import writing
from calm.files.editing.items import Items, items_of, snippet_of
from calm.files.editing.writing import SECTIONS, Patch, Value, Worded, WritingStyle, inline, written
from calm.files.yaml_document import Location

_BLANK_LINE = re.compile(r"^[ \t]*\r?\n(?=(?:[ ]*#.*\n|[ \t]*\r?\n)*\S)", re.MULTILINE)

NAMED = ("components", "environments")
"""Sections whose keys are names chosen by the user: component ids or environment names."""


class EditError(CalmError):
    """The requested change cannot be made in the current text."""


class Page:
    """An editable YAML text that ends with a line break, with its nodes and writing style."""

    def __init__(self, text: str, root: Node, style: WritingStyle) -> None:
        self.text = text
        self.root = root
        self.style = style

    def node(self, location: Location) -> Node | None:
        """Return the node at a location, or None if the location does not exist."""
        node: Node | None = self.root
        for step in location:
            node = node.entry(step)[1] if node else None
        return node

    def put(self, location: Location, value: Value) -> list[Patch]:
        """Return the patches that set a value at a location, and add missing parent mappings."""
        outer: Node | None = None
        node = self.root
        for depth, step in enumerate(location):
            _, child = node.entry(step)
            if child is None:
                new = nested(location[depth:], value)
                if node.kind == "mapping" and (node.keys or outer is None or not depth):
                    name, new_value = next(iter(new.items()))
                    opened = _writes_one_key_per_line(location[:depth], node)
                    return [self._add_entry(node, name, new_value, open=opened)]
                if outer is None or node.kind == "sequence":
                    raise EditError(
                        f"`{'.'.join(map(str, location))}` cannot be set, because it would lie "
                        "inside a list"
                    )
                return self._set(outer, location[depth - 1], new)
            outer, node = node, child
        assert outer is not None
        return self._set(
            outer, location[-1], value, open=_writes_one_key_per_line(location[:-1], outer)
        )

    def _set(
        self, outer: Node, step: str | int, value: Value, *, open: bool = False
    ) -> list[Patch]:
        if outer.kind == "mapping":
            at = [key.data for key in outer.keys].index(step)
            return writing.set_value(self.text, outer, at, value, self.style, open=open)
        old = outer.children[int(step)]
        if old.kind != "scalar" or not isinstance(value, str):
            raise EditError(f"line {old.line} of the file: only a plain value can be changed here")
        return [writing.set_scalar(old, value, flow=outer.style == "flow")]

    def remove(self, location: Location) -> list[Patch]:
        """Return the patches that remove the key at a location."""
        outer = self.node(location[:-1])
        assert outer is not None
        if len(outer.keys) == 1:
            return [Patch(outer.start, outer.end, "{}")]
        items = self._items(outer)
        items.remove([key.data for key in outer.keys].index(location[-1]))
        return [items.patch()]

    def _add_entry(self, mapping: Node, name: str, value: Value, *, open: bool) -> Patch:
        inside = f"{written(name, flow=True)}: {inline(value)}"
        if not mapping.keys:
            return Patch(mapping.start, mapping.end, f"{{{inside}}}")
        items, at = self._items(mapping), writing.place_of(name, [key.data for key in mapping.keys])
        lines = self.style.entry(name, value, items.column, open=open)
        if at and mapping.column == 1 and name in SECTIONS and _BLANK_LINE.search(self.text):
            lines = self.style.line_break + lines
        items.insert(at, inside if items.is_flow else lines)
        return items.patch()

    def items(self, location: Location) -> Items:
        """Return the items of the nonempty list at a location."""
        node = self.node(location)
        assert node is not None
        return self._items(node)

    def _items(self, node: Node) -> Items:
        items = items_of(self.text, node)
        if items is None:
            message = f"line {node.line} of the file: this list or mapping shares lines with other"
            raise EditError(f"{message} items or comments; edit the list in the text of the file")
        return items

    def known(self, location: Location, indices: Iterable[int]) -> list[int]:
        """Sort the indices of list items and remove repetitions.

        Raises
        ------
        EditError
            An item does not exist.
        """
        node = self.node(location)
        count = len(node.children) if node is not None and node.kind == "sequence" else 0
        known = sorted(set(indices))
        for index in known:
            if not 0 <= index < count:
                what = "clamp" if location[-1] == "clamps" else "item"
                raise EditError(f"{what} {index} does not exist; the list has {count}")
        return known

    def copy(self, location: Location, indices: Iterable[int]) -> tuple[str, ...]:
        """Return the texts of list items, each with its comments."""
        known = self.known(location, indices)
        node = self.node(location)
        if not known or node is None:
            return ()
        if node.style == "flow":
            found = [node.children[i] for i in known]
            return tuple(snippet_of(self.text[one.start : one.end], 0) for one in found)
        items = self.items(location)
        return tuple(snippet_of(items.texts[i], items.column) for i in known)

    def add(self, location: Location, index: int, values: Sequence[Value]) -> list[Patch]:
        """Return the patches that insert items into a list, which is created if necessary.

        Parameters
        ----------
        index : index of the first new item
        values : the new items; those of a `Worded` list are written with their own text
        """
        node = self.node(location)
        if node is None or not node.children:
            return self.put(location, values)
        items = self.items(location)
        if isinstance(values, Worded):
            texts = [
                one.inline if items.is_flow else self.style.moved(one.lines, items.column)
                for one in values.wordings
            ]
        else:
            block = all(child.style == "block" for child in node.children)
            texts = [self._text(value, items, block=block) for value in values]
        for text in reversed(texts):
            items.insert(index, text)
        return [items.patch()]

    def _text(self, value: Value, items: Items, *, block: bool = False) -> str:
        return inline(value) if items.is_flow else self.style.item(value, items.column, block=block)

    def rows(self, location: Location, rows: Sequence[Value]) -> list[Patch]:
        """Return the patches that replace the items of a list; unchanged items keep their text."""
        node = self.node(location)
        if node is None or not node.children or not rows or node.kind != "sequence":
            return self.put(location, rows)
        old = [repr(row) for row in node.data]
        new = [repr(data_of(row)) for row in rows]
        items = self.items(location)
        steps = SequenceMatcher(None, old, new, autojunk=False).get_opcodes()
        for tag, start, end, new_start, new_end in reversed(steps):
            if tag == "equal":
                continue
            for row in reversed(rows[new_start:new_end]):
                items.insert(end, self._text(row, items))
            for index in reversed(range(start, end)):
                items.remove(index)
        return [items.patch()]


def _writes_one_key_per_line(location: Location, node: Node) -> bool:
    if location not in [(name,) for name in NAMED]:
        return False
    return not node.children or any(child.style == "block" for child in node.children)


def nested(location: Location, value: Value) -> dict[str, Value]:
    """Wrap a value in nested mappings, one for each key of a location."""
    for step in reversed(location):
        value = {str(step): value}
    assert isinstance(value, dict)
    return value


def data_of(value: Value) -> Any:
    """Return the data that result if a value is written to a file and read again."""
    if value is None or isinstance(value, str):
        return value
    if isinstance(value, Mapping):
        return {key: data_of(one) for key, one in value.items()}
    return [data_of(one) for one in value]


REMOVED = object()
"""Marker used as a value to remove a key."""


def with_value(data: Any, location: Location, value: Any) -> Any:
    """Return a copy of data in which the value at a location is replaced or removed.

    Missing mappings above the location are added. The value `REMOVED` removes the key.
    """
    if not location:
        return data_of(value)
    step, below = location[0], location[1:]
    if isinstance(data, list) and isinstance(step, int):
        return [with_value(one, below, value) if i == step else one for i, one in enumerate(data)]
    base = data if isinstance(data, dict) else {}
    if value is REMOVED and not below:
        return {key: one for key, one in base.items() if key != step}
    return {**base, step: with_value(base.get(step), below, value)}


def has_control(data: Any) -> bool:
    """True if any text in the data contains control characters."""
    if isinstance(data, str):
        return any(category(sign) in ("Cc", "Cf") for sign in data if sign not in "\t\n\r")
    parts = [*data, *data.values()] if isinstance(data, dict) else data or ()
    return any(map(has_control, parts))


def cells_that_differ(
    old: Any, new: Sequence[Sequence[str | None]]
) -> list[tuple[int, int, str]] | None:
    """List the changed cells of a table, each as (row, column, new text).

    Return None if the two tables have different shapes, or if a cell loses its value.
    """
    rows = old if isinstance(old, list | tuple) else []
    if [len(row) if isinstance(row, list | tuple) else -1 for row in rows] != [*map(len, new)]:
        return None
    changed = [
        (i, j, text)
        for i, (before, row) in enumerate(zip(rows, new, strict=True))
        for j, (value, text) in enumerate(zip(before, row, strict=True))
        if value != text
    ]
    cells = [(i, j, text) for i, j, text in changed if text is not None]
    return cells if len(cells) == len(changed) else None


_ENDINGS = ("\r\n", "\n", "\r")


class EndedLine(NamedTuple):
    """A line of text and its line break; the line break of the last line is empty."""

    text: str
    line_break: str


def lines_of(text: str) -> list[EndedLine]:
    """Split a text as `str.splitlines` does, and add an empty line after a final line break."""
    lines = [EndedLine(one.splitlines()[0], one) for one in text.splitlines(keepends=True)]
    found = [EndedLine(text, whole[len(text) :]) for text, whole in lines]
    if not text or text.endswith(_ENDINGS):
        found.append(EndedLine("", ""))
    return found


def retyped(text: str, lines: Sequence[str]) -> str:
    """Replace the content of a text with `lines` from a text editor; keep the line breaks.

    Added lines get the usual line break of the text.
    """
    old = lines_of(text)
    usual = WritingStyle.of(text, None).line_break
    of_old = _taken_from([line.text for line in old], lines)
    ends = [usual if i is None else old[i].line_break or usual for i in of_old]
    ends[-1] = old[-1].line_break if of_old[-1] == len(old) - 1 else ""
    text = ""
    for line, end in zip(lines, ends, strict=True):
        if text.endswith("\r") and not line and end == "\n":
            end = "\r"  # "\r" and "\n" would become one line break
        text += line + end
    return text


def _taken_from(old: Sequence[str], new: Sequence[str]) -> list[int | None]:
    """Return, for each new line, the index of the old line that the new line equals or replaces.

    The index is None for an added line.
    """
    # Comparing is slow, and usually only one line differs.
    head = _common_start(old, new)
    tail = _common_start(old[head:][::-1], new[head:][::-1])
    middle = old[head : len(old) - tail], new[head : len(new) - tail]
    found: list[int | None] = [*range(head)]
    for _, start, end, new_start, new_end in SequenceMatcher(None, *middle, False).get_opcodes():
        places = range(head + start, head + end)
        count = new_end - new_start
        found += [*places, *[None] * count][:count]
    return [*found, *range(len(old) - tail, len(old))]


def _common_start(old: Sequence[str], new: Sequence[str]) -> int:
    pairs = enumerate(zip(old, new, strict=False))
    return next((i for i, (one, other) in pairs if one != other), min(len(old), len(new)))
