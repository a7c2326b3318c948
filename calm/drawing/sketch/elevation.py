"""A line from the side: in the current, in still water beside it, between surface and seabed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import hypot
from typing import TYPE_CHECKING

import numpy as np
from rich.cells import cell_len
from rich.text import Text

from calm.case import Result, TowResult
from calm.case.net_result import AnyResult, NetResult
from calm.drawing.line_picture import (
    LineKind,
    LinePicture,
    PictureMark,
    elevation_of,
    names,
    plane_of,
    spread,
)
from calm.drawing.schematic.pen import ELLIPSIS
from calm.drawing.sketch.canvas import AXIS, PlotFrame, header_rows, scaled_frame
from calm.quantities import bearing_of, bearing_text, say

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from calm.case.result_tables import Shape

    Floats = NDArray[np.float64]


LEAST_SPAN = 0.1
"""Share of the height that distances are drawn to at least: a line that stands looks as it does."""

_NAMED_FROM = 50
_SHARE_OF_NAMES = 0.36
_LONGEST_NAME = 22
_FARTHEST = 1.5
"""Rows that a name may stand from its part; where more names crowd, some are left out."""

_NEED = ("float", "release", "anchor", "instrument")


def elevation(
    result: AnyResult, width: int, height: int, beside: Sequence[Shape] = ()
) -> list[Text]:
    """A line in the vertical plane of its excursion, or of its tow, from 20 by 6 cells on.

    Distances are from the anchor towards the free end, or from the ship backward; their scale is
    not that of the depths. The line in still water is dotted. From 50 cells on parts are named.
    Shapes `beside` a mooring, of other environments or designs, are dashed.
    """
    side = elevation_of(result, beside)
    moored = not isinstance(result, TowResult)
    if moored:  # its seabed is the foot of the picture
        held = [line.y.min() for line in side.lines] if isinstance(result, NetResult) else []
        side = replace(side, top=float(min(0.0, *held, 0.0)), bottom=side.seabed or side.bottom)
    seabed = side.seabed if side.seabed is not None and side.seabed <= side.bottom else None
    head = header_rows(height)
    rows = height - head - 2
    named = _names(side, rows, int(_SHARE_OF_NAMES * width)) if width >= _NAMED_FROM else []
    room = max((cell_len(text) for _, text in named), default=-1) + 1
    across, down = _span(side), (side.top, side.bottom)
    unit = f"m to {bearing_text(bearing_of(*plane_of(result)))}" if moored else "m behind"
    caption, size = _caption(result), (width, height)
    frame = scaled_frame(size, caption, across, down, unit, "m", seabed=seabed, beside=room)
    if side.surface and side.top <= 0.0 <= side.bottom:
        frame.line([(across[0], 0.0), (across[1], 0.0)], SURFACE)
    draw_picture(frame, side)
    for row, text in named:
        frame.canvas.text(width - room + 1, head + row, text, AXIS)
    return frame.canvas.rows()


def draw_picture(frame: PlotFrame, picture: LinePicture) -> None:
    """Draw the lines, the ship and the marks of a picture."""
    for line in picture.lines:
        style, dash, gap = STROKES[line.kind]
        frame.line(zip(line.x.tolist(), line.y.tolist(), strict=True), style, dash=dash, gap=gap)
    if picture.ship is not None:
        frame.mark(*picture.ship, *SHIP)
    for role, (sign, style) in SIGNS.items():
        for mark in picture.marks:
            if mark.role == role:
                frame.mark(mark.x, mark.y, sign, style)


def _caption(result: AnyResult) -> str:
    """Return how deep and how far off the end is, in words."""
    if isinstance(result, NetResult):
        return f"net of {len(result.legs)} legs"
    if isinstance(result, Result):
        top = result.top
        offset = hypot(top.x, top.y)
        deep = "top afloat" if result.type == "surface" else f"top {say('depth', top.depth)}"
        towards = f" to {bearing_text(bearing_of(top.x, top.y))}" if offset >= 0.05 else ""
        return f"{deep}, {say('offset', offset)} off{towards}"
    body = result.body
    deep = say("depth", body.depth)
    if result.file.environment.fluid == "air":
        deep = f"{say('depth', body.depth + result.tow.keys.height)} below"
    return f"body {deep}, {say('layback', body.layback)} behind"


def _span(side: LinePicture) -> tuple[float, float]:
    """Return the distances at the edges; a line that hardly leans stands in the middle."""
    low, high = side.span()
    spare = max(LEAST_SPAN * (side.bottom - side.top) - (high - low), 0.0)
    margin = 0.04 * (high - low + spare) + spare / 2.0
    return low - margin, high + margin


def _names(side: LinePicture, rows: int, room: int) -> list[tuple[int, str]]:
    """Names of parts, each on a row of its own, near its part."""
    height = (side.bottom - side.top) / rows
    found = sorted(names(list(side.marks), height), key=lambda each: each[1].depth)
    while True:
        wanted = [(part.depth - side.top) / height - 0.5 for _, part in found]
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


def _least(found: list[tuple[str, PictureMark]], wanted: list[float], crowded: int) -> int:
    """Of the names around one the least needed: an instrument, the farthest from the others."""
    around = [i for i, row in enumerate(wanted) if abs(row - wanted[crowded]) <= 2.0 * _FARTHEST]
    middle = sum(around) / len(around)
    return min(around, key=lambda i: (-_NEED.index(found[i][1].role), abs(i - middle)))


LINE = "bold cyan"
STILL = "white"
OTHER = "magenta"
"""Of a line in another environment, or of another design, drawn beside."""
SURFACE = "blue"
LIMIT = "red"
SHIP = ("▲", "bold")

SIGNS = {
    "anchor": ("▼", "bold"),
    "float": ("●", "bold yellow"),
    "release": ("◆", "green"),
    "instrument": ("■", "red"),
}
"""Sign and style of each role, the first where it is and the others beside it."""

STROKES = {
    LineKind.LINE: (LINE, 0, 0),
    LineKind.STILL: (STILL, 1, 2),
    LineKind.BESIDE: (OTHER, 3, 2),
}
"""Style, dots drawn and dots left out of each kind of line."""
