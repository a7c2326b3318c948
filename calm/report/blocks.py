"""What CALM says, for every medium: a terminal, a page, a PDF and a notebook print the same.

Every text is plain: a printer escapes it in its own way, and nothing in a text is markup.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar

from calm.checks.finding import Finding, State

if TYPE_CHECKING:
    from calm.report.check_facts import CheckFacts

Item = TypeVar("Item")

ON_THE_WAY = "launch, recovery, breaks"
"""The column of a summary for what is judged of a mooring outside its environments."""


@dataclass(frozen=True)
class Column:
    """Head of a column: title, unit below it, and whether its cells are numbers.

    `share` is that of the width which numbers and short words leave: 0 of a column of short words,
    1 of names, more of sentences. `short` is the title, in lines, where there is little room; a
    column that is not `narrow` is left out there. In one that is `marked` cells may carry a mark.
    """

    heading: str
    unit: str = ""
    numeric: bool = False
    share: float = 1.0
    short: str | None = None
    narrow: bool = True
    marked: bool = False


@dataclass(frozen=True)
class Cell:
    """A cell: its text, a smaller line below it, and the state it shows in colour and word.

    `mark` is the sign after a figure that is near a limit or beyond it. A cell may be indented
    below the row above it, and `strong` where the reader looks for it. On paper the detail of
    one that `goes_on` follows in the same line.
    """

    text: str = ""
    detail: str = ""
    state: State | None = None
    mark: str = ""
    indented: bool = False
    strong: bool = False
    goes_on: bool = False


@dataclass(frozen=True)
class Table:
    """Rows under columns; the last `totals` of the rows are sums.

    A row of a single cell heads those below it. The rows of a table that is `sortable` may be put
    in another order and chosen from; a `dense` one has more columns than fit with room to spare.
    One that is to be filled in `by_hand` has rules and room to write; of any other, columns without
    a word in them are left out.
    """

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""
    totals: int = 0
    sortable: bool = False
    dense: bool = False
    by_hand: bool = False

    def __post_init__(self) -> None:
        """Leave out the columns in which no row has a word."""
        count = len(self.columns)
        full = [row for row in self.rows if len(row) == count]
        kept = [at for at in range(count) if any(row[at] != _EMPTY for row in full)]
        if self.by_hand or not full or len(kept) == count:
            return
        rows = (row if len(row) < count else tuple(row[at] for at in kept) for row in self.rows)
        object.__setattr__(self, "rows", tuple(rows))
        object.__setattr__(self, "columns", tuple(self.columns[at] for at in kept))


_EMPTY = Cell()


@dataclass(frozen=True)
class Pairs:
    """Hold a name and a value of each of several things; a value may have several lines."""

    pairs: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Figure:
    """A drawing as SVG, and what it shows in words; a `tall` one may fill a page."""

    title: str
    svg: str
    tall: bool = False


@dataclass(frozen=True)
class Plate:
    """A drawing as SVG that is as large as a page and has it to itself, and what it shows."""

    title: str
    svg: str


@dataclass(frozen=True)
class Span:
    """Words of a sentence that look as a state does, or `quiet` as what is read last."""

    text: str
    state: State | None = None
    quiet: bool = False


Line = str | tuple[Span, ...]
"""A sentence, as it is or in spans."""


@dataclass(frozen=True)
class Prose:
    """Sentences, each a line of its own; `state` marks those that must not be overlooked."""

    lines: tuple[Line, ...]
    state: State | None = None


@dataclass(frozen=True)
class Note:
    """Sentences about how to read the figures above."""

    lines: tuple[str, ...]


@dataclass(frozen=True)
class Heading:
    """A title over the blocks that follow."""

    text: str


@dataclass(frozen=True)
class Listing:
    """Text as it stands in a file."""

    title: str
    text: str


@dataclass(frozen=True)
class Signatures:
    """Rows to be signed by hand: who, name, date, signature."""

    roles: tuple[str, ...]


@dataclass(frozen=True)
class PageBreak:
    """Begin a page with what follows, where there are pages."""


Block = Table | Pairs | Figure | Prose | Note | Heading | Listing | Signatures | PageBreak


@dataclass(frozen=True)
class ReportPart:
    """Blocks under a heading; what a command shows of one thing is a part of its own.

    On paper no text of it is smaller than `least` [pt].
    """

    title: str
    blocks: tuple[Block, ...]
    least: float = 8.0


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
    facts : what is signed, of a design check
    """

    name: str
    parts: tuple[ReportPart, ...]
    columns: tuple[str, ...] = ()
    worst: tuple[Worst, ...] = ()
    facts: CheckFacts | None = None


@dataclass(frozen=True)
class Report:
    """A whole report.

    Attributes
    ----------
    title, subtitle : of the first page
    front : what stands before the sections
    sections : one for each mooring or tow
    date : in words, None where no date was given
    plates : drawings before all else
    verdict : at the head of every page, with its state
    foot : at the foot of every page
    """

    title: str
    subtitle: str
    front: tuple[ReportPart, ...]
    sections: tuple[Section, ...]
    date: str | None = None
    plates: tuple[Plate, ...] = ()
    verdict: Span | None = None
    foot: str = ""


Field = tuple[Column, Callable[[Item], Cell | str]]
"""Head of a column, and what it shows of an item."""


def table_of(
    title: str,
    items: Iterable[Item],
    *fields: Field[Item],
    note: str = "",
    sums: Iterable[Item] = (),
    sortable: bool = False,
    by_hand: bool = False,
) -> Table:
    """Return a table with a row for each item and a column for each field.

    Parameters
    ----------
    fields : head of a column, and what it shows of an item
    note : below the table
    sums : items whose rows close the table as its totals
    sortable, by_hand : as in `Table`
    """
    totals = list(sums)
    shown = ([show(item) for _, show in fields] for item in (*items, *totals))
    rows = tuple(tuple(Cell(c) if isinstance(c, str) else c for c in row) for row in shown)
    columns = tuple(column for column, _ in fields)
    return Table(title, columns, rows, note, len(totals), sortable=sortable, by_hand=by_hand)
