"""A small table of numbers whose columns carry their units: edited, pasted, filled row by row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from rich.segment import Segment
from rich.style import Style
from textual import events, on
from textual.binding import BindingType
from textual.message import Message

from calm.records.delimited import CopiedTable, NoTableError, copied_table
from calm.tui.cell_editor import CellEditor
from calm.tui.checking import Reading
from calm.tui.dialogs import Asked, InputSheet, ask
from calm.tui.key_table import bindings
from calm.tui.table import EditableTable, TableCells, TableColumn
from calm.tui.theme import CURSOR
from calm.tui.water import pasted
from calm.tui.workspace import Told

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
        """The rows are other ones, and what was done to them."""

        cells: GridCells
        label: str

    def __init__(self) -> None:
        super().__init__()
        self.headings: tuple[str, ...] = ()
        self.rows: pasted.Rows = ()
        self.seabed: float | None = None

    def show(self, headings: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Other rows, the cursor where it was if there is such a cell."""
        self.headings = tuple(headings)
        self.set_reactive(TableCells.column, self.validate_column(self.column))
        self.take_rows(tuple(tuple(row) for row in rows))
        self.styles.height = len(rows) + self.HEADING

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
        # a sheet answers in the name of the grid: a message sent so would go no further than that
        self.post_message(self.Changed(self, label).set_sender(self))
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


def _between(
    columns: Sequence[str], rows: pasted.Rows, at: int, seabed: float | None
) -> tuple[str, ...]:
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
    halves = (pasted.half_way(column, *pair) for column, pair in zip(columns, pairs, strict=True))
    return tuple(f"{half:g}" for half in halves)


class Grid(EditableTable):
    """Edit the cells of a table of the water.

    Values are texts as the file has them: numbers where the heading of their column has a unit,
    else quantities with their own. Without columns nothing is shown and nothing can be edited.
    """

    DEFAULT_CSS = """
    Grid { height: auto; min-height: 3; max-height: 16; }
    Grid GridCells { height: auto; min-height: 3; max-height: 16; }
    """

    def __init__(self, *, id: str | None = None) -> None:
        self.cells = GridCells()
        super().__init__(self.cells, id=id)
        self._place = 0, 0  # row and column that are edited
        self._new = -1  # the row that was added last and is being filled
        self._before: pasted.Rows | None = None  # the rows without the one that Enter has added

    def show(
        self, columns: Sequence[str], rows: Sequence[Sequence[str]], seabed: float | None = None
    ) -> None:
        """Show other rows; new ones are not proposed below the `seabed` [m]."""
        self.cells.seabed = seabed
        self.cells.show(columns, rows)

    def settle(self) -> Reading:
        """Put what is typed into the rows, telling nobody; a bad value stays to be corrected."""
        with self.cells.prevent(GridCells.Changed):
            return self.settle_cell()

    def write(self, text: str) -> None:
        """Put a good text where it was typed."""
        self.cells.put(text, *self._place)

    def on_paste(self, event: events.Paste) -> None:
        """Rows from a spreadsheet or a text take the place of all rows."""
        event.stop()
        self.take_text(event.text)

    def take_text(self, text: str) -> None:
        """Take the rows of a text in the place of all rows.

        They are read by their headings, and shown with their columns before they are taken.
        """
        columns = self.cells.headings
        try:
            copied = copied_table(text)
            headings = pasted.offered_headings(copied.headings, columns)
            pasted.rows_in(columns, headings, copied.rows)
        except pasted.UnknownColumns:
            pass  # the person says what they are
        except (NoTableError, pasted.NoRows) as error:
            self.tell_refusal(f"Nothing is pasted: {error}")
            return
        self._preview(copied, headings)

    def _preview(self, copied: CopiedTable, headings: Sequence[str]) -> None:
        """Show what would be taken, under which columns; these can be corrected."""
        columns = self.cells.headings

        def taken(text: str) -> pasted.Rows:
            return pasted.rows_in(columns, [one.strip() for one in text.split(",")], copied.rows)

        def check(text: str) -> Reading:
            try:
                return Reading(text, comes_to=pasted.previewed(columns, taken(text)))
            except pasted.NoRows as error:
                return Reading(text, str(error))

        def take(answers: dict[str, str]) -> None:
            rows, chosen = taken(answers["columns"]), answers["columns"]
            self.cells.change(rows, f"{len(rows)} rows pasted: {chosen}")
            self.call_after_refresh(self.cells.focus)  # a table may not be shown yet

        text = "It takes the place of all rows."
        if copied.headings is None:
            text += " It has no headings: are these its columns?"
        first = "   ".join(copied.rows[0])
        text += f" Its first row reads  {first}"
        asked = Asked("columns", "Columns", ", ".join(headings), check)
        ask(self.app, InputSheet("A table is pasted", text, [asked]), take)

    @on(GridCells.Pressed)
    def _edit_pressed(self) -> None:
        self.cells.action_edit()

    @on(GridCells.Wanted)
    def _edit(self, event: GridCells.Wanted) -> None:
        event.stop()
        cells = self.cells
        if self.editor.is_typing:
            self.settle_cell()
        self._place = cells.cursor, cells.column
        self._new = cells.cursor if event.new else self._new
        text, check = event.begin or cells.cell, pasted.check_of(cells.headings[cells.column])
        self.open_editor(text, check, least_width=12, begun=event.begin is not None)

    def tell_reading(self, reading: Reading) -> None:
        """Tell what is wrong with the text typed so far."""
        if not reading.is_good:
            self.tell_refusal(reading.note)

    def go_on(self, done: CellEditor.Done) -> None:
        """Go up or down, or to the next value; add a row below one that was added and is filled."""
        cells = self.cells
        if done.text is not None:
            self._before = None  # it is filled
        if done.then in ("up", "down"):
            cells.cursor += 1 if done.then == "down" else -1
        elif done.then == "right":
            cells.column += 1
        elif done.then == "edit next":
            if cells.go_on(1):
                cells.action_edit()
        elif not cells.is_at_the_end:
            cells.go_on(1)
        elif cells.cursor == self._new and cells.has_room_below:
            before = cells.rows
            cells.action_add_row(1)
            self._before = before

    def abandoned(self) -> None:
        """Take out a row that was added and not filled."""
        if self._before is not None:
            self.cells.change(self._before, "a row less")
            self.cells.cursor -= 1
        self._new, self._before = -1, None
