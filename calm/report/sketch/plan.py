"""A line from above, north up, to one scale."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import hypot
from typing import TYPE_CHECKING

import numpy as np
from rich.text import Text

from calm.case import Result
from calm.quantities import bearing_of, bearing_text, say
from calm.report.graph.ticks import number, round_numbers
from calm.report.sketch.canvas import ACROSS, DOWN, Canvas
from calm.report.sketch.frame import AXIS, COLUMNS_PER_TICK, Frame, levels
from calm.report.sketch.parts import LINE, OTHER, SHIP, STILL, header_rows, mark_parts

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from calm.case import TowResult
    from calm.case.columns import Shape

    Floats = NDArray[np.float64]

_LEAST_SPAN = 1.0
_MARGIN = 0.06


def plan(
    result: Result | TowResult, width: int, height: int, beside: Sequence[Shape] = ()
) -> list[Text]:
    """A line from above with its anchor, or the ship, at zero, from 20 by 6 cells on.

    Shapes `beside` it, of other environments or designs, are dashed.
    """
    canvas = Canvas(width, height)
    head, shape = header_rows(height), result.shape
    if head:
        canvas.text(0, 0, _said(result), AXIS)
    rows = height - head - 2
    west, east = _range([0.0, *_ends(each.x for each in (shape, *beside))])
    south, north = _range([0.0, *_ends(each.y for each in (shape, *beside))])
    gutter = 1
    for _ in range(2):  # the numbers beside it take room, which changes them
        columns = width - gutter - 1
        metres = max((east - west) / (columns * ACROSS), (north - south) / (rows * DOWN))
        left, right = _centred(west, east, metres * columns * ACROSS)
        bottom, top = _centred(south, north, metres * rows * DOWN)
        values = levels(bottom, top, rows)
        gutter = max(map(len, map(number, values)))
    columns = width - gutter - 1
    left, right = _centred(west, east, metres * columns * ACROSS)
    frame = Frame.within(canvas, head, gutter, (left, right), (top, bottom))
    canvas.text(gutter, height - 2, "─" * (width - gutter), AXIS)
    frame.scale_down(values, gutter)
    frame.scale_across(
        round_numbers(left, right, max(frame.columns // COLUMNS_PER_TICK, 2)), "m east", "m E"
    )
    frame.line([(left, 0.0), (right, 0.0)], STILL, dash=1, gap=3)
    frame.line([(0.0, bottom), (0.0, top)], STILL, dash=1, gap=3)
    for other in beside:
        frame.line(zip(other.x.tolist(), other.y.tolist(), strict=True), OTHER, dash=3, gap=2)
    frame.line(zip(shape.x.tolist(), shape.y.tolist(), strict=True), LINE)
    if not isinstance(result, Result):
        frame.mark(0.0, 0.0, *SHIP)
    mark_parts(frame, result, lambda part: (part.x, part.y))
    canvas.text(gutter + 1, head, "N", AXIS)
    return canvas.rows()


def _said(result: Result | TowResult) -> str:
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
