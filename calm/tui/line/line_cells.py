"""The values of the line edited in place: what is typed in a cell, and what becomes of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from calm.files import Place
from calm.files.components import FLEXIBLE_KINDS
from calm.files.editing import Value
from calm.tui.checking import Check, anything, count, distance, length, length_text, length_values
from calm.tui.line.cell_editor import CellEditor
from calm.tui.line.table import EDITABLE, Column, LineTable
from calm.tui.messages import Workspace

_LEAST_WIDTHS: dict[Column, int] = {"length": 16}
_LEAST_WIDTH = 6


class LineCells:
    """Edits the cells of a table by the line of input that lies over it.

    Parameters
    ----------
    changed : shows and judges the draft, another one now
    """

    def __init__(
        self,
        workspace: Workspace,
        table: LineTable,
        editor: CellEditor,
        changed: Callable[[], object],
    ) -> None:
        self._workspace, self._table, self._editor = workspace, table, editor
        self._changed = changed
        self._cell: LineCell | None = None

    def edit(self, column: Column) -> None:
        """Edit a value of the row under the cursor, after what is typed in another is taken."""
        if self._table.spot is not None:
            self._edit(LineCell(self._workspace, self._table.spot, column))

    def _edit(self, cell: LineCell) -> None:
        if refused := cell.refused:
            self._workspace.tell(refused)
        if refused or not self.settle():
            return
        self._table.column = EDITABLE.index(cell.column)
        self._cell = cell
        region = self._table.cell_region(cell.column)
        least = _LEAST_WIDTHS.get(cell.column, _LEAST_WIDTH)
        self._editor.open(cell.text, cell.check, region, least_width=least)

    def tell(self, judged: CellEditor.Judged) -> None:
        """Say what the text typed so far comes to."""
        reading = judged.reading
        if self._editor.is_open:
            completed = reading.text if reading.text != self._editor.value.strip() else ""
            note = reading.note or (f"= {completed}" if completed and reading.is_good else "")
            self._workspace.tell(note, wrong=not reading.is_good)

    def take(self, done: CellEditor.Done) -> None:
        """Write what was entered, and go where it says."""
        cell = self._cell
        if cell is None:
            return
        self._put(done.text)
        onward = cell.onward() if done.then == "edit next" else None
        if onward is not None:
            self._edit(onward)
        self._table.column += done.then == "right"
        self._table.cursor += (done.then == "down") - (done.then == "up")

    def settle(self) -> bool:
        """Take what is typed in a cell; a bad value stays to be corrected."""
        if self._cell is None or not self._editor.is_open:
            return True
        reading = self._editor.settle()
        if reading.is_good:
            self._put(self._editor.text)
        else:
            self._editor.focus()
            self._workspace.tell(f"Not taken yet: {reading.note}", wrong=True)
        return reading.is_good

    def _put(self, text: str | None) -> None:
        """Put a text into the cell that is edited; None leaves it as it was."""
        cell = self._cell
        assert cell is not None
        self.leave()
        before = self._workspace.session.draft
        is_put = text is not None and self._workspace.attempt(lambda: cell.put(text))[0]
        if is_put and self._workspace.session.draft is not before:
            self._changed()

    def abandon(self, abandoned: CellEditor.Abandoned) -> None:
        """Leave the value as it was."""
        self.leave()
        if abandoned.reason:
            self._workspace.tell(abandoned.reason, wrong=True)

    def leave(self) -> None:
        """Edit nothing any more; what is typed is not taken."""
        if self._editor.is_open:
            self._cell = None
            had_focus = self._editor.has_focus
            self._editor.close()
            self._workspace.tell("")
            if had_focus:
                self._table.focus()


_NO_COUNT = "A clamp has no count; duplicate it instead"
_NO_LENGTH = "Its length is set by the component"


@dataclass(frozen=True)
class LineCell:
    """A value of a row, as the file of a workspace has it now."""

    workspace: Workspace
    spot: Place
    column: Column

    @property
    def refused(self) -> str:
        """Return why it cannot be edited; empty where it can."""
        if self.spot.is_clamp:
            return _NO_COUNT if self.column == "count" else ""
        index = self.workspace.index
        if self.column != "length" or index is None:
            return ""
        listed = index.get(self._values.get("use", ""))
        is_rigid = listed is not None and listed.kind not in FLEXIBLE_KINDS
        return _NO_LENGTH if is_rigid and "length" not in self._values else ""

    @property
    def text(self) -> str:
        """As it is edited."""
        if self._is_length:
            return length_text(self._values)
        return self._values.get("at" if self.column == "length" else self.column, "")

    @property
    def check(self) -> Check:
        """Return what judges another text of it."""
        if self.column == "count":
            return count
        if self.column != "length":
            return anything
        if self.spot.is_clamp:
            return distance(self.text)
        return length(self._values.get("length", ""), towed=self._is_towed)

    def put(self, text: str) -> None:
        """Write another text, one that was judged good; the same one changes nothing.

        Raises
        ------
        EditError
        """
        written = self._values
        if text == self.text:
            return
        given = {k: new for k, new in self._keys(text).items() if new is not None or k in written}
        if any(written.get(key) != new for key, new in given.items()):
            name = "place" if self.spot.is_clamp and self.column == "length" else self.column
            self.workspace.session.put(self.spot, given, f"change the {name}")

    def onward(self) -> LineCell | None:
        """The next one of the row that can be edited."""
        for column in EDITABLE[EDITABLE.index(self.column) + 1 :]:
            cell = LineCell(self.workspace, self.spot, column)
            if not cell.refused:
                return cell
        return None

    def _keys(self, text: str) -> dict[str, Value | None]:
        """The keys of the file that a text stands for."""
        if self._is_length:
            return dict(length_values(text, towed=self._is_towed))
        if self.column == "length":
            return {"at": text}
        if self.column == "count":
            return {"count": None if text == "1" else text}
        return {self.column: text or None}

    @property
    def _is_length(self) -> bool:
        return self.column == "length" and not self.spot.is_clamp

    @property
    def _values(self) -> dict[str, str]:
        return self.workspace.session.item(self.spot).values

    @property
    def _is_towed(self) -> bool:
        return self.workspace.session.draft.is_tow
