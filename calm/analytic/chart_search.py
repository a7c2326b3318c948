"""Search on a branch of the curve for all cables that match the given quantities.

A cable is a piece of a branch, from λ_A to λ_B, scaled by H₀. The upper end is B, so λ_B > |λ_A|.
If the cable dips below A, λ_A is negative. A size is a tension divided by w, a height, a distance
or a length. The ratio of two sizes does not depend on H₀. The number of unknown values of λ is

- 0 if both angles are given, or one angle and the ratio of the tensions;
- 1 if only one angle is given, or only the ratio of the tensions;
- 2 if the given quantities are the length, the distance and another size.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from calm.analytic.chart_branch import Branch, Floats, inverse_log_cosh, log_cosh

Piece = tuple[float, float]
Path = Callable[[Floats], tuple[Floats, Floats]]

_FINEST = 1e-10
"""Smallest step of a search grid, as a fraction of the range of the grid. Shorter parts of the
curve are straight within rounding.
"""

_POINTS = 240
_NOISE = 1e-13
_AROUND = 3
_WINDOW = 2 * _AROUND + 1


@dataclass(frozen=True)
class ChartSearch:
    """Search for the pieces of a branch that have the given quantities after scaling by H₀.

    Parameters
    ----------
    sizes : given values [m] by name: tension_a and tension_b (divided by w), height, length, and
        distance (positive as on this branch)
    """

    branch: Branch
    sizes: Mapping[str, float]

    def pieces(self, start: float | None, end: float | None) -> list[Piece]:
        """Find all pieces of the branch that have the given quantities after scaling by H₀.

        `start` and `end` are the values of λ at the ends, or None if unknown. If both are None, the
        sizes must determine the ratio of the tensions.
        """
        if end is not None and end <= 0.0:
            return []
        if start is not None and end is not None:
            return [(start, end)] if end > abs(start) else []
        ratio = self.log_ratio()
        if start is not None:
            if ratio is not None:
                return [(start, float(self._raised(start, ratio)))]
            offset = abs(start) + graded(reach(self.branch))
            return self._along(offset, lambda place: (np.full_like(place, start), place))
        if end is not None:
            if ratio is not None:
                level = float(log_cosh(end)) - ratio / self.branch.exponent
                size = float(inverse_log_cosh(max(level, 0.0)))
                return [] if level < 0.0 else sorted({(-size, end), (size, end)})
            inside = merged(graded(2.0 * end) - end, end - graded(2.0 * end))
            inside = inside[np.abs(inside) < end]
            return self._along(inside, lambda place: (place, np.full_like(place, end)))
        assert ratio is not None
        outward = graded(reach(self.branch))
        places = np.concatenate([-outward[::-1], [0.0], outward])
        return self._along(places, lambda place: (place, self._raised(place, ratio)))

    def log_ratio(self) -> float | None:
        """Return ln(T_B/T_A) from two of the sizes tension_a, tension_b and height.

        The result is None if fewer than two of these sizes are given.
        """
        below, above, height = (self.sizes.get(name) for name in _TENSION_NAMES)
        if height is not None and below is not None:
            return float(np.log1p(height / below))
        if height is not None and above is not None:
            return -float(np.log1p(-height / above))
        if below is not None and above is not None:
            return float(np.log1p((above - below) / below))
        return None

    def _raised(self, start: ArrayLike, ratio: float) -> Floats:
        """Return the λ_B at which the tension is exp(ratio) times the tension at `start`."""
        return inverse_log_cosh(log_cosh(start) + ratio / self.branch.exponent)

    def _residual(self, path: Path, places: Floats) -> Floats:
        """Return the error in the ratio of two sizes, from −1 to 1, at points of a search path.

        `path` converts the parameters `places` of the search to λ_A and λ_B. The error is zero for
        a piece with the given ratio.
        """
        start, end = path(places)
        # with three sizes, the path satisfies the ratio of the tensions; one of the two sizes that
        # give this ratio is then compared with the third size
        names = sorted(self.sizes, key=_ORDER.index)
        first, second = names[0], names[-1]
        left = size_of(self.branch, first, start, end) * self.sizes[second]
        right = size_of(self.branch, second, start, end) * self.sizes[first]
        return np.asarray((left - right) / (np.abs(left) + np.abs(right)))

    def _along(self, grid: Floats, path: Path) -> list[Piece]:
        places = roots(lambda at: self._residual(path, at), grid)
        return [(float(start), float(end)) for start, end in zip(*path(places), strict=True)]


_TENSION_NAMES = ("tension_a", "tension_b", "height")
_ORDER = (*_TENSION_NAMES, "distance", "length")


def roots(function: Callable[[Floats], Floats], grid: Floats) -> Floats:
    """Scan a vectorised function over a grid, and find its zeros to machine precision.

    To find pairs of zeros, the grid is refined where the function approaches zero without changing
    sign.
    """
    value = function(grid)
    steps = steps_with_zero(value)
    left, right = grid[steps], grid[steps + 1]
    for dip in dips(value):
        low, high = grid[dip - 1], grid[dip + 1]
        for _ in range(12):
            close = np.linspace(low, high, 17)
            inside = function(close)
            steps = steps_with_zero(inside)
            if steps.size:
                left, right = np.append(left, close[steps]), np.append(right, close[steps + 1])
                break
            least = int(np.argmin(np.abs(inside[1:-1]))) + 1
            low, high = close[least - 1], close[least + 1]
    return refine(function, left, right)


def graded(length: float, points: int = _POINTS) -> Floats:
    """Return grid points up to `length`: in geometric progression near 0, then evenly spaced."""
    near = np.geomspace(_FINEST * length, length, points)
    return merged(near, np.linspace(0.0, min(length, 40.0), 2 * points)[1:])


def merged(*grids: Floats) -> Floats:
    """Merge grids, and remove points that nearly coincide."""
    points = np.unique(np.concatenate(grids))
    gaps = np.diff(points)
    kept = np.ones(points.size, dtype=bool)
    kept[1:-1] = gaps[:-1] > 0.02 * gaps[1:]
    return points[kept]


def reach(branch: Branch) -> float:
    """Return the λ beyond which the curve is straight within rounding.

    Beyond this λ, tension and arc length grow in proportion.
    """
    return 40.0 / branch.exponent + 20.0


def size_of(branch: Branch, name: str, start: ArrayLike, end: ArrayLike) -> Floats:
    """Return the tension, height, distance or length of parts of the curve.

    A tension is in units of wH₀, the other quantities are in units of H₀.
    """
    if name == "tension_a":
        return np.exp(branch.log_tension(start))
    if name == "tension_b":
        return np.exp(branch.log_tension(end))
    if name == "height":
        rise = branch.log_tension(end) - branch.log_tension(start)
        return np.asarray(np.exp(branch.log_tension(start)) * np.expm1(rise))
    arc, distance = branch.span(start, end)
    return arc if name == "length" else distance


def refine(function: Callable[[Floats], Floats], left: Floats, right: Floats) -> Floats:
    """Compute zeros of a vectorised function to machine precision.

    The sign of the function differs between `left` and `right`.
    """
    from scipy.optimize.elementwise import find_root

    found = np.asarray(find_root(function, (left, right)).x) if left.size else left
    return found[np.isfinite(found)]


def steps_with_zero(value: Floats) -> NDArray[np.intp]:
    """Return the indices of the scan points after which the sign changes."""
    change = (np.sign(value[:-1]) != np.sign(value[1:])) & (value[:-1] != 0.0)
    change &= np.maximum(np.abs(value[:-1]), np.abs(value[1:])) > _NOISE
    return np.flatnonzero(change)


def dips(value: Floats) -> NDArray[np.intp]:
    """Return the indices of scan points where the function may touch zero without changing sign."""
    size = np.abs(value)
    before, here, after = size[:-2], size[1:-1], size[2:]
    dip = (here <= before) & (here < after) & (here > _NOISE)
    dip &= (value[:-2] * value[1:-1] > 0.0) & (value[1:-1] * value[2:] > 0.0)
    # rounding noise also has minima, but not from a larger value; points may occur in pairs, so
    # compare with more distant points
    around = np.lib.stride_tricks.sliding_window_view(np.pad(size, _AROUND, mode="edge"), _WINDOW)
    dip &= here < 0.5 * around.max(axis=1)[1:-1]
    return np.flatnonzero(dip) + 1


_POINTS_OF_ENDS = 24
# closer to horizontal than this, the height of a piece is lost in rounding
_LEAST_RISE = 1.0 + 1e-13


@dataclass(frozen=True)
class LengthSearch:
    """Search for the pieces of a branch with given ratios D/L and S/L, where S is a third size.

    Parameters
    ----------
    cosine : ratio D/L of distance to length; D is positive as on this branch
    third : name of the third size S (tension_a, tension_b or height)
    share : ratio S/L
    """

    branch: Branch
    cosine: float
    third: str
    share: float

    def pieces(self) -> list[Piece]:
        """Find all pieces of the branch that have both ratios."""
        if not -1.0 < self.cosine < 1.0:
            return []
        outward = graded(reach(self.branch), _POINTS_OF_ENDS)
        start = np.concatenate([-outward[::-1], [0.0], outward])[:, np.newaxis]
        end = np.abs(start) * _LEAST_RISE + outward
        arc, distance = self.branch.span(start, end)
        third = size_of(self.branch, self.third, start, end)
        misses = distance / arc - self.cosine, np.log(third / (arc * self.share))
        around = np.lib.stride_tricks.sliding_window_view
        size = np.hypot(*misses)
        near = around(np.pad(size, 1, mode="edge"), (3, 3)).min(axis=(2, 3))
        far = around(np.pad(size, _AROUND, mode="edge"), (_WINDOW, _WINDOW)).max(axis=(2, 3))
        here = (size <= near) & (size < 0.5 * far) & (size < 1.0)
        change = (around(np.signbit(miss), (2, 2)).sum(axis=(2, 3)) % 4 > 0 for miss in misses)
        here[:-1, :-1] |= np.logical_and(*change)
        found = (self._polished(float(start[i, 0]), float(end[i, j])) for i, j in np.argwhere(here))
        return [piece for piece in found if piece is not None]

    def _polished(self, start: float, end: float) -> Piece | None:
        """Return the piece with both ratios that Powell's method finds from a starting point.

        `start` and `end` are the values of λ at the ends of the initial piece. The result is None
        if the method does not converge.
        """
        from scipy.optimize import root

        least, farthest = abs(start) * _LEAST_RISE, 3.0 * reach(self.branch)
        if end <= least:
            return None

        def piece(at: Floats) -> tuple[float, float]:
            first = float(np.nan_to_num(np.clip(at[0], -farthest, farthest)))
            above = np.exp(np.nan_to_num(min(at[1], np.log(farthest))))
            return first, abs(first) * _LEAST_RISE + float(above)

        def miss(at: Floats) -> Floats:
            place = piece(at)
            arc, distance = self.branch.span(*place)
            third = size_of(self.branch, self.third, *place)
            # mean cosine and logarithm of the third fraction, minus their required values
            return np.array([distance / arc - self.cosine, np.log(third / (arc * self.share))])

        with np.errstate(all="ignore"):
            found = root(miss, [start, np.log(end - least)], options={"xtol": 1e-15})
        return piece(found.x) if np.abs(found.fun).max() < 1e-12 else None
