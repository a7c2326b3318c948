"""Blocks that CALM speaks in, for every medium: terminal, page, PDF and notebook print the same.

Every text is plain: a printer escapes it in its own way, and nothing in a text is markup.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter, itemgetter
from typing import Any

from calm.checks.finding import State
from calm.quantities import QUANTITIES, Quantity


@dataclass(frozen=True)
class Column:
    """Head of a column: title, unit below it, and whether its cells are numbers.

    `share` is that of the width which numbers and short words leave: 0 of a column of short words,
    1 of names, more of sentences; a column of numbers has one if it is not 1. `short` is the title,
    in lines, where there is little room; a column that is not `narrow` is left out there. In one
    that is `marked` cells may carry a mark.
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
    one that `goes_on` follows in the same line, and `then` is what is to be done about it. A `bar`
    is a share of a limit, drawn with its mark at 1, `picture` a drawing as SVG; `tone` is how a
    share stands out in a matrix: `fail`, `over` or `near`.
    """

    text: str = ""
    detail: str = ""
    state: State | None = None
    mark: str = ""
    indented: bool = False
    strong: bool = False
    goes_on: bool = False
    then: str = ""
    bar: float | None = None
    picture: str = ""
    tone: str = ""


@dataclass(frozen=True)
class Table:
    """Rows under columns; the last `totals` of the rows are sums.

    A row of a single cell heads those below it. The rows of a table that is `sortable` may be put
    in another order and chosen from; a `dense` one has more columns than fit with room to spare.
    One that is to be filled in `by_hand` has rules and room to write. `aside` stands beside the
    title, in smaller letters. One that is `ruled` has a hair line below each row.
    """

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Cell, ...], ...]
    note: str = ""
    totals: int = 0
    sortable: bool = False
    dense: bool = False
    by_hand: bool = False
    aside: str = ""
    ruled: bool = True

    def without_empty_columns(self) -> Table:
        """Return the table without the columns in which no row has a word, unless `by_hand`."""
        count = len(self.columns)
        full = [row for row in self.rows if len(row) == count]
        kept = [at for at in range(count) if any(row[at] != _EMPTY for row in full)]
        return self._of(kept) if full and len(kept) < count and not self.by_hand else self

    def narrow(self) -> Table:
        """Return the table without the columns for which there is no room."""
        return self._of([n for n, one in enumerate(self.columns) if one.narrow])

    def _of(self, kept: Sequence[int]) -> Table:
        """Columns by their numbers, and their rows; a single cell heads the rows below it."""
        rows = (row if len(row) == 1 else tuple(row[at] for at in kept) for row in self.rows)
        columns = tuple(self.columns[at] for at in kept)
        return replace(self, columns=columns, rows=tuple(rows))


_EMPTY = Cell()


@dataclass(frozen=True)
class Pairs:
    """Hold a name and a value of each of several things; a value may have several lines."""

    pairs: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Figure:
    """A drawing as SVG, and what it shows in words; a `tall` one may fill a page.

    `aside` stands beside the title, `note` below the drawing.
    """

    title: str
    svg: str
    tall: bool = False
    aside: str = ""
    note: str = ""


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
    """Text as it stands in a file; on paper that is attached by its `name`, where it has one.

    One that takes more than `most` lines there is in the attachment alone.
    """

    title: str
    text: str
    name: str = ""
    most: int = 0


@dataclass(frozen=True)
class TitleBlock:
    """What a drawing is: above and below its title in small letters, and its fields."""

    above: str
    title: str
    below: str
    fields: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class SignOff:
    """Revisions, and boxes to sign in, each with the name that is known; at the foot of a page.

    Attributes
    ----------
    revisions : revision, date, by whom and what for
    roles : who signs, and the name
    note : beside the boxes
    """

    revisions: tuple[tuple[str, str, str, str], ...]
    roles: tuple[tuple[str, str], ...]
    note: str


@dataclass(frozen=True)
class OpenItem:
    """What is open: its state and number, what it is, and what was found and is to be done."""

    state: State
    number: int
    head: str
    text: str


@dataclass(frozen=True)
class OpenItems:
    """The gravest items first; where not all have room, `more` says where the others stand."""

    title: str
    items: tuple[OpenItem, ...]
    note: str = ""
    more: str = ""


@dataclass(frozen=True)
class Beside:
    """Blocks beside each other on paper, the left ones with a share of the width.

    With a `height` [pt] they have that on paper, and no more.
    """

    left: tuple[Block, ...]
    right: tuple[Block, ...]
    share: float = 0.5
    height: float = 0.0


@dataclass(frozen=True)
class PageBreak:
    """Begin a page with what follows, where there are pages."""


Block = (
    Table | Pairs | Figure | Prose | Note | Heading | Listing | PageBreak | TitleBlock | SignOff
    | OpenItems | Beside
)  # fmt: skip


@dataclass(frozen=True)
class ReportPart:
    """Blocks under a heading; what a command shows of one thing is a part of its own.

    Its tables have letters of a size [pt] on paper; nothing but a listing has smaller ones.
    """

    title: str
    blocks: tuple[Block, ...]
    size: float = 8.0


@dataclass(frozen=True)
class Running:
    """Hold what stands at the head and the foot of every page.

    Attributes
    ----------
    document, title : on the left of the head
    verdict, date : on its right
    foot : on the left of the foot; the number of the page is on its right
    """

    document: str = ""
    title: str = ""
    verdict: str = ""
    date: str = ""
    foot: str = ""


@dataclass(frozen=True)
class Section:
    """All that a report says of one mooring or tow: its name, and the parts that are printed.

    A section may be made in a process of its own. One with `running` texts of its own begins a
    page, and has no other title.
    """

    name: str
    parts: tuple[ReportPart, ...]
    running: Running | None = None


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
    running : in place of title, verdict, date and foot, where the first page has a block of its own
    """

    title: str
    subtitle: str
    front: tuple[ReportPart, ...]
    sections: tuple[Section, ...]
    date: str | None = None
    plates: tuple[Figure, ...] = ()
    verdict: Span | None = None
    foot: str = ""
    running: Running | None = None


Field = tuple[Column, Callable[[Any], Any]]
"""Head of a column, and what it shows of an item: a cell, a text, a number, or None for nothing."""

Shown = str | int | Callable[[Any], Any]


def words(heading: str, show: Shown = "", share: float = 1.0, **more: Any) -> Field:
    """A column of words for `table_of`.

    Parameters
    ----------
    heading : over it
    show : what it shows of an item, the name of an attribute, by default that of the heading, or
        which of its members
    share : of the width, as in `Column`
    more : what else a `Column` says
    """
    return Column(heading, share=share, **more), _getter(show, heading)


def _getter(show: Shown, name: str) -> Callable[[Any], Any]:
    if isinstance(show, int):
        return itemgetter(show)
    return attrgetter(show or name) if isinstance(show, str) else show


def number(heading: str, show: Shown = "", unit: str = "", **more: Any) -> Field:
    """A column of numbers, with the unit below its heading; all else as in `words`."""
    return words(heading, show, unit=unit, numeric=True, **more)


def of_first(*fields: Field) -> list[Field]:
    """The same columns for items that begin with what they show."""

    def first(show: Callable[[Any], Any]) -> Callable[[Any], Any]:
        return lambda row: show(row[0])

    return [(column, first(show)) for column, show in fields]


def blank(heading: str, unit: str = "", share: float = 1.0) -> Field:
    """A column that is filled in by hand."""
    return words(heading, lambda _: None, share, unit=unit)


def quantity(name: str | Quantity, show: Shown = "", heading: str | None = None) -> Field:
    """A column of a quantity, in the unit that people read.

    Parameters
    ----------
    name : of the quantity, or the quantity
    show : what it shows of an item [SI, degrees], as in `words`; by default what has its name
    heading : where it is another than that of the quantity
    """
    shown = QUANTITIES[name] if isinstance(name, str) else name
    value = _getter(show, shown.name)
    return quantity_column(shown, heading), lambda one: figure_cell(shown, value(one))


_SHORT = {
    "height": "above\nseabed",
    "knockdown": "knock-\ndown",
    "safety_factor": "safety\nfactor\n",
}
"""Headings cut so that the table of a line fits 80 columns."""


def quantity_column(quantity: Quantity, heading: str | None = None) -> Column:
    """The head of a column of a quantity, or another, with the unit that people read."""
    short = None if heading else _SHORT.get(quantity.name)
    marked = quantity.name in ("tilt", "safety_factor")
    title, unit = heading or quantity.heading, quantity.display_unit
    return Column(title, unit, True, short=short, marked=marked)


def figure_cell(quantity: Quantity, value: float | None, state: State | None = None) -> Cell:
    """Return a value of a quantity as it stands under its `quantity_column`.

    Parameters
    ----------
    value : SI, degrees; None where it is not known
    state : warns or fails where the figure is near a limit or beyond it, and marks it so
    """
    return Cell(quantity.format(value), state=state, mark=state.sign if state else "")


def table_of(
    title: str,
    items: Iterable[Any],
    *fields: Field,
    note: str = "",
    sums: Iterable[Any] = (),
    **more: Any,
) -> Table:
    """Return a table with a row for each item and a column for each field.

    Columns without a word in them are left out, unless the table is filled in by hand.

    Parameters
    ----------
    items : a cell among them heads the rows below it
    fields : as `words`, `number` and `quantity` make them
    note : below the table
    sums : items whose rows close the table as its totals
    more : what else a `Table` says
    """
    totals = list(sums)
    rows = (
        (item,) if isinstance(item, Cell) else tuple(_cell(show(item)) for _, show in fields)
        for item in (*items, *totals)
    )
    columns = tuple(column for column, _ in fields)
    table = Table(title, columns, tuple(rows), note, len(totals), **more)
    return table.without_empty_columns()


def _cell(shown: Any) -> Cell:
    return shown if isinstance(shown, Cell) else Cell("" if shown is None else str(shown))


def warned(texts: Iterable[str], state: State = State.WARN) -> tuple[Prose, ...]:
    """Sentences that must not be overlooked, where there are any."""
    lines = tuple(texts)
    return (Prose(lines, state),) if lines else ()


def quiet(*texts: str) -> Prose:
    """Sentences that are read last."""
    return Prose(tuple((Span(text, quiet=True),) for text in texts))
