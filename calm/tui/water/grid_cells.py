"""The rows of a table of numbers, with a cursor on one cell of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.binding import BindingType
from textual.message import Message

from calm.tui.key_table import bindings
from calm.tui.messages import Told
from calm.tui.table import TableCells, TableColumn
from calm.tui.theme import CURSOR
from calm.tui.water.pasted import Rows, half_way

_WIDTH = 14
_LEAD = 2
_AS_TEXT = "this table is edited in the text of the file (t)"
_DIGITS = frozenset("0123456789.-+")
_STEP = 10.0
"""How much deeper [m] a row below the last is."""


class GridCells(TableCells, can_focus=True):
    """Show the rows with a cursor on one cell, and add and take out rows."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("grid")]
    GAP = 2

    @dataclass
    class Wanted(Message):
        """A cell is to be edited, beginning with a text; of a row that is `new`, its first one."""

        begin: str | None = None
        new: bool = False

    @dataclass
    class Changed(Message):
        """The rows are other ones."""

        rows: Rows
        label: str

    def __init__(self) -> None:
        super().__init__()
        self.headings: tuple[str, ...] = ()
        self.rows: Rows = ()
        self.seabed: float | None = None

    def show(self, headings: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Other rows, the cursor where it was if there is such a cell."""
        self.headings = tuple(headings)
        self.set_reactive(TableCells.column, self.validate_column(self.column))
        self.take_rows(tuple(tuple(row) for row in rows))

    @property
    def columns(self) -> list[TableColumn]:
        """The columns, named by their numbers: a file may have two of one heading."""
        width = _WIDTH - self.GAP
        return [
            TableColumn(str(number), heading, _LEAD + number * _WIDTH, width)
            for number, heading in enumerate(self.headings)
        ] or [TableColumn("", _AS_TEXT, _LEAD, len(_AS_TEXT))]

    @property
    def editable(self) -> Sequence[str]:
        """All columns, where there are any."""
        return [str(number) for number in range(len(self.headings))]

    def text_of(self, number: int, column: TableColumn) -> str:
        """Return what stands in a cell of a row."""
        return self.rows[number][int(column.name)]

    def lead(self, number: int, style: Style) -> list[Segment]:
        """Return the cursor, where the table has the focus."""
        here = number == self.cursor and self.has_focus
        return [Segment(f"{CURSOR} " if here else "  ", style)]

    @property
    def cell(self) -> str:
        """The text under the cursor."""
        return self.rows[self.cursor][self.column] if self.rows else ""

    def put(self, text: str, row: int, column: int) -> None:
        """Another text in a cell; nothing where there is none any more."""
        if row < len(self.rows) and column < len(self.headings):
            values = [*self.rows[row]]
            values[column] = text
            self.change([*self.rows[:row], tuple(values), *self.rows[row + 1 :]], "a value")

    def change(self, rows: Sequence[tuple[str, ...]], label: str) -> None:
        """Other rows, and what was done to them."""
        self.post_message(self.Changed(tuple(rows), label))
        self.show(self.headings, rows)

    def go_on(self, by: int) -> bool:
        """Go to the next value or the one before, over the rows; whether there is one."""
        row, column = divmod(
            self.cursor * len(self.headings) + self.column + by, len(self.headings)
        )
        if is_there := 0 <= row < len(self.rows):
            self.cursor, self.column = row, column
        return is_there

    def action_move_row(self, by: int) -> None:
        """Go up or down, at the ends out of the table."""
        if 0 <= self.cursor + by < len(self.rows):
            self.cursor += by
        elif by > 0:
            self.screen.focus_next()
        else:
            self.screen.focus_previous()

    def action_move_cell(self, by: int) -> None:
        """Go to the next value; what is typed after the last goes into no other field."""
        if self.headings and self.go_on(by):
            return
        if by < 0:
            self.screen.focus_previous()
        elif self.headings:
            self.post_message(Told("The table ends here: a adds a row, ↓ leaves it", wrong=True))
        else:
            self.screen.focus_next()

    def action_move_column(self, by: int) -> None:
        """Go left or right."""
        self.column += by

    def action_edit(self) -> None:
        """Edit the cell."""
        if self.rows:
            self.post_message(self.Wanted())

    def action_add_row(self, below: int) -> None:
        """A row beside this one, its values between those of its neighbours."""
        if not self.headings:
            return
        at = self.cursor + below if self.rows else 0
        at = min(at, len(self.rows) - 1) if self._ends_at_the_seabed(at) else at
        new = _between(self.headings, self.rows, at, self.seabed)
        self.change([*self.rows[:at], new, *self.rows[at:]], "a row more")
        self.cursor, self.column = at, 0
        self.post_message(self.Wanted(new=True))

    @property
    def is_at_the_end(self) -> bool:
        """Return whether the cursor is on the last value of its row."""
        return self.column == len(self.headings) - 1

    @property
    def has_room_below(self) -> bool:
        """Return whether a row below that of the cursor would not be of a depth below the
        seabed.
        """
        return not self._ends_at_the_seabed(self.cursor + 1)

    def _ends_at_the_seabed(self, at: int) -> bool:
        """Return whether a row at a place would be of a depth below the seabed."""
        if self.seabed is None or not self.rows or at < len(self.rows):
            return False
        try:
            return float(self.rows[-1][0]) >= self.seabed
        except ValueError:
            return False

    def action_drop_row(self) -> None:
        """Take the row out; the last one stays."""
        if len(self.rows) > 1:
            self.change([*self.rows[: self.cursor], *self.rows[self.cursor + 1 :]], "a row less")

    def on_key(self, event: events.Key) -> None:
        """A digit begins a new value."""
        if event.character in _DIGITS and event.is_printable and self.rows:
            event.stop()
            self.post_message(self.Wanted(event.character))


def _between(columns: Sequence[str], rows: Rows, at: int, seabed: float | None) -> tuple[str, ...]:
    """Values half-way between those above and below, where both are numbers.

    Below the last row they are its own, a step deeper but not below the `seabed` [m].
    """
    if not rows:
        return ("0",) * len(columns)
    above, below = rows[max(at - 1, 0)], rows[min(at, len(rows) - 1)]
    try:
        pairs = [(float(one), float(other)) for one, other in zip(above, below, strict=True)]
    except ValueError:
        return above
    if at == len(rows):
        deeper = pairs[0][0] + _STEP
        return (f"{deeper if seabed is None else min(deeper, seabed):g}", *above[1:])
    halves = (half_way(column, *pair) for column, pair in zip(columns, pairs, strict=True))
    return tuple(f"{half:g}" for half in halves)
