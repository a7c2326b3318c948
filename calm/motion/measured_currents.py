"""Currents of a mooring: records of levels, and current meters that hang on the line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.batch.statuses import implausible
from calm.errors import InputError, Problem
from calm.physics.line import Floats
from calm.records.cf_files import (
    UnreadableError,
    factor_of,
    find_times,
    flag_variable,
    flags_of,
    known_values,
    labels_along,
    open_current,
    read_times,
    reading,
)
from calm.records.current_file import holds_arrays, open_record
from calm.records.record import choose_profiles
from calm.records.velocity import find_velocity, with_components
from calm.records.water_column import is_regular

if TYPE_CHECKING:
    from xarray import Dataset


@dataclass(frozen=True)
class CurrentMeasurements:
    """Hold what one file says of the current.

    Attributes
    ----------
    time : (n,) to the nanosecond, rising
    depth : (n, k) of the levels [m]; NaN where they hang on the line
    label : (k,) of the parts they hang at; empty for levels of a depth
    u, v : (n, k) [m/s]
    flag : (n, k); 0 without
    source : its file
    notes : what to know of it
    false : (n,) whether a speed that cannot be was left out
    """

    time: NDArray[np.datetime64]
    depth: Floats
    label: tuple[str, ...]
    u: Floats
    v: Floats
    flag: NDArray[np.int8]
    source: str
    notes: tuple[str, ...] = ()
    false: NDArray[np.bool_] | None = None


def read_currents(
    paths: Sequence[Path],
    seabed: float,
    place: tuple[float, float] | None,
    declination: float | None,
    maximum_speed: float,
) -> list[CurrentMeasurements]:
    """Return the currents of some files.

    Parameters
    ----------
    seabed : depth of the water [m]
    place : latitude and longitude of the mooring [degrees], where it is known
    declination : see `calm.records.record.open_record`
    maximum_speed : what is faster is left out, and said [m/s]

    Raises
    ------
    InputError
        A file cannot be understood.
    """
    found = []
    for path in paths:
        if not path.exists():
            raise InputError([Problem(str(path), 0, 0, "no such file")])
        mine = _labelled(path, declination) if holds_arrays(path) else None
        if mine is None:
            with open_record(path, seabed=seabed, at=place, declination=declination) as record:
                depth, u, v, _ = record.profiles(0, record.count)
                depth = np.broadcast_to(depth, u.shape).copy()
                marks = record.flags(0, record.count)
                flag = np.zeros(u.shape, np.int8) if marks is None else marks
                time = np.asarray(record.time)
            mine = CurrentMeasurements(time, depth, ("",) * u.shape[1], u, v, flag, path.name)
        found.append(_plausible(mine, maximum_speed))
    return found


def _plausible(one: CurrentMeasurements, maximum_speed: float) -> CurrentMeasurements:
    """Without the levels whose current cannot be."""
    depth = np.where([bool(label) for label in one.label], 0.0, one.depth)
    false = implausible(depth, one.u, one.v, None, maximum_speed)
    if not false.any():
        return one
    at, level = (int(index[0]) for index in np.nonzero(false))
    where = one.label[level] or f"{one.depth[at, level]:g} m"
    note = (
        f"{false.sum()} currents left out as implausible (above `maximum_speed`, "
        f"{maximum_speed:g} m/s): the first at {np.datetime_as_string(one.time[at], unit='m')}, "
        f"{where}: {np.hypot(one.u[at, level], one.v[at, level]):.5g} m/s"
    )
    u, v = (np.where(false, np.nan, each) for each in (one.u, one.v))
    return replace(
        one, u=u, v=v, notes=(*one.notes, note), false=np.logical_or.reduce(false, axis=1)
    )


def _labelled(path: Path, declination: float | None) -> CurrentMeasurements | None:
    """Return the currents of a file whose levels are parts of the line; None of any other."""
    with reading(path), open_current(path) as dataset:
        dataset = with_components(dataset)
        try:
            velocity = find_velocity(dataset, regular=is_regular(dataset))
        except UnreadableError:
            return None  # the reader of records says why
        name = velocity.names[0]
        clock = find_times(dataset, name)
        if clock is None or dataset[clock].ndim != 1:
            return None
        time = str(dataset[clock].dims[0])
        along = [str(dim) for dim in dataset[name].dims if dim != time]
        labels = labels_along(dataset, along[0]) if len(along) == 1 else None
        if labels is None:
            return None
        if velocity.magnetic != (declination is not None):
            told = "are relative to magnetic north; give `--declination`"
            if not velocity.magnetic:
                told = "are not said to be relative to magnetic north; leave `--declination` out"
            raise UnreadableError(f"`{name}` and `{velocity.names[1]}` {told}")
        first = _values(dataset, velocity.names[0], time, "speed")
        second = _values(
            dataset, velocity.names[1], time, "speed" if velocity.turn is None else "angle"
        )
        if velocity.turn is not None:
            angle = np.radians(second + velocity.turn)
            first, second = first * np.sin(angle), first * np.cos(angle)
        turn = np.radians(declination or 0.0)
        u = first * np.cos(turn) + second * np.sin(turn)
        v = second * np.cos(turn) - first * np.sin(turn)
        flag = np.zeros(u.shape, np.int8)
        for each in velocity.names:
            marks = flag_variable(dataset, each)
            if marks is not None:
                own = flags_of(marks.transpose(time, ...))
                flag = np.maximum(flag, own.reshape(len(u), -1))
        times = read_times(dataset, clock)
        index, notes = choose_profiles(times, None, 1, path)
        nowhere = np.full(u.shape, np.nan)
        return CurrentMeasurements(
            times[index], nowhere, labels, u[index], v[index],
            np.broadcast_to(flag, u.shape)[index], path.name, notes,
        )  # fmt: skip


def _values(dataset: Dataset, name: str, time: str, dimension: str) -> Floats:
    variable = dataset[name].transpose(time, ...)
    return known_values(variable) * factor_of(variable, dimension)
