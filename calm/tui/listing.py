"""Rows below each other with a cursor on one of them, which is kept in sight.

The widgets of textual that are nearest, measured with 60 rows and with the 516 components of the
catalogue, paint a change in 57 ms (`DataTable`, the line here: 1.3 ms) and in 19 ms (`OptionList`,
the catalogue here: 2.5 ms). The first is longer than a key may take to be seen.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, ClassVar

from textual.geometry import Size
from textual.message import Message
from textual.reactive import reactive

from calm.tui.scrolled import Scrolled


class Listing(Scrolled, inherit_bindings=False):
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
        self.set_reactive(Listing.cursor, self.validate_cursor(self.cursor))
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
