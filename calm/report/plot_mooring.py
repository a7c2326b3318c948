"""A mooring drawn: elevation in the plane of its excursion, the current beside it, and the plan."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from calm.quantities import QUANTITIES, bearing_of, bearing_text
from calm.report.drawing import (
    LEGEND,
    LINE_STYLE,
    SEABED_COLOUR,
    WATER_COLOUR,
    WIDTH,
    along,
    draw_flow,
    draw_plan,
    figure_height,
    mark_parts,
    set_span,
    texts,
    write_names,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from calm.case import Result
    from calm.case.uncertain import Uncertain

    Floats = NDArray[np.float64]


def draw_mooring(result: Result, uncertain: Uncertain | None = None) -> Figure:
    """A figure of three views, which belongs to no window.

    The elevation is in the vertical plane of the anchor and the free end, with the same line in
    still water dashed; the current is shown as its speed and as its part in that plane. Behind the
    line stands the band of its uncertainty, where that is given.
    """
    from matplotlib.figure import Figure

    written = texts(result, result.mooring.water.depth)
    height = figure_height(written)
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    elevation, current, plan = figure.subplots(1, 3, width_ratios=(5, 1.5, 3))
    current.sharey(elevation)
    figure.suptitle(result.name, parse_math=False)

    plane = plane_of(result)
    _draw_elevation(elevation, result, plane, uncertain)
    write_names(elevation, written, height, lambda part: float(along(part.x, part.y, plane)))
    _draw_current(current, result, plane)
    draw_plan(plan, result)
    return figure


def plane_of(result: Result) -> Floats:
    """(2,) direction, east and north, from the anchor to the free end; east when upright."""
    excursion = np.array([result.top.x, result.top.y])
    distance = np.linalg.norm(excursion)
    east = np.array([1.0, 0.0])
    return excursion / distance if distance > 1e-6 * result.mooring.water.depth else east


def _draw_elevation(axes: Axes, result: Result, plane: Floats, uncertain: Uncertain | None) -> None:
    depth = result.mooring.water.depth
    offset = along(result.shape.x, result.shape.y, plane)
    reach = [offset]
    if uncertain is not None:
        reach.append(_draw_band(axes, uncertain))
    axes.axhline(0.0, color=WATER_COLOUR, linewidth=1)
    axes.axhspan(depth, 1.05 * depth, color=SEABED_COLOUR)
    if result.still_shape is not None:
        still = along(result.still_shape.x, result.still_shape.y, plane)
        label = "in still water"
        axes.plot(still, result.still_shape.depth, "--", color="grey", linewidth=1, label=label)
    axes.plot(offset, result.shape.depth, label="in the current", **LINE_STYLE)
    axes.legend(ncols=2, **LEGEND)
    mark_parts(axes, result, lambda part: (float(along(part.x, part.y, plane)), part.depth))
    low, high = (function(list(map(function, reach))) for function in (min, max))
    set_span(axes, min(0.0, low), max(0.0, high), depth)
    axes.set_ylim(1.03 * depth, min(-0.03 * depth, result.shape.depth.min()))
    axes.set_xlabel(f"{QUANTITIES['offset'].label}, towards {bearing_text(bearing_of(*plane))}")
    axes.set_ylabel(QUANTITIES["depth"].label)


def _draw_band(axes: Axes, uncertain: Uncertain) -> Floats:
    """The line between its 5 and 95 % of offset and depth; the offsets it covers."""
    (near, *_, far), (high, *_, low) = uncertain.offset, uncertain.depth_top
    offset = np.concatenate([near, far[::-1]])
    depth = np.concatenate([high, low[::-1]])
    label = "5 to 95 %"
    axes.fill(offset, depth, color=LINE_STYLE["color"], alpha=0.2, linewidth=0, label=label)
    return offset


def _draw_current(axes: Axes, result: Result, plane: Floats) -> None:
    water = result.mooring.water
    depth = np.union1d(np.linspace(0.0, water.depth, 200), water.level)
    depth = depth[(depth >= 0.0) & (depth <= water.depth)]
    u, v = (np.interp(depth, water.level, speed) for speed in (water.u, water.v))
    draw_flow(axes, depth, u, v, plane)
    axes.set_xlabel(f"current {QUANTITIES['speed'].label}")
