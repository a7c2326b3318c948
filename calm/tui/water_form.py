"""Where the water of an environment is written in a file, and how its form reads and writes it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, Literal

from calm.files.editing import Draft
from calm.units import QuantityError, parse_quantity

Location = tuple[str | int, ...]
CurrentForm = Literal["still", "uniform", "table", "file"]
DensityForm = Literal["constant", "table"]

CURRENT_FORMS: tuple[CurrentForm, ...] = ("still", "uniform", "table", "file")
DENSITY_FORMS: tuple[DensityForm, ...] = ("constant", "table")
CURRENT_COLUMNS = ("depth m", "speed m/s", "toward deg")
DENSITY_COLUMNS = ("depth m", "density kg/m^3")
_USUAL_DEPTH = 100.0


class Water:
    """The water of one environment of a file.

    Parameters
    ----------
    draft : the file
    variant : a named environment, laid over that of the file; None for the file's own
    """

    def __init__(self, draft: Draft, variant: str | None) -> None:
        self.draft, self.variant = draft, variant
        self.place: Location = ("environments", variant) if variant else ("environment",)

    def at(self, *keys: str) -> Location:
        """The location of a key."""
        return (*self.place, *keys)

    def own(self, *keys: str) -> Any:
        """What this environment says; None where nothing."""
        return self.draft.value(self.at(*keys))

    def value(self, *keys: str) -> Any:
        """What holds: its own word, or that of the file's own environment below it."""
        if self.own(keys[0]) is not None:
            return self.own(*keys)
        return self.draft.value(("environment", *keys))

    def text(self, *keys: str) -> str:
        """The same, where it is a plain value; empty elsewhere."""
        value = self.value(*keys)
        return value if isinstance(value, str) else ""

    def is_own(self, key: str) -> bool:
        """Whether a key is this environment's own; those of the file always are."""
        return self.variant is None or self.own(key) is not None

    @property
    def depth(self) -> float:
        """The depth [m], a usual one where none can be read."""
        try:
            return parse_quantity(self.text("depth"), "length") or _USUAL_DEPTH
        except QuantityError:
            return _USUAL_DEPTH

    @property
    def current_form(self) -> CurrentForm:
        """How the current is given."""
        current = self.value("current")
        if not isinstance(current, dict) or not current:
            return "still"
        if "file" in current:
            return "file"
        return "table" if "columns" in current or "rows" in current else "uniform"

    @property
    def density_form(self) -> DensityForm:
        """How the density is given."""
        return "constant" if isinstance(self.value("density"), str | None) else "table"

    def table(self, key: str) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
        """Columns and rows of a table, texts as written; none where there is none."""
        table = self.value(key)
        if not isinstance(table, dict) or not isinstance(table.get("columns"), list):
            return (), []
        columns = tuple(map(str, table["columns"]))
        rows = table.get("rows")
        whole = [row for row in rows if isinstance(row, list)] if isinstance(rows, list) else []
        return columns, [tuple("" if each is None else str(each) for each in row) for row in whole]

    # changes: each gives the file with it

    def put(self, keys: Sequence[str], text: str | None) -> Draft:
        """A value; an empty one takes the key out."""
        return self.draft.put_at(self.at(*keys), text or None)

    def put_rows(self, key: str, columns: Iterable[str], rows: Iterable[Sequence[str]]) -> Draft:
        """A table."""
        return self.draft.put_table(self.at(key), [*columns], [[*row] for row in rows])

    def put_wind(self, key: str, text: str) -> Draft:
        """Speed or direction of the wind; no speed is no wind."""
        if key == "speed" and not text:
            return self.draft.put_at(self.at("wind"), None)
        draft = self.draft.put_at(self.at("wind", key), text or "0 deg")
        if draft.value(self.at("wind", "toward")) is None:
            draft = draft.put_at(self.at("wind", "toward"), "0 deg")
        return draft

    def put_current_form(self, form: CurrentForm) -> Draft:
        """Another form of current, begun with what is known."""
        place = self.at("current")
        if form == "still":
            still = {"speed": "0 m/s", "toward": "0 deg"}
            return self.draft.put_at(place, still if self.variant else None)
        if form == "uniform":
            return self.draft.put_at(place, {"speed": "0.5 m/s", "toward": "90 deg"})
        if form == "table":
            speed, toward = self._uniform()
            rows = [["0", speed, toward], [f"{self.depth:g}", speed, toward]]
            return self.put_rows("current", CURRENT_COLUMNS, rows)
        return self.draft

    def _uniform(self) -> tuple[str, str]:
        """The figures of a uniform current, of a plain one where there is none."""
        try:
            speed = parse_quantity(self.text("current", "speed"), "speed")
            toward = parse_quantity(self.text("current", "toward"), "angle")
        except QuantityError:
            return "0.5", "90"
        return f"{speed:g}", f"{toward:g}"

    def put_density_form(self, form: DensityForm) -> Draft:
        """Another form of density, begun with the usual one."""
        if form == "constant":
            return self.draft.put_at(self.at("density"), "1025 kg/m^3")
        rows = [["0", "1025"], [f"{self.depth:g}", "1028"]]
        return self.put_rows("density", DENSITY_COLUMNS, rows)

    def put_file(self, path: str, time: str) -> Draft:
        """A current of a file, as it is at a time."""
        named = {"file": path} | ({"time": time} if time else {})
        return self.draft.put_at(self.at("current"), named)
