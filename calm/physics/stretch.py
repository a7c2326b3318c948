"""Stretch of a rope from its elongation curve."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import isfinite, sqrt
from typing import NamedTuple

TRUSTED_LOAD = 0.8
"""Fraction of the breaking load above which elongation curves are unreliable."""

_GAUSS = sqrt(1.0 / 3.0)


class Knot(NamedTuple):
    """Point of an elongation curve (interpolation knot).

    Up to the next point, the strain is a + x (b + x (c + x d)), where x is the tension minus
    `tension` [N].
    """

    tension: float
    a: float
    b: float
    c: float
    d: float


def curve_strain(knots: Sequence[Knot], first: int, end: int, tension: float) -> float:
    """Return the strain of a rope at a tension ≥ 0 [N].

    The rope's elongation curve has the knots `first` to `end` - 1. The strain is interpolated by
    monotone cubics, and linear above the last knot.
    """
    knot = knots[_knots_below(knots, first + 1, end, tension) - 1]
    x = tension - knot.tension
    return knot.a + x * (knot.b + x * (knot.c + x * knot.d))


def mean_curve_strain(
    knots: Sequence[Knot], first: int, end: int, tension: float, half: float
) -> float:
    """Return the mean strain of a rope along which the tension varies linearly.

    The tension varies from `tension` - `half` to `tension` + `half` [N]. The mean is exact (two
    Gauss points between adjacent knots). `first` and `end` are as in `curve_strain`.
    """
    half = abs(half)
    low, high = tension - half, tension + half
    i, last = _knots_below(knots, first, end, low), _knots_below(knots, first, end, high)
    if i == last:
        return _gauss(knots, first, end, tension, half)
    total = 0.0
    while low < high:
        bend = knots[i].tension if i < last else high
        total += (bend - low) * _gauss(knots, first, end, 0.5 * (low + bend), 0.5 * (bend - low))
        low, i = bend, i + 1
    return total / (2.0 * half)


def _gauss(knots: Sequence[Knot], first: int, end: int, middle: float, half: float) -> float:
    away = half * _GAUSS
    lower = curve_strain(knots, first, end, middle - away)
    return 0.5 * (lower + curve_strain(knots, first, end, middle + away))


def _knots_below(knots: Sequence[Knot], first: int, end: int, tension: float) -> int:
    while first < end and knots[first].tension <= tension:
        first += 1
    return first


class ElongationCurve:
    """Strain of a rope as a smooth function of tension, through the points of a table.

    The curve is a monotone cubic interpolation with a continuous slope. Above the last point, the
    curve is linear with the mean slope of the last interval.

    Parameters
    ----------
    points : pairs (load / breaking load, strain) with increasing loads up to 1; (0, 0) may be
        omitted
    breaking_load : breaking load [N]
    permanent : permanent elongation after the first loading [-], added at every tension

    Attributes
    ----------
    tensions, strains : points of the table, starting with (0, 0) [N], [-]
    knots : the curve in the form used by the march, including permanent elongation
    limit : tension above which results need a warning [N]. The limit is the last point of the
        table, but not more than 80 % of the breaking load

    Raises
    ------
    ValueError
        Loads do not increase or exceed 1, strains decrease or do not start at 0, or a value is
        negative or not finite.

    Source: F. N. Fritsch & J. Butland (1984), SIAM J. Sci. Stat. Comput. 5, 300-304.
    """

    __slots__ = ("breaking_load", "knots", "limit", "permanent", "strains", "tensions")

    def __init__(
        self, points: Iterable[tuple[float, float]], breaking_load: float, permanent: float = 0.0
    ) -> None:
        if not (isfinite(breaking_load) and breaking_load > 0.0):
            raise ValueError("the breaking load must be positive")
        if not (isfinite(permanent) and permanent >= 0.0):
            raise ValueError("the permanent elongation must not be negative")
        self.breaking_load = breaking_load
        loads, self.strains = _checked(points)
        self.tensions = [load * breaking_load for load in loads]
        self.permanent = permanent
        self.limit = min(loads[-1], TRUSTED_LOAD) * breaking_load
        self.knots = tuple(
            Knot(tension, permanent + a, b, c, d)
            for tension, (a, b, c, d) in zip(
                self.tensions, _cubics(self.tensions, self.strains), strict=True
            )
        )

    def strain(self, tension: float) -> float:
        """Return the strain at a tension ≥ 0 [N], including permanent elongation [-]."""
        return curve_strain(self.knots, 0, len(self.knots), tension)

    def stiffer(self, factor: float) -> ElongationCurve:
        """Return a copy of the curve with all strains divided by a factor."""
        loads = (tension / self.breaking_load for tension in self.tensions)
        strains = (strain / factor for strain in self.strains)
        return ElongationCurve(
            zip(loads, strains, strict=True), self.breaking_load, self.permanent / factor
        )


def _checked(points: Iterable[tuple[float, float]]) -> tuple[list[float], list[float]]:
    """Validate a table, and return its loads and strains, starting with (0, 0)."""
    loads, strains = [0.0], [0.0]
    for number, (load, strain) in enumerate(points, start=1):
        if not (isfinite(load) and isfinite(strain)):
            raise ValueError(f"point {number}: a load or a strain is not a number")
        if number == 1 and load == 0.0:
            if strain != 0.0:
                raise ValueError(
                    "the strain at no load must be 0; set a lasting strain as "
                    "`permanent_elongation`"
                )
            continue
        if load > 1.0:
            raise ValueError(
                f"point {number}: the load is {load:g} times the breaking load, more than 1"
            )
        if load <= loads[-1]:
            raise ValueError(
                f"point {number}: the load {load:g} is not above that of the point before"
            )
        if strain < strains[-1]:
            raise ValueError(
                f"point {number}: the strain {strain:g} is below that of the point before"
            )
        loads.append(load)
        strains.append(strain)
    if len(loads) == 1:
        raise ValueError("an elongation curve needs at least one point with a load above 0")
    return loads, strains


def _cubics(xs: list[float], ys: list[float]) -> list[tuple[float, float, float, float]]:
    """Return the coefficients of y in powers of x - xs[i] for every interval.

    The last entry is the straight line beyond the last point.
    """
    widths = [b - a for a, b in pairwise(xs)]
    chords = [(b - a) / h for (a, b), h in zip(pairwise(ys), widths, strict=True)]
    slopes = _slopes(widths, chords)
    cubics = [
        (ys[i], slopes[i], (3.0 * m - 2.0 * slopes[i] - slopes[i + 1]) / h,
         (slopes[i] + slopes[i + 1] - 2.0 * m) / (h * h))
        for i, (h, m) in enumerate(zip(widths, chords, strict=True))
    ]  # fmt: skip
    return [*cubics, (ys[-1], chords[-1], 0.0, 0.0)]


def _slopes(widths: list[float], chords: list[float]) -> list[float]:
    """Return the slope at every point.

    The slope is a weighted harmonic mean of the adjacent mean slopes. At an end, the slope is the
    slope of a parabola through three points.
    """
    if len(chords) == 1:
        return [chords[0], chords[0]]
    slopes = [_end_slope(widths[0], widths[1], chords[0], chords[1])]
    for i in range(1, len(chords)):
        left, right = chords[i - 1], chords[i]
        if left == 0.0 or right == 0.0:
            slopes.append(0.0)
            continue
        before, after = 2.0 * widths[i] + widths[i - 1], widths[i] + 2.0 * widths[i - 1]
        slopes.append((before + after) / (before / left + after / right))
    return [*slopes, _end_slope(widths[-1], widths[-2], chords[-1], chords[-2])]


def _end_slope(width: float, next_width: float, chord: float, next_chord: float) -> float:
    slope = ((2.0 * width + next_width) * chord - width * next_chord) / (width + next_width)
    return max(slope, 0.0)
