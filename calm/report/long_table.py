"""Tables of many rows on a terminal, written line by line where every cell stands on one line.

A table of rich measures, wraps and pads each cell as if it were a page: a thousand pieces take
longer to print than to solve.
"""

from __future__ import annotations

from collections.abc import Sequence

from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.segment import Segment
from rich.table import Table
from rich.text import Text

MANY = 100
"""Rows from which on a table is written line by line."""

Row = tuple[Sequence[Text], str]
"""Cells of a row from the first column on, and its style."""


class LongTable:
    """A table without rules.

    Parameters
    ----------
    table : its columns, and no rows yet
    rows : what it is to have
    gap : blanks between columns
    """

    def __init__(self, table: Table, rows: Sequence[Row], gap: int) -> None:
        self._table, self._rows, self._gap = table, rows, gap

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """The lines, or the table of rich where a cell needs several."""
        headings: list[list[Text]] = [
            list(column.header.split("\n")) if isinstance(column.header, Text) else []
            for column in self._table.columns
        ]
        widths = [max((cell_len(one.plain) for one in lines), default=0) for lines in headings]
        simple = True
        for cells, _ in self._rows:
            for number, cell in enumerate(cells):
                widths[number] = max(widths[number], cell_len(cell.plain))
                simple = simple and "\n" not in cell.plain and not cell.spans
        if not simple or sum(widths) + self._gap * (len(widths) - 1) > options.max_width:
            for cells, style in self._rows:
                self._table.add_row(*cells, style=style)
            yield self._table
            return
        height = max(map(len, headings), default=0)
        for number in range(height):
            rows = ([Text()] * (height - len(lines)) + list(lines) for lines in headings)
            cells = [lines[number] for lines in rows]
            yield from self._line(console, cells, widths, "table.header")
        for cells, style in self._rows:
            yield from self._line(console, cells, widths, style)

    def _line(
        self, console: Console, cells: Sequence[Text], widths: Sequence[int], style: str
    ) -> RenderResult:
        base = console.get_style(style)
        last = len(widths) - 1
        for number, width in enumerate(widths):
            cell = cells[number] if number < len(cells) else Text()
            right = self._table.columns[number].justify == "right"
            said = cell.plain.rstrip() if right else cell.plain
            room = " " * (width - cell_len(said))
            text = room + said if right else said + room
            own = console.get_style(cell.style) if cell.style else None
            yield Segment(text, base + own if own else base)
            if number < last:
                yield Segment(" " * self._gap, base)
        yield Segment.line()
