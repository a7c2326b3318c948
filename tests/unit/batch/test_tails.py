"""Fitted tails: published figures, and distributions whose parameters are known."""

from math import exp, log, log1p

import numpy as np
import pytest
from scipy import optimize, stats

from calm.batch.statistics.tails import (
    CHI_SQUARE,
    CONFIDENCE,
    NotFitted,
    fit_excesses,
    fit_maxima,
)

# Annual maxima of the sea level at Port Pirie, 1923 to 1987 [m]: Coles (2001), table 1.1
PORT_PIRIE = np.array([
    4.03, 3.83, 3.65, 3.88, 4.01, 4.08, 4.18, 3.80, 4.36, 3.96, 3.98, 4.69, 3.85, 3.96, 3.85, 3.93,
    3.75, 3.63, 3.57, 4.25, 3.97, 4.05, 4.24, 4.22, 3.73, 4.37, 4.06, 3.71, 3.96, 4.06, 4.55, 3.79,
    3.89, 4.11, 3.85, 3.86, 3.86, 4.21, 4.01, 4.11, 4.24, 3.96, 4.21, 3.74, 3.85, 3.88, 3.66, 4.11,
    3.71, 4.18, 3.90, 3.78, 3.91, 3.72, 4.00, 3.66, 3.62, 4.33, 4.55, 3.75, 4.08, 3.90, 3.88, 3.94,
    4.33,
])  # fmt: skip


def of_maxima(period):
    return -log(-log1p(-1.0 / period))


def test_the_sea_level_at_port_pirie_as_published():
    # Coles (2001), section 3.4.1: estimates to the digits printed there
    tail = fit_maxima(PORT_PIRIE)
    assert tail.location == pytest.approx(3.87, abs=0.005)
    assert tail.scale == pytest.approx(0.198, abs=5e-4)
    assert tail.shape == pytest.approx(-0.050, abs=5e-4)
    assert tail.level(of_maxima(10)) == pytest.approx(4.30, abs=0.005)
    assert tail.level(of_maxima(100)) == pytest.approx(4.69, abs=0.005)
    # the interval of the 100-year level was read off a curve there: a hundredth of a metre or so
    assert tail.interval(of_maxima(100)) == pytest.approx((4.50, 5.27), abs=0.015)


def test_at_the_ends_of_an_interval_the_likelihood_has_fallen_by_half_of_chi_square():
    # the profile computed another way: scipy's likelihood, maximized over scale and shape
    tail, growth = fit_maxima(PORT_PIRIE), of_maxima(100)
    best = stats.genextreme.logpdf(PORT_PIRIE, -tail.shape, tail.location, tail.scale).sum()
    probability = exp(-exp(-growth))

    def fall(level):
        def loss(free):
            scale, shape = exp(free[0]), free[1]
            location = level - scale * stats.genextreme.ppf(probability, -shape)
            with np.errstate(divide="ignore"):
                return -stats.genextreme.logpdf(PORT_PIRIE, -shape, location, scale).sum()

        found = optimize.minimize(loss, [log(tail.scale), 0.01], method="Nelder-Mead")
        return best + found.fun

    for end in tail.interval(growth):
        assert 2.0 * fall(end) == pytest.approx(CHI_SQUARE, rel=2e-3)


def test_the_quantile_is_that_of_the_confidence():
    assert pytest.approx(stats.chi2.ppf(CONFIDENCE, 1), rel=1e-12) == CHI_SQUARE


@pytest.mark.parametrize("shape", [-0.2, 0.0, 0.15])
def test_a_known_distribution_of_maxima_is_found_again(shape):
    values = stats.genextreme.rvs(
        -shape, loc=20.0, scale=3.0, size=400, random_state=np.random.default_rng(1)
    )
    tail = fit_maxima(values)
    by_scipy = stats.genextreme.fit(values, -tail.shape, loc=tail.location, scale=tail.scale)
    assert (-tail.shape, tail.location, tail.scale) == pytest.approx(by_scipy, abs=2e-3)
    for period in (10, 100):
        low, high = tail.interval(of_maxima(period))
        assert low < stats.genextreme.isf(1.0 / period, -shape, loc=20.0, scale=3.0) < high
        fitted = stats.genextreme.isf(1.0 / period, -tail.shape, tail.location, tail.scale)
        assert tail.level(of_maxima(period)) == pytest.approx(fitted, rel=1e-6)


@pytest.mark.parametrize("shape", [-0.2, 0.0, 0.15])
def test_a_known_distribution_of_peaks_is_found_again(shape):
    values = 10.0 + stats.genpareto.rvs(
        shape, scale=2.0, size=400, random_state=np.random.default_rng(2)
    )
    tail = fit_excesses(values, 10.0)
    by_scipy = stats.genpareto.fit(values - 10.0, tail.shape, floc=0.0, scale=tail.scale)
    assert (tail.shape, tail.scale) == pytest.approx((by_scipy[0], by_scipy[2]), abs=2e-3)
    low, high = tail.interval(log(1000.0))
    assert low < 10.0 + stats.genpareto.isf(1e-3, shape, scale=2.0) < high


@pytest.mark.thorough
def test_most_intervals_hold_the_true_level():
    # 95 % of the intervals should; of 60, fewer than 52 is rarer than one in a thousand
    random, growth, held = np.random.default_rng(3), log(300.0), 0
    for _ in range(60):
        values = 10.0 + stats.genpareto.rvs(0.1, scale=2.0, size=100, random_state=random)
        low, high = fit_excesses(values, 10.0).interval(growth)
        held += low < 10.0 + stats.genpareto.isf(1.0 / 300.0, 0.1, scale=2.0) < (high or np.inf)
    assert held >= 52


def test_a_tail_whose_shape_is_at_a_bound_is_not_fitted():
    with pytest.raises(NotFitted, match=r"the fitted shape parameter is 2\.00"):
        fit_excesses(1.0 + np.geomspace(1e-9, 1e9, 60), 1.0)
    with pytest.raises(NotFitted, match="at a limit of the search"):
        fit_maxima(np.geomspace(1e-9, 1e9, 60))
