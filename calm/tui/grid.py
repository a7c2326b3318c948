"""A small table of numbers whose columns carry their units: rows are edited, added, taken out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from textual import on
from textual.app import ComposeResult
from textual.containers import Vertical
from textual.message import Message

from calm.files.fields import Quantity
from calm.tui.cell_editor import CellEditor
from calm.tui.cells import Cells, Rows
from calm.tui.checking import Check, number, quantity

_DIMENSIONS = {
    "depth": "length",
    "speed": "speed",
    "u": "speed",
    "v": "speed",
    "w": "speed",
    "toward": "angle",
    "density": "density",
    "temperature": "temperature",
    "salinity": "salinity",
}


class Grid(Vertical):
    """The cells with the line of input that edits them."""

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

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._begun: str | None = None

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

    def show(self, columns: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
        """Show other rows."""
        self.cells.show(columns, rows)
        self.cells.styles.height = len(rows) + 1

    @on(Cells.Wanted)
    def _edit(self, event: Cells.Wanted) -> None:
        event.stop()
        cells = self.cells
        begun = event.begin is not None
        text = event.begin or cells.cell
        region = cells.cell_region()
        self.editor.open(text, self._check(), region, least_width=12, begun=begun)

    def _check(self) -> Check:
        return check_of(self.cells.columns[self.cells.column])

    @on(CellEditor.Done)
    def _take(self, event: CellEditor.Done) -> None:
        event.stop()
        self._close()
        cells = self.cells
        if event.text != cells.cell:
            cells.put(event.text)
        if cells.column + 1 < len(cells.columns):
            cells.column += 1
        elif cells.row + 1 < len(cells.rows):
            cells.column = 0
            cells.row += 1
        if event.onward:
            cells.action_edit()

    @on(CellEditor.Abandoned)
    def _abandon(self, event: CellEditor.Abandoned) -> None:
        event.stop()
        self._close()

    def _close(self) -> None:
        if self.editor.is_open:
            had_focus = self.editor.has_focus
            self.editor.close()
            if had_focus:
                self.cells.focus()

    @on(Cells.Changed)
    def _changed(self, event: Cells.Changed) -> None:
        event.stop()
        self.cells.styles.height = len(event.rows) + 1
        self.post_message(self.Changed(self, event.rows, event.label))


def check_of(column: str) -> Check:
    """What judges the values of a column: numbers where it gives its unit, else quantities."""
    name, _, unit = column.replace("[", " ").replace("]", " ").strip().partition(" ")
    dimension = _DIMENSIONS.get(name)
    if unit.strip() or dimension is None:
        return number
    return quantity(Quantity(dimension))
