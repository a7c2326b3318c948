"""Lists in a text, taken apart into the texts of their items, rearranged, and put together."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, NamedTuple

from calm.files.editing.spans import (
    BEHIND,
    Patch,
    first_on_line,
    line_end,
    line_start,
    own_end,
    own_start,
)
from calm.files.nodes import Node

_COMMA = re.compile(r"(?:\s|#[^\n]*\n)*,")


class Slot(NamedTuple):
    """The text of an item: up to the end of its value, and what follows it (no comma).

    Where items have lines of their own it is these lines, comments that belong to it included.
    """

    value: str
    behind: str = ""

    @property
    def text(self) -> str:
        """The whole of it."""
        return self.value + self.behind


@dataclass
class Items:
    """The items of a list, of which there is at least one, in a text.

    Attributes
    ----------
    start, end : int
        What is rearranged of the text.
    form : "block", "rows" or "inline"
        A block list; one in brackets whose items have lines of their own; any other in brackets.
    column : int
        Of the dashes, or of the items where there are none, counted from 1.
    slots : list of Slot
    gaps : list of str
        What stands before each item and is not its own (between two `inline` ones their comma).
    rest : str
        What follows the last.
    ends_in_comma : bool
        There is a comma after the last of the `rows`.
    """

    start: int
    end: int
    form: Literal["block", "rows", "inline"]
    column: int
    slots: list[Slot]
    gaps: list[str]
    rest: str = ""
    ends_in_comma: bool = False

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
        """What comes in place of the list."""
        pieces: list[str] = []
        last = len(self.slots) - 1
        for i, (gap, slot) in enumerate(zip(self.gaps, self.slots, strict=True)):
            comma = self.form == "rows" and (i < last or self.ends_in_comma)
            pieces += gap, slot.value, "," if comma else "", slot.behind
        return Patch(self.start, self.end, "".join(pieces) + self.rest)


def _comment(gap: str) -> str:
    """What stays of a separator whose comma goes."""
    return gap.replace(",", "", 1) if "#" in gap else ""


def items_of(text: str, node: Node) -> Items | None:
    """The items of a list in a text that ends in a line break; None where they are entangled."""
    if node.style == "block":
        return _block(text, node)
    return _rows(text, node) or _inline(text, node)


def _block(text: str, node: Node) -> Items | None:
    dash = re.compile(rf"^[ ]{{{node.column - 1}}}-(?=\s)", re.MULTILINE)
    if not first_on_line(text, node.start):
        return None
    starts, ends = [own_start(text, node.start, 0)], []
    for child, following in zip(node.children, (*node.children[1:], None), strict=True):
        ends.append(own_end(text, child.end, node.column))
        if following is not None:
            found = dash.search(text, line_end(text, child.end))
            if found is None:
                return None
            starts.append(own_start(text, found.start(), ends[-1], node.column))
    slots = [Slot(text[start:end]) for start, end in zip(starts, ends, strict=True)]
    gaps = ["", *(text[end:start] for end, start in zip(ends, starts[1:], strict=False))]
    return Items(starts[0], ends[-1], "block", node.column, slots, gaps)


def _rows(text: str, node: Node) -> Items | None:
    """A list in brackets, an item to a line or to several; None where it is no such list."""
    starts: list[int] = []
    ends: list[int] = []
    slots: list[Slot] = []
    gaps: list[str] = []
    comma = False
    for child in node.children:
        if not first_on_line(text, child.start):
            return None
        least = ends[-1] if ends else line_end(text, node.start)
        if line_start(text, child.start) < least:
            return None
        start = own_start(text, child.start, least)
        comma = text.startswith(",", child.end)
        behind = BEHIND.match(text, child.end + comma)
        if behind is None:
            return None
        gaps.append(text[ends[-1] : start] if ends else "")
        slots.append(Slot(text[start : child.end], behind.group()))
        starts.append(start)
        ends.append(behind.end())
    if any(not text.startswith(",", child.end) for child in node.children[:-1]):
        return None
    if not first_on_line(text, node.end - 1) or (not comma and _COMMA.match(text, ends[-1])):
        return None
    column = node.children[0].column
    return Items(starts[0], ends[-1], "rows", column, slots, gaps, "", comma)


def _inline(text: str, node: Node) -> Items:
    children = node.children
    slots = [Slot(text[child.start : child.end]) for child in children]
    gaps = ["", *(text[one.end : other.start] for one, other in pairwise(children))]
    start, end = children[0].start, children[-1].end
    return Items(start, end, "inline", children[0].column, slots, gaps)
