"""Pieces of the curve of which length, distance and one more size are given: two unknowns.

The mean of cos ψ over the piece is D/L. For a given λ_A it falls as λ_B grows, except where the
piece begins far enough before the apex of the second branch: there it rises first. So D/L gives
λ_B, on up to two sheets over λ_A, and the third size is a residual along them. What its changes of
sign show is finished by Newton's method on both equations, which knows nothing of sheets.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from calm.analytic.chart_branch import Branch, Floats
from calm.analytic.chart_search import (
    Piece,
    dips,
    graded,
    merged,
    reach,
    refine,
    size_of,
    steps_with_zero,
)

_POINTS = 60
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
            lambda end: self._cosine(end) - self.cosine - self._excess(first, end),
            low[before],
            low[before] + reach(self.branch),
        )
        return peak

    def _falling_margin(self, start: Floats) -> Floats:
        """Positive where λ_B exists beyond the greatest mean."""
        if self.cosine <= self.branch.limit:
            return np.full_like(start, -1.0)
        return self._excess(start, self._peak(start))

    def _falling(self, start: Floats) -> Floats:
        far = np.abs(start) + reach(self.branch)
        return last_positive(lambda end: self._excess(start, end), self._peak(start), far)

    def _rising_margin(self, start: Floats) -> Floats:
        """Positive where λ_B exists before the greatest mean."""
        if self.branch.sign > 0:
            return np.full_like(start, -1.0)
        low, peak = np.abs(start), self._peak(start)
        return np.minimum(-self._excess(start, low), self._excess(start, peak))

    def _rising(self, start: Floats) -> Floats:
        low, peak = np.abs(start), self._peak(start)
        return last_positive(lambda end: -self._excess(start, end), low, peak)

    def _stretches(self, margin: Callable[[Floats], Floats]) -> list[Floats]:
        """Grids of λ_A, fine at both ends, for each stretch on which there is a λ_B."""
        outward = graded(reach(self.branch), _POINTS)
        places = np.concatenate([-outward[::-1], [0.0], outward])
        value = margin(places)
        exists = value > 0.0
        edges = np.flatnonzero(exists[1:] != exists[:-1])
        bounds = refine(margin, places[edges], places[edges + 1])
        ends = np.concatenate([places[:1][exists[:1]], bounds, places[-1:][exists[-1:]]])
        stretches = []
        for low, high in ends.reshape(-1, 2):
            steps = graded(high - low, _POINTS)[:-1]
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
        """The root Newton's method reaches, or None."""
        if end <= abs(start) * _LEAST_RISE:
            return None
        place = np.array([start, end])
        value, slope = self._equations(place)
        farthest = 3.0 * reach(self.branch)
        for _ in range(40):
            if np.abs(value).max() < 1e-15:
                break
            try:
                step = np.linalg.solve(slope, value)
            except np.linalg.LinAlgError:
                return None
            for _ in range(30):
                trial = place - step
                if abs(trial[0]) * _LEAST_RISE < trial[1] < farthest:
                    reached, onward = self._equations(trial)
                    if np.abs(reached).max() < np.abs(value).max():
                        break
                step = step / 2.0
            else:
                break
            place, value, slope = trial, reached, onward
        return (float(place[0]), float(place[1])) if np.abs(value).max() < 1e-12 else None

    def _equations(self, place: Floats) -> tuple[Floats, Floats]:
        """Mean cosine and logarithm of the third share, less what is wanted; and their slopes."""
        branch = self.branch
        arc, distance = (float(size) for size in branch.span(place[0], place[1]))
        rate, cosine = branch.rates(place)
        rate = rate * np.array([-1.0, 1.0]) / arc
        mean = distance / arc
        third = float(size_of(branch, self.third, place[0], place[1]))
        tension = np.exp(branch.log_tension(place))
        growth = branch.exponent * np.tanh(place) * tension / third
        growth *= {"tension_a": (1.0, 0.0), "tension_b": (0.0, 1.0), "height": (-1.0, 1.0)}[
            self.third
        ]
        value = np.array([mean - self.cosine, np.log(third / (arc * self.share))])
        return value, np.array([rate * (cosine - mean), growth - rate])


def last_positive(function: Callable[[Floats], Floats], low: Floats, high: Floats) -> Floats:
    """Return where a function positive at `low` changes sign; `high` where it does not up to
    there.
    """
    begin, end = function(low), function(high)
    crosses = (begin > 0.0) & (end < 0.0)
    found = refine(function, low, np.where(crosses, high, low))
    return np.where(crosses, found, np.where(begin > 0.0, high, low))
