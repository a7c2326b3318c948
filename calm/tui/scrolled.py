"""What is longer than its place: lines that are scrolled, without the screen being laid out anew.

Textual lays the whole screen out where the length of anything in it changes, 10 to 20 ms at each
key of a search. Nothing here has a size that depends on what it shows.
"""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import RenderableType
from rich.segment import Segment
from textual.events import Paste
from textual.geometry import Size
from textual.reactive import Reactive
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
    """Texts for people below each other, wrapped to the width; others begin at the top."""

    DEFAULT_CSS = "ScrolledText { overflow-x: hidden; scrollbar-size-vertical: 1; }"

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._texts: Sequence[RenderableType] = ()
        self._drawn: tuple[int, list[tuple[list[Segment], int]]] = (-1, [])  # the width and lines

    def show(self, *texts: RenderableType) -> None:
        """Show other texts."""
        self._texts, self._drawn = texts, (-1, [])
        self.scroll_to(y=0, animate=False)
        self._lines()
        self.refresh()

    def on_resize(self) -> None:
        """Wrap it to the new width."""
        self._lines()

    def _lines(self) -> list[tuple[list[Segment], int]]:
        """Return the lines in the width of now, each with the number of its text."""
        width = self.scrollable_content_region.width
        if width > 0 and self._drawn[0] != width:
            self._drawn = (width, self._wrapped(width))
            self.virtual_size = Size(width, len(self._drawn[1]))
        return self._drawn[1]

    def _wrapped(self, width: int) -> list[tuple[list[Segment], int]]:
        console = self.app.console
        options = console.options.update(width=width, height=None)
        return [
            (line, number)
            for number, text in enumerate(self._texts)
            for line in console.render_lines(text, options, pad=False)
        ]

    def render_line(self, y: int) -> Strip:
        """A row of the screen."""
        lines, number = self._lines(), y + self.scroll_offset.y
        segments = lines[number][0] if number < len(lines) else []
        strip = Strip(segments).apply_style(self.rich_style)
        return strip.adjust_cell_length(self.scrollable_content_region.width, self.rich_style)


class ScrolledEntry(Input):
    """A line of input; a text of several lines that is pasted is left to what is around it."""

    virtual_size = Reactive(Size(0, 0), repaint=False)

    def on_mount(self) -> None:
        """Its cursor stands still: nothing is sent while nobody types."""
        self.cursor_blink = False

    def on_paste(self, event: Paste) -> None:
        """Rows of a table are no value: textual would take the first of them."""
        if len(event.text.splitlines()) > 1:
            event.prevent_default()
