"""Measurements on common times: currents at levels or on the line, and depths of sensors.

Sensor readings are interpolated to the times of the currents over short gaps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.batch.statuses import implausible
from calm.errors import UsageError, unknown
from calm.motion.common_unknowns import NOISE, NORMAL, RESIDUAL_TIDE, TIDE
from calm.physics.line import Floats, Integers
from calm.records.card import ReadCard
from calm.records.current_file import open_record
from calm.records.current_terms import Terms
from calm.records.instrument_series import InstrumentSeries, split_label
from calm.records.record import RULES
from calm.records.velocity import MISSING

MOST_TIMES = 500  # maximum number of times for the common unknowns, spread evenly over the record

Times = NDArray[np.datetime64]

FREE = -1  # index, instead of a point, for a level that is not on the line


@dataclass(frozen=True)
class MooringMeasurements:
    """Currents and depths at n times, from s sensors and k levels."""

    time: NDArray[np.datetime64]  # (n,) increasing times, to the nanosecond
    label: tuple[str, ...]  # (s,) labels of the sensors
    point: Integers  # (s,) points of the sensors, as defined in `calm.motion.line_response.Forward`
    # (n, s) depths of the sensors from their pressures [m]; NaN if missing or rejected
    depth: Floats
    level_depth: Floats  # (n, k) depths of the levels [m]; NaN for levels on the line
    level_point: Integers  # (k,) points of the levels on the line; `FREE` for fixed levels
    u: Floats  # (n, k) eastward current [m/s]; NaN if missing
    v: Floats  # (n, k) northward current [m/s]; NaN if missing
    flag: NDArray[np.int8]  # (n, k) quality flags of the current; 0 if the file has no flags
    # (n,) height of the sea surface above mean sea level [m]; None if unknown
    tide: Floats | None = None
    # (n,) whether an impossible current was removed; None if none was removed
    false: NDArray[np.bool_] | None = None
    # (n,) increase in depth of the whole mooring since the start [m]; None if it never moved
    sunk: Floats | None = None

    @property
    def surface(self) -> Floats:
        """Change (n,) common to all depths, from tide and sinking of the whole mooring [m]."""
        none = np.zeros(len(self.time))
        return none + (0.0 if self.tide is None else self.tide) + self.moved

    @property
    def moved(self) -> Floats:
        """Increase (n,) in the depth of the whole mooring since the first time [m]."""
        return np.zeros(len(self.time)) if self.sunk is None else self.sunk

    @property
    def tide_deviation(self) -> float:
        """Prior standard deviation of the unmeasured part of tide and air pressure [m]."""
        return TIDE if self.tide is None else RESIDUAL_TIDE

    def elapsed(self, time: Times) -> Floats:
        """Return the share of the record, 0 to 1, that has elapsed at each of the times (m,)."""
        first, last = self.time[[0, -1]]
        share: Floats = (time - first) / max(last - first, np.timedelta64(1, "ns"))
        return share

    def at(self, times: slice | Integers) -> MooringMeasurements:
        """Return the measurements at selected times."""
        columns = ("time", "depth", "level_depth", "u", "v", "flag", "tide", "false", "sunk")
        known = {name: getattr(self, name) for name in columns}
        return replace(self, **{name: one[times] for name, one in known.items() if one is not None})


def chosen_times(measured: MooringMeasurements, alone: bool = False) -> Integers:
    """Choose up to `MOST_TIMES` times with a pressure and, unless `alone`, a current."""
    currents = (np.isfinite(measured.u) & np.isfinite(measured.v)) | alone
    used = np.flatnonzero(np.isfinite(measured.depth).any(axis=1) & currents.any(axis=1))
    if len(used) <= MOST_TIMES:
        return used
    return used[np.linspace(0, len(used) - 1, MOST_TIMES).round().astype(np.int64)]


def level_names(measured: MooringMeasurements, labels: Sequence[str]) -> tuple[str, ...]:
    """Return the name of each current level: the label of a part of the line, or a depth."""
    names = []
    for k, point in enumerate(measured.level_point.tolist()):
        depth = measured.level_depth[:, k]
        at = f"{np.nanmean(depth):.1f} m" if np.isfinite(depth).any() else f"level {k + 1}"
        names.append(at if point == FREE else labels[point])
    return tuple(names)


def nearest(time: Times, wanted: Times) -> Integers:
    """Return the index (n,) of the time nearest to each wanted time; the earlier one in a tie."""
    after = np.clip(np.searchsorted(time, wanted), 0, len(time) - 1)
    before = np.maximum(after - 1, 0)
    earlier = np.abs(wanted - time[before]) <= np.abs(time[after] - wanted)
    return np.where(earlier, before, after)


def common_times(
    currents: Sequence[CurrentMeasurements], sensors: Sequence[InstrumentSeries]
) -> Times:
    """Choose the common times of all measurements.

    The first record gives all its times; records of currents come before records of sensors. Each
    further record adds its times that are more than half a time step from all times chosen before.
    If such times are closer together than a quarter of the step, only the first of them is added.
    """
    everything: list[CurrentMeasurements | InstrumentSeries] = [*currents, *sensors]
    times = everything[0].time
    for other in everything[1:]:
        step = np.median(np.diff(times)) if len(times) > 1 else np.timedelta64(1, "h")
        apart = np.abs(times[nearest(times, other.time)] - other.time)
        times = np.unique(np.concatenate([times, _sparse(other.time[apart > step / 2], step / 4)]))
    return times


def _sparse(times: Times, step: np.timedelta64) -> Times:
    taken: list[np.datetime64] = []
    at = 0
    while at < len(times):
        taken.append(times[at])
        at = int(np.searchsorted(times, times[at] + step, "right"))
    return np.array(taken, "M8[ns]")


def interpolated(time: Times, value: Floats, wanted: Times, gap: np.timedelta64) -> Floats:
    """Interpolate (m,) values linearly to other times (n,).

    The result is NaN if the known values on either side are further apart than `gap`.
    """
    known = np.isfinite(value)
    if not known.any():
        return np.full(len(wanted), np.nan)
    x = time[known].astype("M8[ns]").astype(np.int64)
    y, at = value[known], wanted.astype("M8[ns]").astype(np.int64)
    result = np.interp(at, x, y)
    after = np.searchsorted(x, at)
    inside = (after < len(x)) & (after > 0)
    upper, lower = np.clip(after, 0, len(x) - 1), np.clip(after - 1, 0, len(x) - 1)
    near = inside & (x[upper] - x[lower] <= gap.astype("m8[ns]").astype(np.int64))
    near |= x[upper] == at
    return np.where(near, result, np.nan)


def _measured_at(one: InstrumentSeries, wanted: Times, gap: np.timedelta64) -> Floats:
    """Interpolate depths to the times `wanted`; a missing reading at such a time stays missing."""
    at = np.minimum(np.searchsorted(one.time, wanted), len(one.time) - 1)
    between = interpolated(one.time, one.value, wanted, gap)
    return np.where(one.time[at] == wanted, one.value[at], between)


FAR_NEIGHBOURS = 4.0  # maximum interval between the readings before and after a time, in time steps
SPIKE, ALIKE = 6.0, 3.0  # least deviation of a spike, and limit for others, in usual deviations


def without_spikes(
    measured: MooringMeasurements, hidden: Sequence[str] = ()
) -> tuple[MooringMeasurements, list[str]]:
    """Remove readings far from the readings before and after, if other sensors show no change.

    The sensors `hidden` are neither tested nor used to test others. Also return notes on the
    removal.
    """
    hours = (measured.time - measured.time[:1]) / np.timedelta64(1, "h")
    step = float(np.median(np.diff(hours))) if len(hours) > 1 else 0.0
    off = np.full(measured.depth.shape, np.nan)
    for j, label in enumerate(measured.label):
        known, y = np.flatnonzero(np.isfinite(measured.depth[:, j])), measured.depth[:, j]
        if len(known) < 3 or label in hidden:
            continue
        at, before, after = known[1:-1], known[:-2], known[2:]
        apart, change = hours[after] - hours[before], y[after] - y[before]
        away = np.abs(y[at] - y[before] - change * (hours[at] - hours[before]) / apart)
        usual = max(NORMAL * float(np.median(away)), NOISE)
        near = apart <= FAR_NEIGHBOURS * step
        off[at[near], j] = (away / np.hypot(usual, 0.25 * change))[near]
    others = np.isfinite(off).sum(axis=1, keepdims=True) - np.isfinite(off)
    calm = (off < ALIKE).sum(axis=1, keepdims=True) - (off < ALIKE)
    wrong = (off > SPIKE) & (others > 0) & (calm == others)
    kept, excluded = exclude_readings(measured, wrong)
    return kept, [
        f"{label}: {count} of its readings were excluded as spikes, because other sensors show no "
        f"change at these times; the first is {depth:.1f} m, at {time}"
        for label, count, depth, time in excluded
    ]


def exclude_readings(
    measured: MooringMeasurements, wrong: NDArray[np.bool_]
) -> tuple[MooringMeasurements, list[tuple[str, int, float, str]]]:
    """Remove the readings that are true in the mask `wrong` (n, s).

    Also return a row for each affected sensor: label, number of removed readings, and depth [m] and
    time of the first.
    """
    first = [(j, at) for j, at in enumerate(wrong.argmax(axis=0).tolist()) if wrong[at, j]]
    counts, time = wrong.sum(axis=0).tolist(), np.datetime_as_string(measured.time, "s")
    excluded = [
        (measured.label[j], counts[j], float(measured.depth[at, j]), str(time[at]))
        for j, at in first
    ]
    return replace(measured, depth=np.where(wrong, np.nan, measured.depth)), excluded


def joined(
    currents: Sequence[CurrentMeasurements],
    sensors: Sequence[InstrumentSeries],
    points: Sequence[int],
    labels: Sequence[str],
    still: Floats,
    gap: np.timedelta64,
    sea_level: tuple[Times, Floats] | None = None,
) -> MooringMeasurements:
    """Combine all measurements on common times, with levels and sensors from the top down.

    `points` are the points of the sensors; `labels` and `still` are labels and depths in still
    water [m] of all points. Values are interpolated over gaps of at most `gap`. `sea_level` has
    times, and heights above any datum [m]. Raise UsageError if a label is not on the line, or if
    the records do not overlap.
    """
    time = common_times(currents, sensors)
    order = np.argsort([still[point] for point in points], kind="stable")
    sensors, point = [sensors[i] for i in order], np.array([points[i] for i in order], np.int64)
    depth = np.stack([_measured_at(one, time, gap) for one in sensors], axis=1)
    columns: list[tuple[float, int, Floats, Floats, Floats, NDArray[np.int8]]] = []
    for one in currents:
        for k, label in enumerate(one.label):
            where = FREE
            if label:
                if label not in labels:
                    what = f"{one.source}: no part of the line is called `{label}`"
                    raise UsageError(unknown(what, label, labels))
                where = list(labels).index(label)
            at, u, v = (
                interpolated(one.time, each[:, k], time, gap) for each in (one.depth, one.u, one.v)
            )
            places = [float(still[where])] if label else at[np.isfinite(at)].tolist()
            place = float(np.mean(places)) if places else float("inf")
            columns.append((place, where, at, u, v, _worse_flags(one, k, time)))
    columns.sort(key=lambda column: column[0])
    none = np.zeros((len(time), 0))
    level, u, v, flag = (
        np.stack([column[i] for column in columns], axis=1) if columns else none
        for i in (2, 3, 4, 5)
    )
    tide = None
    if sea_level is not None:
        tide = interpolated(*sea_level, time, gap)
        if not np.isfinite(tide).any():
            raise UsageError("--sea-level: the file covers none of the times of the estimate")
        tide = np.nan_to_num(tide - np.nanmean(tide))
    when = [one.time[one.false] for one in currents if one.false is not None]
    false = np.isin(time, np.concatenate(when)) if when else None
    level_point = np.array([column[1] for column in columns], np.int64)
    measured = MooringMeasurements(
        time, tuple(labels[at] for at in point.tolist()), point, depth, level, level_point, u, v,
        flag.astype(np.int8), tide, false,
    )  # fmt: skip
    both = (np.isfinite(u) & np.isfinite(v)).any(axis=1) & np.isfinite(depth).any(axis=1)
    if currents and not both.any():
        raise UsageError(
            "no time has both a current and a pressure: either the currents have no values, or the "
            "records do not overlap, or their samples are further apart than --gap"
        )
    return measured


def _worse_flags(one: CurrentMeasurements, k: int, time: Times) -> NDArray[np.int8]:
    """Return the worse flag of the two nearest readings at level k; 9 outside the record."""
    after = np.searchsorted(one.time, time)
    upper, lower = np.minimum(after, len(one.time) - 1), np.maximum(after - 1, 0)
    exact = one.time[upper] == time
    flags = np.maximum(one.flag[upper, k], one.flag[np.where(exact, upper, lower), k])
    outside = (after == len(one.time)) | ((after == 0) & ~exact)
    return np.where(outside, MISSING, flags).astype(np.int8)


@dataclass(frozen=True)
class CurrentMeasurements:
    """Currents of one file, at n times and k levels."""

    time: NDArray[np.datetime64]  # (n,) increasing times, to the nanosecond
    depth: Floats  # (n, k) depths of the levels [m]; NaN for levels on the line
    # (k,) label of the part of the line at each level; empty for levels at fixed depths
    label: tuple[str, ...]
    u: Floats  # (n, k) eastward current [m/s]
    v: Floats  # (n, k) northward current [m/s]
    flag: NDArray[np.int8]  # (n, k) quality flags; 0 if the file has no flags
    source: str  # name of the file
    notes: tuple[str, ...] = ()
    # (n,) whether an impossible current was removed; None if none was removed
    false: NDArray[np.bool_] | None = None
    cards: tuple[ReadCard, ...] = ()


def read_currents(
    given: Sequence[str | Path],
    seabed: float,
    place: tuple[float, float] | None,
    declination: float | None,
    maximum_speed: float,
) -> list[CurrentMeasurements]:
    """Read the currents of several files, given as paths, or ``LABEL=PATH`` for a single level.

    Parameters
    ----------
    seabed : depth of the water [m]
    place : latitude and longitude of the mooring [degrees]
    declination : magnetic declination, positive to the east [degrees]
    maximum_speed : speed above which currents are removed, with a note [m/s]
    """
    found, terms = [], Terms(seabed, place, declination, on_the_line=True)
    for text in given:
        label, path = split_label(str(text))
        with open_record(path, terms) as record:
            depth, u, v, _ = record.profiles(0, record.count)
            marks = record.flags(0, record.count)
            marks = np.zeros(u.shape, np.int8) if marks is None else marks
            notes = tuple(note for note in record.notes if note not in RULES)
            depth, labels = np.broadcast_to(depth, u.shape).copy(), record.labels
            labels = labels or ("",) * u.shape[1]
            mine = CurrentMeasurements(
                np.asarray(record.time), depth, labels, u, v, marks, path.name, notes,
                cards=record.cards,
            )  # fmt: skip
        if label:
            if len(mine.label) > 1:
                raise UsageError(
                    f"{path} has {len(mine.label)} levels; `{label}=` needs a file with one level"
                )
            mine = replace(mine, label=(label,), depth=np.full_like(mine.depth, np.nan))
        found.append(_plausible(mine, maximum_speed))
    return found


def _plausible(one: CurrentMeasurements, maximum_speed: float) -> CurrentMeasurements:
    depth = np.where([bool(label) for label in one.label], 0.0, one.depth)
    false = implausible(depth, one.u, one.v, None, maximum_speed)
    if not false.any():
        return one
    at, level = (int(index[0]) for index in np.nonzero(false))
    where = one.label[level] or f"{one.depth[at, level]:g} m"
    note = (
        f"{false.sum()} of {np.isfinite(one.u).sum()} currents were excluded as implausible; the "
        f"first is {np.hypot(one.u[at, level], one.v[at, level]):.5g} m/s at {where}, "
        f"{np.datetime_as_string(one.time[at], unit='m')}, and `maximum_speed` is "
        f"{maximum_speed:g} m/s"
    )
    u, v = (np.where(false, np.nan, each) for each in (one.u, one.v))
    return replace(
        one, u=u, v=v, notes=(*one.notes, note), false=np.logical_or.reduce(false, axis=1)
    )
