"""Distributions of extremes fitted by likelihood, and how sure what they extrapolate to is.

Coles, S. (2001): An Introduction to Statistical Modeling of Extreme Values, Springer,
doi:10.1007/978-1-4471-3675-0.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import exp, inf, log, pi, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

CONFIDENCE = 0.95
"""Of the intervals of `Tail.interval`."""

CHI_SQUARE = 3.841458820694124
"""Quantile of the χ² distribution with one degree of freedom at `CONFIDENCE`."""

LEAST_SHAPE = -0.5
"""Shape from which on the theory of the likelihood holds (Coles 2001, §3.3.2)."""

_SHAPES = (-1.0, 2.0)
_EULER = 0.5772156649015329
_NO_SHAPE = 1e-8  # a shape nearer to nothing is the exponential or the Gumbel case to rounding
_FURTHEST = 100.0  # spreads of the data that an interval is searched over
_MOST_DEVIANCE = 1e3  # keeps a search for a root away from infinities


@dataclass(frozen=True)
class Tail:
    """A generalised extreme value or a generalised Pareto distribution, fitted.

    Attributes
    ----------
    location, scale, shape : μ, σ, ξ; the location of a Pareto distribution is its threshold
    maxima : whether it is of maxima (GEV), else of what is beyond a threshold (Pareto)
    values : (n,) that it was fitted to
    """

    location: float
    scale: float
    shape: float
    maxima: bool
    values: Floats

    def level(self, growth: float) -> float:
        """The value exceeded with a probability that decides the `growth`: μ + σ (e^{ξ g} - 1)/ξ.

        g = -log(-log(1 - 1/T)) for maxima of years and T years (Coles 2001, eq. 3.4), g = log(λ T)
        for λ independent peaks a year (eq. 4.12 with λ in place of the rate of exceedances).
        """
        return self.location + self.scale * _grown(self.shape, growth)

    def interval(self, growth: float) -> tuple[float | None, float | None]:
        """Both ends of the `CONFIDENCE` interval of a level, by its profile likelihood.

        The values of the level at which twice the loss of log-likelihood, maximal over the other
        parameters, stays within the quantile of χ² (Coles 2001, §2.6.6, §3.3.4, §4.3.3). None for
        an end that the data do not set.
        """
        best, estimate = self._loss(self.location, self.scale, self.shape), self.level(growth)

        def excess(level: float) -> float:
            deviance = 2.0 * (self._profile(level, growth) - best)
            return min(deviance, _MOST_DEVIANCE) - CHI_SQUARE

        spread = float(self.values.std())
        return _end(excess, estimate, -spread), _end(excess, estimate, spread)

    def _loss(self, location: float, scale: float, shape: float) -> float:
        return _loss(self.values, location, scale, shape, self.maxima)

    def _profile(self, level: float, growth: float) -> float:
        """The least loss of all distributions with a given level."""
        if not self.maxima:

            def of_shape(free: Floats) -> float:
                scale = (level - self.location) / _grown(free[0], growth)
                return self._loss(self.location, scale, free[0])

            return _least(of_shape, [self.shape], [0.0])[1]

        def of_both(free: Floats) -> float:
            scale = exp(free[0])
            return self._loss(level - scale * _grown(free[1], growth), scale, free[1])

        return _least(of_both, [log(self.scale), self.shape], [log(self.scale), 0.0])[1]


def fit_maxima(values: Floats) -> Tail:
    """The generalised extreme value distribution of greatest likelihood (Coles 2001, eq. 3.7-3.9).

    Parameters
    ----------
    values : (n,) independent maxima of blocks of equal length, not all alike
    """
    middle, spread = float(values.mean()), float(values.std())
    scaled = (values - middle) / spread
    scale = sqrt(6.0) / pi  # of a Gumbel distribution of unit deviation

    def loss(free: Floats) -> float:
        return _loss(scaled, free[0], exp(free[1]), free[2], True)

    found, _ = _least(loss, [-_EULER * scale, log(scale), 0.0])
    location, size = middle + spread * float(found[0]), spread * exp(found[1])
    return Tail(location, size, float(found[2]), True, values)


def fit_excesses(values: Floats, threshold: float) -> Tail:
    """The generalised Pareto distribution of greatest likelihood (Coles 2001, eq. 4.10-4.11).

    Parameters
    ----------
    values : (n,) independent peaks, all above the threshold
    """
    size = float(values.mean()) - threshold
    scaled = (values - threshold) / size

    def loss(free: Floats) -> float:
        return _loss(scaled, 0.0, exp(free[0]), free[1], False)

    found, _ = _least(loss, [0.0, 0.0])
    return Tail(threshold, size * exp(found[0]), float(found[1]), False, values)


def _grown(shape: float, growth: float) -> float:
    """(e^{ξ g} - 1)/ξ."""
    shape = _apart(shape)
    return float(np.expm1(min(shape * growth, 700.0))) / shape


def _loss(values: Floats, location: float, scale: float, shape: float, maxima: bool) -> float:
    """Negative log-likelihood; infinite where a value cannot occur.

    With s = log(1 + ξ (x - μ)/σ)/ξ each value adds log σ + (1 + ξ) s, and e^{-s} as a maximum.
    """
    if not (_SHAPES[0] < shape < _SHAPES[1] and scale > 0.0):
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
    """Where a loss is least, and how much it is there, from the best of some starts."""
    from scipy.optimize import minimize

    start = min(starts, key=lambda one: loss(np.array(one)))
    if loss(np.array(start)) == inf:
        return np.array(start), inf
    options = {"xatol": 1e-4, "fatol": 1e-7, "maxiter": 2000}
    found = minimize(loss, start, method="Nelder-Mead", options=options)
    return found.x, float(found.fun)


def _end(excess: Callable[[float], float], estimate: float, step: float) -> float | None:
    """Where a function that is negative at an estimate turns positive on the side of a step."""
    from scipy.optimize import brentq

    within, reach = estimate, abs(step) * _FURTHEST
    beyond = estimate + 0.25 * step
    while excess(beyond) < 0.0:
        within, beyond = beyond, estimate + 2.0 * (beyond - estimate)
        if abs(beyond - estimate) > reach:
            return None
    return float(brentq(excess, within, beyond, xtol=1e-4 * abs(step)))
