"""Values of the line, edited in place."""

from __future__ import annotations

from textual import on

from calm.tui.catalogue_index import WITH_LENGTH
from calm.tui.catalogue_verbs import CatalogueVerbs
from calm.tui.cell_editor import CellEditor
from calm.tui.checking import Check, anything, count, distance, length, length_text, length_values
from calm.tui.line_table import LineTable
from calm.tui.session import Spot
from calm.tui.table_row import EDITABLE, Column

_NO_COUNT = "What is clamped on a piece has no count; duplicate it instead"
_NO_LENGTH = "Its length is that of the component"


class CellVerbs(CatalogueVerbs):
    """Opening a cell, judging what is typed, taking it."""

    _editing: tuple[Spot, Column] | None = None

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
            return
        self.table.column = EDITABLE.index(column)
        text, check = self._value(spot, column)
        self._editing = (spot, column)
        region = self.table.cell_region(column)
        self.editor.open(text, check, region, least_width=16 if column == "length" else 6)

    def _refused(self, spot: Spot, column: Column) -> str:
        """Why a value cannot be edited; empty where it can."""
        if spot.is_clamp:
            return _NO_COUNT if column == "count" else ""
        if column != "length" or self.index is None:
            return ""
        values = self.session.item(spot).values
        listed = self.index.get(values.get("use", ""))
        rigid = listed is not None and listed.kind not in WITH_LENGTH and "length" not in values
        return _NO_LENGTH if rigid else ""

    def _value(self, spot: Spot, column: Column) -> tuple[str, Check]:
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
        if self._editing is None:
            return
        spot, column = self._editing
        self._leave_editor()
        values = self._keys(spot, column, event.text)
        item = self.session.item(spot)
        given = {key: new for key, new in values.items() if new is not None or key in item.values}
        if any(item.values.get(key) != new for key, new in given.items()):
            name = "place" if spot.is_clamp and column == "length" else column
            self.attempt(lambda: self.session.put(spot, given, f"change the {name}"))
        if event.onward:
            self._edit_next(column)

    def _keys(self, spot: Spot, column: Column, text: str) -> dict[str, str | None]:
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
    def _leave_editor(self) -> None:
        if self.editor.is_open:
            self._editing = None
            had_focus = self.editor.has_focus
            self.editor.close()
            self.tell("")
            if had_focus:
                self.table.focus()
