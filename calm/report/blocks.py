"""Building blocks of all reports: on a terminal, in HTML or PDF, and in notebooks.

All texts are plain text without markup; each output format escapes special characters.
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
    """Column of a table, without its cells.

    Attributes
    ----------
    unit : unit below the title
    share : weight in the division of the page width: 0 for short words, 1 for names, more for
        sentences
    short : shorter title for narrow tables, perhaps of several lines
    narrow : whether narrow tables include the column
    marked : whether cells may mark values near or beyond a limit
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
    """Cell of a table.

    Attributes
    ----------
    detail : smaller text below the main text
    state : state of a check, shown by colour and words
    mark : symbol after a value that is close to a limit or beyond it
    goes_on : whether, in print, the detail follows on the same line
    then : suggested action
    bar : value as a fraction of its limit, drawn as a bar
    picture : SVG drawing
    tone : highlight in a matrix: `fail`, `over` or `near`
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
    """Table with columns and rows; a row of a single cell is a heading for the following rows.

    Attributes
    ----------
    totals : number of rows at the end that are sums
    sortable : whether readers can sort and filter the rows
    dense : whether the columns are closely spaced
    by_hand : whether the table is filled in by hand
    note, aside : text below the table, and smaller text next to the title
    ruled : whether there is a line below each row
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
        """Return the table without empty columns.

        A table that is filled in by hand keeps its empty columns.
        """
        count = len(self.columns)
        full = [row for row in self.rows if len(row) == count]
        kept = [at for at in range(count) if any(row[at] != _EMPTY for row in full)]
        return self._with_columns(kept) if full and len(kept) < count and not self.by_hand else self

    def narrow(self) -> Table:
        """Return the table for a narrow page, without the columns that do not fit."""
        return self._with_columns([n for n, one in enumerate(self.columns) if one.narrow])

    def _with_columns(self, kept: Sequence[int]) -> Table:
        rows = (row if len(row) == 1 else tuple(row[at] for at in kept) for row in self.rows)
        columns = tuple(self.columns[at] for at in kept)
        return replace(self, columns=columns, rows=tuple(rows))


_EMPTY = Cell()


@dataclass(frozen=True)
class Pairs:
    """List of pairs of a name and a value; a value may have several lines."""

    pairs: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class Figure:
    """SVG drawing, with a title that describes its content.

    Attributes
    ----------
    tall : whether the drawing may fill a page
    aside, note : text next to the title, and text below the drawing
    """

    title: str
    svg: str
    tall: bool = False
    aside: str = ""
    note: str = ""


@dataclass(frozen=True)
class Span:
    """Part of a sentence, in the colour of a state.

    If `quiet` is true, the part has the style of secondary text.
    """

    text: str
    state: State | None = None
    quiet: bool = False


Line = str | tuple[Span, ...]
"""Sentence, either plain text or a sequence of spans."""


@dataclass(frozen=True)
class Prose:
    """Paragraphs of one sentence each; all are highlighted if `state` is set."""

    lines: tuple[Line, ...]
    state: State | None = None


@dataclass(frozen=True)
class Note:
    """Explanatory sentences about the table or figure above."""

    lines: tuple[str, ...]


@dataclass(frozen=True)
class Heading:
    """Heading over the blocks that follow."""

    text: str


@dataclass(frozen=True)
class Listing:
    """Text of a file, to be shown in a report.

    A PDF attaches the text as a file called `name`, unless `name` is empty. A text of more than
    `most` lines is only attached, not printed.
    """

    title: str
    text: str
    name: str = ""
    most: int = 0


@dataclass(frozen=True)
class TitleBlock:
    """Title block of a drawing.

    Attributes
    ----------
    above : small text above the title
    title : title
    below : lines below the title
    fields : name and text of each field
    """

    above: str
    title: str
    below: tuple[str, ...]
    fields: tuple[tuple[str, str], ...]


@dataclass(frozen=True)
class SignOff:
    """Table of revisions, and boxes for signatures, at the foot of a page.

    `revisions` have revision, date, author and reason; `roles` have role and name. `note` is next
    to the boxes.
    """

    revisions: tuple[tuple[str, str, str, str], ...]
    roles: tuple[tuple[str, str], ...]
    note: str


@dataclass(frozen=True)
class OpenItem:
    """Open item, with its state, number, heading, and text (value and suggested action)."""

    state: State
    number: int
    head: str
    text: str


@dataclass(frozen=True)
class OpenItems:
    """List of open items, most severe first; `more` is printed if not all items fit on the page."""

    title: str
    items: tuple[OpenItem, ...]
    note: str = ""
    more: str = ""


@dataclass(frozen=True)
class Beside:
    """Two groups of blocks, side by side in print.

    `share` is the fraction of the width for the left group. `height` is in points; 0 fits the
    contents.
    """

    left: tuple[Block, ...]
    right: tuple[Block, ...]
    share: float = 0.5
    height: float = 0.0


@dataclass(frozen=True)
class PageBreak:
    """Page break, ignored in output without pages."""


Block = (
    Table | Pairs | Figure | Prose | Note | Heading | Listing | PageBreak | TitleBlock | SignOff
    | OpenItems | Beside
)  # fmt: skip


@dataclass(frozen=True)
class ReportPart:
    """Blocks under a heading.

    `size` is the font size of tables in print [pt]. Listings have a smaller font.
    """

    title: str
    blocks: tuple[Block, ...]
    size: float = 8.0


@dataclass(frozen=True)
class Running:
    """Running header and footer of every page.

    `document` and `title` are on the left side of the header, `verdict` and `date` on the right.
    """

    document: str = ""
    title: str = ""
    verdict: str = ""
    date: str = ""
    foot: str = ""


@dataclass(frozen=True)
class Section:
    """Section of a report, on one mooring or tow.

    A section with its own `running` header starts a new page without a title.
    """

    name: str
    parts: tuple[ReportPart, ...]
    running: Running | None = None


@dataclass(frozen=True)
class Report:
    """A report with all sections.

    Attributes
    ----------
    front : content before the sections
    sections : one section per mooring or tow
    plates : full-page drawings at the beginning
    verdict, foot : texts in the header and the footer of every page
    running : header and footer of a report whose first page has its own title block; replaces
        title, verdict, date and foot
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
"""Column, and a function that returns the content of its cell for an item: a cell, text, number, or
None.
"""

Shown = str | int | Callable[[Any], Any]


def words(heading: str, show: Shown = "", share: float = 1.0, **more: Any) -> Field:
    """Create a column of text for `table_of`.

    Parameters
    ----------
    show : attribute name, member index, or function that gives the text of an item; by default, the
        attribute named `heading`
    share : weight of the column in the division of the page width
    more : further attributes of `Column`
    """
    return Column(heading, share=share, **more), _getter(show, heading)


def _getter(show: Shown, name: str) -> Callable[[Any], Any]:
    if isinstance(show, int):
        return itemgetter(show)
    return attrgetter(show or name) if isinstance(show, str) else show


def number(heading: str, show: Shown = "", unit: str = "", **more: Any) -> Field:
    """Create a column of numbers for `table_of`; the arguments are as in `words`.

    The unit is printed below the heading.
    """
    return words(heading, show, unit=unit, numeric=True, **more)


def of_first(*fields: Field) -> list[Field]:
    """Return the fields for rows that are tuples; each field shows the first member."""

    def first(show: Callable[[Any], Any]) -> Callable[[Any], Any]:
        return lambda row: show(row[0])

    return [(column, first(show)) for column, show in fields]


def blank(heading: str, unit: str = "", share: float = 1.0) -> Field:
    """Create an empty column, to be filled in by hand."""
    return words(heading, lambda _: None, share, unit=unit)


def quantity(name: str | Quantity, show: Shown = "", heading: str | None = None) -> Field:
    """Create a column of a quantity for `table_of`, in display units.

    `show` gives the value [SI, degrees] as in `words`. By default, the value is the attribute that
    has the name of the quantity. `heading` replaces the usual heading.
    """
    shown = QUANTITIES[name] if isinstance(name, str) else name
    value = _getter(show, shown.name)
    return quantity_column(shown, heading), lambda one: figure_cell(shown, value(one))


_SHORT = {
    "height": "above\nseabed",
    "knockdown": "knock-\ndown",
    "safety_factor": "safety\nfactor\n",
}
"""Short headings, so that the table of a line is at most 80 columns wide."""


def quantity_column(quantity: Quantity, heading: str | None = None) -> Column:
    """Create the heading for a column with values of a quantity in display units."""
    short = None if heading else _SHORT.get(quantity.name)
    marked = quantity.name in ("tilt", "safety_factor")
    title, unit = heading or quantity.heading, quantity.display_unit
    return Column(title, unit, True, short=short, marked=marked)


def figure_cell(quantity: Quantity, value: float | None, state: State | None = None) -> Cell:
    """Format a value for a `quantity_column`.

    `value` is in SI units or degrees; None if unknown. A warning marks a value close to a limit, a
    failure a value beyond the limit.
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
    """Build a table with one row per item and one column per field.

    Columns without text are omitted, unless the table is filled in by hand.

    Parameters
    ----------
    items : items to tabulate; a `Cell` is a heading for the following rows
    fields : columns created by `words`, `number` and `quantity`
    sums : items of the total rows at the end
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
    """Return a block with the given warnings, or no block if there are none."""
    lines = tuple(texts)
    return (Prose(lines, state),) if lines else ()


def quiet(*texts: str) -> Prose:
    """Create paragraphs in the style of secondary text."""
    return Prose(tuple((Span(text, quiet=True),) for text in texts))
