"""Which lines, comments included, belong to what in a text; pieces of text put in its place."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

COMMENT = re.compile(r"[ \t]*#[^\n]*(?:\n|\Z)")
BEHIND = re.compile(r"[ \t]*(?:#[^\n]*)?(?:\r?\n|\Z)")
"""What may follow a value on its line: a comment."""


class Patch(NamedTuple):
    """A part of a text, from start to end, and what comes in its place."""

    start: int
    end: int
    text: str


def patched(text: str, patches: Iterable[Patch]) -> str:
    """A text with parts of it replaced; of two at one place the first comes first."""
    pieces: list[str] = []
    done = 0
    for patch in sorted(patches, key=lambda one: one[:2]):
        pieces += text[done : patch.start], patch.text
        done = patch.end
    return "".join(pieces) + text[done:]


def line_start(text: str, place: int) -> int:
    """Where the line of a place begins."""
    return text.rfind("\n", 0, place) + 1 or int(text.startswith("\ufeff"))


def line_end(text: str, place: int) -> int:
    """Where the line after that of a place begins."""
    found = text.find("\n", place)
    return len(text) if found < 0 else found + 1


def first_on_line(text: str, place: int) -> bool:
    """Whether only spaces stand before a place on its line."""
    return not text[line_start(text, place) : place].strip(" \t")


def own_end(text: str, place: int, column: int) -> int:
    """Where the lines of something end, of which `place` is the end of the value.

    Comments directly below that stand further right than its `column` (from 1) are its own.
    """
    end = line_end(text, place)
    while (comment := COMMENT.match(text, end)) and end < len(text):
        if _column(comment.group()) <= column:
            break
        end = comment.end()
    return end


def own_start(text: str, place: int, least: int, column: int | None = None) -> int:
    """Where the lines of something begin that starts at `place`, the first on its line.

    Comments directly above it are its own, but not above `least`, and not those further right
    than a `column`, which belong to what is above.
    """
    start = line_start(text, place)
    while start > least:
        above = line_start(text, start - 1)
        comment = COMMENT.match(text, above)
        if above < least or comment is None or comment.end() != start:
            break
        if column is not None and _column(comment.group()) > column:
            break
        start = above
    return start


def _column(line: str) -> int:
    return len(line) - len(line.lstrip(" \t")) + 1
