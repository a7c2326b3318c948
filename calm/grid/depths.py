"""Where the instruments were: a result of `calm motion`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem
from calm.motion.line_places import LinePlaces
from calm.records.cf_files import UnreadableError, is_netcdf, open_current, read_times, reading

if TYPE_CHECKING:
    from xarray import Dataset

    Floats = NDArray[np.float64]

_POINTS = (
    ("clamp", "clamp_depth", "clamp_depth_sd"),
    ("component", "depth_top", "depth_sd"),
)


@dataclass(frozen=True)
class MooringDepths:
    """Depths of p points of a line over n times.

    Attributes
    ----------
    time : (n,) to the nanosecond, rising
    label, serial : (p,) of clamps and pieces; serials are empty where not known
    clamps : how many of the points are clamps, which come first
    depth, deviation : (n, p) and standard deviation [m]
    place : latitude and longitude [degrees]; empty where not known
    seabed : depth of the last piece, the anchor [m]; NaN where not known
    attributes : of the file
    """

    path: Path
    time: NDArray[np.datetime64]
    label: tuple[str, ...]
    serial: tuple[str, ...]
    clamps: int
    depth: Floats
    deviation: Floats
    place: tuple[float, ...]
    seabed: float
    attributes: Mapping[str, Any]

    @property
    def places(self) -> LinePlaces:
        """The points with their depths in the calmest hours: a twentieth of the times is less
        deep.
        """
        known = np.where(np.isfinite(self.depth).any(axis=0), self.depth, 0.0)
        still = np.asarray(np.nanpercentile(known, 5.0, axis=0), np.float64)
        return LinePlaces(self.path.name, self.label, self.serial, self.clamps, still)


def read_depths(path: Path) -> MooringDepths:
    """Return the depths of a result of `calm motion`.

    Raises
    ------
    InputError
        It is not such a result, or has no time at which a depth is known.
    """
    if not path.exists():
        raise InputError([Problem(str(path), 0, 0, "no such file")])
    if not path.is_dir() and not is_netcdf(path):
        raise InputError([Problem(str(path), 0, 0, "is not a result of calm motion")])
    with reading(path), open_current(path) as dataset:
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
                f"has no `{spread}`: the depths of a result of calm motion are wanted, which have "
                "their uncertainty"
            )
        mine = [str(one) for one in dataset[f"{dimension}_label"].values.tolist()]
        labels += mine
        known = dataset.variables.get(f"{dimension}_serial")
        serials += [""] * len(mine) if known is None else [str(one) for one in known.values]
        depth.append(np.asarray(dataset[name].values, np.float64))
        deviation.append(np.asarray(dataset[spread].values, np.float64))
        clamps = len(mine) if dimension == "clamp" else clamps
    if not depth or "time" not in dataset.variables:
        raise UnreadableError("is not a result of calm motion: it has no depths with their labels")
    time = read_times(dataset, "time")
    whole = np.hstack(depth)
    if len(time) < 2 or not np.isfinite(whole).any():
        raise UnreadableError("has no depths: none of its times is solved")
    place = [float(dataset[a].values) for a in ("latitude", "longitude") if a in dataset.variables]
    seabed = float(np.nanmedian(whole[:, -1])) if np.isfinite(whole[:, -1]).any() else np.nan
    return MooringDepths(
        path, time, tuple(labels), tuple(serials), clamps, whole, np.hstack(deviation),
        tuple(place) if len(place) == 2 else (), seabed, dict(dataset.attrs),
    )  # fmt: skip
