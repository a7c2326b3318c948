"""The schematic of a line: an SVG picture, in order from the top and not to scale."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from calm.drawing.schematic.line_column import (
    FONT,
    HEAD,
    LEADING,
    SYMBOL_SCALE,
    ColumnHead,
    LineColumn,
    PlacedPart,
    column_of,
    draw_ground,
    draw_headings,
    draw_parts,
    draw_row,
    draw_sea,
    measured,
    placed,
)
from calm.drawing.schematic.pen import INK, SOFT, Pen, picture, svg_text, wrapped
from calm.drawing.schematic.shown_parts import HEADINGS, Schematic, schematic_of
from calm.drawing.schematic.symbols import SEABED_ROOM, draw_helicopter, draw_ship
from calm.quantities import QUANTITIES

if TYPE_CHECKING:
    from calm.case import Result, TowResult
    from calm.files import MooringFile

# A4 leaves 180 by 267 mm; a long line is drawn smaller to fit its height, but no smaller than can
# be read.
_WIDTH, _MARGIN = 508.0, 3.0
_MILLIMETRE = 72.0 / 25.4
_PRINTED_HEIGHT, _LEAST_SCALE = 267.0 * _MILLIMETRE, 0.67
_TITLE, _TITLE_LEADING = 13.0, 16.0
_SKY, _MAST, _SHIP, _HELICOPTER = 8.0, 26.0, 30.0, 28.0  # above the surface, or the hook
_SHEAVE = 26.0 * SYMBOL_SCALE
_SUBMERGED, _BELOW_BODY = 12.0, 14.0
_MOORED_AT, _TOWED_AT = 26.0, 46.0


def schematic_svg(file: MooringFile, result: Result | TowResult | None = None) -> str:
    """A line as an SVG picture; it prints on A4 up to some 50 parts, beyond on a longer sheet.

    It refers to nothing outside and has neither identifiers nor style sheets, so that it can stand
    in a page beside others. No text is cut: long ones wrap. The same line gives the same text.

    Parameters
    ----------
    file : MooringFile
        The line as read.
    result : Result or TowResult, optional
        Its solution, which shows depths under load and in the current. Without it depths are those
        of the upright, unstretched line; unknown in a tow and of a float at the surface.
    """
    shown = schematic_of(file, result)
    column = _column(shown)
    room = _WIDTH - 2 * _MARGIN
    words = [(text, _TITLE, INK) for text in wrapped(shown.title, room, _TITLE, bold=True)]
    words += [(text, FONT, SOFT) for text in wrapped(shown.subtitle, room, FONT)]
    head = _MARGIN + sum(_TITLE_LEADING if size > FONT else LEADING for _, size, _ in words)
    surface, line = _hung(shown, column, head + HEAD)
    bottom = line[-1].top + line[-1].height + (_BELOW_BODY if shown.towed_by else 0.0)
    foot = bottom + (SEABED_ROOM if shown.seabed else 0.0) + LEADING
    notes = wrapped(shown.note, room, FONT)
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
    _draw_scene(page, shown, column, surface, bottom)
    draw_parts(page, line, column, 0.0)
    for number, text in enumerate(notes):
        page.letters(_MARGIN, foot + LEADING * number, text, size=FONT, colour=SOFT)
    return svg_text(page)


def _column(shown: Schematic) -> LineColumn:
    rows = [row for part in shown.parts for row in part.rows]
    rows += [row for row in (shown.towed_by, shown.sea, shown.seabed) if row is not None]
    headings = [ColumnHead(HEADINGS[name], QUANTITIES[name].display_unit) for name in shown.columns]
    return column_of(rows, headings, _WIDTH, _TOWED_AT if shown.towed_by else _MOORED_AT)


def _hung(shown: Schematic, column: LineColumn, top: float) -> tuple[float, tuple[PlacedPart, ...]]:
    """The level of the sea surface, or of a helicopter's hook, and the parts below it."""
    parts = measured(shown.parts, column)
    if shown.towed_by is None:
        middle = parts[0].height / 2
        surface = top + (_MAST if shown.surface else _SKY)
        start = surface - middle if shown.surface else surface + _SUBMERGED
        return surface, placed(parts, start, start + middle)
    if shown.sea is None:
        surface = hung = start = top + _HELICOPTER
    else:
        surface = top + _SHIP
        hung, start = surface - _SHEAVE, surface + _SUBMERGED
    *others, last = placed(parts, start, hung)
    return surface, (*others, replace(last, ends=(last.ends[0], last.middle)))


def _draw_scene(
    page: Pen, shown: Schematic, column: LineColumn, surface: float, bottom: float
) -> None:
    """Water, surface and seabed, and what tows, with their texts."""
    if shown.sea is not None:
        draw_sea(page, column, 0.0, (surface, bottom), None if shown.surface else shown.sea)
    if shown.seabed is not None:
        draw_ground(page, column, 0.0, bottom, shown.seabed)
    if shown.towed_by is not None:
        pen = page.draw("g", stroke=INK, stroke_width=1.2)
        if shown.sea is None:
            draw_helicopter(pen.group(column.line_at, surface, SYMBOL_SCALE))
        else:
            draw_ship(pen.group(column.line_at, surface - _SHEAVE, SYMBOL_SCALE))
        draw_row(page, column, 0.0, surface - _SHEAVE, shown.towed_by)
