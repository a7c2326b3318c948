"""Distributions of extremes, fitted by maximum likelihood, and the intervals of their levels.

Coles, S. (2001): An Introduction to Statistical Modeling of Extreme Values, Springer,
doi:10.1007/978-1-4471-3675-0.
"""

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, inf, log, pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

CONFIDENCE = 0.95
"""Share of the intervals of `Tail.interval` that hold the true level, were all assumptions met."""

CHI_SQUARE = 3.841458820694124
"""Quantile of the χ² distribution with one degree of freedom at `CONFIDENCE`."""

LEAST_SHAPE = -0.5
"""Shape from which on the theory of the likelihood holds (Coles 2001, §3.3.2)."""

SHAPES = (-1.0, 2.0)
"""Shapes that are searched. At -1 and below the likelihood has no maximum (Coles 2001, §3.3.2).
The upper bound is our choice: from 1 on even the mean is infinite, as of no force or depth."""

_AT_BOUND = 0.01  # our choice: a hundred times what the search for a shape is exact to
_EULER = 0.5772156649015329
_NO_SHAPE = 1e-8  # a shape nearer to nothing is the exponential or the Gumbel case to rounding
_FURTHEST = 100.0  # our choice: standard deviations of the data that an interval may reach
_MOST_DEVIANCE = 1e3  # keeps a search for a root away from infinities


class NotFitted(Exception):
    """A distribution could not be fitted; the message is the reason."""


@dataclass(frozen=True)
class Tail:
    """A generalised extreme value or a generalised Pareto distribution, fitted.

    Attributes
    ----------
    location, scale : μ, σ, in the unit of the values; the location of a Pareto distribution is
        its threshold
    shape : ξ; a tail with ξ < 0 ends at some value, one with ξ > 0 falls off slowly
    maxima : whether it describes maxima (GEV), rather than peaks over a threshold (Pareto)
    values : (n,) maxima or peaks that it was fitted to
    """

    location: float
    scale: float
    shape: float
    maxima: bool
    values: Floats

    def level(self, growth: float) -> float:
        """The return level μ + σ (e^{ξ g} - 1)/ξ of a period of T years.

        Its growth g is -log(-log(1 - 1/T)) for maxima of years (Coles 2001, eq. 3.4), log(λ T) for
        λ independent peaks a year (eq. 4.12 with λ in place of the rate of exceedances).
        """
        return self.location + self.scale * _grown(self.shape, growth)

    def interval(self, growth: float) -> tuple[float | None, float | None]:
        """Both ends of the `CONFIDENCE` interval of a level, by its profile likelihood.

        For each possible level the likelihood is maximised over the other parameters. The interval
        holds the levels for which twice the logarithm of this is less than `CHI_SQUARE` below that
        of the fit (Coles 2001, §2.6.6, §3.3.4, §4.3.3). An end is None where none is found within
        100 standard deviations of the values: the data do not bound the level there. NotFitted: the
        search for a maximum failed.
        """
        estimate = self.level(growth)
        best = _loss(self.values, self.location, self.scale, self.shape, self.maxima)

        def excess(level: float) -> float:
            deviance = 2.0 * (self._profile(level, growth) - best)
            return min(deviance, _MOST_DEVIANCE) - CHI_SQUARE

        spread = float(self.values.std())
        return _end(excess, estimate, -spread), _end(excess, estimate, spread)

    def _profile(self, level: float, growth: float) -> float:
        """The least loss of all distributions with a given level."""
        if not self.maxima:

            def of_shape(free: Floats) -> float:
                scale = (level - self.location) / _grown(free[0], growth)
                return _loss(self.values, self.location, scale, free[0], False)

            return _least(of_shape, [self.shape], [0.0])[1]

        def of_both(free: Floats) -> float:
            scale = exp(free[0])
            location = level - scale * _grown(free[1], growth)
            return _loss(self.values, location, scale, free[1], True)

        return _least(of_both, [log(self.scale), self.shape], [log(self.scale), 0.0])[1]


def fit_maxima(values: Floats) -> Tail:
    """The generalised extreme value distribution of greatest likelihood (Coles 2001, eq. 3.7-3.9).

    Parameters
    ----------
    values : (n,) independent maxima of blocks of equal length, not all alike

    Raises
    ------
    NotFitted
        The search failed, or ended at a bound of `SHAPES`.
    """
    middle, spread = float(values.mean()), float(values.std())
    scaled = (values - middle) / spread
    scale = sqrt(6.0) / pi  # of a Gumbel distribution of unit deviation

    def loss(free: Floats) -> float:
        return _loss(scaled, free[0], exp(free[1]), free[2], True)

    found, _ = _least(loss, [-_EULER * scale, log(scale), 0.0])
    location, size = middle + spread * float(found[0]), spread * exp(found[1])
    return Tail(location, size, _inside(found[2]), True, values)


def fit_excesses(values: Floats, threshold: float) -> Tail:
    """The generalised Pareto distribution of greatest likelihood (Coles 2001, eq. 4.10-4.11).

    Parameters
    ----------
    values : (n,) independent peaks, all above the threshold

    Raises
    ------
    NotFitted
        The search failed, or ended at a bound of `SHAPES`.
    """
    size = float(values.mean()) - threshold
    scaled = (values - threshold) / size

    def loss(free: Floats) -> float:
        return _loss(scaled, 0.0, exp(free[0]), free[1], False)

    found, _ = _least(loss, [0.0, 0.0])
    return Tail(threshold, size * exp(found[0]), _inside(found[1]), False, values)


def _inside(shape: float) -> float:
    """A shape that was found, refused where it is only as far as the search went."""
    for bound in SHAPES:
        if abs(shape - bound) <= _AT_BOUND:
            raise NotFitted(
                f"the fitted shape is {shape:.2f}, a bound of the search: the maximum of the "
                "likelihood lies there or beyond"
            )
    return float(shape)


def _grown(shape: float, growth: float) -> float:
    """(e^{ξ g} - 1)/ξ."""
    shape = _apart(shape)
    return float(np.expm1(min(shape * growth, 700.0))) / shape


def _loss(values: Floats, location: float, scale: float, shape: float, maxima: bool) -> float:
    """Negative log-likelihood; infinite where a value cannot occur.

    With s = log(1 + ξ (x - μ)/σ)/ξ each value adds log σ + (1 + ξ) s, and e^{-s} as a maximum.
    """
    if not (SHAPES[0] < shape < SHAPES[1] and scale > 0.0):
        return inf
    shape = _apart(shape)
    reached = shape * (values - location) / scale
    if reached.min() <= -1.0:
        return inf
    s = np.log1p(reached) / shape
    loss = len(values) * log(scale) + (1.0 + shape) * float(s.sum())
    if maxima:
        loss += float(np.exp(np.minimum(-s, 700.0)).sum())
    return loss


def _apart(shape: float) -> float:
    return shape if abs(shape) > _NO_SHAPE else _NO_SHAPE


def _least(loss: Callable[[Any], float], *starts: list[float]) -> tuple[Floats, float]:
    """Return where a loss is least, and how much it is there, from the best of some starts."""
    from scipy.optimize import minimize

    start = min(starts, key=lambda one: loss(np.array(one)))
    if loss(np.array(start)) == inf:
        return np.array(start), inf
    options = {"xatol": 1e-4, "fatol": 1e-7, "maxiter": 2000}
    found = minimize(loss, start, method="Nelder-Mead", options=options)
    if not found.success:
        raise NotFitted(f"the likelihood could not be maximised: {str(found.message).lower()}")
    return found.x, float(found.fun)


def _end(excess: Callable[[float], float], estimate: float, step: float) -> float | None:
    """Return where a function, negative at an estimate, turns positive on the side of a step."""
    from scipy.optimize import brentq

    within, reach = estimate, abs(step) * _FURTHEST
    beyond = estimate + 0.25 * step
    while excess(beyond) < 0.0:
        within, beyond = beyond, estimate + 2.0 * (beyond - estimate)
        if abs(beyond - estimate) > reach:
            return None
    return float(brentq(excess, within, beyond, xtol=1e-4 * abs(step)))
