"""The maxima of years and the independent peaks of a record, to which tails are fitted.

Ferro, C. A. T., and Segers, J. (2003): Inference for clusters of extreme values, J. R. Statist.
Soc. B 65, 545-556, doi:10.1111/1467-9868.00401.
"""

from __future__ import annotations

from itertools import pairwise
from math import ceil

import numpy as np
from numpy.typing import NDArray

from calm.batch.statistics.series import Column, Times

WHOLE = 0.9
"""Share of its profiles that a whole year has at least. Our choice, because five weeks that are
missing seldom hide the maximum of a year; a season often does."""

YEAR = np.timedelta64(31_557_600, "s")
"""365.25 days."""


def years_of(step: np.timedelta64, count: int) -> float:
    """Years that some profiles of a record stand for, each as long as the median step."""
    return count * float(step / YEAR)


def median_step(time: Times) -> np.timedelta64:
    """Median time between profiles, which gaps do not lengthen; nothing of a single profile."""
    if len(time) < 2:
        return np.timedelta64(0, "ns")
    steps = np.diff(time).astype("timedelta64[ns]", copy=False).view(np.int64)
    middle = len(steps) // 2
    steps.partition(middle)  # in its place: a record may be long
    return np.timedelta64(int(steps[middle]), "ns")


def annual_maxima(
    time: Times, values: Column, step: np.timedelta64
) -> tuple[NDArray[np.float64], int]:
    """The greatest value of every whole year, and how many years there are, whole or not.

    The years are of 365.25 days from the first profile on; one is whole if it has `WHOLE` of the
    values that it has room for. The maximum of a whole year with gaps is that of the rest.
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
    """The greatest value of every cluster of exceedances of a threshold.

    The extremal index θ comes from the intervals T between the N exceedances, in steps: with
    every T ≤ 2, θ = 2 (ΣT)²/((N-1) ΣT²), else θ = 2 (Σ(T-1))²/((N-1) Σ(T-1)(T-2)), 1 at most. The
    θN - 1 longest intervals part the clusters (Ferro and Segers 2003, eq. 6 and section 3), but
    never exceedances that follow one another, since in a record of a single storm all intervals
    are alike. An interval across a gap counts in full, as if nothing had been exceeded in it.
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
    """θ, the share of exceedances that are independent of those before them.

    Parameters
    ----------
    intervals : (N - 1,) between exceedances [steps], each 1 or more; the form of the estimate
        changes where one of them is beyond 2
    """
    one, two = (1.0, 2.0) if intervals.max() > 2.0 else (0.0, 0.0)
    below = float(((intervals - one) * (intervals - two)).sum())
    estimate = 2.0 * float((intervals - one).sum()) ** 2 / (len(intervals) * below)
    return min(estimate, 1.0)
