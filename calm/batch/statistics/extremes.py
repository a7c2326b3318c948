"""Return levels: values that a response exceeds once in a given number of years on average.

- GEV: the generalised extreme value distribution of annual maxima (Coles 2001, chapter 3).
- POT: the generalised Pareto distribution of independent peaks over a threshold (Coles, chapter 4).
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, log, log1p

import numpy as np
from numpy.typing import NDArray

from calm.batch.statistics import tails
from calm.batch.statistics.series import Column, Times
from calm.batch.statistics.tails import CONFIDENCE, LEAST_SHAPE
from calm.batch.statuses import IN_WEAK_CURRENT, Ending, ending_of

PERIODS = (2, 10, 50, 100)
"""Return periods [years]."""

EXTRAPOLATION = 4.0
"""Longest reported return period, as a multiple of the record length. Choice of CALM: a record of
thirty years allows the 100-year level, a record of one year only the 2-year level.
"""

LEAST_MAXIMA = 10
"""Number of whole years required for GEV. Choice of CALM: the fit has three parameters, so ten
values are few, as the wide intervals show.
"""

LEAST_YEARS = 1.0
"""Years of solved profiles required for POT. Choice of CALM, because each year has a stormy
season.
"""

LEAST_PEAKS = 30
"""Number of independent peaks required for POT. Choice of CALM: confidence intervals from few peaks
contain the true return level less often than stated.
"""

THRESHOLDS = (99.0, 98.0, 97.0, 96.0, 95.0, 94.0, 93.0, 92.0, 91.0, 90.0)
"""Percentiles tried in turn as the threshold of POT, until enough peaks exceed the threshold.
Choice of CALM, because a generalised Pareto distribution is valid for high thresholds only (Coles
2001, §4.3.1).
"""

# our choice: a share of the record (nine hours a year) that is not worth reporting
_FEW_GAPS = 1e-3

METHODS = {"gev": "GEV of annual maxima", "pot": "POT, generalised Pareto"}
"""Descriptions of the two methods, by their names in files."""


@dataclass(frozen=True)
class Level:
    """A return level and its `CONFIDENCE` interval, in the unit of the values.

    Attributes
    ----------
    period : return period T [years]. On average, one in T annual maxima exceeds the level (GEV), or
        one peak exceeds the level in T years (POT)
    low, high : ends of the confidence interval; None if the data do not determine an end
    """

    period: int
    level: float
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Fit:
    """A fitted distribution and its return levels.

    Attributes
    ----------
    method : a key of `METHODS`
    location, scale, shape : μ, σ and ξ; for POT, the location is the threshold
    count, rate : number of fitted maxima or peaks, in total and per year
    rules : description of the selection of maxima or peaks
    levels : return levels for those `PERIODS` that the length of the record allows
    """

    method: str
    location: float
    scale: float
    shape: float
    count: int
    rate: float
    rules: str
    levels: tuple[Level, ...]


@dataclass(frozen=True)
class LevelsRefused:
    """Reason why a method in `METHODS` has no return levels."""

    method: str
    reason: str


def return_levels(
    time: Times, values: Column, statuses: Mapping[str, int], step: np.timedelta64 | None = None
) -> tuple[Fit | LevelsRefused, Fit | LevelsRefused]:
    """Compute return levels with 95 % intervals, first by GEV and then by POT.

    Return a `Fit` for each method, or the reason why the method has no return levels. Return levels
    require a solution for every profile with a current, except for profiles in weak currents
    (`calm.batch.statuses.IN_WEAK_CURRENT`).

    Parameters
    ----------
    time : (n,) times, ascending and evenly spaced except for gaps
    values : (n,) values of the quantity; NaN if missing
    statuses : number of profiles by status, from `calm.batch.finished.statuses_of`
    step : `median_step` of the times, if already known
    """
    refusal = _reason_if_censored(statuses) or _reason_against_fit(time, values)
    if refusal:
        return LevelsRefused("gev", refusal), LevelsRefused("pot", refusal)
    step = median_step(time) if step is None else step
    years = years_of(step, int(np.count_nonzero(np.isfinite(values))))
    fits: list[Fit | LevelsRefused] = []
    for method, fit in (("gev", _by_maxima), ("pot", _by_peaks)):
        try:
            fits.append(fit(time, values, step, years))
        except tails.NotFitted as reason:
            fits.append(LevelsRefused(method, str(reason)))
    return fits[0], fits[1]


def _reason_if_censored(statuses: Mapping[str, int]) -> str:
    ended = {ending: 0 for ending in (Ending.NO_EQUILIBRIUM, Ending.NOT_CONVERGED)}
    for status, count in statuses.items():
        if ending_of(status) in ended and status not in IN_WEAK_CURRENT:
            ended[ending_of(status)] += count
    outcomes = " and ".join(f"{count} {ending.value}" for ending, count in ended.items() if count)
    return outcomes and (
        f"some profiles with a current were not solved ({outcomes}); the largest values may occur "
        "in these profiles, so levels from the solved profiles would be too low"
    )


def _reason_against_fit(time: Times, values: Column) -> str:
    count = int(np.count_nonzero(np.isfinite(values)))
    if count < 2:
        return f"there are too few values ({count})"
    if not bool((time[1:] > time[:-1]).all()):
        return "the times must increase"
    if np.fmax.reduce(values) == np.fmin.reduce(values):
        return "all values are equal"
    return ""


def _by_maxima(
    time: Times, values: Column, step: np.timedelta64, years: float
) -> Fit | LevelsRefused:
    maxima, count = annual_maxima(time, values, step)
    if len(maxima) < LEAST_MAXIMA:
        return LevelsRefused(
            "gev",
            f"annual maxima of {LEAST_MAXIMA} whole years are needed; a whole year has at least "
            f"{100 * WHOLE:.0f} % of its profiles; whole years in the record: {len(maxima)} of "
            f"{count}",
        )
    if maxima.max() == maxima.min():
        return LevelsRefused("gev", f"the {len(maxima)} annual maxima are all equal")
    tail = tails.fit_maxima(maxima)
    rules = (
        f"{len(maxima)} maxima, one from each year that has at least {100 * WHOLE:.0f} % of its "
        "profiles; the first year begins with the first profile, and a year has 365.25 days"
        f"{_gaps(time, values, step)}"
    )
    growths = {period: -log(-log1p(-1.0 / period)) for period in _periods(years)}
    return _fit_with_levels("gev", tail, 1.0, rules, growths)


def _by_peaks(
    time: Times, values: Column, step: np.timedelta64, years: float
) -> Fit | LevelsRefused:
    if years < LEAST_YEARS:
        return LevelsRefused(
            "pot", f"a year of solved profiles is needed; there are {365.25 * years:.0f} days"
        )
    thresholds = np.percentile(values[np.isfinite(values)], THRESHOLDS, overwrite_input=True)
    most = 0
    for percentile, threshold in zip(THRESHOLDS, thresholds.tolist(), strict=True):
        peaks = peaks_over(time, values, threshold, step)
        most = max(most, len(peaks))
        if len(peaks) >= LEAST_PEAKS:
            return _over(percentile, threshold, peaks, years, _gaps(time, values, step))
    return LevelsRefused(
        "pot",
        f"{LEAST_PEAKS} independent peaks are needed; with thresholds from the "
        f"{THRESHOLDS[-1]:.0f} % to the {THRESHOLDS[0]:.0f} % quantile, at most {most} were found",
    )


def _over(
    percentile: float, threshold: float, peaks: NDArray[np.float64], years: float, gaps: str
) -> Fit | LevelsRefused:
    if peaks.max() == peaks.min():
        return LevelsRefused("pot", f"the {len(peaks)} peaks are all equal")
    tail, rate = tails.fit_excesses(peaks, threshold), len(peaks) / years
    rules = (
        f"{len(peaks)} peaks, one from each cluster of values above the {percentile:.0f} % "
        f"quantile; this is the highest quantile from {THRESHOLDS[-1]:.0f} % to "
        f"{THRESHOLDS[0]:.0f} % that gives at least {LEAST_PEAKS} clusters; the intervals between "
        f"exceedances define the clusters (Ferro and Segers 2003){gaps}"
    )
    growths = {period: log(rate * period) for period in _periods(years) if rate * period > 1.0}
    return _fit_with_levels("pot", tail, rate, rules, growths)


def _gaps(time: Times, values: Column, step: np.timedelta64) -> str:
    room = 1.0 + float((time[-1] - time[0]) / step)
    missing = 1.0 - int(np.count_nonzero(np.isfinite(values))) / room
    if missing < _FEW_GAPS:
        return ""
    return (
        f"; {100 * missing:.1f} % of the time between the first and the last profile is "
        "missing, and the levels and their intervals assume that no storm occurred then"
    )


def _periods(years: float) -> list[int]:
    return [period for period in PERIODS if period <= EXTRAPOLATION * years]


def _fit_with_levels(
    method: str, tail: tails.Tail, rate: float, rules: str, growths: dict[int, float]
) -> Fit:
    nothing = (None, None)
    sure = tail.shape > LEAST_SHAPE
    rules += (
        f"; {100 * CONFIDENCE:.0f} % intervals by profile likelihood"
        if sure
        else (
            "; no intervals, because the likelihood theory requires a shape parameter above "
            f"{LEAST_SHAPE}; the fitted shape parameter is {tail.shape:.2f}"
        )
    )
    levels = tuple(
        Level(period, tail.level(growth), *(tail.interval(growth) if sure else nothing))
        for period, growth in growths.items()
    )
    count = len(tail.values)
    return Fit(method, tail.location, tail.scale, tail.shape, count, rate, rules, levels)


WHOLE = 0.9
"""Fraction of the profiles of a year that a complete year must have. Choice of CALM: five missing
weeks seldom hide the annual maximum, but a missing season may.
"""

YEAR = np.timedelta64(31_557_600, "s")
"""Length of a year, 365.25 days."""


def years_of(step: np.timedelta64, count: int) -> float:
    """Return the time represented by `count` profiles [years]; a profile represents one `step`."""
    return count * float(step / YEAR)


def median_step(time: Times) -> np.timedelta64:
    """Return the median time between successive profiles; for a single profile, return zero.

    A few gaps in the record do not change the median.
    """
    if len(time) < 2:
        return np.timedelta64(0, "ns")
    steps = np.diff(time).astype("timedelta64[ns]", copy=False).view(np.int64)
    middle = len(steps) // 2
    steps.partition(middle)  # in place, since a record may be long
    return np.timedelta64(int(steps[middle]), "ns")


def annual_maxima(
    time: Times, values: Column, step: np.timedelta64
) -> tuple[NDArray[np.float64], int]:
    """Return the maximum of every complete year, and the number of complete and incomplete years.

    Years of 365.25 days are counted from the first profile. In a complete year, at least the
    fraction `WHOLE` of the time steps has a value.
    """
    years = int((time[-1] - time[0]) // YEAR) + 1
    starts = np.searchsorted(time, time[0] + np.arange(years + 1) * YEAR)
    parts = [values[start:stop] for start, stop in pairwise(starts.tolist())]
    room = WHOLE * float(YEAR / step)
    whole = [part for part in parts if np.count_nonzero(np.isfinite(part)) >= room]
    return np.array([np.nanmax(part) for part in whole], np.float64), years


def peaks_over(
    time: Times, values: Column, threshold: float, step: np.timedelta64
) -> NDArray[np.float64]:
    """Find the maximum of each cluster of values above a threshold.

    With N exceedances and the extremal index θ, the θN - 1 longest intervals between exceedances
    separate the clusters (Ferro and Segers 2003, eq. 6 and section 3). Exceedances in successive
    time steps are never separated. Gaps in the record count as parts of the intervals.
    """
    over = np.flatnonzero(values > threshold)
    if len(over) < 2:
        return np.asarray(values[over], np.float64)
    intervals = np.maximum(np.rint(np.diff(time[over]) / step), 1.0)
    clusters = ceil(extremal_index(intervals) * len(over))
    longest = np.sort(intervals)[::-1]
    apart = longest[clusters - 1] if clusters <= len(longest) else 1.0
    starts = np.concatenate([[0], 1 + np.flatnonzero(intervals > apart)])
    return np.maximum.reduceat(np.asarray(values[over], np.float64), starts)


def extremal_index(intervals: NDArray[np.float64]) -> float:
    """Estimate the extremal index θ, the reciprocal of the mean cluster size of exceedances.

    The intervals T (N - 1,) are in time steps and at least 1. If all T ≤ 2, θ = 2 (ΣT)²/((N-1)
    ΣT²), else θ = 2 (Σ(T-1))²/((N-1) Σ(T-1)(T-2)); θ ≤ 1 (Ferro and Segers 2003).
    """
    one, two = (1.0, 2.0) if intervals.max() > 2.0 else (0.0, 0.0)
    below = float(((intervals - one) * (intervals - two)).sum())
    estimate = 2.0 * float((intervals - one).sum()) ** 2 / (len(intervals) * below)
    return min(estimate, 1.0)
