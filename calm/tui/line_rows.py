"""Rows of the line table, and editing of their cells and columns."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from textual.events import Paste

from calm.assemble.catalogue_search import Index
from calm.case.columns import Output
from calm.case.result_tables import table_columns
from calm.checks.finding import State, percent_used, worst_state
from calm.files import Place, components
from calm.files.catalogue_search import Listed
from calm.files.editing import Draft, LineItem, Value
from calm.quantities import QUANTITIES
from calm.tui.checking import Check, anything, count, distance, length, length_text, length_values
from calm.tui.dialogs import InputSheet
from calm.tui.forms import FormField
from calm.tui.line_table import EDITABLE, TableRow
from calm.tui.mooring_sheet import (
    RELEASES,
    entered,
    entry_text,
    equipment_changes,
    serial_of_equipment,
    texts_of_equipment,
)
from calm.tui.theme import CLAMP, ROLES, UNKNOWN_ROLE, UNKNOWN_USE
from calm.tui.workspace import Workspace

if TYPE_CHECKING:
    from calm.tui.live import FoundRow, View


_MOST_USE = 9.99


def table_rows(
    draft: Draft, view: View | None, index: Index | None, added: Collection[Place] = ()
) -> list[TableRow]:
    """Return the rows of the line table, one for each item and clamp.

    An item of several pieces shows the least favourable values. If the view belongs to an earlier
    text, only rows with unchanged component and label show results. New rows (`added`) never show
    results of an earlier text.
    """
    found = _results_by_row(draft, view, added)
    wrong = _items_with_mistakes(draft, view)
    rows = []
    before, legs = "", draft.lists.legs
    for number, item in enumerate(draft.items):
        row = _row(Place(number), item, found.get(Place(number), ()), index)
        if legs[number] != before:  # the first row of a leg shows the name of the leg
            before = row.texts["leg"] = legs[number]
        rows.append(replace(row, state=State.FAIL) if number in wrong else row)
        for below, clamp in enumerate(item.clamps):
            spot = Place(number, clamp=below)
            rows.append(_row(spot, clamp, found.get(spot, ()), index))
    return rows


def _items_with_mistakes(draft: Draft, view: View | None) -> set[int]:
    if view is None or view.text != draft.text or not view.problems:
        return set()
    lines = {problem.line for problem in view.problems if problem.path == str(view.path)}
    return {
        number
        for number, item in enumerate(draft.items)
        if not lines.isdisjoint(range(item.line, item.line + max(item.text.count("\n"), 1)))
    }


def _results_by_row(
    draft: Draft, view: View | None, added: Collection[Place]
) -> dict[Place, Sequence[FoundRow]]:
    if view is None:
        return {}
    found: dict[Place, list[FoundRow]] = {}
    for row in view.rows:
        found.setdefault(row.place.row, []).append(row)
    if view.text == draft.text:
        return dict(found)
    known: dict[tuple[str, str, bool], list[Sequence[FoundRow]]] = {}
    for place, rows in found.items():
        known.setdefault(_identity(view.items, place), []).append(rows)
    taken: dict[Place, Sequence[FoundRow]] = {}
    for number, item in enumerate(draft.items):
        for below in range(-1, len(item.clamps)):
            place = Place(number, clamp=below)
            rest = known.get(_identity(draft.items, place))
            if rest and place not in added:
                taken[place] = rest.pop(0)
    return taken


def _identity(items: Sequence[LineItem], place: Place) -> tuple[str, str, bool]:
    item = items[place.item]
    values = (item.clamps[place.clamp] if place.is_clamp else item).values
    use = values.get("use", "")
    return use, values.get("label", use), place.is_clamp


def _row(spot: Place, item: LineItem, found: Sequence[FoundRow], index: Index | None) -> TableRow:
    values = {key: " ".join(value.split()) for key, value in item.values.items()}  # on one line
    use = values.get("use", "")
    listed = None if index is None else index.get(use)
    sign = UNKNOWN_ROLE if listed is None else ROLES.get(listed.role, " ")
    unknown = index is not None and listed is None
    texts = {
        "component": f"{CLAMP} {use}" if spot.is_clamp else use,
        "label": values.get("label", ""),
        "count": values.get("count", ""),
        "length": f"at {values.get('at', '?')}" if spot.is_clamp else _length(values, found),
        **_summary_texts(found),
    }
    states = [row.state for row in found if row.state is not None]
    gravest = worst_state(states) if states else None
    return TableRow(spot, sign if index else " ", texts, gravest, unknown)


def _length(values: Mapping[str, str], found: Sequence[FoundRow]) -> str:
    if values.get("length") == "fit" and found and found[0].length is not None:
        return f"fit: {QUANTITIES['length'].say(found[0].length)}"
    return length_text(values)


def _summary_texts(found: Sequence[FoundRow]) -> dict[str, str]:
    texts = {}
    for one in table_columns(Output.BUILDER):
        known = [row.figures[one.name] for row in found if one.name in row.figures]
        if known and one.quantity:
            texts[one.name] = one.quantity.format(one.worst(known))
    uses = [row.use for row in found if row.use is not None]
    if any(row.lacks_strength for row in found):
        texts["use"] = UNKNOWN_USE
    elif uses:
        most = max(uses)
        texts["use"] = f">{_MOST_USE:.0%}" if most > _MOST_USE else f"{percent_used(most):.0f}%"
    return texts


_NO_COUNT = "Clamps cannot have a count; duplicate the clamp instead"
_NO_LENGTH = "The component determines the length"


@dataclass(frozen=True)
class LineCell:
    """Cell of the line table.

    Edits of the cell change the draft of the workspace.
    """

    workspace: Workspace
    spot: Place
    column: str
    """Name of an editable table column, or `serial`."""

    @property
    def listed(self) -> Listed | None:
        """Catalogue entry for the component of the row; None if there is no entry or catalogue."""
        index = self.workspace.index
        return None if index is None else index.get(self._values.get("use", ""))

    @property
    def refused(self) -> str:
        """Reason why the value cannot be edited; "" if the value is editable."""
        listed = self.listed
        if self.spot.is_clamp:
            return _NO_COUNT if self.column == "count" else ""
        is_rigid = listed is not None and listed.kind not in components.FLEXIBLE_KINDS
        is_set = self.column == "length" and is_rigid and "length" not in self._values
        return _NO_LENGTH if is_set else ""

    @property
    def text(self) -> str:
        """Text of the cell at the start of editing."""
        if self._is_length:
            return length_text(self._values)
        if self.column == "serial":
            return texts_of_equipment(self.workspace.session.written(self.spot), "serial")
        return self._values.get("at" if self.column == "length" else self.column, "")

    @property
    def check(self) -> Check:
        """Function that checks a typed text."""
        if self.column != "length":
            return {"count": count, "serial": serial_of_equipment}.get(self.column, anything)
        if self.spot.is_clamp:
            return distance(self.text)
        return length(self._values.get("length", ""), towed=self._is_towed)

    def put(self, text: str) -> None:
        """Write a valid text to the draft, unless the text is unchanged.

        Raises
        ------
        EditError
            The draft does not allow the change.
        """
        if given := self.values_of(text):
            name = "place" if self.spot.is_clamp and self.column == "length" else self.column
            self.workspace.session.put({self.spot: given}, f"change the {name}")

    def values_of(self, text: str) -> dict[str, Value | None]:
        """Return the changes to the row after a text is entered, as new values by key.

        The value None deletes a key.
        """
        written = self._values
        if text == self.text:
            return {}
        if self.column == "serial":
            return equipment_changes(self.workspace.session.written(self.spot), {"serial": text})
        if self._is_length:
            keys = length_values(text, towed=self._is_towed)
        elif self.column == "length":
            keys = {"at": text}
        else:
            keys = {self.column: None if self.column == "count" and text == "1" else text or None}
        given = {key: new for key, new in keys.items() if new is not None or key in written}
        return given if any(written.get(key) != new for key, new in given.items()) else {}

    def onward(self) -> LineCell | None:
        """Return the next editable cell of the row, or None after the last editable cell."""
        for column in EDITABLE[EDITABLE.index(self.column) + 1 :]:
            cell = LineCell(self.workspace, self.spot, column)
            if not cell.refused:
                return cell
        return None

    @property
    def _is_length(self) -> bool:
        return self.column == "length" and not self.spot.is_clamp

    @property
    def _values(self) -> dict[str, str]:
        return self.workspace.session.item(self.spot).values

    @property
    def _is_towed(self) -> bool:
        return self.workspace.session.draft.is_tow


_TITLES = {"serial": "Serial numbers", "length": "Lengths", "label": "Labels", "codes": "Codes"}


class ColumnSheet(InputSheet):
    """Sheet with a field for each row; a pasted list fills the fields downwards."""

    def on_paste(self, event: Paste) -> None:
        lines = [line.split("\t")[0].strip() for line in event.text.splitlines()]
        fields = self.fields
        first = next((i for i, field in enumerate(fields) if field.input.has_focus), 0)
        if len(lines) < 2:
            return
        event.stop()
        for each, text in zip(fields[first:], lines, strict=False):
            each.input.value = text
        last = min(first + len(lines), len(fields)) - 1
        fields[last].input.focus()
        if len(lines) > len(fields) - first:
            self.app.bell()


class ColumnFilling:
    """Column values of several rows, which are edited on one sheet."""

    def __init__(self, workspace: Workspace, spots: Sequence[Place], column: str) -> None:
        self._session, self._column = workspace.session, column
        held = "serial" if column == "codes" else column  # codes belong to serial numbers
        self._cells = {str(i): LineCell(workspace, spot, held) for i, spot in enumerate(spots)}
        self._form_fields = [
            each for key in self._cells if (each := self._form_field(key)) is not None
        ]

    @property
    def sheet(self) -> ColumnSheet | None:
        """Sheet to edit the values; None if no row can have a value in this column."""
        return (
            ColumnSheet(_TITLES[self._column], "", self._form_fields) if self._form_fields else None
        )

    def write(self, texts: Mapping[str, str]) -> None:
        """Write all changed values to the draft, as a single step of the history."""
        begun, draft = {each.key: each.text for each in self._form_fields}, self._session.draft
        new = {self._cells[key]: text for key, text in texts.items() if text != begun[key]}
        label = f"fill in {_TITLES[self._column].lower()}"
        if self._column == "codes":
            for cell, text in new.items():
                draft = entered(draft, RELEASES, ("serial", cell.text), {"codes": text})
            self._session.do(draft, label)
        else:
            rows = {cell.spot: cell.values_of(text) for cell, text in new.items()}
            self._session.put(rows, label)

    def _form_field(self, key: str) -> FormField | None:
        cell = self._cells[key]
        values = self._session.item(cell.spot).values
        title = values.get("label") or values.get("use", "")
        if self._column != "codes":
            return None if cell.refused else FormField(key, title, cell.text, cell.check)
        if cell.listed is None or cell.listed.role != "release" or not cell.text:
            return None
        codes = entry_text(self._session.draft, RELEASES, ("serial", cell.text), "codes")
        return FormField(key, title, codes)
