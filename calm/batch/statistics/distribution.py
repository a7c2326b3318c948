"""How a quantity is distributed over the profiles of a batch, and how it goes with time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calm.batch.statistics.series import Column, Times

Floats = NDArray[np.float64]

PERCENTILES = (50.0, 90.0, 99.0, 99.9)

SHARES = np.geomspace(1.0, 1e-7, 57)
"""Shares of the profiles for which an exceedance curve shows the value; eight to a decade."""

MOST_INTERVALS = 1000
"""Intervals of time into which a series is gathered to be drawn."""


@dataclass(frozen=True)
class Distribution:
    """How a quantity is distributed over the n profiles in which it is known.

    Attributes
    ----------
    count : n
    mean : each profile counts alike
    percentiles : of `PERCENTILES`: linear between the order statistics, of which that of rank
        1 + (n - 1) p is the p quantile (definition 7 of Hyndman and Fan 1996)
    maximum, time : the greatest value, and when it is first reached
    share, value : exceedance curve: the value that a share of the profiles reaches or exceeds,
        the quantile 1 - share, for `SHARES` down to a single profile
    """

    count: int
    mean: float
    percentiles: tuple[float, ...]
    maximum: float
    time: np.datetime64
    share: Floats
    value: Floats


def distribution_of(values: Column, time: Times) -> Distribution | None:
    """The distribution of (n,) values; NaN is left out, None returned where nothing else is."""
    known = values[np.isfinite(values)]
    known.sort()
    count = len(known)
    if not count:
        return None
    greatest = int(np.argmax(values == known[-1]))  # the first of its like
    share = np.append(SHARES[SHARES * count > 1.0], 1.0 / count)
    rank = (count - 1) * np.concatenate([np.array(PERCENTILES) / 100.0, 1.0 - share])
    rank[-1] = count - 1  # the rarest value is the maximum
    below = np.floor(rank).astype(np.int64)
    above = np.minimum(below + 1, count - 1)
    low, high = known[below].astype(np.float64), known[above].astype(np.float64)
    quantiles = low + (rank - below) * (high - low)
    return Distribution(
        count=count,
        mean=float(known.mean(dtype=np.float64)),
        percentiles=tuple(quantiles[: len(PERCENTILES)].tolist()),
        maximum=float(known[-1]),
        time=time[greatest],
        share=share,
        value=quantiles[len(PERCENTILES) :],
    )


def envelope_of(values: Column, time: Times) -> tuple[Times, Column, Column]:
    """When each of `MOST_INTERVALS` intervals begins, and its least and greatest value.

    The intervals hold the same number of profiles; of a shorter record each profile is one.
    """
    count = min(len(values), MOST_INTERVALS)
    begin = np.unique(np.linspace(0, len(values), count, endpoint=False).astype(np.int64))
    return time[begin], np.fmin.reduceat(values, begin), np.fmax.reduceat(values, begin)
