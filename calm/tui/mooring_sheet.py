"""Sheets for a whole file: name and place, document, deployment, tow, missing figures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

from calm.checks.finding import State
from calm.files import Clamp, Flexible, MooringFile, Piece, Place
from calm.files.definition import LENGTH, POSITIVE_LENGTH, QuantityField
from calm.files.editing import Draft, EditError, Value
from calm.files.pieces import parts_of
from calm.files.rule_texts import RULES
from calm.files.yaml_document import Location
from calm.tui.checking import Reading, anything, day, moment, quantity
from calm.tui.component_screen import form_fields
from calm.tui.dialogs import InputSheet
from calm.tui.field import Asked
from calm.tui.session import location

if TYPE_CHECKING:
    from calm.tui.live import View

_HISTORY: Location = ("document", "history")

LATITUDE = quantity(QuantityField("latitude", at_least=-90, at_most=90), optional=True)
LONGITUDE = quantity(QuantityField("longitude", at_least=-360, at_most=360), optional=True)
_NAME_AND_PLACE = (
    Asked("name", "Name"),
    Asked("description", "Description"),
    Asked("position.latitude", "Latitude", "", LATITUDE, "e.g. 48.3 deg, + north"),
    Asked("position.longitude", "Longitude", "", LONGITUDE, "e.g. -5.2 deg, + east"),
)
"""The key of what is asked for is its place in the file."""
_SPEED, _COURSE = QuantityField("speed", above=0), QuantityField("angle")
_TOW = (
    Asked("tow.speed", "Tow speed", "", quantity(_SPEED), "e.g. 4 knot"),
    Asked("tow.toward", "Towards", "", quantity(_COURSE), "e.g. 90 deg for east"),
    Asked("tow.height", "Sheave height", "", quantity(LENGTH, optional=True), "e.g. 3 m"),
)
_DOCUMENT = (
    Asked("document.id", "Document", placeholder="M-2027-03"),
    Asked("document.revision", "Revision", placeholder="B"),
    Asked("document.date", "Date", "", day, "2027-06-30"),
    Asked("document.author", "Author"),
    Asked("document.checked", "Checked by"),
    Asked("document.approved", "Approved by"),
    Asked("document.project", "Project"),
    Asked("document.ship", "Ship"),
    Asked("document.cruise", "Cruise"),
)
_BEGIN_A_TOW = (
    "The line becomes a tow: it hangs from a ship, its pieces from the ship down, and has no "
    "anchor. Undo makes it a mooring again."
)


Sheet = tuple[InputSheet, str, Callable[[Draft, Mapping[str, str]], Draft]]
"""What is asked, the label of the change, and the file with what is entered."""


def mooring_sheet(draft: Draft, hung: Piece | Clamp | None) -> Sheet:
    """Name and place, as the file has them."""
    sheet = InputSheet("Name and place", "", filled(draft, _NAME_AND_PLACE))
    return sheet, "name and place", written


def document_sheet(draft: Draft, hung: Piece | Clamp | None) -> Sheet:
    """Return what the title block says, as the file has it, and what the revision changed."""
    revision = draft.text_at(("document", "revision"))
    change = said(draft, _HISTORY, ("revision", revision), "change")
    asked = [*filled(draft, _DOCUMENT), Asked("change", "What it changed", change)]
    sheet = InputSheet("The document", "For the title block of drawings, and its history.", asked)
    return sheet, "the document", _documented


def tow_sheet(draft: Draft, hung: Piece | Clamp | None) -> Sheet:
    """Speed, course and sheave of a tow, as the file has them; a mooring becomes one by them."""
    sheet = InputSheet("The tow", "" if draft.is_tow else _BEGIN_A_TOW, filled(draft, _TOW))
    return sheet, "the tow", written


def filled(draft: Draft, asked: Iterable[Asked]) -> list[Asked]:
    """Return what is asked, with the texts that the file has in its places."""
    return [replace(each, text=draft.text_at(tuple(each.key.split(".")))) for each in asked]


def written(draft: Draft, texts: Mapping[str, str], below: Location = ()) -> Draft:
    """The file with the texts of a sheet in their places; a blank one takes its key away."""
    for key, new in texts.items():
        place = (*below, *key.split("."))
        if new != draft.text_at(place):
            draft = draft.put_at(place, new or None)
    return draft


def _documented(draft: Draft, texts: Mapping[str, str]) -> Draft:
    """The file with the texts of the document, and in its history what the revision changed."""
    revision, change = texts["document.revision"], texts["change"]
    if change and not revision:
        raise EditError("a change is that of a revision; say which")
    known = said(draft, _HISTORY, ("revision", revision), "change")
    draft = written(draft, {key: text for key, text in texts.items() if key != "change"})
    if change == known:
        return draft
    date, author = (texts[f"document.{key}"] if change else "" for key in ("date", "author"))
    by = {"date": date, "by": author, "change": change}
    return entered(draft, _HISTORY, ("revision", revision), by)


_DEPTH = quantity(QuantityField("length", above=0), optional=True)
_WHOLE = (
    Asked("deployed.date", "Date", "", moment, "e.g. 2027-06-30 14:05"),
    *(replace(each, key=f"deployed.{each.key}") for each in _NAME_AND_PLACE[2:]),
    Asked("deployed.depth", "Depth there", "", _DEPTH, "e.g. 1187 m"),
)
_OF_A_ROW = (
    ("serial", "Serial number", anything),
    ("length", "Cut to", quantity(POSITIVE_LENGTH, optional=True)),
    ("remark", "Remark", anything),
)
_COMPARED = "Compared with the design by calm diff."
_ITEMS: Location = ("deployed", "items")
RELEASES: Location = ("releases",)


def hung_at(file: MooringFile | None, spot: Place | None) -> Piece | Clamp | None:
    """Return what hangs at a row of a line; None where that is several things, or not known."""
    found = [part for part in parts_of(file.pieces if file else ()) if part.place.row == spot]
    return found[0] if len(found) == 1 else None


def deployed_sheet(draft: Draft, hung: Piece | Clamp | None) -> Sheet:
    """Return when and where the mooring was deployed and what hangs at a row, as in the file."""
    asked, changed = filled(draft, _WHOLE), partial(_deployed, hung)
    if hung is None:
        return InputSheet("As deployed", _COMPARED, asked), "the deployment", changed
    for key, title, check in _OF_A_ROW:
        if key != "length" or isinstance(hung.component, Flexible):
            text = said(draft, _ITEMS, ("label", hung.label), key)
            asked.append(Asked(f"item {key}", title, text, check))
    if hung.component.role == "release":
        codes = said(draft, RELEASES, ("serial", _serial(draft, hung)), "codes")
        asked.append(Asked("codes", "Codes", codes, placeholder="arm 0A1B, release 0A55"))
    about = f"{_COMPARED} Below the depth: {hung.label}."
    return InputSheet("As deployed", about, asked), "the deployment", changed


def _deployed(hung: Piece | Clamp | None, draft: Draft, texts: Mapping[str, str]) -> Draft:
    draft = written(draft, {each.key: texts[each.key] for each in _WHOLE})
    if hung is None:
        return draft
    given = {key: texts[f"item {key}"] for key, _, _ in _OF_A_ROW if f"item {key}" in texts}
    draft = entered(draft, _ITEMS, ("label", hung.label), given)
    if hung.component.role == "release":
        called = "serial", _serial(draft, hung)
        if texts["codes"] and not called[1]:
            raise EditError(f"{hung.label} needs its serial number, by which its codes are known")
        draft = entered(draft, RELEASES, called, {"codes": texts["codes"]})
    return draft


def _serial(draft: Draft, hung: Piece | Clamp) -> str:
    """Of the release as designed, else as deployed."""
    return hung.serial or said(draft, _ITEMS, ("label", hung.label), "serial")


_SEVERAL = "For a count, give one number for each, separated by commas."


def equipment_sheet(label: str, values: Mapping[str, Any], *, is_clamp: bool) -> InputSheet:
    """The fields of a row as the file has them.

    Parameters
    ----------
    label : of the row
    values : what the file says of it
    """
    asked = [
        replace(each, text=texts_of_equipment(values, each.key))
        for each in _EQUIPMENT
        if not (is_clamp and each.key == "termination")
    ]
    return InputSheet(label, _SEVERAL, asked)


def equipment_changes(
    values: Mapping[str, Any], texts: Mapping[str, str]
) -> dict[str, Value | None]:
    """Return what of the texts differs from what the file says; None takes a key away."""
    changed: dict[str, Value | None] = {}
    for key, new in texts.items():
        if new != texts_of_equipment(values, key):
            several = key == "serial" and "," in new and "count" in values
            changed[key] = [one.strip() for one in new.split(",")] if several else new or None
    return changed


def texts_of_equipment(values: Mapping[str, Any], key: str) -> str:
    """A value of the equipment as it is typed: several are parted by commas."""
    value = values.get(key)
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value or "")


def serial_of_equipment(text: str) -> Reading:
    """Check a serial number, or one for each of a count."""
    numbers = [" ".join(one.split()) for one in text.split(",")]
    if len(numbers) > 1 and not all(numbers):
        return Reading("", "a number is blank")
    return Reading(", ".join(numbers))


_EQUIPMENT = (
    Asked("serial", "Serial number", "", serial_of_equipment, "4711"),
    Asked("calibrated", "Calibrated", "", day, "2027-06-30"),
    Asked("sampling", "Sampling", placeholder="every 10 min"),
    Asked("battery_until", "Battery until", "", day, "2028-06-30"),
    Asked("termination", "Termination", placeholder="swaged, thimbles"),
)


def said(draft: Draft, rows: Location, called: tuple[str, str], key: str) -> str:
    """Return what an entry says under a key, where that is a plain text; else empty.

    Parameters
    ----------
    rows : the list
    called : the key and the text that the entry is known by
    """
    index = _index(draft, rows, called)
    return "" if index is None else draft.text_at((*rows, index, key))


def entered(
    draft: Draft, rows: Location, called: tuple[str, str], texts: Mapping[str, str]
) -> Draft:
    """The file with the texts in an entry, which is added where it is not there.

    One in which nothing is left but what it is known by is taken out.
    """
    changed = {key: text for key, text in texts.items() if text != said(draft, rows, called, key)}
    index = _index(draft, rows, called)
    if index is None:
        given = dict([called]) | changed
        return draft.insert(len(draft.value(rows) or ()), given, rows) if changed else draft
    left = draft.value((*rows, index)).keys() - {key for key, text in changed.items() if not text}
    if changed and left <= {called[0]} and not any(changed.values()):
        return draft.delete([index], rows)
    for key, text in changed.items():
        draft = draft.put_at((*rows, index, key), text or None)
    return draft


def _index(draft: Draft, rows: Location, called: tuple[str, str]) -> int | None:
    listed: Any = draft.value(rows)
    entries = enumerate(listed if isinstance(listed, list) else ())
    return next((i for i, one in entries if isinstance(one, dict) and called in one.items()), None)


SHEETS = {
    "mooring": mooring_sheet,
    "document": document_sheet,
    "deployed": deployed_sheet,
    "tow": tow_sheet,
}
"""What is asked about a whole file, and of what hangs at the row under the cursor."""


_ELSEWHERE = "part of an assembly of the catalogue: use its parts, or define it in the file (o)"
_SOURCE = "data sheet, test certificate …"


def figures_sheet(missing: Sequence[Missing]) -> InputSheet:
    """Ask for all figures of each component, and for their source; any may stay empty."""
    asked: list[Asked] = []
    elsewhere = [f"{each.called}: {_ELSEWHERE}" for each in missing if not each.fields]
    for each in missing:
        for number, figure in enumerate(each.fields):
            above = "" if number else each.called
            key, title = f"{each.use}.{figure.key}", figure.key.replace("_", " ")
            asked.append(replace(figure, key=key, title=title, above=above))
    asked.append(Asked("source", "source", takes=_SOURCE, above="Of the figures"))
    count = len(missing)
    title = f"Figures missing of {count} component{'s' * (count != 1)}; any may stay empty"
    return InputSheet(title, "\n".join(elsewhere), asked)


@dataclass
class Missing:
    """Hold what is not known of a component, once for all rows that use it.

    Attributes
    ----------
    use, kind : of the component
    labels : of the pieces and clamps that it is missing of, as the keys of a dict
    targets : by key where in the file it is written: in the definition, where the file has it,
        else in every row that lacks it; nowhere where that stands in an assembly
    """

    use: str
    kind: str
    labels: dict[str, None] = field(default_factory=dict)
    targets: dict[str, dict[Location, None]] = field(default_factory=dict)

    @property
    def called(self) -> str:
        """Return the component, with the labels of the first rows that lack a figure."""
        from calm.report.check_tables import named

        labels = named(self.labels)
        return self.use if labels == self.use else f"{self.use}: {labels}"

    @property
    def fields(self) -> list[Asked]:
        """Return what would do and can be filled in, as the form of a component has it."""
        return [each for each in form_fields(self.kind) if self.targets.get(each.key)]


def missing_figures(view: View, draft: Draft) -> list[Missing]:
    """Return what the unknown findings of a line ask for, down the line."""
    if view.file is None:
        return []
    wanted: dict[Place, dict[str, None]] = {}
    for finding in view.findings:
        if finding.state is State.UNKNOWN and finding.place and RULES[finding.rule].figures:
            asked = wanted.setdefault(finding.place, {})
            asked.update(dict.fromkeys(RULES[finding.rule].figures))
    own = draft.value(("components",)) or ()
    found: dict[str, Missing] = {}
    for part in parts_of(view.file.pieces):
        if part.place not in wanted:
            continue
        missing = found.setdefault(part.use, Missing(part.use, part.component.kind))
        missing.labels[part.label] = None
        for key in wanted[part.place]:
            targets = missing.targets.setdefault(key, {})
            if part.use in own:
                targets["components", part.use] = None
            elif part.place.part < 0:
                targets[location(part.place)] = None
    return list(found.values())


def with_figures(
    draft: Draft, missing: Iterable[Missing], texts: Mapping[str, str], source: str
) -> Draft:
    """The draft with figures filled in.

    Parameters
    ----------
    texts : by ``component.key``; what is empty stays unknown
    source : of all of them; may be empty

    Raises
    ------
    EditError
        The file does not allow it.
    """
    for each in missing:
        for key, targets in each.targets.items():
            text = texts.get(f"{each.use}.{key}", "")
            for target in targets if text else ():
                draft = draft.put_at((*target, key), text)
                if source:
                    draft = draft.put_at((*target, "sources", key), source)
    return draft
