"""A mooring drawn in all of its environments: elevation, current, tension, plan, and breaks."""

from collections.abc import Sequence
from math import ceil

import numpy as np

from calm.case.leg_result import LegResult
from calm.checks.assessment import Assessment
from calm.checks.posture import reaches_the_surface
from calm.checks.recovery import Break
from calm.checks.strength import allowable_load
from calm.drawing import graph, line_picture
from calm.drawing.line_drawing import SEABED_COLOUR, SIGNS, WATER_COLOUR
from calm.drawing.line_picture import NAMED_ROLES, LineKind, along_the_line, current_between
from calm.quantities import QUANTITIES

Solved = Sequence[tuple[str, LegResult]]


_SIZE = 8.0  # font size in points
_WIDTH, _HEIGHT = 533.0, 576.0  # points: an A4 page between its margins
_LEGEND_ROW, _LEGEND_COLUMNS = 13.5, 4
_LEAST_SPAN = 0.1  # as a share of the depth; an almost vertical line is not stretched beyond this
_FURTHEST_LIMIT = 4.0  # times the maximum tension; larger values are drawn at the edge
_DASHES: tuple[tuple[float, ...], ...] = ((), (7.0, 2.5), (1.8, 1.8))
_STILL = graph.Stroke("grey", 1.0, (3.0, 2.0))
_LIMIT = graph.Stroke("#b3261e", 2.0, square=True)
_UNJUDGED, _ENOUGH, _SHORT = "#b8bec4", "#8fb3cf", "#d98880"


def check_figure(assessment: Assessment) -> str:
    """Return the figure as SVG: five panels with a common legend, and a line for each environment.

    The elevation and the current share the depth axis; each elevation is in the plane of its own
    excursion. Tension is drawn over the distance along the line, with the allowable load of each
    piece. The breaks are drawn if the mooring has a release. The panels keep their size: the graph
    grows by the rows of the legend.
    """
    solved = [(stand.environment, stand.result) for stand in assessment.stands if stand.result]
    entries = _legend(solved)
    legend = ceil(len(entries) / _LEGEND_COLUMNS) * _LEGEND_ROW
    title = f"{assessment.name}: elevation, current, tension, plan and breaks"
    page = graph.Graph(_WIDTH, _HEIGHT + legend, title, _SIZE)
    across = (_WIDTH - 12.0) / _LEGEND_COLUMNS
    page.legend(entries, (6.0, 3.0), across, _LEGEND_ROW, _LEGEND_COLUMNS)
    top, lower = legend + 11.0, legend + 372.0
    depth = max(line_picture.seabed_of(result) for _, result in solved)
    highest = min(float(result.shape.depth.min()) for _, result in solved)
    # depth axis of the elevation and the current, from below the seabed to above the surface
    depths = graph.Scale(1.03 * depth, min(-0.03 * depth, highest))
    _draw_elevation(page, (42.0, top, 187.0, 310.0), solved, depths)
    _draw_current(page, (240.0, top, 72.0, 310.0), solved, depths)
    _draw_tension(page, (361.0, top, 165.0, 310.0), solved)
    _draw_plan(page, (42.0, lower, 187.0, 173.0), solved)
    if assessment.backup:
        _draw_breaks(page, (288.0, lower, 238.0, 173.0), assessment.backup)
    return page.svg()


Place = tuple[float, float, float, float]
"""Left and upper edge, width and height of axes [pt]."""


def _legend(solved: Solved) -> list[graph.LegendEntry]:
    """Legend entries for each environment, and for the other lines and marks of the panels."""
    _, first = solved[0]
    there = {part.role for part in line_picture.named_parts(first)}
    still = [] if first.still_shape is None else [graph.LegendEntry("still water", line=_STILL)]
    return [
        *(graph.LegendEntry(name, line=_stroke(number)) for number, (name, _) in enumerate(solved)),
        *still,
        *(graph.LegendEntry(role, sign=SIGNS[role]) for role in NAMED_ROLES if role in there),
        graph.LegendEntry("limit", line=_LIMIT),
    ]


def _stroke(number: int) -> graph.Stroke:
    """Colour and dashes of an environment, distinct for the first twenty-one environments."""
    turn, colour = divmod(number, len(graph.COLOURS))
    return graph.Stroke(graph.COLOURS[colour], 1.2, _DASHES[turn % len(_DASHES)])


def _draw_elevation(page: graph.Graph, place: Place, solved: Solved, depths: graph.Scale) -> None:
    _, first = solved[0]
    side, depth = line_picture.elevation_of(first), depths.low / 1.03
    lines = [line_picture.from_the_side(one.shape, line_picture.plane_of(one)) for _, one in solved]
    start = min(0.0, *(float(line.x.min()) for line in lines))
    end = max(0.0, *(float(line.x.max()) for line in lines))
    span = max(end - start, _LEAST_SPAN * depth)
    axes = page.axes(*place, graph.Scale(start - 0.08 * span, start + 1.08 * span), depths)
    axes.strip(depth, depths.low, SEABED_COLOUR)
    axes.level(0.0, graph.Stroke(WATER_COLOUR, 1.0))
    for line in side.lines:
        if line.kind is LineKind.STILL:
            axes.line(line.x, line.y, _STILL)
        elif line.kind is LineKind.SEABED:
            axes.line(line.x, line.y, graph.Stroke(SEABED_COLOUR, 3.0))
    for number, line in enumerate(lines):
        axes.line(line.x, line.y, _stroke(number))
    for mark in side.marks:
        axes.mark(mark.x, mark.y, *SIGNS[mark.role])
    axes.frame(5, 9, below=QUANTITIES["offset"].label, beside=side.up)


def _draw_current(page: graph.Graph, place: Place, solved: Solved, depths: graph.Scale) -> None:
    profiles = []
    for _, result in solved:
        water = result.water
        depth, u, v = current_between(water, 0.0, water.depth, samples=60)
        profiles.append((np.hypot(u, v), depth))
    fastest = max(float(speed.max()) for speed, _ in profiles)
    axes = page.axes(*place, graph.Scale(0.0, 1.05 * fastest or 1.0), depths)
    for number, (speed, depth) in enumerate(profiles):
        axes.line(speed, depth, _stroke(number))
    below = f"current [{QUANTITIES['speed'].usual_unit}]"
    axes.frame(3, 9, below=below, numbered=(True, False))


def _draw_tension(page: graph.Graph, place: Place, solved: Solved) -> None:
    """Draw tension over the stretched length, and the allowable loads of the pieces, if known."""
    greatest = max(float(result.shape.tension.max()) for _, result in solved)
    _, first = solved[0]
    ends = np.concatenate([[0.0], np.cumsum(first.components.length[:-1])])
    factors, surface = first.file.checks.safety_factor, reaches_the_surface(first.leg)
    loads = [
        allowable_load(piece.component, factors, surface) or np.nan
        for piece in first.file.pieces[:-1]
    ]
    edge = min(np.nanmax([*loads, greatest]), _FURTHEST_LIMIT * greatest)
    distances = [along_the_line(result.shape) for _, result in solved]
    furthest = max(float(each[-1]) for each in (ends, *distances))
    axes = page.axes(
        *place, graph.Scale(0.0, 1.04 * edge), graph.Scale(1.02 * furthest, -0.02 * furthest)
    )
    for number, ((_, result), distance) in enumerate(zip(solved, distances, strict=True)):
        axes.line(result.shape.tension, distance, _stroke(number))
    axes.lines([np.minimum(loads, edge)] * 2, [ends[:-1], ends[1:]], _LIMIT)
    axes.frame(4, 9, below=QUANTITIES["tension"].label, beside="distance along the line [m]")


def _draw_plan(page: graph.Graph, place: Place, solved: Solved) -> None:
    """Draw the line from above, with equal scales on both axes."""
    _, _, width, height = place
    across, up = (
        graph.covering([0.0], *(getattr(result.shape, name) for _, result in solved))
        for name in "xy"
    )
    axes = page.axes(*place, *graph.to_one_scale(across, up, width, height))
    for number, (_, result) in enumerate(solved):
        stroke = _stroke(number)
        axes.line(result.shape.x, result.shape.y, stroke)
        axes.mark(result.top.x, result.top.y, "o", 3.5, stroke.colour)
    axes.mark(0.0, 0.0, "v", 5.0, "black")
    axes.frame(5, 6, below=QUANTITIES["x"].label, beside=QUANTITIES["y"].label)


def _draw_breaks(page: graph.Graph, place: Place, backup: Sequence[Break]) -> None:
    """Draw the remaining buoyancy after each break, and the required buoyancy; breaks without
    assessment are grey.
    """
    number = np.array([each.break_after for each in backup], dtype=np.float64)
    required = np.array([each.required for each in backup])
    margins = np.array([each.margin for each in backup])
    axes = page.axes(
        *place, graph.covering(number - 0.5, number + 0.5), graph.covering([0.0], margins, required)
    )
    colours = [
        _UNJUDGED if not each.judged else _ENOUGH if each.margin >= each.required else _SHORT
        for each in backup
    ]
    axes.bars(number, margins, 0.8, colours)
    axes.lines([number - 0.5, number + 0.5], [required] * 2, _LIMIT)
    axes.level(0.0, graph.Stroke("black", 0.6))
    numbered = graph.counts(backup[0].break_after, backup[-1].break_after, 8)
    axes.frame(numbered, 6, below="break below piece no.", beside="back-up buoyancy left [N]")
