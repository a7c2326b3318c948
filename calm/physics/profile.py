"""Current, density and viscosity by depth, as the march looks them up."""

from __future__ import annotations

from bisect import bisect_right
from math import inf, isfinite

from calm.physics.line import Water
from calm.physics.state import MarchError


class Profile:
    """The levels of a `Water` as plain lists, extended beyond the first and the last.

    Attributes
    ----------
    levels : depths that bound the intervals [m], from -inf to inf
    rows : per interval its origin depth, then value there and slope of u, v, w and density
    gravity : [m/s²]
    """

    def __init__(self, water: Water) -> None:
        depths = [float(depth) for depth in water.level]
        self.levels = [-inf, *depths, inf]
        self.gravity = water.gravity
        columns = [
            _values_and_slopes(depths, [float(value) for value in values])
            for values in (water.u, water.v, water.w, water.density)
        ]
        origins = [depths[0], *depths]
        self.rows = [
            (origin, *(number for column in columns for number in column[i]))
            for i, origin in enumerate(origins)
        ]
        self._viscous = [float(depth) for depth in water.viscosity_level]
        self._viscosity = _values_and_slopes(self._viscous, [float(v) for v in water.viscosity])

    def interval(self, depth: float, i: int) -> int:
        """Index of the interval that holds `depth`, searched from interval `i`."""
        if not isfinite(depth):
            raise MarchError("the line runs off to infinity")
        levels = self.levels
        while depth >= levels[i + 1]:
            i += 1
        while depth < levels[i]:
            i -= 1
        return i

    def at(self, depth: float, i: int) -> tuple[float, float, float, float]:
        """Current u, v, w [m/s] and density [kg/m³] at a depth, searched from interval `i`."""
        levels = self.levels
        if not levels[i] < depth < levels[i + 1]:
            i = self.interval(depth, i)
        origin, u, du, v, dv, w, dw, density, ddensity = self.rows[i]
        below = depth - origin
        return (
            u + du * below,
            v + dv * below,
            w + dw * below,
            density + ddensity * below,
        )

    def viscosity(self, depth: float) -> float:
        """Kinematic viscosity at a depth [m²/s]."""
        i = bisect_right(self._viscous, depth)
        value, slope = self._viscosity[i]
        return value + slope * (depth - self._viscous[max(i - 1, 0)])

    def distance_to_level(self, depth: float, sinking: float, i: int, least: float = 0.0) -> float:
        """Way to the next level from a depth [m], along a path that sinks so much per metre.

        A level no farther than `least` is as good as reached: the one behind it counts.
        """
        if sinking == 0.0:
            return inf
        i = self.interval(depth, i) + (sinking > 0.0)
        ahead = 1 if sinking > 0.0 else -1
        while (gap := (self.levels[i] - depth) / sinking) <= least:
            i += ahead
        return gap


def _values_and_slopes(depths: list[float], values: list[float]) -> list[tuple[float, float]]:
    """Value at its origin and slope of every interval; constant in the first and the last."""
    inner = [
        (values[i], (values[i + 1] - values[i]) / (depths[i + 1] - depths[i]))
        for i in range(len(depths) - 1)
    ]
    return [(values[0], 0.0), *inner, (values[-1], 0.0)]
