"""A text whose lines were edited where line breaks of all kinds look alike."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import SequenceMatcher
from typing import NamedTuple

from calm.files.editing.writing import WritingStyle

_ENDINGS = ("\r\n", "\n", "\r")


class TextLine(NamedTuple):
    """Hold what a line says, and the line break after it: none after the last."""

    text: str
    line_break: str


def lines_of(text: str) -> list[TextLine]:
    """Split a text as `str.splitlines` does; an empty line follows the last line break."""
    lines = [TextLine(one.splitlines()[0], one) for one in text.splitlines(keepends=True)]
    found = [TextLine(text, whole[len(text) :]) for text, whole in lines]
    if not text or text.endswith(_ENDINGS):
        found.append(TextLine("", ""))
    return found


def retyped(text: str, lines: Sequence[str]) -> str:
    """Return a text after an editor has made these lines of it.

    Lines that are as they were keep their line breaks, and so does one that another one took the
    place of; those of new lines follow the manner of the file.
    """
    old = lines_of(text)
    usual = WritingStyle.of(text, None).line_break
    of_old = _taken_from([line.text for line in old], lines)
    ends = [usual if i is None else old[i].line_break or usual for i in of_old]
    ends[-1] = old[-1].line_break if of_old[-1] == len(old) - 1 else ""
    text = ""
    for line, end in zip(lines, ends, strict=True):
        if text.endswith("\r") and not line and end == "\n":
            end = "\r"  # both would become one line break
        text += line + end
    return text


def _taken_from(old: Sequence[str], new: Sequence[str]) -> list[int | None]:
    """Return for each new line the old one that it is, or that it took the place of."""
    # Comparing is slow, and most often only a line differs.
    head = _alike(old, new)
    tail = min(_alike(old[::-1], new[::-1]), len(old) - head, len(new) - head)
    middle = old[head : len(old) - tail], new[head : len(new) - tail]
    found: list[int | None] = [*range(head)]
    for _, start, end, new_start, new_end in SequenceMatcher(None, *middle, False).get_opcodes():
        places = range(head + start, head + end)
        count = new_end - new_start
        found += [*places, *[None] * count][:count]
    return [*found, *range(len(old) - tail, len(old))]


def _alike(old: Sequence[str], new: Sequence[str]) -> int:
    """Count the lines with which both begin."""
    pairs = enumerate(zip(old, new, strict=False))
    return next((i for i, (one, other) in pairs if one != other), min(len(old), len(new)))
