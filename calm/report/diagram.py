"""The mooring diagram for the wall, over as many pages as it needs, each with its title block."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from xml.etree import ElementTree

from calm.deck import Deck
from calm.drawing.schematic.pen import FAINT, INK, SOFT, Pen, text_width, wrapped
from calm.drawing.schematic.shown_parts import one_line
from calm.drawing.schematic.sign import LINES, Sign, Symbol
from calm.drawing.schematic.symbols import (
    draw_cable,
    draw_clamp,
    draw_seabed,
    draw_surface,
    figure_of,
)
from calm.quantities import QUANTITIES, say
from calm.report.check_summary import short_verdict
from calm.report.diagram_layout import (
    CLAMP_SCALE,
    CONTINUED,
    FIGURES,
    FONT,
    HEAD,
    INDENT,
    LEADING,
    MARGIN,
    PICTURE,
    SYMBOL_SCALE,
    ColumnOf,
    Paper,
    PlacedEntry,
    columns_of,
    entries_of,
)
from calm.report.provenance import title_pairs

_FONTS = "'DejaVu Sans', Helvetica, Arial, 'Liberation Sans', sans-serif"
_TITLE = 13.0
_LINE_AT = 26.0
_CLAMP_AT = 16.0
_HEADINGS = (
    (("cut,", "or place"), "length"), (("stretched",), "length"), (("depth",), "depth"),
    (("above", "seabed"), "height"), (("tension",), "tension"),
    (("net", "buoyancy"), "wet_weight"),
)  # fmt: skip
_LEGEND_ROW, _LEGEND_COLUMNS = 21.0, 4
_GROUND = 44.0
_WORDS = {
    Symbol.SPHERE: "float", Symbol.BALL: "ball", Symbol.GLASS: "glass float",
    Symbol.FOAM: "foam float", Symbol.STREAMLINED: "streamlined float",
    Symbol.BUOY: "surface buoy", Symbol.CURRENT_METER: "current meter", Symbol.ADCP: "ADCP",
    Symbol.CTD: "CTD or logger", Symbol.TRAP: "sediment trap", Symbol.INSTRUMENT: "instrument",
    Symbol.RELEASE: "release", Symbol.RELEASE_PAIR: "pair of releases",
    Symbol.SHACKLE: "shackle", Symbol.SWIVEL: "swivel", Symbol.LINK: "link or ring",
    Symbol.CHAIN: "chain", Symbol.WIRE: "wire", Symbol.ROPE: "rope",
    Symbol.WHEELS: "anchor, wheels", Symbol.BLOCK: "anchor", Symbol.BODY: "body",
}  # fmt: skip


@dataclass(frozen=True)
class TitleBlock:
    """Fields in rows of as many columns, each with its text in lines; what is not known is blank.

    Attributes
    ----------
    rows : of name and lines of text
    columns : how many stand side by side
    height : of all [pt]
    sheet : such as 2 of 5
    """

    rows: tuple[tuple[tuple[str, tuple[str, ...]], ...], ...]
    columns: int
    height: float
    sheet: str = ""

    def of_page(self, number: int, count: int) -> TitleBlock:
        """The block of one of several pages."""
        return replace(self, sheet=f"{number} of {count}")

    def draw(self, page: Pen, left: float, top: float, width: float) -> None:
        """In a frame, its upper left corner at a point."""
        step = width / self.columns
        y = top
        for row in self.rows:
            height = _height(row)
            for number, (name, lines) in enumerate(one for one in row if one[0]):
                x = left + number * step
                page.draw(
                    "rect", x=x, y=y, width=step, height=height, fill="none", stroke=INK,
                    stroke_width=0.6,
                )  # fmt: skip
                page.letters(x + _PAD, y + 6.0, name, size=FONT, colour=SOFT)
                shown = (self.sheet,) if name == "sheet" else lines
                for line, text in enumerate(shown):
                    page.letters(x + _PAD, y + 6.0 + LEADING * (line + 1), text, size=FONT)
            y += height


_Page = tuple[str, Paper, TitleBlock, list[tuple[int, ColumnOf]], tuple[Sign, ...], bool]


def diagram_pages(deck: Deck, paper: Paper) -> list[str]:
    """The pages as SVG pictures at their own size, no text below 8 pt.

    Pages end above a junction where one is near their end, else between two pieces, else between
    two clamps; where a line goes on, both ends carry the same letter. No text is cut: long ones
    wrap. The same deck gives the same text.
    """
    written = []
    for page in _drawn(deck, paper):
        picture = _picture(*paper.size, one_line(deck.file.name))
        _fill(picture, *page)
        written.append(_written(picture))
    return written


def diagram_svg(deck: Deck, paper: Paper) -> str:
    """All pages of the diagram, one below the other, as one picture."""
    pages = [*_drawn(deck, paper)]
    width, height = paper.size
    picture = _picture(width, height * len(pages), one_line(deck.file.name))
    for number, page in enumerate(pages):
        _fill(picture.group(0.0, number * height), *page)
    return _written(picture)


def _drawn(deck: Deck, paper: Paper) -> list[_Page]:
    entries = entries_of(deck)
    block = title_block_of(deck, paper)
    legend = tuple({entry.sign.symbol: entry.sign for entry in entries}.values())
    rows = -(-len(legend) // _LEGEND_COLUMNS)
    need = _GROUND + LEADING + rows * _LEGEND_ROW
    bottom = paper.size[1] - MARGIN - block.height
    foot = block.height
    while True:  # a page that had nothing but the legend takes over some entries
        columns = columns_of(entries, paper, foot)
        if len(columns) % paper.columns or columns[-1].end + need <= bottom:
            break
        foot += 2 * LEADING
    placed = [*enumerate(columns)]
    pages = [
        placed[start : start + paper.columns] for start in range(0, len(placed), paper.columns)
    ]
    title = one_line(deck.file.name)
    count = len(pages)
    return [
        (title, paper, block.of_page(number, count), page, legend, number == count)
        for number, page in enumerate(pages, 1)
    ]


def _fill(
    page: Pen,
    title: str,
    paper: Paper,
    block: TitleBlock,
    columns: list[tuple[int, ColumnOf]],
    legend: tuple[Sign, ...],
    is_last: bool,
) -> None:
    """Draw a page: its head, its columns, its title block, and the legend on the last one."""
    width, height = paper.size
    page.letters(MARGIN, MARGIN + 0.4 * _TITLE, title, size=_TITLE, bold=True)
    for number, column in columns:
        _column(page, column, paper, paper.left(number), first=number == 0)
    bottom = height - MARGIN - block.height
    if is_last:
        _legend(page, legend, columns, paper, bottom)
    block.draw(page, MARGIN, bottom, width - 2 * MARGIN)


def _column(page: Pen, column: ColumnOf, paper: Paper, left: float, *, first: bool) -> None:
    rights = _rights(paper, left)
    top = MARGIN + HEAD
    for (words, name), right in zip(_HEADINGS, rights, strict=True):
        lines = (*words, QUANTITIES[name].display_unit)
        for number, word in enumerate(lines):
            y = top - 8.0 - 9.0 * (len(lines) - 1 - number)
            page.letters(right, y, word, size=FONT, colour=SOFT, anchor="end")
    page.line(left, top - 2.0, left + paper.column_width, top - 2.0, stroke=FAINT)
    pen = page.draw("g", stroke=INK, stroke_width=0.9, stroke_linejoin="round", fill=INK)
    x = left + _LINE_AT
    if column.above:
        _continued(page, x, column.entries[0].top - CONTINUED, left, f"from {column.above}")
    elif first:
        water = pen.group(left, 0.0)
        draw_surface(water, PICTURE, top + 7.0)
        page.letters(left + PICTURE, top + 7.0, "sea surface", size=FONT, colour=SOFT)
    for placed in column.entries:
        _entry(page, pen, placed, x, left, rights)
    if column.below:
        _continued(page, x, column.end, left, f"continues at {column.below}")
    else:
        ground = pen.group(left, 0.0)
        draw_seabed(ground, PICTURE, column.end)
        page.letters(left + PICTURE, column.end + 9.0, "seabed", size=FONT, colour=SOFT)


def _continued(page: Pen, x: float, top: float, left: float, words: str) -> None:
    """Where a line is parted: its two ends carry the same letter."""
    page.line(x, top, x, top + CONTINUED, stroke=INK, stroke_width=1.2, stroke_dasharray="2 2")
    page.draw(
        "rect", x=left + PICTURE - 4.0, y=top + 2.0, width=78.0, height=CONTINUED - 4.0,
        fill="white", stroke=INK, stroke_width=0.8,
    )  # fmt: skip
    page.letters(left + PICTURE, top + CONTINUED / 2, words, size=FONT, bold=True)


def _entry(
    page: Pen,
    pen: Pen,
    placed: PlacedEntry,
    x: float,
    left: float,
    rights: Sequence[float],
) -> None:
    entry, top, bottom = placed.entry, placed.top, placed.top + placed.height
    middle = (top + bottom) / 2
    group = pen.draw("g")
    if entry.cable is not None:
        draw_cable(group, entry.cable, x, top, bottom)
    else:
        group.line(x, top, x, bottom)
    if entry.clamped:
        clamp = group.group(x, middle)
        draw_clamp(clamp, _CLAMP_AT)
        figure_of(entry.sign).draw(clamp.group(_CLAMP_AT, 0.0, CLAMP_SCALE))
    elif entry.floats is not None:
        clamp = group.group(x, middle)
        draw_clamp(clamp, _CLAMP_AT)
        figure_of(entry.floats).draw(clamp.group(_CLAMP_AT, 0.0, CLAMP_SCALE))
    elif entry.sign.symbol not in LINES:
        figure_of(entry.sign).draw(group.group(x, middle, SYMBOL_SCALE))
    start = left + PICTURE + (INDENT if entry.clamped else 0.0)
    lines = [(text, INK, entry.strong, 0.0) for text in placed.label]
    lines += [(text, SOFT, False, placed.abreast) for text in placed.name]
    last = len(lines) - 1 - (placed.abreast > 0.0)
    ends = start
    for number, (text, colour, bold, aside) in enumerate(lines):
        below = LEADING * (min(number, last) - last / 2)
        place = start + aside
        page.letters(place, middle + below, text, size=FONT, colour=colour, bold=bold)
        if abs(below) < LEADING:
            ends = max(ends, place + text_width(text, FONT, bold=bold))
    _leaders(page, (x, start), (ends, rights[0] - FIGURES[0]), middle)
    for text, right in zip(entry.cells, rights, strict=True):
        page.letters(right, middle - LEADING * last / 2, text, size=FONT, anchor="end")


def _leaders(
    page: Pen, symbol: tuple[float, float], text: tuple[float, float], middle: float
) -> None:
    """Lead the eye from a symbol to its words, and from these to their figures."""
    for (left, right), room in ((symbol, 18.0), (text, 3.0)):
        if right - left > room + 5.0:
            page.line(
                left + room, middle, right - 3.0, middle, stroke=SOFT, stroke_width=0.6,
                stroke_dasharray="0.6 2.4",
            )  # fmt: skip


def _rights(paper: Paper, left: float) -> list[float]:
    """Right edges of the columns of figures."""
    right = left + paper.column_width
    return [right - sum(FIGURES[number + 1 :]) for number in range(len(FIGURES))]


def _legend(
    page: Pen,
    legend: Sequence[Sign],
    columns: Sequence[tuple[int, ColumnOf]],
    paper: Paper,
    bottom: float,
) -> None:
    """The symbols that are drawn, each in words, at the foot of the last column."""
    number = columns[-1][0]
    shared = len(columns) == paper.columns
    left = paper.left(number if shared else number + 1)
    rows = -(-len(legend) // _LEGEND_COLUMNS)
    top = bottom - rows * _LEGEND_ROW
    page.letters(left, top - LEADING, "Symbols", size=FONT, bold=True)
    pen = page.draw("g", stroke=INK, stroke_width=0.9, stroke_linejoin="round", fill=INK)
    step = paper.column_width / _LEGEND_COLUMNS
    for place, sign in enumerate(legend):
        x = left + 14.0 + step * (place % _LEGEND_COLUMNS)
        y = top + _LEGEND_ROW * (place // _LEGEND_COLUMNS) + _LEGEND_ROW / 2 - 3.0
        if sign.symbol in LINES:
            draw_cable(pen, sign.symbol, x, y - 9.0, y + 9.0)
        else:
            figure = figure_of(Sign(sign.symbol))
            figure.draw(pen.group(x, y, min(0.5, 20.0 / figure.height)))
        page.letters(x + 18.0, y, _WORDS[sign.symbol], size=FONT)


def _picture(width: float, height: float, title: str) -> Pen:
    element = ElementTree.Element(
        "svg",
        {
            "xmlns": "http://www.w3.org/2000/svg",
            "width": f"{width:g}pt",
            "height": f"{height:g}pt",
            "viewBox": f"0 0 {width:g} {height:g}",
            "role": "img",
            "font-family": _FONTS,
        },
    )
    pen = Pen(element)
    pen.title(title)
    pen.draw("rect", width=width, height=height, fill="white")
    return pen


def _written(picture: Pen) -> str:
    ElementTree.indent(picture.element)
    return ElementTree.tostring(picture.element, encoding="unicode") + "\n"


_FIELDS = (
    "mooring", "document", "revision", "date", "project", "ship", "cruise", "position",
    "water depth", "environment", "author", "checked", "approved", "anchor in air, in water",
    "least backup", "design check", "sheet",
)  # fmt: skip
_COLUMNS = {Paper.A4: 5, Paper.LETTER: 5, Paper.A3: 9}
_PAD = 4.0


def title_block_of(deck: Deck, paper: Paper) -> TitleBlock:
    """The title block of a mooring, without the number of its page."""
    known = {**dict(title_pairs(deck.file)), **_known(deck), "environment": deck.environment}
    columns = _COLUMNS[paper]
    room = (paper.size[0] - 2 * MARGIN) / columns - 2 * _PAD
    fields = [(name, tuple(wrapped(one_line(known.get(name, "")), room, FONT))) for name in _FIELDS]
    fields += [("", ())] * (-len(fields) % columns)
    rows = tuple(tuple(fields[start : start + columns]) for start in range(0, len(fields), columns))
    return TitleBlock(rows, columns, sum(map(_height, rows)))


def _known(deck: Deck) -> dict[str, str]:
    """The anchor's weights, what floats the release after the worst break, and the verdict."""
    anchor = deck.assessment.inventory[-1]
    for one in deck.assessment.inventory:
        if one.role == "anchor":
            anchor = one
    mass = "unknown" if anchor.dry_mass is None else say("dry_mass", anchor.dry_mass)
    weight = "unknown" if anchor.wet_weight is None else say("wet_weight", anchor.wet_weight)
    breaks = [one.margin for one in deck.assessment.backup if one.judged]
    return {
        "anchor in air, in water": f"{mass}, {weight}",
        "least backup": say("tension", min(breaks)) if breaks else "none",
        "design check": short_verdict(deck.assessment.all_findings()).text,
    }


def _height(row: tuple[tuple[str, tuple[str, ...]], ...]) -> float:
    return 8.0 + LEADING * max(1, *(len(lines) for _, lines in row)) + 3.0
