"""What a report says, whatever it is printed on: an HTML page and a PDF show the same content.

Every text is plain: a printer escapes it in its own way.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from calm.checks.finding import State

if TYPE_CHECKING:
    from calm.checks.finding import Finding
    from calm.files.checks import LimitKey

ON_THE_WAY = "launch, recovery, breaks"
"""The column of a summary for what is judged of a mooring outside its environments."""


@dataclass(frozen=True)
class Column:
    """Head of a column: title, unit below it, and whether its cells are numbers.

    `share` is that of the width which numbers and short words leave: 0 of a column of short words,
    1 of names, more of sentences.
    """

    heading: str
    unit: str = ""
    numeric: bool = False
    share: float = 1.0


@dataclass(frozen=True)
class Cell:
    """A cell: its text, a smaller line below it, and the state it tells in colour and word."""

    text: str = ""
    detail: str = ""
    state: State | None = None


@dataclass(frozen=True)
class Table:
    """Rows under columns; the last `totals` of the rows are sums.

    The rows of a table that is `sortable` may be put in another order and chosen from.
    """

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""
    totals: int = 0
    sortable: bool = False


@dataclass(frozen=True)
class Figure:
    """A drawing as SVG, and what it shows in words; a `tall` one may fill a page."""

    title: str
    svg: str
    tall: bool = False


@dataclass(frozen=True)
class Prose:
    """Sentences, each a line of its own; `state` marks those that must not be overlooked."""

    lines: tuple[str, ...]
    state: State | None = None


@dataclass(frozen=True)
class Listing:
    """Text as it stands in a file."""

    title: str
    text: str


@dataclass(frozen=True)
class Signatures:
    """Rows to be signed by hand: who, name, date, signature."""

    roles: tuple[str, ...]


Block = Table | Figure | Prose | Listing | Signatures


@dataclass(frozen=True)
class Part:
    """Blocks under a heading."""

    title: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Worst:
    """The worst that a rule finds in one column of the summary.

    `column` is an environment, or `ON_THE_WAY` for what is judged once for a mooring; `unknown`
    counts the findings that lack a figure, which a pass of others must not hide.
    """

    column: str
    finding: Finding
    unknown: int


@dataclass(frozen=True)
class Section:
    """All that a report says of one mooring or tow; it may be made in a process of its own.

    Attributes
    ----------
    name : of the mooring or tow
    parts : what is printed
    columns : the environments and what else was judged, in order; none of a single result
    worst : for each column and rule that applies there
    findings, accepted : of a design check; what of it is accepted
    limits : by which it is judged
    """

    name: str
    parts: tuple[Part, ...]
    columns: tuple[str, ...] = ()
    worst: tuple[Worst, ...] = ()
    findings: tuple[Finding, ...] = ()
    accepted: tuple[Finding, ...] = ()
    limits: tuple[LimitKey, ...] = ()


@dataclass(frozen=True)
class Report:
    """A whole report.

    Attributes
    ----------
    title, subtitle : of the first page
    front : what stands before the sections
    sections : one for each mooring or tow
    date : in words, None where no date was given
    """

    title: str
    subtitle: str
    front: tuple[Part, ...]
    sections: tuple[Section, ...]
    date: str | None = None
