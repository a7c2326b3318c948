"""Figures of a design check.

The figures are the elevation of the mooring, the load chart, and the symbols of the line in table
rows. The figures are black, grey and white, so that no information depends on colour. Lengths are
in points.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from calm.case.leg_result import LegResult
from calm.drawing.graph import number, round_numbers
from calm.drawing.line_picture import along, plane_of_legs
from calm.drawing.schematic import CLAMP_SCALE, SYMBOL_SCALE, PlacedPart, draw_symbol
from calm.drawing.schematic.pen import Pen, picture, shortened, svg_text, text_width
from calm.drawing.schematic.shown_parts import ShownPart
from calm.drawing.schematic.symbols import (
    BALLS,
    LINES,
    Symbol,
    draw_surface,
    figure_of,
)
from calm.physics.line import Floats
from calm.quantities import QUANTITIES

FONT = 8.0
"""Font size of all texts."""
ROW_WIDTH = 52.0
"""Width of the line symbols in table rows."""
INK, GREY, PALE = "black", "#6e6e6e", "#cdcdcd"

_LEFT = 28.0  # width of the depth axis
_FLOW = 38.0  # width of the current profile
_SYMBOLS = 44.0
_ABOVE, _BELOW = 14.0, 10.0
_NEAREST = 9.5  # smallest distance of two labels
_LEAST = 0.45  # smallest share of the height used for the water depth


@dataclass(frozen=True)
class DrawnCase:
    """A load case in the drawing: its code and the results for its legs."""

    code: str
    legs: Sequence[LegResult]


@dataclass(frozen=True)
class Label:
    """Label of a part, next to the line.

    `at` is the depth, and the position to the east and north [m]; None for a cable. `tag` is the
    mark and number of the open item on the part.
    """

    part: ShownPart
    text: str
    depth: str
    at: tuple[float, float, float] | None
    tag: str = ""


def grey(svg: str) -> str:
    """Replace the colours of a drawing with greys of equal luminance."""

    def of(match: re.Match[str]) -> str:
        red, green, blue = (int(match[1][at : at + 2], 16) for at in (0, 2, 4))
        light = round(0.299 * red + 0.587 * green + 0.114 * blue)
        return f"#{light:02x}{light:02x}{light:02x}"

    return re.sub(r"#([0-9a-f]{6})\b", of, svg)


def elevation(
    title: str, cases: Sequence[DrawnCase], labels: Sequence[Label], size: tuple[float, float]
) -> tuple[str, float]:
    """Draw the elevation of the mooring as SVG; also return the scale of the axes [m per point].

    All load cases are projected onto one vertical plane. The first load case determines this plane,
    and is drawn as a thick line. The labels are on the right, in order of depth. If a wide mooring
    leaves no space for labels, the parts are only marked on the line.
    """
    width, height = size
    page = picture(width, height, title)
    legs = cases[0].legs
    plane = plane_of_legs(legs)
    lines = {
        case.code: [(along(leg.shape.x, leg.shape.y, plane), leg.shape.depth) for leg in case.legs]
        for case in cases
    }
    reach = np.concatenate([x for one in lines.values() for x, _ in one])
    depth = max(float(leg.water.depth) for leg in legs)
    rise = max(0.0, -min(float(y.min()) for one in lines.values() for _, y in one))
    tall = height - _ABOVE - _BELOW
    span = float(np.ptp(reach))
    listed = [*labels[: int((height - _ABOVE) / _NEAREST)]]
    flow = _LEFT + _FLOW
    upright = (depth + rise) / tall
    beside = width - flow - _SYMBOLS
    room = beside - min(_longest(listed), max(beside - span / upright, _LEAST_LABELS))
    scale = max(upright, span / max(room, 1.0))
    if depth / scale < _LEAST * tall:  # too wide for labels next to it
        listed, flow, room = [], _LEFT, width - _LEFT - 8.0
        scale = max((depth + rise) / tall, span / room)
    sea = _ABOVE + rise / scale
    start = flow + max(0.5 * (room - span / scale), 0.0) * (not listed)

    def x(value: Floats | float) -> Floats:
        return np.asarray(start + (value - float(reach.min())) / scale)

    def y(value: Floats | float) -> Floats:
        return np.asarray(sea + value / scale)

    edge = width if not listed else flow + room
    page.line(_LEFT, sea, edge, sea, stroke=INK, stroke_width=0.9)
    bed = float(y(depth))
    page.line(_LEFT, bed, edge, bed, stroke=INK, stroke_width=0.9)
    for count in range(int((edge - _LEFT) / 6.0)):
        left = _LEFT + 6.0 * count
        page.line(left + 4.0, bed, left, bed + 4.5, stroke=INK, stroke_width=0.4)
    for level in round_numbers(0.0, depth, max(2, min(7, int(depth / scale / 12.0)))):
        at = float(y(level))
        page.line(_LEFT - 3.0, at, _LEFT, at, stroke=INK, stroke_width=0.5)
        page.letters(_LEFT - 5.0, at, number(level), size=FONT, colour=INK, anchor="end")
    if listed:
        _draw_flow(page, legs[0], sea, scale)
    for code, drawn in reversed(lines.items()):
        stroke = _STROKES.get("first" if code == cases[0].code else code[-1], _THIN)
        for across, below in drawn:
            points = " L".join(f"{a:.1f} {b:.1f}" for a, b in zip(x(across), y(below), strict=True))
            page.path(f"M{points}", fill="none", **stroke)
    marks = [one for one in labels if one.at is not None]
    for one in marks:
        assert one.at is not None
        level, east, north = one.at
        px, py = float(x(along(east, north, plane))), float(y(level))
        hollow = one.part.sign.symbol in _HOLLOW
        if one in listed:
            drop = _level(listed.index(one), len(listed), height)
            knee = flow + room + 6.0
            page.path(f"M{px:.1f} {py:.1f}L{knee:.1f} {drop:.1f}L{knee + 12.0:.1f} {drop:.1f}",
                      fill="none", stroke=GREY, stroke_width=0.35)  # fmt: skip
        page.circle(px, py, 1.9, fill="white" if hollow else INK, stroke=INK, stroke_width=0.6)
    if listed:
        _draw_labelled_line(page, listed, flow + room + 28.0, width, height)
    return grey(svg_text(page)), scale


_THIN: dict[str, float | str] = {"stroke": GREY, "stroke_width": 0.5}
_STROKES: dict[str, dict[str, float | str]] = {
    "first": {"stroke": INK, "stroke_width": 1.2},
    "s": {"stroke": INK, "stroke_width": 0.7, "stroke_dasharray": "1 1.6"},
    "0": {"stroke": GREY, "stroke_width": 0.7, "stroke_dasharray": "4 2"},
}
"""Line styles of load cases, by the last letter of the case code."""
_HOLLOW = (*BALLS, Symbol.SPHERE, Symbol.FOAM, Symbol.STREAMLINED, Symbol.BUOY)
_FIGURES, _GAP = 26.0, 6.0
_LEAST_LABELS = 138.0
"""Minimum width for labels next to a wide mooring; shorter labels take only their own width."""
_REAL = 0.82
"""Assumed width of a text, as a fraction of the upper bound from `text_width`. In DejaVu Sans, the
widest substitute font, the fraction is up to 0.88; the space before the depths suffices for this.
"""
_MOST_LEVELS = 7


def _longest(labels: Sequence[Label]) -> float:
    widths = (text_width(f"{one.text} {one.tag}", FONT, bold=True) for one in labels)
    return _REAL * max(widths, default=0.0) + _FIGURES + _GAP


def _level(place: int, count: int, height: float) -> float:
    return _ABOVE + (place + 0.5) * (height - _ABOVE) / count


def _draw_flow(page: Pen, leg: LegResult, sea: float, scale: float) -> None:
    speed = np.hypot(leg.water.u, leg.water.v)
    fastest = float(speed.max())
    if fastest == 0.0:
        return
    across = _LEFT + 4.0 + speed / fastest * (_FLOW - 20.0)
    level = np.clip(leg.water.level, 0.0, leg.water.depth)
    down = sea + level / scale
    points = " L".join(f"{a:.1f} {b:.1f}" for a, b in zip(across, down, strict=True))
    page.path(f"M{points}", fill="none", stroke=GREY, stroke_width=0.8)
    last = -np.inf
    for x, y, value in zip(across.tolist(), down.tolist(), speed.tolist(), strict=True):
        if y - last < max(1.4 * FONT, (down[-1] - down[0]) / _MOST_LEVELS):
            continue
        last = y
        page.line(_LEFT + 2.0, y, x, y, stroke=GREY, stroke_width=0.6)
        page.path(f"M{x - 4.0:.1f} {y - 1.7:.1f}L{x:.1f} {y:.1f}L{x - 4.0:.1f} {y + 1.7:.1f}Z",
                  fill=GREY)  # fmt: skip
        unit = f" {QUANTITIES['speed'].display_unit}" if y == down[0] else ""
        text = QUANTITIES["speed"].format(value) + unit
        page.letters(x + 1.5, y - 5.0, text, size=FONT, colour=INK)


def _draw_labelled_line(
    page: Pen, labels: Sequence[Label], at: float, width: float, height: float
) -> None:
    pitch = (height - _ABOVE) / len(labels)
    levels = [_level(number, len(labels), height) for number in range(len(labels))]
    pen = page.draw("g", stroke=INK, stroke_width=0.9, stroke_linejoin="round", fill=INK)
    pen.line(at, levels[0], at, levels[-1])
    left = at + 20.0
    for one, y in zip(labels, levels, strict=True):
        sign = one.part.sign
        if sign.symbol not in LINES:
            figure = figure_of(sign)
            scale = min(CLAMP_SCALE, (pitch - 1.0) / figure.height)
            figure.draw(pen.group(at, y, scale))
        room = width - left - _FIGURES
        bold = one.at is not None
        tag = f" {one.tag}" if one.tag else ""
        text = shortened(one.text, room / _REAL - text_width(tag, FONT, bold=bold), FONT, bold=bold)
        style = {} if bold else {"font_style": "italic"}
        page.draw("g", **style).letters(left, y, text + tag, size=FONT, bold=bold)
        page.letters(width, y, one.depth, size=FONT, anchor="end")


class PieceBar(NamedTuple):
    """A piece in the load chart, with its tensions and capacities in the unit of the chart.

    `launch` and `launch_capacity` are the tension and capacity during the launch. Unknown values
    are None. `judged` is true if the capacity of the piece is checked.
    """

    number: int
    tension: float
    capacity: float | None
    launch: float | None
    launch_capacity: float | None
    judged: bool


def load_chart(title: str, loads: Sequence[PieceBar], size: tuple[float, float]) -> str:
    """Draw tension and capacity of every piece as SVG, with the top of the line on the left.

    `size` is the width and height of the chart.
    """
    width, height = size
    page = picture(width, height, title)
    left, top, bottom = 24.0, 8.0, height - 12.0
    highest = 1.3 * max(max(one.tension, one.launch or 0.0) for one in loads) or 1.0
    step = (width - left - 4.0) / max(len(loads), 1)

    def y(value: float) -> float:
        return bottom - min(value / highest, 1.0) * (bottom - top)

    for level in round_numbers(0.0, highest, 4):
        page.line(left, y(level), width, y(level), stroke=PALE, stroke_width=0.4)
        page.letters(left - 4.0, y(level), number(level), size=FONT, colour=INK, anchor="end")
    named = -1e9
    for place, one in enumerate(loads):
        capacity, falls, tension = one.capacity, one.launch, one.tension
        most = None if one.launch_capacity == capacity else one.launch_capacity
        x = left + 3.0 + place * step
        middle = x + 0.37 * step
        if falls:
            page.box(middle, (y(falls) + bottom) / 2, 0.74 * step, bottom - y(falls), fill=PALE)
        page.box(middle, (y(tension) + bottom) / 2, 0.4 * step, bottom - y(tension), fill=INK)
        for load, dashes in ((capacity, "none"), (most, "1.2 1.2")):
            if load is not None and load <= highest:
                page.line(x - 0.06 * step, y(load), x + 0.82 * step, y(load), stroke=INK,
                          stroke_width=1.3, stroke_dasharray=dashes)  # fmt: skip
        if one.judged and capacity is None:
            page.letters(middle, top - 3.0, "?", size=FONT, bold=True, anchor="middle")
        elif capacity is not None and capacity > highest:
            page.path(f"M{middle - 2:.1f} {top - 1:.1f}h4l-2 -3.4Z", fill=INK)
        if x - named >= 11.0:
            named = x
            page.letters(
                middle, bottom + 7.0, str(one.number), size=FONT, colour=INK, anchor="middle"
            )
    return grey(svg_text(page))


def beside_row(part: ShownPart, height: float, *, first: bool = False, last: bool = False) -> str:
    """Draw the line and the symbol of a part as SVG, for a table row.

    If `first` is true, the line begins at the symbol. If `last` is true, the line ends at the
    symbol.
    """
    page = _row_picture(height, ", ".join(part.labels))
    middle = height / 2
    ends = middle if first else 0.0, middle if last else height
    pen = page.draw("g", stroke=INK, stroke_width=0.9, stroke_linejoin="round", fill=INK)
    draw_symbol(pen, PlacedPart(part, 0.0, height, (), ends), ROW_WIDTH / 2)
    return grey(svg_text(page))


def _row_picture(height: float, title: str) -> Pen:
    page = picture(ROW_WIDTH, height, title)
    page.element.remove(page.element[-1])  # a background would hide the rules of the table
    return page


def surface_row(height: float) -> str:
    """Draw the sea surface as SVG, for a table row."""
    page = _row_picture(height, "sea surface")
    draw_surface(page, ROW_WIDTH, height / 2)
    return grey(svg_text(page))


def seabed_row(height: float) -> str:
    """Draw the seabed as SVG, for a table row."""
    page = _row_picture(height, "seabed")
    page.line(0.0, 1.0, ROW_WIDTH, 1.0, stroke=INK, stroke_width=0.9)
    for at in range(int(ROW_WIDTH / 6.0)):
        page.line(6.0 * at + 4.0, 1.0, 6.0 * at, 6.0, stroke=INK, stroke_width=0.4)
    return grey(svg_text(page))


def row_height(part: ShownPart) -> float:
    """Return the minimum height of a table row with the symbol of a part."""
    if part.sign.symbol in LINES:
        return 19.0
    scale = CLAMP_SCALE if part.clamped else SYMBOL_SCALE
    return max(13.0, scale * figure_of(part.sign).height + 2.0)
