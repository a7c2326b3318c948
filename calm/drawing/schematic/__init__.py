"""Drawing of the parts of a line in a column, with symbols, wrapped texts and values.

A schematic has one column, a mooring diagram several. Drawings are not to scale. Lengths are in
points (1/72 inch).
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from math import inf, isnan, log10
from typing import NamedTuple

from calm.case.design import AnyResult
from calm.drawing.schematic import symbols
from calm.drawing.schematic.pen import FAINT, INK, SOFT, Pen, picture, svg_text, text_width, wrapped
from calm.drawing.schematic.shown_parts import HEADINGS, Schematic, ShownPart, TextRow, schematic_of
from calm.drawing.schematic.symbols import LINES, SEABED_ROOM, draw_cable, draw_clamp, figure_of
from calm.files import MooringFile
from calm.quantities import QUANTITIES

FONT = 8.0
"""Text size, and minimum text size in a column."""
LEADING = 10.0
"""Distance between two lines of text."""
SYMBOL_SCALE, CLAMP_SCALE = 0.6, 0.42
HEAD = 38.0
"""Distance from the top of the column to the end of the headings."""
_PAD, _GAP, _INDENT = 4.0, 6.0, 10.0
_CLAMP_AT = 16.0
_SHORTEST, _PER_DECADE = 18.0, 9.0
_NEAR_THE_END = 0.3  # a group of parts may end within this last fraction of its height

# A4 leaves 180 by 267 mm; a long line is reduced to fit this height, but stays legible
_WIDTH, _MARGIN = 508.0, 3.0
_MILLIMETRE = 72.0 / 25.4
_PRINTED_HEIGHT, _LEAST_SCALE = 267.0 * _MILLIMETRE, 0.67
_TITLE, _TITLE_LEADING = 13.0, 16.0
_SHEAVE = 26.0 * SYMBOL_SCALE
# heights above the surface, or above the hook
_SKY, _MAST, _SHIP, _HELICOPTER = 8.0, 26.0, 30.0, 28.0
_SUBMERGED, _BELOW_BODY = 12.0, 14.0
_MOORED_AT, _TOWED_AT = 26.0, 46.0


def schematic_svg(file: MooringFile, result: AnyResult | None = None) -> str:
    """Draw the schematic of a line as one SVG picture.

    The picture of a line with more than about 50 parts is longer than an A4 page. The picture has
    no external references, identifiers or style sheets. Texts are never cut. The same line always
    gives the same picture.

    Without a result, the depths are those of the upright, unstretched line. The depths of a tow, or
    of a line that reaches the surface, are then unknown.
    """
    (drawn,) = _draw_sheets(schematic_of(file, result), inf)
    return drawn


def schematic_sheets(file: MooringFile, result: AnyResult | None = None) -> list[str]:
    """Draw the picture of `schematic_svg` on several sheets, each of which is legible on A4.

    The picture is cut only between parts, never through a part.
    """
    return _draw_sheets(schematic_of(file, result), _PRINTED_HEIGHT / _LEAST_SCALE)


def _draw_sheets(shown: Schematic, most: float) -> list[str]:
    """Draw the sheets of a schematic; `most` is the maximum height of a sheet."""
    rows = [row for part in shown.parts for row in part.rows]
    rows += [row for row in (shown.towed_by, shown.sea, shown.seabed) if row is not None]
    headings = [(*HEADINGS[name], QUANTITIES[name].display_unit) for name in shown.columns]
    column = column_of(rows, headings, _WIDTH, _TOWED_AT if shown.towed_by else _MOORED_AT)
    room = _WIDTH - 2 * _MARGIN
    words = [(text, _TITLE, INK) for text in wrapped(shown.title, room, _TITLE, bold=True)]
    words += [(text, FONT, SOFT) for text in wrapped(shown.subtitle, room, FONT)]
    head = _MARGIN + sum(_TITLE_LEADING if size > FONT else LEADING for _, size, _ in words)
    notes = wrapped(shown.note, room, FONT)
    ends = _MAST + _SHIP + SEABED_ROOM + LEADING * (1 + len(notes))  # above and below the line
    groups = _equal_groups(measured(shown.parts, column), most - head - HEAD - ends)
    sheets = []
    for number, group in enumerate(groups):
        first, last = number == 0, number + 1 == len(groups)
        surface, line = _place_on_sheet(shown, group, head + HEAD, first=first)
        if shown.towed_by is not None and last:
            *others, body = line
            line = (*others, replace(body, ends=(body.ends[0], body.middle)))
        bottom = line[-1].top + line[-1].height + (_BELOW_BODY if shown.towed_by else 0.0)
        foot = bottom + (SEABED_ROOM if shown.seabed and last else 0.0) + LEADING
        height = foot + LEADING * len(notes)
        scale = min(max(_PRINTED_HEIGHT / height, _LEAST_SCALE), 1.0) / _MILLIMETRE
        printed = f"{_WIDTH * scale:.2f}mm", f"{height * scale:.2f}mm"
        page = picture(_WIDTH, height, shown.title, printed)
        y = _MARGIN
        for text, size, colour in words:
            leading = _TITLE_LEADING if size > FONT else LEADING
            page.letters(_MARGIN, y + leading / 2, text, size=size, colour=colour, bold=size > FONT)
            y += leading
        draw_headings(page, column, 0.0, head)
        _draw_scene(page, shown, column, (surface, bottom), first=first, last=last)
        draw_parts(page, line, column, 0.0)
        for place, text in enumerate(notes):
            page.letters(_MARGIN, foot + LEADING * place, text, size=FONT, colour=SOFT)
        sheets.append(svg_text(page))
    return sheets


def _equal_groups(parts: Sequence[PlacedPart], room: float) -> list[list[PlacedPart]]:
    """Divide parts into groups of about equal height.

    There are as few groups as possible for a height of `room` per group.
    """
    fewest = len([*divided(parts, room)])
    each = sum(one.height for one in parts) / fewest
    while len(groups := [*divided(parts, each)]) > fewest:
        each += LEADING
    return groups


def _place_on_sheet(
    shown: Schematic, parts: Sequence[PlacedPart], top: float, *, first: bool
) -> tuple[float, tuple[PlacedPart, ...]]:
    """Place the parts of one sheet; return the vertical position of the surface, and the parts.

    Under a helicopter, the returned position is that of the hook. On every sheet but the first, it
    is the top of the sheet.
    """
    if not first:
        return top, placed(parts, top)
    middle = parts[0].height / 2
    if shown.towed_by is None:
        surface = top + (_MAST if shown.surface else _SKY)
        start = surface - middle if shown.surface else surface + _SUBMERGED
        return surface, placed(parts, start, start + middle)
    if shown.sea is None:
        surface = line_top = start = top + _HELICOPTER
    else:
        surface = top + _SHIP
        line_top, start = surface - _SHEAVE, surface + _SUBMERGED
    return surface, placed(parts, start, line_top)


def _draw_scene(
    page: Pen,
    shown: Schematic,
    column: LineColumn,
    levels: tuple[float, float],
    *,
    first: bool,
    last: bool,
) -> None:
    surface, bottom = levels
    if shown.sea is not None and first:
        draw_sea(page, column, 0.0, levels, None if shown.surface else shown.sea)
    elif shown.sea is not None:
        symbols.draw_water(page.group(0.0, 0.0), 2.0 * column.line_at, *levels)
    if shown.seabed is not None and last:
        draw_ground(page, column, 0.0, bottom, shown.seabed)
    if shown.towed_by is not None and first:
        pen = page.draw("g", stroke=INK, stroke_width=1.2)
        if shown.sea is None:
            symbols.draw_helicopter(pen.group(column.line_at, surface, SYMBOL_SCALE))
        else:
            symbols.draw_ship(pen.group(column.line_at, surface - _SHEAVE, SYMBOL_SCALE))
        draw_row(page, column, 0.0, surface - _SHEAVE, shown.towed_by)


@dataclass(frozen=True)
class LineColumn:
    """Layout of a column: positions of the line, the texts and the values [pt].

    Attributes
    ----------
    headings : text lines of each heading, with the unit last
    rights : right edge of each column of values
    text : left and right edge of the texts
    line_at : distance of the line from the left edge
    """

    width: float
    headings: tuple[Sequence[str], ...]
    rights: tuple[float, ...]
    text: tuple[float, float]
    line_at: float


def column_of(
    parts: Iterable[TextRow],
    headings: Sequence[tuple[str, ...]],
    width: float,
    line_at: float = 26.0,
) -> LineColumn:
    """Compute the layout of a column; each column of values is as wide as its widest entry.

    `line_at` is the distance of the line from the left edge. The symbols have this much space on
    each side of the line.
    """
    cells = [[*heading] for heading in headings]
    for row in parts:
        for texts, text in zip(cells, row.cells, strict=False):
            texts.append(text)
    figures = [max(text_width(text, FONT) for text in texts) + _GAP for texts in cells]
    lefts = [*accumulate(reversed(figures), lambda left, each: left - each, initial=width)]
    rights = tuple(reversed(lefts[:-1]))
    return LineColumn(width, tuple(headings), rights, (2.0 * line_at + 4.0, lefts[-1]), line_at)


class TextLine(NamedTuple):
    """A line of text next to a part, with its values and an optional text to the side.

    `side_text` begins at the distance `at` from the left edge of `text`.
    """

    text: str
    colour: str = INK
    bold: bool = False
    side_text: str = ""
    at: float = 0.0
    cells: tuple[str, ...] = ()

    @property
    def width(self) -> float:
        """Width of the line of text."""
        side_text = self.at + text_width(self.side_text, FONT) if self.side_text else 0.0
        return max(text_width(self.text, FONT, bold=self.bold), side_text)


@dataclass(frozen=True)
class PlacedPart:
    """A part with its position in the picture and its texts.

    The line is drawn through the part, between the two vertical positions in `ends`.
    """

    part: ShownPart
    top: float
    height: float
    lines: tuple[TextLine, ...]
    ends: tuple[float, float] = (0.0, 0.0)

    @property
    def middle(self) -> float:
        """Vertical position of the symbol."""
        return self.top + self.height / 2


def measured(
    parts: Sequence[ShownPart], column: LineColumn, growth: float = 1.0
) -> list[PlacedPart]:
    """Compute the height of each part, before the parts are placed.

    The height of a cable increases with the logarithm of the cable length. The increase per decade
    is multiplied by `growth`.
    """
    found = [_measured(part, column) for part in parts]
    for number, one in enumerate(found):
        if one.part.cable is not None and not one.part.clamped and not isnan(one.part.length):
            wanted = _SHORTEST + growth * _PER_DECADE * log10(max(one.part.length, 1.0))
            for other in found[number + 1 :]:
                if not other.part.clamped:
                    break
                wanted -= other.height
            found[number] = replace(one, height=max(one.height, wanted))
    return found


def _measured(part: ShownPart, column: LineColumn) -> PlacedPart:
    left, right = column.text
    room = right - left - _GAP - (_INDENT if part.clamped else 0.0)
    lines = tuple(line for row in part.rows for line in _text_lines(row, room))
    height = LEADING * len(lines) + _PAD
    if part.sign.symbol in LINES:
        height = max(height, _SHORTEST)
    else:
        scale = CLAMP_SCALE if part.clamped else SYMBOL_SCALE
        height = max(height, scale * figure_of(part.sign).height + 3.0)
    return PlacedPart(part, 0.0, height, lines)


def _text_lines(row: TextRow, room: float) -> list[TextLine]:
    at = text_width(row.label, FONT, bold=row.strong) + 6.0
    if at + text_width(row.name, FONT) <= room and row.label.isascii():
        return [TextLine(row.label, INK, row.strong, row.name, at, row.cells)]
    lines = [
        TextLine(text, INK, row.strong) for text in wrapped(row.label, room, FONT, bold=row.strong)
    ]
    lines += [TextLine(text, SOFT) for text in wrapped(row.name, room, FONT)]
    return [lines[0]._replace(cells=row.cells), *lines[1:]] if lines else [TextLine("")]


def divided(parts: Sequence[PlacedPart], room: float) -> Iterator[list[PlacedPart]]:
    """Divide parts into groups at most `room` high.

    A group ends above a junction, if one is near the end of the group. Otherwise the group ends
    between two pieces or, failing that, between two clamps.
    """
    rest = [*parts]
    while rest:
        heights = [*accumulate(one.height for one in rest)]
        fits = max(bisect_right(heights, room), 1)
        if fits < len(rest):
            least = (1.0 - _NEAR_THE_END) * room
            near = [
                each for each in range(fits, 0, -1) if each == fits or heights[each - 1] >= least
            ]
            next_parts = {each: rest[each].part for each in near}
            fits = min(near, key=lambda at: (not next_parts[at].junction, next_parts[at].clamped))
        yield rest[:fits]
        rest = rest[fits:]


def placed(
    parts: Sequence[PlacedPart], top: float, line_top: float | None = None
) -> tuple[PlacedPart, ...]:
    """Place parts one below the other, beginning at `top`.

    The line begins at `line_top`, which by default is `top`.
    """
    tops = accumulate((part.height for part in parts), initial=top)
    found = [
        replace(part, top=at, ends=(at, at + part.height))
        for part, at in zip(parts, tops, strict=False)
    ]
    if line_top is not None:
        found[0] = replace(found[0], ends=(line_top, found[0].ends[1]))
    return tuple(found)


def draw_headings(page: Pen, column: LineColumn, left: float, top: float) -> None:
    """Write the headings of the values, aligned at their last lines, above a horizontal rule."""
    for lines, right in zip(column.headings, column.rights, strict=True):
        for number, word in enumerate(reversed(lines)):
            y = top + HEAD - 8.0 - 9.4 * number
            page.letters(left + right, y, word, size=FONT, colour=SOFT, anchor="end")
    page.line(left, top + HEAD - 2.0, left + column.width, top + HEAD - 2.0, stroke=FAINT)


def draw_sea(
    page: Pen, column: LineColumn, left: float, levels: tuple[float, float], row: TextRow | None
) -> None:
    """Draw the water between two levels, and the sea surface with an optional row of text."""
    pen = page.group(left, 0.0)
    symbols.draw_water(pen, 2.0 * column.line_at, *levels)
    symbols.draw_surface(pen, 2.0 * column.line_at, levels[0])
    if row is not None:
        draw_row(page, column, left, levels[0], row)


def draw_ground(page: Pen, column: LineColumn, left: float, y: float, row: TextRow) -> None:
    """Draw the seabed with its row of text."""
    symbols.draw_seabed(page.group(left, 0.0, stroke=INK), 2.0 * column.line_at, y)
    draw_row(page, column, left, y + SEABED_ROOM / 2 + 1.0, row)


def draw_row(page: Pen, column: LineColumn, left: float, y: float, row: TextRow) -> None:
    """Write a row of text that belongs to no part, with its values."""
    page.letters(left + column.text[0], y, row.label, size=FONT, colour=SOFT)
    for text, right in zip(row.cells, column.rights, strict=False):
        page.letters(left + right, y, text, size=FONT, colour=SOFT, anchor="end")


def draw_parts(page: Pen, parts: Sequence[PlacedPart], column: LineColumn, left: float) -> None:
    """Draw the line with its symbols and texts; `left` is the left edge of the column."""
    pen = page.draw("g", stroke=INK, stroke_width=0.9, stroke_linejoin="round", fill=INK)
    for part in parts:
        draw_symbol(pen.draw("g"), part, left + column.line_at)
    for part in parts:
        _draw_texts(page, part, column, left)


def draw_symbol(pen: Pen, one: PlacedPart, x: float) -> None:
    """Draw the line through a part, and its symbol or its clamps."""
    part = one.part
    if part.labels:
        pen.title(", ".join(part.labels))
    if part.cable is not None:
        draw_cable(pen, part.cable, x, *one.ends)
    else:
        pen.line(x, one.ends[0], x, one.ends[1])
    if part.clamped:
        clamp = pen.group(x, one.middle)
        draw_clamp(clamp, _CLAMP_AT)
        figure_of(part.sign).draw(clamp.group(_CLAMP_AT, 0.0, CLAMP_SCALE))
    elif part.sign.symbol not in LINES:
        figure_of(part.sign).draw(pen.group(x, one.middle, SYMBOL_SCALE))


def _draw_texts(page: Pen, one: PlacedPart, column: LineColumn, left: float) -> None:
    start = left + column.text[0] + (_INDENT if one.part.clamped else 0.0)
    levels = [
        one.middle + LEADING * (number - (len(one.lines) - 1) / 2)
        for number in range(len(one.lines))
    ]
    for line, y in zip(one.lines, levels, strict=True):
        page.letters(start, y, line.text, size=FONT, colour=line.colour, bold=line.bold)
        page.letters(start + line.at, y, line.side_text, size=FONT, colour=SOFT)
    for line, y in zip(one.lines, levels, strict=True):
        for text, right in zip(line.cells, column.rights, strict=False):
            page.letters(left + right, y, text, size=FONT, anchor="end")
    near = (
        line.width
        for line, y in zip(one.lines, levels, strict=True)
        if abs(y - one.middle) < LEADING
    )
    ends = start + max(near)
    for begin, end in (
        (left + column.line_at + 18.0, start - 3.0),
        (ends + 3.0, left + column.text[1] - 3.0),
    ):
        if end - begin > 2.0:
            page.line(
                begin, one.middle, end, one.middle, stroke=SOFT, stroke_width=0.6,
                stroke_dasharray="0.6 2.4",
            )  # fmt: skip
