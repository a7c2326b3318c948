"""Mooring diagram on as many pages as it needs, each with a title block."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from itertools import count
from string import ascii_uppercase

from calm.case.leg_result import LegResult
from calm.checks.finding import DEFAULT_ENVIRONMENT, OWN
from calm.deck import Deck
from calm.drawing import schematic
from calm.drawing.schematic import FONT, HEAD, LEADING, PlacedPart, divided, placed
from calm.drawing.schematic.deck_parts import has_plans, parts_of_deck
from calm.drawing.schematic.pen import INK, SOFT, Pen, picture, svg_text, wrapped
from calm.drawing.schematic.shown_parts import TextRow, one_line
from calm.drawing.schematic.symbols import LINES, Sign, draw_cable, figure_of
from calm.quantities import QUANTITIES, say
from calm.report.open_items import assessment_verdict, short
from calm.report.provenance import title_pairs
from calm.report.sheet import end_descriptions, leg_title

_HEADINGS = (
    (("no.",), ""),
    (("cut length", "or position"), "length"), (("stretched",), "length"), (("depth",), "depth"),
    (("planned",), "planned_depth"),
    (("above", "seabed"), "height"), (("tension",), "tension"),
    (("net", "buoyancy"), "wet_weight"),
)  # fmt: skip
_MARGIN, _BETWEEN = 34.0, 20.0
_TITLE, _TITLE_ROOM = 13.0, 12.0
_CONTINUED = 16.0  # height of a continuation mark
_SKY, _MAST, _SUBMERGED = 7.0, 26.0, 11.0
_LEGEND_ROW, _LEGEND_COLUMNS = 21.0, 4
_GROUND = 44.0
_EVEN = 0.7  # smallest length of the last column, if possible, as a fraction of the first


class PageSize(StrEnum):
    """Page size of the sheets."""

    A4 = "a4"
    A3 = "a3"
    LETTER = "letter"

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the page [pt]."""
        return {"a4": (595.28, 841.89), "a3": (1190.55, 841.89), "letter": (612.0, 792.0)}[self]

    @property
    def columns(self) -> int:
        """Number of diagram columns side by side."""
        return 2 if self is PageSize.A3 else 1

    @property
    def column_width(self) -> float:
        """Width of a diagram column [pt]."""
        return (self.size[0] - 2 * _MARGIN - (self.columns - 1) * _BETWEEN) / self.columns

    def left(self, column: int) -> float:
        """Return the left edge of a diagram column [pt]."""
        return _MARGIN + (column % self.columns) * (self.column_width + _BETWEEN)


@dataclass(frozen=True)
class _PageColumn:
    """A column of the diagram, with the parts of one leg of a net or of a single line.

    `above` and `below` are the texts at connections to other columns, or None.
    """

    parts: tuple[PlacedPart, ...]
    above: str | None
    below: str | None
    afloat: bool
    leg: str

    @property
    def end(self) -> float:
        """Lower edge of the last part in the column [pt]."""
        return self.parts[-1].top + self.parts[-1].height


_Stacks = tuple[tuple[tuple[float, _PageColumn], ...], ...]
"""Columns in reading order, each with its legs and their vertical offsets [pt]."""


class _Diagram:
    def __init__(self, deck: Deck, page_size: PageSize) -> None:
        lines = deck.result.legs
        listed = [items for _, items in deck.by_leg(deck.parts, lambda one: one.index)]
        legs = [
            parts_of_deck(deck, items, surface=line.type == "surface")
            for line, items in zip(lines, listed, strict=True)
        ]
        parts = [part for leg in legs for part in leg]
        self.title, self.page_size, self.fields = (
            one_line(deck.file.name),
            page_size,
            _title_block_rows(deck, page_size),
        )
        self.bottom = page_size.size[1] - _MARGIN - sum(map(_height, self.fields))
        headings = [(*words, QUANTITIES[name].display_unit if name else "")
                    for words, name in _HEADINGS
                    if name != "planned_depth" or has_plans(deck)]  # fmt: skip
        rows = (row for part in parts for row in part.rows)
        self.column = column = schematic.column_of(rows, headings, page_size.column_width)
        drawn = (one for part in parts for one in (part.cable, part.sign.symbol) if one)
        self.legend = tuple(dict.fromkeys(drawn))
        sets = (  # long cables are drawn shorter if that saves a page
            [
                (line, schematic.measured(leg, column, growth))
                for line, leg in zip(lines, legs, strict=True)
            ]
            for growth in (1.0, 0.5, 0.0)
        )
        self.columns = min(map(self._evenly_distributed, sets), key=len)
        self.count = -(-len(self.columns) // page_size.columns)

    def _evenly_distributed(
        self, legs: Sequence[tuple[LegResult, Sequence[PlacedPart]]]
    ) -> _Stacks:
        """Distribute the parts of all legs evenly over the columns.

        The last column leaves room for the seabed and the legend above the title block.
        """
        need = _GROUND + LEADING - (-len(self.legend) // _LEGEND_COLUMNS) * _LEGEND_ROW
        lowest = self.bottom
        even: _Stacks = ()
        while True:
            marks = (
                letter + (str(turn) if turn else "")
                for turn in count()
                for letter in ascii_uppercase
            )
            every = (one for line, leg in legs for one in _columns(line, leg, lowest, marks))
            columns = self._stack_legs(every)
            if even and len(columns) > len(even):
                return even
            first, last = (down + one.end for down, one in (columns[0][-1], columns[-1][-1]))
            if len(columns) % self.page_size.columns or last + need <= self.bottom:
                even = columns
                if len(columns) == 1 or len(legs) > 1 or last >= _EVEN * first:
                    return even
            lowest -= 2 * LEADING

    def _stack_legs(self, columns: Iterable[_PageColumn]) -> _Stacks:
        found: list[list[tuple[float, _PageColumn]]] = []
        down = 0.0
        for one in columns:
            if found:
                down = found[-1][-1][0] + found[-1][-1][1].end + _CONTINUED + HEAD - _TOP
            if found and one.leg and down + one.end + _GROUND <= self.bottom:
                found[-1].append((down, one))
            else:
                found.append([(0.0, one)])
        return tuple(map(tuple, found))

    def draw_page(self, page: Pen, number: int) -> None:
        width = self.page_size.size[0] - 2 * _MARGIN
        page.write(_MARGIN, _MARGIN + 0.4 * _TITLE, self.title, width, size=_TITLE, bold=True)
        first = number * self.page_size.columns
        there = self.columns[first : first + self.page_size.columns]
        for at, column in enumerate(there):
            for down, one in column:
                self._draw_column(page.group(0.0, down), one, self.page_size.left(at))
        if number + 1 == self.count:
            self._draw_legend(page, len(there) - (len(there) == self.page_size.columns))
        self._draw_title_block(page, f"{number + 1} of {self.count}")

    def _draw_column(self, page: Pen, one: _PageColumn, left: float) -> None:
        column = self.column
        schematic.draw_headings(page, column, left, _TOP - HEAD)
        if one.leg:
            page.write(left, _TOP - 8.0, one.leg, column.text[1], size=FONT, bold=True)
        start, end = one.parts[0].top, one.end
        if one.above is None:
            surface = one.parts[0].middle if one.afloat else _TOP + _SKY
            row = None if one.afloat else TextRow("sea surface", "")
            schematic.draw_sea(page, column, left, (surface, end), row)
        if one.below is None:
            schematic.draw_ground(page, column, left, end, TextRow("seabed", ""))
        if one.above is not None:
            self._draw_continuation_mark(page, left, start - _CONTINUED, one.above)
        schematic.draw_parts(page, one.parts, column, left)
        if one.below is not None:
            self._draw_continuation_mark(page, left, end, one.below)

    def _draw_continuation_mark(self, page: Pen, left: float, top: float, words: str) -> None:
        x, text = left + self.column.line_at, left + self.column.text[0]
        page.line(x, top, x, top + _CONTINUED, stroke=INK, stroke_width=1.2, stroke_dasharray="2 2")
        page.draw(
            "rect", x=text - 4.0, y=top + 2.0, width=78.0, height=_CONTINUED - 4.0, fill="white",
            stroke=INK, stroke_width=0.8,
        )  # fmt: skip
        page.letters(text, top + _CONTINUED / 2, words, size=FONT, bold=True)

    def _draw_legend(self, page: Pen, column: int) -> None:
        left = self.page_size.left(column)
        top = self.bottom + (-len(self.legend) // _LEGEND_COLUMNS) * _LEGEND_ROW
        page.letters(left, top - LEADING - 5.0, "Symbols", size=FONT, bold=True)
        pen = page.draw("g", stroke=INK, stroke_width=0.9, fill=INK)
        step = self.page_size.column_width / _LEGEND_COLUMNS
        for place, symbol in enumerate(self.legend):
            x = left + 14.0 + step * (place % _LEGEND_COLUMNS)
            y = top + _LEGEND_ROW * (place // _LEGEND_COLUMNS) + _LEGEND_ROW / 2 - 3.0
            if symbol in LINES:
                draw_cable(pen, symbol, x, y - 9.0, y + 9.0)
            else:
                figure = figure_of(Sign(symbol))
                figure.draw(pen.group(x, y, min(0.5, 20.0 / figure.height)))
            page.letters(x + 18.0, y, symbol.value, size=FONT)

    def _draw_title_block(self, page: Pen, sheet: str) -> None:
        step, y = (self.page_size.size[0] - 2 * _MARGIN) / _COLUMNS[self.page_size], self.bottom
        for row in self.fields:
            height = _height(row)
            for number, (name, lines) in enumerate(row):
                x = _MARGIN + number * step
                page.draw(
                    "rect", x=x, y=y, width=step, height=height, fill="none", stroke=INK,
                    stroke_width=0.6,
                )  # fmt: skip
                page.letters(x + _PAD, y + 6.0, name, size=FONT, colour=SOFT)
                for line, text in enumerate((sheet,) if name == "sheet" else lines, 1):
                    page.letters(x + _PAD, y + 6.0 + LEADING * line, text, size=FONT)
            y += height


def diagram_pages(deck: Deck, page_size: PageSize) -> list[str]:
    """Draw the pages of the diagram as SVG pictures at print size; no text is smaller than 8 pt.

    A long line is interrupted, preferably above a junction. The two ends at an interruption are
    marked with the same letter. The same deck gives the same SVG.
    """
    diagram = _Diagram(deck, page_size)
    pages = [picture(*page_size.size, diagram.title) for _ in range(diagram.count)]
    for number, page in enumerate(pages):
        diagram.draw_page(page, number)
    return [svg_text(page) for page in pages]


def diagram_svg(deck: Deck, page_size: PageSize) -> str:
    """Draw all pages of the diagram in one picture, one below the other."""
    diagram, (width, height) = _Diagram(deck, page_size), page_size.size
    drawn = picture(width, height * diagram.count, diagram.title)
    for number in range(diagram.count):
        diagram.draw_page(drawn.group(0.0, number * height), number)
    return svg_text(drawn)


_TOP = _MARGIN + _TITLE_ROOM + HEAD


def _columns(
    line: LegResult, parts: Sequence[PlacedPart], lowest: float, marks: Iterator[str]
) -> Iterator[_PageColumn]:
    """Yield the columns of a line or a leg in reading order.

    `lowest` is the lower limit of a column [pt], and `marks` are the letters for interruptions.
    """
    afloat, (above, bottom) = line.type == "surface", end_descriptions(line)
    sea = _MAST - parts[0].height / 2 if afloat else _SKY + _SUBMERGED
    for group in divided(parts, lowest - _TOP - _CONTINUED - max(sea, _CONTINUED)):
        mark = "" if group[-1] is parts[-1] else next(marks)
        if above is not None:
            there = placed(group, _TOP + _CONTINUED)
        else:
            there = placed(group, _TOP + sea, _TOP + sea + group[0].height / 2)
        below = f"continues at {mark}" if mark else bottom
        leg = leg_title(line) if line.leg.of_several else ""
        yield _PageColumn(there, above, below, afloat and above is None, leg)
        above = f"from {mark}"


_FIELDS = (
    "mooring", "document", "revision", "date", "project", "ship", "cruise", "position",
    "water depth", "environment", "author", "checked", "approved", "anchor in air, in water",
    "min. back-up", "design check", "sheet",
)  # fmt: skip
_COLUMNS = {PageSize.A4: 5, PageSize.LETTER: 5, PageSize.A3: 9}
_PAD = 4.0


_Fields = tuple[tuple[str, tuple[str, ...]], ...]
"""One row of the title block: names and lines of text."""


_LONGEST = 240
"""Longest text in a field of the title block; a longer text would leave no room for the line."""


def _title_block_rows(deck: Deck, page_size: PageSize) -> list[_Fields]:
    environment = DEFAULT_ENVIRONMENT if deck.environment == OWN else deck.environment
    known = {**dict(title_pairs(deck.file)), **_checked_values(deck), "environment": environment}
    columns = _COLUMNS[page_size]
    room = (page_size.size[0] - 2 * _MARGIN) / columns - 2 * _PAD
    texts = {name: short(one_line(known.get(name, "")), _LONGEST) for name in _FIELDS}
    fields = [(name, tuple(wrapped(text, room, FONT))) for name, text in texts.items()]
    return [tuple(fields[start : start + columns]) for start in range(0, len(fields), columns)]


def _checked_values(deck: Deck) -> dict[str, str]:
    anchors = [one for one in deck.assessment.inventory if one.role == "anchor"]
    if not deck.result.several:
        anchors = anchors[-1:] or [deck.assessment.inventory[-1]]
    texts = [
        ", ".join(
            "unknown" if value is None else say(name, value)
            for name, value in (("dry_mass", one.dry_mass), ("wet_weight", one.wet_weight))
        )
        for one in anchors
    ]
    breaks = [one.margin for one in deck.assessment.backup if one.judged]
    return {
        "anchor in air, in water": "; ".join(dict.fromkeys(texts)),
        "min. back-up": say("tension", min(breaks)) if breaks else "none",
        "design check": assessment_verdict(deck.assessment).text,
    }


def _height(row: _Fields) -> float:
    return 8.0 + LEADING * max(1, *(len(lines) for _, lines in row)) + 3.0
