"""The height of the sea surface over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem
from calm.physics.line import Floats
from calm.records.cf_files import (
    UnreadableError,
    factor_of,
    find_times,
    holdings,
    known_values,
    open_current,
    read_times,
    reading,
)
from calm.records.columns import read_time_columns
from calm.records.current_file import holds_arrays

FURTHEST = 20.0
"""A height of the sea surface is this far from the others at most [m]: no tide has half of it."""

_STANDARD = (
    "sea_surface_height_above_mean_sea_level",
    "sea_surface_height_above_geoid",
    "sea_surface_height_above_geopotential_datum",
    "tidal_sea_surface_height_above_mean_sea_level",
    "water_surface_height_above_reference_datum",
)


def read_sea_level(path: Path) -> tuple[NDArray[np.datetime64], Floats]:
    """Times, rising, and the height of the sea surface above a datum [m].

    Raises
    ------
    InputError
        The file cannot be read, or holds no height with its unit, or one that cannot be.
    """
    if not path.exists():
        raise InputError([Problem(str(path), 0, 0, "no such file")])
    if not holds_arrays(path):
        table = read_time_columns(path, ("length",), "level[m]")
        if len(table.names) != 1:
            message = "has several columns; the sea level is one: `time,level[m]`"
            raise InputError([Problem(str(path), 1, 1, message)])
        _refuse_far(path, table.time, table.values[:, 0])
        return table.time, table.values[:, 0]
    with reading(path), open_current(path) as dataset:
        for standard in _STANDARD:
            for name in map(str, dataset.cf.standard_names.get(standard, [])):
                clock = find_times(dataset, name)
                variable = dataset[name].squeeze()
                if clock is None or variable.ndim != 1:
                    continue
                times = read_times(dataset, clock)
                order = np.argsort(times, kind="stable")
                level = known_values(variable) * factor_of(variable, "length")
                _refuse_far(path, times, level)
                return times[order], level[order]
        raise UnreadableError(f"holds no height of the sea surface; it holds {holdings(dataset)}")


def _refuse_far(path: Path, time: NDArray[np.datetime64], level: Floats) -> None:
    known = level[np.isfinite(level)]
    far = np.abs(level - (np.median(known) if known.size else 0.0)) > FURTHEST
    if far.any():
        at = int(far.argmax())
        message = (
            f"is {level[at]:g} m at {np.datetime_as_string(time[at], 's')}: no height of the sea "
            f"surface is more than {FURTHEST:g} m from the others; leave empty what was not "
            "measured"
        )
        raise InputError([Problem(str(path), 0, 0, message)])
