"""Return levels: how maxima and peaks are chosen, what is told, and what is refused."""

import numpy as np
import pytest
from scipy import optimize, stats

from calm.batch.statistics.extremes import (
    LEAST_PEAKS,
    Fit,
    LevelsRefused,
    annual_maxima,
    extremal_index,
    median_step,
    peaks_over,
    return_levels,
)

HOUR, DAY = np.timedelta64(3600, "s"), np.timedelta64(86400, "s")


def times(count, step=HOUR):
    return np.datetime64("1993-01-01", "ns") + np.arange(count) * step


def daily_peaks(years, shape, scale, seed):
    """A peak a day above 10, independent of the others, in an otherwise still daily record."""
    count = round(365.25 * years)
    return times(count, DAY), stats.genpareto.rvs(
        shape, loc=10.0, scale=scale, size=count, random_state=np.random.default_rng(seed)
    )


def test_levels_go_with_the_unit():
    time, values = daily_peaks(20, 0.05, 2.0, 4)
    for here, there in zip(
        return_levels(time, values, {}), return_levels(time, 0.001 * values - 5.0, {}), strict=True
    ):
        assert here.shape == pytest.approx(there.shape, abs=1e-4)
        for level, other in zip(here.levels, there.levels, strict=True):
            assert other.level == pytest.approx(0.001 * level.level - 5.0, abs=1e-5)
            assert other.high == pytest.approx(0.001 * level.high - 5.0, abs=1e-4)


def test_both_ways_agree_with_the_truth():
    # a peak a day: the T-year level is exceeded once in 365.25 T days
    time, values = daily_peaks(40, 0.1, 2.0, 5)
    gev, pot = return_levels(time, values, {})
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
    assert return_levels(time, values, {}) == return_levels(time, values, {})


def test_no_level_beyond_four_times_the_record():
    time, values = daily_peaks(12, 0.1, 2.0, 7)
    for fit in return_levels(time, values, {}):
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


@pytest.mark.parametrize(
    ("at", "peaks"),
    [
        # intervals 2 2 2, none beyond 2: θ = 2·6²/(3·12) = 2, at most 1, and every peak is its own
        ([0, 2, 4, 6], [2.0, 3.0, 4.0, 5.0]),
        # intervals 1 2 1: θ = 2·4²/(3·6) = 1.8, at most 1; what follows at once stays together
        ([0, 1, 3, 4], [3.0, 5.0]),
        # intervals 1 1 3, one beyond 2: θ = 2·2²/(3·2) = 1.3, at most 1
        ([0, 1, 2, 5], [4.0, 5.0]),
    ],
)
def test_the_index_changes_its_form_beyond_an_interval_of_two(at, peaks):
    values = np.zeros(10)
    values[at] = 2.0, 3.0, 4.0, 5.0
    assert peaks_over(times(10), values, 1.0, HOUR).tolist() == peaks


@pytest.mark.parametrize(
    ("intervals", "index"),
    [
        # 2 (ΣT)²/((N-1) ΣT²) as long as no interval is beyond 2: 2·22²/(21·24)
        ([1.0] * 20 + [2.0], 2.0 * 22.0**2 / (21.0 * 24.0)),
        # 2 (Σ(T-1))²/((N-1) Σ(T-1)(T-2)) from 3 on: 2·2²/(21·2)
        ([1.0] * 20 + [3.0], 2.0 * 2.0**2 / (21.0 * 2.0)),
    ],
)
def test_the_extremal_index_on_both_sides_of_its_boundary(intervals, index):
    assert extremal_index(np.array(intervals)) == pytest.approx(min(index, 1.0))


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
    gev, pot = return_levels(time, values, {})
    assert isinstance(gev, LevelsRefused) and isinstance(pot, LevelsRefused)
    assert "10 whole years" in gev.reason and "whole years in the record: 0 of 1" in gev.reason
    assert "183 days" in pot.reason


def test_a_few_years_do_for_peaks_only():
    time, values = daily_peaks(9.5, 0.1, 2.0, 11)
    gev, pot = return_levels(time, values, {})
    assert "whole years in the record: 9 of 10" in gev.reason
    assert isinstance(pot, Fit)


def test_one_long_storm_has_too_few_peaks():
    time = times(2 * 8766)
    values = np.sin(np.linspace(0.0, np.pi, len(time)))
    _, pot = return_levels(time, values, {})
    assert f"{LEAST_PEAKS} independent peaks are needed" in pot.reason


def test_gaps_do_not_count_as_record():
    time, values = daily_peaks(2.0, 0.1, 2.0, 12)
    values[: len(values) - 300] = np.nan
    _, pot = return_levels(time, values, {})
    assert "300 days" in pot.reason


@pytest.mark.parametrize(
    ("time", "values", "reason"),
    [
        (times(5), np.ones(5), "all values are equal"),
        (times(5), np.full(5, np.nan), "there are too few values (0)"),
        (times(5)[::-1], np.arange(5.0), "must increase"),
    ],
)
def test_what_cannot_be_fitted_is_said(time, values, reason):
    for refusal in return_levels(time, values, {}):
        assert reason in refusal.reason


def test_a_tail_that_ends_abruptly_has_levels_without_intervals():
    time = times(4 * 8766)
    values = stats.genpareto.rvs(
        -0.75, scale=0.75, size=len(time), random_state=np.random.default_rng(13)
    )
    _, pot = return_levels(time, values, {})
    assert -0.9 < pot.shape < -0.6
    assert "no intervals" in pot.rules
    assert all((level.low, level.high) == (None, None) for level in pot.levels)
    assert all(level.level == pytest.approx(1.0, abs=2e-3) for level in pot.levels)


def test_a_fit_at_the_bound_of_the_search_is_refused():
    # uniform: the generalised Pareto distribution of shape -1, where the search ends
    time = times(4 * 8766)
    values = np.random.default_rng(13).uniform(size=len(time))
    _, pot = return_levels(time, values, {})
    assert isinstance(pot, LevelsRefused)
    assert "at a limit of the search" in pot.reason


@pytest.mark.parametrize("searches", [0, 1])
def test_a_search_that_fails_is_refused(monkeypatch, searches):
    # the first search is that of the fit, the next is one of an end of an interval
    minimize, done = optimize.minimize, []

    def failing(*given, **options):
        found = minimize(*given, **options)
        done.append(found)
        if len(done) > searches:
            found.success, found.message = False, "Maximum number of iterations exceeded."
        return found

    monkeypatch.setattr(optimize, "minimize", failing)
    time, values = daily_peaks(12, 0.1, 2.0, 6)
    gev, pot = return_levels(time, values, {})
    for refusal in (gev, pot):
        assert isinstance(refusal, LevelsRefused)
        assert "could not be maximised: maximum number of iterations" in refusal.reason


def test_no_level_where_the_strongest_currents_have_no_solution():
    time, values = daily_peaks(30, 0.1, 2.0, 25)
    strongest = np.argsort(values)[-19:]
    kept = values.copy()
    kept[strongest] = np.nan
    ended = {"converged": len(values) - 19, "no-equilibrium": 14, "anchor-lifts": 5}
    # what would be told from the others: an interval that the true level is far beyond
    true = 10.0 + stats.genpareto.isf(1.0 / 36525.0, 0.1, scale=2.0)
    assert return_levels(time, kept, {})[0].levels[-1].high < 0.8 * true
    for refusal in return_levels(time, kept, ended):
        assert isinstance(refusal, LevelsRefused)
        assert (
            "some profiles with a current were not solved (19 without equilibrium" in refusal.reason
        )


def test_no_level_where_a_profile_did_not_converge():
    time, values = daily_peaks(12, 0.1, 2.0, 15)
    for refusal in return_levels(time, values, {"converged": len(time), "not-converged": 1}):
        assert "1 not converged" in refusal.reason


def test_gaps_and_weak_currents_leave_levels_and_gaps_are_told():
    time, values = daily_peaks(12, 0.1, 2.0, 16)
    values[100:120] = np.nan
    values[3000:3030] = np.nan
    ended = {"converged": len(time) - 50, "no-current": 20, "slack": 20, "above-surface": 10}
    for fit in return_levels(time, values, ended):
        assert isinstance(fit, Fit)
        assert "1.1 % of the time between the first and the last profile is missing" in fit.rules
    assert all(
        "missing" not in fit.rules for fit in return_levels(*daily_peaks(12, 0.1, 2, 16), {})
    )


def test_the_median_step_is_that_of_the_times_in_any_unit():
    for unit in ("s", "us", "ns"):
        assert median_step(times(9).astype(f"datetime64[{unit}]")) == HOUR
