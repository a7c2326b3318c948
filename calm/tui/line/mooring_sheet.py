"""What is asked about a whole file: name and place, document, speed of a tow."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from textual.app import App

from calm.case.parts import parts_of
from calm.files import Flexible, MooringFile, Piece, Place
from calm.files.editing import Draft, EditError, Value
from calm.files.fields import LENGTH, POSITIVE_LENGTH, QuantityField
from calm.files.yaml_document import Location
from calm.tui.checking import Reading, anything, day, moment, quantity
from calm.tui.dialogs import Asked, Sheet
from calm.tui.line.missing_screen import entered, said
from calm.tui.line.pane import LinePane

_PLACES: dict[str, Location] = {
    "name": ("name",),
    "description": ("description",),
    "latitude": ("position", "latitude"),
    "longitude": ("position", "longitude"),
    "speed": ("tow", "speed"),
    "toward": ("tow", "toward"),
    "height": ("tow", "height"),
    **{
        key: ("document", key)
        for key in (
            "id",
            "revision",
            "date",
            "author",
            "checked",
            "approved",
            "project",
            "ship",
            "cruise",
        )
    },
}

_HISTORY: Location = ("document", "history")

LATITUDE = quantity(QuantityField("angle", at_least=-90, at_most=90), optional=True)
LONGITUDE = quantity(QuantityField("angle", at_least=-360, at_most=360), optional=True)
_NAME_AND_PLACE = (
    Asked("name", "Name", check=anything),
    Asked("description", "Description", check=anything),
    Asked("latitude", "Latitude", check=LATITUDE, placeholder="e.g. 48.3 deg, + north"),
    Asked("longitude", "Longitude", check=LONGITUDE, placeholder="e.g. -5.2 deg, + east"),
)
_TOW = (
    Asked(
        "speed",
        "Tow speed",
        check=quantity(QuantityField("speed", above=0)),
        placeholder="e.g. 4 knot",
    ),
    Asked(
        "toward",
        "Towards",
        check=quantity(QuantityField("angle")),
        placeholder="e.g. 90 deg for east",
    ),
    Asked("height", "Sheave height", check=quantity(LENGTH, optional=True), placeholder="e.g. 3 m"),
)
_DOCUMENT = (
    Asked("id", "Document", placeholder="M-2027-03"),
    Asked("revision", "Revision", placeholder="B"),
    Asked("date", "Date", check=day, placeholder="2027-06-30"),
    Asked("author", "Author"),
    Asked("checked", "Checked by"),
    Asked("approved", "Approved by"),
    Asked("project", "Project"),
    Asked("ship", "Ship"),
    Asked("cruise", "Cruise"),
)
_BEGIN_A_TOW = (
    "The line becomes a tow: it hangs from a ship, its pieces from the ship down, and has no "
    "anchor. Undo makes it a mooring again."
)


def mooring_sheet(draft: Draft) -> Sheet:
    """Name and place, as the file has them."""
    return Sheet("Name and place", "", filled(draft, _NAME_AND_PLACE))


def document_sheet(draft: Draft) -> Sheet:
    """What the title block of the drawings says, as the file has it."""
    revision = draft.text_at(_PLACES["revision"])
    change = said(draft, _HISTORY, ("revision", revision), "change")
    asked = [*filled(draft, _DOCUMENT), Asked("change", "What it changed", change)]
    return Sheet("The document", "For the title block of drawings, and its history.", asked)


def tow_sheet(draft: Draft) -> Sheet:
    """Speed, course and sheave of a tow, as the file has them; a mooring becomes one by them."""
    return Sheet("The tow", "" if draft.is_tow else _BEGIN_A_TOW, filled(draft, _TOW))


def filled(
    draft: Draft, asked: tuple[Asked, ...], places: Mapping[str, Location] = _PLACES
) -> list[Asked]:
    """What is asked, with the texts that the file has in the places of its keys."""
    return [replace(each, text=draft.text_at(places[each.key])) for each in asked]


def written(
    draft: Draft, texts: Mapping[str, str], places: Mapping[str, Location] = _PLACES
) -> Draft:
    """The file with the texts of a sheet in their places; a blank one takes its key away."""
    for key, new in texts.items():
        if new != draft.text_at(places[key]):
            draft = draft.put_at(places[key], new or None)
    return draft


def documented(draft: Draft, texts: Mapping[str, str]) -> Draft:
    """The file with the texts of the document, and in its history what the revision changed."""
    revision, change = texts["revision"], texts["change"]
    if change and not revision:
        raise EditError("a change is that of a revision; say which")
    known = said(draft, _HISTORY, ("revision", revision), "change")
    draft = written(draft, {key: text for key, text in texts.items() if key != "change"})
    if change == known:
        return draft
    by = {"date": texts["date"], "by": texts["author"]} if change else {"date": "", "by": ""}
    return entered(draft, _HISTORY, ("revision", revision), by | {"change": change})


_DEPLOYED_PLACES: dict[str, Location] = {
    "date": ("deployed", "date"),
    "latitude": ("deployed", "position", "latitude"),
    "longitude": ("deployed", "position", "longitude"),
    "depth": ("deployed", "depth"),
}
_WHOLE = (
    Asked("date", "Date", check=moment, placeholder="e.g. 2027-06-30 14:05"),
    Asked("latitude", "Latitude", check=LATITUDE, placeholder="e.g. 48.3 deg, + north"),
    Asked("longitude", "Longitude", check=LONGITUDE, placeholder="e.g. -5.2 deg, + east"),
    Asked(
        "depth",
        "Depth there",
        check=quantity(QuantityField("length", above=0), optional=True),
        placeholder="e.g. 1187 m",
    ),
)
_OF_A_ROW = (
    ("serial", "Serial number", anything),
    ("length", "Cut to", quantity(POSITIVE_LENGTH, optional=True)),
    ("remark", "Remark", anything),
)
_COMPARED = "Compared with the design by calm diff."
_ITEMS: Location = ("deployed", "items")
_RELEASES: Location = ("releases",)


@dataclass(frozen=True)
class Hung:
    """What hangs at a row, and is deployed once: its label and designed serial number."""

    label: str
    serial: str
    is_cut: bool
    is_release: bool


def hung_at(file: MooringFile | None, spot: Place | None) -> Hung | None:
    """What hangs at a row of a line; None where that is several things, or not known."""
    if file is None or spot is None:
        return None
    found = [
        part
        for piece in file.pieces
        for part in parts_of([piece])
        if (part.place.item, part.place.clamp) == (spot.item, spot.clamp)
    ]
    if len(found) != 1:
        return None
    [part] = found
    serial = part.equipment.serial
    return Hung(
        part.label,
        serial if isinstance(serial, str) else "",
        isinstance(part, Piece) and isinstance(part.component, Flexible),
        part.component.role == "release",
    )


def deployed_sheet(draft: Draft, hung: Hung | None) -> Sheet:
    """When and where the mooring was deployed, and what hangs at a row, as the file has them."""
    asked = filled(draft, _WHOLE, _DEPLOYED_PLACES)
    if hung is None:
        return Sheet("As deployed", _COMPARED, asked)
    for key, title, check in _OF_A_ROW:
        if key != "length" or hung.is_cut:
            text = said(draft, _ITEMS, ("label", hung.label), key)
            asked.append(Asked(f"item {key}", title, text, check))
    if hung.is_release:
        codes = said(draft, _RELEASES, ("serial", _serial(draft, hung)), "codes")
        asked.append(Asked("codes", "Codes", codes, placeholder="arm 0A1B, release 0A55"))
    return Sheet("As deployed", f"{_COMPARED} Below the depth: {hung.label}.", asked)


def as_deployed(draft: Draft, hung: Hung | None, texts: Mapping[str, str]) -> Draft:
    """The file with what was entered."""
    draft = written(draft, {key: texts[key] for key in _DEPLOYED_PLACES}, _DEPLOYED_PLACES)
    if hung is None:
        return draft
    given = {key: texts[f"item {key}"] for key, _, _ in _OF_A_ROW if f"item {key}" in texts}
    draft = entered(draft, _ITEMS, ("label", hung.label), given)
    if hung.is_release:
        called = "serial", _serial(draft, hung)
        if texts["codes"] and not called[1]:
            raise EditError(f"{hung.label} needs its serial number, by which its codes are known")
        draft = entered(draft, _RELEASES, called, {"codes": texts["codes"]})
    return draft


def _serial(draft: Draft, hung: Hung) -> str:
    """Of the release as designed, else as deployed."""
    return hung.serial or said(draft, _ITEMS, ("label", hung.label), "serial")


_SEVERAL = "For a count, give one number for each, separated by commas."


def equipment_sheet(label: str, values: Mapping[str, Any], *, is_clamp: bool) -> Sheet:
    """The fields of a row as the file has them.

    Parameters
    ----------
    label : of the row
    values : what the file says of it
    """
    asked = [
        Asked("serial", "Serial number", _said(values, "serial"), _serial_of_equipment, "4711"),
        Asked("calibrated", "Calibrated", _said(values, "calibrated"), day, "2027-06-30"),
        Asked("sampling", "Sampling", _said(values, "sampling"), anything, "every 10 min"),
        Asked("battery_until", "Battery until", _said(values, "battery_until"), day, "2028-06-30"),
    ]
    if not is_clamp:
        made = _said(values, "termination")
        asked.append(Asked("termination", "Termination", made, anything, "swaged, thimbles"))
    return Sheet(label, _SEVERAL, asked)


def equipment_changes(
    values: Mapping[str, Any], texts: Mapping[str, str]
) -> dict[str, Value | None]:
    """What of the texts differs from what the file says; None takes a key away."""
    changed: dict[str, Value | None] = {}
    for key, new in texts.items():
        if new != _said(values, key):
            several = key == "serial" and "," in new and "count" in values
            changed[key] = [one.strip() for one in new.split(",")] if several else new or None
    return changed


def _said(values: Mapping[str, Any], key: str) -> str:
    value = values.get(key)
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value or "")


def _serial_of_equipment(text: str) -> Reading:
    numbers = [" ".join(one.split()) for one in text.split(",")]
    if len(numbers) > 1 and not all(numbers):
        return Reading("", "a number is blank")
    return Reading(", ".join(numbers))


class Sheets:
    """Shows each, and writes what was entered."""

    def __init__(self, app: App[Any], line: LinePane) -> None:
        self._app, self._line, self._workspace = app, line, line.workspace

    @property
    def _draft(self) -> Draft:
        return self._workspace.session.draft

    def mooring(self) -> None:
        """Name, description, position."""
        self._ask(mooring_sheet(self._draft), "name and place", written)

    def document(self) -> None:
        """What the title block of the drawings says, and what the revision changed."""
        self._ask(document_sheet(self._draft), "the document", documented)

    def deployed(self) -> None:
        """When and where the mooring was deployed, and what hangs at the row."""
        view = self._workspace.view if self._workspace.is_fresh else None
        hung = hung_at(None if view is None else view.file, self._line.table.spot)

        def deployed(draft: Draft, texts: Mapping[str, str]) -> Draft:
            return as_deployed(draft, hung, texts)

        self._ask(deployed_sheet(self._draft, hung), "the deployment", deployed)

    def tow(self) -> None:
        """Speed and course of a tow; a mooring becomes one."""
        self._ask(tow_sheet(self._draft), "the tow", written)

    def _ask(
        self, sheet: Sheet, label: str, changed: Callable[[Draft, Mapping[str, str]], Draft]
    ) -> None:
        session = self._workspace.session

        def take(texts: dict[str, str] | None) -> None:
            if texts is not None:
                self._line.attempt(lambda: session.do(changed(session.draft, texts), label))

        self._app.push_screen(sheet, take)
