"""Measured and estimated depths of the sensors over time, as they are drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.motion.measured import Measured
from calm.physics.line import Floats

if TYPE_CHECKING:
    from xarray import Dataset


@dataclass(frozen=True)
class Series:
    """Of one sensor.

    Attributes
    ----------
    hidden : whether it was hidden from the estimate
    time, measured, estimated, spread : (n,) depths and standard deviation [m]
    plain : (n,) by the currents alone; None of a hidden sensor
    """

    label: str
    hidden: bool
    time: NDArray[np.datetime64]
    measured: Floats
    estimated: Floats
    spread: Floats
    plain: Floats | None


def depths_at(result: Dataset, point: int) -> tuple[Floats, Floats]:
    """(n,) depths of a point in a result, and their standard deviations [m]."""
    clamps = result.sizes.get("clamp", 0)
    names = ("clamp_depth", "clamp_depth_sd") if point < clamps else ("depth_top", "depth_sd")
    column = point if point < clamps else point - clamps
    depth, spread = (np.asarray(result[name][:, column].values, np.float64) for name in names)
    return depth, spread


def series_of(measured: Measured, used: tuple[str, ...], result: Dataset) -> list[Series]:
    """Of all sensors from the top down.

    Parameters
    ----------
    measured : with the sensors that were hidden
    used : labels of those that were not
    result : of `calm.motion.run.run_motion`
    """
    found = []
    for j, label in enumerate(measured.label):
        depth, spread = depths_at(result, int(measured.point[j]))
        hidden = label not in used
        plain = None
        if not hidden:
            plain = np.asarray(result["plain_depth"][:, used.index(label)].values, np.float64)
        found.append(
            Series(label, hidden, measured.time, measured.depth[:, j], depth, spread, plain)
        )
    return found
