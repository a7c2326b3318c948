"""A mooring drawn: elevation in the plane of its excursion, the current beside it, and the plan."""

from __future__ import annotations

import io
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from calm.errors import UsageError
from calm.quantities import QUANTITIES
from calm.report.labels import NAMED_ROLES, Named, named_parts, names, spread

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from calm.case import Result

    Floats = NDArray[np.float64]

FORMATS = (".png", ".svg")
"""The endings a picture's file name may have."""

_MARKERS: dict[str, dict[str, Any]] = {
    role: {"linestyle": "none", "marker": marker, "color": colour, "markersize": size}
    for role, marker, colour, size in (
        ("float", "o", "#e69f00", 7),
        ("instrument", "s", "#cc3311", 4.5),
        ("release", "D", "#009e73", 5),
        ("anchor", "v", "black", 6),
    )
}
_LINE = "#0b3c5d"
_FONT_SIZE = 8.0  # points
_LINE_HEIGHT = 1.3 * _FONT_SIZE / 72  # inches
_WIDTH = 11.0  # inches
_LEAST_HEIGHT, _GREATEST_HEIGHT = 6.5, 20.0  # inches
_FRAME = 1.5  # inches above and below the axes, for titles and ticks
# The drawn line keeps to this share of the width of the elevation; the names stand beyond it.
_SHARE_OF_LINE = 0.55
# Offsets are drawn to at least this share of the depth, lest a still line look tortured.
_LEAST_SPAN = 0.1


def check_format(path: Path) -> None:
    """Refuse a picture whose file name does not end in one of `FORMATS`.

    Raises
    ------
    UsageError
        Naming the endings that are allowed.
    """
    if path.suffix.lower() not in FORMATS:
        allowed = " or ".join(FORMATS)
        raise UsageError(f"cannot draw {path}: a picture's name ends in {allowed}")


def picture(result: Result, suffix: str) -> bytes:
    """The figure as a file: PNG at 150 dots per inch, or SVG with its texts as text.

    Parameters
    ----------
    result : Result
        A solved mooring.
    suffix : str
        One of `FORMATS`.
    """
    import matplotlib

    content = io.BytesIO()
    with (
        matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": "calm"}),
        warnings.catch_warnings(),
    ):
        # A label may hold signs that the font lacks; they show as boxes.
        warnings.filterwarnings("ignore", message="Glyph")
        figure = draw(result)
        if suffix.lower() == ".svg":
            figure.savefig(content, format="svg", metadata={"Date": None})
        else:
            figure.savefig(content, format="png", dpi=150)
    return content.getvalue()


def draw(result: Result) -> Figure:
    """A figure of three views, which belongs to no window.

    The elevation is in the vertical plane of the anchor and the free end, with the same line in
    still water dashed; the current is shown as its speed and as its part in that plane.
    """
    from matplotlib.figure import Figure

    texts = _texts(result)
    needed = len(texts) * _LINE_HEIGHT + _FRAME
    height = min(max(_LEAST_HEIGHT, needed), _GREATEST_HEIGHT)
    figure = Figure(figsize=(_WIDTH, height), layout="constrained")
    elevation, current, plan = figure.subplots(1, 3, width_ratios=(5, 1.5, 3))
    current.sharey(elevation)
    figure.suptitle(result.name, parse_math=False)

    plane = _plane(result)
    _draw_elevation(elevation, result, plane)
    _write_names(elevation, result, plane, height - _FRAME)
    _draw_current(current, result, plane)
    _draw_plan(plan, result)
    return figure


def _plane(result: Result) -> Floats:
    """(2,) direction, east and north, from the anchor to the free end; east when upright."""
    excursion = np.array([result.top.x, result.top.y])
    distance = np.linalg.norm(excursion)
    east = np.array([1.0, 0.0])
    return excursion / distance if distance > 1e-6 * result.mooring.water.depth else east


def _draw_elevation(axes: Axes, result: Result, plane: Floats) -> None:
    depth = result.mooring.water.depth
    along = _along(result.shape.x, result.shape.y, plane)
    axes.axhline(0.0, color="#3399cc", linewidth=1)
    axes.axhspan(depth, 1.05 * depth, color="#d9c7a3")
    if result.still_shape is not None:
        still = _along(result.still_shape.x, result.still_shape.y, plane)
        label = "in still water"
        axes.plot(still, result.still_shape.depth, "--", color="grey", linewidth=1, label=label)
    axes.plot(along, result.shape.depth, color=_LINE, linewidth=1.5, label="in the current")
    for role, parts in _by_role(result):
        x, y, depths = np.array([(part.x, part.y, part.depth) for part in parts]).T
        axes.plot(_along(x, y, plane), depths, **_MARKERS[role])
    left, right = min(0.0, along.min()), max(0.0, along.max())
    span = max(right - left, _LEAST_SPAN * depth)
    axes.set_xlim(left - 0.05 * span, left + span / _SHARE_OF_LINE)
    axes.set_ylim(1.03 * depth, min(-0.03 * depth, result.shape.depth.min()))
    axes.set_xlabel(f"{QUANTITIES['offset'].label}, towards {_bearing(plane):.0f}°")
    axes.set_ylabel(QUANTITIES["depth"].label)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False)


def _texts(result: Result) -> list[tuple[str, Named]]:
    """The names to write; one stands for what lies within one line of text."""
    line = result.mooring.water.depth * _LINE_HEIGHT / (_LEAST_HEIGHT - _FRAME)
    return names(named_parts(result), near=line)


def _write_names(axes: Axes, result: Result, plane: Floats, height: float) -> None:
    """Names in a column right of the line, each with a thin line to its part."""
    texts = _texts(result)
    line = min(_LINE_HEIGHT, height / len(texts)) / height
    bottom, top = axes.get_ylim()
    wanted = [(part.depth - top) / (bottom - top) for _, part in texts]
    places = spread(wanted, line, line / 2, 1.0 - line / 2)
    for (text, part), place in zip(texts, places, strict=True):
        axes.annotate(
            text,
            xy=(float(_along(part.x, part.y, plane)), part.depth),
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


def _draw_current(axes: Axes, result: Result, plane: Floats) -> None:
    water = result.mooring.water
    depth = np.union1d(np.linspace(0.0, water.depth, 200), water.level)
    depth = depth[(depth >= 0.0) & (depth <= water.depth)]
    u, v = (np.interp(depth, water.level, speed) for speed in (water.u, water.v))
    axes.axvline(0.0, color="grey", linewidth=0.5)
    axes.plot(np.hypot(u, v), depth, color="#3399cc", label="speed")
    axes.plot(_along(u, v, plane), depth, "--", color="#3399cc", linewidth=1, label="in the plane")
    axes.set_xlabel(f"current {QUANTITIES['speed'].label}")
    axes.tick_params(labelleft=False)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), frameon=False)


def _draw_plan(axes: Axes, result: Result) -> None:
    axes.plot(result.shape.x, result.shape.y, color=_LINE, linewidth=1.5)
    for role, parts in _by_role(result):
        x, y = np.array([(part.x, part.y) for part in parts]).T
        axes.plot(x, y, label=role, **_MARKERS[role])
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(QUANTITIES["x"].label)
    axes.set_ylabel(QUANTITIES["y"].label)
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, frameon=False)


def _by_role(result: Result) -> list[tuple[str, list[Named]]]:
    """The parts to mark, in one group for each role that occurs."""
    parts = named_parts(result)
    groups = [(role, [part for part in parts if part.role == role]) for role in NAMED_ROLES]
    return [(role, group) for role, group in groups if group]


def _along(x: Floats | float, y: Floats | float, plane: Floats) -> Floats:
    return np.asarray(x * plane[0] + y * plane[1], dtype=np.float64)


def _bearing(plane: Floats) -> float:
    """Degrees clockwise from north."""
    return float(np.degrees(np.arctan2(plane[0], plane[1])) % 360.0)
