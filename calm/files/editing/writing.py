"""Write values as YAML in the style of an existing file.

Keys have the order of the models. Text gets quotes only if YAML would otherwise misread it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from calm.files.composition import Node, compose
from calm.files.environment import Position
from calm.files.logbook import DocumentKeys
from calm.files.mooring_file import Solver
from calm.files.reader import MooringKeys
from calm.files.water import TableKeys

# No YAML library writes the file, because aligned columns and Windows line ends would be lost.

# Words that YAML, or other programs that read it, interpret as something else.
_WORD = re.compile(r"(?:~|=|<<|null|true|false|yes|no|on|off)?", re.IGNORECASE)

# Text that needs no quotes: no special character of YAML at the beginning, no `: ` and no ` #`.
_BEGINNING = r"(?:[^\s\-?:,\[\]{}#&*!|>'\"%@`]|-(?=[^\s,\[\]{}]))"
_PLAIN = re.compile(_BEGINNING + r"(?:[^\S\r\n\t](?=[^\s#])|:(?=\S)|[^\s:])*")
_NOT_IN_FLOW = re.compile(r"[,\[\]{}?]|:(?=[,\[\]{}]|$)")
_ESCAPED = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}


Value = str | None | Mapping[str, "Value"] | Sequence["Value"]
"""The values in a file: text, nothing, or a mapping or list of values."""


class Wording(NamedTuple):
    """A list item with its text in block style and in flow style.

    Attributes
    ----------
    lines : lines of the item and its comments in a block list, from column 1
    inline : text in flow style, without comments
    """

    value: Value
    lines: str
    inline: str


class Worded(list[Value]):
    """List items, each of which is written with the text of its `Wording`."""

    def __init__(self, wordings: Iterable[Wording]) -> None:
        self.wordings = tuple(wordings)
        super().__init__(one.value for one in self.wordings)


SECTIONS = frozenset(MooringKeys.model_fields) - {"name", "description", "position", "tow"}
"""Top-level keys whose values are always written below the key, one value per line."""

_ORDERS: tuple[tuple[str, ...], ...] = (
    tuple(MooringKeys.model_fields),
    ("fluid", "depth", "depth_range", "density", "gravity", "current", "wind", "seabed", "fouling"),
    (
        *("use", "at", "label", "count", "length", "top_depth", "body_depth", "length_at"),
        *("termination", "serial", "calibrated", "sampling", "battery_until"),
    ),
    tuple(DocumentKeys.model_fields),
    tuple(TableKeys.model_fields),
    ("speed", "toward", "w", "height", "surface_drift", "drift_depth"),
    ("file", "time"),
    tuple(Position.model_fields),
    tuple(Solver.model_fields),
)
_LAST = "clamps"


@dataclass(frozen=True)
class WritingStyle:
    """Line breaks and indentation of a YAML file.

    Attributes
    ----------
    step : indentation of a nested mapping from its key [columns]
    dash : indentation of the dashes of a list from its key [columns]
    """

    line_break: str = "\n"
    step: int = 2
    dash: int = 2

    @classmethod
    def of(cls, text: str, root: Node | None) -> WritingStyle:
        """Detect the style of a text from its first line break and its first indented entries."""
        ending = text.find("\n")
        line_break = "\r\n" if ending > 0 and text[ending - 1] == "\r" else "\n"
        step = dash = None
        for outer, inner in _below_keys(root) if root else ():
            if inner.kind == "mapping" and step is None:
                step = inner.column - outer.column
            if inner.kind == "sequence" and dash is None:
                dash = inner.column - outer.column
            if step is not None and dash is not None:
                break
        step = step or 2
        return cls(line_break, step, step if dash is None else dash)

    def entry(self, name: str, value: Value, column: int, *, open: bool = False) -> str:
        """Return the lines for a key and its value in a block mapping.

        Parameters
        ----------
        column : column of the key, from 1
        open : whether even a short mapping is written on separate lines
        """
        key = " " * (column - 1) + written(name, flow=False) + ":"
        head, below = self.parts(name, value, column, open=open)
        return key + head + self.line_break + below

    def parts(self, name: str, value: Value, column: int, *, open: bool = False) -> tuple[str, str]:
        """Return the text after the colon of a key, and the lines below the key.

        Parameters are those of `entry`.
        """
        if value is None:
            return "", ""
        if isinstance(value, str):
            return " " + written(value, flow=False), ""
        if isinstance(value, Mapping):
            if not value or not (open or name in SECTIONS or _is_deep(value)):
                return " " + inline(value), ""
            inner = column + self.step
            deep = name in ("components", "environments")
            lines = [self.entry(key, one, inner, open=deep) for key, one in value.items()]
            return "", "".join(lines)
        if isinstance(value, Worded) and value:
            return "", "".join(self.moved(one.lines, column + self.dash) for one in value.wordings)
        if not value or (not any(map(_is_long, value)) and name not in SECTIONS):
            return " " + inline(value), ""
        return "", "".join(self.item(one, column + self.dash) for one in value)

    def moved(self, lines: str, column: int) -> str:
        """Indent lines that start in column 1 to another column."""
        indented = re.sub(r"^(?=[^\n])", " " * (column - 1), lines, flags=re.MULTILINE)
        return indented.replace("\n", self.line_break)

    def item(self, value: Value, column: int, *, block: bool = False) -> str:
        """Return the lines for an item of a block list.

        Parameters
        ----------
        column : column of the dash, from 1
        block : whether each key gets its own line even in a short item
        """
        indent = " " * (column - 1)
        if isinstance(value, Mapping) and value and (block or _is_deep(value)):
            lines = "".join(self.entry(key, one, column + 2) for key, one in value.items())
            return f"{indent}- {lines[column + 1 :]}"
        return f"{indent}- {inline(value)}{self.line_break}"


def inline(value: Value) -> str:
    """Write a value on one line, in the flow style of YAML."""
    if value is None:
        return "null"
    if isinstance(value, str):
        return written(value, flow=True)
    if isinstance(value, Mapping):
        entries = (f"{written(key, flow=True)}: {inline(one)}" for key, one in value.items())
        return "{" + ", ".join(entries) + "}"
    if isinstance(value, Worded):
        return "[" + ", ".join(one.inline for one in value.wordings) + "]"
    return "[" + ", ".join(inline(one) for one in value) + "]"


def read_inline(text: str) -> Value:
    """Read a text written by `inline`; any other text is returned unchanged."""
    composition = compose(text)
    root = composition.root
    if root is None or composition.refusals or root.style != "flow":
        return text
    value: Value = root.data
    return value


def place_of(name: str, names: Sequence[str]) -> int:
    """Return the index at which to insert a new key among the existing keys `names`.

    Keys of the file format are inserted in the order of the format, other keys at the end.
    """
    order = next((one for one in _ORDERS if name in one), ())
    if name in order:
        before = order[: order.index(name)]
        known = [i for i, other in enumerate(names) if other in before]
        if known:
            return known[-1] + 1
        if any(other in order for other in names):
            return next(i for i, other in enumerate(names) if other in order)
    return names.index(_LAST) if _LAST in names and name != _LAST else len(names)


def _is_deep(value: Mapping[str, Value]) -> bool:
    """True if a value of the mapping is a mapping, or a list that contains a mapping or list."""
    return any(
        isinstance(one, Mapping)
        or (one is not None and not isinstance(one, str) and any(map(_is_long, one)))
        for one in value.values()
    )


def _is_long(value: Value) -> bool:
    return value is not None and not isinstance(value, str)


def _below_keys(node: Node) -> Iterator[tuple[Node, Node]]:
    """Yield (mapping, collection) for each collection in block style that is the value of a key.

    The mapping is the one that contains the key.
    """
    for child in node.children:
        if child.style == "block":
            if node.kind == "mapping":
                yield node, child
            yield from _below_keys(child)


def written(text: str, *, flow: bool, quote: str = "") -> str:
    """Write a text as a YAML scalar.

    Parameters
    ----------
    flow : whether the scalar is inside brackets, where a comma ends unquoted text
    quote : preferred quotation mark, or ""
    """
    if quote == "'" and text.isprintable():
        return "'" + text.replace("'", "''") + "'"
    if quote != '"' and _can_be_plain(text, flow):
        return text
    escaped = "".join(
        _ESCAPED.get(sign) or (sign if sign.isprintable() else f"\\U{ord(sign):08x}")
        for sign in text
    )
    return f'"{escaped}"'


def _can_be_plain(text: str, flow: bool) -> bool:
    if _WORD.fullmatch(text) or text.startswith(("---", "...")) or not text.isprintable():
        return False
    return bool(_PLAIN.fullmatch(text)) and not (flow and _NOT_IN_FLOW.search(text))


_COMMENT = re.compile(r"[ \t]*#[^\n]*(?:\n|\Z)")


class Patch(NamedTuple):
    """Replacement for the part of a text from `start` to `end`."""

    start: int
    end: int
    text: str


def patched(text: str, patches: Iterable[Patch]) -> str:
    """Apply patches to a text. Patches at the same position are applied in the given order."""
    pieces: list[str] = []
    done = 0
    for patch in sorted(patches, key=lambda one: one[:2]):
        pieces += text[done : patch.start], patch.text
        done = patch.end
    return "".join(pieces) + text[done:]


def line_start(text: str, place: int) -> int:
    """Return the index at which the line that contains the position `place` begins."""
    return text.rfind("\n", 0, place) + 1 or int(text.startswith("\ufeff"))


def line_end(text: str, place: int) -> int:
    """Return the index at which the line that contains the position `place` ends.

    The index is after the line break.
    """
    found = text.find("\n", place)
    return len(text) if found < 0 else found + 1


def first_on_line(text: str, place: int) -> bool:
    """True if only blanks precede the position `place` on its line."""
    return not text[line_start(text, place) : place].strip(" \t")


def own_end(text: str, place: int, column: int) -> int:
    """Return the index at which an item ends, including its comments.

    Parameters
    ----------
    text : the text, which ends with a line break
    place : index at which the value of the item ends
    column : column of the item, from 1; comments to the right of it belong to the item
    """
    end = line_end(text, place)
    while (comment := _COMMENT.match(text, end)) and end < len(text):
        if _column(comment.group()) <= column:
            break
        end = comment.end()
    return end


def own_start(text: str, place: int, least: int, column: int | None = None) -> int:
    """Return the index at which an item begins, including the comments above it.

    Parameters
    ----------
    text : the text, which ends with a line break
    place : index of the item, which is the first on its line
    least : smallest index that may be returned
    column : largest column of a comment of the item, from 1; None for any column
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
    """Return the patches that replace the value of a key.

    Parameters
    ----------
    text : the text, which ends with a line break
    at : index of the key in the mapping
    open : whether even a short mapping is written on separate lines
    """
    key, old = mapping.keys[at], mapping.children[at]
    if isinstance(value, str) and old.kind == "scalar" and old.data is not None:
        return [set_scalar(old, value, flow=mapping.style == "flow")]
    colon = _after_colon(text, key.end)
    if mapping.style == "flow":
        head, below = " " + inline(value), ""
        if colon is None:
            return [Patch(key.end, key.end, ":" + head)]
    else:
        head, below = style.parts(key.data, value, mapping.column, open=open)
    assert colon is not None
    if mapping.style == "block" and old.line > key.line:
        # The value is in lines below the key, so a comment after the key is kept.
        start, end = line_end(text, colon), own_end(text, old.end, old.column - 1)
        return [Patch(colon, colon, head), Patch(start, end, below)]
    patches = [Patch(colon, old.end, head)]
    if below:
        end = line_end(text, old.end)
        patches.append(Patch(end, end, below))
    return patches


def set_scalar(old: Node, value: str, *, flow: bool) -> Patch:
    """Return the patch that replaces the text of a scalar and keeps its quotation marks.

    `flow` is true for a scalar inside brackets.
    """
    quote = old.style if old.style in "'\"" else ""
    return Patch(old.start, old.end, written(value, flow=flow, quote=quote))


def _after_colon(text: str, place: int) -> int | None:
    found = re.compile(r"\s*:").match(text, place)
    return found.end() if found else None
