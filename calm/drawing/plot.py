"""A result drawn as a file: a mooring or a tow, from the side and above; a tow at many speeds."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.case import TowResult
from calm.drawing.line_on_figure import (
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
from calm.drawing.picture import image
from calm.quantities import QUANTITIES, bearing_of, bearing_text
from calm.units import KNOT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from calm.case import Result
    from calm.case.uncertain import Uncertain
    from calm.report.tabulation import Tabulation

    Floats = NDArray[np.float64]
    from calm.case import TowResult


def picture(result: Result | TowResult, suffix: str, uncertain: Uncertain | None = None) -> bytes:
    """The drawing of a mooring or a tow as a file; `suffix` is one of `picture.FORMATS`."""
    return image(draw(result, uncertain), suffix)


def draw(result: Result | TowResult, uncertain: Uncertain | None = None) -> Figure:
    """The drawing of a mooring or a tow: a figure that belongs to no window.

    Parameters
    ----------
    uncertain : of a mooring; its band is drawn behind the line
    """
    if isinstance(result, TowResult):
        pass

        return draw_tow(result)
    pass

    return draw_mooring(result, uncertain)


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
    _draw_mooring_elevation(elevation, result, plane, uncertain)
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


def _draw_mooring_elevation(
    axes: Axes, result: Result, plane: Floats, uncertain: Uncertain | None
) -> None:
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

    _draw_tow_elevation(elevation, result, behind)
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


def _draw_tow_elevation(axes: Axes, result: TowResult, behind: Floats) -> None:
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


_HEIGHT = 4.5  # inches
_MOST_MARKED = 60  # points that can still be told apart


def draw_sweep(tabulation: Tabulation) -> Figure:
    """A figure of three panels against the speed, which belongs to no window.

    Depth of the body, its layback, and the tension at the tow point and at the body. A speed
    without equilibrium is a gap.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH, _HEIGHT), layout="constrained")
    depth, layback, tension = figure.subplots(1, 3)
    figure.suptitle(tabulation.name, parse_math=False)
    _draw(depth, tabulation, "depth")
    depth.axhline(0.0, color=WATER_COLOUR, linewidth=1)
    depth.invert_yaxis()
    _draw(layback, tabulation, "layback")
    _draw(tension, tabulation, "tension", label="at the tow point")
    _draw(tension, tabulation, "body_tension", "--", label="at the body")
    tension.set_ylabel(QUANTITIES["tension"].label)
    tension.set_ylim(bottom=0.0)
    tension.legend(frameon=False)
    return figure


def _draw(
    axes: Axes, tabulation: Tabulation, name: str, dashes: str = "-", label: str = ""
) -> None:
    from matplotlib.ticker import MaxNLocator

    speeds = [float(row.chosen["speed"]) for row in tabulation.rows]
    figures = [row.figures[name] for row in tabulation.rows]
    values = [float("nan") if value is None else value for value in figures]
    marker = "." if dashes == "-" and len(speeds) <= _MOST_MARKED else ""
    axes.plot(speeds, values, linestyle=dashes, marker=marker, label=label, **LINE_STYLE)
    margin = 0.04 * (speeds[-1] - speeds[0]) or speeds[0]
    axes.set_xlim(speeds[0] - margin, speeds[-1] + margin)
    axes.set_xlabel(QUANTITIES["speed"].label)
    axes.set_ylabel(QUANTITIES[name].label)
    axes.grid(alpha=0.3)
    if not axes.child_axes:
        to_knots, from_knots = partial(np.multiply, 1.0 / KNOT), partial(np.multiply, KNOT)
        knots = axes.secondary_xaxis("top", functions=(to_knots, from_knots))
        knots.set_xlabel("speed [knot]")
        knots.xaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10]))
