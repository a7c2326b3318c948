"""What drawings of lines have in common: views, markers, names and where these stand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.case.result_tables import rows_down
from calm.quantities import QUANTITIES

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


NAMED_ROLES = ("float", "instrument", "release", "anchor")
"""The roles a drawing marks; what only joins them is left to the table."""


@dataclass(frozen=True)
class Named:
    """A marked point of the line: text, role, and position [m] east, north and down."""

    use: str
    text: str
    role: str
    x: float
    y: float
    depth: float


def named_parts(result: Result | TowResult) -> list[Named]:
    """The floats, instruments, releases and the anchor, clamped ones too, in file order."""
    parts = []
    for component, clamps in rows_down(result):
        x = (component.x_top + component.x_bottom) / 2
        y = (component.y_top + component.y_bottom) / 2
        depth = (component.depth_top + component.depth_bottom) / 2
        parts.append(Named(component.use, component.label, component.role, x, y, depth))
        parts += [
            Named(clamp.use, clamp.label, clamp.part.component.role, clamp.x, clamp.y, clamp.depth)
            for clamp in clamps
        ]
    return [part for part in parts if part.role in NAMED_ROLES]


def names(parts: list[Named], near: float) -> list[tuple[str, Named]]:
    """Texts to write, each with the part it points at.

    Neighbours of one component within `near` [m] of each other whose labels differ only by a
    number at the end are named together: ``glass 1–6``.
    """
    runs: list[list[Named]] = []
    for part in parts:
        last = runs[-1][-1] if runs else None
        if last and _is_next(last, part) and abs(part.depth - last.depth) <= near:
            runs[-1].append(part)
        else:
            runs.append([part])
    texts = []
    for run in runs:
        texts.append((together([part.text for part in run]), run[len(run) // 2]))
    return texts


def alike(label: str, other: str) -> bool:
    """Return whether two labels differ only by a number at the end."""
    stems = [text.removesuffix(_number(text)) for text in (label, other)]
    return stems[0] == stems[1] and bool(_number(other))


def together(labels: list[str]) -> str:
    """One name for labels that are alike: ``glass 1–6``."""
    return labels[0] if len(labels) == 1 else f"{labels[0]}–{_number(labels[-1])}"


def spread(wanted: list[float], gap: float, start: float, end: float) -> list[float]:
    """Positions at least `gap` apart, in the given ascending order, as near as can be to `wanted`.

    The sum of the squared shifts is the least possible between `start` and `end`; where not all
    fit, they pass the end. Once each position is reduced by the gaps before it, they only have to
    ascend: what then descends is pooled at its mean (isotonic regression).
    """
    pools: list[tuple[float, int]] = []
    for index, position in enumerate(wanted):
        mean, count = position - index * gap, 1
        while pools and pools[-1][0] > mean:
            other, size = pools.pop()
            mean, count = (mean * count + other * size) / (count + size), count + size
        pools.append((mean, count))
    last = max(start, end - (len(wanted) - 1) * gap)
    reduced = [min(max(mean, start), last) for mean, count in pools for _ in range(count)]
    return [position + index * gap for index, position in enumerate(reduced)]


def _is_next(part: Named, other: Named) -> bool:
    """Return whether two parts are the same component under the same label, numbers apart."""
    return part.use == other.use and alike(part.text, other.text)


def _number(label: str) -> str:
    """The digits at the end of a label."""
    return label[len(label.rstrip("0123456789")) :]
