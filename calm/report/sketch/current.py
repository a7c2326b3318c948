"""The current by depth: how fast it flows, and where to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.text import Text

from calm.quantities import bearing_of, bearing_text
from calm.report.graph.ticks import number, round_numbers
from calm.report.sketch.canvas import Canvas
from calm.report.sketch.frame import AXIS, Frame, levels
from calm.report.sketch.parts import SEABED, SURFACE, header_rows

if TYPE_CHECKING:
    from calm.physics.line import Water

_STYLE = "bold blue"
_ARROWS = "↑↗→↘↓↙←↖"
_COLUMNS_PER_TICK = 7
_DEGREES_FROM = 18
_SAMPLES = 200


def current_profile(water: Water, width: int, height: int) -> list[Text]:
    """Speed by depth with the directions beside it, from 12 by 6 cells on.

    Depths are on the rows where `elevation` of the same height has them.
    """
    canvas = Canvas(width, height)
    head = header_rows(height)
    rows = height - head - 2
    values, foot = levels(0.0, water.depth, rows), number(water.depth)
    gutter = max(map(len, [foot, *map(number, values)]))
    beside = 6 if width >= _DEGREES_FROM else 2
    depths = np.union1d(np.linspace(0.0, water.depth, _SAMPLES), water.level)
    depths = depths[(depths >= 0.0) & (depths <= water.depth)]
    velocity, _ = water.at(depths)
    speeds = np.hypot(velocity[:, 0], velocity[:, 1])
    fastest = float(speeds.max())
    right = 1.08 * fastest if fastest > 0.0 else 1.0
    frame = Frame.within(canvas, head, gutter, (0.0, right), (0.0, water.depth), beside)
    if head:
        canvas.text(0, 0, "current, m/s" if fastest > 0.0 else "still water", AXIS)
    frame.line([(0.0, 0.0), (right, 0.0)], SURFACE)
    canvas.text(frame.column, height - 2, "▒" * frame.columns, SEABED)
    frame.scale_down(values, gutter, foot)
    most = max(frame.columns // _COLUMNS_PER_TICK, 2)
    frame.scale_across(round_numbers(0.0, right, most), "" if head else "m/s")
    frame.line(zip(speeds.tolist(), depths.tolist(), strict=True), _STYLE)
    if beside:
        for value in values:
            _, row = frame.cell(0.0, value)
            (u, v, _), _ = (each[0] for each in water.at(np.array([value])))
            if np.hypot(u, v) > 0.0:
                canvas.text(width - beside + 1, row, _direction(u, v, beside), _STYLE)
    return canvas.rows()


def _direction(u: float, v: float, room: int) -> str:
    """Where it flows to: an arrow, and the degrees where there is room."""
    arrow = _ARROWS[round(np.degrees(np.arctan2(u, v)) / 45.0) % 8]
    return arrow if room == 2 else f"{bearing_text(bearing_of(u, v))}{arrow}"
