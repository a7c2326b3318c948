"""The list of the components found: one line each, with a cursor."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import zip_longest

from rich.cells import cell_len, set_cell_size
from rich.segment import Segment
from textual import events
from textual.message import Message
from textual.strip import Strip

from calm.errors import CalmError
from calm.files import Catalogue
from calm.tui.catalogue.index import Index, Listed
from calm.tui.scrolled import Listing
from calm.tui.theme import CURSOR, FAVOURITE, ROLES
from calm.units import QuantityError, parse_quantity

_LEAD, _FIGURE = 4, 8


class ComponentList(Listing, can_focus=False):
    """Components with a cursor, which the search moves."""

    DEFAULT_CSS = """
    ComponentList {
        height: 1fr; overflow-x: hidden; overflow-y: auto; scrollbar-size-vertical: 1;
        background: $background;
        & > .component-list--cursor { text-style: bold; background: $surface; }
        & > .component-list--id { color: $foreground; }
        & > .component-list--name { text-style: dim; }
        & > .component-list--own { color: $text-accent; }
    }
    """
    HEADING = 1
    COMPONENT_CLASSES = {  # noqa: RUF012 - textual reads the class attribute
        "component-list--cursor",
        "component-list--id",
        "component-list--name",
        "component-list--own",
    }

    class Moved(Listing.Moved):
        """The cursor is on another component."""

    class Pressed(Message):
        """The component under the cursor was pressed with the mouse."""

    def __init__(self) -> None:
        super().__init__()
        self.rows: Sequence[Listed] = ()
        self._longest = 0
        self._index: Index | None = None
        self._by: str | None = None
        self._favourites: frozenset[str] = frozenset()

    @property
    def chosen(self) -> Listed | None:
        """The component under the cursor."""
        return self.rows[self.cursor] if self.rows else None

    def show(
        self,
        found: Sequence[Listed],
        index: Index,
        by: str | None = None,
        favourites: frozenset[str] = frozenset(),
    ) -> None:
        """List other components, the cursor on the first; `by` which figure they are sorted."""
        before, columns = self.rows, self._columns()
        cursor, like = self.cursor, (self._index, self._favourites)
        self._index, self._by, self._favourites = index, by, favourites
        self._longest = max((len(each.id) for each in found), default=0)
        self.set_reactive(Listing.cursor, 0)
        if like != (index, favourites) or columns != self._columns() or self.scroll_offset.y:
            self.take_rows(found)
            self.scroll_to(y=0, animate=False)
        else:
            pairs = zip_longest(before[: self.size.height], found[: self.size.height])
            changed = [number for number, (old, new) in enumerate(pairs) if old is not new]
            self.take_rows(found, {0, cursor, *changed})
        self.post_message(self.Moved())

    def on_click(self, event: events.Click) -> None:
        """Choose with the mouse; a press on the one chosen takes it."""
        place = event.get_content_offset(self)
        number = None if place is None else self.row_at(place.y)
        if number is None:
            return
        if number == self.cursor:
            self.post_message(self.Pressed())
        else:
            self.cursor = number

    def _columns(self) -> tuple[int, list[Column], int]:
        """Cells of the ids, the figures that have room beside them, cells left for the names."""
        width = self.scrollable_content_region.width
        id_width = max(min(self._longest, width - _LEAD), 0)
        room, shown = width - _LEAD - id_width - 1, []
        for column in sorted(COLUMNS, key=lambda each: each.key != self._by):
            if room >= _FIGURE + 1:
                shown.append(column)
                room -= _FIGURE + 1
        return id_width, [each for each in COLUMNS if each in shown], max(room, 0)

    def render_line(self, y: int) -> Strip:
        """A row of the screen."""
        width = self.scrollable_content_region.width
        number, style = self.row_at(y), self.rich_style
        id_width, columns, name_width = self._columns()
        name_style = style + self.get_component_rich_style("component-list--name", partial=True)
        if y == 0:
            heads = [f"{each.heading:>{_FIGURE}} " for each in columns]
            text = f"{'':{_LEAD}}{'component':{id_width}.{id_width}} {''.join(heads)}"
            return Strip([Segment(text, name_style)]).adjust_cell_length(width, style)
        if number is None or self._index is None:
            return Strip.blank(width, style)
        each: Listed = self.rows[number]
        here = number == self.cursor
        if here:
            style += self.get_component_rich_style("component-list--cursor", partial=True)
            name_style += self.get_component_rich_style("component-list--cursor", partial=True)
        star = FAVOURITE if each.id in self._favourites else " "
        look = "own" if each.own else "id"
        id_style = style + self.get_component_rich_style(f"component-list--{look}", partial=True)
        figures = self._index.figures(each.id)
        cells = [f"{column.shown(figures.get(column.key)):>{_FIGURE}} " for column in columns]
        segments = [
            Segment(f"{CURSOR if here else ' '}{star}{ROLES.get(each.role, ' ')} ", style),
            Segment(set_cell_size(each.id, id_width), id_style),
            Segment(f" {''.join(cells)}", style),
        ]
        if cell_len(each.name) <= name_width:  # whole, or in the card alone
            segments.append(Segment(each.name, name_style))
        return Strip(segments).adjust_cell_length(width, style)


@dataclass(frozen=True)
class Column:
    """A figure of components: its key, heading, dimension, and the unit it is shown in."""

    key: str
    heading: str
    dimension: str
    unit: str
    scale: float = 1.0
    decimals: int = 0

    def shown(self, value: float | None) -> str:
        """A figure for people; empty where it is not known."""
        return "" if value is None else f"{value * self.scale:.{self.decimals}f}"


COLUMNS = (
    Column("net", "net N", "force", "N"),
    Column("breaking", "break kN", "force", "kN", 1e-3, 1),
    Column("working", "work kN", "force", "kN", 1e-3, 1),
    Column("depth", "to m", "length", "m"),
    Column("drag", "drag N", "force", "N", 1.0, 1),
    Column("mass", "mass kg", "mass", "kg", 1.0, 1),
)
"""Net force in water, + up; loads; depth rating; drag across the axis at 1 m/s; mass in air. Of a
cable or chain per metre, but for its loads."""

_ALSO = {
    "mbl": "breaking",
    "wll": "working",
    "swl": "working",
    "buoyancy": "net",
    "rating": "depth",
}
_ASKED = re.compile(r"([a-z]+)(<=|>=|<|>)([-+]?[\d.].*)")
_HOLDS: dict[str, Callable[[float, float], bool]] = {
    "<": lambda value, limit: value < limit,
    "<=": lambda value, limit: value <= limit,
    ">": lambda value, limit: value > limit,
    ">=": lambda value, limit: value >= limit,
}
Figures = dict[str, float | None]


def figures_of(catalogue: Catalogue, id: str) -> Figures:
    """The figures of a component or assembly by the keys of `COLUMNS`; SI units."""
    from calm.assemble.datasheet import datasheet

    try:
        definition = catalogue.get(id)
        sheet = datasheet(definition, catalogue)
    except CalmError:
        return {}
    return {
        "net": None if sheet is None else sheet.net_buoyancy,
        "breaking": getattr(definition, "breaking_load", None),
        "working": getattr(definition, "working_load", None),
        "depth": getattr(definition, "depth_rating", None),
        "drag": None if sheet is None else sheet.kn,
        "mass": getattr(definition, "mass", None),
    }


@dataclass(frozen=True)
class Wanted:
    """A limit that a figure is to keep: ``breaking>50kN``."""

    key: str
    relation: str
    limit: float

    def holds(self, figures: Figures) -> bool:
        """Whether it is kept; not where the figure is unknown."""
        value = figures.get(self.key)
        return value is not None and _HOLDS[self.relation](value, self.limit)


def wanted(word: str) -> Wanted | None:
    """The limit that a word of a search is; None of a plain word.

    A number alone has the unit of its column.
    """
    found = _ASKED.fullmatch(word)
    if found is None:
        return None
    key = _ALSO.get(found[1], found[1])
    column = next((each for each in COLUMNS if each.key == key), None)
    if column is None:
        return None
    for text in (found[3], f"{found[3]} {column.unit}"):
        try:
            return Wanted(key, found[2], parse_quantity(text, column.dimension))
        except QuantityError:
            continue
    return None
