"""Extreme-value distributions, fitted by maximum likelihood, and confidence intervals of their
return levels.

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
"""Confidence level of the intervals by `Tail.interval`: fraction of intervals that contain the true
level if all assumptions hold.
"""

CHI_SQUARE = 3.841458820694124
"""Quantile of the χ² distribution with one degree of freedom at `CONFIDENCE`."""

LEAST_SHAPE = -0.5
"""Shape parameter above which the theory of the likelihood is valid (Coles 2001, §3.3.2)."""

SHAPES = (-1.0, 2.0)
"""Searched range of the shape parameter. At -1 and below, the likelihood has no maximum (Coles
2001, §3.3.2). The upper bound is a choice of CALM: from 1 on, even the mean is infinite.
"""

_AT_BOUND = 0.01  # our choice: a hundred times the accuracy of the search for a shape
_EULER = 0.5772156649015329
_NO_SHAPE = 1e-8  # shapes closer to zero are, to rounding, the exponential or the Gumbel case
_FURTHEST = 100.0  # our choice: largest extent of an interval in standard deviations of the data
_MOST_DEVIANCE = 1e3  # keeps a root search away from infinities


class NotFitted(Exception):
    """A distribution could not be fitted; the message gives the reason."""


@dataclass(frozen=True)
class Tail:
    """A fitted generalised extreme value distribution (GEV) or generalised Pareto distribution.

    Attributes
    ----------
    location, scale : μ, σ, in the unit of the values; a Pareto location is the threshold
    shape : ξ; a tail with ξ < 0 has a finite end
    maxima : whether the distribution describes maxima (GEV) or peaks (Pareto)
    values : (n,) fitted maxima or peaks
    """

    location: float
    scale: float
    shape: float
    maxima: bool
    values: Floats

    def level(self, growth: float) -> float:
        """Return the level μ + σ (e^{ξ g} - 1)/ξ for a return period of T years.

        The growth g is -log(-log(1 - 1/T)) for annual maxima (Coles 2001, eq. 3.4). For λ
        independent peaks per year, g is log(λ T) (eq. 4.12, with λ for the rate of exceedances).
        """
        return self.location + self.scale * _grown(self.shape, growth)

    def interval(self, growth: float) -> tuple[float | None, float | None]:
        """Return both ends of the `CONFIDENCE` interval of a return level, by profile likelihood.

        An end is None if it is more than 100 standard deviations of the data away from the estimate
        (Coles 2001, §2.6.6, §3.3.4, §4.3.3). Raises NotFitted if a likelihood cannot be maximised.
        """
        estimate = self.level(growth)
        best = _loss(self.values, self.location, self.scale, self.shape, self.maxima)

        def excess(level: float) -> float:
            deviance = 2.0 * (self._profile(level, growth) - best)
            return min(deviance, _MOST_DEVIANCE) - CHI_SQUARE

        spread = float(self.values.std())
        return _end(excess, estimate, -spread), _end(excess, estimate, spread)

    def _profile(self, level: float, growth: float) -> float:
        """Return the least negative log-likelihood of all distributions with a return level."""
        if not self.maxima:

            def of_shape(free: Floats) -> float:
                scale = (level - self.location) / _grown(free[0], growth)
                return _loss(self.values, self.location, scale, free[0], False)

            return _minimise(of_shape, [self.shape], [0.0])[1]

        def of_both(free: Floats) -> float:
            scale = exp(free[0])
            location = level - scale * _grown(free[1], growth)
            return _loss(self.values, location, scale, free[1], True)

        return _minimise(of_both, [log(self.scale), self.shape], [log(self.scale), 0.0])[1]


def fit_maxima(values: Floats) -> Tail:
    """Fit a generalised extreme value distribution by maximum likelihood (Coles 2001, eq. 3.7-3.9).

    The values (n,) are independent maxima of equal blocks, not all equal. Raises NotFitted if the
    fit fails or ends at a bound of `SHAPES`.
    """
    middle, spread = float(values.mean()), float(values.std())
    scaled = (values - middle) / spread
    scale = sqrt(6.0) / pi  # scale of a Gumbel distribution of unit deviation

    def loss(free: Floats) -> float:
        return _loss(scaled, free[0], exp(free[1]), free[2], True)

    found, _ = _minimise(loss, [-_EULER * scale, log(scale), 0.0])
    location, size = middle + spread * float(found[0]), spread * exp(found[1])
    return Tail(location, size, _shape_inside_range(found[2]), True, values)


def fit_excesses(values: Floats, threshold: float) -> Tail:
    """Fit a generalised Pareto distribution by maximum likelihood (Coles 2001, eq. 4.10-4.11).

    The values (n,) are independent peaks above the threshold. Raises NotFitted if the fit fails or
    ends at a bound of `SHAPES`.
    """
    size = float(values.mean()) - threshold
    scaled = (values - threshold) / size

    def loss(free: Floats) -> float:
        return _loss(scaled, 0.0, exp(free[0]), free[1], False)

    found, _ = _minimise(loss, [0.0, 0.0])
    return Tail(threshold, size * exp(found[0]), _shape_inside_range(found[1]), False, values)


def _shape_inside_range(shape: float) -> float:
    for bound in SHAPES:
        if abs(shape - bound) <= _AT_BOUND:
            raise NotFitted(
                f"the fitted shape parameter is {shape:.2f}, at a limit of the search range; a "
                "shape parameter outside this range may fit better"
            )
    return float(shape)


def _grown(shape: float, growth: float) -> float:
    """Evaluate (e^{ξ g} - 1)/ξ."""
    shape = _apart(shape)
    return float(np.expm1(min(shape * growth, 700.0))) / shape


def _loss(values: Floats, location: float, scale: float, shape: float, maxima: bool) -> float:
    """Return the negative log-likelihood, which is infinite if a value is impossible.

    Let s = log(1 + ξ (x - μ)/σ)/ξ. The term of a peak x is log σ + (1 + ξ) s. The term of a maximum
    x is log σ + (1 + ξ) s + e^{-s}.
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


def _minimise(loss: Callable[[Any], float], *starts: list[float]) -> tuple[Floats, float]:
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
    """Find the end of a confidence interval, a root of `excess`.

    `excess` is negative at the estimate. The search goes from the estimate in the direction of
    `step`. Return None if the root is too far from the estimate.
    """
    from scipy.optimize import brentq

    within, reach = estimate, abs(step) * _FURTHEST
    beyond = estimate + 0.25 * step
    while excess(beyond) < 0.0:
        within, beyond = beyond, estimate + 2.0 * (beyond - estimate)
        if abs(beyond - estimate) > reach:
            return None
    return float(brentq(excess, within, beyond, xtol=1e-4 * abs(step)))
