"""Entries of mappings in a text: put in, taken out, given another value."""

from __future__ import annotations

import re

from calm.files.editing.layout import SECTIONS, Layout, Value, inline, place_of
from calm.files.editing.scalars import written
from calm.files.editing.spans import (
    COMMENT,
    Patch,
    first_on_line,
    line_end,
    line_start,
    own_end,
    own_start,
)
from calm.files.nodes import Node

_FILLING = re.compile(r"(?:[ \t\r\n]|#[^\n]*\n)*")
_BLANK_LINE = re.compile(r"^[ \t]*\r?\n(?=(?:[ ]*#.*\n|[ \t]*\r?\n)*\S)", re.MULTILINE)


def add_entry(
    text: str, mapping: Node, name: str, value: Value, layout: Layout, *, open: bool = False
) -> list[Patch]:
    """A key that a mapping does not have, and its value, where the format has it.

    `open` writes a mapping below its key even where it is short.
    """
    at = place_of(name, [key.data for key in mapping.keys])
    if mapping.style == "flow" or not mapping.keys:
        return [_flow_entry(text, mapping, at, f"{written(name, flow=True)}: {inline(value)}")]
    column = mapping.column
    lines = layout.entry(name, value, column, open=open)
    if at:
        place = own_end(text, mapping.children[at - 1].end, column)
        apart = column == 1 and name in SECTIONS and _BLANK_LINE.search(text)
        return [Patch(place, place, (layout.line_break if apart else "") + lines)]
    first = mapping.keys[0].start
    if first_on_line(text, first):
        place = _start(text, mapping, 0)
        return [Patch(place, place, lines)]
    indent = column - 1
    return [Patch(first, first, lines[indent:] + " " * indent)]


def _start(text: str, mapping: Node, at: int) -> int:
    """Where the lines of a key begin, the first on its line: with the comments directly above.

    Those that a file begins with are about the file.
    """
    least = own_end(text, mapping.children[at - 1].end, mapping.column) if at else 0
    key = mapping.keys[at].start
    start = own_start(text, key, least, mapping.column)
    is_head = mapping.column == 1 and start == line_start(text, 0)
    return line_start(text, key) if is_head else start


def _flow_entry(text: str, mapping: Node, at: int, entry: str) -> Patch:
    if not mapping.keys:
        return Patch(mapping.start, mapping.end, f"{{{entry}}}")
    if at == 0:
        place = mapping.keys[0].start
        return Patch(place, place, f"{entry}, ")
    before = mapping.children[at - 1]
    place = max(before.end, mapping.keys[at - 1].end)
    # Right behind a colon a comma would be part of the key.
    space = " " if before.data is None and text[place - 1] == ":" else ""
    return Patch(place, place, f"{space}, {entry}")


def remove_entry(text: str, mapping: Node, at: int) -> list[Patch]:
    """A key and its value taken out, and the comments directly above it and further right below."""
    if len(mapping.keys) == 1:
        return [Patch(mapping.start, mapping.end, "{}")]
    if mapping.style == "flow":
        return _without_flow_entry(text, mapping, at)
    start = mapping.keys[at].start
    end = own_end(text, mapping.children[at].end, mapping.column)
    if first_on_line(text, start):
        return [Patch(_start(text, mapping, at), end, "")]
    # On the line of a dash: what comes next moves up to it.
    end += len(text[end:]) - len(text[end:].lstrip(" "))
    return [Patch(start, end, "")]


def _without_flow_entry(text: str, mapping: Node, at: int) -> list[Patch]:
    start = mapping.keys[at].start
    end = max(mapping.children[at].end, mapping.keys[at].end)
    behind = _FILLING.match(text, end)
    comma = behind.end() if behind else end
    if text[comma] == ",":
        end = comma + 1
        end += len(text[end:]) - len(text[end:].lstrip(" \t"))
        return [Patch(*_with_lines(text, start, end), "")]
    before = max(mapping.children[at - 1].end, mapping.keys[at - 1].end)
    between = text[before:start]
    if "#" not in between:
        return [Patch(before, end, "")]
    comma = before + between.index(",") if _comma_first(between) else before
    start, end = _with_lines(text, start, end)
    return [Patch(comma, comma + (text[comma] == ","), ""), Patch(start, end, "")]


def _comma_first(between: str) -> bool:
    return between.lstrip(" \t\r\n").startswith(",")


def _with_lines(text: str, start: int, end: int) -> tuple[int, int]:
    """The whole of the lines of a part that has them for itself, but for a comment."""
    comment = COMMENT.match(text, end)
    if not first_on_line(text, start) or not (comment or text[end:].lstrip(" \t\r")[:1] == "\n"):
        return start, end
    return line_start(text, start), line_end(text, end)


def set_value(
    text: str, mapping: Node, at: int, value: Value, layout: Layout, *, open: bool = False
) -> list[Patch]:
    """Another value for a key."""
    key, old = mapping.keys[at], mapping.children[at]
    if isinstance(value, str) and old.kind == "scalar" and old.data is not None:
        return [set_scalar(old, value, flow=mapping.style == "flow")]
    colon = _colon(text, key.end)
    if mapping.style == "flow":
        head, below = " " + inline(value), ""
        if colon is None:
            return [Patch(key.end, key.end, ":" + head)]
    else:
        head, below = layout.parts(key.data, value, mapping.column, open=open)
    assert colon is not None
    if mapping.style == "block" and old.line > key.line:
        # Lines below the key: a comment behind the key stays.
        start, end = line_end(text, colon), own_end(text, old.end, old.column - 1)
        return [Patch(colon, colon, head), Patch(start, end, below)]
    patches = [Patch(colon, old.end, head)]
    if below:
        end = line_end(text, old.end)
        patches.append(Patch(end, end, below))
    return patches


def set_scalar(old: Node, value: str, *, flow: bool) -> Patch:
    """Another text for a scalar, quoted as it was."""
    quote = old.style if old.style in "'\"" else ""
    return Patch(old.start, old.end, written(value, flow=flow, quote=quote))


def _colon(text: str, place: int) -> int | None:
    """The place after the colon of a key that ends at a place; None where it has none."""
    found = re.compile(r"\s*:").match(text, place)
    return found.end() if found else None
