"""Return levels: published figures, distributions whose parameters are known, and refusals."""

from math import exp, log, log1p

import numpy as np
import pytest
from scipy import optimize, stats

from calm.batch.statistics.extremes import (
    LEAST_PEAKS,
    Fit,
    Refusal,
    annual_maxima,
    peaks_over,
    return_levels,
)
from calm.batch.statistics.tails import CHI_SQUARE, CONFIDENCE, fit_excesses, fit_maxima

HOUR, DAY = np.timedelta64(3600, "s"), np.timedelta64(86400, "s")

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


def times(count, step=HOUR):
    return np.datetime64("1993-01-01", "ns") + np.arange(count) * step


def daily_peaks(years, shape, scale, seed):
    """A peak a day above 10, independent of the others, in an otherwise still daily record."""
    count = round(365.25 * years)
    return times(count, DAY), stats.genpareto.rvs(
        shape, loc=10.0, scale=scale, size=count, random_state=np.random.default_rng(seed)
    )


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


def test_most_intervals_hold_the_true_level():
    # 95 % of the intervals should; of 60, fewer than 52 is rarer than one in a thousand
    random, growth, held = np.random.default_rng(3), log(300.0), 0
    for _ in range(60):
        values = 10.0 + stats.genpareto.rvs(0.1, scale=2.0, size=100, random_state=random)
        low, high = fit_excesses(values, 10.0).interval(growth)
        held += low < 10.0 + stats.genpareto.isf(1.0 / 300.0, 0.1, scale=2.0) < (high or np.inf)
    assert held >= 52


def test_levels_go_with_the_unit():
    time, values = daily_peaks(20, 0.05, 2.0, 4)
    for here, there in zip(
        return_levels(time, values), return_levels(time, 0.001 * values - 5.0), strict=True
    ):
        assert here.shape == pytest.approx(there.shape, abs=1e-4)
        for level, other in zip(here.levels, there.levels, strict=True):
            assert other.level == pytest.approx(0.001 * level.level - 5.0, abs=1e-5)
            assert other.high == pytest.approx(0.001 * level.high - 5.0, abs=1e-4)


def test_both_ways_agree_with_the_truth():
    # a peak a day: the T-year level is exceeded once in 365.25 T days
    time, values = daily_peaks(40, 0.1, 2.0, 5)
    gev, pot = return_levels(time, values)
    assert (gev.method, pot.method) == ("gev", "pot")
    assert gev.count in (39, 40)  # the last day of the record may fall short of the last year
    for fit in (gev, pot):
        assert [level.period for level in fit.levels] == [2, 10, 50, 100]
        for level in fit.levels[1:]:
            true = 10.0 + stats.genpareto.isf(1.0 / (365.25 * level.period), 0.1, scale=2.0)
            assert level.low < true < level.high
            assert level.low < level.level < level.high


def test_the_same_record_gives_the_same_levels():
    time, values = daily_peaks(12, 0.1, 2.0, 6)
    assert return_levels(time, values) == return_levels(time, values)


def test_no_level_beyond_four_times_the_record():
    time, values = daily_peaks(12, 0.1, 2.0, 7)
    for fit in return_levels(time, values):
        assert [level.period for level in fit.levels] == [2, 10]


def test_annual_maxima_by_hand():
    # three years of days, then a gap of 60 of them in the second, whose maximum no longer counts
    time = times(3 * 365 + 1, DAY)
    values = np.zeros(len(time))
    values[[100, 500, 900]] = 3.0, 7.0, 5.0
    assert annual_maxima(time, values, DAY)[0].tolist() == [3.0, 7.0, 5.0]
    values[600:660] = np.nan
    maxima, years = annual_maxima(time, values, DAY)
    assert maxima.tolist() == [3.0, 5.0]
    assert years == 3


def test_peaks_by_hand():
    # exceedances at steps 0 1 2 10 11 30: intervals 1 1 8 1 19, θ = 2·25²/(5·348) = 0.718, so 5
    # clusters of 6 exceedances, but three intervals are alike: those longer than 1 part
    values = np.zeros(40)
    values[[0, 1, 2, 10, 11, 30]] = 2.0, 5.0, 3.0, 4.0, 6.0, 2.5
    assert peaks_over(times(40), values, 1.0, HOUR).tolist() == [5.0, 6.0, 2.5]


def test_neighbours_in_time_are_one_cluster():
    # intervals 1 1 1, none beyond 2: θ = 2·3²/(3·3) = 2, at most 1, which would part them all
    values = np.array([0.0, 2.0, 3.0, 4.0, 2.0, 0.0])
    assert peaks_over(times(6), values, 1.0, HOUR).tolist() == [4.0]
    # with one of 103 between, θ = 2·102²/(7·102·101) = 0.29: 3 clusters of 8
    longer = np.concatenate([values, np.zeros(100), values])
    assert peaks_over(times(len(longer)), longer, 1.0, HOUR).tolist() == [4.0, 4.0]


def test_what_is_independent_is_not_gathered():
    random = np.random.default_rng(8)
    values = random.exponential(size=20000)
    threshold = float(np.percentile(values, 98.0))
    peaks = peaks_over(times(len(values)), values, threshold, HOUR)
    # θ of independent values is 1; its estimate from 400 of them is good to some 10 %
    assert len(peaks) > 0.85 * (values > threshold).sum()


def test_a_moving_maximum_of_two_has_half_as_many_clusters():
    values = np.random.default_rng(9).exponential(size=40001)
    values = np.maximum(values[1:], values[:-1])  # its extremal index is 0.5
    threshold = float(np.percentile(values, 98.0))
    peaks = peaks_over(times(len(values)), values, threshold, HOUR)
    assert len(peaks) == pytest.approx(0.5 * (values > threshold).sum(), rel=0.1)


def test_a_short_record_is_refused_with_its_length():
    time, values = daily_peaks(0.5, 0.1, 2.0, 10)
    gev, pot = return_levels(time, values)
    assert isinstance(gev, Refusal) and isinstance(pot, Refusal)
    assert "10 whole years" in gev.reason and "of the 1 year begun, 0 have 90 %" in gev.reason
    assert "183 days" in pot.reason


def test_a_few_years_do_for_peaks_only():
    time, values = daily_peaks(9.5, 0.1, 2.0, 11)
    gev, pot = return_levels(time, values)
    assert "of the 10 years begun, 9 have 90 %" in gev.reason
    assert isinstance(pot, Fit)


def test_one_long_storm_has_too_few_peaks():
    time = times(2 * 8766)
    values = np.sin(np.linspace(0.0, np.pi, len(time)))
    _, pot = return_levels(time, values)
    assert f"{LEAST_PEAKS} independent peaks are needed" in pot.reason


def test_gaps_do_not_count_as_record():
    time, values = daily_peaks(2.0, 0.1, 2.0, 12)
    values[: len(values) - 300] = np.nan
    _, pot = return_levels(time, values)
    assert "300 days" in pot.reason


@pytest.mark.parametrize(
    ("time", "values", "reason"),
    [
        (times(5), np.ones(5), "all alike"),
        (times(5), np.full(5, np.nan), "there are 0 values"),
        (times(5)[::-1], np.arange(5.0), "do not ascend"),
    ],
)
def test_what_cannot_be_fitted_is_said(time, values, reason):
    for refusal in return_levels(time, values):
        assert reason in refusal.reason


def test_a_tail_that_ends_abruptly_has_levels_without_intervals():
    # uniform: the generalised Pareto distribution of shape -1
    time = times(4 * 8766)
    values = np.random.default_rng(13).uniform(size=len(time))
    _, pot = return_levels(time, values)
    assert pot.shape < -0.5
    assert "no intervals" in pot.rules
    assert all((level.low, level.high) == (None, None) for level in pot.levels)
    assert all(level.level == pytest.approx(1.0, abs=1e-3) for level in pot.levels)
