"""Reading and writing of the environment keys of a file, for the water form."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

from textual import events, on
from textual.message import Message
from textual.widget import Widget
from textual.widgets import Static

from calm.files.definition import POSITIVE_LENGTH, QuantityField
from calm.files.editing import Draft, Value
from calm.files.environment import (
    CurrentFile,
    EnvironmentKeys,
    TowEnvironmentKeys,
    UniformCurrent,
)
from calm.files.water import USUAL_DENSITY, SeaWaterKeys
from calm.files.yaml_document import Location
from calm.records import headings, profile_tables
from calm.records.delimited import CopiedTable, NoTableError, copied_table
from calm.tui import key_table, water_tables
from calm.tui.checking import quantity
from calm.tui.field import Cycle, Field
from calm.tui.forms import FormColumn, FormField, form_of, rows_in, text_of, value_of
from calm.tui.table_field import Grid
from calm.units import QuantityError, QuantityRange

CURRENT_FORMS = ("still", "uniform", "table", "file")
DENSITY_FORMS = ("constant", "table", "temperature and salinity")
TITLE = 24
"""Width of field names [cells]."""
PROFILE_FORMS = ("constant", "table")
"""Possible forms of temperature and salinity."""

_CURRENT = ("0.5", "90")
_CONSTANTS = {
    ("density",): (profile_tables.WATER_DENSITY, "kg/m^3", f"{USUAL_DENSITY['water']:g}"),
    ("density", "temperature"): (profile_tables.TEMPERATURE, "degC", "10"),
    ("density", "salinity"): (profile_tables.SALINITY, "", "35"),
}
"""Quantities that are either constant or tabulated: kind, unit, and initial value."""

Place = tuple[str, ...]
"""Path of a key within an environment: ``("density", "salinity")``."""


class WaterForm:
    """Access to one environment in a file.

    `variant` is the name of the environment, or None for the default environment. Every change
    raises EditError if the text of the file does not allow the change.
    """

    def __init__(self, draft: Draft, variant: str | None) -> None:
        self.draft, self.variant = draft, variant
        self.place: Location = ("environments", variant) if variant else ("environment",)

    def at(self, *keys: str) -> Location:
        """Return the location of an environment key in the file."""
        return (*self.place, *keys)

    def own(self, *keys: str) -> Any:
        """Return the value of a key that this environment itself sets, or None."""
        return self.draft.value(self.at(*keys))

    def value(self, *keys: str) -> Any:
        """Return the value of a key in this environment, or else in the default environment."""
        if self.own(keys[0]) is not None:
            return self.own(*keys)
        return self.draft.value(("environment", *keys))

    def text(self, *keys: str) -> str:
        """Return the value of a key as the text that a user would type."""
        return text_of(self.value(*keys))

    def is_own(self, key: str) -> bool:
        """Return whether this environment sets a key; always true for the default environment."""
        return self.variant is None or self.own(key) is not None

    @property
    def depth(self) -> float | None:
        """Water depth [m]; None if the depth is not set or not positive."""
        return _si_value(POSITIVE_LENGTH, self.text("depth"))

    def form(self, *keys: str) -> str:
        """Return the form in which a property is given, such as ``constant`` or ``table``.

        The property is the current, the density, the temperature or the salinity.
        """
        value = self.value(*keys)
        if isinstance(value, dict) and {"columns", "rows"} & set(value):
            return "table"
        if keys == ("density",):
            return DENSITY_FORMS[2] if isinstance(value, dict) else "constant"
        if keys != ("current",):
            return "constant"
        if not isinstance(value, dict) or not value:
            return "still"
        return "file" if CurrentFile.model_fields.keys() & set(value) else "uniform"

    def table(self, *keys: str) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        """Return the columns and the rows of a table as texts; missing cells are empty.

        Without a table, or if a row is too long or has nested values, there are no columns and no
        rows.
        """
        table = self.value(*keys)
        columns = table.get("columns") if isinstance(table, dict) else None
        if not isinstance(columns, list) or not all(isinstance(one, str) for one in columns):
            return (), []
        rows = rows_in(table.get("rows"), [FormColumn("", heading) for heading in columns])
        if rows is None or any(text.startswith(("[", "{")) for row in rows for text in row):
            return (), []
        return tuple(columns), [*rows]

    # changes, which return the new draft

    def put(self, keys: Sequence[str], text: str, *, is_needed: bool = False) -> Draft:
        """Set the value of a key, or delete the key if the text is empty.

        If a required key (`is_needed`) is deleted, its parent is deleted, too.
        """
        if is_needed and len(keys) > 1 and not text:
            return self.draft.put_at(self.at(*keys[:-1]), None)
        return self.put_form(keys, value_of(text))

    def put_rows(
        self, keys: Sequence[str], columns: Iterable[str], rows: Iterable[Sequence[str]]
    ) -> Draft:
        """Write a table to the file. Unchanged rows keep their text."""
        names = [*columns]
        given = self.value(*keys)
        old = given.get("rows") if isinstance(given, dict) and self.table(*keys)[0] else None
        known = dict(zip(self.table(*keys)[1], old or (), strict=False))
        new = [known.get(tuple(row), [text or None for text in row]) for row in rows]
        return self._with_inherited_value(keys).put_table(self.at(*keys), names, new)

    def put_form(self, keys: Sequence[str], value: Value | None) -> Draft:
        """Replace the value of a property, such as the current; None deletes the property."""
        return self._with_inherited_value(keys).put_at(self.at(*keys), value)

    def begun(self, keys: Place, form: str) -> Value | None:
        """Return the initial value of a property that the user changes to another form.

        The initial value comes from the previous value of the property. If this is unknown, it is a
        typical value. None means that the key can be omitted.
        """
        if keys == ("current",):
            return self._begun_current(form)
        kind, unit, usual = _CONSTANTS[keys]
        known = _si_value(kind, self.text(*keys))
        figure = usual if known is None else f"{known:g}"
        if form == "table":
            columns = ["depth m", f"{keys[-1]} {unit}".rstrip()]
            return {"columns": columns, "rows": [["0", figure], [self._down_to, figure]]}
        if form == "constant":
            return f"{figure} {unit}".rstrip()
        return {name[-1]: self.begun(name, "constant") for name in _CONSTANTS if len(name) > 1}

    def _begun_current(self, form: str) -> Value | None:
        """Return the initial current in another form.

        The values are taken from the uniform current or from the first row of the table.
        """
        place = {name: self.text("current", name) for name in ("speed", "toward")}
        columns, rows = self.table("current")
        for column, text in zip(columns, rows[0] if rows else (), strict=False):
            name, unit = headings.heading(column)
            place[name] = f"{text} {unit}".strip()
        found = [
            _si_value(QuantityField("speed"), place.get(name, "")) for name in ("speed", "u", "v")
        ]
        flow = found[0], _si_value(QuantityField("angle"), place["toward"])
        if found[1] is not None and found[2] is not None:
            flow = profile_tables.speed_and_direction(found[1], found[2])
        known = [f"{each:g}" for each in flow if each is not None]
        speed, toward = known if len(known) == 2 else _CURRENT
        if form == "table":
            rows_begun = [["0", speed, toward], [self._down_to, speed, toward]]
            return {"columns": [*water_tables.CURRENT_COLUMNS], "rows": rows_begun}
        if form == "uniform":
            return {"speed": f"{speed} m/s", "toward": f"{toward} deg"}
        # otherwise the current of the default environment would apply here, too
        return {"speed": "0 m/s", "toward": "0 deg"} if self.variant else None

    @property
    def _down_to(self) -> str:
        return f"{self.depth or water_tables.USUAL_DEPTH:g}"

    def _with_inherited_value(self, keys: Sequence[str]) -> Draft:
        inherited = self.value(keys[0])
        if len(keys) == 1 or self.is_own(keys[0]) or not isinstance(inherited, dict):
            return self.draft
        # a key of a named environment replaces the whole value of the default environment
        return self.draft.put_at(self.at(keys[0]), inherited)


def _si_value(kind: QuantityRange, text: str) -> float | None:
    try:
        return kind.read(text) if text else None
    except QuantityError:
        return None


_ACCEPT_HINT = "Enter accepts"


class FormChoice(Cycle):
    """Selector of the form in which a water property is given.

    The arrows show other forms, and Enter accepts. Leaving without Enter restores the form in the
    draft.
    """

    BINDINGS = key_table.bindings("given")

    @dataclass
    class Taken(Message):
        """Message that another form was accepted."""

        choice: FormChoice
        form: str

    def __init__(self, title: str, forms: tuple[str, ...], *, id: str) -> None:
        super().__init__(title, forms, forms[0], title_width=TITLE, id=f"{id}-form")
        self._given = forms[0]

    def show(self, word: str) -> None:
        """Show the form in the draft."""
        self._given = word
        super().show(word)

    def action_turn(self, by: int) -> None:
        super().show(self.next_word(by))

    def action_take(self) -> None:
        if self.word != self._given:
            self.post_message(self.Taken(self, self.word))
        else:
            self.screen.focus_next()

    @on(events.Click)
    def _press(self, event: events.Click) -> None:
        event.prevent_default()
        # a press on the hint accepts
        if self.word != self._given and event.x >= self.render().cell_len - len(_ACCEPT_HINT):
            self.action_take()
        else:
            self.action_turn(1)

    def on_blur(self) -> None:
        self.show(self._given)

    @property
    def hint(self) -> str:
        """Text that names the keys of this widget.

        While a new form is shown, the text names only the key that accepts this form.
        """
        return _ACCEPT_HINT if self.word != self._given else super().hint


class ProfileGrid(Grid):
    """Table of water properties by depth, in the units of the column headings."""

    LEAST_ROWS = 1
    EDITS_ON = False

    def __init__(
        self,
        tell: Callable[..., object],
        changed: Callable[[Any, str], object],
        preview: Callable[[ProfileGrid, CopiedTable, list[str]], object],
        *,
        id: str,
    ) -> None:
        super().__init__(tell, changed, id=id)
        self._preview = preview
        self._seabed: float | None = None

    def show_profile(
        self, columns: Sequence[str], rows: Sequence[Sequence[str]], seabed: float | None
    ) -> None:
        """Replace the rows; no rows are proposed below the `seabed` [m]."""
        self._seabed = seabed
        self.show(
            [FormColumn("", heading, water_tables.check_of(heading)) for heading in columns], rows
        )

    def new_row(self, at: int) -> tuple[str, ...]:
        """Return the mean of the rows above and below, if all their values are numbers.

        Below the last row, the values of the last row are proposed one step deeper, but not below
        the seabed.
        """
        columns, rows = self.cells.headings, self.cells.rows
        if not rows:
            return ("0",) * len(columns)
        above, below = rows[max(at - 1, 0)], rows[min(at, len(rows) - 1)]
        try:
            pairs = [(float(one), float(other)) for one, other in zip(above, below, strict=True)]
        except ValueError:
            return above
        if at == len(rows):
            deeper = pairs[0][0] + _STEP
            return (f"{min(deeper, self._seabed or math.inf):g}", *above[1:])
        halves = (
            water_tables.half_way(column, *pair)
            for column, pair in zip(columns, pairs, strict=True)
        )
        return tuple(f"{half:g}" for half in halves)

    def ends_at(self, at: int) -> bool:
        """Return whether a row at index `at` would be below the seabed."""
        rows = self.cells.rows
        if self._seabed is None or not rows or at < len(rows):
            return False
        try:
            return float(rows[-1][0]) >= self._seabed
        except ValueError:
            return False

    def take_text(self, text: str) -> None:
        """Read rows from a pasted text, with or without headings, and show a preview."""
        columns = self.cells.headings
        try:
            copied = copied_table(text)
            headings = water_tables.offered_headings(copied.headings, columns)
            water_tables.rows_in(columns, headings, copied.rows)
        except water_tables.UnknownColumns:
            pass  # the user can then name the columns
        except (NoTableError, water_tables.NoRows) as error:
            self.tell(f"Not pasted: {error}", wrong=True)
            return
        self._preview(self, copied, headings)


_STEP = 10.0
"""Depth step from the last row to a new row [m]."""
_FIRST = ("depth", "density", "current", "wind")


def fields_of_water(towed: bool, grid: Callable[..., ProfileGrid]) -> Iterator[Widget]:
    """Yield the widgets for the keys of an environment; their ids are the paths of the keys."""
    fields = form_of(TowEnvironmentKeys if towed else EnvironmentKeys, needed=False)
    fields = [each for each in fields if each.key != "fluid" or towed]
    groups = {each.key.partition(".")[0]: [] for each in fields}  # type: dict[str, list[FormField]]
    for each in fields:
        groups[each.key.partition(".")[0]].append(each)
    for key in (*_FIRST, *(key for key in groups if key not in _FIRST)):
        if key == "density":
            yield from _density(groups[key][0], grid)
        elif key == "current":
            yield FormChoice("current", CURRENT_FORMS, id="current")
            for model in (UniformCurrent, CurrentFile):
                yield from _fields(form_of(model, "current."))
            yield grid(id="current-table")
        else:
            yield from _fields(groups[key])


def _density(form_field: FormField, grid: Callable[..., ProfileGrid]) -> Iterator[Widget]:
    of_sea_water = {each.key: each for each in form_of(SeaWaterKeys, "density.")}
    for place, (kind, _, _) in _CONSTANTS.items():
        id, is_inner = "-".join(place), len(place) > 1
        forms = PROFILE_FORMS if is_inner else DENSITY_FORMS
        one = of_sea_water[".".join(place)] if is_inner else form_field
        yield FormChoice(f"  {place[1]}" if is_inner else "density", forms, id=id)
        yield Field(replace(one, title="", check=quantity(kind, optional=not is_inner)), id=id)
        yield grid(id=f"{id}-table")


def _fields(fields: Iterable[FormField]) -> Iterator[Widget]:
    for each in fields:
        if each.above:
            yield Static(each.above, classes="above", markup=False)
        indent = "  " * each.key.count(".")
        shown = replace(each, title=indent + each.title, above="")
        yield Field(shown, id=each.key.replace(".", "-"))
