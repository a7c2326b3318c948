"""Drawing of a result as SVG: side view of the line, current by depth, and plan."""

from __future__ import annotations

from collections.abc import Sequence
from math import ceil

import numpy as np

from calm.case.design import AnyResult
from calm.case.uncertain import Uncertain
from calm.drawing import line_picture
from calm.drawing.graph import Axes, Graph, LegendEntry, Scale, Stroke, covering, to_one_scale
from calm.drawing.line_picture import LineKind, LinePicture, PictureMark, along
from calm.drawing.schematic.pen import text_width, wrapped
from calm.physics.line import Floats
from calm.quantities import QUANTITIES

LINE_COLOUR, WATER_COLOUR, SEABED_COLOUR = "#0b3c5d", "#3399cc", "#d9c7a3"

SIGNS = {
    "float": ("o", 7.0, "#e69f00"),
    "instrument": ("s", 4.5, "#cc3311"),
    "release": ("D", 5.0, "#009e73"),
    "anchor": ("v", 6.0, "black"),
}
"""Form, size [pt] and colour of the mark for each role of a component."""

STROKES = {
    LineKind.LINE: Stroke(LINE_COLOUR, 1.4),
    LineKind.STILL: Stroke("grey", 1.0, (3.0, 2.0)),
    LineKind.BESIDE: Stroke("grey", 1.0),
    LineKind.SEABED: Stroke(SEABED_COLOUR, 3.0),
}
"""Stroke for each kind of line; bands are filled areas instead."""

LEAST_SPAN = 0.1
"""Minimum horizontal range, as a fraction of the height of the line or the water depth.

With a smaller range, a vertical line would look bent.
"""

_SIZE = 8.0  # font size in points
_WIDTH = 600.0  # points
_LEFT, _RIGHT, _BELOW = 44.0, 8.0, 32.0  # around the axes, for their scales
_TITLE, _TITLE_LEADING = 11.0, 15.0
_LEGEND_ROW, _LEGEND_COLUMNS = 13.5, 5
_FLOW, _PLAN, _BETWEEN = 72.0, 130.0, 50.0  # widths; the last includes the scale of the plan
_LEAST_HEIGHT = 290.0  # smallest height of the axes
_NAME_LEADING = 10.5
_LONGEST_NAME, _LEADER = 140.0, 32.0
# speeds that differ by less, as a share of the maximum, are drawn as one line, since the lines
# would overlap
_SAME_SPEED = 0.01
# A line that leaves the plane of the tow by more than this share of its layback is drawn in plan.
_PLANE_WITHIN = 0.01
_SHIP = ("^", 8.0, "black")
_FASTER, _IN_PLANE = Stroke(WATER_COLOUR, 1.4), Stroke(WATER_COLOUR, 1.0, (3.0, 2.0))


def line_drawing(result: AnyResult, uncertain: Uncertain | None = None) -> str:
    """Draw a mooring, a net or a tow from the side and from above, as SVG.

    The direction of the side view is from `line_picture.plane_of`. The line in still water is
    dashed. A band behind the line shows the uncertainty of a mooring. A second graph shows current
    speed against depth; for a tow, the speed is relative to the line. The view from above is
    omitted if a tow lies in the plane of the side view.
    """
    plane = line_picture.plane_of(result)
    side = line_picture.elevation_of(result, uncertain=uncertain)
    flat = side.ship is not None and not _leaves_plane(result, plane)
    above = None if flat else line_picture.plan_of(result)
    near = (side.bottom - side.top) * _NAME_LEADING / _LEAST_HEIGHT
    written = sorted(line_picture.names(list(side.marks), near), key=lambda named: named[1].depth)
    height = max(_LEAST_HEIGHT, len(written) * _NAME_LEADING)
    depth, u, v = line_picture.water_past(result)
    entries = [*_legend(side), *flow_legend(u, v, plane)]
    title = wrapped(result.name, _WIDTH - 12.0, _TITLE, bold=True)
    legend = len(title) * _TITLE_LEADING + 6.0
    top = legend + ceil(len(entries) / _LEGEND_COLUMNS) * _LEGEND_ROW + 10.0
    page = Graph(_WIDTH, top + height + _BELOW, result.name, _SIZE)
    for number, text in enumerate(title):
        middle = 3.0 + (number + 0.5) * _TITLE_LEADING
        page.pen.letters(_WIDTH / 2, middle, text, size=_TITLE, bold=True, anchor="middle")
    across = (_WIDTH - _LEFT) / _LEGEND_COLUMNS
    page.legend(entries, (_LEFT, legend), across, _LEGEND_ROW, _LEGEND_COLUMNS)

    plan = 0.0 if above is None else _PLAN + _BETWEEN
    flow = _FLOW if above is not None else 2.0 * _FLOW
    wide = _WIDTH - _LEFT - _RIGHT - plan - flow - 12.0
    depths = Scale(side.bottom, side.top)
    draw_elevation(page, (_LEFT, top, wide, height), side, written, depths)
    place = (_LEFT + wide + 12.0, top, flow, height)
    what = "past the line" if result.towed else "of the water"
    draw_flow(page, place, (depth, u, v), plane, depths, what)
    if above is not None:
        draw_plan(page, (_WIDTH - _RIGHT - _PLAN, top, _PLAN, height), above)
    return page.svg()


Place = tuple[float, float, float, float]
"""Position (left, top) and size (width, height) of axes [pt]."""


def _leaves_plane(result: AnyResult, behind: Floats) -> bool:
    (shape,) = (leg.shape for leg in result.legs)
    across = along(shape.x, shape.y, np.array([behind[1], -behind[0]]))
    distance = np.hypot(shape.x, shape.y).max()
    return bool(np.abs(across).max() > _PLANE_WITHIN * distance)


def _legend(side: LinePicture) -> list[LegendEntry]:
    lines = [
        LegendEntry(line.label, line=Stroke("#ced8df", 7.0))
        if line.kind is LineKind.BAND
        else LegendEntry(line.label, line=STROKES[line.kind])
        for line in side.lines
        if line.label
    ]
    ship = [] if side.ship is None else [LegendEntry("tow point", sign=_SHIP)]
    there = {mark.role for mark in side.marks}
    roles = [role for role in line_picture.NAMED_ROLES if role in there]
    return [*lines, *ship, *(LegendEntry(role, sign=SIGNS[role]) for role in roles)]


def draw_elevation(
    page: Graph,
    place: Place,
    side: LinePicture,
    written: Sequence[tuple[str, PictureMark]],
    depths: Scale,
) -> None:
    """Draw the side view of the line, with the names of the parts in a column."""
    _, _, width, _ = place
    widest = max((text_width(text, _SIZE) for text, _ in written), default=0.0)
    room = min(widest, _LONGEST_NAME)
    start, end = side.span()
    span = max(end - start, LEAST_SPAN * side.height)
    across = Scale(start - 0.05 * span, start + span * width / (width - room - _LEADER))
    axes = page.axes(*place, across, depths, clipped=True)
    if side.seabed is not None:
        axes.strip(side.seabed, max(2.0 * side.seabed, side.bottom), SEABED_COLOUR)
    if side.surface:
        axes.level(0.0, Stroke(WATER_COLOUR, 1.0))
    _draw_lines(axes, side)
    if side.ship is not None:
        axes.mark(side.ship[0], side.ship[1], *_SHIP)
    _draw_marks(axes, side.marks)
    _write_names(axes, written, room)
    axes.frame(6, 8, below=side.across, beside=side.up)


def _draw_lines(axes: Axes, picture: LinePicture) -> None:
    for line in picture.lines:
        if line.kind is LineKind.BAND:
            axes.area(line.x, line.y, LINE_COLOUR)
        else:
            axes.line(line.x, line.y, STROKES[line.kind])


def _draw_marks(axes: Axes, marks: Sequence[PictureMark]) -> None:
    for role, sign in SIGNS.items():
        for mark in marks:
            if mark.role == role:
                axes.mark(mark.x, mark.y, *sign)


def _write_names(axes: Axes, written: Sequence[tuple[str, PictureMark]], room: float) -> None:
    left, half = axes.left + axes.width - room - 4.0, _NAME_LEADING / 2
    wanted = [float(axes.y(part.depth)) for _, part in written]
    places = line_picture.spread(
        wanted, _NAME_LEADING, axes.top + half, axes.top + axes.height - half
    )
    for (text, part), y in zip(written, places, strict=True):
        x, level = float(axes.x(part.x)), float(axes.y(part.depth))
        axes.drawn.line(x, level, left - 2.0, y, stroke="grey", stroke_width=0.5)
        back = min(text_width(text, _SIZE), room) + 2.0
        axes.drawn.box(left + back / 2 - 1.0, y, back, 0.9 * _NAME_LEADING, fill="white")
        axes.drawn.write(left, y, text, room, size=_SIZE)


def draw_plan(page: Graph, place: Place, above: LinePicture) -> None:
    """Draw the line from above, with equal scales on both axes."""
    _, _, width, height = place
    across, up = (
        covering([0.0], *(getattr(line, name) for line in above.lines)) for name in ("x", "y")
    )
    axes = page.axes(*place, *to_one_scale(across, up, width, height))
    _draw_lines(axes, above)
    if above.ship is not None:
        axes.mark(above.ship[0], above.ship[1], *_SHIP)
    _draw_marks(axes, above.marks)
    axes.frame(3, 7, below=above.across, beside=above.up)


def _two_speeds(u: Floats, v: Floats, plane: Floats) -> bool:
    speed = np.hypot(u, v)
    return bool(np.any(np.abs(speed - along(u, v, plane)) > _SAME_SPEED * speed.max()))


def flow_legend(u: Floats, v: Floats, plane: Floats) -> list[LegendEntry]:
    """Return the legend entries for the lines drawn by `draw_flow`."""
    entries = [LegendEntry("speed", line=_FASTER)]
    return entries + [LegendEntry("in the plane", line=_IN_PLANE)] * _two_speeds(u, v, plane)


def draw_flow(
    page: Graph,
    place: Place,
    flow: tuple[Floats, Floats, Floats],
    plane: Floats,
    depths: Scale,
    what: str,
) -> None:
    """Draw current speed against depth.

    A second curve shows the current component in a vertical plane, if this component differs from
    the speed. `flow` is depths (n,) [m], and velocities (n,) to the east and north [m/s]. `plane`
    is the (2,) direction of the plane, east and north. The axis label is "speed" and the text
    `what`.
    """
    depth, u, v = flow
    speed, in_plane = np.hypot(u, v), along(u, v, plane)
    axes = page.axes(*place, covering([0.0], speed, in_plane), depths)
    axes.plumb(0.0, Stroke("grey", 0.5))
    axes.line(speed, depth, _FASTER)
    if _two_speeds(u, v, plane):
        axes.line(in_plane, depth, _IN_PLANE)
    quantity = QUANTITIES["speed"]
    below = f"speed {what} [{quantity.usual_unit}]"
    axes.frame(3, 8, below=below, numbered=(True, False))
