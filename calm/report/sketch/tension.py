"""Tension along a line, and what each piece may bear."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.text import Text

from calm.case import Result
from calm.checks.posture import meant_for_the_surface
from calm.checks.strength import allowable_load
from calm.quantities import say
from calm.report.graph.ticks import number, round_numbers
from calm.report.sketch.canvas import DOWN, Canvas
from calm.report.sketch.frame import AXIS, COLUMNS_PER_TICK, Frame, levels
from calm.report.sketch.parts import LIMIT, LINE, header_rows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from calm.case import TowResult

    Floats = NDArray[np.float64]

_FARTHEST = 2.5
"""Allowable loads are drawn up to this many times the greatest tension."""
_KILO = 1e4
"""Tensions are in kilonewtons from here on [N]."""


def tension(result: Result | TowResult, width: int, height: int) -> list[Text]:
    """Tension by the way along the line, as listed from the top, from 20 by 6 cells on.

    Dotted in red is what the weakest piece there may bear: its working load, or its breaking load
    over the safety factor that the design asks for. What bears far more than is drawn has no mark.
    """
    canvas = Canvas(width, height)
    head = header_rows(height)
    way, pulls = _along(result)
    greatest = max(float(pulls.max()), 1e-9)
    loads = _allowable(result)
    near = [load for _, _, load in loads if load <= _FARTHEST * greatest]
    scale, unit = (1e-3, "kN") if greatest >= _KILO else (1.0, "N")
    right = 1.08 * max([greatest, *near]) * scale
    if head:
        limits = "; dotted: limits" if near else ""
        canvas.text(0, 0, f"at most {say('tension', greatest)}{limits}", AXIS)
    rows = height - head - 2
    length = max(float(way[-1]), 1e-9)
    values = levels(0.0, length, rows)
    gutter = max(map(len, map(number, values)))
    frame = Frame.within(canvas, head, gutter, (0.0, right), (0.0, length))
    canvas.text(gutter, height - 2, "─" * (width - gutter), AXIS)
    frame.scale_down(values, gutter)
    frame.scale_across(round_numbers(0.0, right, max(frame.columns // COLUMNS_PER_TICK, 2)), unit)
    before = 0.0
    for row, load in _weakest(loads, length, rows * DOWN):
        if load <= _FARTHEST * greatest and (row % 2 == 0 or load != before):
            x, _ = frame.point(load * scale, 0.0)
            canvas.dot(x, frame.row * DOWN + row, LIMIT)
        before = load
    frame.line(zip((pulls * scale).tolist(), way.tolist(), strict=True), LINE)
    return canvas.rows()


def _along(result: Result | TowResult) -> tuple[Floats, Floats]:
    """(k,) way from the first-listed end [m] and tension [N]."""
    shape = result.shape
    steps = np.sqrt(np.diff(shape.x) ** 2 + np.diff(shape.y) ** 2 + np.diff(shape.depth) ** 2)
    pulls = shape.tension
    if not isinstance(result, Result):
        steps, pulls = steps[::-1], pulls[::-1]
    return np.concatenate([[0.0], np.cumsum(steps)]), pulls


def _allowable(result: Result | TowResult) -> list[tuple[float, float, float]]:
    """Start and end along the line [m] of each piece with a known limit, and that [N]."""
    factors = result.file.checks.safety_factor
    surface = isinstance(result, Result) and meant_for_the_surface(result)
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
