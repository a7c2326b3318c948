"""Scrollable widgets of fixed size: rows, texts, and tables with a cursor.

The size does not depend on the content, because a new size costs a new layout of the screen (10 to
20 ms).
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from rich.cells import cell_len, set_cell_size
from rich.console import RenderableType
from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.geometry import Region, Size
from textual.message import Message
from textual.reactive import Reactive, reactive
from textual.scroll_view import ScrollView
from textual.strip import Strip

from calm.tui.theme import ELLIPSIS

Row = list[Segment]


class Scrolled(ScrollView, inherit_bindings=False):
    """Widget with scrollable lines, which `render_line` draws.

    `virtual_size` holds the width and the number of the lines.
    """

    virtual_size = Reactive(Size(0, 0), repaint=False)

    def watch_virtual_size(self, size: Size) -> None:
        window = self.container_size
        down = self.styles.overflow_y != "hidden" and size.height > window.height > 0
        if down or self.show_vertical_scrollbar:
            bar = self.vertical_scrollbar
            self.show_vertical_scrollbar = bar.display = down
            bar.window_virtual_size, bar.window_size = size.height, window.height
        across = self.styles.overflow_x != "hidden" and size.width > window.width > 0
        if across or self.show_horizontal_scrollbar:
            bar = self.horizontal_scrollbar
            self.show_horizontal_scrollbar = bar.display = across
            bar.window_virtual_size, bar.window_size = size.width, window.width
        if self.scroll_offset.y > self.max_scroll_y:
            self.scroll_to(y=self.max_scroll_y, animate=False)

    def on_focus(self) -> None:
        self.refresh()  # draws the cursor

    def on_blur(self) -> None:
        self.refresh()  # removes the cursor


class DrawnRows(Scrolled, can_focus=False):
    """Widget that draws its rows to fit its size, and draws them again when the size changes."""

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._drawn: tuple[Size | None, list[Row]] = (None, [])  # rows and their size

    def rows_for(self, size: Size) -> list[Row]:
        """Draw the rows for a widget of this size."""
        raise NotImplementedError

    def draw_again(self) -> None:
        """Redraw the rows."""
        self._drawn = (None, self._drawn[1])
        self.refresh()

    def drawn(self) -> list[Row]:
        """Return the rows for the current size."""
        size = self.scrollable_content_region.size
        if size.width > 0 and size != self._drawn[0]:
            self._drawn = (size, self.rows_for(size))
        return self._drawn[1]

    def render_line(self, y: int) -> Strip:
        rows, number, left = self.drawn(), y + self.scroll_offset.y, self.scroll_offset.x
        width, style = self.scrollable_content_region.width, self.rich_style
        strip = Strip(rows[number] if number < len(rows) else []).apply_style(style)
        return strip.adjust_cell_length(left + width, style).crop(left, left + width)


class ScrolledText(DrawnRows):
    """Widget that shows texts below each other, wrapped to its width."""

    DEFAULT_CSS = "ScrolledText { overflow-x: hidden; scrollbar-size-vertical: 1; }"

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self._texts: Sequence[RenderableType] = ()
        self._numbers: list[int] = []  # number of the text of each row

    def show(self, *texts: RenderableType) -> None:
        """Replace the texts, and scroll to the top."""
        self._texts = texts
        self.scroll_to(y=0, animate=False)
        self.draw_again()
        self.drawn()

    def on_resize(self) -> None:
        self.drawn()

    def rows_for(self, size: Size) -> list[Row]:
        wrapped = self._wrapped(size.width)
        self._numbers = [number for number, _ in wrapped]
        self.virtual_size = Size(size.width, len(wrapped))
        return [row for _, row in wrapped]

    def _wrapped(self, width: int) -> list[tuple[int, Row]]:
        console = self.app.console
        options = console.options.update(width=width, height=None)
        return [
            (number, row)
            for number, text in enumerate(self._texts)
            for row in console.render_lines(text, options, pad=False)
        ]


@dataclass(frozen=True)
class TableColumn:
    """A table column, with its name, heading, position on the screen and width [cells].

    If a text is too long, its last `tail` characters are kept.
    """

    name: str
    heading: str
    start: int
    width: int
    right_aligned: bool = False
    tail: int = 0

    def fitted(self, text: str) -> str:
        """Fit a text to the width of the column, with an ellipsis if it is too long."""
        excess = cell_len(text) > self.width
        if excess and self.tail:
            begin = set_cell_size(text, self.width - 1 - self.tail)
            return begin + ELLIPSIS + text[-self.tail :]
        if excess:
            text = set_cell_size(text, self.width - 1).rstrip() + ELLIPSIS
        if self.right_aligned:
            return " " * (self.width - cell_len(text)) + text
        return set_cell_size(text, self.width)


class TableCells(Scrolled, inherit_bindings=False):
    """Table with a fixed heading, in which a cursor moves from cell to cell.

    Subclasses define the columns, the editable columns, the texts of the cells, and the text in
    front of each row.
    """

    COMPONENT_CLASSES: ClassVar[set[str]] = {"table--heading", "table--cursor"}
    DEFAULT_CSS = """
    TableCells {
        height: 1fr; width: 1fr; overflow-x: hidden; overflow-y: auto; scrollbar-size-vertical: 1;
        & > .table--heading { text-style: dim; }
        & > .table--cursor { text-style: reverse bold; }
    }
    """

    HEADING: ClassVar[int] = 1
    BEYOND: ClassVar[int] = 0
    """Number of rows that stay visible above and below the cursor."""
    GAP: ClassVar[int] = 1
    """Number of cells between two columns."""

    cursor: reactive[int] = reactive(0, init=False, repaint=False)
    column: reactive[int] = reactive(0, init=False, repaint=False)
    rows: Sequence[Any] = ()

    class Moved(Message):
        """Message that the cursor has moved to another cell."""

    class Pressed(Message):
        """Message that the cell under the cursor was pressed with the mouse."""

    # defined by subclasses

    @property
    def columns(self) -> Sequence[TableColumn]:
        """Columns that fit the current width."""
        raise NotImplementedError

    @property
    def editable(self) -> Sequence[str]:
        """Names of the columns that the cursor can enter, from the left."""
        return ()

    def text_of(self, number: int, column: TableColumn) -> str:
        """Return the text of a cell."""
        raise NotImplementedError

    def lead(self, number: int, style: Style) -> list[Segment]:
        """Return the text segments in front of a row."""
        raise NotImplementedError

    def look(self, name: str) -> Style:
        """Return the style of a component class of Textual, without the style of the widget."""
        return self.get_component_rich_style(name, partial=True)

    def row_style(self, number: int) -> Style:
        """Return the style of a row."""
        return self.rich_style

    def cell_style(self, number: int, column: TableColumn, style: Style) -> Style:
        """Return the style of a cell that is not under the cursor."""
        return style

    def below(self, y: int) -> list[Segment]:
        """Return the text segments of a line below the last row."""
        return []

    # rows and cursor

    def take_rows(self, rows: Sequence[Any], changed: Iterable[int] | None = None) -> None:
        """Replace the rows; the cursor stays at the same row number if possible.

        If the numbers of `changed` rows are given, only these rows are drawn again.
        """
        self.rows = rows
        self.virtual_size = Size(0, len(rows) + self.HEADING)
        self.set_reactive(TableCells.cursor, self.validate_cursor(self.cursor))
        if changed is None:
            self.refresh()
        else:
            self.refresh_rows(*changed)

    def validate_cursor(self, cursor: int) -> int:
        return max(0, min(cursor, len(self.rows) - 1))

    def validate_column(self, column: int) -> int:
        return max(0, min(column, len(self.editable) - 1))

    def watch_cursor(self, before: int, now: int) -> None:
        if not self.follow():
            self.refresh_rows(before, now)
        self.post_message(self.Moved())

    def watch_column(self) -> None:
        self.refresh_rows(self.cursor)
        self.post_message(self.Moved())

    def refresh_rows(self, *numbers: int) -> None:
        """Redraw only the given rows."""
        for number in numbers:
            self.refresh_line(number + self.HEADING)

    def follow(self) -> bool:
        """Scroll to make the cursor visible; return whether scrolling was necessary."""
        page = max(self.scrollable_content_region.height - self.HEADING, 1)
        beyond = min(self.BEYOND, (page - 1) // 2)
        top = self.scroll_offset.y
        wanted = min(max(top, self.cursor + beyond - page + 1), max(self.cursor - beyond, 0))
        if wanted != top:
            self.scroll_to(y=wanted, animate=False)
        return wanted != top

    def row_at(self, y: int) -> int | None:
        """Return the number of the row on line `y` of the widget; None if there is no row."""
        row = y - self.HEADING + self.scroll_offset.y
        return row if y >= self.HEADING and row < len(self.rows) else None

    def cell_region(self) -> Region:
        """Return the region of the cell under the cursor, relative to the widget."""
        shown = {each.name: each for each in self.columns}
        column = shown.get(self.editable[self.column], self.columns[0])
        y = self.cursor + self.HEADING - self.scroll_offset.y
        return Region(column.start, y, column.width, 1)

    # reacts to the press of the mouse button, not to the release: the layout may change between the
    # two when text typed elsewhere is accepted
    def on_mouse_down(self, event: events.MouseDown) -> None:
        place = event.get_content_offset(self)
        number = None if place is None else self.row_at(place.y)
        if place is None or number is None:
            return
        begun = [each.name for each in self.columns if each.start <= place.x]
        here = begun[-1] if begun else self.columns[0].name
        column = self.editable.index(here) if here in self.editable else self.column
        if (number, column) == (self.cursor, self.column):
            self.post_message(self.Pressed())
        else:
            self.cursor, self.column = number, column

    # drawing

    def render_line(self, y: int) -> Strip:
        width, number = self.scrollable_content_region.width, self.row_at(y)
        ground = self.rich_style
        if y == 0:
            segments = [Segment(self._heading(), self.get_component_rich_style("table--heading"))]
        elif number is None:
            segments = self.below(y)
        else:
            ground = self.row_style(number)
            segments = self._row(number, ground)
        return Strip(segments).adjust_cell_length(width, ground)

    def _heading(self) -> str:
        texts = [" " * self.columns[0].start] if self.columns else []
        for each in self.columns:
            if each.right_aligned:
                texts.append(f"{each.heading:>{each.width}}{'':{self.GAP}}")
            else:
                texts.append(set_cell_size(each.heading, each.width + self.GAP))
        return "".join(texts)

    def _row(self, number: int, style: Style) -> list[Segment]:
        cursor = None
        if number == self.cursor and self.has_focus and self.editable:
            cursor = self.editable[self.column]
        segments = self.lead(number, style)
        for each in self.columns:
            own = self.cell_style(number, each, style)
            if each.name == cursor:
                own = style + self.look("table--cursor")
            segments.append(Segment(each.fitted(self.text_of(number, each)), own))
            segments.append(Segment(" " * self.GAP, style))
        return segments
