"""A current from a CF NetCDF file: one profile, found by standard names, then by usual names."""

from __future__ import annotations

import re
from collections.abc import Sequence
from datetime import UTC
from pathlib import Path
from typing import TYPE_CHECKING, Any

from calm.errors import InputError, Problem
from calm.files.tables import CurrentTable
from calm.files.times import TimeChoiceError, choose_time
from calm.units import QuantityError, unit_factor

if TYPE_CHECKING:
    import xarray as xr

_EAST = (("eastward_sea_water_velocity",), ("uo", "UCUR", "EWCT", "water_u", "u", "U"))
_NORTH = (("northward_sea_water_velocity",), ("vo", "VCUR", "NSCT", "water_v", "v", "V"))
_UP = (("upward_sea_water_velocity",), ("wo", "WCUR", "water_w", "w", "W"))
_SPEED = (("sea_water_speed",), ("HCSP", "speed"))
_TOWARD = (
    ("sea_water_velocity_to_direction", "direction_of_sea_water_velocity"),
    ("HCDT", "toward"),
)
_FROM = (("sea_water_velocity_from_direction",), ())
_TIME_NAMES = ("time", "TIME")
_LEVEL_NAMES = ("depth", "DEPTH", "depthu", "deptht", "lev", "z", "height")
_SEABED_HEIGHTS = ("height_above_sea_floor",)


class _Unreadable(Exception):
    """The file does not hold one current profile that can be understood."""


def read_current_netcdf(
    path: Path, time: str | None, water_depth: float
) -> tuple[CurrentTable, list[str]]:
    """The profile of a time, and notices; `time` may be None where there is only one.

    `water_depth` [m] places levels that are given as heights above the seabed.

    Raises
    ------
    InputError
        The file holds no current profile that can be understood.
    TimeChoiceError
        The time is not in the file.
    """
    import cf_xarray  # noqa: F401  (gives datasets their `cf`)
    import xarray as xr

    with path.open("rb") as file:
        engine = "scipy" if file.read(3) == b"CDF" else "h5netcdf"
    notices: list[str] = []
    try:
        with xr.open_dataset(path, engine=engine) as dataset:
            profile, notice = _at_time(dataset, time)
            notices += [notice] if notice else []
            return _profile(profile, water_depth, notices), notices
    except TimeChoiceError:
        raise
    except _Unreadable as error:
        raise InputError([Problem(str(path), 0, 0, str(error))]) from None
    # Damaged files leave the libraries by exceptions of many kinds.
    except Exception as error:
        reason = str(error).partition("\n")[0]
        message = f"cannot be read as NetCDF: {reason}"
        raise InputError([Problem(str(path), 0, 0, message)]) from None


def _at_time(dataset: xr.Dataset, wanted: str | None) -> tuple[xr.Dataset, str | None]:
    """The dataset at the time wanted, without the dimensions that have but one value."""
    names = dataset.cf.coordinates.get("time", []) + list(_TIME_NAMES)
    name = next((name for name in names if name in dataset.variables), None)
    if name is None:
        if wanted is not None:
            raise TimeChoiceError("the file has no times")
        return dataset.squeeze(), None
    times = dataset[name]
    if times.dtype.kind != "M" or times.ndim > 1:
        raise _Unreadable(f"the times in `{name}` cannot be read")
    seconds = times.values.ravel().astype("datetime64[us]").tolist()
    index, notice = choose_time([moment.replace(tzinfo=UTC) for moment in seconds], wanted)
    if times.ndim == 1:
        dataset = dataset.isel({times.dims[0]: index})
    return dataset.squeeze(), notice


def _profile(dataset: xr.Dataset, water_depth: float, notices: list[str]) -> CurrentTable:
    import numpy as np

    east, north = _find(dataset, _EAST), _find(dataset, _NORTH)
    up = _find(dataset, _UP)
    if east is not None and north is not None:
        u, v = _values(east, "speed"), _values(north, "speed")
    else:
        east, u, v = _from_direction(dataset)
    w = np.zeros_like(u) if up is None else _values(up, "speed")
    depth = _depths(dataset, east, water_depth)
    if not u.shape == v.shape == w.shape == depth.shape:
        raise _Unreadable("its velocities and depths have different shapes")
    known = np.isfinite(u) & np.isfinite(v) & np.isfinite(w) & np.isfinite(depth)
    below = known & (depth >= 0)
    _tell(notices, int(np.sum(~known)), "without a value")
    _tell(notices, int(np.sum(known & ~below)), "above the surface")
    if not below.any():
        raise _Unreadable("no level below the surface has a value")
    if any(str(name).endswith(("_QC", "_qc")) for name in dataset.variables):
        notices.append("the current's quality flags are not looked at")
    order = np.argsort(depth[below])
    depth, u, v, w = (values[below][order] for values in (depth, u, v, w))
    if np.any(np.diff(depth) == 0):
        raise _Unreadable("two levels have the same depth")
    return CurrentTable(*(tuple(values.tolist()) for values in (depth, u, v, w)))


def _from_direction(dataset: xr.Dataset) -> tuple[xr.DataArray, Any, Any]:
    """Speed as found, and its east and north parts."""
    import numpy as np

    speed, toward, origin = (_find(dataset, names) for names in (_SPEED, _TOWARD, _FROM))
    direction = toward if toward is not None else origin
    if speed is None or direction is None:
        held = ", ".join(str(name) for name in dataset.variables)
        raise _Unreadable(
            "holds no current: eastward and northward velocity, or speed and direction to or from, "
            f"are looked for by CF standard name; it holds {held[:200] or 'nothing'}"
        )
    angle = _values(direction, "angle") + (0.0 if toward is not None else 180.0)
    sine, cosine = np.sin(np.radians(angle)), np.cos(np.radians(angle))
    size = _values(speed, "speed")
    return speed, size * sine, size * cosine


def _find(dataset: xr.Dataset, names: tuple[Sequence[str], Sequence[str]]) -> xr.DataArray | None:
    """The variable of a standard name, else of a usual name."""
    standard, usual = names
    for name in standard:
        found = dataset.cf.standard_names.get(name, [])
        if len(found) > 1:
            raise _Unreadable(f"several variables are {name}: {', '.join(found)}")
        if found:
            variable: xr.DataArray = dataset[found[0]]
            return variable
    present = [name for name in usual if name in dataset.data_vars]
    return dataset[present[0]] if present else None


def _values(variable: xr.DataArray, dimension: str) -> Any:
    """A variable in SI (angles: degrees), as a one-dimensional float64 array."""
    import numpy as np

    if variable.ndim > 1:
        sizes = ", ".join(f"{name} ({size})" for name, size in variable.sizes.items())
        raise _Unreadable(f"`{variable.name}` is no single profile, but spreads over {sizes}")
    units = str(variable.attrs.get("units", ""))
    try:
        factor = unit_factor(re.sub(r"(?i)[ _](true|t)$", "", units), dimension)
    except QuantityError as error:
        raise _Unreadable(f"`{variable.name}`: its unit, `{units}`, {error.complaint}") from None
    return np.atleast_1d(variable.values).astype(np.float64) * factor


def _depths(dataset: xr.Dataset, velocity: xr.DataArray, water_depth: float) -> Any:
    """The depths of the levels [m], positive down."""
    names = dataset.cf.axes.get("Z", []) + dataset.cf.coordinates.get("vertical", [])
    names += [name for name in _LEVEL_NAMES if name in dataset.variables]
    levels = next((dataset[name] for name in names if dataset[name].dims == velocity.dims), None)
    if levels is None:
        raise _Unreadable("its levels have no depth")
    values = _values(levels, "length")
    standard_name = levels.attrs.get("standard_name", "")
    if standard_name in _SEABED_HEIGHTS:
        return water_depth - values
    positive = levels.attrs.get("positive") or ("down" if "depth" in _names_of(levels) else None)
    if positive not in ("up", "down"):
        raise _Unreadable(f"`{levels.name}` does not say whether it is `positive` up or down")
    return values if positive == "down" else -values


def _names_of(levels: xr.DataArray) -> str:
    return f"{levels.name} {levels.attrs.get('standard_name', '')}".lower()


def _tell(notices: list[str], count: int, what: str) -> None:
    if count:
        notices.append(f"{count} level{'s' * (count > 1)} {what} left out of the current")
