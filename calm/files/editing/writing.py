"""How values are written into a file: after its manner, in the order of the keys in the models.

A text is plain where that reads back, and in quotes where it would not.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from calm.files.composition import Node
from calm.files.environment import Position
from calm.files.logbook import DocumentKeys
from calm.files.mooring_file import Solver
from calm.files.reader import MooringKeys
from calm.files.water import TableKeys

# Read otherwise by YAML, or by other programs that read it.
_WORD = re.compile(r"(?:~|=|<<|null|true|false|yes|no|on|off)?", re.IGNORECASE)

# What may stand without quotes: no sign of YAML at its beginning, no `: ` nor ` #` within.
_BEGINNING = r"(?:[^\s\-?:,\[\]{}#&*!|>'\"%@`]|-(?=[^\s,\[\]{}]))"
_PLAIN = re.compile(_BEGINNING + r"(?:[^\S\r\n\t](?=[^\s#])|:(?=\S)|[^\s:])*")
_NOT_IN_FLOW = re.compile(r"[,\[\]{}?]|:(?=[,\[\]{}]|$)")
_ESCAPED = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}


Value = str | None | Mapping[str, "Value"] | Sequence["Value"]
"""What a file can hold: text, nothing, or a mapping or list of what it can hold."""


class Wording(NamedTuple):
    """Hold an item of a list as it is written.

    Attributes
    ----------
    value : Value
    lines : in a block list that begins in column 1, with its comments
    above, inline, behind : the comments above it, its text within brackets, and what follows that
        on its line
    """

    value: Value
    lines: str
    above: str
    inline: str
    behind: str


class Worded(list[Value]):
    """Hold items of a list that keep their wording."""

    def __init__(self, wordings: Iterable[Wording]) -> None:
        self.wordings = tuple(wordings)
        super().__init__(one.value for one in self.wordings)


SECTIONS = frozenset(MooringKeys.model_fields) - {"name", "description", "position", "tow"}
"""Keys whose values are written below them, a line each."""

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
    """Hold how a file is written: its line breaks and indentation.

    Attributes
    ----------
    line_break : str
    step : columns by which what is below a key is indented
    dash : the same for the dashes of a list
    """

    line_break: str = "\n"
    step: int = 2
    dash: int = 2

    @classmethod
    def of(cls, text: str, root: Node | None) -> WritingStyle:
        """Return the manner of a text, as its first places show it."""
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
        """Write the lines of an entry of a block mapping whose keys stand in a column (from 1).

        Parameters
        ----------
        name : the key
        value : Value
        column : of the key, from 1
        open : write a mapping below its key even where it is short
        """
        key = " " * (column - 1) + written(name, flow=False) + ":"
        head, below = self.parts(name, value, column, open=open)
        return key + head + self.line_break + below

    def parts(self, name: str, value: Value, column: int, *, open: bool = False) -> tuple[str, str]:
        """Write what follows the colon of a key, and the lines below it.

        Parameters
        ----------
        name : the key
        value : Value
        column : of the key, from 1
        open : as for `entry`
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
        """Move lines that begin in column 1 to another one."""
        indented = re.sub(r"^(?=[^\n])", " " * (column - 1), lines, flags=re.MULTILINE)
        return indented.replace("\n", self.line_break)

    def item(self, value: Value, column: int, *, block: bool = False) -> str:
        """Write the lines of an item whose dash stands in a column.

        Parameters
        ----------
        value : Value
        column : of the dash, from 1
        block : write a key a line, as is done of an item that has items of its own
        """
        indent = " " * (column - 1)
        if isinstance(value, Mapping) and value and (block or _is_deep(value)):
            lines = "".join(self.entry(key, one, column + 2) for key, one in value.items())
            return f"{indent}- {lines[column + 1 :]}"
        return f"{indent}- {inline(value)}{self.line_break}"


def inline(value: Value) -> str:
    """Write a value on one line, as it stands within brackets."""
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


def place_of(name: str, names: Sequence[str]) -> int:
    """Return where a new key goes among others: in the order of the format, else at the end."""
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
    """Return whether a mapping holds more than texts and short lists of texts."""
    return any(
        isinstance(one, Mapping)
        or (one is not None and not isinstance(one, str) and any(map(_is_long, one)))
        for one in value.values()
    )


def _is_long(value: Value) -> bool:
    return value is not None and not isinstance(value, str)


def _below_keys(node: Node) -> Iterator[tuple[Node, Node]]:
    """Return the block collections that stand below a key: with the mapping of the key."""
    for child in node.children:
        if child.style == "block":
            if node.kind == "mapping":
                yield node, child
            yield from _below_keys(child)


def written(text: str, *, flow: bool, quote: str = "") -> str:
    """Write a text as a scalar of YAML.

    Parameters
    ----------
    text : str
    flow : it is to stand within brackets, where commas and brackets end a plain text
    quote : the sign it was quoted with so far, which is kept
    """
    if quote == "'" and text.isprintable():
        return "'" + text.replace("'", "''") + "'"
    if quote != '"' and _stands_plain(text, flow):
        return text
    escaped = "".join(
        _ESCAPED.get(sign) or (sign if sign.isprintable() else f"\\U{ord(sign):08x}")
        for sign in text
    )
    return f'"{escaped}"'


def _stands_plain(text: str, flow: bool) -> bool:
    if _WORD.fullmatch(text) or text.startswith(("---", "...")) or not text.isprintable():
        return False
    return bool(_PLAIN.fullmatch(text)) and not (flow and _NOT_IN_FLOW.search(text))
