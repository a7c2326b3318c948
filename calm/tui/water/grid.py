"""A small table of numbers whose columns carry their units: rows are edited, added, taken out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from textual import events, on
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.message import Message

from calm.records.delimited import CopiedTable, NoTableError, copied_table
from calm.tui.checking import Check, Reading
from calm.tui.dialogs import Asked, InputSheet
from calm.tui.line.cell_editor import CellEditor
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


class Grid(Vertical):
    """The cells with the line of input that edits them.

    Values are texts as the file has them: numbers where the heading of their column has a unit,
    else quantities with their own. Without columns nothing is shown and nothing can be edited.
    """

    DEFAULT_CSS = """
    Grid { height: auto; min-height: 3; max-height: 16; layers: table over; }
    Grid GridCells { height: auto; min-height: 3; max-height: 16; }
    """

    @dataclass
    class Changed(Message):
        """The rows are other ones."""

        grid: Grid
        rows: Rows
        label: str

    @dataclass
    class Refused(Message):
        """Why something cannot be done."""

        reason: str

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._place = 0, 0  # row and column that are edited
        self._new = -1  # the row that was added last and is being filled
        self._before: Rows | None = None  # the rows without the one that Enter has added

    def compose(self) -> ComposeResult:
        """The rows, and over them what is edited."""
        yield GridCells()
        yield CellEditor()

    @property
    def cells(self) -> GridCells:
        """The rows."""
        return self.query_one(GridCells)

    @property
    def editor(self) -> CellEditor:
        """Return what is edited."""
        return self.query_one(CellEditor)

    def show(
        self, columns: Sequence[str], rows: Sequence[Sequence[str]], seabed: float | None = None
    ) -> None:
        """Show other rows; new ones are not proposed below the `seabed` [m]."""
        self.cells.seabed = seabed
        self.cells.show(columns, rows)
        self.cells.styles.height = len(rows) + 1

    @property
    def is_typing(self) -> bool:
        """Return whether a value is typed that is not in the rows yet."""
        return self.editor.is_typing

    def settle(self) -> Reading:
        """Put what is typed into the rows, telling nobody; a bad value stays to be corrected."""
        reading = self.editor.settle()
        if not reading.is_good:
            self.editor.focus()
        elif self.editor.is_open:
            with self.cells.prevent(GridCells.Changed):
                self._put()
        return reading

    def _put(self) -> None:
        """Put the good text that is typed, if any, where it was typed."""
        text = self.editor.text
        self.drop()
        if text is not None:
            self.cells.put(text, *self._place)

    def drop(self) -> None:
        """End editing; the value stays as it was."""
        if self.editor.is_open:
            had_focus = self.editor.has_focus
            self.editor.close()
            if had_focus:
                self.cells.focus()

    def on_paste(self, event: events.Paste) -> None:
        """Rows from a spreadsheet or a text take the place of all rows."""
        event.stop()
        self.take_text(event.text)

    def take_text(self, text: str) -> None:
        """Take the rows of a text in the place of all rows.

        They are read by their headings, and shown with their columns before they are taken.
        """
        columns = self.cells.columns
        try:
            copied = copied_table(text)
            headings = offered_headings(copied.headings, columns)
            rows_in(columns, headings, copied.rows)
        except UnknownColumns:
            pass  # the person says what they are
        except (NoTableError, NoRows) as error:
            self.post_message(self.Refused(f"Nothing is pasted: {error}"))
            return
        self._preview(copied, headings)

    def _preview(self, copied: CopiedTable, headings: Sequence[str]) -> None:
        """Show what would be taken, under which columns; these can be corrected."""
        columns = self.cells.columns

        def taken(text: str) -> Rows:
            return rows_in(columns, [one.strip() for one in text.split(",")], copied.rows)

        def check(text: str) -> Reading:
            try:
                return Reading(text, comes_to=previewed(columns, taken(text)))
            except NoRows as error:
                return Reading(text, str(error))

        def take(answers: dict[str, str] | None) -> None:
            if answers is not None:
                rows, chosen = taken(answers["columns"]), answers["columns"]
                self.cells.change(rows, f"{len(rows)} rows pasted: {chosen}")
                self.call_after_refresh(self.cells.focus)  # a table may not be shown yet

        text = "It takes the place of all rows."
        if copied.headings is None:
            text += " It has no headings: are these its columns?"
        first = "   ".join(copied.rows[0])
        text += f" Its first row reads  {first}"
        asked = Asked("columns", "Columns", ", ".join(headings), check)
        self.app.push_screen(InputSheet("A table is pasted", text, [asked]), take)

    @on(GridCells.Wanted)
    def _edit(self, event: GridCells.Wanted) -> None:
        event.stop()
        cells = self.cells
        if self.editor.is_typing and self.editor.settle().is_good:
            self._put()
        self._place = cells.cursor, cells.column
        self._new = cells.cursor if event.new else self._new
        begun = event.begin is not None
        text = event.begin or cells.cell
        region = cells.cell_region()
        self.editor.open(text, self._check(), region, least_width=12, begun=begun)

    def _check(self) -> Check:
        return check_of(self.cells.columns[self.cells.column])

    @on(CellEditor.Judged)
    def _tell_reading(self, event: CellEditor.Judged) -> None:
        event.stop()
        if self.editor.is_open and not event.reading.is_good:
            self.post_message(self.Refused(event.reading.note))

    @on(CellEditor.Done)
    def _take(self, event: CellEditor.Done) -> None:
        event.stop()
        cells, is_here = self.cells, self.editor.has_focus
        self._put()
        if not is_here:
            return  # it was left for another place
        if event.text is not None:
            self._before = None  # it is filled
        if event.then in ("up", "down"):
            cells.cursor += 1 if event.then == "down" else -1
        elif event.then == "right":
            cells.column += 1
        elif event.then == "edit next":
            if cells.go_on(1):
                cells.action_edit()
        elif not cells.is_at_the_end:
            cells.go_on(1)
        elif cells.cursor == self._new and cells.has_room_below:
            before = cells.rows
            cells.action_add_row(1)
            self._before = before

    @on(CellEditor.Abandoned)
    def _abandon(self, event: CellEditor.Abandoned) -> None:
        event.stop()
        self.drop()
        if self._before is not None:
            self.cells.change(self._before, "a row less")
            self.cells.cursor -= 1
        self._new, self._before = -1, None
        if event.reason:
            self.post_message(self.Refused(event.reason))

    @on(GridCells.AtTheEnd)
    def _tell_the_end(self) -> None:
        self.post_message(self.Refused("The table ends here: a adds a row, ↓ leaves it"))

    @on(GridCells.Changed)
    def _changed(self, event: GridCells.Changed) -> None:
        event.stop()
        self.cells.styles.height = len(event.rows) + 1
        self.post_message(self.Changed(self, event.rows, event.label))
