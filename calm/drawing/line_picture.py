"""Side view and plan of a solved line [m], independent of the output format.

The picture is drawn by `line_drawing` for files and pages, `sketch` in a terminal, `plot` on
matplotlib axes, and `check_figures` for a design check.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from itertools import repeat

import numpy as np

from calm.case.design import AnyResult
from calm.case.leg_result import LegResult
from calm.case.result_tables import Shape, rows_down
from calm.case.uncertain import Uncertain
from calm.physics.line import Floats, Water
from calm.quantities import QUANTITIES, bearing_of, bearing_text

# the seabed is drawn if its depth is at most this multiple of the line's depth
_SEABED_NEAR = 1.5
_MOORED_MARGIN, _TOWED_MARGIN = 0.03, 0.04  # share of the height, above and below

NAMED_ROLES = ("float", "instrument", "release", "anchor")
"""Roles with a mark in drawings. Connectors have none; they appear only in tables."""


class LineKind(Enum):
    """Kind of a line in a picture, which determines how an output format draws the line."""

    LINE = "line"
    STILL = "still"
    BESIDE = "beside"
    BAND = "band"
    SEABED = "seabed"


@dataclass(frozen=True)
class Polyline:
    """A line in a picture: `x` to the right, and `y` along the vertical axis of the picture [m]."""

    kind: LineKind
    x: Floats
    y: Floats
    label: str = ""


@dataclass(frozen=True)
class PictureMark:
    """A marked part of the line: component id, name, role and depth [m].

    `x` and `y` are picture coordinates [m]. In a mark from `named_parts`, `x` is the distance to
    the east, and `y` the distance to the north [m].
    """

    use: str
    text: str
    role: str
    x: float
    y: float
    depth: float


@dataclass(frozen=True)
class LinePicture:
    """A picture of a line, with coordinates in metres.

    Attributes
    ----------
    lines : lines, from back to front
    marks : floats, instruments, releases and the anchor
    across, up : labels of the axes, with units
    top, bottom : depths at the edges of a side view
    height : water depth of a mooring, or height of a towed line
    surface : whether there is a sea surface at depth 0
    seabed : depth of the seabed; None if not shown
    """

    lines: tuple[Polyline, ...]
    marks: tuple[PictureMark, ...]
    across: str
    up: str
    ship: tuple[float, float] | None = None
    top: float = 0.0
    bottom: float = 0.0
    height: float = 0.0
    surface: bool = False
    seabed: float | None = None

    def span(self) -> tuple[float, float]:
        """Return the range of `x`, which includes 0.

        The line in still water is ignored.
        """
        reach = [line.x for line in self.lines if line.kind is not LineKind.STILL]
        return min(0.0, *(float(x.min()) for x in reach)), max(
            0.0, *(float(x.max()) for x in reach)
        )


def elevation_of(
    result: AnyResult, overlays: Sequence[Shape] = (), uncertain: Uncertain | None = None
) -> LinePicture:
    """Return the side view of a line, in the vertical plane of `plane_of`.

    `overlays` are other shapes to compare with the line. `uncertain` adds a band from the 5th to
    the 95th percentile.
    """
    plane, depth = plane_of(result), QUANTITIES["depth"].label
    marks = tuple(
        replace(part, x=float(along(part.x, part.y, plane)), y=part.depth)
        for part in named_parts(result)
    )
    edges = levels_of(result)
    if (tow := result.file.tow) is not None:
        line, environment = from_the_side(result.legs[0].shape, plane), result.file.environment
        across = f"distance behind the tow point [m], heading {tow.toward:.0f}°"
        ship, height = (float(line.x[-1]), float(line.y[-1])), float(np.ptp(line.y))
        water = environment.fluid == "water"
        return LinePicture(
            (line,), marks, across, depth, ship, *edges, height, water, environment.depth
        )
    lines = [*_seabeds(result), *([] if uncertain is None else [_uncertainty_band(uncertain)])]
    lines += [from_the_side(shape, plane, LineKind.BESIDE) for shape in overlays]
    legs = result.legs
    still = [leg.still_shape for leg in legs if leg.still_shape is not None]
    for kind, shapes, label in (
        (LineKind.STILL, still, "in still water"),
        (LineKind.LINE, [leg.shape for leg in legs], "in the current"),
    ):
        labels = (label, *[""] * len(shapes))  # a legend names each kind once
        lines += [from_the_side(*one) for one in zip(shapes, repeat(plane), repeat(kind), labels)]
    across = f"{QUANTITIES['offset'].label}, towards {bearing_text(bearing_of(*plane))}"
    seabed = seabed_of(result)
    return LinePicture(tuple(lines), marks, across, depth, None, *edges, seabed, True, seabed)


def plan_of(result: AnyResult, overlays: Sequence[Shape] = ()) -> LinePicture:
    """Return the plan of a line, with the anchor or the ship at the origin.

    `overlays` are shapes of the mooring in other environments, or of other designs.
    """
    shapes = [(LineKind.BESIDE, shape) for shape in overlays]
    shapes += [(LineKind.LINE, leg.shape) for leg in result.legs]
    return LinePicture(
        lines=tuple(Polyline(kind, shape.x, shape.y) for kind, shape in shapes),
        marks=tuple(named_parts(result)),
        across=QUANTITIES["x"].label,
        up=QUANTITIES["y"].label,
        ship=(0.0, 0.0) if result.towed else None,
    )


def from_the_side(
    shape: Shape, plane: Floats, kind: LineKind = LineKind.LINE, label: str = ""
) -> Polyline:
    """Project the shape of a line onto a vertical plane, as distances in the plane and depths.

    `plane` is the (2,) direction of the plane, east and north.
    """
    return Polyline(kind, along(shape.x, shape.y, plane), shape.depth, label)


def _seabeds(result: AnyResult) -> Iterator[Polyline]:
    """Yield lines of the seabed at anchors on a slope, and at anchors above the deepest seabed."""
    plane, legs = plane_of(result), result.legs
    drawn = np.concatenate([along(leg.shape.x, leg.shape.y, plane) for leg in legs])
    stand = [leg for leg in legs if leg.leg.anchored]
    deepest = max(leg.water.depth for leg in legs)
    for leg in stand:
        water, rows = leg.water, leg.components
        slope = along(water.deeper_east, water.deeper_north, plane)
        if slope or water.depth < deepest:
            at = along(rows.x_top[-1], rows.y_top[-1], plane)
            ends = at + np.array([-0.5, 0.5]) * np.ptp(drawn) / len(stand)
            place = np.clip(ends, drawn.min(), drawn.max())
            yield Polyline(LineKind.SEABED, place, water.depth + slope * (place - at))


def _uncertainty_band(uncertain: Uncertain) -> Polyline:
    (near, *_, far), (high, *_, low) = uncertain.offset, uncertain.depth_top
    return Polyline(
        LineKind.BAND,
        np.concatenate([near, far[::-1]]),
        np.concatenate([high, low[::-1]]),
        "5 to 95 %",
    )


def plane_of(result: AnyResult) -> Floats:
    """Return the horizontal direction (east, north) of the side view.

    - Mooring: from the anchor to the free end, or east if upright
    - Net: along the largest extent
    - Tow: backward from the ship
    """
    return plane_of_legs(result.legs)


def plane_of_legs(legs: Sequence[LegResult]) -> Floats:
    """Return the horizontal direction of the side view, as in `plane_of`.

    `legs` are all legs of a net, or the single leg of a mooring or tow.
    """
    if len(legs) > 1:
        depth = max(leg.water.depth for leg in legs)
        x, y = (np.concatenate([getattr(leg.shape, name) for leg in legs]) for name in "xy")
        width, axes = np.linalg.eigh(np.cov(x, y))
        wide = axes[:, 1] if width[1] > 1e-12 * depth**2 else (1.0, 0.0)
        axis = np.array(wide)
        return axis if (axis[0] + 1e-9 * axis[1]) >= 0.0 else -axis
    if (tow := legs[0].file.tow) is not None:
        heading = np.radians(tow.toward)
        return -np.array([np.sin(heading), np.cos(heading)])
    top = legs[0].top
    excursion = np.array([top.x, top.y])
    distance = np.linalg.norm(excursion)
    east = np.array([1.0, 0.0])
    return excursion / distance if distance > 1e-6 * legs[0].water.depth else east


def levels_of(result: AnyResult) -> tuple[float, float]:
    """Return the depths at the upper and lower edge of a side view [m]."""
    highest = min(float(line.shape.depth.min()) for line in result.legs)
    if not result.towed:
        depth = seabed_of(result)
        return min(-_MOORED_MARGIN * depth, highest), (1.0 + _MOORED_MARGIN) * depth
    top, bottom = min(highest, 0.0), max(float(result.legs[0].shape.depth.max()), 0.0)
    seabed = result.file.environment.depth
    if seabed is not None and seabed < _SEABED_NEAR * bottom:
        bottom = seabed
    margin = _TOWED_MARGIN * (bottom - top)
    return top - margin, bottom + margin


def seabed_of(result: AnyResult) -> float:
    """Return the maximum depth of the seabed in the picture [m].

    On a slope, the maximum may be at an end of the drawn seabed. Otherwise it is at an anchor.
    """
    beds = (float(bed.y.max()) for bed in _seabeds(result))
    return max(*(float(one.water.depth) for one in (result, *result.legs)), *beds)


def along(x: Floats | float, y: Floats | float, plane: Floats) -> Floats:
    """Return the distances of points along a horizontal direction.

    Parameters
    ----------
    x, y : distances of the points to the east and north [m]
    plane : (2,) direction, east and north
    """
    return np.asarray(x * plane[0] + y * plane[1], dtype=np.float64)


def current_between(
    water: Water, top: float, bottom: float, samples: int = 200
) -> tuple[Floats, Floats, Floats]:
    """Return depths, and the current to the east and north at these depths [m/s].

    There are `samples` equally spaced depths from `top` to `bottom` [m]. The levels of the current
    profile between `top` and `bottom` are added.
    """
    depth = np.union1d(np.linspace(top, bottom, samples), water.level)
    depth = depth[(depth >= top) & (depth <= bottom)]
    u, v = (np.interp(depth, water.level, speed) for speed in (water.u, water.v))
    return depth, u, v


def water_past(result: AnyResult) -> tuple[Floats, Floats, Floats]:
    """Return depths, and the velocity of the water relative to the line, east and north [m/s].

    For a mooring, this velocity is the current. For a tow, it is the current minus the velocity of
    the ship.
    """
    water, tow = result.water, result.file.tow
    if tow is None:
        return current_between(water, 0.0, water.depth)
    top, bottom = levels_of(result)
    behind = plane_of(result)
    above = 0.0 if result.file.environment.fluid == "water" else top
    depth, u, v = current_between(water, above, bottom)
    return depth, u + tow.speed * behind[0], v + tow.speed * behind[1]


def along_the_line(shape: Shape) -> Floats:
    """Return the stretched length from the first node to each node [m], shape (k,)."""
    steps = np.sqrt(np.diff(shape.x) ** 2 + np.diff(shape.y) ** 2 + np.diff(shape.depth) ** 2)
    return np.concatenate([[0.0], np.cumsum(steps)])


def named_parts(result: AnyResult) -> list[PictureMark]:
    """Return all floats, instruments, releases and anchors, clamped or not, in file order."""
    parts = []
    for row, clamps in rows_down(result):
        ends = (
            (row.x_top, row.x_bottom),
            (row.y_top, row.y_bottom),
            (row.depth_top, row.depth_bottom),
        )
        middle = (sum(each) / 2 for each in ends)
        parts.append(PictureMark(row.use, row.label, row.role, *middle))
        for one in clamps:
            role = one.part.component.role
            parts.append(PictureMark(one.use, one.label, role, one.x, one.y, one.depth))
    return [part for part in parts if part.role in NAMED_ROLES]


def names(parts: list[PictureMark], near: float) -> list[tuple[str, PictureMark]]:
    """Return the names to write in a drawing, each with its part.

    Adjacent parts of the same component, at most `near` [m] apart in depth, share a name such as
    ``glass 1–6``.
    """
    runs: list[list[PictureMark]] = []
    for part in parts:
        last = runs[-1][-1] if runs else None
        same = last and last.use == part.use and differ_by_number(last.text, part.text)
        if last and same and abs(part.depth - last.depth) <= near:
            runs[-1].append(part)
        else:
            runs.append([part])
    return [(together([part.text for part in run]), run[len(run) // 2]) for run in runs]


def differ_by_number(label: str, other: str) -> bool:
    """Return whether two labels differ only by a number at the end."""
    stems = [text.removesuffix(_number(text)) for text in (label, other)]
    return stems[0] == stems[1] and bool(_number(other))


def together(labels: list[str]) -> str:
    """Join labels that differ only by a number at the end to one name, such as ``glass 1–6``."""
    return labels[0] if len(labels) == 1 else f"{labels[0]}–{_number(labels[-1])}"


def spread(wanted: list[float], gap: float, start: float, end: float) -> list[float]:
    """Shift positions as little as possible, to obtain a minimum distance between positions.

    The sum of the squared shifts is minimal. `wanted` is in ascending order. The new positions are
    from `start` to `end`, but extend beyond `end` if there is not enough room.
    """
    # isotonic regression of the positions without the gaps
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


def _number(label: str) -> str:
    return label[len(label.rstrip("0123456789")) :]
