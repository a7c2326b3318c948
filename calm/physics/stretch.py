"""How a rope stretches: an elongation curve, and the diameter that goes with it."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from itertools import pairwise
from math import isfinite, sqrt

TRUSTED_LOAD = 0.8
"""Share of the breaking load beyond which an elongation curve should not be trusted."""


def stretched_diameter(diameter: float, strain: float) -> float:
    """Diameter d0/√(1 + strain) of a rope of constant volume, slack diameter d0 [m]."""
    return diameter / sqrt(1.0 + strain)


class ElongationCurve:
    """Strain of a rope against its tension, through a maker's table.

    Monotone cubic interpolation: it passes through every point, has a continuous slope and never
    falls where the table does not. Beyond the last point it goes on straight, with the chord of
    the last interval. A table of one point is a linear stiffness.

    Parameters
    ----------
    points : (load / breaking load [-], strain [-]) by growing load, up to 1; (0, 0) is added
        where the table does not begin with it
    breaking_load : [N]
    permanent : elongation that stays once the rope has been loaded [-], added at every tension

    Attributes
    ----------
    permanent : as given [-]
    limit : tension beyond which an answer deserves a warning [N]: that of the last point, and at
        most 80 % of the breaking load

    Raises
    ------
    ValueError
        Loads that do not grow, strains that fall, a strain at no load, a load above the breaking
        load, figures that are negative or not finite.

    Source: F. N. Fritsch & J. Butland (1984), SIAM J. Sci. Stat. Comput. 5, 300-304, for the
    slopes at the points.
    """

    __slots__ = ("_cubics", "_tensions", "limit", "permanent")

    def __init__(
        self,
        points: Iterable[tuple[float, float]],
        breaking_load: float,
        permanent: float = 0.0,
    ) -> None:
        if not (isfinite(breaking_load) and breaking_load > 0.0):
            raise ValueError("the breaking load must be positive")
        if not (isfinite(permanent) and permanent >= 0.0):
            raise ValueError("the permanent elongation must not be negative")
        loads, strains = _checked(points)
        tensions = [load * breaking_load for load in loads]
        self.permanent = permanent
        self.limit = min(loads[-1], TRUSTED_LOAD) * breaking_load
        self._tensions = tensions
        self._cubics = _cubics(tensions, strains)

    def strain(self, tension: float) -> float:
        """Strain at a tension ≥ 0 [N], permanent elongation included [-]."""
        i = bisect_right(self._tensions, tension, 1) - 1
        a, b, c, d = self._cubics[i]
        x = tension - self._tensions[i]
        return self.permanent + a + x * (b + x * (c + x * d))

    def slope(self, tension: float) -> float:
        """How fast the strain grows with the tension, at a tension ≥ 0 [N] [1/N]."""
        i = bisect_right(self._tensions, tension, 1) - 1
        _, b, c, d = self._cubics[i]
        x = tension - self._tensions[i]
        return b + x * (2.0 * c + x * 3.0 * d)


def _checked(points: Iterable[tuple[float, float]]) -> tuple[list[float], list[float]]:
    """Loads and strains of a table that can be a rope's, (0, 0) in front."""
    loads, strains = [0.0], [0.0]
    for number, (load, strain) in enumerate(points, start=1):
        if not (isfinite(load) and isfinite(strain)):
            raise ValueError(f"point {number}: a load or a strain is not a number")
        if number == 1 and load == 0.0:
            if strain != 0.0:
                raise ValueError("the strain at no load must be 0: give it as permanent elongation")
            continue
        if load > 1.0:
            raise ValueError(f"point {number}: a load of {load:g} times the breaking load")
        if load <= loads[-1]:
            raise ValueError(f"point {number}: the load {load:g} does not grow")
        if strain < strains[-1]:
            raise ValueError(f"point {number}: the strain {strain:g} falls")
        loads.append(load)
        strains.append(strain)
    if len(loads) == 1:
        raise ValueError("an elongation curve needs a point with a load")
    return loads, strains


def _cubics(xs: list[float], ys: list[float]) -> list[tuple[float, float, float, float]]:
    """Coefficients of y in powers of x - xs[i], for every interval and the line beyond the last."""
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
    """Slope at every point: at the ends of a parabola, elsewhere a weighted harmonic mean."""
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
