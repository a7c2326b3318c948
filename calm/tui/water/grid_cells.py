"""The rows of a table of numbers, with a cursor on one cell of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from rich.cells import set_cell_size
from rich.segment import Segment
from textual import events
from textual.binding import BindingType
from textual.geometry import Region
from textual.message import Message
from textual.reactive import reactive
from textual.strip import Strip

from calm.tui.actions import bindings
from calm.tui.scrolled import RowList
from calm.tui.theme import CURSOR
from calm.tui.water.pasted import Rows, half_way

_WIDTH = 14
_LEAD = 2
_AS_TEXT = "this table is edited in the text of the file (t)"
_DIGITS = frozenset("0123456789.-+")
_STEP = 10.0
"""How much deeper [m] a row below the last is."""


class GridCells(RowList, can_focus=True):
    """The rows with a cursor on one cell."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("grid")]
    COMPONENT_CLASSES: ClassVar[set[str]] = {"cells--heading", "cells--row", "cells--cursor"}
    DEFAULT_CSS = """
    GridCells {
        height: 1fr; width: 1fr; overflow-x: hidden; scrollbar-size-vertical: 1;
        & > .cells--heading { text-style: dim; }
        & > .cells--cursor { text-style: reverse bold; }
    }
    """

    HEADING = 1

    column: reactive[int] = reactive(0, init=False, repaint=False)

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

    class AtTheEnd(Message):
        """There is no value after the last."""

    def __init__(self) -> None:
        super().__init__()
        self.columns: tuple[str, ...] = ()
        self.rows: Rows = ()
        self.seabed: float | None = None

    def show(self, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Show other rows, the cursor where it was if there is such a cell."""
        self.columns = tuple(columns)
        self.set_reactive(GridCells.column, self.validate_column(self.column))
        self.take_rows(tuple(tuple(row) for row in rows))

    def validate_column(self, column: int) -> int:
        """Keep it on the columns."""
        return max(0, min(column, len(self.columns) - 1))

    def watch_column(self) -> None:
        """Show it."""
        self.refresh()

    @property
    def cell(self) -> str:
        """The text under the cursor."""
        return self.rows[self.cursor][self.column] if self.rows else ""

    def cell_region(self) -> Region:
        """Return where it is, within the widget."""
        y = self.cursor + 1 - self.scroll_offset.y
        return Region(_LEAD + self.column * _WIDTH, y, _WIDTH - 2, 1)

    def put(self, text: str, row: int, column: int) -> None:
        """Another text in a cell; nothing where there is none any more."""
        if row < len(self.rows) and column < len(self.columns):
            values = [*self.rows[row]]
            values[column] = text
            self.change([*self.rows[:row], tuple(values), *self.rows[row + 1 :]], "a value")

    def change(self, rows: Sequence[tuple[str, ...]], label: str) -> None:
        """Other rows, and what was done to them."""
        self.post_message(self.Changed(tuple(rows), label))
        self.show(self.columns, rows)

    def go_on(self, by: int) -> bool:
        """Go to the next value or the one before, over the rows; whether there is one."""
        row, column = divmod(self.cursor * len(self.columns) + self.column + by, len(self.columns))
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
        if self.columns and self.go_on(by):
            return
        if by < 0:
            self.screen.focus_previous()
        elif self.columns:
            self.post_message(self.AtTheEnd())
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
        if not self.columns:
            return
        at = self.cursor + below if self.rows else 0
        at = min(at, len(self.rows) - 1) if self._ends_at_the_seabed(at) else at
        new = _between(self.columns, self.rows, at, self.seabed)
        self.change([*self.rows[:at], new, *self.rows[at:]], "a row more")
        self.cursor, self.column = at, 0
        self.post_message(self.Wanted(new=True))

    @property
    def is_at_the_end(self) -> bool:
        """Return whether the cursor is on the last value of its row."""
        return self.column == len(self.columns) - 1

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

    def on_mouse_down(self, event: events.MouseDown) -> None:
        """Go where the mouse is; edit where the cursor was already.

        At once, as what is typed elsewhere is taken now, and the table is laid out anew.
        """
        place = event.get_content_offset(self)
        row = None if place is None else self.row_at(place.y)
        if place is None or row is None:
            return
        column = (place.x - _LEAD) // _WIDTH
        if (row, column) == (self.cursor, self.column):
            self.action_edit()
        else:
            self.cursor, self.column = row, column

    def render_line(self, y: int) -> Strip:
        """A row of the screen."""
        width = self.scrollable_content_region.width
        number_of_row = self.row_at(y)
        style = self.rich_style
        if y == 0:
            heading = style + self.get_component_rich_style("cells--heading", partial=True)
            text = "".join(set_cell_size(name, _WIDTH) for name in self.columns) or _AS_TEXT
            return Strip([Segment(" " * _LEAD + text, heading)]).adjust_cell_length(width, style)
        if number_of_row is None:
            return Strip.blank(width, style)
        here = number_of_row == self.cursor and self.has_focus
        segments = [Segment(f"{CURSOR} " if here else "  ", style)]
        cursor = style + self.get_component_rich_style("cells--cursor", partial=True)
        for column, text in enumerate(self.rows[number_of_row]):
            own = cursor if here and column == self.column else style
            segments.append(Segment(set_cell_size(text, _WIDTH - 2), own))
            segments.append(Segment("  ", style))
        return Strip(segments).adjust_cell_length(width, style)


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
