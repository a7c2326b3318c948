"""The number nearest to where one stands at which a condition begins to hold."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from math import ceil, floor, inf, isfinite, log10

from calm.solve.root import bracketed_root

DOUBLINGS = 10
"""The range is searched outward from the start, from 1/2¹⁰ of it in doubling steps."""
SIGNIFICANT = 6
"""Digits of an answer that need not be exact: it is rounded away from the start."""

_NARROW = 1e-10
_DEEPENINGS = 60


@dataclass
class LeastChange:
    """A search for the smallest change of a number that brings an excess down to nothing.

    Outward from the start in both directions by doubling steps until the excess is gone; where it
    never is, further around the least excess found; then Brent's method, or bisection for whole
    numbers. Between two steps the excess is taken to change sign once.

    Parameters
    ----------
    excess : of a number; at most 0 where the condition holds, None where there is no answer
    low, high : the range of the number
    whole : whether only whole numbers count
    exact : whether the excess is to be 0 rather than at most 0
    small : the excess that counts as none where it is to be 0

    Attributes
    ----------
    tried : the excess of every number tried; inf where there is no answer
    """

    excess: Callable[[float], float | None]
    low: float
    high: float
    whole: bool = False
    exact: bool = False
    small: float = 0.0
    tried: dict[float, float] = field(default_factory=dict)

    def at(self, x: float) -> float:
        """The excess, found once."""
        if x not in self.tried:
            excess = self.excess(x)
            self.tried[x] = inf if excess is None else excess
        return self.tried[x]

    def find(self, start: float) -> float | None:
        """The number nearest to the start where the condition holds; None where none is found."""
        start = min(max(start, self.low), self.high)
        first = self.at(start)
        if first <= 0.0 or (self.exact and abs(first) <= self.small):
            return start
        held = self._outward(start)
        if held is None:
            held = self._around_the_least()
        if held is None:
            return None
        found = self._nearest(start, held)
        # as far on the other side, where the steps were others
        mirrored = 2.0 * start - found
        if self.low <= mirrored <= self.high and self.at(mirrored) <= 0.0:
            return self._nearest(start, mirrored)
        return found

    @property
    def least(self) -> float | None:
        """The number of the least excess tried; None where there was no answer at all."""
        best = min(self.tried, key=self.at)
        return best if isfinite(self.at(best)) else None

    @property
    def steady(self) -> bool:
        """Return whether the excess only rises or only falls over the numbers tried."""
        excesses = [self.tried[x] for x in sorted(self.tried) if isfinite(self.tried[x])]
        noise = 1e-6 * max(map(abs, excesses), default=0.0)
        steps = [b - a for a, b in pairwise(excesses)]
        return not (any(step > noise for step in steps) and any(step < -noise for step in steps))

    def neighbours(self, x: float) -> tuple[float, float]:
        """The numbers tried next to x, x itself where it is the first or last."""
        below = max((t for t in self.tried if t < x), default=x)
        above = min((t for t in self.tried if t > x), default=x)
        return below, above

    def _outward(self, start: float) -> float | None:
        """The first of ever larger steps to either side at which the condition holds."""
        upward = [start + step for step in self._steps(self.high - start)]
        downward = [start - step for step in self._steps(start - self.low)]
        for x in sorted(upward + downward, key=lambda x: abs(x - start)):
            if self.at(x) <= 0.0:
                return x
        return None

    def _steps(self, room: float) -> list[float]:
        if room <= 0.0:
            return []
        if self.whole:
            doubled = [2.0**k for k in range(ceil(log10(room) / log10(2.0)))]
            return [*doubled, room]
        return [room * 2.0 ** (k - DOUBLINGS) for k in range(DOUBLINGS + 1)]

    def _around_the_least(self) -> float | None:
        """Return the same by halving the wider of the two gaps beside the least excess, as often
        as pays.

        That finds a dip between two steps, and the last numbers before those without answer.
        """
        for _ in range(_DEEPENINGS):
            best = self.least
            if best is None:
                return None
            below, above = self.neighbours(best)
            far = below if best - below > above - best else above
            x = 0.5 * (best + far)
            x = float(round(x)) if self.whole else x
            if x in self.tried or abs(far - best) <= 1e-7 * (self.high - self.low):
                return None
            if self.at(x) <= 0.0:
                return x
        return None

    def _nearest(self, start: float, good: float) -> float:
        """Return where the condition begins to hold between the start and a number at which it
        does.
        """
        between = [x for x in self.tried if min(start, good) <= x <= max(start, good)]
        bad = min((x for x in between if self.tried[x] > 0.0), key=lambda x: abs(x - good))
        return self._whole(bad, good) if self.whole else self._root(bad, good)

    def _whole(self, bad: float, good: float) -> float:
        while abs(good - bad) > 1.0:
            middle = float(floor(0.5 * (bad + good)))
            if self.at(middle) <= 0.0:
                good = middle
            else:
                bad = middle
        return good

    def _root(self, bad: float, good: float) -> float:
        width = abs(good - bad)
        while not isfinite(self.at(bad)):
            middle = 0.5 * (bad + good)
            if abs(good - bad) <= 1e-7 * width:
                return good  # the condition holds wherever there is an answer
            if self.at(middle) <= 0.0:
                good = middle
            else:
                bad = middle
        ceiling = self.at(bad)
        root, _, _ = bracketed_root(
            lambda _, x: min(self.at(x), ceiling), None, bad, ceiling, good, self.at(good),
            self.small if self.exact else 0.0, _NARROW * max(abs(bad), abs(good)),
        )  # fmt: skip
        return root if self.exact else self._rounded(root, good)

    def _rounded(self, root: float, good: float) -> float:
        """The root in few digits, on the side where the condition holds."""
        towards = ceil if good > root else floor
        for digits in range(SIGNIFICANT, 1, -1):
            unit = 10.0 ** (floor(log10(abs(root))) + 1 - digits) if root else 1e-6
            x = float(f"{towards(root / unit) * unit:.{digits}g}")
            if min(root, good) <= x <= max(root, good) and self.at(x) <= 0.0:
                return x
        return good
