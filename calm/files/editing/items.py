"""Cut, copy, insert and move items of YAML lists, and entries of YAML mappings, as text."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import Any

from calm.files.composition import Node, compose
from calm.files.editing import writing
from calm.files.editing.writing import Patch, Wording, first_on_line, inline, line_start, own_start
from calm.files.yaml_document import Location

LINE: Location = ("line",)
"""Location of the items of the line."""

_LINE_BREAK = re.compile(r"\r\n|\n")


@dataclass(frozen=True)
class LineLists:
    """Locations of the lists of line items: one list, or one list per leg of a net.

    A line index counts the items of all lists, in file order.

    Attributes
    ----------
    all : location of each list, and its number of items
    """

    all: tuple[tuple[Location, int], ...]

    @classmethod
    def of(cls, data: Any) -> LineLists:
        """Find the lists of line items in the data of a file."""
        data = data if isinstance(data, dict) else {}
        legs = data.get("legs")
        if "line" in data or not isinstance(legs, dict):
            line = data.get("line")
            return cls(((LINE, len(line) if isinstance(line, list) else 0),))
        lines = {
            ("legs", name, *LINE): leg.get("line")
            for name, leg in legs.items()
            if isinstance(leg, dict)
        }
        found = [(at, len(line)) for at, line in lines.items() if isinstance(line, list)]
        return cls(tuple(found) or ((LINE, 0),))

    @property
    def legs(self) -> list[str]:
        """Name of the leg of each item; empty if the file describes a single mooring line."""
        names = [(str(rows[1]) if len(rows) > 1 else "", count) for rows, count in self.all]
        return [name for name, count in names for _ in range(count)]

    def real(self, location: Location) -> Location:
        """Convert a location that contains a line index to the location in the file."""
        if location[:1] != LINE or len(location) == 1:
            return location
        rows, index = self.place(int(location[1]), above=True)
        return (*rows, index, *location[2:])

    def place(self, index: int, *, above: bool) -> tuple[Location, int]:
        """Convert a line index to the location of a list and an index in this list.

        At the boundary of two legs, the result is the start of the lower leg if `above` is true.
        Otherwise, the result is the end of the upper leg.
        """
        for rows, count in self.all[:-1]:
            if index < count or (index == count and not above):
                return rows, index
            index -= count
        return self.all[-1][0], index

    def place_in(self, rows: Location, index: int, *, above: bool) -> tuple[Location, int]:
        """Return the location of the list that contains an item, and the index in this list.

        If `rows` is `LINE`, the argument `index` is a line index. Otherwise, `index` refers to the
        list at `rows`, and is returned unchanged.
        """
        return self.place(index, above=above) if rows == LINE else (self.real(rows), index)

    def grouped(
        self, indices: Iterable[int], rows: Location
    ) -> Iterator[tuple[Location, list[int]]]:
        """Yield each list that contains given items: its location, and the indices of the items."""
        if rows != LINE:
            yield self.real(rows), [*indices]
            return
        places = [self.place(index, above=True) for index in sorted(indices)]
        for own, group in groupby(places, key=lambda place: place[0]):
            yield own, [index for _, index in group]


@dataclass(frozen=True)
class LineItem:
    """An item of a line, or a clamp of an item.

    Attributes
    ----------
    line, column : position of the item in the text, from 1; the pieces that the item produces have
        the same position
    values : keys and plain values as written; empty text for a key without a value, and text such
        as `480 m at 2 kN` for `length_at`
    text : lines of the item in the file, with its comments
    """

    line: int
    column: int
    values: dict[str, str]
    clamps: tuple[LineItem, ...]
    text: str


def item_of(node: Node, text: str, *, lines: str = "") -> LineItem:
    """Convert a YAML node to a line item.

    Parameters
    ----------
    text : text that contains the node
    lines : text of the item with its comments; if empty, the text of the node
    """
    entries = list(zip(node.keys, node.children, strict=False))
    values = {key.data: child.data or "" for key, child in entries if child.kind == "scalar"}
    clamps = [child for key, child in entries if key.data == "clamps" and child.kind == "sequence"]
    measured = next((child.data for key, child in entries if key.data == "length_at"), None)
    if isinstance(measured, dict):
        values["length_at"] = f"{measured.get('length', '?')} at {measured.get('load', '?')}"
    return LineItem(
        line=node.line,
        column=node.column,
        values=values,
        clamps=tuple(item_of(clamp, text) for found in clamps for clamp in found.children),
        text=lines or text[node.start : node.end],
    )


def snippet_of(text: str, column: int) -> str:
    """Convert the text of an item to a block list with this item only, starting in column 1.

    `column` is the column of the item's dash, from 1; 0 for an item in brackets.
    """
    text = _LINE_BREAK.sub("\n", text)
    if not column:
        return f"- {text}\n"
    return re.sub(rf"^[ ]{{1,{column - 1}}}", "", text, flags=re.M) if column > 1 else text


def read_snippet(snippet: str) -> Wording | None:
    """Parse a text that `snippet_of` returned; return None unless it contains exactly one item."""
    composition = compose(snippet)
    root = composition.root
    if root is None or composition.refusals or (root.kind, root.style) != ("sequence", "block"):
        return None
    if len(root.children) != 1 or root.column != 1:
        return None
    item = root.children[0]
    text = snippet[item.start : item.end]
    is_one_line = item.style == "flow" and "\n" not in text
    return Wording(item.data, snippet, text if is_one_line else inline(item.data))


@dataclass
class Items:
    """The items of a nonempty list, or the entries of a nonempty mapping.

    Attributes
    ----------
    start, end : span of the collection in the text
    is_flow : whether the collection is in brackets
    column : column of the dashes or keys, from 1
    texts : lines of each item with its comments; in brackets, the text between two commas
    gaps : text before each item that belongs to no item
    rest : text after the last item
    separator : text between two items in brackets
    on_a_dash : whether the first entry of the mapping is on the same line as a preceding dash or
        `?`
    """

    start: int
    end: int
    is_flow: bool
    column: int
    texts: list[str]
    gaps: list[str]
    rest: str = ""
    separator: str = ""
    on_a_dash: bool = False

    def remove(self, index: int) -> str:
        """Remove an item and return its text. Text that belongs to no item is kept."""
        text, gap = self.texts.pop(index), self.gaps.pop(index)
        if index == len(self.texts):
            self.rest = gap + self.rest
        else:
            self.gaps[index] = gap + self.gaps[index]
        return text

    def insert(self, index: int, text: str) -> None:
        """Insert an item at an index."""
        self.texts.insert(index, text)
        self.gaps.insert(index, "")
        if index == 0 and len(self.gaps) > 1:
            self.gaps[0], self.gaps[1] = self.gaps[1], ""

    def patch(self) -> Patch:
        """Return the patch that replaces the collection."""
        parts = [gap + text for gap, text in zip(self.gaps, self.texts, strict=True)]
        text = self.separator.join(parts) + self.rest
        return Patch(self.start, self.end, text.lstrip(" ") if self.on_a_dash else text)


def items_of(text: str, node: Node) -> Items | None:
    """Divide a collection into items.

    Return None if the lines of the items contain other text, such as the dash of an outer list, or
    a comment between brackets.

    The text must end with a line break.
    """
    spans = [(child.start, child.end) for child in node.children]
    if node.kind == "mapping":
        pairs = zip(node.keys, node.children, strict=True)
        spans = [(key.start, max(key.end, child.end)) for key, child in pairs]
    if node.style == "block":
        return _block(text, node, spans)
    return _flow(text, node, spans)


def _block(text: str, node: Node, spans: list[tuple[int, int]]) -> Items | None:
    dash = re.compile(rf"^[ ]{{{node.column - 1}}}-(?=\s)", re.MULTILINE)
    is_list, first = node.kind == "sequence", node.start
    on_a_dash = not first_on_line(text, first)
    if on_a_dash and is_list:
        return None
    if not on_a_dash:
        first = own_start(text, first, 0, None if is_list else node.column)
        if not is_list and node.column == 1 and first == line_start(text, 0):
            # comments at the beginning of a file are about the file, not about its first entry
            first = line_start(text, node.start)
    starts, ends = [first], []
    for (_, end), following in zip(spans, (*spans[1:], None), strict=True):
        ends.append(writing.own_end(text, end, node.column))
        if following is not None:
            found = dash.search(text, writing.line_end(text, end)) if is_list else None
            if found is None and is_list:
                return None
            head = found.start() if found else following[0]
            starts.append(own_start(text, head, ends[-1], node.column))
    texts = [text[start:end] for start, end in zip(starts, ends, strict=True)]
    if on_a_dash:
        texts[0] = " " * (node.column - 1) + texts[0]
    gaps = ["", *(text[end:start] for end, start in zip(ends, starts[1:], strict=False))]
    return Items(starts[0], ends[-1], False, node.column, texts, gaps, on_a_dash=on_a_dash)


def _flow(text: str, node: Node, spans: list[tuple[int, int]]) -> Items | None:
    between = [text[one[1] : other[0]] for one, other in pairwise(spans)]
    if any("#" in each for each in between):
        return None
    # after the colon of an empty value a comma would be part of the key
    texts = [text[start:end] + " " * text.endswith(":", start, end) for start, end in spans]
    separator = between[0] if between and "\n" in between[0] else ", "
    gaps = [""] * len(texts)
    return Items(spans[0][0], spans[-1][1], True, node.column, texts, gaps, "", separator)
