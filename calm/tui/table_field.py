"""Tables that are edited cell by cell, in forms and on the water screen."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, ClassVar

from rich.segment import Segment
from rich.style import Style
from textual import events, on

from calm.records.delimited import NoTableError, copied_table
from calm.tui import cell_editor, key_table, theme
from calm.tui.checking import Reading
from calm.tui.forms import FormColumn, FormField, Rows, rows_of, text_of_rows
from calm.tui.scrolled import TableCells, TableColumn

_WIDTH = 14
_LEAD = 2
_AS_TEXT = "edit this table in the text of the file (t)"
_NO_ROWS = "a  adds a row"
_DIGITS = frozenset("0123456789.-+")


class GridCells(TableCells, can_focus=True):
    """Table of texts, in which a cursor moves from cell to cell."""

    GAP = 2

    def __init__(self) -> None:
        super().__init__()
        self.headings: tuple[str, ...] = ()
        self.rows: Rows = ()

    def show(self, headings: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Replace headings and rows; the cursor keeps its position if possible."""
        self.headings = tuple(headings)
        self.set_reactive(TableCells.column, self.validate_column(self.column))
        self.take_rows(tuple(tuple(row) for row in rows))
        self.styles.height = max(len(rows), 1) + self.HEADING

    @property
    def columns(self) -> list[TableColumn]:
        """Columns of the table; their names are numbers, because several headings may be equal."""
        return [*self._columns()] or [TableColumn("", _AS_TEXT, _LEAD, len(_AS_TEXT))]

    def _columns(self) -> Iterator[TableColumn]:
        widths = [
            max(_WIDTH - self.GAP, len(heading), *(len(row[number]) for row in self.rows))
            for number, heading in enumerate(self.headings)
        ]
        room = self.scrollable_content_region.width - _LEAD - self.GAP * len(widths)
        while sum(widths) > room and max(widths) > _WIDTH:  # truncate the widest
            widths[widths.index(max(widths))] -= 1
        start = _LEAD
        for number, (heading, width) in enumerate(zip(self.headings, widths, strict=True)):
            yield TableColumn(str(number), heading, start, width)
            start += width + self.GAP

    @property
    def editable(self) -> Sequence[str]:
        """Names of all columns, since every column is editable."""
        return [str(number) for number in range(len(self.headings))]

    def text_of(self, number: int, column: TableColumn) -> str:
        return self.rows[number][int(column.name)]

    def lead(self, number: int, style: Style) -> list[Segment]:
        """Return the cursor symbol in front of a row, if the table has the focus."""
        here = number == self.cursor and self.has_focus
        return [Segment(f"{theme.CURSOR} " if here else "  ", style)]

    def below(self, y: int) -> list[Segment]:
        """Return the hint below an empty table."""
        is_empty = y == self.HEADING and self.headings and not self.rows
        cursor = theme.CURSOR if self.has_focus else " "
        return [Segment(f"{cursor} {_NO_ROWS}", Style(dim=True))] if is_empty else []

    def go_on(self, by: int) -> bool:
        """Move to the next or previous value, if necessary in the next or previous row.

        Return whether there is such a value.
        """
        count = len(self.headings)
        row, column = divmod(self.cursor * count + self.column + by, count)
        if is_there := 0 <= row < len(self.rows):
            self.cursor, self.column = row, column
        return is_there


class Grid(cell_editor.EditableTable):
    """Table with editable cells and rows.

    Cells contain texts as in the file. A table without columns cannot be edited. `changed` is
    called after a change, with the table and a label.
    """

    BINDINGS = key_table.bindings("grid")
    DEFAULT_CSS = """
    Grid { height: auto; min-height: 3; max-height: 16; }
    Grid GridCells { height: auto; min-height: 3; max-height: 16; }
    """
    LEAST_ROWS: ClassVar[int] = 0
    EDITS_ON: ClassVar[bool] = True
    """Whether Enter opens the next cell of an added row.

    Tables of numbers do not need this, because a typed digit opens the cell.
    """

    def __init__(
        self,
        tell: Callable[..., object],
        changed: Callable[[Any, str], object],
        *,
        id: str | None = None,
    ) -> None:
        self.cells = GridCells()
        super().__init__(tell, self.cells, id=id)
        self._changed = changed
        self._columns: tuple[FormColumn, ...] = ()
        self._place = 0, 0  # row and column of the edited cell
        self._new = -1  # the added row that is being filled
        self._before: Rows | None = None  # rows without the row that Enter added

    def show(self, columns: Sequence[FormColumn], rows: Sequence[Sequence[str]]) -> None:
        """Replace the columns and the rows."""
        self._columns = tuple(columns)
        self.cells.show([column.heading for column in columns], rows)

    def change(self, rows: Rows, label: str) -> None:
        """Show changed rows, and report the change."""
        self.cells.show(self.cells.headings, rows)
        self._changed(self, label)

    def write(self, text: str) -> None:
        """Write a valid text to the edited cell, if the cell still exists."""
        rows, (row, column) = self.cells.rows, self._place
        if row < len(rows) and column < len(self.cells.headings):
            values = (*rows[row][:column], text, *rows[row][column + 1 :])
            self.change((*rows[:row], values, *rows[row + 1 :]), "a value")

    def new_row(self, at: int) -> tuple[str, ...]:
        """Return the initial values for a new row at index `at`."""
        return ("",) * len(self._columns)

    def ends_at(self, at: int) -> bool:
        """Return whether the table ends before index `at`, so that no row is proposed there."""
        return False

    # keys

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        return not self.editor.is_open

    def action_move_row(self, by: int) -> None:
        if 0 <= self.cells.cursor + by < len(self.cells.rows):
            self.cells.cursor += by
        elif by > 0:
            self.screen.focus_next()
        else:
            self.screen.focus_previous()

    def action_move_cell(self, by: int) -> None:
        has_rows = bool(self.cells.headings) and bool(self.cells.rows)
        if has_rows and self.cells.go_on(by):
            return
        if by < 0:
            self.screen.focus_previous()
        elif has_rows:
            self.tell("End of the table: a adds a row, ↓ leaves the table", wrong=True)
        else:
            self.screen.focus_next()

    def on_key(self, event: events.Key) -> None:
        if event.character in _DIGITS and event.is_printable and self.cells.rows:
            event.stop()
            self._edit(event.character)

    @on(GridCells.Pressed)
    def action_edit(self) -> None:
        if self.cells.rows:
            self._edit()

    def _edit(self, begun: str | None = None) -> None:
        cells = self.cells
        if not super().settle():  # settles the cell only, as the row may be incomplete
            return
        self._place = row, column = cells.cursor, cells.column
        text, check = begun or cells.rows[row][column], self._columns[column].check
        self.open_editor(text, check, least_width=12, begun=begun is not None)

    def action_add_row(self, below: int) -> None:
        cells, rows = self.cells, self.cells.rows
        if not cells.headings:
            return
        at = cells.cursor + below if rows else 0
        at = min(at, len(rows) - 1) if self.ends_at(at) else at
        self.change((*rows[:at], self.new_row(at), *rows[at:]), "add a row")
        cells.cursor, cells.column = at, 0
        self._new = at
        self._edit()

    def action_drop_row(self) -> None:
        rows, here = self.cells.rows, self.cells.cursor
        if len(rows) > self.LEAST_ROWS:
            self.change((*rows[:here], *rows[here + 1 :]), "delete a row")

    # typed text

    def go_on(self, then: cell_editor.Then, text: str | None) -> None:
        """Move the cursor up, down, or to the next value.

        After the last value of an added row, another row is added.
        """
        cells = self.cells
        if text is not None:
            self._before = None  # the row is not empty any more
        if then in ("up", "down"):
            cells.cursor += 1 if then == "down" else -1
        elif then == "right":
            cells.column += 1
        elif then == "edit next":
            if cells.go_on(1):
                self.action_edit()
        elif cells.column < len(cells.headings) - 1:
            cells.go_on(1)
            if cells.cursor == self._new and self.EDITS_ON:
                self.action_edit()
        elif cells.cursor == self._new and not self.ends_at(cells.cursor + 1):
            before = cells.rows
            self.action_add_row(1)
            self._before = before

    def abandoned(self) -> None:
        """Delete an added row that is still empty."""
        if self._before is not None:
            self.change(self._before, "delete a row")
            self.cells.cursor -= 1
        self._new, self._before = -1, None

    # pasted text

    def on_paste(self, event: events.Paste) -> None:
        event.stop()
        self.take_text(event.text)

    def take_text(self, text: str) -> None:
        """Replace all rows by the rows of a pasted text with the same number of columns."""
        try:
            copied = copied_table(text).rows
        except NoTableError as error:
            self.tell(f"Not pasted: {error}", wrong=True)
            return
        rows = []
        for number, row in enumerate(copied, 1):
            cells = zip(self._columns, row, strict=False)
            readings = [column.check(value) for column, value in cells]
            bad = [each.note for each in readings if not each.is_good]
            if len(row) != len(self._columns):
                bad = [f"it has {len(row)} values, but the table has {len(self._columns)} columns"]
            if bad:
                self.tell(f"Not pasted: row {number}: {bad[0]}", wrong=True)
                return
            rows.append(tuple(reading.text for reading in readings))
        self.change(tuple(rows), f"{len(rows)} rows pasted")


class TableField(Grid):
    """Table that is a field of a form."""

    def __init__(self, form_field: FormField, tell: Callable[..., object]) -> None:
        super().__init__(tell, lambda *_: None)
        self.key, self.begun, self.form_field = form_field.key, form_field.text, form_field
        rows = rows_of(form_field.text, form_field.columns)
        self._shown = rows or ()
        self.show(form_field.columns if rows is not None else (), self._shown)

    @property
    def text(self) -> str:
        """Rows as text, or the initial text if the rows are unchanged."""
        rows = self.cells.rows
        return self.begun if rows == self._shown else text_of_rows(rows, self._columns)

    @property
    def reading(self) -> Reading:
        """Interpretation of the rows, which reports the first invalid cell."""
        for number, row in enumerate(self.cells.rows, 1):
            for column, text in zip(self._columns, row, strict=True):
                reading = column.check(text)
                if any(row) and not reading.is_good:
                    return Reading(text, f"row {number}, {column.heading}: {reading.note}")
        return Reading(self.text)

    @property
    def input(self) -> GridCells:
        """Widget that receives key presses."""
        return self.cells

    def settle(self) -> bool:
        """Accept typed text; return whether all rows are valid."""
        if not super().settle():
            return False
        if complaint := self.reading.complaint:
            self.tell(complaint, wrong=True)
        return not complaint
