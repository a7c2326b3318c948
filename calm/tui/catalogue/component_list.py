"""The list of the components found: one line each, with a cursor."""

from __future__ import annotations

from collections.abc import Sequence

from rich.cells import set_cell_size
from rich.segment import Segment
from textual import events
from textual.message import Message
from textual.strip import Strip

from calm.tui.catalogue.index import Listed
from calm.tui.listing import Listing
from calm.tui.signs import CURSOR, ROLES


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
    COMPONENT_CLASSES = {  # noqa: RUF012 - textual reads the class attribute
        "component-list--cursor",
        "component-list--id",
        "component-list--name",
        "component-list--own",
    }

    class Moved(Listing.Moved):
        """Another component is under the cursor."""

    class Pressed(Message):
        """The component under the cursor was pressed with the mouse."""

    def __init__(self) -> None:
        super().__init__()
        self.rows: Sequence[Listed] = ()
        self._longest = 0

    @property
    def chosen(self) -> Listed | None:
        """The component under the cursor."""
        return self.rows[self.cursor] if self.rows else None

    def show(self, found: Sequence[Listed]) -> None:
        """List other components, the cursor on the first."""
        self._longest = max((len(each.id) for each in found), default=0)
        self.set_reactive(Listing.cursor, 0)
        self.take_rows(found)
        self.scroll_to(y=0, animate=False)
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

    def render_line(self, y: int) -> Strip:
        """A row of the screen."""
        width = self.scrollable_content_region.width
        number = self.row_at(y)
        if number is None:
            return Strip.blank(width, self.rich_style)
        each: Listed = self.rows[number]
        here = number == self.cursor
        style = self.rich_style
        if here:
            style += self.get_component_rich_style("component-list--cursor", partial=True)
        look = "own" if each.own else "id"
        id_style = style + self.get_component_rich_style(f"component-list--{look}", partial=True)
        name_style = style + self.get_component_rich_style("component-list--name", partial=True)
        lead = f"{CURSOR if here else ' '} {ROLES.get(each.role, ' ')} "
        id_width = max(min(self._longest, width - len(lead)), 0)
        segments = [
            Segment(lead, style),
            Segment(set_cell_size(each.id, id_width), id_style),
            Segment(" ", style),
            Segment(each.name, name_style),
        ]
        return Strip(segments).adjust_cell_length(width, style)
