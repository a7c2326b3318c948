"""Currents of an imported design over time, as a record for `calm batch`."""

from __future__ import annotations

import numpy as np

from calm.exchange.design import CurrentRecord


def record_file(record: CurrentRecord, source: str) -> bytes:
    """A record as a classic NetCDF file by the CF conventions."""
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
    seconds = np.rint(record.days * 86_400e3) / 1e3  # days hold a millisecond, hardly more
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
