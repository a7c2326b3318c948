"""What is longer than its place: lines that are scrolled, without the screen being laid out anew.

Textual lays the whole screen out where the length of anything in it changes, 10 to 20 ms at each
key of a search. Nothing here has a size that depends on what it shows.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, ClassVar

from rich.console import RenderableType
from rich.segment import Segment
from textual.events import Paste
from textual.geometry import Size
from textual.message import Message
from textual.reactive import Reactive, reactive
from textual.scroll_view import ScrollView
from textual.strip import Strip
from textual.widgets import Input


class Scrolled(ScrollView, inherit_bindings=False):
    """Lines of its own, drawn by `render_line`; `virtual_size` tells how many and how long."""

    virtual_size = Reactive(Size(0, 0), repaint=False)

    def watch_virtual_size(self, size: Size) -> None:
        """The scroll bar follows, and what is shown where it is beyond the end now."""
        self._scroll_update(size)
        if self.scroll_offset.y > self.max_scroll_y:
            self.scroll_to(y=self.max_scroll_y, animate=False)


class ScrolledText(Scrolled, can_focus=False):
    """A text for people, wrapped to the width; another one begins at its top."""

    DEFAULT_CSS = "ScrolledText { overflow-x: hidden; scrollbar-size-vertical: 1; }"

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._text: RenderableType = ""
        self._drawn: tuple[int, list[list[Segment]]] = (-1, [])  # the width and its lines

    def show(self, text: RenderableType) -> None:
        """Show another text."""
        self._text, self._drawn = text, (-1, [])
        self.scroll_to(y=0, animate=False)
        self._lines()
        self.refresh()

    def on_resize(self) -> None:
        """Wrap it to the new width."""
        self._lines()

    def _lines(self) -> list[list[Segment]]:
        width = self.scrollable_content_region.width
        if width > 0 and self._drawn[0] != width:
            console = self.app.console
            options = console.options.update(width=width, height=None)
            self._drawn = (width, console.render_lines(self._text, options, pad=False))
            self.virtual_size = Size(width, len(self._drawn[1]))
        return self._drawn[1]

    def render_line(self, y: int) -> Strip:
        """A row of the screen."""
        lines, number = self._lines(), y + self.scroll_offset.y
        strip = Strip(lines[number] if number < len(lines) else []).apply_style(self.rich_style)
        return strip.adjust_cell_length(self.scrollable_content_region.width, self.rich_style)


class ScrolledEntry(Input):
    """A line of input; a text of several lines that is pasted is left to what is around it."""

    virtual_size = Reactive(Size(0, 0), repaint=False)

    def on_paste(self, event: Paste) -> None:
        """Rows of a table are no value: textual would take the first of them."""
        if len(event.text.splitlines()) > 1:
            event.prevent_default()


class RowList(Scrolled, inherit_bindings=False):
    """Rows, drawn by `render_line` of the one that is made of it."""

    HEADING: ClassVar[int] = 0
    """Lines above the rows, which stay as the rows are scrolled."""
    BEYOND: ClassVar[int] = 0
    """Rows kept in sight beyond the cursor."""

    cursor: reactive[int] = reactive(0, init=False, repaint=False)
    rows: Sequence[Any] = ()

    class Moved(Message):
        """The cursor is elsewhere."""

    def take_rows(self, rows: Sequence[Any], changed: Iterable[int] | None = None) -> None:
        """Other rows, the cursor where it was if there is such a row.

        Only those that have `changed` are drawn, by their numbers; without them all are.
        """
        self.rows = rows
        self.virtual_size = Size(0, len(rows) + self.HEADING)
        self.set_reactive(RowList.cursor, self.validate_cursor(self.cursor))
        if changed is None:
            self.refresh()
        else:
            self.refresh_rows(*changed)

    def validate_cursor(self, cursor: int) -> int:
        """Keep it on the rows."""
        return max(0, min(cursor, len(self.rows) - 1))

    def watch_cursor(self, before: int, now: int) -> None:
        """Keep the cursor in sight."""
        if not self.follow():
            self.refresh_rows(before, now)
        self.post_message(self.Moved())

    def refresh_rows(self, *numbers: int) -> None:
        """Draw some rows only."""
        for number in numbers:
            self.refresh_line(number + self.HEADING)

    def follow(self) -> bool:
        """Scroll to the cursor; whether that was needed."""
        page = max(self.scrollable_content_region.height - self.HEADING, 1)
        beyond = min(self.BEYOND, (page - 1) // 2)
        top = self.scroll_offset.y
        wanted = min(max(top, self.cursor + beyond - page + 1), max(self.cursor - beyond, 0))
        if wanted != top:
            self.scroll_to(y=wanted, animate=False)
        return wanted != top

    def row_at(self, y: int) -> int | None:
        """The number of the row on a line of the widget; None on the heading and below the last."""
        row = y - self.HEADING + self.scroll_offset.y
        return row if y >= self.HEADING and row < len(self.rows) else None

    def on_focus(self) -> None:
        """The cursor is drawn where the focus is."""
        self.refresh()

    def on_blur(self) -> None:
        """And only there."""
        self.refresh()
