"""Form of the water: where an environment is written in a file, how it is read and written."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from textual import events, on
from textual.message import Message
from textual.widget import Widget

from calm.files.definition import DENSITY, POSITIVE_LENGTH, QuantityField
from calm.files.editing import Draft, Value
from calm.files.water import USUAL_DENSITY
from calm.files.yaml_document import Location
from calm.records import headings, profile_tables
from calm.tui import key_table, water_grid, water_tables
from calm.tui.checking import Check, anything, needed, quantity
from calm.tui.field import Asked, Cycle, Field
from calm.units import QuantityError, QuantityRange

CURRENT_FORMS = ("still", "uniform", "table", "file")
DENSITY_FORMS = ("constant", "table", "temperature and salinity")
PROFILE_FORMS = ("constant", "table")
"""Of the temperature and of the salinity."""

_CURRENT = ("0.5", "90")
_CONSTANTS = {
    ("density",): (DENSITY, "kg/m^3", f"{USUAL_DENSITY['water']:g}"),
    ("density", "temperature"): (profile_tables.TEMPERATURE, "degC", "10"),
    ("density", "salinity"): (profile_tables.SALINITY, "", "35"),
}
"""What can be a constant or a table: kind, unit, and the figure to begin with."""

Place = tuple[str, ...]
"""Keys that lead to something within an environment: ``("density", "salinity")``."""


class WaterForm:
    """The water of one environment of a file.

    Parameters
    ----------
    draft : the file
    variant : a named environment, laid over that of the file; None for the file's own

    Raises
    ------
    EditError
        By all that gives another file, where the text does not allow it.
    """

    def __init__(self, draft: Draft, variant: str | None) -> None:
        self.draft, self.variant = draft, variant
        self.place: Location = ("environments", variant) if variant else ("environment",)

    def at(self, *keys: str) -> Location:
        """The location of a key."""
        return (*self.place, *keys)

    def own(self, *keys: str) -> Any:
        """Return what this environment says; None where nothing."""
        return self.draft.value(self.at(*keys))

    def value(self, *keys: str) -> Any:
        """Return what holds: its own word, or that of the file's own environment below it."""
        if self.own(keys[0]) is not None:
            return self.own(*keys)
        return self.draft.value(("environment", *keys))

    def text(self, *keys: str) -> str:
        """Return the same, where it is a plain value; empty elsewhere."""
        value = self.value(*keys)
        return value if isinstance(value, str) else ""

    def is_own(self, key: str) -> bool:
        """Return whether a key is this environment's own; those of the file always are."""
        return self.variant is None or self.own(key) is not None

    @property
    def depth(self) -> float | None:
        """The depth [m], above 0; None where none is given or it cannot be read."""
        return _read(POSITIVE_LENGTH, self.text("depth"))

    def form(self, *keys: str) -> str:
        """Return how the current, the density, or the temperature or salinity of that is given."""
        value = self.value(*keys)
        if isinstance(value, dict) and {"columns", "rows"} & set(value):
            return "table"
        if keys == ("density",):
            return DENSITY_FORMS[2] if isinstance(value, dict) else "constant"
        if keys != ("current",):
            return "constant"
        if not isinstance(value, dict) or not value:
            return "still"
        return "file" if {"file", "time"} & set(value) else "uniform"

    def table(self, *keys: str) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        """Columns and rows of a table, texts as written, each row of as many as there are columns.

        What a row lacks is empty. There are neither columns nor rows where there is no table, or
        one that only the text can show: rows longer than the columns, or of anything but texts.
        """
        table = self.value(*keys)
        columns = table.get("columns") if isinstance(table, dict) else None
        rows = table.get("rows") if isinstance(table, dict) else None
        if not isinstance(columns, list) or not _is_row(columns, len(columns)):
            return (), []
        if not all(_is_row(row, len(columns)) for row in rows or ()):
            return (), []
        return tuple(map(str, columns)), [_filled(row, len(columns)) for row in rows or ()]

    # changes: each gives the file with it

    def put(self, keys: Sequence[str], text: str) -> Draft:
        """A value; an empty one takes the key out. No speed is no wind."""
        if keys == ("wind", "speed") and not text:
            return self.draft.put_at(self.at("wind"), None)
        return self.put_form(keys, text or None)

    def put_rows(
        self, keys: Sequence[str], columns: Iterable[str], rows: Iterable[Sequence[str]]
    ) -> Draft:
        """A table; rows that are as `table` shows them stay as they are written."""
        names = [*columns]
        given = self.value(*keys)
        old = given.get("rows") if isinstance(given, dict) and self.table(*keys)[0] else None
        known = {_filled(row, len(names)): row for row in old or ()}
        new = [known.get(tuple(row), [text or None for text in row]) for row in rows]
        return self._with_own(keys).put_table(self.at(*keys), names, new)

    def put_form(self, keys: Sequence[str], value: Value | None) -> Draft:
        """The whole of the current or the density; None takes it out."""
        return self._with_own(keys).put_at(self.at(*keys), value)

    def begun(self, keys: Place, form: str) -> Value | None:
        """Return what another form begins with: what is known, else something usual.

        None where nothing has to be said.
        """
        if keys == ("current",):
            return self._begun_current(form)
        kind, unit, usual = _CONSTANTS[keys]
        known = _read(kind, self.text(*keys))
        figure = usual if known is None else f"{known:g}"
        if form == "table":
            columns = ["depth m", f"{keys[-1]} {unit}".rstrip()]
            return {"columns": columns, "rows": [["0", figure], [self._down_to, figure]]}
        if form == "constant":
            return f"{figure} {unit}".rstrip()
        return {name[-1]: self.begun(name, "constant") for name in _CONSTANTS if len(name) > 1}

    def _begun_current(self, form: str) -> Value | None:
        """Begin with a uniform current as it is, or with what a table has in its first row."""
        place = {name: self.text("current", name) for name in ("speed", "toward")}
        columns, rows = self.table("current")
        for column, text in zip(columns, rows[0] if rows else (), strict=False):
            name, unit = headings.heading(column)
            place[name] = f"{text} {unit}".strip()
        found = [_read(QuantityField("speed"), place.get(name, "")) for name in ("speed", "u", "v")]
        flow = found[0], _read(QuantityField("angle"), place["toward"])
        if found[1] is not None and found[2] is not None:
            flow = profile_tables.speed_and_direction(found[1], found[2])
        known = [f"{each:g}" for each in flow if each is not None]
        speed, toward = known if len(known) == 2 else _CURRENT
        if form == "table":
            rows_begun = [["0", speed, toward], [self._down_to, speed, toward]]
            return {"columns": [*water_tables.CURRENT_COLUMNS], "rows": rows_begun}
        if form == "uniform":
            return {"speed": f"{speed} m/s", "toward": f"{toward} deg"}
        # one that flows in the file's own environment would be there in this one, too
        return {"speed": "0 m/s", "toward": "0 deg"} if self.variant else None

    @property
    def _down_to(self) -> str:
        return f"{self.depth or water_tables.USUAL_DEPTH:g}"

    def _with_own(self, keys: Sequence[str]) -> Draft:
        """The file with what its own environment says under the first key said here, too.

        A key of a named environment stands in place of the whole of it.
        """
        inherited = self.value(keys[0])
        if len(keys) == 1 or self.is_own(keys[0]) or not isinstance(inherited, dict):
            return self.draft
        return self.draft.put_at(self.at(keys[0]), inherited)


def _read(kind: QuantityRange, text: str) -> float | None:
    """A quantity in SI units; None where it cannot be read."""
    try:
        return kind.read(text) if text else None
    except QuantityError:
        return None


def _is_row(row: object, most: int) -> bool:
    return (
        isinstance(row, list)
        and len(row) <= most
        and all(isinstance(each, str | None) for each in row)
    )


def _filled(row: Sequence[str | None], count: int) -> tuple[str, ...]:
    return tuple([*(text or "" for text in row), *[""] * count][:count])


_TAKE_IT = "Enter takes it"


class FormChoice(Cycle):
    """A name and a form; the arrows show other ones, Enter takes what is shown.

    When it is left without, it shows the form there is again.
    """

    BINDINGS = key_table.bindings("given")

    @dataclass
    class Taken(Message):
        """Another form is wanted."""

        choice: FormChoice
        form: str

    def __init__(self, title: str, forms: tuple[str, ...], *, id: str) -> None:
        super().__init__(title, forms, forms[0], id=f"{id}-form")
        self._given = forms[0]

    def show(self, word: str) -> None:
        """Show the form there is."""
        self._given = word
        super().show(word)

    def action_turn(self, by: int) -> None:
        """Show the next form."""
        super().show(self.next_word(by))

    def action_take(self) -> None:
        """Choose the form shown, and go on."""
        if self.word != self._given:
            self.post_message(self.Taken(self, self.word))
        else:
            self.screen.focus_next()

    @on(events.Click)
    def _press(self, event: events.Click) -> None:
        """The mouse goes on, or takes the form by a press on the words that say so."""
        event.prevent_default()
        if self.word != self._given and event.x >= self.render().cell_len - len(_TAKE_IT):
            self.action_take()
        else:
            self.action_turn(1)

    def on_blur(self) -> None:
        """Do what was not taken is not there."""
        self.show(self._given)

    @property
    def hint(self) -> str:
        """Return how the form that is shown is taken, where it is another one."""
        return _TAKE_IT if self.word != self._given else super().hint


def fields_of_water(grid: Callable[..., water_grid.Grid]) -> Iterator[Widget]:
    """The parts of the form, tables made by `grid`; ids tell their places in an environment."""

    def field(place: str, title: str, check: Check = anything, placeholder: str = "") -> Field:
        key = place.rpartition("-")[2]
        return Field(Asked(key, title, check=check, placeholder=placeholder), id=place)

    speed = QuantityField("speed", at_least=0)
    depth = quantity(POSITIVE_LENGTH, optional=True)
    density = quantity(profile_tables.WATER_DENSITY, optional=True)
    toward = quantity(profile_tables.DIRECTION, optional=True)
    yield field("depth", "Depth", depth, "e.g. 1100 m")
    yield FormChoice("Density", DENSITY_FORMS, id="density")
    yield field("density", "", density, "else 1025 kg/m^3")
    yield grid(id="density-table")
    for place, (kind, _, _) in _CONSTANTS.items():
        if len(place) > 1:
            id = "-".join(place)
            yield FormChoice(f"  {place[1]}", PROFILE_FORMS, id=id)
            yield field(id, "", quantity(kind))
            yield grid(id=f"{id}-table")
    yield FormChoice("Current", CURRENT_FORMS, id="current")
    yield field("current-speed", "  speed", quantity(speed))
    yield field("current-toward", "  towards", quantity(profile_tables.DIRECTION))
    yield field("current-file", "  file", needed("a file"))
    yield field("current-time", "  time", placeholder="e.g. 2026-03-01T06")
    yield grid(id="current-table")
    yield field("wind-speed", "Wind", quantity(speed, optional=True), "none")
    yield field("wind-toward", "  towards", toward, "where it blows")
