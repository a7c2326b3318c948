"""Parse problem files of WHOI Cable according to their grammar."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path

from calm.exchange.cbl.formulas import Expression, TokenStream, read_expression
from calm.exchange.cbl.preprocessor import Preprocessor
from calm.exchange.cbl.words import Token, tokens_of
from calm.exchange.model import ImportOptions

_TEXTS = frozenset([
    "title", "color", "category", "comment", "type", "buoy", "platform", "anchor", "material",
    "connector", "body", "wave-file", "velocity-file", "force-file", "current-file", "flap-file",
    "forcing-method", "input-type", "static-solution", "static-initial-guess",
    "dynamic-integration", "static-outer-method",
])  # fmt: skip
"""Keys whose value is a word."""

_SECTIONS = {
    "environment": "environment", "buoys": "buoys", "platforms": "buoys", "anchors": "anchors",
    "connectors": "connectors", "materials": "materials", "layout": "layout", "end": "",
    "problem": "description", "analysis": "analysis",
}  # fmt: skip
"""Attributes of `CableProblem` that store the sections, by section name."""

_LONG_SECTIONS = {"problem": "description", "analysis": "parameters"}
"""Second words of two-word section names."""

_MOST_NODES = 1_000_000
_LAYOUT = frozenset(["terminal", "segment", "branch"])


@dataclass
class KeyValue:
    """Value of a key: a word, a formula, or rows in parentheses."""

    token: Token
    text: str = ""
    formula: Expression | None = None
    rows: list[tuple[Expression, ...]] = field(default_factory=list)
    repeats: bool = False

    def number(self, **values: float) -> float:
        """Evaluate the formula; `values` holds the values of the names in it."""
        if self.formula is None:
            raise self.token.refuse(f"a number is missing after `{self.token.text} =`")
        return self.formula.at(**values)

    def at(self, depth: float) -> float:
        """Evaluate the formula or table at a depth.

        If the first column of a table has speeds or strains, `depth` is a speed or strain instead.
        A table is interpolated linearly, and extrapolated beyond its ends.
        """
        if not self.rows:
            return self.number(H=depth, h=depth, t=0.0)
        if any(len(row) != 2 for row in self.rows):
            raise self.token.refuse(f"the rows of `{self.token.text}` must be pairs")
        pairs = [(row[0].at(), row[1].at()) for row in self.rows]
        if any(b[0] < a[0] for a, b in pairwise(pairs)):
            raise self.token.refuse(f"the rows of `{self.token.text}` must increase")
        if len(pairs) == 1:
            return pairs[0][1]
        if self.repeats and pairs[-1][0] > 0.0:
            depth = math.fmod(depth, pairs[-1][0])
        above = next((i for i, pair in enumerate(pairs) if depth <= pair[0]), len(pairs) - 1)
        (x1, y1), (x2, y2) = pairs[max(above - 1, 0)], pairs[max(above, 1)]
        return y2 if x1 == x2 else y1 + (y2 - y1) * (depth - x1) / (x2 - x1)


class KeyValues(dict[str, KeyValue]):
    """Values of a section, a definition or a block, by key."""

    def number(self, *keys: str, default: float = 0.0) -> float:
        """Return the first nonzero value among several synonymous keys, evaluated at time 0.

        `default` is returned if all keys are missing.
        """
        found = default
        for key in keys:
            if key in self:
                found = self[key].number(t=0.0)
                if found:
                    break
        return found


@dataclass
class CableDefinition:
    """Definition of a buoy, an anchor, a connector or a material."""

    token: Token
    values: KeyValues

    @property
    def name(self) -> str:
        """Name by which the layout of the problem refers to this definition."""
        return self.token.text


@dataclass
class CableSegment:
    """A segment of one material, and the connector at the upper end of the segment.

    `attachments` are connectors attached along the segment, each with the numbers of the nodes to
    which it is attached.
    """

    token: Token
    values: KeyValues
    attachments: list[tuple[Token, list[int]]] = field(default_factory=list)
    connector: Token | None = None
    joint: KeyValues = field(default_factory=KeyValues)


@dataclass
class CableTerminal(CableDefinition):
    """An end of the line: anchor, buoy or platform."""

    @property
    def buoy(self) -> KeyValue | None:
        """Name of the buoy or platform at this end; None if there is neither."""
        return self.values.get("buoy") or self.values.get("platform")


@dataclass
class CableBranch:
    """A side line, with its segments from the junction outward, and its terminal."""

    token: Token
    layout: CableItems


CableItems = list[CableTerminal | CableSegment | CableBranch]
"""Terminals, segments and branches, in file order."""


@dataclass
class CableProblem:
    """Contents of a problem file.

    `description`, `environment` and `analysis` are the sections of these names, by key. Buoys,
    anchors, connectors and materials are by name. `layout` is in file order.
    """

    path: Path
    options: ImportOptions
    description: KeyValues = field(default_factory=KeyValues)
    environment: KeyValues = field(default_factory=KeyValues)
    analysis: KeyValues = field(default_factory=KeyValues)
    buoys: dict[str, CableDefinition] = field(default_factory=dict)
    anchors: dict[str, CableDefinition] = field(default_factory=dict)
    connectors: dict[str, CableDefinition] = field(default_factory=dict)
    materials: dict[str, CableDefinition] = field(default_factory=dict)
    layout: CableItems = field(default_factory=list)

    @property
    def kind(self) -> str:
        """Type of the problem in lower case, such as ``towing``; ``general`` by default."""
        given = self.description.get("type")
        return given.text.lower() if given else "general"

    @property
    def terminals(self) -> list[CableTerminal]:
        """Ends of the line."""
        return [each for each in self.layout if isinstance(each, CableTerminal)]

    @property
    def segments(self) -> list[CableSegment]:
        """Segments of the line, from its first terminal to its last."""
        return [each for each in self.layout if isinstance(each, CableSegment)]

    @property
    def length(self) -> float:
        """Total length of the segments [m]."""
        return sum(segment.values.number("length") for segment in self.segments)


def read_problem(path: Path, options: ImportOptions) -> CableProblem:
    """Parse a problem file; raise InputError with line and column if it is invalid."""
    words = TokenStream(list(tokens_of(Preprocessor(options).read(path))))
    problem = CableProblem(path, options)
    while words.next.kind != "end":
        _section(words, problem)
    return problem


def _section(words: TokenStream, problem: CableProblem) -> None:
    name = _section_name(words)
    if name is None:
        raise words.next.refuse(f"a section must begin here, not `{words.next.text}`")
    words.take()
    if name in _LONG_SECTIONS:
        words.take()
    if name == "layout":
        problem.layout += _layout(words)
    elif name != "end":
        into = getattr(problem, _SECTIONS[name])
        if isinstance(into, KeyValues):
            into |= _values(words)
            return
        while words.next.kind in ("name", "text") and _section_name(words) is None:
            token = words.take()
            if token.text in into:
                raise token.refuse(f"`{token.text}` is defined twice")
            into[token.text] = CableDefinition(token, _values(words))


def _section_name(words: TokenStream) -> str | None:
    word, behind = words.next.text.lower(), words.ahead(1)
    if words.next.kind != "name" or word not in _SECTIONS:
        return None
    second = _LONG_SECTIONS.get(word)
    fits = second is None or (behind.kind == "name" and behind.text.lower() == second)
    return word if fits else None


def _values(words: TokenStream) -> KeyValues:
    values = KeyValues()
    while words.next.kind == "key" and words.next.text not in _LAYOUT:
        key = words.take()
        values[key.text] = _value(words, key)
    return values


def _value(words: TokenStream, key: Token) -> KeyValue:
    if key.text in _TEXTS:
        return KeyValue(key, text=_word(words, key))
    if words.is_next("{"):  # name of a profile
        words.take()
        words.take()
        words.expect("}")
    if words.is_next("(") and (rows := _rows(words)):
        return KeyValue(key, rows=rows, repeats=words.accept("+"))
    if words.next.kind == "text":
        return KeyValue(key, text=words.take().text)
    return KeyValue(key, formula=read_expression(words))


def _word(words: TokenStream, key: Token) -> str:
    token = words.take()
    if token.kind not in ("name", "text", "number"):
        raise key.refuse(f"a name is missing after `{key.text} =`")
    text = token.text
    while words.is_next("-") and words.ahead(1).kind == "name":
        words.take()
        text += "-" + words.take().text
    return text


def _rows(words: TokenStream) -> list[tuple[Expression, ...]]:
    """Parse rows such as ``(0, 0.5) (100, 0.2)``; return no rows for a formula in parentheses."""
    rows: list[tuple[Expression, ...]] = []
    while True:
        back = words.at
        if rows:
            words.accept(",")
        if not words.accept("("):
            words.at = back
            return rows
        row = [read_expression(words)]
        while words.accept(","):
            row.append(read_expression(words))
        words.expect(")")
        if not rows and len(row) == 1:
            words.at = back
            return []
        rows.append(tuple(row))


def _layout(words: TokenStream) -> CableItems:
    layout: CableItems = []
    while words.next.kind == "key":
        key = words.take()
        if key.text == "terminal":
            layout.append(CableTerminal(key, _block(words)))
        elif key.text == "segment":
            layout.append(_segment(words, key))
        elif key.text == "connector":
            _connector(words, key, layout)
        elif key.text == "branch":
            words.expect("{")
            layout.append(CableBranch(key, _layout(words)))
            words.expect("}")
        else:
            raise key.refuse(f"`{key.text} =` is not allowed in a layout")
    return layout


def _block(words: TokenStream) -> KeyValues:
    words.expect("{")
    values = _values(words)
    words.expect("}")
    return values


def _segment(words: TokenStream, key: Token) -> CableSegment:
    segment = CableSegment(key, KeyValues())
    words.expect("{")
    while words.next.kind == "key":
        name = words.take()
        if name.text == "attachments":
            segment.attachments += _attachments(words, name)
        else:
            segment.values[name.text] = _value(words, name)
    words.expect("}")
    return segment


def _connector(words: TokenStream, key: Token, layout: CableItems) -> None:
    below = layout[-1] if layout else None
    if not isinstance(below, CableSegment):
        raise key.refuse("a connector must follow a segment")
    body: KeyValue | None
    if words.is_next("{"):
        below.joint = _block(words)
        body = below.joint.get("body") or below.joint.get("connector")
    else:
        body = KeyValue(key, _word(words, key))
    if body is not None:
        below.connector = replace(body.token, kind="name", text=body.text)


def _attachments(words: TokenStream, key: Token) -> list[tuple[Token, list[int]]]:
    """Parse lists such as ``meter : (3 9 27), light : [2, 2, 40]``."""
    found: list[tuple[Token, list[int]]] = []
    while words.next.kind in ("name", "text"):
        token = words.take()
        words.accept(":")
        found.append((token, _nodes(words, token)))
        words.accept(",")
    if not found:
        raise key.refuse("`attachments` names nothing")
    return found


def _nodes(words: TokenStream, token: Token) -> list[int]:
    spaced = words.accept("[")
    if not spaced:
        words.expect("(")
    numbers: list[int] = []
    while words.next.kind == "number":
        numbers.append(round(words.take().number))
        words.accept(",")
    words.expect("]" if spaced else ")")
    if not spaced:
        return numbers
    if len(numbers) != 3 or numbers[1] < 1 or numbers[2] > _MOST_NODES:
        raise token.refuse("nodes must be given as [first, step, last]")
    return list(range(numbers[0], numbers[2] + 1, numbers[1]))
