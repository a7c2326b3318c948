"""Input sheets for sections of the file and for single rows, generated from the file models."""

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
from calm.tui.forms import FormField, filled, form_of, model_in, written
from calm.tui.session import location

if TYPE_CHECKING:
    from calm.tui.live import View

Sheet = tuple[InputSheet, str, Callable[[Draft, Mapping[str, str]], Draft]]
"""An input sheet, the label of the resulting change, and a function that writes the entered texts
to a draft.
"""

_BEGIN_A_TOW = (
    "The line becomes a tow: it hangs from a ship, has no anchor, and is listed from the ship "
    "down. Undo restores the mooring."
)
_COMPARED = "calm diff compares these entries with the design."
RELEASES: Location = ("releases",)
_ITEMS: Location = ("deployed", "items")

SHEETS = {
    "mooring": ("Name and position", ("name", "description", "position")),
    "document": ("The document", ("document",)),
    "deployed": ("As deployed", ("deployed", "releases")),
    "tow": ("The tow", ("tow",)),
}
"""Title of each sheet, and the keys of the file that the sheet contains, by name of the sheet."""
_ABOUT = {
    "document": "These entries fill the title block of drawings, with its revision history.",
    "tow": _BEGIN_A_TOW,
}


def settings() -> list[str]:
    """Return the names of the file sections that have a model but no sheet in `SHEETS`."""
    known = {key for _, keys in SHEETS.values() for key in keys}
    fields = MooringKeys.model_fields.items()
    return [name for name, each in fields if name not in known and model_in(each.annotation)]


def sheet_of(name: str, draft: Draft, part: Piece | Clamp | None) -> Sheet:
    """Create a sheet that shows the values in the file.

    `name` is a sheet in `SHEETS` or a section from `settings`. `part` is the piece or clamp in the
    row under the cursor.
    """
    fields = MooringKeys.model_fields
    title, keys = SHEETS.get(name, (name.capitalize(), (name,)))
    form_fields: list[FormField] = []
    for key in keys:
        model = model_in(fields[key].annotation)
        form_fields += form_of(model, f"{key}.", needed=name == "tow") if model else _top_level(key)
    about = _ABOUT.get(name, "" if name in SHEETS else fields[name].description or "")
    if name == "tow" and draft.is_tow:
        about = ""
    if name == "deployed":
        return _deployed_sheet(draft, part, form_fields)
    return InputSheet(title, about, filled(form_fields, draft.value(()))), title.lower(), written


def _top_level(key: str) -> list[FormField]:
    return [each for each in form_of(MooringKeys, needed=False) if each.key == key]


def part_of_row(file: MooringFile | None, spot: Place | None) -> Piece | Clamp | None:
    """Return the piece or clamp of a row; None unless the row is exactly one piece or clamp."""
    found = [part for part in parts_of(file.pieces if file else ()) if part.place.row == spot]
    return found[0] if len(found) == 1 else None


def _deployed_sheet(
    draft: Draft, part: Piece | Clamp | None, form_fields: list[FormField]
) -> Sheet:
    if part is None:
        sheet = InputSheet("As deployed", _COMPARED, filled(form_fields, draft.value(())))
        return sheet, "the deployment", written
    is_release = part.component.role == "release"
    without = {"deployed.items"} if is_release else {"deployed.items", "releases"}
    whole = filled([each for each in form_fields if each.key not in without], draft.value(()))
    own = [
        replace(each, text=entry_text(draft, _ITEMS, ("label", part.label), each.key))
        for each in form_of(DeployedItem)
        if each.key != "label" and (each.key != "length" or isinstance(part.component, Flexible))
    ]
    row = [replace(each, key=f"{_ROW}{each.key}") for each in own]
    row[0] = replace(row[0], above=part.label)
    every = sorted([*whole, *row], key=lambda each: bool(each.columns))  # tables come last
    sheet = InputSheet("As deployed", _COMPARED, every)
    return sheet, "the deployment", partial(_deployed, part.label)


_ROW = "row: "


def _deployed(label: str, draft: Draft, texts: Mapping[str, str]) -> Draft:
    draft = written(draft, {key: text for key, text in texts.items() if not key.startswith(_ROW)})
    given = {key.removeprefix(_ROW): text for key, text in texts.items() if key.startswith(_ROW)}
    return entered(draft, _ITEMS, ("label", label), given)


_SEVERAL = "If the row has a count, separate the serial numbers by commas."


def equipment_sheet(label: str, values: Mapping[str, Any], *, is_clamp: bool) -> InputSheet:
    """Create the equipment sheet for a row, with the values in the file.

    Parameters
    ----------
    label : label of the row
    values : keys of the row in the file
    """
    form_fields = [
        replace(each, text=texts_of_equipment(values, each.key))
        for each in form_of(Equipment)
        if not (is_clamp and each.key == "termination")
    ]
    form_fields[0] = replace(form_fields[0], check=serial_of_equipment)
    return InputSheet(label, _SEVERAL, form_fields)


def equipment_changes(
    values: Mapping[str, Any], texts: Mapping[str, str]
) -> dict[str, Value | None]:
    """Return new values for the equipment keys whose text has changed; None deletes a key."""
    changed: dict[str, Value | None] = {}
    for key, new in texts.items():
        if new != texts_of_equipment(values, key):
            several = key == "serial" and "," in new
            changed[key] = [one.strip() for one in new.split(",")] if several else new or None
    return changed


def texts_of_equipment(values: Mapping[str, Any], key: str) -> str:
    """Return the value of an equipment key as a text, with commas between several values."""
    value = values.get(key)
    return ", ".join(map(str, value)) if isinstance(value, list) else str(value or "")


def serial_of_equipment(text: str) -> Reading:
    """Check the serial numbers of a row, typed with commas between them."""
    numbers = [" ".join(one.split()) for one in text.split(",")]
    if len(numbers) > 1 and not all(numbers):
        return Reading("", "a number is blank")
    return Reading(", ".join(numbers))


def entry_text(draft: Draft, rows: Location, called: tuple[str, str], key: str) -> str:
    """Return the text of a key in one entry of a list in the file.

    `rows` is the path of the list. `called` is a key and the text that this key has in the entry.
    Without such an entry, the result is "".
    """
    index = _index(draft, rows, called)
    return "" if index is None else draft.text_at((*rows, index, key))


def entered(
    draft: Draft, rows: Location, called: tuple[str, str], texts: Mapping[str, str]
) -> Draft:
    """Write texts to a list entry of the file (see `entry_text`), and return the new draft.

    A missing entry is added. An entry is deleted if only its identifying key remains.
    """
    changed = {
        key: text for key, text in texts.items() if text != entry_text(draft, rows, called, key)
    }
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


_ELSEWHERE = (
    "this component is part of an assembly from the catalogue. To enter its values, put the parts "
    "of the assembly in the line instead, or define the component in the file (key o)"
)
PENDING = "Launch, recovery, break and wave checks are still running."
_SOURCE = "data sheet, test certificate …"


def figures_sheet(missing: Sequence[Missing], *, complete: bool = True) -> InputSheet:
    """Create a sheet for missing component values and their source; all fields are optional.

    Parameters
    ----------
    complete : whether all rules have been checked; if not, more values may be needed
    """
    form_fields: list[FormField] = []
    notes = [] if complete else [PENDING]
    elsewhere = [f"{each.called}: {_ELSEWHERE}" for each in missing if not each.fields]
    for each in missing:
        for number, figure in enumerate(each.fields):
            above = "" if number else each.called
            key, title = f"{each.use}.{figure.key}", figure.key.replace("_", " ")
            takes = each.estimates.get(figure.key, figure.takes)
            form_fields.append(replace(figure, key=key, title=title, above=above, takes=takes))
    form_fields.append(FormField("source", "source", takes=_SOURCE, above="Source of these values"))
    count = len(missing)
    title = f"Missing values of {count} component{'s' * (count != 1)}; all are optional"
    return InputSheet(title, "\n".join([*elsewhere, *notes]), form_fields)


@dataclass
class Missing:
    """Missing values of a component, collected from all rows that use the component.

    Attributes
    ----------
    labels : labels of the pieces and clamps concerned
    targets : for each key, the locations in the file to which the missing value is written. If the
        file defines the component, the location is this definition. Otherwise, the locations are
        all rows that lack the value. For a part of an assembly, the location is the row of the
        assembly.
    estimates : estimates for the class of component, by key, without their source
    """

    use: str
    kind: str
    labels: dict[str, None] = field(default_factory=dict)
    targets: dict[str, dict[Location, None]] = field(default_factory=dict)
    estimates: dict[str, str] = field(default_factory=dict)

    @property
    def called(self) -> str:
        """Id of the component, followed by the labels of the parts that lack a value."""
        from calm.report.check_tables import named

        labels = named(self.labels)
        return self.use if labels == self.use else f"{self.use}: {labels}"

    @property
    def fields(self) -> list[FormField]:
        """Form fields in which the missing values can be entered."""
        return [each for each in form_fields(self.kind) if self.targets.get(each.key)]


def missing_figures(view: View, draft: Draft) -> list[Missing]:
    """Collect the values that findings report as missing, by component in line order."""
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
    """Write the entered component values to the file, and return the new draft.

    The keys of `texts` are ``component.key``. An empty text leaves a value unknown. Raise EditError
    if the file does not allow the change.
    """
    for each in missing:
        for key, targets in each.targets.items():
            text = texts.get(f"{each.use}.{key}", "")
            for target in targets if text else ():
                draft = draft.put_at((*target, key), text)
                if source:
                    draft = draft.put_at((*target, "sources", key), source)
    return draft
