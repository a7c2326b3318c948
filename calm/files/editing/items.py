"""Lists and mappings in a text: taken apart into the texts of their items, rearranged, and put
together.

The items of a mapping are its entries. An item of a list can be copied as a text by itself, and
pasted from one.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby, pairwise
from typing import Any, Literal, NamedTuple

from calm.files.composition import Node, compose
from calm.files.editing import writing
from calm.files.editing.writing import Patch, Wording, first_on_line, inline, line_start, own_start
from calm.files.yaml_document import Location

LINE: Location = ("line",)
"""Where the items of the line stand."""

_COMMA = re.compile(r"(?:\s|#[^\n]*\n)*,")
_BEHIND = re.compile(r"[ \t]*(?:#[^\n]*)?(?:\r?\n|\Z)")
"""What may follow a value on its line: a comment."""
_LINE_BREAK = re.compile(r"\r\n|\n")


@dataclass(frozen=True)
class LineLists:
    """Say where the items of a line stand: in one list, those of a net in one for each leg.

    An index in `LINE` counts through all of them.

    Attributes
    ----------
    all : the location of each list, and the number of its items
    """

    all: tuple[tuple[Location, int], ...]

    @classmethod
    def of(cls, data: Any) -> LineLists:
        """Return those of a file, as its data."""
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
        """Return the leg of each item; nothing of a line."""
        names = [(str(rows[1]) if len(rows) > 1 else "", count) for rows, count in self.all]
        return [name for name, count in names for _ in range(count)]

    def real(self, location: Location) -> Location:
        """Return the location in the text of one that counts through all lists."""
        if location[:1] != LINE or len(location) == 1:
            return location
        rows, index = self.place(int(location[1]), above=True)
        return (*rows, index, *location[2:])

    def place(self, index: int, *, above: bool) -> tuple[Location, int]:
        """Return the list that an index is in, and the index there.

        Between two legs it is that of the lower one, `above` its first item, else the upper one's.
        """
        for rows, count in self.all[:-1]:
            if index < count or (index == count and not above):
                return rows, index
            index -= count
        return self.all[-1][0], index

    def place_in(self, rows: Location, index: int, *, above: bool) -> tuple[Location, int]:
        """Return the same of an index of the line, or of any other list."""
        return self.place(index, above=above) if rows == LINE else (self.real(rows), index)

    def grouped(
        self, indices: Iterable[int], rows: Location
    ) -> Iterator[tuple[Location, list[int]]]:
        """Yield the lists that items of a list are in, in their order, with their indices there."""
        if rows != LINE:
            yield self.real(rows), [*indices]
            return
        places = [self.place(index, above=True) for index in sorted(indices)]
        for own, group in groupby(places, key=lambda place: place[0]):
            yield own, [index for _, index in group]


@dataclass(frozen=True)
class LineItem:
    """Represent an item of a line, or a clamp of one.

    Attributes
    ----------
    line, column : where it stands, counted from 1: those of the pieces that it is read as
    values : its keys with plain values, as written; empty text where there is no value. A
        `length_at` is in it as people say it, `480 m at 2 kN`.
    clamps : tuple of Item
    text : the lines it takes, with the comments that belong to it
    """

    line: int
    column: int
    values: dict[str, str]
    clamps: tuple[LineItem, ...]
    text: str


def item_of(node: Node, text: str, *, lines: str = "") -> LineItem:
    """Return the item that a node of a text is.

    Parameters
    ----------
    node : of the item
    text : it stands in
    lines : its text, where it takes more than the node
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


def worded_slot(wording: Wording, items: Items, style: writing.WritingStyle) -> Slot:
    """Place an item as it is worded; within brackets in one line it loses its comments.

    Parameters
    ----------
    wording : of the item
    items : those of the list
    style : of the file
    """
    above = style.moved(wording.above, items.column)
    slot = items.slot(style.moved(wording.lines, items.column), wording.inline, style)
    if items.form != "rows":
        return slot
    return Slot(above + slot.value, wording.behind.replace("\n", style.line_break))


def snippet_of(slot: Slot, node: Node, items: Items) -> str:
    """Return the text of an item by itself, as an item of a block list that begins in column 1.

    Parameters
    ----------
    slot : of the item
    node : of the item
    items : those of its list
    """
    if items.form == "inline":
        return _LINE_BREAK.sub("\n", f"- {slot.value}\n")
    text = slot.text
    if items.form == "rows":
        own = len(slot.value) - (node.end - node.start)
        comments = slot.value[:own].rstrip(" \t")
        text = comments + " " * (items.column - 1) + "- " + slot.value[own:] + slot.behind
    indent = re.compile(rf"^[ ]{{1,{items.column - 1}}}" if items.column > 1 else "(?!)", re.M)
    return indent.sub("", _LINE_BREAK.sub("\n", text))


def read_snippet(snippet: str) -> Wording | None:
    """Return the item that a text as that of `snippet_of` is; None where it is none."""
    composition = compose(snippet)
    root = composition.root
    if root is None or composition.refusals or (root.kind, root.style) != ("sequence", "block"):
        return None
    if len(root.children) != 1 or root.column != 1:
        return None
    item = root.children[0]
    text = snippet[item.start : item.end]
    above = snippet[: line_start(snippet, root.start)]
    if item.style == "flow" and "\n" not in text:
        return Wording(item.data, snippet, above, text, snippet[item.end :])
    return Wording(item.data, snippet, above, inline(item.data), "\n")


class Slot(NamedTuple):
    """Hold the text of an item up to the end of its value, and what follows it (no comma).

    Where items have lines of their own it is these lines, comments that belong to it included.
    """

    value: str
    behind: str = ""

    @property
    def text(self) -> str:
        """Return the whole of it."""
        return self.value + self.behind


@dataclass
class Items:
    """Hold the items of a list, or the entries of a mapping, of which there is at least one.

    Attributes
    ----------
    start, end : what is rearranged of the text
    form : in lines; in brackets, items on lines of their own; any other in brackets
    column : of the dashes, or of the items where there are none, counted from 1
    slots : list of Slot
    gaps : what stands before each item and is not its own (between two `inline` ones their comma)
    rest : what follows the last
    ends_in_comma : there is a comma after the last of the `rows`
    on_a_dash : the first entry of the mapping stands on the line of a dash, or of a `?`
    """

    start: int
    end: int
    form: Literal["block", "rows", "inline"]
    column: int
    slots: list[Slot]
    gaps: list[str]
    rest: str = ""
    ends_in_comma: bool = False
    on_a_dash: bool = False

    def slot(self, lines: str, inside: str, style: writing.WritingStyle) -> Slot:
        """Write a new item after the form of the others: by its lines, or as within brackets."""
        if self.form == "block":
            return Slot(lines)
        if self.form == "rows":
            return Slot(" " * (self.column - 1) + inside, style.line_break)
        return Slot(inside)

    def remove(self, index: int) -> Slot:
        """Take an item out. What is not its own stays in its place."""
        slot, gap = self.slots.pop(index), self.gaps.pop(index)
        last = index == len(self.slots)
        if self.form != "inline":
            if last:
                self.rest = gap + self.rest
            else:
                self.gaps[index] = gap + self.gaps[index]
        elif not last:
            self.gaps[index] = gap + _comment(self.gaps[index])
        else:
            self.rest = _comment(gap) + self.rest
        return slot

    def insert(self, index: int, slot: Slot) -> None:
        """Put an item in."""
        separator = ", " if self.form == "inline" and self.slots else ""
        self.slots.insert(index, slot)
        self.gaps.insert(index, separator)
        if index == 0 and len(self.gaps) > 1:
            self.gaps[0], self.gaps[1] = self.gaps[1], separator

    def patch(self) -> Patch:
        """Return what comes in place of the list."""
        text, last = "", len(self.slots) - 1
        for i, (gap, slot) in enumerate(zip(self.gaps, self.slots, strict=True)):
            text = _behind(text, gap) + slot.value
            if self.form == "rows" and (i < last or self.ends_in_comma):
                text = _behind(text, ",")
            text += slot.behind
        text = _behind(text, self.rest)
        return Patch(self.start, self.end, text.lstrip(" ") if self.on_a_dash else text)


def _behind(text: str, gap: str) -> str:
    """Add what parts items; right behind a colon a comma would be part of the key."""
    return f"{text} {gap}" if gap.startswith(",") and text.endswith(":") else text + gap


def _comment(gap: str) -> str:
    """Return what stays of a separator whose comma goes."""
    return gap.replace(",", "", 1) if "#" in gap else ""


def items_of(text: str, node: Node) -> Items | None:
    """Take apart a collection in a text that ends in a line break; None where it is entangled."""
    spans = [(child.start, child.end) for child in node.children]
    if node.kind == "mapping":
        pairs = zip(node.keys, node.children, strict=True)
        spans = [(key.start, max(key.end, child.end)) for key, child in pairs]
    if node.style == "block":
        return _block(text, node, spans)
    return _rows(text, node, spans) or _inline(text, node, spans)


def _block(text: str, node: Node, spans: list[tuple[int, int]]) -> Items | None:
    dash = re.compile(rf"^[ ]{{{node.column - 1}}}-(?=\s)", re.MULTILINE)
    is_list, first = node.kind == "sequence", node.start
    on_a_dash = not first_on_line(text, first)
    if on_a_dash and is_list:
        return None
    if not on_a_dash:
        first = own_start(text, first, 0, None if is_list else node.column)
        if not is_list and node.column == 1 and first == line_start(text, 0):
            first = line_start(text, node.start)  # those that a file begins with are about the file
    starts, ends = [first], []
    for (_, end), following in zip(spans, (*spans[1:], None), strict=True):
        ends.append(writing.own_end(text, end, node.column))
        if following is not None:
            found = dash.search(text, writing.line_end(text, end)) if is_list else None
            if found is None and is_list:
                return None
            head = found.start() if found else following[0]
            starts.append(own_start(text, head, ends[-1], node.column))
    slots = [Slot(text[start:end]) for start, end in zip(starts, ends, strict=True)]
    if on_a_dash:
        slots[0] = Slot(" " * (node.column - 1) + slots[0].value)
    gaps = ["", *(text[end:start] for end, start in zip(ends, starts[1:], strict=False))]
    return Items(starts[0], ends[-1], "block", node.column, slots, gaps, on_a_dash=on_a_dash)


def _rows(text: str, node: Node, spans: list[tuple[int, int]]) -> Items | None:
    """Take apart a list in brackets, items on lines of their own; None where it is no such list."""
    starts: list[int] = []
    ends: list[int] = []
    slots: list[Slot] = []
    gaps: list[str] = []
    comma = False
    for first, last in spans:
        if not first_on_line(text, first):
            return None
        least = ends[-1] if ends else writing.line_end(text, node.start)
        if line_start(text, first) < least:
            return None
        start = own_start(text, first, least)
        comma = text.startswith(",", last)
        behind = _BEHIND.match(text, last + comma)
        if behind is None:
            return None
        gaps.append(text[ends[-1] : start] if ends else "")
        slots.append(Slot(text[start:last], behind.group()))
        starts.append(start)
        ends.append(behind.end())
    if any(not text.startswith(",", last) for _, last in spans[:-1]):
        return None
    if not first_on_line(text, node.end - 1) or (not comma and _COMMA.match(text, ends[-1])):
        return None
    column = spans[0][0] - line_start(text, spans[0][0]) + 1
    return Items(starts[0], ends[-1], "rows", column, slots, gaps, "", comma)


def _inline(text: str, node: Node, spans: list[tuple[int, int]]) -> Items:
    slots = [Slot(text[start:end]) for start, end in spans]
    gaps = ["", *(text[one[1] : other[0]] for one, other in pairwise(spans))]
    return Items(spans[0][0], spans[-1][1], "inline", node.column, slots, gaps)
