"""The line as a table from top to bottom, with cursor, marks, values and search."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from textwrap import wrap
from typing import ClassVar, Literal

from rich.cells import cell_len
from rich.segment import Segment
from rich.style import Style

from calm.case.columns import Output, ResultColumn
from calm.case.result_tables import table_columns
from calm.checks.finding import State, percent_used
from calm.checks.strength import strength
from calm.files import Place
from calm.tui import cell_editor, checking, dialogs, forms, theme
from calm.tui.scrolled import TableCells, TableColumn
from calm.tui.workspace import Workspace

_TAIL = 4
_EMPTY = (
    "  The line is empty.",
    "  a   adds the first piece, from the catalogue",
    "  b   starts from a template: deep, shelf, ADCP, taut or slack surface, or tow",
)


class LineTable(TableCells, can_focus=True):
    """Table of the line, with a cell cursor."""

    COMPONENT_CLASSES: ClassVar[set[str]] = {
        "line-table--row",
        "line-table--clamp",
        "line-table--under-cursor",
        "line-table--marked",
        "line-table--wrong",
        "line-table--old",
        "line-table--fail",
        "line-table--unknown",
        "line-table--warn",
    }
    DEFAULT_CSS = """
    LineTable {
        background: $background; color: $foreground;
        & > .table--heading { color: $text-muted; background: $background; text-style: none; }
        & > .line-table--row { color: $foreground; background: $background; }
        & > .line-table--clamp { color: $text-muted; background: $background; }
        & > .line-table--under-cursor { background: $surface; text-style: bold; }
        & > .line-table--marked { color: $text-accent; text-style: bold; }
        & > .line-table--wrong { color: $text-error; }
        & > .line-table--old { text-style: dim; }
        & > .line-table--fail { color: $text-error; text-style: bold; }
        & > .line-table--unknown { color: $text-muted; }
        & > .line-table--warn { color: $text-warning; }
    }
    """

    BEYOND = 2

    class Moved(TableCells.Moved):
        """Message that the cursor has moved to another cell of the line."""

    def __init__(self, *, id: str | None = None) -> None:
        super().__init__(id=id)
        self.rows: tuple[TableRow, ...] = ()
        self.marked: frozenset[Place] = frozenset()
        self.old = False
        self._arranged: tuple[int, tuple[TableColumn, ...]] = (0, layout_for(80))

    @property
    def columns(self) -> tuple[TableColumn, ...]:
        """Columns that fit the current width."""
        width = self.scrollable_content_region.width
        if self._arranged[0] != width:
            names = ("component", "label", "length", "leg")
            longest = (self._longest(name) for name in names)
            planned = any("planned_depth" in row.texts for row in self.rows)
            self._arranged = (width, layout_for(width, *longest, planned=planned))
        return self._arranged[1]

    def _longest(self, column: str) -> int:
        return max((cell_len(row.texts.get(column, "")) for row in self.rows), default=0)

    @property
    def editable(self) -> Sequence[str]:
        """Names of the editable columns."""
        return EDITABLE

    @property
    def row(self) -> TableRow | None:
        """The row under the cursor."""
        return self.rows[self.cursor] if self.rows else None

    @property
    def spot(self) -> Place | None:
        """Position of the row under the cursor; None if the line is empty."""
        return self.row.spot if self.row else None

    @property
    def chosen_here(self) -> Place:
        """Position of the row under the cursor; the line must not be empty."""
        return self.rows[self.cursor].spot

    @property
    def chosen(self) -> tuple[Place, ...]:
        """Positions of the marked rows, or of the row under the cursor if no row is marked."""
        if self.marked:
            return tuple(row.spot for row in self.rows if row.spot in self.marked)
        return (self.spot,) if self.spot else ()

    def show_rows(self, rows: Sequence[TableRow], *, old: bool = False) -> None:
        """Replace the rows; dim values that were computed from an earlier draft (`old`)."""
        self.old = old
        self._arranged = (-1, self._arranged[1])
        self.marked &= {row.spot for row in rows}
        self.take_rows(tuple(rows))

    def go_to(self, spot: Place | None) -> None:
        """Move the cursor to a row of the line."""
        for number, row in enumerate(self.rows):
            if row.spot == spot:
                self.cursor = number
                self.follow()

    def mark(self, spots: frozenset[Place]) -> None:
        """Mark the given rows, and no others."""
        self.marked = spots
        self.refresh()

    def on_resize(self) -> None:
        self.follow()

    def below(self, y: int) -> list[Segment]:
        width = max(self.size.width, 20)
        hints = [line for text in _EMPTY for line in wrap(text, width, subsequent_indent=" " * 6)]
        if self.rows or not 1 < y < len(hints) + 2:
            return []
        return [Segment(hints[y - 2], self.get_component_rich_style("line-table--clamp"))]

    def text_of(self, number: int, column: TableColumn) -> str:
        return self.rows[number].texts.get(column.name, "")

    def row_style(self, number: int) -> Style:
        row = self.rows[number]
        base = "line-table--clamp" if row.spot.is_clamp else "line-table--row"
        style = self.get_component_rich_style(base)
        for part, is_so in (
            ("under-cursor", number == self.cursor and self.has_focus),
            ("wrong", row.wrong),
            ("marked", row.spot in self.marked),
        ):
            if is_so:
                style += self.look(f"line-table--{part}")
        return style

    def cell_style(self, number: int, column: TableColumn, style: Style) -> Style:
        if self.old and column.name not in EDITABLE:
            style += self.look("line-table--old")
        return style

    def lead(self, number: int, style: Style) -> list[Segment]:
        row = self.rows[number]
        sign = Segment(" ", style)
        if row.spot in self.marked:
            sign = Segment(theme.MARK, style)
        elif row.state is not None and row.state.value not in (
            "pass",
            "not-judged",
            "accepted",
            "estimated",
        ):
            colour = self.look(f"line-table--{row.state.value}")
            sign = Segment(row.state.sign, style + colour)
        cursor = theme.CURSOR if number == self.cursor else " "
        return [Segment(cursor, style), sign, Segment(f"{row.sign} ", style)]


Column = Literal["component", "label", "count", "length"]
EDITABLE: tuple[Column, ...] = ("component", "label", "count", "length")
"""Editable columns, from the left."""

_WORDS = ("leg", "component", "label")
_WIDTHS = {"count": 3, "length": 9, "depth": 8, "tension": 9, "tilt": 6, "use": 5,
           "planned_depth": 7}  # fmt: skip
_DEFAULT_WIDTH = 9
_MIN_TEXT, _PREFERRED_TEXT = 9, 12
_MAX_COMPONENT, _MAX_LABEL, _MAX_LENGTH, _MAX_LEG = 30, 40, 13, 10
LEAD = 4
"""Width before the first column [cells]: cursor, mark or state, role symbol, blank."""


@dataclass(frozen=True)
class TableRow:
    """Displayed row of a piece or a clamp.

    `spot` is the position in the line, `sign` the symbol for the role. `texts` are by column name.
    `state` is the most severe state of the findings. `wrong` is true if the component is unknown.
    """

    spot: Place
    sign: str
    texts: dict[str, str]
    state: State | None = None
    wrong: bool = False


def layout_for(
    width: int,
    component: int = _MAX_COMPONENT,
    label: int = _MAX_LABEL,
    length: int = 0,
    leg: int = 0,
    *,
    planned: bool = False,
) -> tuple[TableColumn, ...]:
    """Return the columns that fit a width; a narrow table omits the least important columns.

    Parameters
    ----------
    width : width of the table [cells]
    component, label, length, leg : longest text in the column [cells]; `leg` is 0 except for a net
    planned : whether any row has a planned depth
    """
    heads = {name: "n" if name == "count" else name for name in ("leg", *EDITABLE)}
    figures = {one.name: _heading(one) for one in table_columns(Output.BUILDER)}
    if planned:
        figures["planned_depth"] = "planned"  # in the unit of the depth column
    else:
        figures.pop("planned_depth")
    heads |= figures | {"use": "use"}
    shown = list(heads)[0 if leg else 1 :]
    fixed = _WIDTHS | {"length": min(max(length, _WIDTHS["length"]), _MAX_LENGTH)}
    fixed["leg"] = min(max(leg, 3), _MAX_LEG)
    for name, head in figures.items():
        fixed[name] = max(_WIDTHS.get(name, _DEFAULT_WIDTH), len(head))
    others = [name for name in figures if name not in _WIDTHS]
    for name in (*others, "use", "planned_depth", "tilt", "count", "tension", "depth"):
        if _text_room(shown, width, fixed) >= 2 * _PREFERRED_TEXT:
            break
        if name in shown:
            shown.remove(name)
    room = max(_text_room(shown, width, fixed), 2 * _MIN_TEXT)
    component = min(max(component, _MIN_TEXT), _MAX_COMPONENT)
    component = min(component, room - min(max(label, _MIN_TEXT), room // 2))
    widths = fixed | {"component": component, "label": min(room - component, _MAX_LABEL)}
    columns, start = [], LEAD
    for name in shown:
        tail = _TAIL if name == "component" else 0  # the end of an id is its size
        is_right = name not in _WORDS
        columns.append(TableColumn(name, heads[name], start, widths[name], is_right, tail))
        start += widths[name] + 1
    return tuple(columns)


def _heading(figure: ResultColumn) -> str:
    if figure.quantity is None:
        return figure.name
    return f"{figure.quantity.heading} {figure.quantity.display_unit}".rstrip()


def _text_room(shown: list[str], width: int, fixed: dict[str, int]) -> int:
    """Return the width that remains for the component and label columns [cells]."""
    return width - LEAD - len(shown) - sum(fixed.get(name, 0) for name in shown)


class LineSearch(cell_editor.EditableTable):
    """Search commands of the line table; each moves the cursor to a row and reports the match."""

    table: LineTable
    workspace: Workspace
    words = ""

    def action_find(self) -> None:
        def take(texts: dict[str, str]) -> None:
            self.words = texts["words"]
            self.action_find_next(1)

        takes = "id, label, serial, maker"
        fields = [forms.FormField("words", "Words", self.words, checking.needed("a word"), takes)]
        dialogs.enter(self.app, "Find in the line", "", fields, take)

    def action_find_next(self, by: int) -> None:
        wanted = self.words.casefold().split()
        if not wanted:
            self.workspace.tell("Press / first to search for words in the line")
            return
        self._to(
            by, lambda row: all(word in self._searched_text(row) for word in wanted), self.words
        )

    def action_weakest(self) -> None:
        view = self.workspace.judged("Checks are still running; try again in a moment")
        if view is None:
            return
        found = [
            (each.utilisation, each.place.row, each)
            for each in (*view.findings, *view.tighter)
            if each.utilisation is not None and each.place is not None
            if each.rule == strength.name
        ]
        if not found:
            self.workspace.tell("The utilisation of strength is unknown for all pieces")
            return
        use, place, finding = max(found, key=lambda each: each[0])
        self.table.go_to(place)
        used = f"{percent_used(use):.0f} %"
        text = f"Highest utilisation of strength, {used}: {finding.component}, {finding.message}"
        self.workspace.tell(text)

    def _to(self, by: int, is_wanted: Callable[[TableRow], bool], what: str) -> None:
        rows: Sequence[TableRow] = self.table.rows
        found = [number for number, row in enumerate(rows) if is_wanted(row)]
        if not found:
            self.workspace.tell(f"No row of the line contains `{what}`", wrong=True)
            return
        here = self.table.cursor
        beyond = [each for each in found[::by] if (each - here) * by > 0]
        number = (beyond or found[::by])[0]
        self.table.cursor = number
        self.workspace.tell(f"{found.index(number) + 1} of {len(found)} {what}")

    def _searched_text(self, row: TableRow) -> str:
        index, use = self.workspace.index, row.texts["component"].split()[-1:]
        listed = index.get(use[0]) if index and use else None
        serial = self.workspace.session.written(row.spot).get("serial", "")
        own = f"{row.texts['component']} {row.texts.get('label', '')} {serial}".casefold()
        return f"{own} {listed.searched}" if listed else own
