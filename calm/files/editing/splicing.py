"""Values put into a text, and taken out of it, at the places where libyaml found them.

A text is never written anew: what emitters of YAML keep of it (ruamel.yaml by round trip keeps most
comments) is less than a person put there, such as figures in columns and line ends of Windows.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

from calm.files.composition import Node
from calm.files.editing.writing import Value, WritingStyle, inline, written

_COMMENT = re.compile(r"[ \t]*#[^\n]*(?:\n|\Z)")


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
    open : write a mapping below its key even where it is short
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
