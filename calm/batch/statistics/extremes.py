"""Return levels: the value that a response exceeds once in so many years on average.

Two ways to estimate them, each with its own rules, which are reported with the levels:

- GEV: the generalised extreme value distribution of the maxima of years (Coles 2001, chapter 3).
- POT: the generalised Pareto distribution of independent peaks over a threshold (chapter 4).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import log, log1p

import numpy as np
from numpy.typing import NDArray

from calm.batch.statistics.samples import (
    WHOLE,
    annual_maxima,
    median_step,
    peaks_over,
    years_of,
)
from calm.batch.statistics.series import Column, Times
from calm.batch.statistics.tails import (
    CONFIDENCE,
    LEAST_SHAPE,
    NotFitted,
    Tail,
    fit_excesses,
    fit_maxima,
)
from calm.batch.statuses import IN_WEAK_CURRENT, Ending, ending_of

PERIODS = (2, 10, 50, 100)
"""Return periods [years]."""

EXTRAPOLATION = 4.0
"""Times the length of a record beyond which no return level is reported. Our choice: thirty
years give the level of a hundred, and a year none beyond two."""

LEAST_MAXIMA = 10
"""Whole years that a GEV asks for. Our choice, because three parameters are fitted: ten
values are few for that, as their wide intervals show."""

LEAST_YEARS = 1.0
"""Years of solved profiles that POT asks for. Our choice, because the year has a stormy season."""

LEAST_PEAKS = 30
"""Independent peaks that POT asks for. Our choice, because the intervals are those of many
peaks, and with fewer they hold the true level less often than they say."""

THRESHOLDS = (99.0, 98.0, 97.0, 96.0, 95.0, 94.0, 93.0, 92.0, 91.0, 90.0)
"""Percentiles tried as the threshold of POT, the first that leaves enough peaks taken. Our choice,
because a generalised Pareto distribution holds for high thresholds only (Coles 2001, §4.3.1)."""

_FEW_GAPS = 1e-3  # our choice: a share of the record, nine hours a year, that is not worth a word

METHODS = {"gev": "GEV of annual maxima", "pot": "POT, generalised Pareto"}
"""The two ways, by their name in files."""


@dataclass(frozen=True)
class Level:
    """A return level and its interval of `CONFIDENCE`, in the unit of the values.

    Attributes
    ----------
    period : T [years]; by GEV one year in T has a maximum above the level, by POT there is a peak
        above it once in T years on average
    level : the estimate
    low, high : ends of its interval; None for one that the data do not set
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
    location, scale, shape : μ, σ, ξ; the location of POT is its threshold
    count : maxima or peaks that were fitted
    rate : maxima or peaks a year
    rules : how the maxima or peaks were chosen, in words
    levels : for those of `PERIODS` that the record is long enough for
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
class Refusal:
    """Why there are no return levels by one of the `METHODS`."""

    method: str
    reason: str


def return_levels(
    time: Times,
    values: Column,
    statuses: Mapping[str, int],
    step: np.timedelta64 | None = None,
) -> tuple[Fit | Refusal, Fit | Refusal]:
    """Return levels by GEV and by POT, each with 95 % intervals or refused with a reason.

    They are refused, too, where profiles with a current were not solved: the line most often
    fails to stand in the strongest currents, and levels from what is left would be too low.

    Parameters
    ----------
    time : (n,) ascending, as evenly as a record with gaps is
    values : (n,) NaN where there is none
    statuses : profiles by their status, as `calm.batch.result.statuses_of` counts them; of those
        that were not solved, only `calm.batch.statuses.IN_WEAK_CURRENT` and profiles without data
        are passed over
    step : `median_step` of the times, where it is known already
    """
    refusal = _censored(statuses) or _unfit(time, values)
    if refusal:
        return Refusal("gev", refusal), Refusal("pot", refusal)
    step = median_step(time) if step is None else step
    years = years_of(step, int(np.count_nonzero(np.isfinite(values))))
    fits: list[Fit | Refusal] = []
    for method, fit in (("gev", _by_maxima), ("pot", _by_peaks)):
        try:
            fits.append(fit(time, values, step, years))
        except NotFitted as reason:
            fits.append(Refusal(method, str(reason)))
    return fits[0], fits[1]


def _censored(statuses: Mapping[str, int]) -> str:
    """Why the extremes may be among the profiles that were not solved, or nothing."""
    ended = {ending: 0 for ending in (Ending.NO_EQUILIBRIUM, Ending.NOT_CONVERGED)}
    for status, count in statuses.items():
        if ending_of(status) in ended and status not in IN_WEAK_CURRENT:
            ended[ending_of(status)] += count
    said = " and ".join(f"{count} {ending.value}" for ending, count in ended.items() if count)
    return said and (
        f"of the profiles with a current {said}: the greatest values may be among them, and "
        "levels from the others would be too low"
    )


def _unfit(time: Times, values: Column) -> str:
    """Why nothing can be fitted, or nothing."""
    count = int(np.count_nonzero(np.isfinite(values)))
    if count < 2:
        return f"there are {count} values"
    if not bool((time[1:] > time[:-1]).all()):
        return "the times do not increase"
    if np.fmax.reduce(values) == np.fmin.reduce(values):
        return "the values are all alike"
    return ""


def _by_maxima(time: Times, values: Column, step: np.timedelta64, years: float) -> Fit | Refusal:
    maxima, count = annual_maxima(time, values, step)
    if len(maxima) < LEAST_MAXIMA:
        return Refusal(
            "gev",
            f"annual maxima of {LEAST_MAXIMA} whole years are needed; of the {count} year"
            f"{'s' if count != 1 else ''} begun, {len(maxima)} "
            f"{'has' if len(maxima) == 1 else 'have'} {100 * WHOLE:.0f} % of the profiles",
        )
    if maxima.max() == maxima.min():
        return Refusal("gev", f"the {len(maxima)} annual maxima are all alike")
    tail = fit_maxima(maxima)
    rules = (
        f"maxima of {len(maxima)} years of 365.25 days, counted from the first profile, that have "
        f"{100 * WHOLE:.0f} % of their profiles{_gaps(time, values, step)}"
    )
    growths = {period: -log(-log1p(-1.0 / period)) for period in _periods(years)}
    return _told("gev", tail, 1.0, rules, growths)


def _by_peaks(time: Times, values: Column, step: np.timedelta64, years: float) -> Fit | Refusal:
    if years < LEAST_YEARS:
        return Refusal(
            "pot",
            f"a year of solved profiles is needed; there are {365.25 * years:.0f} days of them",
        )
    thresholds = np.percentile(values[np.isfinite(values)], THRESHOLDS, overwrite_input=True)
    most = 0
    for percentile, threshold in zip(THRESHOLDS, thresholds.tolist(), strict=True):
        peaks = peaks_over(time, values, threshold, step)
        most = max(most, len(peaks))
        if len(peaks) >= LEAST_PEAKS:
            return _over(percentile, threshold, peaks, years, _gaps(time, values, step))
    return Refusal(
        "pot",
        f"{LEAST_PEAKS} independent peaks are needed; no threshold from the {THRESHOLDS[0]:.0f} % "
        f"to the {THRESHOLDS[-1]:.0f} % percentile leaves more than {most}",
    )


def _over(
    percentile: float, threshold: float, peaks: NDArray[np.float64], years: float, gaps: str
) -> Fit | Refusal:
    if peaks.max() == peaks.min():
        return Refusal("pot", f"the {len(peaks)} peaks are all alike")
    tail, rate = fit_excesses(peaks, threshold), len(peaks) / years
    rules = (
        f"{len(peaks)} peaks over the {percentile:.0f} % percentile, the highest from "
        f"{THRESHOLDS[0]:.0f} % to {THRESHOLDS[-1]:.0f} % that leaves {LEAST_PEAKS} clusters; "
        f"clusters by the intervals between exceedances (Ferro and Segers 2003){gaps}"
    )
    growths = {period: log(rate * period) for period in _periods(years) if rate * period > 1.0}
    return _told("pot", tail, rate, rules, growths)


def _gaps(time: Times, values: Column, step: np.timedelta64) -> str:
    """What is reported of the share of a record that is missing."""
    room = 1.0 + float((time[-1] - time[0]) / step)
    missing = 1.0 - int(np.count_nonzero(np.isfinite(values))) / room
    if missing < _FEW_GAPS:
        return ""
    return (
        f"; {100 * missing:.1f} % of the time from the first profile to the last is missing, and "
        "the intervals make no allowance for what happened in it"
    )


def _periods(years: float) -> list[int]:
    return [period for period in PERIODS if period <= EXTRAPOLATION * years]


def _told(method: str, tail: Tail, rate: float, rules: str, growths: dict[int, float]) -> Fit:
    """The levels; without intervals where the theory of the likelihood does not hold."""
    nothing = (None, None)
    sure = tail.shape > LEAST_SHAPE
    rules += (
        f"; {100 * CONFIDENCE:.0f} % intervals by profile likelihood"
        if sure
        else f"; no intervals: the shape {tail.shape:.2f} is not above {LEAST_SHAPE}, where the "
        "theory of the likelihood ends"
    )
    levels = tuple(
        Level(period, tail.level(growth), *(tail.interval(growth) if sure else nothing))
        for period, growth in growths.items()
    )
    count = len(tail.values)
    return Fit(method, tail.location, tail.scale, tail.shape, count, rate, rules, levels)
