"""The schematic of a line: an SVG picture, in order from the top and not to scale."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree

from calm.drawing.schematic.pen import FAINT, INK, SOFT, Pen
from calm.drawing.schematic.shown_parts import HEADINGS, Clamped, Schematic, TextRow, schematic_of
from calm.drawing.schematic.symbols import (
    draw_cable,
    draw_clamp,
    draw_helicopter,
    draw_leader,
    draw_seabed,
    draw_ship,
    draw_surface,
    draw_water,
    figure_of,
)
from calm.drawing.schematic.text_layout import (
    FONT,
    LINE,
    LINE_AT,
    PICTURE,
    SHEAVE,
    SMALL,
    Columns,
    SchematicLayout,
    TextPlace,
    indented,
    layout_of,
)
from calm.quantities import QUANTITIES

if TYPE_CHECKING:
    from calm.case import Result, TowResult
    from calm.files import MooringFile

# Millimetres of a unit of the page: A4 leaves 15 mm at each side, and a long line is drawn smaller
# to fit its height, but no smaller than can be read.
_LEAST_SCALE, _GREATEST_SCALE = 0.18, 0.25
_PRINTED_HEIGHT = 267.0
_FONTS = "Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif"
_TITLE = 16.0
_MARGIN = 6.0
_TITLE_AT, _SUBTITLE_AT, _HEADS_AT, _RULE_AT = 12.0, 32.0, (50.0, 61.0, 72.0), 80.0
_CLAMP_AT, _CLAMP_HEIGHT, _CLAMP_SCALE = 24.0, 13.5, 0.8
_TO_TEXT = 5.0


def schematic_svg(file: MooringFile, result: Result | TowResult | None = None) -> str:
    """A line as an SVG picture; it prints on A4 up to some 50 parts, beyond on a longer sheet.

    It refers to nothing outside and has neither identifiers nor style sheets, so that it can stand
    in a page beside others. A label or name too long for its column is cut, and has the whole for
    its title. The same line gives the same text.

    Parameters
    ----------
    file : MooringFile
        The line as read.
    result : Result or TowResult, optional
        Its solution, which shows depths under load and in the current. Without it depths are those
        of the upright, unstretched line; unknown in a tow and of a float at the surface.
    """
    schematic = schematic_of(file, result)
    layout = layout_of(schematic)
    page = _page(schematic.title, layout)
    _draw_scene(page, schematic, layout)
    for place in layout.places:
        _draw_place(page, place, layout)
    _write_head(page, schematic, layout.columns)
    _write_scene(page, schematic, layout)
    for place in layout.places:
        _write_place(page, place, layout.columns)
    ElementTree.indent(page.element)
    return ElementTree.tostring(page.element, encoding="unicode") + "\n"


def _page(title: str, layout: SchematicLayout) -> Pen:
    width, height = layout.columns.width + 2 * _MARGIN, layout.height
    scale = min(max(_PRINTED_HEIGHT / height, _LEAST_SCALE), _GREATEST_SCALE)
    element = ElementTree.Element(
        "svg",
        {
            "xmlns": "http://www.w3.org/2000/svg",
            "width": f"{width * scale:.2f}mm",
            "height": f"{height * scale:.2f}mm",
            "viewBox": f"{-_MARGIN:g} 0 {width:.2f} {height:.2f}",
            "role": "img",
            "font-family": _FONTS,
        },
    )
    page = Pen(element)
    page.title(title)
    page.draw("rect", x=-_MARGIN, width=width, height=height, fill="white")
    return page


def _draw_scene(page: Pen, schematic: Schematic, layout: SchematicLayout) -> None:
    """Water, surface and seabed, and what tows."""
    pen = page.draw("g", stroke=INK, stroke_width=1.2, stroke_linejoin="round")
    if schematic.sea is not None:
        draw_water(pen, PICTURE, layout.surface, layout.bottom)
        draw_surface(pen, PICTURE, layout.surface)
    if schematic.seabed is not None:
        draw_seabed(pen, PICTURE, layout.bottom)
    if schematic.towed_by is None:
        return
    if schematic.sea is None:
        draw_helicopter(pen.group(LINE_AT, layout.surface))
    else:
        draw_ship(pen.group(LINE_AT, layout.surface - SHEAVE))


def _draw_place(page: Pen, place: TextPlace, layout: SchematicLayout) -> None:
    """A part, the line through it, and what is clamped on it."""
    pen = page.draw("g", stroke=INK, stroke_width=1.2, stroke_linejoin="round", fill=INK)
    pen.title(", ".join(place.part.labels))
    sign = place.part.sign
    first, last = place is layout.places[0], place is layout.places[-1]
    top = layout.hung if first else place.top
    if place.figure is None:
        draw_cable(pen, sign.symbol, LINE_AT, top, place.bottom)
        reach = 3.0
    else:
        pen.line(LINE_AT, top, LINE_AT, place.middle if last else place.bottom)
        place.figure.draw(pen.group(LINE_AT, place.middle))
        reach = place.figure.reach
    for y in place.rows:
        draw_leader(pen, LINE_AT + reach + 3.0, layout.columns.label[0] - _TO_TEXT, y)
    for clamp, y in zip(place.part.clamps, place.clamps, strict=True):
        _draw_clamped(pen, clamp, y, layout.columns)


def _draw_clamped(pen: Pen, clamp: Clamped, y: float, columns: Columns) -> None:
    figure = figure_of(clamp.sign)
    scale = min(_CLAMP_SCALE, _CLAMP_HEIGHT / figure.height)
    group = pen.group(LINE_AT, y)
    group.title(clamp.row.label)
    draw_clamp(group, _CLAMP_AT)
    figure.draw(group.group(_CLAMP_AT, 0.0, scale))
    start = LINE_AT + _CLAMP_AT + scale * figure.reach + 3.0
    draw_leader(pen, start, indented(columns)[0] - _TO_TEXT, y)


def _write_head(page: Pen, schematic: Schematic, columns: Columns) -> None:
    """Title and headings."""
    width = columns.width
    page.write(0.0, _TITLE_AT, schematic.title, width, size=_TITLE, bold=True)
    page.write(0.0, _SUBTITLE_AT, schematic.subtitle, width, size=SMALL, colour=SOFT)
    for name, (right, room) in zip(schematic.columns, columns.figures, strict=True):
        lines = (*HEADINGS[name], QUANTITIES[name].display_unit)
        for text, y in zip(lines, _HEADS_AT, strict=True):
            page.write(right, y, text, room, size=SMALL, colour=SOFT, anchor="end")
    page.line(0.0, _RULE_AT, width, _RULE_AT, stroke=FAINT)


def _write_scene(page: Pen, schematic: Schematic, layout: SchematicLayout) -> None:
    """The texts at the ship, the sea surface and the seabed, and the note below."""
    if schematic.towed_by is not None:
        above = SHEAVE - 4.0 if schematic.sea else 20.0
        _write_row(page, schematic.towed_by, layout.surface - above, layout.columns, SOFT)
    if schematic.sea is not None and not schematic.surface:
        _write_row(page, schematic.sea, layout.surface, layout.columns, SOFT)
    if schematic.seabed is not None:
        _write_row(page, schematic.seabed, layout.bottom + LINE / 2, layout.columns, SOFT)
    y = layout.height - SMALL
    page.write(0.0, y, schematic.note, layout.columns.width, size=SMALL, colour=SOFT)


def _write_place(page: Pen, place: TextPlace, columns: Columns) -> None:
    for row, y in zip(place.part.rows, place.rows, strict=True):
        _write_row(page, row, y, columns)
    for clamp, y in zip(place.part.clamps, place.clamps, strict=True):
        _write_row(page, clamp.row, y, columns, at=indented(columns))


def _write_row(
    page: Pen,
    row: TextRow,
    y: float,
    columns: Columns,
    colour: str = INK,
    at: tuple[float, float] | None = None,
) -> None:
    """Label, name and figures of a row, `at` the left edge and width of the label."""
    left, width = at or columns.label
    page.write(left, y, row.label, width, size=FONT, colour=colour, bold=row.strong)
    page.write(columns.name[0], y, row.name, columns.name[1], size=FONT, colour=SOFT)
    for text, (right, room) in zip(row.cells, columns.figures, strict=True):
        page.write(right, y, text, room, size=FONT, colour=colour, anchor="end")
