"""Time-dependent currents in a design file, and their conversion to NetCDF."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(eq=False)
class CurrentRecord:
    """Currents `u`, `v`, `w` [m/s] by time and level.

    `depth` holds the depths of the levels [m]. `days` are the times, in days after the date
    `epoch`.
    """

    days: NDArray[np.float64]
    epoch: str
    depth: NDArray[np.float64]
    u: NDArray[np.float64]
    v: NDArray[np.float64]
    w: NDArray[np.float64]


def record_file(record: CurrentRecord, source: str) -> bytes:
    """Convert a record to a classic NetCDF file with CF conventions."""
    import xarray as xr

    speeds = {
        name: (
            ("time", "depth"),
            np.ascontiguousarray(values, np.float64),
            {"standard_name": standard_name, "units": "m s-1"},
        )
        for name, standard_name, values in (
            ("u", "eastward_sea_water_velocity", record.u),
            ("v", "northward_sea_water_velocity", record.v),
            ("w", "upward_sea_water_velocity", record.w),
        )
    }
    seconds = np.rint(record.days * 86_400e3) / 1e3  # the precision of days is about a millisecond
    time = {
        "standard_name": "time",
        "units": f"seconds since {record.epoch}",
        "calendar": "standard",
    }
    depth = {"standard_name": "depth", "units": "m", "positive": "down", "axis": "Z"}
    dataset = xr.Dataset(
        speeds,
        {
            "time": ("time", seconds, {**time, "axis": "T"}),
            "depth": ("depth", np.asarray(record.depth, np.float64), depth),
        },
        {"Conventions": "CF-1.11", "title": "Currents", "source": source},
    )
    return bytes(dataset.to_netcdf(engine="scipy"))
