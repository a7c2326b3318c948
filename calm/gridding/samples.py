"""Samples of instruments at their actual depths, averaged to common times."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.batch.finished import labels_of
from calm.errors import UsageError
from calm.motion.matching import LinePlaces
from calm.motion.measurements import interpolated, nearest
from calm.records.cf_files import UnreadableError, opened, read_times
from calm.records.instrument_series import InstrumentSeries

if TYPE_CHECKING:
    from xarray import Dataset

Floats = NDArray[np.float64]
Times = NDArray[np.datetime64]
_POINTS = (("clamp", "clamp_depth", "clamp_depth_sd"), ("component", "depth_top", "depth_sd"))


@dataclass(frozen=True)
class MooringDepths:
    """Depths of p points of a line at n times."""

    time: NDArray[np.datetime64]  # (n,) increasing times, with a resolution of a nanosecond
    # the points, each with a depth in weak currents (5th percentile of its depths)
    places: LinePlaces
    depth: Floats  # (n, p) depths [m]
    deviation: Floats  # (n, p) standard deviations of the depths [m]
    place: tuple[float, ...]  # latitude and longitude of the mooring [degrees]; empty if unknown
    seabed: float  # depth of the last piece, which is the anchor [m]; NaN if unknown
    attributes: Mapping[str, Any]  # global attributes of the file


def read_depths(path: Path) -> MooringDepths:
    """Read the depths from a result file of `calm motion`."""
    with opened(path) as dataset:
        return _understood(dataset, path)


def _understood(dataset: Dataset, path: Path) -> MooringDepths:
    labels: list[str] = []
    serials: list[str] = []
    depth, deviation, clamps = [], [], 0
    for dimension, name, spread in _POINTS:
        if f"{dimension}_label" not in dataset.variables:
            continue
        if name not in dataset.variables or spread not in dataset.variables:
            raise UnreadableError(
                f"has no `{spread}`; CALM needs a result of `calm motion`, which contains the "
                "standard deviations of the depths"
            )
        mine = labels_of(dataset, f"{dimension}_label")
        labels += mine
        serials += labels_of(dataset, f"{dimension}_serial") or [""] * len(mine)
        depth.append(np.asarray(dataset[name].values, np.float64))
        deviation.append(np.asarray(dataset[spread].values, np.float64))
        clamps = len(mine) if dimension == "clamp" else clamps
    if not depth or "time" not in dataset.variables:
        raise UnreadableError("is not a result of calm motion: it has no labelled depths")
    time = read_times(dataset, "time")
    whole = np.hstack(depth)
    if len(time) < 2 or not np.isfinite(whole).any():
        raise UnreadableError("has no depths, because no time step has a solution")
    axes = [a for a in ("latitude", "longitude") if a in dataset.variables]
    position = tuple(float(dataset[axis].values) for axis in axes) if len(axes) == 2 else ()
    seabed = float(np.nanmedian(whole[:, -1])) if np.isfinite(whole[:, -1]).any() else np.nan
    known = np.where(np.isfinite(whole).any(axis=0), whole, 0.0)
    still = np.asarray(np.nanpercentile(known, 5.0, axis=0), np.float64)
    places = LinePlaces(path.name, tuple(labels), tuple(serials), clamps, still)
    return MooringDepths(
        time, places, whole, np.hstack(deviation), position, seabed, dict(dataset.attrs)
    )


ANOTHER_PLACE = 30.0  # difference of pressure [dbar] and depth [m] that suggests another instrument

MOST = 5_000_000  # maximum number of times written: one a second for two months


@dataclass(frozen=True)
class Samples:
    """Values of one quantity at n times, from s instruments listed from the top down."""

    time: Times  # (n,) increasing times
    label: tuple[str, ...]  # (s,) labels of the instruments
    depth: Floats  # (n, s) depths of the instruments [m]
    deviation: Floats  # (n, s) standard deviations of the depths [m]
    value: Floats  # (n, s) values in the unit of the quantity; NaN if not measured


def common_times(
    depths: MooringDepths, series: Sequence[InstrumentSeries], step: np.timedelta64 | None
) -> Times:
    """Choose the times of the field, in the period in which both depths and values are known.

    With a step, the times are equally spaced; otherwise, they are times of the depths.
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
        raise UsageError(
            f"depths and values have no common time: the depths cover {texts[0]}, the values "
            f"{texts[1]}"
        )
    if step is None:
        inside: Times = depths.time[(depths.time >= first) & (depths.time <= last)]
        return inside
    since = np.datetime64("1970-01-01", "ns")
    wide = step.astype("m8[ns]")
    begin = since + -(-(first - since) // wide) * wide
    if (last - begin) // wide >= MOST:
        raise UsageError(f"--step makes more than {MOST} times; set a longer step")
    times: Times = np.arange(begin, last + np.timedelta64(1, "ns"), wide)
    if len(times) < 2:
        raise UsageError("--step is longer than the period for which depths and values are known")
    return times


def gather(
    depths: MooringDepths, series: Sequence[InstrumentSeries], points: dict[int, int], time: Times
) -> Samples:
    """Average the values, and the depths at which they were measured, around each time (n,).

    Each value counts for the nearest time, within half a time step. `points` maps the index of a
    series to the index of its point on the line.
    """
    still = depths.places.still
    each = [(at, series[i].below) for i, at in points.items()]
    for at, below in each:
        if each.count((at, below)) > 1:
            who = ", ".join(series[i].source for i in points if points[i] == at)
            raise UsageError(f"two series belong to `{depths.places.label[at]}`: {who}; remove one")
    order = sorted(points, key=lambda i: still[points[i]] + series[i].below)
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
        bin_of = nearest(time, one.time)
        good = np.isfinite(one.value) & np.isfinite(where)
        good &= np.abs(time[bin_of] - one.time) <= half
        count = np.bincount(bin_of[good], minlength=len(time)).astype(float)
        for table, known in (
            (value, one.value),
            (depth, where + one.below),
            (deviation, np.nan_to_num(spread)),
        ):
            sums = np.bincount(bin_of[good], known[good], minlength=len(time))
            with np.errstate(invalid="ignore"):
                table[:, column] = sums / count
    labels = tuple(depths.places.label[points[i]] for i in order)
    return Samples(time, labels, depth, deviation, value)
