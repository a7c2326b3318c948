"""A tow drawn: elevation behind the ship, the flow past the line, and the plan where it is not
straight behind."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from calm.quantities import QUANTITIES
from calm.report.drawing import (
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

    from calm.case import TowResult

    Floats = NDArray[np.float64]

# A line that leaves the plane of the tow by more than this share of its layback is drawn in plan.
_PLANE_WITHIN = 0.01
# The seabed is drawn when it is no deeper than this many times the line.
_SEABED_NEAR = 1.5
_SHIP: dict[str, Any] = {"linestyle": "none", "marker": "^", "color": "black", "markersize": 8}


def draw_tow(result: TowResult) -> Figure:
    """A figure of two or three views, which belongs to no window.

    The elevation is in the vertical plane of the tow, the ship at distance 0; beside it the speed
    of the water past the line, and its part in that plane.
    """
    from matplotlib.figure import Figure

    heading = np.radians(result.toward)
    behind = -np.array([np.sin(heading), np.cos(heading)])
    top, bottom = levels_of(result)
    written = texts(result, bottom - top)
    height = figure_height(written)
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    views = (5, 1.5, 3) if _leaves_plane(result, behind) else (7, 2)
    elevation, flow, *plan = figure.subplots(1, len(views), width_ratios=views)
    flow.sharey(elevation)
    figure.suptitle(result.name, parse_math=False)

    _draw_elevation(elevation, result, behind)
    elevation.set_ylim(bottom, top)
    write_names(elevation, written, height, lambda part: float(along(part.x, part.y, behind)))
    _draw_flow(flow, result, behind, (top, bottom))
    for axes in plan:
        axes.plot(0.0, 0.0, label="tow point", **_SHIP)
        draw_plan(axes, result)
    return figure


def _leaves_plane(result: TowResult, behind: Floats) -> bool:
    across = along(result.shape.x, result.shape.y, np.array([behind[1], -behind[0]]))
    distance = np.hypot(result.shape.x, result.shape.y).max()
    return bool(np.abs(across).max() > _PLANE_WITHIN * distance)


def levels_of(result: TowResult) -> tuple[float, float]:
    """Depths at the upper and the lower edge of the elevation [m]."""
    depth = result.shape.depth
    top, bottom = min(float(depth.min()), 0.0), max(float(depth.max()), 0.0)
    seabed = result.file.environment.depth
    if seabed is not None and seabed < _SEABED_NEAR * bottom:
        bottom = seabed
    margin = 0.04 * (bottom - top)
    return top - margin, bottom + margin


def _draw_elevation(axes: Axes, result: TowResult, behind: Floats) -> None:
    environment = result.file.environment
    if environment.fluid == "water":
        axes.axhline(0.0, color=WATER_COLOUR, linewidth=1)
    if environment.depth is not None:
        axes.axhspan(environment.depth, 2.0 * environment.depth, color=SEABED_COLOUR)
    distance = along(result.shape.x, result.shape.y, behind)
    axes.plot(distance, result.shape.depth, **LINE_STYLE)
    axes.plot(distance[-1], result.shape.depth[-1], **_SHIP)
    mark_parts(axes, result, lambda part: (float(along(part.x, part.y, behind)), part.depth))
    height = float(np.ptp(result.shape.depth))
    set_span(axes, min(0.0, float(distance.min())), float(distance.max()), height)
    axes.set_xlabel(f"distance behind the tow point [m], heading {result.toward:.0f}°")
    axes.set_ylabel(QUANTITIES["depth"].label)


def _draw_flow(axes: Axes, result: TowResult, behind: Floats, levels: tuple[float, float]) -> None:
    water = result.tow.water
    top, bottom = levels
    if result.file.environment.fluid == "water":
        top = 0.0
    depth = np.union1d(np.linspace(top, bottom, 200), water.level)
    depth = depth[(depth >= top) & (depth <= bottom)]
    u, v = (np.interp(depth, water.level, speed) for speed in (water.u, water.v))
    u, v = u + result.speed * behind[0], v + result.speed * behind[1]
    draw_flow(axes, depth, u, v, behind)
    speed = QUANTITIES["speed"]
    axes.set_xlabel(f"{speed.heading} past the line [{speed.display_unit}]")
