"""Values put into a text, and taken out of it, at the places where libyaml found them.

A text is never written anew: what emitters of YAML keep of it (ruamel.yaml by round trip keeps most
comments) is less than a person put there, such as figures in columns and line ends of Windows.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from calm.files.composition import Node
from calm.files.editing.writing import SECTIONS, Value, WritingStyle, inline, place_of, written

_COMMENT = re.compile(r"[ \t]*#[^\n]*(?:\n|\Z)")

_FILLING = re.compile(r"(?:[ \t\r\n]|#[^\n]*\n)*")
_BLANK_LINE = re.compile(r"^[ \t]*\r?\n(?=(?:[ ]*#.*\n|[ \t]*\r?\n)*\S)", re.MULTILINE)


class Patch(NamedTuple):
    """Hold a part of a text, from start to end, and what comes in its place."""

    start: int
    end: int
    text: str


def patched(text: str, patches: Iterable[Patch]) -> str:
    """Return a text with parts of it replaced; of two at one place the first comes first."""
    pieces: list[str] = []
    done = 0
    for patch in sorted(patches, key=lambda one: one[:2]):
        pieces += text[done : patch.start], patch.text
        done = patch.end
    return "".join(pieces) + text[done:]


def line_start(text: str, place: int) -> int:
    """Return where the line of a place begins."""
    return text.rfind("\n", 0, place) + 1 or int(text.startswith("\ufeff"))


def line_end(text: str, place: int) -> int:
    """Return where the line after that of a place begins."""
    found = text.find("\n", place)
    return len(text) if found < 0 else found + 1


def first_on_line(text: str, place: int) -> bool:
    """Return whether only spaces stand before a place on its line."""
    return not text[line_start(text, place) : place].strip(" \t")


def own_end(text: str, place: int, column: int) -> int:
    """Return where the lines of something end, comments of its own included.

    Parameters
    ----------
    text : it ends in a line break
    place : the end of the value
    column : of the thing, from 1; comments below it that stand further right are its own
    """
    end = line_end(text, place)
    while (comment := _COMMENT.match(text, end)) and end < len(text):
        if _column(comment.group()) <= column:
            break
        end = comment.end()
    return end


def own_start(text: str, place: int, least: int, column: int | None = None) -> int:
    """Return where the lines of something begin, comments of its own included.

    Parameters
    ----------
    text : it ends in a line break
    place : the beginning, the first on its line
    least : comments above this are not its own
    column : nor are those further right than this, from 1
    """
    start = line_start(text, place)
    while start > least:
        above = line_start(text, start - 1)
        comment = _COMMENT.match(text, above)
        if above < least or comment is None or comment.end() != start:
            break
        if column is not None and _column(comment.group()) > column:
            break
        start = above
    return start


def _column(line: str) -> int:
    return len(line) - len(line.lstrip(" \t")) + 1


def add_entry(
    text: str, mapping: Node, name: str, value: Value, style: WritingStyle, *, open: bool = False
) -> list[Patch]:
    """Write a key that a mapping does not have, and its value, where the format has it.

    Parameters
    ----------
    text : it ends in a line break
    mapping : in it
    name : the new key
    value : Value
    style : of the file
    open : write a mapping below its key even where it is short
    """
    at = place_of(name, [key.data for key in mapping.keys])
    if mapping.style == "flow" or not mapping.keys:
        return [_flow_entry(text, mapping, at, f"{written(name, flow=True)}: {inline(value)}")]
    column = mapping.column
    lines = style.entry(name, value, column, open=open)
    if at:
        place = own_end(text, mapping.children[at - 1].end, column)
        apart = column == 1 and name in SECTIONS and _BLANK_LINE.search(text)
        return [Patch(place, place, (style.line_break if apart else "") + lines)]
    first = mapping.keys[0].start
    if first_on_line(text, first):
        place = _start(text, mapping, 0)
        return [Patch(place, place, lines)]
    indent = column - 1
    return [Patch(first, first, lines[indent:] + " " * indent)]


def _start(text: str, mapping: Node, at: int) -> int:
    """Return where the lines of a key, the first on its line, and the comments above begin.

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
    """Take out a key, its value and the comments directly above it and further right below.

    Parameters
    ----------
    text : it ends in a line break
    mapping : in it
    at : number of the entry, from 0
    """
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
    comma = before + between.index(",") if between.lstrip(" \t\r\n").startswith(",") else before
    start, end = _with_lines(text, start, end)
    return [Patch(comma, comma + (text[comma] == ","), ""), Patch(start, end, "")]


def _with_lines(text: str, start: int, end: int) -> tuple[int, int]:
    """Return the whole of the lines of a part that has them for itself, but for a comment."""
    comment = _COMMENT.match(text, end)
    if not first_on_line(text, start) or not (comment or text[end:].lstrip(" \t\r")[:1] == "\n"):
        return start, end
    return line_start(text, start), line_end(text, end)


def set_value(
    text: str, mapping: Node, at: int, value: Value, style: WritingStyle, *, open: bool = False
) -> list[Patch]:
    """Give a key another value.

    Parameters
    ----------
    text : it ends in a line break
    mapping : in it
    at : number of the entry, from 0
    value : Value
    style : of the file
    open : as for `add_entry`
    """
    key, old = mapping.keys[at], mapping.children[at]
    if isinstance(value, str) and old.kind == "scalar" and old.data is not None:
        return [set_scalar(old, value, flow=mapping.style == "flow")]
    colon = _colon(text, key.end)
    if mapping.style == "flow":
        head, below = " " + inline(value), ""
        if colon is None:
            return [Patch(key.end, key.end, ":" + head)]
    else:
        head, below = style.parts(key.data, value, mapping.column, open=open)
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
    """Write another text for a scalar, quoted as it was.

    Parameters
    ----------
    old : the scalar
    value : the new text
    flow : it stands within brackets
    """
    quote = old.style if old.style in "'\"" else ""
    return Patch(old.start, old.end, written(value, flow=flow, quote=quote))


def _colon(text: str, place: int) -> int | None:
    """Return the place after the colon of a key that ends at a place; None where it has none."""
    found = re.compile(r"\s*:").match(text, place)
    return found.end() if found else None
