"""Sheets for a whole file and for a row of its line; all they ask for is in the models."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any

from calm.checks.missing import alternatives
from calm.files import Clamp, Flexible, MooringFile, Piece, Place
from calm.files.editing import Draft, Value
from calm.files.item_keys import ASSEMBLY_FIGURES, Equipment
from calm.files.logbook import DeployedItem
from calm.files.pieces import parts_of
from calm.files.reader import MooringKeys
from calm.files.yaml_document import Location
from calm.tui.checking import Reading
from calm.tui.component_screen import form_fields
from calm.tui.dialogs import InputSheet
from calm.tui.forms import Asked, filled, form_of, model_in, written
from calm.tui.session import location

if TYPE_CHECKING:
    from calm.tui.live import View

Sheet = tuple[InputSheet, str, Callable[[Draft, Mapping[str, str]], Draft]]
"""What is asked, the label of the change, and the file with what is entered."""

_BEGIN_A_TOW = (
    "The line becomes a tow: it hangs from a ship, its pieces from the ship down, and has no "
    "anchor. Undo makes it a mooring again."
)
_COMPARED = "Compared with the design by calm diff."
RELEASES: Location = ("releases",)
_ITEMS: Location = ("deployed", "items")

SHEETS = {
    "mooring": ("Name and place", ("name", "description", "position")),
    "document": ("The document", ("document",)),
    "deployed": ("As deployed", ("deployed", "releases")),
    "tow": ("The tow", ("tow",)),
}
"""Titles of sheets, and the keys of the file that they ask for."""
_ABOUT = {
    "document": "For the title block of drawings, and its history.",
    "tow": _BEGIN_A_TOW,
}


def settings() -> list[str]:
    """Sections of the file that are forms and on no other sheet."""
    known = {key for _, keys in SHEETS.values() for key in keys}
    fields = MooringKeys.model_fields.items()
    return [name for name, each in fields if name not in known and model_in(each.annotation)]


def sheet_of(name: str, draft: Draft, hung: Piece | Clamp | None) -> Sheet:
    """Return a sheet of `SHEETS`, or that of a section of `settings`, as the file has it.

    Parameters
    ----------
    hung : what hangs at the row under the cursor
    """
    fields = MooringKeys.model_fields
    title, keys = SHEETS.get(name, (name.capitalize(), (name,)))
    asked: list[Asked] = []
    for key in keys:
        model = model_in(fields[key].annotation)
        asked += form_of(model, f"{key}.", needed=name == "tow") if model else _top_level(key)
    about = _ABOUT.get(name, "" if name in SHEETS else fields[name].description or "")
    if name == "tow" and draft.is_tow:
        about = ""
    if name == "deployed":
        return _deployed_sheet(draft, hung, asked)
    return InputSheet(title, about, filled(asked, draft.value(()))), title.lower(), written


def _top_level(key: str) -> list[Asked]:
    return [each for each in form_of(MooringKeys, needed=False) if each.key == key]


def hung_at(file: MooringFile | None, spot: Place | None) -> Piece | Clamp | None:
    """Return what hangs at a row of a line; None where that is several things, or not known."""
    found = [part for part in parts_of(file.pieces if file else ()) if part.place.row == spot]
    return found[0] if len(found) == 1 else None


def _deployed_sheet(draft: Draft, hung: Piece | Clamp | None, asked: list[Asked]) -> Sheet:
    """When and where it was deployed; of the row what hangs there, else all that differs."""
    if hung is None:
        sheet = InputSheet("As deployed", _COMPARED, filled(asked, draft.value(())))
        return sheet, "the deployment", written
    is_release = hung.component.role == "release"
    without = {"deployed.items"} if is_release else {"deployed.items", "releases"}
    whole = filled([each for each in asked if each.key not in without], draft.value(()))
    own = [
        replace(each, text=said(draft, _ITEMS, ("label", hung.label), each.key))
        for each in form_of(DeployedItem)
        if each.key != "label" and (each.key != "length" or isinstance(hung.component, Flexible))
    ]
    row = [replace(each, key=f"{_ROW}{each.key}") for each in own]
    row[0] = replace(row[0], above=hung.label)
    every = sorted([*whole, *row], key=lambda each: bool(each.columns))  # tables come last
    sheet = InputSheet("As deployed", _COMPARED, every)
    return sheet, "the deployment", partial(_deployed, hung.label)


_ROW = "row: "


def _deployed(label: str, draft: Draft, texts: Mapping[str, str]) -> Draft:
    draft = written(draft, {key: text for key, text in texts.items() if not key.startswith(_ROW)})
    given = {key.removeprefix(_ROW): text for key, text in texts.items() if key.startswith(_ROW)}
    return entered(draft, _ITEMS, ("label", label), given)


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
        for each in form_of(Equipment)
        if not (is_clamp and each.key == "termination")
    ]
    asked[0] = replace(asked[0], check=serial_of_equipment)
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


_ELSEWHERE = "part of an assembly of the catalogue: use its parts, or define it in the file (o)"
PENDING = "Launch, recovery, breaks and waves are still being judged."
_SOURCE = "data sheet, test certificate …"


def figures_sheet(missing: Sequence[Missing], *, complete: bool = True) -> InputSheet:
    """Ask for all figures of each component, and for their source; any may stay empty.

    Parameters
    ----------
    complete : whether all rules have been judged; else others may need more
    """
    asked: list[Asked] = []
    notes = [] if complete else [PENDING]
    elsewhere = [f"{each.called}: {_ELSEWHERE}" for each in missing if not each.fields]
    for each in missing:
        for number, figure in enumerate(each.fields):
            above = "" if number else each.called
            key, title = f"{each.use}.{figure.key}", figure.key.replace("_", " ")
            takes = each.estimates.get(figure.key, figure.takes)
            asked.append(replace(figure, key=key, title=title, above=above, takes=takes))
    asked.append(Asked("source", "source", takes=_SOURCE, above="Of the figures"))
    count = len(missing)
    title = f"Figures missing of {count} component{'s' * (count != 1)}; any may stay empty"
    return InputSheet(title, "\n".join([*elsewhere, *notes]), asked)


@dataclass
class Missing:
    """Hold what is not known of a component, once for all rows that use it.

    Attributes
    ----------
    use, kind : of the component
    labels : of the pieces and clamps that it is missing of, as the keys of a dict
    targets : by key where in the file it is written: in the definition, where the file has it,
        else in every row that lacks it, of an assembly its own; nowhere if that cannot take it
    estimates : class estimate by key, without its source
    """

    use: str
    kind: str
    labels: dict[str, None] = field(default_factory=dict)
    targets: dict[str, dict[Location, None]] = field(default_factory=dict)
    estimates: dict[str, str] = field(default_factory=dict)

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
    estimates: dict[tuple[str, str], str] = {}
    pieces = [*parts_of(view.file.pieces)]
    for figure in (one.missing for one in view.findings if one.missing is not None):
        own_places = [part.place for part in pieces if part.use == figure.component_id]
        places = [one for one in own_places if one in figure.places] or own_places
        for place in places:
            wanted.setdefault(place, {}).update(dict.fromkeys(alternatives(figure.quantity)))
        if figure.class_estimate is not None:
            bounds = str(figure.class_estimate).partition(": ")[2].partition(" (")[0]
            estimates[figure.component_id, figure.quantity] = f"estimated: {bounds}"
    own = draft.value(("components",)) or ()
    found: dict[str, Missing] = {}
    for part in pieces:
        if part.place not in wanted:
            continue
        missing = found.setdefault(part.use, Missing(part.use, part.component.kind))
        missing.labels[part.label] = None
        for key in wanted[part.place]:
            if (estimate := estimates.get((part.use, key))) is not None:
                missing.estimates[key] = estimate
            targets = missing.targets.setdefault(key, {})
            if part.use in own:
                targets["components", part.use] = None
            elif part.place.part < 0:
                targets[location(part.place)] = None
            elif key in ASSEMBLY_FIGURES:
                targets[location(part.place.row)] = None
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
