"""Current, density and viscosity by depth, as the march looks them up."""

from collections.abc import MutableSequence, Sequence
from functools import cached_property
from math import inf, isfinite, sqrt
from typing import NamedTuple

from calm.physics.compiled import packed, within
from calm.physics.line import Floats, Water
from calm.physics.seawater import REFERENCE_DENSITY

SLIVER = 0.01
"""Part of a segment, as a share of it, at which no chosen segment ends."""


NEAR_A_LEVEL = 1e-6
"""Depth range beyond a level, as a share of that of the segment, that is never split off: in still
water at the level any part counts."""


class Interval(NamedTuple):
    """The water between two levels: its origin [m], values there and what they grow by per metre.

    Current u, v, w [m/s] and density [kg/m³].
    """

    origin: float
    u: float
    du: float
    v: float
    dv: float
    w: float
    dw: float
    density: float
    ddensity: float


class Stratum(NamedTuple):
    """Kinematic viscosity from a depth on [m]: its value there [m²/s] and growth per metre."""

    top: float
    origin: float
    value: float
    slope: float


class Sea(NamedTuple):
    """The water as the march takes it.

    Attributes
    ----------
    levels : depths that bound the intervals [m], from -inf to inf
    intervals : the water in each
    bends : at each level, see `find_bends` [1/m]
    gravity : [m/s²]
    strata : kinematic viscosity, from -inf down
    """

    levels: Sequence[float]
    intervals: Sequence[Interval]
    bends: Sequence[float]
    gravity: float
    strata: Sequence[Stratum]


def interval_at(levels: Sequence[float], depth: float, i: int) -> int:
    """Index of the interval that holds `depth` [m], searched from interval `i`.

    Where a line has run off to infinity, that one.
    """
    if not isfinite(depth):
        return i
    while depth >= levels[i + 1]:
        i += 1
    while depth < levels[i]:
        i -= 1
    return i


@within
def water_at(sea: Sea, depth: float, i: int) -> tuple[float, float, float, float, int]:
    """Current u, v, w [m/s], density [kg/m³] and interval at a depth [m], searched from one."""
    levels = sea.levels
    if not levels[i] <= depth < levels[i + 1]:
        i = interval_at(levels, depth, i)
    row = sea.intervals[i]
    below = depth - row.origin
    return (
        row.u + row.du * below,
        row.v + row.dv * below,
        row.w + row.dw * below,
        row.density + row.ddensity * below,
        i,
    )


def viscosity_at(sea: Sea, depth: float) -> float:
    """Kinematic viscosity at a depth [m²/s]."""
    i = len(sea.strata) - 1
    while depth < sea.strata[i].top:
        i -= 1
    stratum = sea.strata[i]
    return stratum.value + stratum.slope * (depth - stratum.origin)


def distance_to_bend(
    sea: Sea, depth: float, sinking: float, i: int, length: float, share: float
) -> float:
    """Way from a depth to where the drag bends next, along a path that sinks so much per metre [m].

    That is at the next level; and before it where the flow is least, if it all but vanishes within
    a length: |V| V bends there. Searched from interval `i`. A level no farther than `SLIVER` of the
    length is as good as reached, unless a segment of that length has to be split there.

    Parameters
    ----------
    length : of a segment [m]
    share : see `counts_across`
    """
    if sinking == 0.0 or not isfinite(sinking):
        return inf
    down, deep = sinking > 0.0, length * abs(sinking)
    i = interval_at(sea.levels, depth, i)
    k = i + 1 if down else i
    gap = (sea.levels[k] - depth) / sinking
    while gap <= SLIVER * length:
        off = abs(sea.levels[k] - depth)
        if counts_across(sea, k, min(off, deep - off), deep, share):
            break
        k += 1 if down else -1
        gap = (sea.levels[k] - depth) / sinking
    row, shorter = sea.intervals[k - 1 if down else k], min(length, gap)
    square = row.du * row.du + row.dv * row.dv + row.dw * row.dw
    if square > 0.0:
        growth = row.u * row.du + row.v * row.dv + row.w * row.dw
        way = (row.origin - growth / square - depth) / sinking
        if SLIVER * shorter < way < shorter:
            least = row.u * row.u + row.v * row.v + row.w * row.w - growth * growth / square
            if least < square * shorter * shorter * sinking * sinking:
                return way
    return gap


def in_interval(sea: Sea, i: int, start: float, end: float) -> bool:
    """Whether two depths are in an interval [m]."""
    upper, lower = sea.levels[i], sea.levels[i + 1]
    return upper <= start < lower and upper <= end < lower


def level_within(sea: Sea, hint: int, start: float, end: float, share: float) -> int:
    """Index of the first level that a straight segment has to be split at; 0 if there is none.

    Parameters
    ----------
    hint : interval from which the ends are searched
    start, end : depths of the ends of the segment [m]
    share : see `counts_across`
    """
    levels = sea.levels
    i, last = interval_at(levels, start, hint), interval_at(levels, end, hint)
    while i != last:
        k = i + 1 if last > i else i
        off = min(abs(levels[k] - start), abs(levels[k] - end))
        if counts_across(sea, k, off, abs(end - start), share):
            return k
        i += 1 if last > i else -1
    return 0


@within
def counts_across(sea: Sea, k: int, off: float, length: float, share: float) -> bool:
    """Whether a segment that extends beyond a level needs to be split there.

    The water at the middle of a segment stands for the mean along it. If the slope of the current
    changes by b at a level, the mean is off by b·off²/(2·length): twice that may be at most `share`
    of the flow at the level. The same holds for the density, which jumps where a tow leaves the
    water.

    Parameters
    ----------
    k : index of the level
    off : depth range of the segment on the far side of the level [m]
    length : depth range of the segment [m]
    """
    return off > NEAR_A_LEVEL * length and sea.bends[k] * off * off > share * length


def find_bends(intervals: Sequence[Interval], bends: MutableSequence[float]) -> None:
    """Fill in by how much the slopes of current and density change at each level, over the current
    and the density there [1/m].

    Parameters
    ----------
    intervals : of the water, whose k-th begins at level k
    bends : one for each level, from -inf to inf
    """
    bends[0] = 0.0
    for k in range(1, len(intervals)):
        above, below = intervals[k - 1], intervals[k]
        du, dv, dw = below.du - above.du, below.dv - above.dv, below.dw - above.dw
        bend = sqrt(du * du + dv * dv + dw * dw)
        flow = sqrt(below.u * below.u + below.v * below.v + below.w * below.w)
        dense = abs(below.ddensity - above.ddensity) / below.density
        bends[k] = dense
        if bend > dense * flow:
            bends[k] = bend / flow if flow > 0.0 else inf
    bends[len(intervals)] = 0.0


class Profile:
    """A `Water` laid out for the march, extended beyond its first and last level."""

    def __init__(self, water: Water) -> None:
        depths = water.level.tolist()
        columns = [
            number
            for values in (water.u, water.v, water.w, water.density)
            for number in _values_and_slopes(depths, values)
        ]
        origins = [depths[0], *depths]
        viscous = water.viscosity_level.tolist()
        intervals = [Interval(*row) for row in zip(origins, *columns, strict=True)]
        bends = [0.0] * (len(depths) + 2)
        find_bends(intervals, bends)
        self.sea = Sea(
            [-inf, *depths, inf],
            intervals,
            bends,
            water.gravity,
            [
                Stratum(*row)
                for row in zip(
                    [-inf, *viscous],
                    [viscous[0], *viscous],
                    *_values_and_slopes(viscous, water.viscosity),
                    strict=True,
                )
            ],
        )

    @cached_property
    def packed(self) -> Sea:
        """Return the same as compiled laws take it."""
        sea: Sea = packed(self.sea)
        return sea

    def excess_at(self, depth: float) -> float:
        """Return what a displaced cubic metre lifts more at a depth than in reference water
        [N/m³].
        """
        *_, density, _ = water_at(self.sea, depth, 0)
        return (density - REFERENCE_DENSITY) * self.sea.gravity


def _values_and_slopes(depths: list[float], column: Floats) -> tuple[list[float], list[float]]:
    """Value at its origin and slope of every interval; constant in the first and the last."""
    values = column.tolist()
    slopes = [
        (values[i + 1] - values[i]) / (depths[i + 1] - depths[i]) for i in range(len(depths) - 1)
    ]
    return [values[0], *values], [0.0, *slopes, 0.0]
