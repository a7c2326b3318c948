"""What the drawings of a mooring and of a tow have in common: views, markers and names."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.quantities import QUANTITIES
from calm.report.labels import NAMED_ROLES, Named, named_parts, names, spread

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from calm.case import Result, TowResult

    Floats = NDArray[np.float64]

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


def texts(result: Result | TowResult, extent: float) -> list[tuple[str, Named]]:
    """The names to write; one stands for what lies within one line of text.

    Parameters
    ----------
    extent : height of the elevation [m]
    """
    near = extent * _LINE_HEIGHT / (_LEAST_HEIGHT - _FRAME)
    return sorted(names(named_parts(result), near), key=lambda named: named[1].depth)


def figure_height(written: list[tuple[str, Named]]) -> float:
    """Height [inches] of a figure that has room for the names."""
    return min(max(_LEAST_HEIGHT, len(written) * _LINE_HEIGHT + _FRAME), _GREATEST_HEIGHT)


def set_span(axes: Axes, start: float, end: float, height: float) -> None:
    """Give the line, from `start` to `end` [m], its share of the width; plumb lines look plumb.

    `height` [m] is that of the drawing.
    """
    span = max(end - start, _LEAST_SPAN * height)
    axes.set_xlim(start - 0.05 * span, start + span / _SHARE_OF_LINE)


def mark_parts(
    axes: Axes, result: Result | TowResult, place: Callable[[Named], tuple[float, float]]
) -> None:
    """Mark the named parts, in one group for each role that occurs, `place` giving both axes."""
    parts = named_parts(result)
    for role in NAMED_ROLES:
        points = [place(part) for part in parts if part.role == role]
        if points:
            sign, size, colour = SIGNS[role]
            x, y = zip(*points, strict=True)
            axes.plot(x, y, sign, label=role, color=colour, markersize=size)


def write_names(
    axes: Axes,
    written: list[tuple[str, Named]],
    height: float,
    abscissa: Callable[[Named], float],
) -> None:
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
    places = spread(wanted, line, line / 2, 1.0 - line / 2)
    for (text, part), place in zip(written, places, strict=True):
        axes.annotate(
            text,
            xy=(abscissa(part), part.depth),
            xytext=(_SHARE_OF_LINE + 0.1, 1.0 - place),
            textcoords="axes fraction",
            fontsize=_FONT_SIZE * line * height / _LINE_HEIGHT,
            verticalalignment="center",
            parse_math=False,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5},
            arrowprops={
                "arrowstyle": "-",
                "color": "grey",
                "linewidth": 0.5,
                "relpos": (0.0, 0.5),
            },
        )


def draw_flow(axes: Axes, depth: Floats, u: Floats, v: Floats, plane: Floats) -> None:
    """Speed by depth, and the part of it in a vertical plane where that is another.

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


def draw_plan(axes: Axes, result: Result | TowResult) -> None:
    """The line from above, both axes to one scale."""
    axes.plot(result.shape.x, result.shape.y, **LINE_STYLE)
    mark_parts(axes, result, lambda part: (part.x, part.y))
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(QUANTITIES["x"].label)
    axes.set_ylabel(QUANTITIES["y"].label)
    axes.legend(ncols=2, **LEGEND)


def along(x: Floats | float, y: Floats | float, plane: Floats) -> Floats:
    """Distance along the direction of a plane, of points east and north."""
    return np.asarray(x * plane[0] + y * plane[1], dtype=np.float64)
