"""What is longer than its place: lines that are scrolled, without the screen being laid out anew.

Textual lays the whole screen out where the length of anything in it changes, 10 to 20 ms at each
key of a search. Nothing here has a size that depends on what it shows.
"""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import RenderableType
from rich.segment import Segment
from textual.geometry import Size
from textual.reactive import Reactive
from textual.scroll_view import ScrollView
from textual.strip import Strip

Row = list[Segment]


class Scrolled(ScrollView, inherit_bindings=False):
    """Lines of its own, drawn by `render_line`; `virtual_size` tells how many and how long."""

    virtual_size = Reactive(Size(0, 0), repaint=False)

    def watch_virtual_size(self, size: Size) -> None:
        """The scroll bar follows, and what is shown where it is beyond the end now."""
        self._scroll_update(size)
        if self.scroll_offset.y > self.max_scroll_y:
            self.scroll_to(y=self.max_scroll_y, animate=False)


class DrawnRows(Scrolled, can_focus=False):
    """Rows that are drawn for the cells there are, anew where these are others."""

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._drawn: tuple[Size | None, list[Row]] = (None, [])  # the size that the rows are for

    def rows_for(self, size: Size) -> list[Row]:
        """Draw the rows for a size."""
        raise NotImplementedError

    def draw_again(self) -> None:
        """Draw what is shown now."""
        self._drawn = (None, self._drawn[1])
        self.refresh()

    def drawn(self) -> list[Row]:
        """Return the rows for the size of now."""
        size = self.scrollable_content_region.size
        if size.width > 0 and size != self._drawn[0]:
            self._drawn = (size, self.rows_for(size))
        return self._drawn[1]

    def render_line(self, y: int) -> Strip:
        """A row of the screen."""
        rows, number, left = self.drawn(), y + self.scroll_offset.y, self.scroll_offset.x
        width, style = self.scrollable_content_region.width, self.rich_style
        strip = Strip(rows[number] if number < len(rows) else []).apply_style(style)
        return strip.adjust_cell_length(left + width, style).crop(left, left + width)


class ScrolledText(DrawnRows):
    """Texts for people below each other, wrapped to the width; others begin at the top."""

    DEFAULT_CSS = "ScrolledText { overflow-x: hidden; scrollbar-size-vertical: 1; }"

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._texts: Sequence[RenderableType] = ()
        self._numbers: list[int] = []  # of the text that each row is of

    def show(self, *texts: RenderableType) -> None:
        """Show other texts."""
        self._texts = texts
        self.scroll_to(y=0, animate=False)
        self.draw_again()
        self.drawn()

    def on_resize(self) -> None:
        """Wrap it to the new width."""
        self.drawn()

    def rows_for(self, size: Size) -> list[Row]:
        """Wrap the texts."""
        wrapped = self._wrapped(size.width)
        self._numbers = [number for number, _ in wrapped]
        self.virtual_size = Size(size.width, len(wrapped))
        return [row for _, row in wrapped]

    def _wrapped(self, width: int) -> list[tuple[int, Row]]:
        """Return the rows in a width, each with the number of its text."""
        console = self.app.console
        options = console.options.update(width=width, height=None)
        return [
            (number, row)
            for number, text in enumerate(self._texts)
            for row in console.render_lines(text, options, pad=False)
        ]
