"""Name, description and position of a mooring or tow; the keys of a tow."""

from __future__ import annotations

from calm.files.fields import LENGTH, Quantity
from calm.tui.checking import anything, quantity
from calm.tui.dialogs import Asked, Sheet
from calm.tui.written import Location, is_tow, text_at

_PLACES: dict[str, Location] = {
    "name": ("name",),
    "description": ("description",),
    "latitude": ("position", "latitude"),
    "longitude": ("position", "longitude"),
    "speed": ("tow", "speed"),
    "toward": ("tow", "toward"),
    "height": ("tow", "height"),
}

_LATITUDE = quantity(Quantity("angle", at_least=-90, at_most=90), optional=True)
_LONGITUDE = quantity(Quantity("angle", at_least=-360, at_most=360), optional=True)


def mooring_sheet(text: str) -> Sheet:
    """The sheet with what a file says."""
    asked = [
        Asked("name", "Name", check=anything),
        Asked("description", "Description", check=anything),
        Asked("latitude", "Latitude", check=_LATITUDE, placeholder="48.3 deg, north"),
        Asked("longitude", "Longitude", check=_LONGITUDE, placeholder="-5.2 deg, east"),
    ]
    if is_tow(text):
        asked += [
            Asked("speed", "Tow speed", check=quantity(Quantity("speed", above=0))),
            Asked("toward", "Towards", check=quantity(Quantity("angle"))),
            Asked("height", "Sheave height", check=quantity(LENGTH, optional=True)),
        ]
    filled = [
        Asked(each.key, each.title, text_at(text, _PLACES[each.key]), each.check, each.placeholder)
        for each in asked
    ]
    return Sheet("Name and place", "", filled)


def mooring_changes(text: str, texts: dict[str, str]) -> dict[Location, str | None]:
    """What of the texts differs from what the file says; None takes a key away."""
    changed = {
        _PLACES[key]: new or None
        for key, new in texts.items()
        if new != text_at(text, _PLACES[key])
    }
    gone = {("position", "latitude"), ("position", "longitude")}
    if all(changed.get(each, "") is None for each in gone):
        changed = {place: new for place, new in changed.items() if place not in gone}
        changed[("position",)] = None
    return changed
