"""The list of the components found: one line each, with a cursor."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest

from rich.cells import cell_len, set_cell_size
from rich.segment import Segment
from textual import events
from textual.message import Message
from textual.strip import Strip

from calm.tui.catalogue.index import COLUMNS, CatalogueColumn, Index, Listed
from calm.tui.scrolled import RowList
from calm.tui.theme import CURSOR, FAVOURITE, ROLES

_LEAD, _FIGURE = 4, 8


class ComponentList(RowList, can_focus=False):
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

    class Moved(RowList.Moved):
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
        self.set_reactive(RowList.cursor, 0)
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

    def _columns(self) -> tuple[int, list[CatalogueColumn], int]:
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
