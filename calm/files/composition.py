"""YAML text to nodes, the unchanged parts of a text that is edited taken from memory.

Composing is slow: 20 ms for a line of 60 items. A block collection whose entries begin in one
column is therefore composed entry by entry, each text remembered. The outcome is that of
composing the whole: at the beginning of a line in that column YAML's scanner, unless it is within
quotes or brackets, is where it was at the beginning of the entry before. Within them the entry
above does not end, which is an error when it is composed by itself; then, as for all else that
does not fit, the whole is composed.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

from ruamel.yaml import YAML, tokens
from ruamel.yaml.error import YAMLError

from calm.files.nodes import Node, NodeReader, Refusal

_WORTHWHILE = 150
"""Characters from which on a text is composed in parts."""

_BREAK = "\n\r\x85\u2028\u2029"
_NOT_CONTENT = re.compile(rf"(?:[ ]*(?:#[^{_BREAK}]*)?\r?\n)*")
_HEADER = re.compile(rf"[ ]*[A-Za-z_][\w-]*:(?:[ ]+#[^{_BREAK}]*|[ ]*)\r?\n")
_DOCUMENT_SIGN = re.compile(r"^(?:---|\.\.\.|%)", re.MULTILINE)
_LINE_BREAK = re.compile(r"\r\n?|\n")
_BRACKET = re.compile(r"[\[\]{}]")
_BRACKETS: dict[type, str] = {
    tokens.FlowSequenceStartToken: "[",
    tokens.FlowSequenceEndToken: "]",
    tokens.FlowMappingStartToken: "{",
    tokens.FlowMappingEndToken: "}",
}

_DEEPEST = 100
"""Brackets within brackets; the time to read them grows with the square of their number."""


class _Unfit(Exception):
    """The text cannot be composed in parts."""


@dataclass(frozen=True)
class Composition:
    """The nodes of a text (None: it is empty), and what in it is not allowed."""

    root: Node | None
    refusals: tuple[Refusal, ...] = ()


def compose(text: str) -> Composition:
    """The nodes of a YAML text.

    Raises
    ------
    YAMLError, ValueError, IndexError, RecursionError
        By ruamel.yaml, of a text that is no valid YAML.
    """
    _refuse_depth(text)
    mark = 1 if text.startswith("\ufeff") else 0
    # YAML drops a byte order mark before a text, which a part would have and the whole has not.
    if not _DOCUMENT_SIGN.search(text) and "\ufeff" not in text[mark:]:
        try:
            return Composition(_in_parts(text[mark:], mark, 0))
        except (_Unfit, YAMLError, ValueError, IndexError, RecursionError):
            pass
    return _whole(text)


def compose_whole(text: str) -> Composition:
    """The same without memory, in less time where the text is read once; errors are the same."""
    _refuse_depth(text)
    return _whole(text)


def _whole(text: str) -> Composition:
    root = YAML(typ="safe", pure=True).compose(text)
    if root is None:
        return Composition(None)
    reader = NodeReader(text)
    node = reader.read(root)
    return Composition(node, tuple(reader.refusals))


def _refuse_depth(text: str) -> None:
    """Raise RecursionError where brackets stand within brackets too often to be read in time."""
    if not _is_too_deep(_BRACKET.findall(text)):
        return
    try:  # some may stand in comments and quotes
        kinds = map(type, YAML(typ="safe", pure=True).scan(text))
        is_refused = _is_too_deep(_BRACKETS[kind] for kind in kinds if kind in _BRACKETS)
    except YAMLError:
        return  # which composing says too
    if is_refused:
        raise RecursionError


def _is_too_deep(signs: Iterable[str]) -> bool:
    depth = 0
    for sign in signs:
        depth = depth + 1 if sign in "[{" else max(depth - 1, 0)
        if depth > _DEEPEST:
            return True
    return False


def _in_parts(text: str, offset: int, lines: int) -> Node:
    """The block collection that a text is, which begins with a line of its own.

    `offset` characters and `lines` lines of the whole stand before it.
    """
    filling = _NOT_CONTENT.match(text)
    start = filling.end() if filling else 0
    column = len(text) - start - len(text[start:].lstrip(" "))
    is_sequence = text[start + column : start + column + 1] == "-"
    entries: list[Node] = []
    cuts = [match.start() for match in _beginnings(column, is_sequence).finditer(text, start)]
    if not cuts or cuts[0] != start:
        raise _Unfit
    lines += len(_LINE_BREAK.findall(text, 0, start))
    for cut, end in zip(cuts, [*cuts[1:], len(text)], strict=True):
        part = text[cut:end]
        entries.append(_entry(part, offset + cut, lines, column, is_sequence))
        lines += len(_LINE_BREAK.findall(part))
    return _joined(entries)


@lru_cache(maxsize=64)
def _beginnings(column: int, is_sequence: bool) -> re.Pattern[str]:
    """Where entries begin: in their column, and in a mapping not with the dash of an item.

    What begins in that column and is no entry (`?`, `:`) is taken for one, and found out later.
    """
    entry = r"-(?=\s)" if is_sequence else r"(?!-\s)[^\s#]"
    return re.compile(rf"^[ ]{{{column}}}{entry}", re.MULTILINE)


def _entry(part: str, offset: int, lines: int, column: int, is_sequence: bool) -> Node:
    """The collection of a single entry that a part is."""
    if len(part) > _WORTHWHILE:
        try:
            inner = _inner(part, offset, lines, column, is_sequence)
        except (_Unfit, YAMLError, ValueError, IndexError):
            pass
        else:
            return inner
    node = _remembered(part, offset, lines)
    kind = "sequence" if is_sequence else "mapping"
    if (node.kind, node.style, node.column) != (kind, "block", column + 1):
        raise _Unfit
    return node


def _inner(part: str, offset: int, lines: int, column: int, is_sequence: bool) -> Node:
    """The same, what is below its dash or its key composed in parts again."""
    start = offset + column
    if is_sequence:
        # Below its dash the item stands as it would below a key.
        blank = " " * (column + 1)
        child = _in_parts(blank + part[column + 1 :], offset, lines)
        place = (start, child.end, lines + 1, column + 1)
        if child.column <= column + 1:
            raise _Unfit
        return Node("sequence", *place, "block", [child.data], (), (child,))
    header = _HEADER.match(part)
    if header is None:
        raise _Unfit
    child = _in_parts(part[header.end() :], offset + header.end(), lines + 1)
    if child.column <= column + (child.kind == "mapping"):
        raise _Unfit
    name = part[column : part.index(":")]
    key = Node("scalar", start, start + len(name), lines + 1, column + 1, "", name)
    place = (start, child.end, lines + 1, column + 1)
    return Node("mapping", *place, "block", {name: child.data}, (key,), (child,))


@lru_cache(maxsize=4096)
def _remembered(part: str, offset: int, lines: int) -> Node:
    return _composed(part).shifted(offset, lines)


@lru_cache(maxsize=4096)
def _composed(part: str) -> Node:
    root = YAML(typ="safe", pure=True).compose(part)
    if root is None or part.lstrip(" ")[0] in "?:":
        raise _Unfit
    reader = NodeReader(part)
    node = reader.read(root)
    if reader.refusals or len(node.children) != 1:
        raise _Unfit
    return node


def _joined(entries: list[Node]) -> Node:
    first, last = entries[0], entries[-1]
    children = tuple([entry.children[0] for entry in entries])
    if first.kind == "sequence":
        data = [child.data for child in children]
        return first._replace(end=last.end, data=data, children=children)
    keys = tuple([entry.keys[0] for entry in entries])
    table = {key.data: child.data for key, child in zip(keys, children, strict=True)}
    if len(table) < len(keys):
        raise _Unfit
    return first._replace(end=last.end, data=table, keys=keys, children=children)
