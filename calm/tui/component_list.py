"""The list of the components found: one line each, with a cursor."""

from __future__ import annotations

from collections.abc import Sequence

from rich.cells import set_cell_size
from rich.segment import Segment
from textual import events
from textual.geometry import Size
from textual.message import Message
from textual.reactive import reactive
from textual.scroll_view import ScrollView
from textual.strip import Strip

from calm.tui.catalogue_index import Listed
from calm.tui.signs import CURSOR, ROLES


class ComponentList(ScrollView, can_focus=False):
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

    cursor: reactive[int] = reactive(0, init=False)

    class Moved(Message):
        """Another component is under the cursor."""

    class Pressed(Message):
        """The component under the cursor was pressed with the mouse."""

    def __init__(self) -> None:
        super().__init__()
        self.found: Sequence[Listed] = ()
        self._longest = 0

    @property
    def chosen(self) -> Listed | None:
        """The component under the cursor."""
        return self.found[self.cursor] if self.found else None

    def show(self, found: Sequence[Listed]) -> None:
        """List other components, the cursor on the first."""
        self.found = found
        self._longest = max((len(each.id) for each in found), default=0)
        self.virtual_size = Size(0, len(found))
        self.set_reactive(ComponentList.cursor, 0)
        self.scroll_to(y=0, animate=False)
        self.refresh()
        self.post_message(self.Moved())

    def validate_cursor(self, cursor: int) -> int:
        """Keep it in the list."""
        return max(0, min(cursor, len(self.found) - 1))

    def watch_cursor(self) -> None:
        """Keep it in sight."""
        page, top = max(self.scrollable_content_region.height, 1), self.scroll_offset.y
        wanted = min(max(top, self.cursor - page + 1), self.cursor)
        if wanted != top:
            self.scroll_to(y=wanted, animate=False)
        self.refresh()
        self.post_message(self.Moved())

    def on_click(self, event: events.Click) -> None:
        """Choose with the mouse; a press on the one chosen takes it."""
        place = event.get_content_offset(self)
        if place is None:
            return
        number = place.y + self.scroll_offset.y
        if number == self.cursor:
            self.post_message(self.Pressed())
        elif number < len(self.found):
            self.cursor = number

    def render_line(self, y: int) -> Strip:
        """A row of the screen."""
        width = self.scrollable_content_region.width
        number = y + self.scroll_offset.y
        if number >= len(self.found):
            return Strip.blank(width, self.rich_style)
        each = self.found[number]
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
