"""Series at their moving depths, brought to common times: what a field is estimated from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calm.errors import UsageError
from calm.grid.depths import MooringDepths
from calm.motion.measurements import interpolated
from calm.records.instrument_series import InstrumentSeries

Floats = NDArray[np.float64]
Times = NDArray[np.datetime64]

MOST = 5_000_000
"""Times that are written, at most: a second each for two months."""


@dataclass(frozen=True)
class Samples:
    """Values of one quantity from s instruments at n times, from the top down.

    Attributes
    ----------
    time : (n,) rising
    label : (s,) of the instruments
    depth, deviation : (n, s) where each was, and standard deviation of that [m]
    value : (n, s) in the unit of the quantity; NaN where nothing was measured
    """

    time: Times
    label: tuple[str, ...]
    depth: Floats
    deviation: Floats
    value: Floats

    def without(self, labels: Sequence[str]) -> Samples:
        """Return the samples but for some instruments."""
        kept = [j for j, label in enumerate(self.label) if label not in labels]
        return Samples(
            self.time, tuple(self.label[j] for j in kept), self.depth[:, kept],
            self.deviation[:, kept], self.value[:, kept],
        )  # fmt: skip


def common_times(
    depths: MooringDepths, series: Sequence[InstrumentSeries], step: np.timedelta64 | None
) -> Times:
    """Return the times that a field is estimated for: those of the depths, or a step apart.

    They begin and end where both depths and values are known.

    Raises
    ------
    UsageError
        Depths and values have no time in common, or the step is longer than what they have.
    """
    known = [one.time[np.isfinite(one.value)] for one in series]
    known = [one for one in known if len(one)]
    if not known:
        raise UsageError("no instrument has a good value")
    solved = depths.time[np.isfinite(depths.depth).any(axis=1)]
    first = max(solved[0], min(one[0] for one in known))
    last = min(solved[-1], max(one[-1] for one in known))
    if first > last:
        spans = ((solved[0], solved[-1]), (min(k[0] for k in known), max(k[-1] for k in known)))
        texts = [" to ".join(np.datetime_as_string(one, "m") for one in span) for span in spans]
        raise UsageError(f"no time is common: depths are of {texts[0]}, values of {texts[1]}")
    if step is None:
        inside: Times = depths.time[(depths.time >= first) & (depths.time <= last)]
        return inside
    since = np.datetime64("1970-01-01", "ns")
    wide = step.astype("m8[ns]")
    begin = since + -(-(first - since) // wide) * wide
    if (last - begin) // wide >= MOST:
        raise UsageError(f"--step: more than {MOST} times; take a longer one")
    times: Times = np.arange(begin, last + np.timedelta64(1, "ns"), wide)
    if len(times) < 2:
        raise UsageError("--step is longer than the time for which depths and values are known")
    return times


def gather(
    depths: MooringDepths,
    series: Sequence[InstrumentSeries],
    points: dict[int, int],
    time: Times,
) -> Samples:
    """Return the means of values, and of the depths at which they were taken, around each time.

    A value belongs to the nearest of the times, where that is no further than half a step.

    Parameters
    ----------
    points : of each series that is used, its point
    time : (n,) see `common_times`
    """
    still = depths.places.still
    order = sorted(points, key=lambda i: still[points[i]])
    shape = len(time), len(order)
    value, depth, deviation = (np.full(shape, np.nan) for _ in range(3))
    half = (np.median(np.diff(time)) if len(time) > 1 else np.timedelta64(1, "h")) / 2
    apart = np.diff(depths.time)
    gap = max(2 * np.median(apart), np.timedelta64(2, "h"))
    for column, i in enumerate(order):
        one, at = series[i], points[i]
        where, spread = (
            interpolated(depths.time, known[:, at], one.time, gap)
            for known in (depths.depth, depths.deviation)
        )
        after = np.clip(np.searchsorted(time, one.time), 1, max(len(time) - 1, 1))
        before = np.maximum(after - 1, 0)
        after = np.minimum(after, len(time) - 1)
        nearer = np.abs(one.time - time[before]) <= np.abs(time[after] - one.time)
        bin_of = np.where(nearer, before, after)
        good = np.isfinite(one.value) & np.isfinite(where)
        good &= np.abs(time[bin_of] - one.time) <= half
        count = np.bincount(bin_of[good], minlength=len(time)).astype(float)
        for table, known in (
            (value, one.value),
            (depth, where),
            (deviation, np.nan_to_num(spread)),
        ):
            sums = np.bincount(bin_of[good], known[good], minlength=len(time))
            with np.errstate(invalid="ignore"):
                table[:, column] = sums / count
    return Samples(time, tuple(depths.label[points[i]] for i in order), depth, deviation, value)
