"""A problem of WHOI Cable as its file says it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from calm.exchange.cbl.expressions import Expression
from calm.exchange.cbl.tokens import Token


@dataclass
class KeyValue:
    """The value of a key: a word, a formula, or rows in parentheses."""

    token: Token
    text: str = ""
    formula: Expression | None = None
    rows: list[tuple[Expression, ...]] = field(default_factory=list)
    repeats: bool = False

    def number(self, **values: float) -> float:
        """A formula's value; `values` are those of the names it may hold."""
        if self.formula is None:
            raise self.token.refuse(f"a number is missing after `{self.token.text} =`")
        return self.formula.at(**values)


KeyValues = dict[str, KeyValue]


@dataclass
class CableDefinition:
    """A buoy, an anchor, a connector or a material."""

    token: Token
    values: KeyValues

    @property
    def name(self) -> str:
        """As the layout calls it."""
        return self.token.text


@dataclass
class CableAttachment:
    """A connector hung on nodes of a segment."""

    token: Token
    nodes: list[int]


@dataclass
class CableSegment:
    """A length of one material, and what joins it to the next one up."""

    token: Token
    values: KeyValues
    attachments: list[CableAttachment] = field(default_factory=list)
    connector: Token | None = None
    joint: KeyValues = field(default_factory=dict)


@dataclass
class CableTerminal:
    """An end of the line."""

    token: Token
    values: KeyValues


@dataclass
class CableProblem:
    """The content of a problem file.

    Attributes
    ----------
    description, environment : key and value
    buoys, anchors, connectors, materials : by name
    layout : terminals and segments in the order of the file
    branch : the first word of a branch, where there is one
    """

    path: Path
    description: KeyValues = field(default_factory=dict)
    environment: KeyValues = field(default_factory=dict)
    analysis: KeyValues = field(default_factory=dict)
    buoys: dict[str, CableDefinition] = field(default_factory=dict)
    anchors: dict[str, CableDefinition] = field(default_factory=dict)
    connectors: dict[str, CableDefinition] = field(default_factory=dict)
    materials: dict[str, CableDefinition] = field(default_factory=dict)
    layout: list[CableTerminal | CableSegment] = field(default_factory=list)
    branch: Token | None = None
