"""Where on a branch of the curve a cable lies: every place that fits what is given.

A cable is a piece of a branch, λ_A to λ_B, enlarged H₀ times. With λ_B > |λ_A| its upper end is B;
λ_A < 0 when it dips below its lower end. Two given sizes (tensions over w, height, distance,
length) have a ratio that does not depend on H₀. That leaves

- nothing to search where both angles, or one angle and the ratio of the tensions, are given;
- one unknown on a line where one angle, or the ratio of the tensions, is given;
- two unknowns for length, distance and one more: the ratio of these two then ties λ_B to λ_A.

A residual is scanned on a grid that is fine where pieces are short and reaches to where the curve
is straight to rounding; changes of sign are refined, dips towards zero examined for a pair.

Of length and distance, the mean of cos ψ over the piece is D/L. For a given λ_A it falls as λ_B
grows, except where the piece begins far enough before the apex of the second branch: there it rises
first. So D/L gives λ_B, on up to two sheets over λ_A, and the third size is a residual along them.
Its changes of sign are finished by Newton's method on both equations, which knows of no sheets.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from calm.analytic.chart_branch import Branch, Floats, inverse_log_cosh, log_cosh

Piece = tuple[float, float]
Path = Callable[[Floats], tuple[Floats, Floats]]

_FINEST = 1e-10
"""Least share of the reach of a grid; pieces so short are straight to rounding."""

_POINTS = 240
_NOISE = 1e-13
_AROUND = 3
_WINDOW = 2 * _AROUND + 1


@dataclass(frozen=True)
class ChartSearch:
    """A branch and the sizes given.

    Parameters
    ----------
    branch : Branch
        Where to look.
    sizes : mapping
        The given among tension_a, tension_b (over w), height, distance (turned as the branch is),
        length, all in metres.
    """

    branch: Branch
    sizes: Mapping[str, float]

    def pieces(self, start: float | None, end: float | None) -> list[Piece]:
        """Every piece with these ends, where given, and these sizes.

        Without an end, two of the sizes must give the ratio of the tensions.
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
        """ln(T_B/T_A) where two of T_A, T_B, H are given."""
        below, above, height = (self.sizes.get(name) for name in _TENSION_NAMES)
        if height is not None and below is not None:
            return float(np.log1p(height / below))
        if height is not None and above is not None:
            return -float(np.log1p(-height / above))
        if below is not None and above is not None:
            return float(np.log1p((above - below) / below))
        return None

    def _raised(self, start: ArrayLike, ratio: float) -> Floats:
        """The λ_B at which the tension is exp(ratio) times that at `start`."""
        return inverse_log_cosh(log_cosh(start) + ratio / self.branch.exponent)

    def _residual(self, path: Path, places: Floats) -> Floats:
        """Zero where the ratio of two given sizes is right, between −1 and 1."""
        start, end = path(places)
        # Of more than two, the path has used the tensions; one of them and the other size remain.
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
    """Every zero of a vectorised function that a grid can show.

    Changes of sign are refined to rounding. A dip towards zero that does not change the sign is
    looked at ever closer, for two zeros that lie between two points of the grid.
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
    """Distances from an edge up to `length`: by constant ratio at first, then evenly as well."""
    near = np.geomspace(_FINEST * length, length, points)
    return merged(near, np.linspace(0.0, min(length, 40.0), 2 * points)[1:])


def merged(*grids: Floats) -> Floats:
    """One grid of several without points that all but coincide: a scan needs true neighbours."""
    points = np.unique(np.concatenate(grids))
    gaps = np.diff(points)
    kept = np.ones(points.size, dtype=bool)
    kept[1:-1] = gaps[:-1] > 0.02 * gaps[1:]
    return points[kept]


def reach(branch: Branch) -> float:
    """λ beyond which nothing changes any more, to rounding, but tension and arc in step."""
    return 40.0 / branch.exponent + 20.0


def size_of(branch: Branch, name: str, start: ArrayLike, end: ArrayLike) -> Floats:
    """One size of pieces, in H₀: a tension (over wH₀), height, distance or length."""
    if name == "tension_a":
        return np.exp(branch.log_tension(start))
    if name == "tension_b":
        return np.exp(branch.log_tension(end))
    if name == "height":
        rise = branch.log_tension(end) - branch.log_tension(start)
        return np.asarray(np.exp(branch.log_tension(start)) * np.expm1(rise))
    arc, distance = branch.span(start, end)
    return arc if name == "length" else distance


def refine(function: Callable[..., Floats], left: Floats, right: Floats, *beside: Floats) -> Floats:
    """The zeros of a vectorised function between places where its signs differ, to rounding.

    Parameters
    ----------
    function : of the places, and of what is given beside each of them
    left, right : the places
    """
    from scipy.optimize.elementwise import find_root

    if not left.size:
        return left
    return np.asarray(find_root(function, (left, right), args=beside).x)


def steps_with_zero(value: Floats) -> NDArray[np.intp]:
    """The steps of a scan, by the index of their first point, in which the sign changes."""
    change = (np.sign(value[:-1]) != np.sign(value[1:])) & (value[:-1] != 0.0)
    change &= np.maximum(np.abs(value[:-1]), np.abs(value[1:])) > _NOISE
    return np.flatnonzero(change)


def dips(value: Floats) -> NDArray[np.intp]:
    """The points of a scan about which the value comes so near zero that it may touch it."""
    size = np.abs(value)
    before, here, after = size[:-2], size[1:-1], size[2:]
    dip = (here <= before) & (here < after) & (here > _NOISE)
    dip &= (value[:-2] * value[1:-1] > 0.0) & (value[1:-1] * value[2:] > 0.0)
    # Noise dips too, but not from a height above it. Points may lie in pairs, so look further.
    around = np.lib.stride_tricks.sliding_window_view(np.pad(size, _AROUND, mode="edge"), _WINDOW)
    dip &= here < 0.5 * around.max(axis=1)[1:-1]
    return np.flatnonzero(dip) + 1


_SHEET_POINTS = 60
_NEAR_ZERO = 0.05
# Nearer to level than this the height of a piece is lost in rounding.
_LEAST_RISE = 1.0 + 1e-13


@dataclass(frozen=True)
class LengthSearch:
    """A branch, the mean cosine D/L wanted, and the third size as a share of the length.

    Parameters
    ----------
    branch : Branch
        Where to look.
    cosine : float
        D/L, D turned as the branch is.
    third, share : str, float
        tension_a, tension_b or height; that size over the length.
    """

    branch: Branch
    cosine: float
    third: str
    share: float

    def pieces(self) -> list[Piece]:
        """Every piece that fits."""
        if not -1.0 < self.cosine < 1.0:
            return []
        candidates: list[Piece] = []
        for margin, end in (
            (self._falling_margin, self._falling),
            (self._rising_margin, self._rising),
        ):
            for grid in self._stretches(margin):
                candidates += self._candidates(grid, end(grid))
        found = (self._polished(*candidate) for candidate in candidates)
        return [piece for piece in found if piece is not None]

    def _excess(self, start: Floats, end: Floats) -> Floats:
        """Mean cosine of pieces, less what is wanted."""
        arc, distance = self.branch.span(start, end)
        # A piece of no length has the direction of its point.
        mean = np.where(arc > 0.0, distance / np.where(arc > 0.0, arc, 1.0), self._cosine(end))
        return np.asarray(mean - self.cosine)

    def _cosine(self, place: Floats) -> Floats:
        return self.branch.rates(place)[1]

    def _peak(self, start: Floats) -> Floats:
        """The λ_B ≥ |λ_A| of the greatest mean."""
        low = np.abs(start)
        if self.branch.sign > 0:
            return low
        before = start < 0.0
        peak = low.copy()
        first = start[before]
        peak[before] = last_positive(
            lambda end, first: self._cosine(end) - self.cosine - self._excess(first, end),
            low[before],
            low[before] + reach(self.branch),
            first,
        )
        return peak

    def _falling_margin(self, start: Floats) -> Floats:
        """Positive where λ_B exists beyond the greatest mean."""
        if self.cosine <= self.branch.limit:
            return np.full_like(start, -1.0)
        return self._excess(start, self._peak(start))

    def _falling(self, start: Floats) -> Floats:
        far = np.abs(start) + reach(self.branch)
        return last_positive(lambda end, s: self._excess(s, end), self._peak(start), far, start)

    def _rising_margin(self, start: Floats) -> Floats:
        """Positive where λ_B exists before the greatest mean."""
        if self.branch.sign > 0:
            return np.full_like(start, -1.0)
        low, peak = np.abs(start), self._peak(start)
        return np.minimum(-self._excess(start, low), self._excess(start, peak))

    def _rising(self, start: Floats) -> Floats:
        low, peak = np.abs(start), self._peak(start)
        return last_positive(lambda end, first: -self._excess(first, end), low, peak, start)

    def _stretches(self, margin: Callable[[Floats], Floats]) -> list[Floats]:
        """Grids of λ_A, fine at both ends, for each stretch on which there is a λ_B."""
        outward = graded(reach(self.branch), _SHEET_POINTS)
        places = np.concatenate([-outward[::-1], [0.0], outward])
        value = margin(places)
        exists = value > 0.0
        edges = np.flatnonzero(exists[1:] != exists[:-1])
        bounds = refine(margin, places[edges], places[edges + 1])
        ends = np.concatenate([places[:1][exists[:1]], bounds, places[-1:][exists[-1:]]])
        stretches = []
        for low, high in ends.reshape(-1, 2):
            steps = graded(high - low, _SHEET_POINTS)[:-1]
            own = places[(places > low) & (places < high)]
            grid = merged(low + steps, high - steps, own)
            stretches.append(grid[(grid > low) & (grid < high)])
        return stretches

    def _candidates(self, start: Floats, end: Floats) -> list[Piece]:
        """Places next to a change of sign of the residual, to a dip of it, and to the edges."""
        arc, _ = self.branch.span(start, end)
        size = size_of(self.branch, self.third, start, end)
        value = (size - self.share * arc) / (size + self.share * arc)
        steps, low_points = steps_with_zero(value), dips(value)
        edges = [place for place in (0, value.size - 1) if abs(value[place]) < _NEAR_ZERO]
        places = np.concatenate([steps, steps + 1, low_points - 1, low_points + 1, edges])
        return [(float(start[place]), float(end[place])) for place in np.unique(places.astype(int))]

    def _polished(self, start: float, end: float) -> Piece | None:
        """The root that Powell's method reaches from a place, or None."""
        from scipy.optimize import root

        least, farthest = abs(start) * _LEAST_RISE, 3.0 * reach(self.branch)
        if end <= least:
            return None

        def piece(at: Floats) -> tuple[float, float]:
            first = float(np.clip(at[0], -farthest, farthest))
            return first, abs(first) * _LEAST_RISE + float(np.exp(min(at[1], np.log(farthest))))

        def miss(at: Floats) -> Floats:
            """Mean cosine and logarithm of the third share, less what is wanted."""
            place = piece(at)
            arc, distance = (float(size) for size in self.branch.span(*place))
            third = float(size_of(self.branch, self.third, *place))
            return np.array([distance / arc - self.cosine, np.log(third / (arc * self.share))])

        with np.errstate(all="ignore"):
            found = root(miss, [start, np.log(end - least)], options={"xtol": 1e-15})
        return piece(found.x) if np.abs(found.fun).max() < 1e-12 else None


def last_positive(
    function: Callable[..., Floats], low: Floats, high: Floats, start: Floats
) -> Floats:
    """Return where a function positive at `low` changes sign; `high` where it does not up to
    there.

    Parameters
    ----------
    function : of the place, and of the start beside it
    low, high : between which it is looked for
    start : of each
    """
    begin, end = function(low, start), function(high, start)
    crosses = (begin > 0.0) & (end < 0.0)
    found = np.where(begin > 0.0, high, low)
    found[crosses] = refine(function, low[crosses], high[crosses], start[crosses])
    return found
