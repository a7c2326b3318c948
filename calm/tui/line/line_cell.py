"""A value of the line as it is edited: its text, what judges another one, how it is written."""

from __future__ import annotations

from dataclasses import dataclass

from calm.files import Place
from calm.files.components import FLEXIBLE_KINDS
from calm.files.editing import Value
from calm.tui.checking import Check, anything, count, distance, length, length_text, length_values
from calm.tui.line.table import EDITABLE, Column
from calm.tui.messages import Workspace

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
        if given := self.values_of(text):
            name = "place" if self.spot.is_clamp and self.column == "length" else self.column
            self.workspace.session.put(self.spot, given, f"change the {name}")

    def values_of(self, text: str) -> dict[str, Value | None]:
        """The keys of the file that another text changes; None takes one away."""
        written = self._values
        if text == self.text:
            return {}
        given = {k: new for k, new in self._keys(text).items() if new is not None or k in written}
        return given if any(written.get(key) != new for key, new in given.items()) else {}

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
