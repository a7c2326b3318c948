"""A solved line seen from the side and from above: what is drawn, in metres, for every printer.

`calm.drawing.line_drawing` draws it for files and pages, `calm.drawing.check_figures` beside others
of a check, `calm.drawing.sketch` in a terminal and `calm.drawing.plot` on axes of matplotlib.
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

# The seabed is drawn when it is no deeper than this many times the line.
_SEABED_NEAR = 1.5
_MOORED_MARGIN, _TOWED_MARGIN = 0.03, 0.04  # of the height, above and below

NAMED_ROLES = ("float", "instrument", "release", "anchor")
"""The roles a drawing marks; what only joins them is left to the table."""


class LineKind(Enum):
    """Tell what a line of a picture stands for; each printer has its strokes for it."""

    LINE = "line"
    STILL = "still"
    BESIDE = "beside"
    BAND = "band"
    SEABED = "seabed"


@dataclass(frozen=True)
class Polyline:
    """Hold the points of a line: `x` to the right, `y` of the picture's other axis [m]."""

    kind: LineKind
    x: Floats
    y: Floats
    label: str = ""


@dataclass(frozen=True)
class PictureMark:
    """Hold a marked point of the line: its component, name, role and depth [m].

    `x` and `y` are its place in the picture; east and north [m] as `named_parts` has them.
    """

    use: str
    text: str
    role: str
    x: float
    y: float
    depth: float


@dataclass(frozen=True)
class LinePicture:
    """Represent a picture of a line.

    Attributes
    ----------
    lines : what is drawn behind before what is drawn over it
    marks : floats, instruments, releases and the anchor
    top, bottom : depths at the edges of a view from the side, with their margins [m]
    height : of the water that is moored in, or of the line that is towed [m]
    surface : whether the sea surface lies at depth 0
    seabed : its depth [m]; None where it is not in the picture
    ship : where the ship is, of a tow
    across, up : what the axes show, with their units
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
        """Return the least and the greatest `x`, zero among them; still water does not count."""
        reach = [line.x for line in self.lines if line.kind is not LineKind.STILL]
        return min(0.0, *(float(x.min()) for x in reach)), max(
            0.0, *(float(x.max()) for x in reach)
        )


def elevation_of(
    result: AnyResult, beside: Sequence[Shape] = (), uncertain: Uncertain | None = None
) -> LinePicture:
    """Return a line in the vertical plane of its excursion, or of its tow.

    Parameters
    ----------
    beside : shapes of the mooring in other environments, or of other designs
    uncertain : of a mooring; the band between its 5 and 95 %
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
    lines = [*_beds(result), *([] if uncertain is None else [_band(uncertain)])]
    lines += [from_the_side(shape, plane, LineKind.BESIDE) for shape in beside]
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


def plan_of(result: AnyResult, beside: Sequence[Shape] = ()) -> LinePicture:
    """Return a line from above, its anchor, or the ship, at zero; shapes `beside` it too."""
    shapes = [(LineKind.BESIDE, shape) for shape in beside]
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
    """Return a shape in a vertical plane, distances along it and depths.

    Parameters
    ----------
    plane : (2,) direction of the plane, east and north
    kind, label : what it stands for, and what a legend says of it
    """
    return Polyline(kind, along(shape.x, shape.y, plane), shape.depth, label)


def _beds(result: AnyResult) -> Iterator[Polyline]:
    """The seabed about each anchor, if it slopes there or is not as deep as at the deepest one."""
    plane, legs = plane_of(result), result.legs
    drawn = np.concatenate([along(leg.shape.x, leg.shape.y, plane) for leg in legs])
    stand = [leg for leg in legs if leg.leg.anchored]
    deepest = max(leg.water.depth for leg in legs)
    for leg in stand:
        water, rows = leg.water, leg.components
        slope = along(water.deeper_east, water.deeper_north, plane)
        if slope or water.depth < deepest:
            at = along(rows.x_top[-1], rows.y_top[-1], plane)
            beside = at + np.array([-0.5, 0.5]) * np.ptp(drawn) / len(stand)
            place = np.clip(beside, drawn.min(), drawn.max())
            yield Polyline(LineKind.SEABED, place, water.depth + slope * (place - at))


def _band(uncertain: Uncertain) -> Polyline:
    """The outline of the line between its 5 and 95 % of offset and depth."""
    (near, *_, far), (high, *_, low) = uncertain.offset, uncertain.depth_top
    return Polyline(
        LineKind.BAND,
        np.concatenate([near, far[::-1]]),
        np.concatenate([high, low[::-1]]),
        "5 to 95 %",
    )


def plane_of(result: AnyResult) -> Floats:
    """Return the direction, east and north, from the anchor to the free end, or behind the ship.

    It is east of a mooring that stands upright, and of a net the one in which it is widest.
    """
    return plane_of_legs(result.legs)


def plane_of_legs(legs: Sequence[LegResult]) -> Floats:
    """The same of one leg, or of those of a net."""
    depth = max(leg.water.depth for leg in legs)
    if len(legs) > 1:
        x, y = (np.concatenate([getattr(leg.shape, name) for leg in legs]) for name in "xy")
        width, ways = np.linalg.eigh(np.cov(x, y))
        wide = ways[:, 1] if width[1] > 1e-12 * depth**2 else (1.0, 0.0)
        way = np.array(wide)
        return way if (way[0] + 1e-9 * way[1]) >= 0.0 else -way
    if (tow := legs[0].file.tow) is not None:
        heading = np.radians(tow.toward)
        return -np.array([np.sin(heading), np.cos(heading)])
    top = legs[0].top
    excursion = np.array([top.x, top.y])
    distance = np.linalg.norm(excursion)
    east = np.array([1.0, 0.0])
    return excursion / distance if distance > 1e-6 * depth else east


def levels_of(result: AnyResult) -> tuple[float, float]:
    """Return the depths at the upper and the lower edge of a view from the side [m]."""
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
    """Return the depth of the water at the deepest anchor, or of a seabed drawn deeper [m]."""
    beds = (float(bed.y.max()) for bed in _beds(result))
    return max(*(float(one.water.depth) for one in (result, *result.legs)), *beds)


def along(x: Floats | float, y: Floats | float, plane: Floats) -> Floats:
    """Return the distance along the direction of a plane, of points east and north."""
    return np.asarray(x * plane[0] + y * plane[1], dtype=np.float64)


def current_between(
    water: Water, top: float, bottom: float, samples: int = 200
) -> tuple[Floats, Floats, Floats]:
    """Return depths, and the current east and north there [m/s], with the profile's own levels.

    Parameters
    ----------
    top, bottom : depths between which it is wanted [m]
    samples : how many depths, at least
    """
    depth = np.union1d(np.linspace(top, bottom, samples), water.level)
    depth = depth[(depth >= top) & (depth <= bottom)]
    u, v = (np.interp(depth, water.level, speed) for speed in (water.u, water.v))
    return depth, u, v


def water_past(result: AnyResult) -> tuple[Floats, Floats, Floats]:
    """Return depths, and the speed of the water past the line there, east and north [m/s].

    It is the current of a mooring and a net; a tow adds the speed of its ship.
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
    """Return the (k,) stretched length from the first node to each node [m]."""
    steps = np.sqrt(np.diff(shape.x) ** 2 + np.diff(shape.y) ** 2 + np.diff(shape.depth) ** 2)
    return np.concatenate([[0.0], np.cumsum(steps)])


def named_parts(result: AnyResult) -> list[PictureMark]:
    """Return the floats, instruments, releases and the anchor, clamped ones too, in file order."""
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
    """Texts to write, each with the part it points at.

    Neighbours of one component within `near` [m] of each other whose labels differ only by a
    number at the end are named together: ``glass 1–6``.
    """
    runs: list[list[PictureMark]] = []
    for part in parts:
        last = runs[-1][-1] if runs else None
        same = last and last.use == part.use and alike(last.text, part.text)
        if last and same and abs(part.depth - last.depth) <= near:
            runs[-1].append(part)
        else:
            runs.append([part])
    return [(together([part.text for part in run]), run[len(run) // 2]) for run in runs]


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


def _number(label: str) -> str:
    """The digits at the end of a label."""
    return label[len(label.rstrip("0123456789")) :]
