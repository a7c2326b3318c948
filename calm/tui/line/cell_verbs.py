"""Values of the line, edited in place."""

from __future__ import annotations

from collections.abc import Callable

from textual import on

from calm.files import Place
from calm.tui.catalogue.index import WITH_LENGTH
from calm.tui.catalogue.verbs import CatalogueVerbs
from calm.tui.checking import Check, anything, count, distance, length, length_text, length_values
from calm.tui.line.cell_editor import CellEditor
from calm.tui.line.table import LineTable
from calm.tui.line.table_row import EDITABLE, Column

_NO_COUNT = "What is clamped on a piece has no count; duplicate it instead"
_NO_LENGTH = "Its length is that of the component"


class CellVerbs(CatalogueVerbs):
    """Opening a cell, judging what is typed, taking it."""

    _editing: tuple[Place, Column] | None = None

    def action_edit(self) -> None:
        """Edit the value under the cursor."""
        self.action_edit_column(self.table.cell)

    @on(LineTable.Activated)
    def _pressed(self) -> None:
        self.action_edit()

    def action_edit_column(self, column: Column) -> None:
        """Edit a value of the row under the cursor."""
        spot, row = self.table.spot, self.table.row
        if spot is None or row is None:
            self.action_add(1)
            return
        if column == "component":
            self.action_replace()
            return
        refused = self._refused(spot, column)
        if refused:
            self.tell(refused)
        if refused or not self.settle():
            return
        self.table.column = EDITABLE.index(column)
        text, check = self._value(spot, column)
        self._editing = (spot, column)
        region = self.table.cell_region(column)
        self.editor.open(text, check, region, least_width=16 if column == "length" else 6)

    def _refused(self, spot: Place, column: Column) -> str:
        """Why a value cannot be edited; empty where it can."""
        if spot.is_clamp:
            return _NO_COUNT if column == "count" else ""
        if column != "length" or self.index is None:
            return ""
        values = self.session.item(spot).values
        listed = self.index.get(values.get("use", ""))
        rigid = listed is not None and listed.kind not in WITH_LENGTH and "length" not in values
        return _NO_LENGTH if rigid else ""

    def _value(self, spot: Place, column: Column) -> tuple[str, Check]:
        """The text of a cell as it is edited, and what judges it."""
        values = self.session.item(spot).values
        if column == "label":
            return values.get("label", ""), anything
        if column == "count":
            return values.get("count", ""), count
        if spot.is_clamp:
            return values.get("at", ""), distance(values.get("at", ""))
        text = length_text(values)
        return text, length(values.get("length", ""), towed=self.is_tow)

    @on(CellEditor.Judged)
    def _tell_reading(self, event: CellEditor.Judged) -> None:
        reading = event.reading
        if not self.editor.is_open:
            return
        completed = reading.text if reading.text != self.editor.value.strip() else ""
        self.tell(
            reading.note or (f"= {completed}" if completed and reading.is_good else ""),
            wrong=not reading.is_good,
        )

    @on(CellEditor.Done)
    def _take_value(self, event: CellEditor.Done) -> None:
        if self._editing is not None:
            _, column = self._editing
            self._put(event.text)
            if event.onward:
                self._edit_next(column)

    def settle(self) -> bool:
        """Take what is typed in a cell; a bad value stays to be corrected."""
        if self._editing is None or not self.editor.is_open:
            return True
        reading = self.editor.settle()
        if reading.is_good:
            self._put(self.editor.text)
        else:
            self.editor.focus()
            self.tell(f"Not taken yet: {reading.note}", wrong=True)
        return reading.is_good

    @property
    def is_typing(self) -> bool:
        """Whether a value is typed in place that is not in the draft yet."""
        return self.editor.is_typing

    def replaced(self) -> None:
        """Show the draft anew: what is marked or edited may be another piece in it."""
        self._forget_rows()
        self.refresh_rows()

    def changed(self, spot: Place | None = None, told: str = "") -> None:
        """The file is another one, and so may be the piece that is marked or edited."""
        here = self.table.spot
        self._forget_rows()
        super().changed(here if spot is None else spot, told)

    def attempt(self, change: Callable[[], object], told: str = "") -> bool:
        """Make a change, after what is typed in place is taken. Whether it was made."""
        return self.settle() and super().attempt(change, told)

    def _forget_rows(self) -> None:
        self._leave_editor()
        self.table.mark(frozenset())

    def _put(self, text: str | None) -> None:
        """Put a text into the piece that is edited; None leaves it as it was."""
        assert self._editing is not None
        spot, column = self._editing
        self._leave_editor()
        if text is None:
            return
        values = self._keys(spot, column, text)
        item = self.session.item(spot)
        given = {key: new for key, new in values.items() if new is not None or key in item.values}
        if any(item.values.get(key) != new for key, new in given.items()):
            name = "place" if spot.is_clamp and column == "length" else column
            self.attempt(lambda: self.session.put(spot, given, f"change the {name}"))

    def _keys(self, spot: Place, column: Column, text: str) -> dict[str, str | None]:
        """The keys of the file that a text of a cell stands for."""
        if column == "label":
            return {"label": text or None}
        if column == "count":
            return {"count": None if text == "1" else text}
        if spot.is_clamp:
            return {"at": text}
        return dict(length_values(text, towed=self.is_tow))

    def _edit_next(self, column: Column) -> None:
        spot = self.table.spot
        for other in EDITABLE[EDITABLE.index(column) + 1 :]:
            if spot is not None and not self._refused(spot, other):
                self.action_edit_column(other)
                return

    @on(CellEditor.Abandoned)
    def _abandon(self, event: CellEditor.Abandoned) -> None:
        self._leave_editor()
        if event.reason:
            self.tell(event.reason, wrong=True)

    def _leave_editor(self) -> None:
        if self.editor.is_open:
            self._editing = None
            had_focus = self.editor.has_focus
            self.editor.close()
            self.tell("")
            if had_focus:
                self.table.focus()
