"""A small table of numbers whose columns carry their units: rows are edited, added, taken out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from textual import events, on
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.message import Message

from calm.files.current_text import CopiedTable, NoTableError, copied_table
from calm.tui.checking import Check, Reading
from calm.tui.dialogs import Asked, Sheet
from calm.tui.line.cell_editor import CellEditor
from calm.tui.water.cells import Cells
from calm.tui.water.columns import check_of
from calm.tui.water.pasted import NoRows, Rows, UnknownColumns, offered_headings, rows_in


class Grid(Vertical):
    """The cells with the line of input that edits them.

    Values are texts as the file has them: numbers where the heading of their column has a unit,
    else quantities with their own. Without columns nothing is shown and nothing can be edited.
    """

    DEFAULT_CSS = """
    Grid { height: auto; min-height: 3; max-height: 16; layers: table over; }
    Grid Cells { height: auto; min-height: 3; max-height: 16; }
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

    def compose(self) -> ComposeResult:
        """The rows, and over them what is edited."""
        yield Cells()
        yield CellEditor()

    @property
    def cells(self) -> Cells:
        """The rows."""
        return self.query_one(Cells)

    @property
    def editor(self) -> CellEditor:
        """What is edited."""
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
        """Whether a value is typed that is not in the rows yet."""
        return self.editor.is_typing

    def settle(self) -> Reading:
        """Put what is typed into the rows, telling nobody; a bad value stays to be corrected."""
        reading = self.editor.settle()
        if not reading.is_good:
            self.editor.focus()
        elif self.editor.is_open:
            with self.cells.prevent(Cells.Changed):
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
        """Rows from a spreadsheet or a text take the place of all rows.

        They are read by their headings; where these are missing or unknown the columns are asked.
        """
        event.stop()
        columns = self.cells.columns
        try:
            copied = copied_table(event.text)
            headings = offered_headings(copied.headings, columns)
            rows = rows_in(columns, headings, copied.rows)
        except UnknownColumns:
            self._ask_for_columns(copied, headings)
        except (NoTableError, NoRows) as error:
            self.post_message(self.Refused(f"Nothing is pasted: {error}"))
        else:
            if copied.headings is None or headings != list(copied.headings):
                self._ask_for_columns(copied, headings)
            else:
                self._take_copied(rows, headings)

    def _ask_for_columns(self, copied: CopiedTable, headings: Sequence[str]) -> None:
        """Let the person say what the columns are; they are judged as they are typed."""
        columns = self.cells.columns

        def check(text: str) -> Reading:
            try:
                rows_in(columns, [one.strip() for one in text.split(",")], copied.rows)
            except NoRows as error:
                return Reading(text, str(error))
            return Reading(text)

        def take(answers: dict[str, str] | None) -> None:
            if answers is not None:
                chosen = [one.strip() for one in answers["columns"].split(",")]
                self._take_copied(rows_in(columns, chosen, copied.rows), chosen)

        first = "   ".join(copied.rows[0])
        had = "Its headings are not all known" if copied.headings else "It has no headings"
        text = f"{had}. What are its {len(copied.rows[0])} columns, with units? First row: {first}"
        asked = Asked("columns", "Columns", ", ".join(headings), check)
        self.app.push_screen(Sheet("A table is pasted", text, [asked]), take)

    def _take_copied(self, rows: Rows, headings: Sequence[str]) -> None:
        self.cells.change(rows, f"{len(rows)} rows pasted: {', '.join(headings)}")

    @on(Cells.Wanted)
    def _edit(self, event: Cells.Wanted) -> None:
        event.stop()
        cells = self.cells
        if self.editor.is_typing and self.editor.settle().is_good:
            self._put()
        self._place = cells.cursor, cells.column
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
        if event.then in ("up", "down"):
            cells.cursor += 1 if event.then == "down" else -1
        elif event.then == "right":
            cells.column += 1
        elif cells.go_on(1) and event.then == "edit next":
            cells.action_edit()

    @on(CellEditor.Abandoned)
    def _abandon(self, event: CellEditor.Abandoned) -> None:
        event.stop()
        self.drop()
        if event.reason:
            self.post_message(self.Refused(event.reason))

    @on(Cells.AtTheEnd)
    def _tell_the_end(self) -> None:
        self.post_message(self.Refused("The table ends here: a adds a row, ↓ leaves it"))

    @on(Cells.Changed)
    def _changed(self, event: Cells.Changed) -> None:
        event.stop()
        self.cells.styles.height = len(event.rows) + 1
        self.post_message(self.Changed(self, event.rows, event.label))
