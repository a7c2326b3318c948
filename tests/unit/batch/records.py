"""Records as models and instruments write them, small."""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

SEABED = 300.0
HERE = (48.3, -5.2)
COUNT = 7


def _standard(way: str, units: str = "m s-1") -> dict[str, Any]:
    return {"standard_name": f"{way}ward_sea_water_velocity", "units": units}


def _currents(*shape: int) -> tuple[Any, Any]:
    """To the east and to the north, the same whenever they are made."""
    random = np.random.default_rng(sum(shape))
    return tuple(random.uniform(-0.8, 0.8, (2, *shape)).round(3))


def _time(unit: str, *, step: float, start: float = 0.0) -> tuple[str, Any, dict[str, str]]:
    values = start + step * np.arange(COUNT)
    return ("time", values, {"units": unit, "standard_name": "time", "calendar": "standard"})


def glorys() -> xr.Dataset:
    """A reanalysis: packed, a seabed within the levels, the column nearest to HERE on land."""
    depth = np.array([0.494, 47.4, 109.7, 222.5, 318.1], "f4")
    u, v = _currents(COUNT, 5, 3, 4)
    for values in (u, v):
        values[:, :, 1, 1] = np.nan  # land
        values[:, 3:, 1, 2] = np.nan  # seabed
        values[2, 1, 1, 2] = np.nan  # a gap
    shape = ("time", "depth", "latitude", "longitude")
    dataset = xr.Dataset(
        {"uo": (shape, u, _standard("east")), "vo": (shape, v, _standard("north"))},
        {
            "time": _time("hours since 1950-01-01", step=24.0, start=667_000.0),
            "depth": ("depth", depth, {"units": "m", "positive": "down", "axis": "Z"}),
            "latitude": ("latitude", [48.22, 48.3, 48.38], {"units": "degrees_north"}),
            "longitude": ("longitude", [-5.29, -5.2, -5.12, -5.04], {"units": "degrees_east"}),
        },
        {"Conventions": "CF-1.4"},
    )
    packing = {"dtype": "int16", "scale_factor": 0.0006103701889514923, "_FillValue": -32767}
    for name in ("uo", "vo"):
        dataset[name].encoding = {**packing, "add_offset": 0.0}
    return dataset


def hycom() -> xr.Dataset:
    """A model with longitudes from 0° to 360°, dimensions in another order, one grid line south."""
    shape = ("time", "lat", "depth", "lon")
    u, v = _currents(COUNT, 2, 4, 3)
    dataset = xr.Dataset(
        {
            "water_u": (shape, u, {"units": "m/s", "long_name": "Eastward Water Velocity"}),
            "water_v": (shape, v, {"units": "m/s", "long_name": "Northward Water Velocity"}),
            "tau": ("time", np.zeros(COUNT), {"units": "hours since analysis"}),
        },
        {
            "time": _time("hours since 2000-01-01 00:00:00", step=3.0, start=229_296.0),
            "depth": ("depth", [0.0, 50.0, 125.0, 250.0], {"units": "m", "positive": "down"}),
            "lat": ("lat", [48.24, 48.28], {"units": "degrees_north"}),
            "lon": ("lon", [354.72, 354.8, 354.88], {"units": "degrees_east"}),
        },
    )
    for name in ("water_u", "water_v"):
        dataset[name].encoding = {"dtype": "int16", "scale_factor": 0.001, "_FillValue": -30000}
    return dataset


def oceansites() -> xr.Dataset:
    """Moored current meters: quality flags, a fill value, days since 1950."""
    u, v = (values.astype("f4") for values in _currents(COUNT, 3))
    u[3, 1] = np.nan
    dataset = xr.Dataset(
        {
            "UCUR": (("TIME", "DEPTH"), u, _standard("east", "cm/s")),
            "VCUR": (("TIME", "DEPTH"), v, _standard("north", "cm/s")),
            "UCUR_QC": (("TIME", "DEPTH"), np.ones((COUNT, 3), "i1")),
        },
        {
            "TIME": (
                "TIME",
                27_818.25 + np.arange(COUNT) / 24,
                {"units": "days since 1950-01-01T00:00:00Z", "axis": "T", "standard_name": "time"},
            ),
            "DEPTH": (
                "DEPTH",
                np.array([250.0, 40.0, 120.0], "f4"),
                {"units": "meters", "positive": "down", "axis": "Z", "standard_name": "depth"},
            ),
            "LATITUDE": ("LATITUDE", [48.3], {"units": "degrees_north"}),
            "LONGITUDE": ("LONGITUDE", [-5.2], {"units": "degrees_east"}),
        },
    )
    for name in ("UCUR", "VCUR"):
        dataset[name].encoding["_FillValue"] = np.float32(99999.0)
    return dataset


def adcp() -> xr.Dataset:
    """An instrument in the line, looking up: its bins move with it, the uppermost in the air."""
    count = 5
    u, v = _currents(COUNT, count)
    depth = 60.0 + 8.0 * np.sin(np.arange(COUNT))[:, None] - 16.0 * np.arange(count)
    return xr.Dataset(
        {
            "u": (("time", "bin"), 1e3 * u, _standard("east", "mm s-1")),
            "v": (("time", "bin"), 1e3 * v, _standard("north", "mm s-1")),
            "w": (("time", "bin"), 20 * u, _standard("up", "mm s-1")),
        },
        {
            "time": _time("seconds since 2026-03-01", step=600.0),
            "bin": np.arange(count),
            "bin_depths": (("time", "bin"), depth, {"units": "m", "positive": "down"}),
        },
    )


def adcp_by_distance() -> xr.Dataset:
    """The same by heights above the sensor, whose depth is a variable of its own."""
    dataset = adcp().drop_vars(["bin_depths", "bin"])
    sensor = 60.0 + 8.0 * np.sin(np.arange(COUNT))
    height = {"units": "m", "positive": "up", "axis": "Z", "long_name": "height_above_sensor"}
    return dataset.rename(bin="HEIGHT_ABOVE_SENSOR").assign_coords(
        HEIGHT_ABOVE_SENSOR=("HEIGHT_ABOVE_SENSOR", 16.0 * np.arange(5), height),
        DEPTH=("time", sensor, {"units": "m", "positive": "down", "standard_name": "depth"}),
    )


def adcp_on_the_seabed() -> xr.Dataset:
    """Bins by their height above the seabed, bins before times, one of them lost in a gap."""
    u, v = _currents(4, COUNT)
    v[2, 1:3] = np.nan
    height = {"units": "m", "positive": "up", "standard_name": "height_above_sea_floor"}
    return xr.Dataset(
        {
            "EWCT": (("level", "time"), u, {"units": "m s-1"}),
            "NSCT": (("level", "time"), v, {"units": "m s-1"}),
        },
        {
            "time": _time("days since 2026-03-01", step=1.0),
            "level": ("level", [4.0, 54.0, 104.0, 154.0], height),
        },
    )


def curvilinear() -> xr.Dataset:
    """A model on a turned grid with places of two dimensions, positive up."""
    u, v = _currents(COUNT, 3, 4, 5)
    j, i = np.mgrid[0:4, 0:5]
    shape = ("time", "s", "y", "x")
    return xr.Dataset(
        {
            "a": (shape, u, _standard("east")),
            "b": (shape, v, _standard("north")),
        },
        {
            "time": _time("seconds since 1970-01-01", step=3600.0, start=1.77e9),
            "z": ("s", [-200.0, -100.0, -5.0], {"units": "m", "positive": "up", "axis": "Z"}),
            "nav_lat": (("y", "x"), 48.1 + 0.08 * j + 0.03 * i, {"units": "degrees_north"}),
            "nav_lon": (("y", "x"), -5.5 + 0.12 * i - 0.04 * j, {"units": "degrees_east"}),
        },
    )


def speed_and_direction() -> xr.Dataset:
    """A single current meter: speed, and where the current comes from."""
    speed = np.abs(_currents(COUNT)[0])
    return xr.Dataset(
        {
            "cspd": ("time", speed, {"standard_name": "sea_water_speed", "units": "m/s"}),
            "cdir": (
                "time",
                360 * speed,
                {
                    "standard_name": "sea_water_velocity_from_direction",
                    "units": "degrees_true",
                },
            ),
        },
        {
            "time": _time("minutes since 2026-03-01", step=10.0),
            "depth": ((), 80.0, {"units": "m", "positive": "down"}),
        },
    )


def write_csv(path: Path, *, speed: bool = False) -> Path:
    """Profiles of one to three levels, with gaps: one blank, one `NaN`."""
    head = "speed[cm/s],toward[deg]" if speed else "u[cm/s],v[m/s]"
    first, second = _currents(COUNT, 3)
    lines = ["# made", f"time,depth[m],{head}"]
    for hour in range(COUNT):
        for level in range(1 + hour % 3):
            cells = [f"2026-03-01T{hour:02d}:00Z", f"{5 + 40 * level}"]
            cells += [f"{50 * abs(first[hour, level])}", f"{500 * second[hour, level]}"]
            lines.append(",".join(cells))
    lines[4] = lines[4].rpartition(",")[0] + ","
    lines[5] = lines[5].rpartition(",")[0] + ", NaN"
    path.write_text("\n".join(lines) + "\n")
    return path


ARRAYS = {
    "glorys": glorys,
    "hycom": hycom,
    "oceansites": oceansites,
    "adcp": adcp,
    "adcp-by-distance": adcp_by_distance,
    "adcp-on-the-seabed": adcp_on_the_seabed,
    "curvilinear": curvilinear,
    "speed-and-direction": speed_and_direction,
}


def write(name: str, folder: Path, ending: str = "nc") -> Path:
    """One of them by its name, as NetCDF 4, classic NetCDF (`cdf`), zarr or CSV."""
    path = folder / f"{name}.{ending}"
    if name.startswith("csv"):
        return write_csv(path, speed="speed" in name)
    dataset = ARRAYS[name]()
    if ending == "zarr":
        dataset.to_zarr(path, zarr_format=2, consolidated=False)
    else:
        dataset.to_netcdf(path, engine="scipy" if ending == "cdf" else "h5netcdf")
    return path
