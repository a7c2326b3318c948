"""What is asked about a whole file: name and place, document, speed of a tow."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from calm.files.editing import Draft, EditError
from calm.files.fields import LENGTH, QuantityField
from calm.files.yaml_document import Location
from calm.tui.checking import anything, day, quantity
from calm.tui.dialogs import Asked, Sheet
from calm.tui.line.entries import entered, said

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
