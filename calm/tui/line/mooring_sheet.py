"""What is asked about a whole file: name and place, document, deployment, speed of a tow."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from calm.files.document import Location
from calm.files.editing import Draft
from calm.files.fields import LENGTH, Quantity
from calm.tui.checking import anything, day, moment, quantity
from calm.tui.dialogs import Asked, Sheet

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
    "deployed date": ("deployed", "date"),
    "deployed latitude": ("deployed", "position", "latitude"),
    "deployed longitude": ("deployed", "position", "longitude"),
    "deployed depth": ("deployed", "depth"),
}

_LATITUDE = quantity(Quantity("angle", at_least=-90, at_most=90), optional=True)
_LONGITUDE = quantity(Quantity("angle", at_least=-360, at_most=360), optional=True)
_NAME_AND_PLACE = (
    Asked("name", "Name", check=anything),
    Asked("description", "Description", check=anything),
    Asked("latitude", "Latitude", check=_LATITUDE, placeholder="e.g. 48.3 deg, + north"),
    Asked("longitude", "Longitude", check=_LONGITUDE, placeholder="e.g. -5.2 deg, + east"),
)
_TOW = (
    Asked(
        "speed", "Tow speed", check=quantity(Quantity("speed", above=0)), placeholder="e.g. 4 knot"
    ),
    Asked(
        "toward", "Towards", check=quantity(Quantity("angle")), placeholder="e.g. 90 deg for east"
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
_DEPLOYED = (
    Asked("deployed date", "Date", check=moment, placeholder="e.g. 2027-06-30 14:05"),
    Asked("deployed latitude", "Latitude", check=_LATITUDE, placeholder="e.g. 48.3 deg, + north"),
    Asked("deployed longitude", "Longitude", check=_LONGITUDE, placeholder="e.g. -5.2 deg, + east"),
    Asked(
        "deployed depth",
        "Depth there",
        check=quantity(Quantity("length", above=0), optional=True),
        placeholder="e.g. 1187 m",
    ),
)
_BEGIN_A_TOW = (
    "The line becomes a tow: it hangs from a ship, its pieces from the ship down, and has no "
    "anchor. Undo makes it a mooring again."
)


def mooring_sheet(draft: Draft) -> Sheet:
    """Name and place, as the file has them."""
    return Sheet("Name and place", "", _filled(draft, _NAME_AND_PLACE))


def document_sheet(draft: Draft) -> Sheet:
    """What the title block of the drawings says, as the file has it."""
    return Sheet("The document", "For the title block of drawings.", _filled(draft, _DOCUMENT))


def deployed_sheet(draft: Draft) -> Sheet:
    """When and where the mooring was deployed, as the file has it."""
    said = "Compared with the design by calm diff. Serials, lengths as cut: in the text, `items`."
    return Sheet("As deployed", said, _filled(draft, _DEPLOYED))


def tow_sheet(draft: Draft) -> Sheet:
    """Speed, course and sheave of a tow, as the file has them; a mooring becomes one by them."""
    return Sheet("The tow", "" if draft.is_tow else _BEGIN_A_TOW, _filled(draft, _TOW))


def _filled(draft: Draft, asked: tuple[Asked, ...]) -> list[Asked]:
    return [replace(each, text=draft.text_at(_PLACES[each.key])) for each in asked]


def changes(draft: Draft, texts: Mapping[str, str]) -> dict[Location, str | None]:
    """What of the texts of a sheet differs from what the file says; None takes a key away."""
    return {
        _PLACES[key]: new or None
        for key, new in texts.items()
        if new != draft.text_at(_PLACES[key])
    }
