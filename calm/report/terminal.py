"""Rendering of report blocks on a terminal, without table rules and legible without colour."""

import re
from collections.abc import Iterable, Iterator, Sequence
from math import ceil
from typing import Any

from rich import table
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, Group, RenderableType, RenderResult
from rich.containers import Lines
from rich.padding import Padding
from rich.segment import Segment
from rich.text import Text

from calm.checks.finding import State
from calm.drawing.picture import in_ascii, printable
from calm.report import blocks
from calm.report.blocks import Block, Cell, Column, Heading, Line, Pairs, Prose, ReportPart, Table

_STYLES = {
    State.PASS: "green", State.NOT_JUDGED: "", State.ACCEPTED: "", State.ESTIMATED: "green",
    State.WARN: "yellow", State.UNKNOWN: "bold", State.FAIL: "bold red",
}  # fmt: skip
"""Terminal style of each state; a word or a mark identifies the state without colour."""
_QUIET = "dim"
_WARNED = _STYLES[State.FAIL]


def shown(part: ReportPart, *, plain: bool = False) -> RenderableType:
    """Convert a part to an object for a rich console, without its figures.

    If `plain` is true, all symbols are ASCII.
    """
    return Group(*_Printer(plain).part(part))


class _Printer:
    def __init__(self, plain: bool) -> None:
        self._sign = in_ascii if plain else str

    def part(self, part: ReportPart) -> Iterator[RenderableType]:
        if part.title:
            yield self._text(part.title, "bold")
            yield Text()
        before: Block | None = None
        for block in part.blocks:
            both = isinstance(before, Prose) and isinstance(block, Prose)
            if before is not None and not both and not isinstance(before, Heading):
                yield Text()
            if isinstance(before, Heading) and isinstance(block, Pairs):
                yield Padding(self._pairs(block), (0, 0, 0, 2))
            else:
                yield from self._block(block)
            before = block

    def _block(self, block: Block) -> Iterable[RenderableType]:
        if isinstance(block, Table):
            return self._table(block)
        if isinstance(block, Pairs):
            return [self._pairs(block)]
        if isinstance(block, Prose):
            return [self._line(line, block.state) for line in block.lines]
        if isinstance(block, blocks.Note):
            return [self._text(line, _QUIET) for line in block.lines]
        if isinstance(block, Heading):
            return [self._text(block.text, "bold")]
        if isinstance(block, blocks.OpenItems):
            return self._items(block)
        raise TypeError(f"a terminal shows no {type(block).__name__}")

    def _table(self, block: Table) -> Iterator[RenderableType]:
        if block.title:
            yield self._text(block.title, "bold")
        gap, block = 1 if block.dense else 2, block.narrow()
        grid = table.Table(box=None, padding=(0, 0, 0, gap), pad_edge=False)
        for column in block.columns:
            self._add_column(grid, column)
        rows: list[Row] = []
        for count, row in enumerate(block.rows, 1):
            style = "bold" if count > len(block.rows) - block.totals else ""
            if len(row) < len(block.columns):
                rows.append(([self._text(cell.text, "bold") for cell in row], style))
            else:
                rows.append(([*map(self._cell, row, block.columns)], style))
        yield PlainTable(grid, rows, gap)
        if block.note:
            yield self._text(block.note, _QUIET)

    def _add_column(self, rows: table.Table, column: Column) -> None:
        lines = [column.heading if column.short is None else column.short]
        lines += [column.unit] * bool(column.unit)
        # room after the digits of a column that may carry marks, so that digits stay aligned
        heading = "\n".join(f"{line} " for line in "\n".join(lines).split("\n"))
        heading = heading if column.marked else "\n".join(lines)
        rows.add_column(
            self._text(heading),
            justify="right" if column.numeric else "left",
            no_wrap=column.numeric or column.share == 0.0,
            overflow="fold",
            vertical="top",
        )

    def _cell(self, cell: Cell, column: Column) -> Text:
        text = f"{cell.text}{cell.mark or ' '}" if column.marked else cell.text + cell.mark
        if cell.bar is not None:
            text = bar_text(cell.bar, cell.state)
        style = _STYLES[cell.state] if cell.state else "bold" if cell.strong else ""
        shown_text = self._text(f"  {text}" if cell.indented else text, style)
        if cell.detail:
            shown_text.append_text(self._text(f"\n{cell.detail}", _QUIET))
        return shown_text

    def _pairs(self, block: Pairs) -> RenderableType:
        rows = table.Table.grid(padding=(0, 2, 0, 0))
        for name, value in block.pairs:
            rows.add_row(self._text(name), self._text(value))
        return rows

    def _items(self, block: blocks.OpenItems) -> Iterator[RenderableType]:
        yield self._text(block.title, "bold")
        rows = table.Table.grid(padding=(0, 1, 0, 0))
        rows.add_column(no_wrap=True)
        rows.add_column(overflow="fold")
        for item in block.items:
            style = _STYLES[item.state]
            shown_text = self._text(item.head, style).append_text(self._text(f" {item.text}"))
            rows.add_row(self._text(item.state.sign, style), shown_text)
        yield rows
        if block.note:
            yield self._text(block.note, _QUIET)

    def _line(self, line: Line, state: State | None) -> Text:
        if isinstance(line, str):
            if state is None:
                return self._text(line)
            return self._text(f"! {line}" if state is State.WARN else line, _WARNED)
        shown_text = Text()
        for span in line:
            style = _STYLES[span.state] if span.state else _QUIET if span.quiet else ""
            shown_text.append_text(self._text(span.text, style))
        return shown_text

    def _text(self, text: str, style: str = "") -> Text:
        """Create a text without markup or terminal control sequences."""
        return _BreakableText(self._sign(printable(text)), style=style)


_BAR, _BEYOND = 10, 3  # characters of a bar up to the limit, and beyond it


def bar_text(share: float, state: State | None) -> str:
    """Draw a fraction of a limit as a bar of text, with a mark at the limit.

    Each character is a tenth of the limit. A bar beyond the limit is hatched if the finding is not
    a failure.
    """
    tenths = min(ceil(_BAR * share - 1e-9), _BAR + _BEYOND)
    sign = "▒" if tenths > _BAR and state is not State.FAIL else "█"
    return f"{sign * min(tenths, _BAR):{_BAR}}|{sign * max(tenths - _BAR, 0)}"


class _BreakableText(Text):
    """Text whose long words may break after a hyphen, an underscore, a full stop or a slash."""

    def wrap(self, console: Console, width: int, **options: Any) -> Lines:
        places: list[int] = []
        for word in re.finditer(r"(?m)^ *\S+|\S+", self.plain):
            start = word.start()
            while word.end() - start > width:
                ends = [one.end() for one in _BREAKS.finditer(self.plain, start, start + width)]
                if not ends:
                    break
                start = ends[-1]
                places.append(start)
        parted = Text("\n").join(self.divide(places)) if places else self.copy()
        return Text.wrap(parted, console, width, **options)


_BREAKS = re.compile("[-_./]")


Row = tuple[Sequence[Text], str]
"""Cells of a table row from the first column on, and the style of the row."""


class PlainTable:
    """Table without ruled lines, printed as plain text.

    `table` is a rich table without rows, and `gap` the number of blanks between columns.
    """

    def __init__(self, table: table.Table, rows: Sequence[Row], gap: int) -> None:
        self._table, self._rows, self._gap = table, rows, gap
        for cells, style in rows:
            table.add_row(*cells, style=style)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        headings: list[list[Text]] = [
            list(column.header.split("\n")) if isinstance(column.header, Text) else []
            for column in self._table.columns
        ]
        # an empty column of a rich table has a width of 1
        widths = [max([1, *(cell_len(one.plain) for one in lines)]) for lines in headings]
        simple = True
        for cells, _ in self._rows:
            for number, cell in enumerate(cells):
                widths[number] = max(widths[number], cell_len(cell.plain))
                simple = simple and "\n" not in cell.plain and not cell.spans
        excess = sum(widths) + self._gap * (len(widths) - 1) - options.max_width
        wrapped = [i for i, column in enumerate(self._table.columns) if not column.no_wrap]
        folded = wrapped[0] if excess > 0 and len(wrapped) == 1 else -1
        if folded >= 0:
            widths[folded] -= excess
            least = max((cell_len(one.plain) for one in headings[folded]), default=0)
            simple = simple and widths[folded] >= max(least, 1)
        if not simple or excess > 0 > folded:
            yield self._table  # rich wraps its columns
            return
        height = max(map(len, headings), default=0)
        for number in range(height):
            rows = ([Text()] * (height - len(lines)) + list(lines) for lines in headings)
            cells = [lines[number] for lines in rows]
            yield from self._line(console, cells, widths, "table.header")
        for row, style in self._rows:
            if not 0 <= folded < len(row) or cell_len(row[folded].plain) <= widths[folded]:
                yield from self._line(console, row, widths, style)
                continue
            lines = row[folded].wrap(console, widths[folded], overflow="fold")
            for number, line in enumerate(lines):
                others = [Text() if number else cell for cell in row]
                others[folded] = line
                yield from self._line(console, others, widths, style)

    def _line(
        self, console: Console, cells: Sequence[Text], widths: Sequence[int], style: str
    ) -> RenderResult:
        base = console.get_style(style)
        last = len(widths) - 1
        for number, width in enumerate(widths):
            cell = cells[number] if number < len(cells) else Text()
            right = self._table.columns[number].justify == "right"
            shown_text = cell.plain.rstrip() if right else cell.plain
            room = " " * (width - cell_len(shown_text))
            text = room + shown_text if right else shown_text + room
            own = console.get_style(cell.style) if cell.style else None
            yield Segment(text, base + own if own else base)
            if number < last:
                yield Segment(" " * self._gap, base)
        yield Segment.line()
