"""Drawings of a solved line in a terminal: side view, plan, tension, and current by depth.

A drawing is a list of texts, one for each terminal row. Lines are drawn with braille dots. A
drawing with scales needs at least 20 by 6 cells.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from math import hypot

import numpy as np
from rich.cells import cell_len
from rich.text import Text

from calm.case.design import AnyResult
from calm.case.leg_result import LegResult
from calm.case.result_tables import Shape
from calm.checks.posture import reaches_the_surface
from calm.checks.strength import allowable_load
from calm.drawing import line_picture
from calm.drawing.graph import number
from calm.drawing.line_picture import LineKind, LinePicture, PictureMark, along_the_line, plane_of
from calm.drawing.schematic.pen import ELLIPSIS
from calm.drawing.sketch import canvas
from calm.drawing.sketch.canvas import (
    AXIS,
    DOTS_ACROSS,
    DOTS_DOWN,
    header_rows,
    levels,
    scaled_frame,
)
from calm.physics.line import Floats, Water
from calm.quantities import bearing_of, bearing_text, say

_LEAST_SPAN = 0.1
"""Minimum horizontal range, as a fraction of the height of the picture.

With a smaller range, a vertical line would not look vertical.
"""

_NAMED_FROM = 50
_SHARE_OF_NAMES = 0.36
_LONGEST_NAME = 22
_FARTHEST = 1.5
"""Maximum distance of a name from its part [rows].

A name that cannot be placed within this distance is omitted.
"""

_NEED = ("float", "release", "anchor", "instrument")


def elevation(
    result: AnyResult, width: int, height: int, overlays: Sequence[Shape] = ()
) -> list[Text]:
    """Draw a side view of a line, in the vertical plane of its excursion or of the tow.

    Distances are from the anchor towards the free end, or from the ship backward. Horizontal and
    vertical scales differ. The line in still water is dotted; `overlays` are dashed. Names of parts
    need a width of 50 cells.
    """
    side = line_picture.elevation_of(result, overlays)
    moored = not result.towed
    if moored:  # the seabed of a mooring is the foot of the picture
        held = [line.y.min() for line in side.lines] if result.several else []
        side = replace(side, top=float(min(0.0, *held, 0.0)), bottom=side.seabed or side.bottom)
    seabed = side.seabed if side.seabed is not None and side.seabed <= side.bottom else None
    head = header_rows(height)
    rows = height - head - 2
    named = _placed_names(side, rows, int(_SHARE_OF_NAMES * width)) if width >= _NAMED_FROM else []
    room = max((cell_len(text) for _, text in named), default=-1) + 1
    across, down = _span(side), (side.top, side.bottom)
    unit = f"m to {bearing_text(bearing_of(*plane_of(result)))}" if moored else "m behind"
    caption, size = _caption(result), (width, height)
    frame = scaled_frame(size, caption, across, down, unit, "m", seabed=seabed, margin=room)
    if side.surface and side.top <= 0.0 <= side.bottom:
        frame.line([(across[0], 0.0), (across[1], 0.0)], SURFACE)
    draw_picture(frame, side)
    for row, text in named:
        frame.canvas.text(width - room + 1, head + row, text, AXIS)
    return frame.canvas.rows()


def draw_picture(frame: canvas.PlotFrame, picture: LinePicture) -> None:
    """Draw the lines, the ship and the marks of a picture."""
    for line in picture.lines:
        frame.line(zip(line.x.tolist(), line.y.tolist(), strict=True), *STROKES[line.kind])
    if picture.ship is not None:
        frame.mark(*picture.ship, *SHIP)
    for role, (sign, style) in SIGNS.items():
        for mark in picture.marks:
            if mark.role == role:
                frame.mark(mark.x, mark.y, sign, style)


def _caption(result: AnyResult) -> str:
    if result.several:
        return _distance(result)
    (leg,) = result.legs
    if leg.body is None:
        deep = "top afloat" if leg.type == "surface" else f"top {say('depth', leg.top.depth)}"
        return f"{deep}, {_distance(result)}"
    deep = say("depth", leg.body.depth)
    if leg.file.tow is not None and leg.file.environment.fluid == "air":
        deep = f"{say('depth', leg.body.depth + leg.file.tow.height)} below"
    return f"body {deep}, {say('layback', leg.body.layback)} behind"


def _distance(result: AnyResult) -> str:
    if result.several:
        return f"net of {len(result.legs)} legs"
    (leg,) = result.legs
    free = leg.shape  # the shape begins at the free end
    x, y = (float(free.x[0]), float(free.y[0])) if leg.towed else (leg.top.x, leg.top.y)
    distance = hypot(x, y)
    towards = f" to {bearing_text(bearing_of(x, y))}" if distance >= 0.05 else ""
    return f"{say('offset', distance)} off{towards}"


def _span(side: LinePicture) -> tuple[float, float]:
    low, high = side.span()
    spare = max(_LEAST_SPAN * (side.bottom - side.top) - (high - low), 0.0)
    margin = 0.04 * (high - low + spare) + spare / 2.0
    return low - margin, high + margin


def _placed_names(side: LinePicture, rows: int, room: int) -> list[tuple[int, str]]:
    """Choose a row for each name, and omit names until all other names are close to their parts."""
    height = (side.bottom - side.top) / rows
    found = sorted(line_picture.names(list(side.marks), height), key=lambda each: each[1].depth)
    while True:
        wanted = [(part.depth - side.top) / height - 0.5 for _, part in found]
        places = line_picture.spread(wanted, 1.0, 0.0, rows - 1.0)
        strayed = [abs(place - each) for place, each in zip(places, wanted, strict=True)]
        if not found or max(strayed) <= _FARTHEST:
            break
        found.pop(_least_needed(found, wanted, strayed.index(max(strayed))))
    longest = min(room, _LONGEST_NAME)
    return [
        (round(place), text if cell_len(text) <= longest else text[: longest - 1] + ELLIPSIS)
        for place, (text, _) in zip(places, found, strict=True)
    ]


def _least_needed(found: list[tuple[str, PictureMark]], wanted: list[float], crowded: int) -> int:
    """Return the index of the name to omit among crowded names.

    Names of instruments are omitted first. Among names of equal role, the name closest to the
    middle is omitted.
    """
    around = [i for i, row in enumerate(wanted) if abs(row - wanted[crowded]) <= 2.0 * _FARTHEST]
    middle = sum(around) / len(around)
    return min(around, key=lambda i: (-_NEED.index(found[i][1].role), abs(i - middle)))


LINE = "bold cyan"
STILL = "white"
OTHER = "magenta"
"""Style of a comparison line: in another environment, or of another design."""
SURFACE = "blue"
LIMIT = "red"
SHIP = ("▲", "bold")

SIGNS = {
    "anchor": ("▼", "bold"),
    "float": ("●", "bold yellow"),
    "release": ("◆", "green"),
    "instrument": ("■", "red"),
}
"""Character and style of each role."""

STROKES = {
    LineKind.LINE: (LINE, 0, 0),
    LineKind.STILL: (STILL, 1, 2),
    LineKind.BESIDE: (OTHER, 3, 2),
    LineKind.SEABED: (canvas.SEABED, 0, 0),
}
"""Style, dash length and gap length [dots] for each kind of line."""


_HIGHEST_LOAD = 2.5
"""Maximum allowable load that is drawn, relative to the maximum tension."""
_KILO = 1e4
"""Tension at which the labels change from newtons to kilonewtons [N]."""


def tension(result: LegResult, width: int, height: int) -> list[Text]:
    """Draw the tension against the distance along the line from its top.

    A red dotted line shows the allowable load. This is the working load, or the breaking load
    divided by the required safety factor. Allowable loads far above the tension are not drawn.
    """
    pulls, along = result.shape.tension, along_the_line(result.shape)
    if result.towed:  # pieces are listed from the ship down, while the shape begins at the body
        pulls, along = pulls[::-1], (along[-1] - along)[::-1]
    greatest = max(float(pulls.max()), 1e-9)
    loads = _allowable_loads(result)
    near = [load for _, _, load in loads if load <= _HIGHEST_LOAD * greatest]
    scale, unit = (1e-3, "kN") if greatest >= _KILO else (1.0, "N")
    across = 0.0, 1.08 * max([greatest, *near]) * scale
    length = max(float(along[-1]), 1e-9)
    caption = f"at most {say('tension', greatest)}{'; dotted: limits' if near else ''}"
    frame = scaled_frame((width, height), caption, across, (0.0, length), unit)
    before = 0.0
    for row, load in _least_load_by_row(loads, length, frame.rows * DOTS_DOWN):
        if load <= _HIGHEST_LOAD * greatest and (row % 2 == 0 or load != before):
            x, _ = frame.point(load * scale, 0.0)
            frame.canvas.dot(x, frame.row * DOTS_DOWN + row, LIMIT)
        before = load
    frame.line(zip((pulls * scale).tolist(), along.tolist(), strict=True), LINE)
    return frame.canvas.rows()


def _allowable_loads(result: LegResult) -> list[tuple[float, float, float]]:
    """Return start [m], end [m] and allowable load [N] of each piece with a known load."""
    factors = result.file.checks.safety_factor
    surface = not result.towed and reaches_the_surface(result.leg)
    found, start = [], 0.0
    for piece, length in zip(result.file.pieces, result.components.length.tolist(), strict=True):
        load = allowable_load(piece.component, factors, surface)
        if load is not None and piece.component.kind != "anchor":
            found.append((start, start + length, load))
        start += length
    return found


def _least_load_by_row(
    loads: list[tuple[float, float, float]], length: float, dots: int
) -> list[tuple[int, float]]:
    least: dict[int, float] = {}
    for start, end, load in loads:
        first, last = (round(each / length * (dots - 1)) for each in (start, min(end, length)))
        for row in range(first, last + 1):
            least[row] = min(load, least.get(row, load))
    return sorted(least.items())


_STYLE = "bold blue"
_ARROWS = "↑↗→↘↓↙←↖"
_COLUMNS_PER_TICK = 7
_DEGREES_FROM = 18


def current_profile(water: Water, width: int, height: int) -> list[Text]:
    """Draw speed and direction of the current against depth, in at least 12 by 6 cells.

    Each depth is on the same row as in an `elevation` of equal height.
    """
    margin = 6 if width >= _DEGREES_FROM else 2
    depths, u, v = line_picture.current_between(water, 0.0, water.depth)
    speeds = np.hypot(u, v)
    fastest = float(speeds.max())
    across = 0.0, 1.08 * fastest if fastest > 0.0 else 1.0
    frame = scaled_frame(
        (width, height), "current, m/s" if fastest > 0.0 else "still water", across,
        (0.0, water.depth), "" if header_rows(height) else "m/s", seabed=water.depth,
        margin=margin, per_tick=_COLUMNS_PER_TICK,
    )  # fmt: skip
    frame.line([(0.0, 0.0), (across[1], 0.0)], SURFACE)
    frame.line(zip(speeds.tolist(), depths.tolist(), strict=True), _STYLE)
    for value in levels(0.0, water.depth, frame.rows):
        _, row = frame.cell(0.0, value)
        east, north = (float(np.interp(value, depths, each)) for each in (u, v))
        if hypot(east, north) > 0.0:
            arrow = _ARROWS[round(np.degrees(np.arctan2(east, north)) / 45.0) % 8]
            arrow = f"{bearing_text(bearing_of(east, north))}{arrow}" if margin > 2 else arrow
            frame.canvas.text(width - margin + 1, row, arrow, _STYLE)
    return frame.canvas.rows()


_LEAST_RANGE = 1.0  # metres
_MARGIN = 0.06


def plan(result: AnyResult, width: int, height: int, overlays: Sequence[Shape] = ()) -> list[Text]:
    """Draw a line from above, with the anchor or the ship at the origin.

    `overlays` are shapes in other environments or of other designs, which are dashed.
    """
    shapes = [*(leg.shape for leg in result.legs), *overlays]
    rows = height - header_rows(height) - 2
    west, east = _range([0.0, *_ends(each.x for each in shapes)])
    south, north = _range([0.0, *_ends(each.y for each in shapes)])
    gutter = 1
    for _ in range(2):  # the width of the numbers affects the scale and the numbers
        columns = width - gutter - 1
        metres = max((east - west) / (columns * DOTS_ACROSS), (north - south) / (rows * DOTS_DOWN))
        bottom, top = _centred(south, north, metres * rows * DOTS_DOWN)
        gutter = max(map(len, map(number, levels(bottom, top, rows))))
    left, right = _centred(west, east, metres * (width - gutter - 1) * DOTS_ACROSS)
    across, down = (left, right), (top, bottom)
    what = "" if result.several else "end " if result.towed else "top "
    title = f"{what}{_distance(result)}"
    frame = scaled_frame((width, height), title, across, down, "m east", "m E")
    frame.line([(left, 0.0), (right, 0.0)], STILL, dash=1, gap=3)
    frame.line([(0.0, bottom), (0.0, top)], STILL, dash=1, gap=3)
    draw_picture(frame, line_picture.plan_of(result, overlays))
    frame.canvas.text(frame.column, frame.row, "N", AXIS)
    return frame.canvas.rows()


def _ends(coordinates: Iterable[Floats]) -> list[float]:
    return [float(end) for each in coordinates for end in (each.min(), each.max())]


def _range(values: list[float]) -> tuple[float, float]:
    low, high = min(values), max(values)
    margin = _MARGIN * max(high - low, _LEAST_RANGE)
    return low - margin, high + margin


def _centred(low: float, high: float, span: float) -> tuple[float, float]:
    middle = (low + high) / 2.0
    return middle - span / 2.0, middle + span / 2.0
