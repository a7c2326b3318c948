"""Search for roots in a bracket, and for the smallest change of a value that meets a condition."""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from math import ceil, floor, inf, isfinite, isnan, log10
from typing import Any

DOUBLINGS = 10
"""Number of doubling steps of the search; the first step is 1/2¹⁰ of the range."""
SIGNIFICANT = 6
"""Number of significant digits to which an answer is rounded.

Exact answers, and answers very close to the start, are not rounded.
"""

_NARROW = 1e-10
_DEEPENINGS = 60


@dataclass
class LeastChange:
    """Search for the smallest change of a value that reduces an excess to zero.

    The search tries values outward from the start, in doubling steps. The excess is assumed to
    change sign at most once between two steps.

    Parameters
    ----------
    excess : function of the value, at most 0 if the condition holds; None if not computable
    low, high : range of the value
    whole : whether only whole numbers are allowed
    exact : whether the excess must be 0 instead of at most 0
    small : absolute excess that counts as 0 if `exact`

    Attributes
    ----------
    tried : excess at every value tried; inf if not computable
    """

    excess: Callable[[float], float | None]
    low: float
    high: float
    whole: bool = False
    exact: bool = False
    small: float = 0.0
    tried: dict[float, float] = field(default_factory=dict)

    def at(self, x: float) -> float:
        """Return the excess at a value; each excess is computed only once."""
        if x not in self.tried:
            excess = self.excess(x)
            self.tried[x] = inf if excess is None else excess
        return self.tried[x]

    def find(self, start: float) -> float | None:
        """Return the value nearest to the start that meets the condition, if there is one."""
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
        # a value just as near on the other side may have been missed between two steps
        mirrored = 2.0 * start - found
        if self.low <= mirrored <= self.high and self.at(mirrored) <= 0.0:
            return self._nearest(start, mirrored)
        return found

    @property
    def least(self) -> float | None:
        """The tried value with the smallest excess, or None if no excess could be computed."""
        best = min(self.tried, key=self.at)
        return best if isfinite(self.at(best)) else None

    @property
    def steady(self) -> bool:
        """Whether the excess only rises, or only falls, over the tried values."""
        excesses = [self.tried[x] for x in sorted(self.tried) if isfinite(self.tried[x])]
        noise = 1e-6 * max(map(abs, excesses), default=0.0)
        steps = [b - a for a, b in pairwise(excesses)]
        return not (any(step > noise for step in steps) and any(step < -noise for step in steps))

    def neighbours(self, x: float) -> tuple[float, float]:
        """Return the nearest tried values below and above x, or x if there is no such value."""
        below = max((t for t in self.tried if t < x), default=x)
        above = min((t for t in self.tried if t > x), default=x)
        return below, above

    def _outward(self, start: float) -> float | None:
        """Return the first tried value that meets the condition, going outward from the start."""
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
        """Search around the smallest excess for a value that meets the condition."""
        # finds a dip between two steps, and solutions next to values without a computable excess
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
        """Return the value nearest to the start that meets the condition.

        Parameters
        ----------
        good : a value that meets the condition; the search stays between the start and this value
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
                return good  # the condition holds wherever the excess can be computed
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
        """Round a root to few digits, towards the values that meet the condition."""
        towards = ceil if good > root else floor
        for digits in range(SIGNIFICANT, 1, -1):
            unit = 10.0 ** (floor(log10(abs(root))) + 1 - digits) if root else 1e-6
            x = float(f"{towards(root / unit) * unit:.{digits}g}")
            if min(root, good) <= x <= max(root, good) and self.at(x) <= 0.0:
                return x
        return good


def bracketed_root(
    function: Callable[[Any, float], float],
    about: Any,
    a: float,
    fa: float,
    b: float,
    fb: float,
    small: float,
    narrow: float,
) -> tuple[float, float, float]:
    """Find the root of a continuous function between two numbers.

    The function must have opposite signs at these numbers.

    Parameters
    ----------
    function, about : the function is called as `function(about, number)`; NaN ends the search
    a, fa, b, fb : two numbers and the values of the function there
    small : |function| at which the search stops
    narrow : width of the bracket at which the search stops

    Returns
    -------
    Root, function value at the root, and slope across the last bracket. The last evaluation of the
    function is at the root, or there is no evaluation if a or b is precise enough.

    Source: Chandrupatla, Advances in Engineering Software 28 (1997), 145-149.
    """
    # Chandrupatla's method: inverse quadratic steps, or bisection; the first step is a secant step
    share = fa / (fa - fb) if fa != fb else 0.5
    while True:
        width, slope = abs(b - a), (fb - fa) / (b - a) if b != a else 0.0
        if isnan(fa):
            return a, fa, slope
        root, value = (a, fa) if abs(fa) < abs(fb) else (b, fb)
        middle = a + 0.5 * (b - a)
        if abs(value) <= small or middle in (a, b):
            return root, value, slope
        if width <= narrow:
            return a, fa, slope
        least = 0.25 * narrow / width
        x = a + min(max(share, least), 1.0 - least) * (b - a)
        value = function(about, x)
        if (value > 0.0) == (fa > 0.0):
            c, fc = a, fa
        else:
            c, fc, b, fb = b, fb, a, fa
        a, fa = x, value
        share = 0.5
        place, height = (a - b) / (c - b), (fa - fb) / (fc - fb)
        if height * height < place and (1.0 - height) * (1.0 - height) < 1.0 - place:
            share = fa / (fb - fa) * fc / (fb - fc)
            share += (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)


def root_near(
    function: Callable[[Any, float], float],
    about: Any,
    x: float,
    slope: float,
    low: float,
    high: float,
    small: float,
    narrow: float,
) -> tuple[bool, float, float, float]:
    """Find the root of a decreasing function near a given number, between two limits.

    Parameters
    ----------
    function, about, small, narrow : as in `bracketed_root`
    x, slope : approximate root, and slope of the function there
    low, high : limits of the root

    Returns
    -------
    Whether a root was found, the root, the function value there, and the slope of the last secant.
    """
    # secant steps while each halves the value, then longer and longer steps to a change of sign
    x = min(max(x, low), high)
    fx = function(about, x)
    step = -fx / slope if slope < 0.0 else 0.0
    while abs(fx) > small:
        reach = max(abs(step), 1e-12 * (high - low))
        following = min(max(x + (reach if fx > 0.0 else -reach), low), high)
        if following == x:
            return False, x, fx, slope
        value = function(about, following)
        slope = (value - fx) / (following - x)
        if (value > 0.0) != (fx > 0.0) and not isnan(value):
            root, left, slope = bracketed_root(
                function, about, x, fx, following, value, small, narrow
            )
            return True, root, left, slope
        halved = abs(value) < 0.5 * abs(fx)
        step = -value / slope if halved else 8.0 * reach
        x, fx = following, value
    return True, x, fx, slope
