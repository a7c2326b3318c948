"""The rows of a table of numbers, with a cursor on one cell of them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from rich.cells import set_cell_size
from rich.segment import Segment
from textual import events
from textual.binding import BindingType
from textual.geometry import Region, Size
from textual.message import Message
from textual.reactive import reactive
from textual.scroll_view import ScrollView
from textual.strip import Strip

from calm.tui.actions import bindings
from calm.tui.checking import number
from calm.tui.signs import CURSOR

Rows = tuple[tuple[str, ...], ...]

_WIDTH = 14
_LEAD = 2
_DIGITS = frozenset("0123456789.-+")
_SEPARATOR = re.compile(r"[\t;]|,(?=\s)|,(?!\d)|\s+")


class Cells(ScrollView, can_focus=True):
    """The rows with a cursor on one cell."""

    BINDINGS: ClassVar[list[BindingType]] = [*bindings("grid")]
    COMPONENT_CLASSES: ClassVar[set[str]] = {"cells--heading", "cells--row", "cells--cursor"}
    DEFAULT_CSS = """
    Cells {
        height: 1fr; width: 1fr; overflow-x: hidden; scrollbar-size-vertical: 1;
        & > .cells--heading { text-style: dim; }
        & > .cells--cursor { text-style: reverse bold; }
    }
    """

    row: reactive[int] = reactive(0, init=False)
    column: reactive[int] = reactive(0, init=False)

    @dataclass
    class Wanted(Message):
        """A cell is to be edited, beginning with a text."""

        begin: str | None = None

    @dataclass
    class Changed(Message):
        """The rows are other ones."""

        rows: Rows
        label: str

    def __init__(self) -> None:
        super().__init__()
        self.columns: tuple[str, ...] = ()
        self.rows: Rows = ()

    def show(self, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Show other rows, the cursor where it was if there is such a cell."""
        self.columns, self.rows = tuple(columns), tuple(tuple(row) for row in rows)
        self.virtual_size = Size(0, len(self.rows) + 1)
        self.set_reactive(Cells.row, self.validate_row(self.row))
        self.set_reactive(Cells.column, self.validate_column(self.column))
        self.refresh()

    def validate_row(self, row: int) -> int:
        """Keep it on the rows."""
        return max(0, min(row, len(self.rows) - 1))

    def validate_column(self, column: int) -> int:
        """Keep it on the columns."""
        return max(0, min(column, len(self.columns) - 1))

    def watch_row(self) -> None:
        """Keep it in sight."""
        page = max(self.scrollable_content_region.height - 1, 1)
        top = self.scroll_offset.y
        wanted = min(max(top, self.row - page + 1), self.row)
        if wanted != top:
            self.scroll_to(y=wanted, animate=False)
        self.refresh()

    def watch_column(self) -> None:
        """Show it."""
        self.refresh()

    def on_focus(self) -> None:
        """The cursor is drawn where the focus is."""
        self.refresh()

    def on_blur(self) -> None:
        """And only there."""
        self.refresh()

    @property
    def cell(self) -> str:
        """The text under the cursor."""
        return self.rows[self.row][self.column] if self.rows else ""

    def cell_region(self) -> Region:
        """Where it is, within the widget."""
        y = self.row + 1 - self.scroll_offset.y
        return Region(_LEAD + self.column * _WIDTH, y, _WIDTH - 2, 1)

    def put(self, text: str) -> None:
        """Another text under the cursor."""
        if not self.rows:
            return
        row = [*self.rows[self.row]]
        row[self.column] = text
        self._change([*self.rows[: self.row], tuple(row), *self.rows[self.row + 1 :]], "a value")

    def _change(self, rows: Sequence[tuple[str, ...]], label: str) -> None:
        self.post_message(self.Changed(tuple(rows), label))
        self.show(self.columns, rows)

    def action_move_row(self, by: int) -> None:
        """Go up or down."""
        self.row += by

    def action_move_column(self, by: int) -> None:
        """Go left or right."""
        self.column += by

    def action_edit(self) -> None:
        """Edit the cell."""
        if self.rows:
            self.post_message(self.Wanted())

    def action_add_row(self, below: int) -> None:
        """A row beside this one, its values between those of its neighbours."""
        at = self.row + below if self.rows else 0
        new = _between(self.rows, at, len(self.columns))
        self._change([*self.rows[:at], new, *self.rows[at:]], "a row more")
        self.row, self.column = at, 0
        self.post_message(self.Wanted())

    def action_drop_row(self) -> None:
        """Take the row out; the last one stays."""
        if len(self.rows) > 1:
            self._change([*self.rows[: self.row], *self.rows[self.row + 1 :]], "a row less")

    def on_key(self, event: events.Key) -> None:
        """A digit begins a new value."""
        if event.character in _DIGITS and event.is_printable and self.rows:
            event.stop()
            self.post_message(self.Wanted(event.character))

    def on_paste(self, event: events.Paste) -> None:
        """Rows from a spreadsheet or a text take the place of all rows."""
        lines = [_SEPARATOR.split(line.strip()) for line in event.text.splitlines()]
        rows = [tuple(line) for line in lines if _is_row(line, len(self.columns))]
        if rows:
            event.stop()
            self._change(rows, "rows pasted")

    def on_click(self, event: events.Click) -> None:
        """Go where the mouse is; edit where it was already."""
        place = event.get_content_offset(self)
        if place is None or place.y == 0:
            return
        row = place.y - 1 + self.scroll_offset.y
        column = (place.x - _LEAD) // _WIDTH
        if (row, column) == (self.row, self.column):
            self.action_edit()
        elif row < len(self.rows):
            self.row, self.column = row, column

    def render_line(self, y: int) -> Strip:
        """A row of the screen."""
        width = self.scrollable_content_region.width
        number_of_row = y - 1 + self.scroll_offset.y
        style = self.rich_style
        if y == 0:
            heading = style + self.get_component_rich_style("cells--heading", partial=True)
            text = "".join(set_cell_size(name, _WIDTH) for name in self.columns)
            return Strip([Segment(" " * _LEAD + text, heading)]).adjust_cell_length(width, style)
        if number_of_row >= len(self.rows):
            return Strip.blank(width, style)
        here = number_of_row == self.row and self.has_focus
        segments = [Segment(f"{CURSOR} " if here else "  ", style)]
        cursor = style + self.get_component_rich_style("cells--cursor", partial=True)
        for column, text in enumerate(self.rows[number_of_row]):
            own = cursor if here and column == self.column else style
            segments.append(Segment(set_cell_size(text, _WIDTH - 2), own))
            segments.append(Segment("  ", style))
        return Strip(segments).adjust_cell_length(width, style)


def _between(rows: Rows, at: int, columns: int) -> tuple[str, ...]:
    """Values half-way between those above and below, where both are numbers."""
    if not rows:
        return ("0",) * columns
    above, below = rows[max(at - 1, 0)], rows[min(at, len(rows) - 1)]
    try:
        pairs = [(float(one), float(other)) for one, other in zip(above, below, strict=True)]
    except ValueError:
        return above
    if at == len(rows):
        return (f"{pairs[0][0] + 10:g}", *above[1:])
    return tuple(f"{(one + other) / 2:g}" for one, other in pairs)


def _is_row(texts: Sequence[str], columns: int) -> bool:
    return len(texts) == columns and all(number(text).is_good for text in texts)
