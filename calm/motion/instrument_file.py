"""Depths added to a copy of a user's own file of instruments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem, UsageError
from calm.motion.measurements import interpolated
from calm.motion.study import depths_at
from calm.records.cf_files import (
    UnreadableError,
    engine_of,
    groups_of,
    holdings,
    is_netcdf,
    labels_along,
    open_current,
    read_times,
    reading,
)
from calm.whole_file import beside

if TYPE_CHECKING:
    from xarray import Dataset

ADDED = ("depth", "depth_sd")
_TIMES = ("time", "TIME", "Time")


@dataclass(frozen=True)
class Instruments:
    """A file of instruments that depths are added to.

    Attributes
    ----------
    path : of it
    clock, along : its variable of times, whose dimension is `dimension`; dimension of instruments
    time : (n,)
    label : of the instruments
    """

    path: Path
    clock: str
    dimension: str
    along: str
    time: NDArray[np.datetime64]
    label: tuple[str, ...]


def read_instruments(path: Path, labels: Sequence[str], *, replace: bool) -> Instruments:
    """Return what a file holds, before anything is estimated for it.

    Parameters
    ----------
    labels : of the parts of the line
    replace : whether a `depth` that it has may be replaced

    Raises
    ------
    InputError
        It is not a NetCDF file, or has no times or no labels of instruments, or groups.
    UsageError
        It has depths already, or a dimension called so; none of its instruments is a part of the
        line.
    """
    if not path.is_file():
        raise InputError([Problem(str(path), 0, 0, "no such file")])
    if not is_netcdf(path):
        raise InputError([Problem(str(path), 0, 0, "is not a NetCDF file")])
    with reading(path), open_current(path) as dataset:
        if groups := groups_of(path):
            raise UnreadableError(
                f"has groups, which a copy would lack: {', '.join(groups)}; give the variables of "
                "its instruments as a file of their own"
            )
        counted = [name for name in ADDED if name in dataset.sizes]
        if counted:
            raise UsageError(
                f"--onto: `{counted[0]}` is a dimension of {path}; rename it: a variable of two "
                "dimensions cannot have the name of one"
            )
        there = [name for name in ADDED if name in dataset.variables]
        if there and not replace:
            raise UsageError(
                f"--onto: {path} has `{there[0]}` already; with --replace the copy has another"
            )
        clock = next((name for name in _TIMES if name in dataset.variables), None)
        if clock is None or dataset[clock].ndim != 1:
            raise UnreadableError(f"has no times; it holds {holdings(dataset)}")
        dimension = str(dataset[clock].dims[0])
        for along in map(str, dataset.sizes):
            label = None if along == dimension else labels_along(dataset, along)
            if label is not None:
                break
        else:
            raise UnreadableError(
                f"has no labels of instruments (`instrument` or `label`); it holds "
                f"{holdings(dataset)}"
            )
        time = read_times(dataset, clock)
    if not set(label) & set(labels):
        raise UsageError(f"--onto: no instrument of {path} is a part of the line: {label[0]}, …")
    return Instruments(path, clock, dimension, along, time, label)


def write_depths(
    instruments: Instruments,
    result: Dataset,
    labels: Sequence[str],
    gap: np.timedelta64,
    output: Path,
) -> list[str]:
    """Write the copy with `depth` and `depth_sd`, whole; returns the instruments without either.

    Parameters
    ----------
    instruments : the file that is copied
    result : of `calm.motion.correction.run_motion`
    labels : of the points of the result
    gap : between neighbours of a depth, at most
    output : the copy

    Raises
    ------
    OSError
        There is no room for it.
    """
    import xarray as xr

    time = result["time"].values
    shape = len(instruments.time), len(instruments.label)
    depth, spread = np.full(shape, np.nan), np.full(shape, np.nan)
    lost = []
    for j, label in enumerate(instruments.label):
        if label not in labels:
            lost.append(label)
            continue
        found = depths_at(result, list(labels).index(label))
        for array, values in zip((depth, spread), found, strict=True):
            array[:, j] = interpolated(time, values, instruments.time, gap)
    dims = (instruments.dimension, instruments.along)
    told = {"units": "m", "positive": "down", "standard_name": "depth"}
    # values as they stand, but for texts: kept as characters they would be split once more
    with xr.open_dataset(
        instruments.path,
        engine=engine_of(instruments.path),
        mask_and_scale=False,
        decode_times=False,
        decode_coords=False,
    ) as own:
        copy = own.load().drop_vars([name for name in ADDED if name in own.variables])
    told["long_name"], told["ancillary_variables"] = "depth estimated by CALM", "depth_sd"
    copy["depth"] = xr.Variable(dims, depth, told)
    copy["depth_sd"] = xr.Variable(
        dims, spread, {"units": "m", "standard_name": "depth standard_error"}
    )
    with beside(output) as part:
        copy.to_netcdf(part, engine="h5netcdf")
    return lost
