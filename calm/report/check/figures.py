"""A mooring drawn in all of its environments: elevation, current, tension, plan, and breaks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.checks.posture import meant_for_the_surface
from calm.checks.strength import allowable_load
from calm.quantities import QUANTITIES
from calm.report.check.panels import panels
from calm.report.drawing import SEABED_COLOUR, WATER_COLOUR, along, mark_parts
from calm.report.plot_mooring import plane_of
from calm.report.vector import figure_svg

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

    from calm.case import Result
    from calm.checks.assessment import Assessment
    from calm.checks.backup import Break

    Solved = Sequence[tuple[str, Result]]

_LEAST_SPAN = 0.1  # of the depth: a line that hardly leans is not drawn as if it did
_FURTHEST_LIMIT = 4.0  # times the greatest tension; what is beyond is drawn at the edge
_COLOURS = ("#0b3c5d", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#a6761d", "#332288")
_DASHES: tuple[Any, ...] = ("-", (0, (6, 2)), (0, (1.5, 1.5)))
_STILL: dict[str, Any] = {"color": "grey", "linestyle": (0, (3, 2)), "linewidth": 1.0}
_LIMIT: dict[str, Any] = {"colors": "#b3261e", "linewidth": 2.0, "capstyle": "projecting"}


def check_figure(assessment: Assessment) -> str:
    """The figure as SVG: five panels that share one legend, the environments distinguished by line.

    The elevation and the current are of one depth axis; an elevation lies in the plane of its own
    excursion. Tension is drawn over the distance along the line, with the load that each piece may
    bear. The breaks are drawn where the mooring has a release.
    """
    solved = [(stand.environment, stand.result) for stand in assessment.stands if stand.result]
    with panels() as sheet:
        _draw_elevation(sheet.elevation, solved)
        _draw_current(sheet.current, solved)
        _draw_tension(sheet.tension, solved)
        _draw_plan(sheet.plan, solved)
        sheet.breaks.set_visible(bool(assessment.backup))
        if assessment.backup:
            _draw_breaks(sheet.breaks, assessment.backup)
        sheet.write_legend(_legend(sheet.elevation, [name for name, _ in solved]))
        return figure_svg(sheet.figure)


def _legend(elevation: Axes, names: Sequence[str]) -> list[tuple[Line2D, str]]:
    """A line and a name for each environment, and for what else the panels show."""
    from matplotlib.lines import Line2D

    environments = [(Line2D([], [], **_style(number)), name) for number, name in enumerate(names)]
    limit = Line2D([], [], color=_LIMIT["colors"], linewidth=_LIMIT["linewidth"])
    lines, labels = elevation.get_legend_handles_labels()
    others = [
        (line, label) for line, label in zip(lines, labels, strict=True) if isinstance(line, Line2D)
    ]
    return [*environments, *others, (limit, "limit")]


def _style(number: int) -> dict[str, Any]:
    """Colour and dashes of an environment: no two of the first twenty-one are alike."""
    dashes = _DASHES[number // len(_COLOURS) % len(_DASHES)]
    return {"color": _COLOURS[number % len(_COLOURS)], "linestyle": dashes, "linewidth": 1.2}


def _draw_elevation(axes: Axes, solved: Solved) -> None:
    depth = max(result.mooring.water.depth for _, result in solved)
    axes.axhline(0.0, color=WATER_COLOUR, linewidth=1.0)
    axes.axhspan(depth, 1.05 * depth, color=SEABED_COLOUR)
    _, first = solved[0]
    plane = plane_of(first)
    if first.still_shape is not None:
        still = along(first.still_shape.x, first.still_shape.y, plane)
        axes.plot(still, first.still_shape.depth, label="still water", **_STILL)
    furthest = [0.0]
    for number, (_, result) in enumerate(solved):
        offset = along(result.shape.x, result.shape.y, plane_of(result))
        axes.plot(offset, result.shape.depth, **_style(number))
        furthest += [float(offset.min()), float(offset.max())]
    mark_parts(axes, first, lambda part: (float(along(part.x, part.y, plane)), part.depth))
    start, end = min(furthest), max(furthest)
    span = max(end - start, _LEAST_SPAN * depth)
    axes.set_xlim(start - 0.08 * span, start + 1.08 * span)
    axes.set_ylim(1.03 * depth, min(-0.03 * depth, float(first.shape.depth.min())))
    axes.set_xlabel(QUANTITIES["offset"].label)
    axes.set_ylabel(QUANTITIES["depth"].label)


def _draw_current(axes: Axes, solved: Solved) -> None:
    for number, (_, result) in enumerate(solved):
        water = result.mooring.water
        depth = np.union1d(np.linspace(0.0, water.depth, 60), water.level)
        depth = depth[(depth >= 0.0) & (depth <= water.depth)]
        u, v = (np.interp(depth, water.level, speed) for speed in (water.u, water.v))
        axes.plot(np.hypot(u, v), depth, **_style(number))
    axes.tick_params(labelleft=False)
    axes.set_xlim(left=0.0)
    axes.set_xlabel(f"current [{QUANTITIES['speed'].display_unit}]")


def _draw_tension(axes: Axes, solved: Solved) -> None:
    """Tension over the stretched length, and what the pieces may bear, where that is known."""
    greatest = max(float(result.shape.tension.max()) for _, result in solved)
    for number, (_, result) in enumerate(solved):
        axes.plot(result.shape.tension, _distance(result), **_style(number))
    _, first = solved[0]
    ends = np.concatenate([[0.0], np.cumsum(first.components.length[:-1])])
    factors, surface = first.file.checks.safety_factor, meant_for_the_surface(first)
    loads = [
        allowable_load(piece.component, factors, surface) or np.nan
        for piece in first.file.pieces[:-1]
    ]
    edge = min(np.nanmax([*loads, greatest]), _FURTHEST_LIMIT * greatest)
    axes.vlines(np.minimum(loads, edge), ends[:-1], ends[1:], **_LIMIT)
    axes.set_xlim(0.0, 1.04 * edge)
    axes.set_ylim(1.02 * float(ends[-1]), -0.02 * float(ends[-1]))
    axes.set_xlabel(QUANTITIES["tension"].label)
    axes.set_ylabel("distance along the line [m]")


def _distance(result: Result) -> Any:
    """(k,) stretched length from the free end to each node [m]."""
    shape = result.shape
    steps = np.sqrt(np.diff(shape.x) ** 2 + np.diff(shape.y) ** 2 + np.diff(shape.depth) ** 2)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _draw_plan(axes: Axes, solved: Solved) -> None:
    for number, (_, result) in enumerate(solved):
        axes.plot(result.shape.x, result.shape.y, **_style(number))
        axes.plot(result.top.x, result.top.y, "o", color=_style(number)["color"], markersize=3.5)
    axes.plot(0.0, 0.0, "v", color="black", markersize=5)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(QUANTITIES["x"].label)
    axes.set_ylabel(QUANTITIES["y"].label)


def _draw_breaks(axes: Axes, backup: Sequence[Break]) -> None:
    """What is left to lift after each break, and what is required; grey where it is not judged."""
    from matplotlib.ticker import MaxNLocator

    number = np.array([each.break_after for each in backup])
    required = np.array([each.required for each in backup])
    axes.bar(number, [each.margin for each in backup], color=[_colour(each) for each in backup])
    axes.hlines(required, number - 0.5, number + 0.5, **_LIMIT)
    axes.axhline(0.0, color="black", linewidth=0.6)
    axes.xaxis.set_major_locator(MaxNLocator(8, integer=True))
    axes.set_xlabel("break below piece no.")
    axes.set_ylabel("back-up buoyancy left [N]")


def _colour(one: Break) -> str:
    if not one.judged:
        return "#b8bec4"
    return "#8fb3cf" if one.margin >= one.required else "#d98880"
