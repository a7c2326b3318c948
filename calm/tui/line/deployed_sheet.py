"""What went over the side: when and where, and what hangs at the row of the cursor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from calm.case.parts import parts_of
from calm.files import Flexible, MooringFile, Piece, Place
from calm.files.editing import Draft, EditError
from calm.files.fields import POSITIVE_LENGTH, QuantityField
from calm.files.yaml_document import Location
from calm.tui.checking import anything, moment, quantity
from calm.tui.dialogs import Asked, Sheet
from calm.tui.line.entries import entered, said
from calm.tui.line.mooring_sheet import LATITUDE, LONGITUDE, filled, written

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
