"""Current, density and viscosity against depth, as used by the march."""

from collections.abc import MutableSequence, Sequence
from functools import cached_property
from math import inf, isfinite, sqrt
from typing import NamedTuple

from calm.physics.compiled import packed, within
from calm.physics.line import Floats, Water, once_per_input
from calm.physics.seawater import REFERENCE_DENSITY

LEAST_PART = 0.01
"""Least length of a segment that is shortened to end at a kink of the drag.

The length is a fraction of the segment's full length.
"""


NEAR_A_LEVEL = 1e-6
"""Limit for splitting a segment at a level, as a fraction of the segment's depth range.

A segment that extends less far beyond the level is not split. Without this limit, a segment would
be split again and again at a level with no flow.
"""


class Interval(NamedTuple):
    """Current u, v, w [m/s] and density [kg/m³] of the water between two levels.

    Each quantity has a value at the depth `origin` [m] and an increase per metre of depth.
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
    """Kinematic viscosity of the water below the depth `top` [m].

    `value` is the viscosity at the depth `origin` [m²/s], and `slope` its increase per metre of
    depth.
    """

    top: float
    origin: float
    value: float
    slope: float


class Sea(NamedTuple):
    """Water profile in the form used by the march.

    Attributes
    ----------
    levels : depths that bound the intervals [m], from -inf to inf
    intervals : water in each interval
    bends : relative change of the slopes of current and density at each level [1/m]
    gravity : acceleration of gravity [m/s²]
    strata : kinematic viscosity, from the top down; the first stratum begins at -inf
    """

    levels: Sequence[float]
    intervals: Sequence[Interval]
    bends: Sequence[float]
    gravity: float
    strata: Sequence[Stratum]


def interval_at(levels: Sequence[float], depth: float, i: int) -> int:
    """Return the index of the interval that contains `depth` [m], searching from interval `i`.

    The result is `i` if the depth is not finite, which means that the line has diverged.
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
    """Return current u, v, w [m/s], density [kg/m³], and index of the interval, at a depth [m].

    The search for the interval starts at interval `i`.
    """
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
    """Return the kinematic viscosity at a depth [m²/s]."""
    i = len(sea.strata) - 1
    while depth < sea.strata[i].top:
        i -= 1
    stratum = sea.strata[i]
    return stratum.value + stratum.slope * (depth - stratum.origin)


def distance_to_bend(
    sea: Sea, depth: float, sinking: float, i: int, length: float, share: float
) -> float:
    """Return the distance [m] along a path to the next point where the drag has a kink.

    The drag has a kink at a level, and where the flow almost vanishes. Kinks nearer than
    `LEAST_PART` times the segment length are skipped. A level that has to split the segment is
    never skipped.

    Parameters
    ----------
    depth : depth at the start of the path [m]
    sinking : increase in depth per metre of the path [-]
    i : interval at which the search starts
    length : length of a segment [m]
    share : see `counts_across`
    """
    if sinking == 0.0 or not isfinite(sinking):
        return inf
    down, deep = sinking > 0.0, length * abs(sinking)
    i = interval_at(sea.levels, depth, i)
    k = i + 1 if down else i
    gap = (sea.levels[k] - depth) / sinking
    while gap <= LEAST_PART * length:
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
        if LEAST_PART * shorter < way < shorter:
            least = row.u * row.u + row.v * row.v + row.w * row.w - growth * growth / square
            if least < square * shorter * shorter * sinking * sinking:
                return way
    return gap


def in_interval(sea: Sea, i: int, start: float, end: float) -> bool:
    """Return whether two depths [m] are both in interval `i`."""
    upper, lower = sea.levels[i], sea.levels[i + 1]
    return upper <= start < lower and upper <= end < lower


def level_within(sea: Sea, hint: int, start: float, end: float, share: float) -> int:
    """Return the index of the first level at which a straight segment has to be split, or 0.

    `start` and `end` are the depths of the ends of the segment [m]. The search for the two depths
    begins at interval `hint`. `share` is as in `counts_across`.
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


def counts_across(sea: Sea, k: int, off: float, length: float, share: float) -> bool:
    """Return whether a segment that crosses a level has to be split at the level.

    Without a split, the water at the midpoint differs from the mean along the segment. If the slope
    of the current changes by b at the level, the difference is b·off²/(2·length).

    Parameters
    ----------
    k : index of the level
    off : depth range of the part of the segment beyond the level [m]
    length : depth range of the whole segment [m]
    share : twice the allowed difference, as a fraction of the current or density [-]
    """
    return off > NEAR_A_LEVEL * length and sea.bends[k] * off * off > share * length


def find_bends(intervals: Sequence[Interval], bends: MutableSequence[float]) -> None:
    """Compute the change of the slopes of current and density at each level.

    The change is relative to the current and the density at the level [1/m]. Interval k begins at
    level k; the first and the last level are at -inf and inf. `bends` receives one value per level.
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
    """Water profile in the form used by the march.

    Above the first level and below the last level, all values are constant.
    """

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
        """The profile as arrays, for compiled code."""
        sea: Sea = packed(self.sea)
        return sea

    def excess_at(self, depth: float) -> float:
        """Return the excess buoyancy per displaced cubic metre at a depth [N/m³].

        The excess is relative to reference water.
        """
        *_, density, _ = water_at(self.sea, depth, 0)
        return (density - REFERENCE_DENSITY) * self.sea.gravity


profile_of = once_per_input(Profile)
"""Return the `Profile` of a `Water`."""


def _values_and_slopes(depths: list[float], column: Floats) -> tuple[list[float], list[float]]:
    """Return value at the origin and slope for every interval; the outer slopes are zero."""
    values = column.tolist()
    slopes = [
        (values[i + 1] - values[i]) / (depths[i + 1] - depths[i]) for i in range(len(depths) - 1)
    ]
    return [values[0], *values], [0.0, *slopes, 0.0]
