"""A line from the side: in the current, in still water beside it, between surface and seabed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot
from typing import TYPE_CHECKING

import numpy as np
from rich.cells import cell_len
from rich.text import Text

from calm.case import Result
from calm.drawing.graph.scale import number, round_numbers
from calm.drawing.line_on_figure import Named, along, named_parts, names, spread
from calm.drawing.plot import levels_of, plane_of
from calm.drawing.schematic.pen import ELLIPSIS
from calm.drawing.sketch.canvas import AXIS, COLUMNS_PER_TICK, Canvas, PlotFrame, levels
from calm.quantities import bearing_of, bearing_text, say

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from calm.case import TowResult
    from calm.case.result_tables import Shape

    Floats = NDArray[np.float64]
    from calm.case import Result
    from calm.drawing.line_on_figure import Named


LEAST_SPAN = 0.1
"""Share of the height that distances are drawn to at least: a line that stands looks as it does."""

_NAMED_FROM = 50
_SHARE_OF_NAMES = 0.36
_LONGEST_NAME = 22
_FARTHEST = 1.5
"""Rows that a name may stand from its part; where more names crowd, some are left out."""

_NEED = ("float", "release", "anchor", "instrument")

Points = list[tuple[float, float]]


def elevation(
    result: Result | TowResult, width: int, height: int, beside: Sequence[Shape] = ()
) -> list[Text]:
    """A line in the vertical plane of its excursion, or of its tow, from 20 by 6 cells on.

    Distances are from the anchor towards the free end, or from the ship backward; their scale is
    not that of the depths. The line in still water is dotted. From 50 cells on parts are named.
    Shapes `beside` a mooring, of other environments or designs, are dashed.
    """
    view = _of_mooring(result, beside) if isinstance(result, Result) else _of_tow(result)
    canvas = Canvas(width, height)
    head = header_rows(height)
    if head:
        canvas.text(0, 0, view.said, AXIS)
    rows = height - head - 2
    values = levels(view.top, view.bottom, rows)
    foot = "m" if view.seabed is None else number(view.seabed)
    gutter = max(map(len, [foot, *map(number, values)]))
    named = _names(result, view, rows, int(_SHARE_OF_NAMES * width)) if width >= _NAMED_FROM else []
    room = max((cell_len(text) for _, text in named), default=-1) + 1
    low, high = _span(view)
    frame = PlotFrame.within(canvas, head, gutter, (low, high), (view.top, view.bottom), room)
    _draw_water(frame, view)
    frame.scale_down(values, gutter, foot)
    frame.scale_across(
        round_numbers(low, high, max(frame.columns // COLUMNS_PER_TICK, 2)), view.along, "m"
    )
    for other in view.beside:
        frame.line(other, OTHER, dash=3, gap=2)
    frame.line(view.still, STILL, dash=1, gap=2)
    frame.line(view.line, LINE)
    if view.ship is not None:
        frame.mark(*view.ship, *SHIP)
    mark_parts(frame, result, view.place)
    for row, text in named:
        canvas.text(width - room + 1, head + row, text, AXIS)
    return canvas.rows()


@dataclass(frozen=True)
class _View:
    """What is drawn: the plane, the depths of the edges, the line, and its captions."""

    plane: Floats
    top: float
    bottom: float
    seabed: float | None
    sea: bool
    line: Points
    still: Points
    beside: list[Points]
    ship: tuple[float, float] | None
    said: str
    along: str

    def place(self, part: Named) -> tuple[float, float]:
        """Distance and depth of a part."""
        return float(along(part.x, part.y, self.plane)), part.depth


def _of_mooring(result: Result, beside: Sequence[Shape]) -> _View:
    plane, top, depth = plane_of(result), result.top, result.mooring.water.depth
    still = result.still_shape
    moved = still is not None and still is not result.shape
    offset = hypot(top.x, top.y)
    deep = "top afloat" if result.type == "surface" else f"top {say('depth', top.depth)}"
    towards = f" to {bearing_text(bearing_of(top.x, top.y))}" if offset >= 0.05 else ""
    return _View(
        plane=plane,
        top=0.0,
        bottom=depth,
        seabed=depth,
        sea=True,
        line=_points(result.shape, plane),
        still=_points(still, plane) if still is not None and moved else [],
        beside=[_points(shape, plane) for shape in beside],
        ship=None,
        said=f"{deep}, {say('offset', offset)} off{towards}",
        along=f"m to {bearing_text(bearing_of(*plane))}",
    )


def _of_tow(result: TowResult) -> _View:
    heading = np.radians(result.toward)
    behind = -np.array([np.sin(heading), np.cos(heading)])
    top, bottom = levels_of(result)
    environment, body = result.file.environment, result.body
    seabed = environment.depth
    line = _points(result.shape, behind)
    deep = say("depth", body.depth)
    if environment.fluid == "air":
        deep = f"{say('depth', body.depth + result.tow.keys.height)} below"
    return _View(
        plane=behind,
        top=top,
        bottom=bottom,
        seabed=seabed if seabed is not None and seabed <= bottom else None,
        sea=environment.fluid == "water",
        line=line,
        still=[],
        beside=[],
        ship=line[-1],
        said=f"body {deep}, {say('layback', body.layback)} behind",
        along="m behind",
    )


def _points(shape: Shape, plane: Floats) -> Points:
    offset = along(shape.x, shape.y, plane)
    return list(zip(offset.tolist(), shape.depth.tolist(), strict=True))


def _span(view: _View) -> tuple[float, float]:
    """Distances at the edges; a line that hardly leaves the plumb stands in the middle."""
    offsets = [0.0, *(offset for line in (view.line, *view.beside) for offset, _ in line)]
    low, high = min(offsets), max(offsets)
    spare = max(LEAST_SPAN * (view.bottom - view.top) - (high - low), 0.0)
    margin = 0.04 * (high - low + spare) + spare / 2.0
    return low - margin, high + margin


def _draw_water(frame: PlotFrame, view: _View) -> None:
    """The surface, and what is below the frame: the seabed, or an edge."""
    canvas, (low, high) = frame.canvas, (frame.across.low, frame.across.high)
    if view.sea and view.top <= 0.0 <= view.bottom:
        frame.line([(low, 0.0), (high, 0.0)], SURFACE)
    below = frame.row + frame.rows
    sign, style = ("─", AXIS) if view.seabed is None else ("▒", SEABED)
    first = frame.column - (view.seabed is None)
    canvas.text(first, below, sign * (frame.column + frame.columns - first), style)


def _names(result: Result | TowResult, view: _View, rows: int, room: int) -> list[tuple[int, str]]:
    """Names of parts, each on a row of its own, near its part."""
    height = (view.bottom - view.top) / rows
    found = sorted(names(named_parts(result), height), key=lambda each: each[1].depth)
    while True:
        wanted = [(part.depth - view.top) / height - 0.5 for _, part in found]
        places = spread(wanted, 1.0, 0.0, rows - 1.0)
        strayed = [abs(place - each) for place, each in zip(places, wanted, strict=True)]
        if not found or max(strayed) <= _FARTHEST:
            break
        found.pop(_least(found, wanted, strayed.index(max(strayed))))
    longest = min(room, _LONGEST_NAME)
    return [
        (round(place), text if cell_len(text) <= longest else text[: longest - 1] + ELLIPSIS)
        for place, (text, _) in zip(places, found, strict=True)
    ]


def _least(found: list[tuple[str, Named]], wanted: list[float], crowded: int) -> int:
    """Of the names around one the least needed: an instrument, the farthest from the others."""
    around = [i for i, row in enumerate(wanted) if abs(row - wanted[crowded]) <= 2.0 * _FARTHEST]
    middle = sum(around) / len(around)
    return min(around, key=lambda i: (-_NEED.index(found[i][1].role), abs(i - middle)))


LINE = "bold cyan"
STILL = "white"
OTHER = "magenta"
"""Of a line in another environment, or of another design, drawn beside."""
SURFACE, SEABED = "blue", "yellow"
LIMIT = "red"
SHIP = ("▲", "bold")

SIGNS = {
    "anchor": ("▼", "bold"),
    "float": ("●", "bold yellow"),
    "release": ("◆", "green"),
    "instrument": ("■", "red"),
}
"""Sign and style of each role, the first where it is and the others beside it."""

_HEADED = 9


def header_rows(height: int) -> int:
    """Rows above a picture for what it says in words; none where it is low."""
    return int(height >= _HEADED)


def mark_parts(
    frame: PlotFrame, result: Result | TowResult, place: Callable[[Named], tuple[float, float]]
) -> None:
    """Mark floats, instruments, releases and the anchor, `place` giving both axes."""
    parts = named_parts(result)
    for role, (sign, style) in SIGNS.items():
        for part in parts:
            if part.role == role:
                frame.mark(*place(part), sign, style)
