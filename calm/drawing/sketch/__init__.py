"""A solved line for a terminal: from the side and above, its tension, the current by depth.

Each picture is drawn with braille dots, a text for each row of any number of cells. From 20 by 6
cells on it shows a scale; more room shows more.
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
from calm.drawing.sketch.canvas import ACROSS, AXIS, DOWN, header_rows, levels, scaled_frame
from calm.physics.line import Floats, Water
from calm.quantities import bearing_of, bearing_text, say

_LEAST_SPAN = 0.1
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
    """A line in the vertical plane of its excursion, or of its tow.

    Distances are from the anchor towards the free end, or from the ship backward; their scale is
    not that of the depths. The line in still water is dotted. From 50 cells on parts are named.
    Shapes `beside` a mooring, of other environments or designs, are dashed.
    """
    side = line_picture.elevation_of(result, beside)
    moored = not result.towed
    if moored:  # its seabed is the foot of the picture
        held = [line.y.min() for line in side.lines] if result.several else []
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
    """Return how deep and how far off the end is, in words."""
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
    """Return how far off the end is and where to; of several legs how many there are."""
    if result.several:
        return f"net of {len(result.legs)} legs"
    (leg,) = result.legs
    free = leg.shape  # which begins at the free end
    x, y = (float(free.x[0]), float(free.y[0])) if leg.towed else (leg.top.x, leg.top.y)
    distance = hypot(x, y)
    towards = f" to {bearing_text(bearing_of(x, y))}" if distance >= 0.05 else ""
    return f"{say('offset', distance)} off{towards}"


def _span(side: LinePicture) -> tuple[float, float]:
    """Return the distances at the edges; a line that hardly leans stands in the middle."""
    low, high = side.span()
    spare = max(_LEAST_SPAN * (side.bottom - side.top) - (high - low), 0.0)
    margin = 0.04 * (high - low + spare) + spare / 2.0
    return low - margin, high + margin


def _names(side: LinePicture, rows: int, room: int) -> list[tuple[int, str]]:
    """Names of parts, each on a row of its own, near its part."""
    height = (side.bottom - side.top) / rows
    found = sorted(line_picture.names(list(side.marks), height), key=lambda each: each[1].depth)
    while True:
        wanted = [(part.depth - side.top) / height - 0.5 for _, part in found]
        places = line_picture.spread(wanted, 1.0, 0.0, rows - 1.0)
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
    LineKind.SEABED: (canvas.SEABED, 0, 0),
}
"""Style, dots drawn and dots left out of each kind of line."""


_HIGHEST_LOAD = 2.5
"""Allowable loads are drawn up to this many times the greatest tension."""
_KILO = 1e4
"""Tensions are in kilonewtons from here on [N]."""


def tension(result: LegResult, width: int, height: int) -> list[Text]:
    """Tension by the way along the line, as listed from the top.

    Dotted in red is what the weakest piece there may bear: its working load, or its breaking load
    over the safety factor that the design asks for. What bears far more than is drawn has no mark.
    """
    pulls, way = result.shape.tension, along_the_line(result.shape)
    if result.towed:  # listed from the ship down, its shape from the body up
        pulls, way = pulls[::-1], (way[-1] - way)[::-1]
    greatest = max(float(pulls.max()), 1e-9)
    loads = _allowable(result)
    near = [load for _, _, load in loads if load <= _HIGHEST_LOAD * greatest]
    scale, unit = (1e-3, "kN") if greatest >= _KILO else (1.0, "N")
    across = 0.0, 1.08 * max([greatest, *near]) * scale
    length = max(float(way[-1]), 1e-9)
    caption = f"at most {say('tension', greatest)}{'; dotted: limits' if near else ''}"
    frame = scaled_frame((width, height), caption, across, (0.0, length), unit)
    before = 0.0
    for row, load in _weakest(loads, length, frame.rows * DOWN):
        if load <= _HIGHEST_LOAD * greatest and (row % 2 == 0 or load != before):
            x, _ = frame.point(load * scale, 0.0)
            frame.canvas.dot(x, frame.row * DOWN + row, LIMIT)
        before = load
    frame.line(zip((pulls * scale).tolist(), way.tolist(), strict=True), LINE)
    return frame.canvas.rows()


def _allowable(result: LegResult) -> list[tuple[float, float, float]]:
    """Start and end along the line [m] of each piece with a known limit, and that [N]."""
    factors = result.file.checks.safety_factor
    surface = not result.towed and reaches_the_surface(result.leg)
    found, start = [], 0.0
    for piece, length in zip(result.file.pieces, result.components.length.tolist(), strict=True):
        load = allowable_load(piece.component, factors, surface)
        if load is not None and piece.component.kind != "anchor":
            found.append((start, start + length, load))
        start += length
    return found


def _weakest(
    loads: list[tuple[float, float, float]], length: float, dots: int
) -> list[tuple[int, float]]:
    """For each dot down the line the least of the limits there."""
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
    """Speed by depth with the directions beside it, from 12 by 6 cells on.

    Depths are on the rows where `elevation` of the same height has them.
    """
    beside = 6 if width >= _DEGREES_FROM else 2
    depths, u, v = line_picture.current_between(water, 0.0, water.depth)
    speeds = np.hypot(u, v)
    fastest = float(speeds.max())
    across = 0.0, 1.08 * fastest if fastest > 0.0 else 1.0
    frame = scaled_frame(
        (width, height), "current, m/s" if fastest > 0.0 else "still water", across,
        (0.0, water.depth), "" if header_rows(height) else "m/s", seabed=water.depth,
        beside=beside, per_tick=_COLUMNS_PER_TICK,
    )  # fmt: skip
    frame.line([(0.0, 0.0), (across[1], 0.0)], SURFACE)
    frame.line(zip(speeds.tolist(), depths.tolist(), strict=True), _STYLE)
    for value in levels(0.0, water.depth, frame.rows):
        _, row = frame.cell(0.0, value)
        east, north = (float(np.interp(value, depths, each)) for each in (u, v))
        if hypot(east, north) > 0.0:
            way = _ARROWS[round(np.degrees(np.arctan2(east, north)) / 45.0) % 8]
            way = f"{bearing_text(bearing_of(east, north))}{way}" if beside > 2 else way
            frame.canvas.text(width - beside + 1, row, way, _STYLE)
    return frame.canvas.rows()


_LEAST_RANGE = 1.0  # metres
_MARGIN = 0.06


def plan(result: AnyResult, width: int, height: int, beside: Sequence[Shape] = ()) -> list[Text]:
    """A line from above with its anchor, or the ship, at zero.

    Shapes `beside` it, of other environments or designs, are dashed.
    """
    shapes = [*(leg.shape for leg in result.legs), *beside]
    rows = height - header_rows(height) - 2
    west, east = _range([0.0, *_ends(each.x for each in shapes)])
    south, north = _range([0.0, *_ends(each.y for each in shapes)])
    gutter = 1
    for _ in range(2):  # the numbers beside it take room, which changes them
        columns = width - gutter - 1
        metres = max((east - west) / (columns * ACROSS), (north - south) / (rows * DOWN))
        bottom, top = _centred(south, north, metres * rows * DOWN)
        gutter = max(map(len, map(number, levels(bottom, top, rows))))
    left, right = _centred(west, east, metres * (width - gutter - 1) * ACROSS)
    across, down = (left, right), (top, bottom)
    what = "" if result.several else "end " if result.towed else "top "
    said = f"{what}{_distance(result)}"
    frame = scaled_frame((width, height), said, across, down, "m east", "m E")
    frame.line([(left, 0.0), (right, 0.0)], STILL, dash=1, gap=3)
    frame.line([(0.0, bottom), (0.0, top)], STILL, dash=1, gap=3)
    draw_picture(frame, line_picture.plan_of(result, beside))
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
