"""Currents of a mooring: records of levels, and current meters that hang on the line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.batch.statuses import implausible
from calm.physics.line import Floats
from calm.records.current_file import open_record
from calm.records.record import RULES


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
        with open_record(
            path, seabed=seabed, at=place, declination=declination, on_the_line=True
        ) as record:
            depth, u, v, _ = record.profiles(0, record.count)
            marks = record.flags(0, record.count)
            mine = CurrentMeasurements(
                np.asarray(record.time),
                np.broadcast_to(depth, u.shape).copy(),
                record.labels or ("",) * u.shape[1],
                u,
                v,
                np.zeros(u.shape, np.int8) if marks is None else marks,
                path.name,
                tuple(note for note in record.notes if note not in RULES),
            )
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
