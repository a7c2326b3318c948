"""A result drawn as a file: a mooring or a tow, from the side and above."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.case.design import AnyResult
from calm.case.uncertain import Uncertain
from calm.drawing import line_picture
from calm.drawing.line_picture import LineKind, LinePicture, PictureMark, along, current_between
from calm.drawing.picture import empty_figure
from calm.physics.line import Floats
from calm.quantities import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


WIDTH = 11.0  # inches
LINE_STYLE: dict[str, Any] = {"color": "#0b3c5d", "linewidth": 1.5}
WATER_COLOUR, SEABED_COLOUR = "#3399cc", "#d9c7a3"
LEGEND: dict[str, Any] = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "frameon": False}
"""A legend above the axes."""

SIGNS = {
    "float": ("o", 7.0, "#e69f00"),
    "instrument": ("s", 4.5, "#cc3311"),
    "release": ("D", 5.0, "#009e73"),
    "anchor": ("v", 6.0, "black"),
}
"""Form, size [pt] and colour of the mark of a role."""

_FONT_SIZE = 8.0  # points
_LINE_HEIGHT = 1.3 * _FONT_SIZE / 72  # inches
_LEAST_HEIGHT, _GREATEST_HEIGHT = 6.5, 20.0  # inches
_FRAME = 1.5  # inches above and below the axes, for titles and ticks
# The drawn line keeps to this share of the width of the elevation; the names stand beyond it.
_SHARE_OF_LINE = 0.55
# Distances are drawn to at least this share of the height: a still line must not look bent.
_LEAST_SPAN = 0.1
# Speeds that differ by less, as a share of the greatest, are drawn as one line: they would cover
# each other.
_SAME_SPEED = 0.01
# A line that leaves the plane of the tow by more than this share of its layback is drawn in plan.
_PLANE_WITHIN = 0.01
_SHIP: dict[str, Any] = {"linestyle": "none", "marker": "^", "color": "black", "markersize": 8}


def draw(result: AnyResult, uncertain: Uncertain | None = None) -> Figure:
    """Draw a mooring or a tow as a figure of two or three views, which belongs to no window.

    The elevation is in the vertical plane of the anchor and the free end, of a net in the one in
    which it is widest, with the same line in still water dashed, or in that of the tow, the ship at
    distance 0. Beside it stand the speed of the water and its part in that plane, past the line in
    a tow; and the line from above, where it leaves the plane of a tow. The band of an uncertain
    mooring is drawn behind the line.
    """
    side, plane = (
        line_picture.elevation_of(result, uncertain=uncertain),
        line_picture.plane_of(result),
    )
    extent = side.bottom - side.top
    near = extent * _LINE_HEIGHT / (_LEAST_HEIGHT - _FRAME)
    written = sorted(line_picture.names(list(side.marks), near), key=lambda named: named[1].depth)
    height = min(max(_LEAST_HEIGHT, len(written) * _LINE_HEIGHT + _FRAME), _GREATEST_HEIGHT)
    figure = empty_figure(WIDTH, height, layout="constrained")
    flat = side.ship is not None and not _leaves_plane(result, plane)
    views = (7, 2) if flat else (5, 1.5, 3)
    elevation, flow, *plan = figure.subplots(1, len(views), width_ratios=views)
    flow.sharey(elevation)
    figure.suptitle(result.name, parse_math=False)

    draw_elevation(elevation, side)
    write_names(elevation, written, height)
    _draw_flow_of(flow, result, side, plane)
    for axes in plan:
        draw_plan(axes, line_picture.plan_of(result))
    return figure


def _leaves_plane(result: AnyResult, behind: Floats) -> bool:
    (shape,) = (leg.shape for leg in result.legs)
    across = along(shape.x, shape.y, np.array([behind[1], -behind[0]]))
    distance = np.hypot(shape.x, shape.y).max()
    return bool(np.abs(across).max() > _PLANE_WITHIN * distance)


def draw_elevation(axes: Axes, side: LinePicture) -> None:
    """Draw the line from the side, between surface and seabed."""
    if side.surface:
        axes.axhline(0.0, color=WATER_COLOUR, linewidth=1)
    if side.seabed is not None:
        axes.axhspan(side.seabed, max(2.0 * side.seabed, side.bottom), color=SEABED_COLOUR)
    draw_lines(axes, side)
    if any(line.label for line in side.lines):
        axes.legend(ncols=2, **LEGEND)
    if side.ship is not None:
        axes.plot(*side.ship, **_SHIP)
    mark_parts(axes, side.marks)
    start, end = side.span()
    span = max(end - start, _LEAST_SPAN * side.height)
    across = start - 0.05 * span, start + span / _SHARE_OF_LINE
    axes.set(xlim=across, ylim=(side.bottom, side.top), xlabel=side.across, ylabel=side.up)


def draw_lines(axes: Axes, picture: LinePicture) -> None:
    """Draw the lines of a picture, each with its label for a legend."""
    for line in picture.lines:
        if line.kind is LineKind.BAND:
            colour = LINE_STYLE["color"]
            axes.fill(line.x, line.y, color=colour, alpha=0.2, linewidth=0, label=line.label)
        elif line.kind is LineKind.STILL:
            axes.plot(line.x, line.y, "--", color="grey", linewidth=1, label=line.label)
        elif line.kind is LineKind.SEABED:
            axes.plot(line.x, line.y, color=SEABED_COLOUR, linewidth=3)
        else:
            axes.plot(line.x, line.y, label=line.label, **LINE_STYLE)


def draw_plan(axes: Axes, above: LinePicture) -> None:
    """Draw the line from above, both axes to one scale."""
    if above.ship is not None:
        axes.plot(*above.ship, label="tow point", **_SHIP)
    draw_lines(axes, above)
    mark_parts(axes, above.marks)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel=above.across, ylabel=above.up)
    axes.legend(ncols=2, **LEGEND)


def _draw_flow_of(axes: Axes, result: AnyResult, side: LinePicture, plane: Floats) -> None:
    """Draw the current, of a tow the water past the line, over the depths of the elevation."""
    speed = QUANTITIES["speed"]
    water, tow = result.water, result.file.tow
    if tow is None:
        draw_flow(axes, *current_between(water, 0.0, water.depth), plane)
        axes.set_xlabel(f"current {speed.label}")
        return
    top = 0.0 if side.surface else side.top
    depth, u, v = current_between(water, top, side.bottom)
    draw_flow(axes, depth, u + tow.speed * plane[0], v + tow.speed * plane[1], plane)
    axes.set_xlabel(f"{speed.heading} past the line [{speed.usual_unit}]")


def draw_flow(axes: Axes, depth: Floats, u: Floats, v: Floats, plane: Floats) -> None:
    """Draw speed by depth, and the part of it in a vertical plane where that is another.

    Parameters
    ----------
    depth, u, v : (n,) [m], [m/s] to the east and to the north
    plane : (2,) direction of the plane, east and north
    """
    axes.axvline(0.0, color="grey", linewidth=0.5)
    speed, in_plane = np.hypot(u, v), along(u, v, plane)
    axes.plot(speed, depth, color=WATER_COLOUR, label="speed")
    if np.any(np.abs(speed - in_plane) > _SAME_SPEED * speed.max()):
        axes.plot(in_plane, depth, "--", color=WATER_COLOUR, linewidth=1, label="in the plane")
    axes.tick_params(labelleft=False)
    axes.legend(**LEGEND)


def mark_parts(axes: Axes, marks: Sequence[PictureMark]) -> None:
    """Mark the named parts where they are, in one group for each role that occurs."""
    for role in line_picture.NAMED_ROLES:
        there = [mark for mark in marks if mark.role == role]
        if there:
            sign, size, colour = SIGNS[role]
            x, y = [mark.x for mark in there], [mark.y for mark in there]
            axes.plot(x, y, sign, label=role, color=colour, markersize=size)


def write_names(axes: Axes, written: list[tuple[str, PictureMark]], height: float) -> None:
    """Names in a column right of the line, each with a thin line to its part.

    Parameters
    ----------
    height : of the figure [inches]
    """
    if not written:
        return
    height -= _FRAME
    line = min(_LINE_HEIGHT, height / len(written)) / height
    bottom, top = axes.get_ylim()
    wanted = [(part.depth - top) / (bottom - top) for _, part in written]
    places = line_picture.spread(wanted, line, line / 2, 1.0 - line / 2)
    for (text, part), place in zip(written, places, strict=True):
        axes.annotate(
            text, (part.x, part.depth), (_SHARE_OF_LINE + 0.1, 1.0 - place),
            textcoords="axes fraction", fontsize=_FONT_SIZE * line * height / _LINE_HEIGHT,
            verticalalignment="center", parse_math=False,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5},
            arrowprops={"arrowstyle": "-", "color": "grey", "linewidth": 0.5, "relpos": (0.0, 0.5)},
        )  # fmt: skip
