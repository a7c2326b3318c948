"""The line as a table, top to bottom: a cursor, marks, figures, and no lines between the cells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

from rich.cells import cell_len, set_cell_size
from rich.segment import Segment
from rich.style import Style
from textual import events
from textual.geometry import Region
from textual.message import Message
from textual.reactive import reactive
from textual.strip import Strip

from calm.checks.finding import State
from calm.files import Place
from calm.tui.scrolled import RowList
from calm.tui.theme import CURSOR, ELLIPSIS, LOOKS, MARK

_TAIL = 4
_EMPTY = (
    "  The line is empty.",
    "  a   adds the first piece, from the catalogue",
    "  b   begins with a mooring: deep, shelf, ADCP, taut or slack surface; a tow",
)


class LineTable(RowList, can_focus=True):
    """Rows of the line with a cursor on one cell of them."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "line-table--heading",
        "line-table--row",
        "line-table--clamp",
        "line-table--under-cursor",
        "line-table--cursor",
        "line-table--marked",
        "line-table--wrong",
        "line-table--old",
        "line-table--fail",
        "line-table--unknown",
        "line-table--warn",
    }
    DEFAULT_CSS = """
    LineTable {
        height: 1fr; width: 1fr; overflow-x: hidden; overflow-y: auto; scrollbar-size-vertical: 1;
        background: $background; color: $foreground;
        & > .line-table--heading { color: $text-muted; background: $background; }
        & > .line-table--row { color: $foreground; background: $background; }
        & > .line-table--clamp { color: $text-muted; background: $background; }
        & > .line-table--under-cursor { background: $surface; text-style: bold; }
        & > .line-table--cursor { text-style: reverse bold; }
        & > .line-table--marked { color: $text-accent; text-style: bold; }
        & > .line-table--wrong { color: $text-error; }
        & > .line-table--old { text-style: dim; }
        & > .line-table--fail { color: $text-error; text-style: bold; }
        & > .line-table--unknown { color: $text-muted; }
        & > .line-table--warn { color: $text-warning; }
    }
    """

    HEADING, BEYOND = 1, 2

    column: reactive[int] = reactive(0, init=False, repaint=False)

    class Moved(RowList.Moved):
        """The cursor is on another cell."""

    class Activated(Message):
        """A cell was pressed with the mouse while the cursor was on it."""

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.rows: tuple[TableRow, ...] = ()
        self.marked: frozenset[Place] = frozenset()
        self.old = False
        self._arranged: tuple[int, TableLayout] = (0, layout_for(80))

    @property
    def arrangement(self) -> TableLayout:
        """The columns as wide as they are now."""
        width = self.scrollable_content_region.width
        if self._arranged[0] != width:
            longest = (self._longest(name) for name in ("component", "label", "length"))
            self._arranged = (width, layout_for(width, *longest))
        return self._arranged[1]

    def _longest(self, column: str) -> int:
        return max((cell_len(row.texts.get(column, "")) for row in self.rows), default=0)

    @property
    def row(self) -> TableRow | None:
        """The row under the cursor."""
        return self.rows[self.cursor] if self.rows else None

    @property
    def spot(self) -> Place | None:
        """Return where the cursor is in the line."""
        return self.row.spot if self.row else None

    @property
    def cell(self) -> Column:
        """The column of the cursor."""
        return EDITABLE[self.column]

    @property
    def chosen(self) -> tuple[Place, ...]:
        """The rows marked, or that under the cursor."""
        if self.marked:
            return tuple(row.spot for row in self.rows if row.spot in self.marked)
        return (self.spot,) if self.spot else ()

    def show_rows(self, rows: Sequence[TableRow], *, old: bool = False) -> None:
        """Other rows; `old` where their figures are those of an earlier line."""
        self.old = old
        self._arranged = (-1, self._arranged[1])
        self.marked &= {row.spot for row in rows}
        self.take_rows(tuple(rows))

    def go_to(self, spot: Place | None) -> None:
        """Put the cursor on a row of the line."""
        for number, row in enumerate(self.rows):
            if row.spot == spot:
                self.cursor = number
                self.follow()

    def mark(self, spots: frozenset[Place]) -> None:
        """Mark these rows and no other."""
        self.marked = spots
        self.refresh()

    def cell_region(self, column: str) -> Region:
        """Return where a cell of the row under the cursor is, within the widget."""
        start, width = self.arrangement.place(column)
        return Region(start, self.cursor + 1 - self.scroll_offset.y, width, 1)

    def validate_column(self, column: int) -> int:
        """Keep it on the columns that a person fills and that are shown."""
        return max(0, min(column, len(EDITABLE) - 1))

    def watch_column(self) -> None:
        """Show it."""
        self.refresh_rows(self.cursor)
        self.post_message(self.Moved())

    def on_resize(self) -> None:
        """Keep the cursor in sight as the window changes."""
        self.follow()

    def on_click(self, event: events.Click) -> None:
        """Put the cursor where the mouse is; a press on the cursor itself edits."""
        place = event.get_content_offset(self)
        number = None if place is None else self.row_at(place.y)
        if place is None or number is None:
            return
        name = self.arrangement.at(place.x)
        column = next((i for i, each in enumerate(EDITABLE) if each == name), self.column)
        if (number, column) == (self.cursor, self.column):
            self.post_message(self.Activated())
        else:
            self.cursor, self.column = number, column

    def render_line(self, y: int) -> Strip:
        """A row of the screen."""
        width = self.scrollable_content_region.width
        number = self.row_at(y)
        segments = self._heading() if y == 0 else [] if number is None else self._row(number)
        if not self.rows and 1 < y < len(_EMPTY) + 2:
            segments = [Segment(_EMPTY[y - 2], self.get_component_rich_style("line-table--clamp"))]
        ground = self.get_component_rich_style("line-table--row")
        if number == self.cursor and self.has_focus:
            ground += self.get_component_rich_style("line-table--under-cursor", partial=True)
        return Strip(segments).adjust_cell_length(width, ground).crop(0, width)

    def _heading(self) -> list[Segment]:
        style = self.get_component_rich_style("line-table--heading")
        segments = [Segment(" " * self.arrangement.columns[0][1], style)]
        for name, _, width in self.arrangement.columns:
            segments.append(Segment(_fitted(HEADINGS[name], width, name) + " ", style))
        return segments

    def _row(self, number: int) -> list[Segment]:
        row = self.rows[number]
        look = self.get_component_rich_style
        style = look("line-table--clamp" if row.spot.is_clamp else "line-table--row")
        here = number == self.cursor and self.has_focus
        if here:
            style += look("line-table--under-cursor", partial=True)
        if row.wrong:
            style += look("line-table--wrong", partial=True)
        is_marked = row.spot in self.marked
        if is_marked:
            style += look("line-table--marked", partial=True)
        segments = [
            Segment(CURSOR if number == self.cursor else " ", style),
            *self._state(row, is_marked, style),
            Segment(f"{row.sign} ", style),
        ]
        for name, _, width in self.arrangement.columns:
            own = style
            if here and name == self.cell:
                own += look("line-table--cursor", partial=True)
            elif name not in EDITABLE and self.old:
                own += look("line-table--old", partial=True)
            segments.append(Segment(_fitted(row.texts.get(name, ""), width, name), own))
            segments.append(Segment(" ", style))
        return segments

    def _state(self, row: TableRow, is_marked: bool, style: Style) -> list[Segment]:
        if is_marked:
            return [Segment(MARK, style)]
        if row.state is None or row.state.value in ("pass", "accepted"):
            return [Segment(" ", style)]
        colour = self.get_component_rich_style(f"line-table--{row.state.value}", partial=True)
        return [Segment(LOOKS[row.state].sign, style + colour)]


def _fitted(text: str, width: int, column: str) -> str:
    """A text as wide as its column; one that is too long ends in an ellipsis."""
    if cell_len(text) > width and column == "component":  # its size stands at its end
        return set_cell_size(text, width - 1 - _TAIL) + ELLIPSIS + text[-_TAIL:]
    if cell_len(text) > width:
        return set_cell_size(set_cell_size(text, width - 1).rstrip() + ELLIPSIS, width)
    if column in RIGHT_ALIGNED:
        return " " * (width - cell_len(text)) + text
    return set_cell_size(text, width)


Column = Literal["component", "label", "count", "length"]
EDITABLE: tuple[Column, ...] = ("component", "label", "count", "length")
"""The columns that a person fills, from the left."""

FIGURES = ("depth", "tension", "tilt", "margin")
HEADINGS = {
    "component": "component",
    "label": "label",
    "count": "n",
    "length": "length",
    "depth": "depth m",
    "tension": "tension N",
    "tilt": "tilt °",
    "margin": "margin",
}
RIGHT_ALIGNED = frozenset({"count", "length", *FIGURES})

_WIDTHS = {"count": 3, "length": 9, "depth": 8, "tension": 9, "tilt": 6, "margin": 7}
_LEAST_TEXT, _WANTED_TEXT = 9, 12
_MOST_COMPONENT, _MOST_LABEL, _MOST_LENGTH = 30, 40, 13
LEAD = 4
"""Cells before the first column: cursor, mark or state, sign, a blank."""


@dataclass(frozen=True)
class TableRow:
    """What is shown of a piece, or of what is clamped on one.

    `texts` are by the name of the column; `wrong` tells that no such component is known.
    """

    spot: Place
    sign: str
    texts: dict[str, str]
    state: State | None = None
    wrong: bool = False


@dataclass(frozen=True)
class TableLayout:
    """The columns that fit a width: name, first cell, and width."""

    columns: tuple[tuple[str, int, int], ...]

    def place(self, name: str) -> tuple[int, int]:
        """First cell and width of a column; of the first one where it is not shown."""
        for column, start, width in self.columns:
            if column == name:
                return start, width
        return self.columns[0][1:]

    def at(self, x: int) -> str:
        """The column at a cell."""
        found = self.columns[0][0]
        for column, start, _ in self.columns:
            if x >= start:
                found = column
        return found


def layout_for(
    width: int, component: int = _MOST_COMPONENT, label: int = _MOST_LABEL, length: int = 0
) -> TableLayout:
    """The columns of a table as wide as this, those least needed left out where it is narrow.

    Parameters
    ----------
    component, label : cells of the longest text in these columns, which share what is left
    length : cells of the longest length
    """
    shown = [*EDITABLE, *FIGURES]
    fixed = _WIDTHS | {"length": min(max(length, _WIDTHS["length"]), _MOST_LENGTH)}
    for name in ("margin", "tilt", "count", "tension", "depth"):
        if _text_room(shown, width, fixed) >= 2 * _WANTED_TEXT:
            break
        shown.remove(name)
    room = max(_text_room(shown, width, fixed), 2 * _LEAST_TEXT)
    component = min(max(component, _LEAST_TEXT), _MOST_COMPONENT)
    component = min(component, room - min(max(label, _LEAST_TEXT), room // 2))
    widths = fixed | {"component": component, "label": min(room - component, _MOST_LABEL)}
    columns, start = [], LEAD
    for name in shown:
        columns.append((name, start, widths[name]))
        start += widths[name] + 1
    return TableLayout(tuple(columns))


def _text_room(shown: list[str], width: int, fixed: dict[str, int]) -> int:
    """Cells left for the component and the label."""
    return width - LEAD - len(shown) - sum(fixed.get(name, 0) for name in shown)
