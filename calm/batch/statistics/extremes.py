"""How large a response grows in ten years or a hundred: return levels, or why there are none.

Two ways, each with its own rules, which are told with the levels:

- GEV: the generalised extreme value distribution of the maxima of years (Coles 2001, chapter 3).
- POT: the generalised Pareto distribution of independent peaks over a threshold (chapter 4), the
  peaks told apart by the intervals between exceedances (Ferro, C. A. T., and Segers, J. (2003):
  Inference for clusters of extreme values, J. R. Statist. Soc. B 65, 545-556,
  doi:10.1111/1467-9868.00401).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import ceil, log, log1p

import numpy as np
from numpy.typing import NDArray

from calm.batch.statistics.series import Column, Times
from calm.batch.statistics.tails import CONFIDENCE, LEAST_SHAPE, Tail, fit_excesses, fit_maxima

PERIODS = (2, 10, 50, 100)
"""Return periods [years]."""

EXTRAPOLATION = 4.0
"""Times the length of a record beyond which no return level is told."""

LEAST_MAXIMA = 10
"""Whole years that a GEV asks for."""

WHOLE = 0.9
"""Share of its profiles that a whole year has at least."""

LEAST_YEARS = 1.0
"""Years of solved profiles that POT asks for."""

LEAST_PEAKS = 30
"""Independent peaks that POT asks for."""

THRESHOLDS = (99.0, 98.0, 97.0, 96.0, 95.0, 94.0, 93.0, 92.0, 91.0, 90.0)
"""Percentiles tried as the threshold of POT, the first that leaves enough peaks taken."""

YEAR = np.timedelta64(31_557_600, "s")
"""365.25 days."""

METHODS = {"gev": "GEV of annual maxima", "pot": "POT, generalised Pareto"}
"""The two ways, by their name in files."""


@dataclass(frozen=True)
class Level:
    """A return level, and its interval of `CONFIDENCE`; None for an end that the data do not set.

    The period [years] is that of a GEV's year with such a maximum, or of a peak.
    """

    period: int
    level: float
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Fit:
    """Return levels by one way.

    Attributes
    ----------
    method : of `METHODS`
    location, scale, shape : μ, σ, ξ; the location of POT is its threshold
    count : maxima or peaks fitted
    rate : of them in a year
    rules : what was chosen, and how
    levels : for those of `PERIODS` that the record allows
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
    """Why one way has no return levels to tell."""

    method: str
    reason: str


def return_levels(time: Times, values: Column) -> tuple[Fit | Refusal, Fit | Refusal]:
    """Return levels by GEV and by POT, each with 95 % intervals or refused with a reason.

    Parameters
    ----------
    time : (n,) ascending, as evenly as a record with gaps is
    values : (n,) NaN where there is none
    """
    refusal = _unfit(time, values)
    if refusal:
        return Refusal("gev", refusal), Refusal("pot", refusal)
    step, years = _step(time), years_of(time, int(np.isfinite(values).sum()))
    return _by_maxima(time, values, step, years), _by_peaks(time, values, step, years)


def years_of(time: Times, count: int) -> float:
    """Years that some profiles of a record stand for, each as long as the median step."""
    return count * float(_step(time) / YEAR) if len(time) > 1 else 0.0


def annual_maxima(
    time: Times, values: Column, step: np.timedelta64
) -> tuple[NDArray[np.float64], int]:
    """The greatest value of every whole year, and how many years there are, whole or not.

    The years are of 365.25 days from the first profile on; one is whole if it has `WHOLE` of the
    values that it has room for.
    """
    years = int((time[-1] - time[0]) // YEAR) + 1
    starts = np.searchsorted(time, time[0] + np.arange(years + 1) * YEAR)
    parts = [values[start:stop] for start, stop in pairwise(starts.tolist())]
    room = WHOLE * float(YEAR / step)
    whole = [part for part in parts if np.isfinite(part).sum() >= room]
    return np.array([np.nanmax(part) for part in whole], np.float64), years


def peaks_over(
    time: Times, values: Column, threshold: float, step: np.timedelta64
) -> NDArray[np.float64]:
    """The greatest value of every cluster of exceedances of a threshold.

    The extremal index θ comes from the intervals T between the N exceedances, in steps: with
    every T ≤ 2, θ = 2 (ΣT)²/((N-1) ΣT²), else θ = 2 (Σ(T-1))²/((N-1) Σ(T-1)(T-2)), 1 at most. The
    θN - 1 longest intervals part the clusters (Ferro and Segers 2003, eq. 6 and section 3), but
    never exceedances that follow one another: of a single storm these intervals cannot tell.
    """
    over = np.flatnonzero(values > threshold)
    if len(over) < 2:
        return np.asarray(values[over], np.float64)
    intervals = np.maximum(np.rint(np.diff(time[over]) / step), 1.0)
    clusters = ceil(_extremal_index(intervals) * len(over))
    longest = np.sort(intervals)[::-1]
    apart = longest[clusters - 1] if clusters <= len(longest) else 1.0
    starts = np.concatenate([[0], 1 + np.flatnonzero(intervals > apart)])
    return np.maximum.reduceat(np.asarray(values[over], np.float64), starts)


def _unfit(time: Times, values: Column) -> str:
    """Why nothing can be fitted, or nothing."""
    known = np.isfinite(values)
    if known.sum() < 2:
        return f"there are {int(known.sum())} values"
    if np.diff(time).min() <= np.timedelta64(0, "ns"):
        return "the times do not ascend"
    if np.nanmax(values) == np.nanmin(values):
        return "the values are all alike"
    return ""


def _step(time: Times) -> np.timedelta64:
    """Median time between profiles, which gaps do not lengthen."""
    steps, middle = np.diff(time).view(np.int64), (len(time) - 1) // 2
    steps.partition(middle)  # in its place: a record may be long
    return np.timedelta64(int(steps[middle]), "ns")


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
        f"{100 * WHOLE:.0f} % of their profiles"
    )
    growths = {period: -log(-log1p(-1.0 / period)) for period in _periods(years)}
    return _told("gev", tail, 1.0, rules, growths)


def _by_peaks(time: Times, values: Column, step: np.timedelta64, years: float) -> Fit | Refusal:
    if years < LEAST_YEARS:
        return Refusal(
            "pot",
            f"a year of solved profiles is needed; there are {365.25 * years:.0f} days of them",
        )
    thresholds = np.nanpercentile(values, THRESHOLDS)
    most = 0
    for percentile, threshold in zip(THRESHOLDS, thresholds.tolist(), strict=True):
        peaks = peaks_over(time, values, threshold, step)
        most = max(most, len(peaks))
        if len(peaks) >= LEAST_PEAKS:
            return _over(percentile, threshold, peaks, years)
    return Refusal(
        "pot",
        f"{LEAST_PEAKS} independent peaks are needed; no threshold from the {THRESHOLDS[0]:.0f} % "
        f"to the {THRESHOLDS[-1]:.0f} % percentile leaves more than {most}",
    )


def _over(
    percentile: float, threshold: float, peaks: NDArray[np.float64], years: float
) -> Fit | Refusal:
    if peaks.max() == peaks.min():
        return Refusal("pot", f"the {len(peaks)} peaks are all alike")
    tail, rate = fit_excesses(peaks, threshold), len(peaks) / years
    rules = (
        f"{len(peaks)} peaks over the {percentile:.0f} % percentile, the highest from "
        f"{THRESHOLDS[0]:.0f} % to {THRESHOLDS[-1]:.0f} % that leaves {LEAST_PEAKS} clusters; "
        "clusters by the intervals between exceedances (Ferro and Segers 2003)"
    )
    growths = {period: log(rate * period) for period in _periods(years) if rate * period > 1.0}
    return _told("pot", tail, rate, rules, growths)


def _extremal_index(intervals: NDArray[np.float64]) -> float:
    """θ, the share of exceedances that are independent of those before them."""
    one, two = (1.0, 2.0) if intervals.max() > 2.0 else (0.0, 0.0)
    below = float(((intervals - one) * (intervals - two)).sum())
    estimate = 2.0 * float((intervals - one).sum()) ** 2 / (len(intervals) * below)
    return min(estimate, 1.0)


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
