"""Sketches beside the elevation: tension, the current by depth, the line from above."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot
from typing import TYPE_CHECKING

import numpy as np
from rich.text import Text

from calm.case import Result
from calm.case.net_result import AnyResult, NetResult
from calm.checks.posture import reaches_the_surface
from calm.checks.strength import allowable_load
from calm.drawing.graph.scale import number
from calm.drawing.line_picture import along_the_line, current_between, lines_of, plan_of
from calm.drawing.sketch.canvas import (
    ACROSS,
    AXIS,
    DOWN,
    header_rows,
    levels,
    scaled_frame,
)
from calm.drawing.sketch.elevation import LIMIT, LINE, STILL, SURFACE, draw_picture
from calm.quantities import bearing_of, bearing_text, say

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from calm.case import TowResult
    from calm.physics.line import Water

    Floats = NDArray[np.float64]
    from calm.case.result_tables import Shape


_FARTHEST = 2.5
"""Allowable loads are drawn up to this many times the greatest tension."""
_KILO = 1e4
"""Tensions are in kilonewtons from here on [N]."""


def tension(result: Result | TowResult, width: int, height: int) -> list[Text]:
    """Tension by the way along the line, as listed from the top, from 20 by 6 cells on.

    Dotted in red is what the weakest piece there may bear: its working load, or its breaking load
    over the safety factor that the design asks for. What bears far more than is drawn has no mark.
    """
    pulls, way = result.shape.tension, along_the_line(result.shape)
    if not isinstance(result, Result):  # listed from the ship down, its shape from the body up
        pulls, way = pulls[::-1], (way[-1] - way)[::-1]
    greatest = max(float(pulls.max()), 1e-9)
    loads = _allowable(result)
    near = [load for _, _, load in loads if load <= _FARTHEST * greatest]
    scale, unit = (1e-3, "kN") if greatest >= _KILO else (1.0, "N")
    across = 0.0, 1.08 * max([greatest, *near]) * scale
    length = max(float(way[-1]), 1e-9)
    caption = f"at most {say('tension', greatest)}{'; dotted: limits' if near else ''}"
    frame = scaled_frame((width, height), caption, across, (0.0, length), unit)
    before = 0.0
    for row, load in _weakest(loads, length, frame.rows * DOWN):
        if load <= _FARTHEST * greatest and (row % 2 == 0 or load != before):
            x, _ = frame.point(load * scale, 0.0)
            frame.canvas.dot(x, frame.row * DOWN + row, LIMIT)
        before = load
    frame.line(zip((pulls * scale).tolist(), way.tolist(), strict=True), LINE)
    return frame.canvas.rows()


def _allowable(result: Result | TowResult) -> list[tuple[float, float, float]]:
    """Start and end along the line [m] of each piece with a known limit, and that [N]."""
    factors = result.file.checks.safety_factor
    surface = isinstance(result, Result) and reaches_the_surface(result.mooring)
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
    depths, u, v = current_between(water, 0.0, water.depth)
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
            frame.canvas.text(width - beside + 1, row, _direction(east, north, beside), _STYLE)
    return frame.canvas.rows()


def _direction(u: float, v: float, room: int) -> str:
    """Return where it flows to: an arrow, and the degrees where there is room."""
    arrow = _ARROWS[round(np.degrees(np.arctan2(u, v)) / 45.0) % 8]
    return arrow if room == 2 else f"{bearing_text(bearing_of(u, v))}{arrow}"


_LEAST_SPAN = 1.0
_MARGIN = 0.06


def plan(result: AnyResult, width: int, height: int, beside: Sequence[Shape] = ()) -> list[Text]:
    """A line from above with its anchor, or the ship, at zero, from 20 by 6 cells on.

    Shapes `beside` it, of other environments or designs, are dashed.
    """
    shapes = [*(line.shape for line in lines_of(result)), *beside]
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
    frame = scaled_frame((width, height), _said(result), across, down, "m east", "m E")
    frame.line([(left, 0.0), (right, 0.0)], STILL, dash=1, gap=3)
    frame.line([(0.0, bottom), (0.0, top)], STILL, dash=1, gap=3)
    draw_picture(frame, plan_of(result, beside))
    frame.canvas.text(frame.column, frame.row, "N", AXIS)
    return frame.canvas.rows()


def _said(result: AnyResult) -> str:
    if isinstance(result, NetResult):
        return f"net of {len(result.legs)} legs"
    if isinstance(result, Result):
        x, y, what = result.top.x, result.top.y, "top"
    else:
        x, y, what = float(result.shape.x[0]), float(result.shape.y[0]), "end"
    distance = hypot(x, y)
    towards = f" to {bearing_text(bearing_of(x, y))}" if distance >= 0.05 else ""
    return f"{what} {say('offset', distance)} off{towards}"


def _ends(coordinates: Iterable[Floats]) -> list[float]:
    return [float(end) for each in coordinates for end in (each.min(), each.max())]


def _range(values: list[float]) -> tuple[float, float]:
    low, high = min(values), max(values)
    margin = _MARGIN * max(high - low, _LEAST_SPAN)
    return low - margin, high + margin


def _centred(low: float, high: float, span: float) -> tuple[float, float]:
    middle = (low + high) / 2.0
    return middle - span / 2.0, middle + span / 2.0
