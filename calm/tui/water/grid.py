"""A small table of numbers whose columns carry their units: edited, pasted, filled row by row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from textual import events, on
from textual.message import Message

from calm.records.delimited import CopiedTable, NoTableError, copied_table
from calm.tui.cell_editor import CellEditor
from calm.tui.checking import Reading
from calm.tui.dialogs import Asked, InputSheet, ask
from calm.tui.table import EditableTable
from calm.tui.water.grid_cells import GridCells
from calm.tui.water.pasted import (
    NoRows,
    Rows,
    UnknownColumns,
    check_of,
    offered_headings,
    previewed,
    rows_in,
)


class Grid(EditableTable):
    """Edit the cells of a table of the water.

    Values are texts as the file has them: numbers where the heading of their column has a unit,
    else quantities with their own. Without columns nothing is shown and nothing can be edited.
    """

    DEFAULT_CSS = """
    Grid { height: auto; min-height: 3; max-height: 16; }
    Grid GridCells { height: auto; min-height: 3; max-height: 16; }
    """

    @dataclass
    class Changed(Message):
        """The rows are other ones."""

        grid: Grid
        rows: Rows
        label: str

    def __init__(self, *, id: str | None = None) -> None:
        self.cells = GridCells()
        super().__init__(self.cells, id=id)
        self._place = 0, 0  # row and column that are edited
        self._new = -1  # the row that was added last and is being filled
        self._before: Rows | None = None  # the rows without the one that Enter has added

    def show(
        self, columns: Sequence[str], rows: Sequence[Sequence[str]], seabed: float | None = None
    ) -> None:
        """Show other rows; new ones are not proposed below the `seabed` [m]."""
        self.cells.seabed = seabed
        self.cells.show(columns, rows)
        self.cells.styles.height = len(rows) + 1

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
            headings = offered_headings(copied.headings, columns)
            rows_in(columns, headings, copied.rows)
        except UnknownColumns:
            pass  # the person says what they are
        except (NoTableError, NoRows) as error:
            self.tell_refusal(f"Nothing is pasted: {error}")
            return
        self._preview(copied, headings)

    def _preview(self, copied: CopiedTable, headings: Sequence[str]) -> None:
        """Show what would be taken, under which columns; these can be corrected."""
        columns = self.cells.headings

        def taken(text: str) -> Rows:
            return rows_in(columns, [one.strip() for one in text.split(",")], copied.rows)

        def check(text: str) -> Reading:
            try:
                return Reading(text, comes_to=previewed(columns, taken(text)))
            except NoRows as error:
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
        text, check = event.begin or cells.cell, check_of(cells.headings[cells.column])
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

    @on(GridCells.Changed)
    def _changed(self, event: GridCells.Changed) -> None:
        event.stop()
        self.cells.styles.height = len(event.rows) + 1
        self.post_message(self.Changed(self, event.rows, event.label))
