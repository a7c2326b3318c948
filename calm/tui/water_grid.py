"""A small table of numbers whose columns carry their units: edited, pasted, filled row by row."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from rich.segment import Segment
from rich.style import Style
from textual import events, on

from calm.records.delimited import CopiedTable, NoTableError, copied_table
from calm.tui import cell_editor, checking, dialogs, field, key_table, theme
from calm.tui.scrolled import TableCells, TableColumn
from calm.tui.water_tables import (
    NoRows,
    Rows,
    UnknownColumns,
    check_of,
    half_way,
    offered_headings,
    previewed,
    rows_in,
)
from calm.tui.workspace import Workspace

_WIDTH = 14
_LEAD = 2
_AS_TEXT = "this table is edited in the text of the file (t)"
_DIGITS = frozenset("0123456789.-+")
_STEP = 10.0
"""How much deeper [m] a row below the last is."""


class GridCells(TableCells, can_focus=True):
    """Show the rows with a cursor on one cell."""

    GAP = 2

    def __init__(self) -> None:
        super().__init__()
        self.headings: tuple[str, ...] = ()
        self.rows: Rows = ()

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
        return [Segment(f"{theme.CURSOR} " if here else "  ", style)]

    def go_on(self, by: int) -> bool:
        """Go to the next value or the one before, over the rows; whether there is one."""
        count = len(self.headings)
        row, column = divmod(self.cursor * count + self.column + by, count)
        if is_there := 0 <= row < len(self.rows):
            self.cursor, self.column = row, column
        return is_there


class Grid(cell_editor.EditableTable):
    """Edit the cells and the rows of a table of the water.

    Values are texts as the file has them: numbers where the heading of their column has a unit,
    else quantities with their own. Without columns nothing is shown and nothing can be edited.

    Parameters
    ----------
    changed : takes the table where its rows are other ones, and what was done to them
    """

    BINDINGS = key_table.bindings("grid")
    DEFAULT_CSS = """
    Grid { height: auto; min-height: 3; max-height: 16; }
    Grid GridCells { height: auto; min-height: 3; max-height: 16; }
    """

    def __init__(
        self, workspace: Workspace, changed: Callable[[Grid, str], object], *, id: str
    ) -> None:
        self.cells = GridCells()
        super().__init__(workspace, self.cells, id=id)
        self._changed = changed
        self._seabed: float | None = None
        self._place = 0, 0  # row and column that are edited
        self._new = -1  # the row that was added last and is being filled
        self._before: Rows | None = None  # the rows without the one that Enter has added

    def show(
        self, columns: Sequence[str], rows: Sequence[Sequence[str]], seabed: float | None = None
    ) -> None:
        """Show other rows; new ones are not proposed below the `seabed` [m]."""
        self._seabed = seabed
        self.cells.show(columns, rows)

    def change(self, rows: Rows, label: str) -> None:
        """Show other rows, and tell what was done to them."""
        self.cells.show(self.cells.headings, rows)
        self._changed(self, label)

    def write(self, text: str) -> None:
        """Put a good text where it was typed; nothing where there is no such cell any more."""
        rows, (row, column) = self.cells.rows, self._place
        if row < len(rows) and column < len(self.cells.headings):
            values = (*rows[row][:column], text, *rows[row][column + 1 :])
            self.change((*rows[:row], values, *rows[row + 1 :]), "a value")

    # keys

    def check_action(self, action: str, parameters: tuple[object, ...]) -> bool | None:
        """The keys of the rows are not those of a value that is typed."""
        return not self.editor.is_open

    def action_move_row(self, by: int) -> None:
        """Go up or down, at the ends out of the table."""
        if 0 <= self.cells.cursor + by < len(self.cells.rows):
            self.cells.cursor += by
        elif by > 0:
            self.screen.focus_next()
        else:
            self.screen.focus_previous()

    def action_move_cell(self, by: int) -> None:
        """Go to the next value; what is typed after the last goes into no other field."""
        has_columns = bool(self.cells.headings)
        if has_columns and self.cells.go_on(by):
            return
        if by < 0:
            self.screen.focus_previous()
        elif has_columns:
            self.workspace.tell("The table ends here: a adds a row, ↓ leaves it", wrong=True)
        else:
            self.screen.focus_next()

    def on_key(self, event: events.Key) -> None:
        """A digit begins a new value."""
        if event.character in _DIGITS and event.is_printable and self.cells.rows:
            event.stop()
            self._edit(event.character)

    @on(GridCells.Pressed)
    def action_edit(self) -> None:
        """Edit the cell."""
        if self.cells.rows:
            self._edit()

    def _edit(self, begun: str | None = None) -> None:
        """Edit the cell under the cursor, beginning with what it has or with what is `begun`."""
        cells = self.cells
        if not self.settle():
            return
        self._place = row, column = cells.cursor, cells.column
        text, check = begun or cells.rows[row][column], check_of(cells.headings[column])
        self.open_editor(text, check, least_width=12, begun=begun is not None)

    def action_add_row(self, below: int) -> None:
        """A row beside this one, its values between those of its neighbours."""
        cells, rows = self.cells, self.cells.rows
        if not cells.headings:
            return
        at = cells.cursor + below if rows else 0
        at = min(at, len(rows) - 1) if self._ends_at_the_seabed(at) else at
        new = _between(cells.headings, rows, at, self._seabed)
        self.change((*rows[:at], new, *rows[at:]), "a row more")
        cells.cursor, cells.column = at, 0
        self._new = at
        self._edit()

    def _ends_at_the_seabed(self, at: int) -> bool:
        """Return whether a row at a place would be of a depth below the seabed."""
        rows = self.cells.rows
        if self._seabed is None or not rows or at < len(rows):
            return False
        try:
            return float(rows[-1][0]) >= self._seabed
        except ValueError:
            return False

    def action_drop_row(self) -> None:
        """Take the row out; the last one stays."""
        rows, here = self.cells.rows, self.cells.cursor
        if len(rows) > 1:
            self.change((*rows[:here], *rows[here + 1 :]), "a row less")

    # what is typed

    def go_on(self, then: cell_editor.Then, text: str | None) -> None:
        """Go up or down, or to the next value; add a row below one that was added and is filled."""
        cells = self.cells
        if text is not None:
            self._before = None  # it is filled
        if then in ("up", "down"):
            cells.cursor += 1 if then == "down" else -1
        elif then == "right":
            cells.column += 1
        elif then == "edit next":
            if cells.go_on(1):
                self.action_edit()
        elif cells.column < len(cells.headings) - 1:
            cells.go_on(1)
        elif cells.cursor == self._new and not self._ends_at_the_seabed(cells.cursor + 1):
            before = cells.rows
            self.action_add_row(1)
            self._before = before

    def abandoned(self) -> None:
        """Take out a row that was added and not filled."""
        if self._before is not None:
            self.change(self._before, "a row less")
            self.cells.cursor -= 1
        self._new, self._before = -1, None

    # what is pasted

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
            self.workspace.tell(f"Nothing is pasted: {error}", wrong=True)
            return
        self._preview(copied, headings)

    def _preview(self, copied: CopiedTable, headings: Sequence[str]) -> None:
        """Show what would be taken, under which columns; these can be corrected."""
        columns = self.cells.headings

        def taken(text: str) -> Rows:
            return rows_in(columns, [one.strip() for one in text.split(",")], copied.rows)

        def check(text: str) -> checking.Reading:
            try:
                return checking.Reading(text, comes_to=previewed(columns, taken(text)))
            except NoRows as error:
                return checking.Reading(text, str(error))

        def take(answers: dict[str, str]) -> None:
            rows, chosen = taken(answers["columns"]), answers["columns"]
            self.change(rows, f"{len(rows)} rows pasted: {chosen}")
            self.call_after_refresh(self.cells.focus)  # a table may not be shown yet

        text = "It takes the place of all rows."
        if copied.headings is None:
            text += " It has no headings: are these its columns?"
        first = "   ".join(copied.rows[0])
        text += f" Its first row reads  {first}"
        asked = field.Asked("columns", "Columns", ", ".join(headings), check)
        dialogs.enter(self.app, "A table is pasted", text, [asked], take)


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
