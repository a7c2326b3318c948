"""Access to CF datasets (NetCDF 3 and 4, zarr): opening, values, units, times and labels.

Times stay undecoded, and values are read lazily. A faulty file raises `UnreadableError`, which
`reading` converts to `InputError`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from math import inf, prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from calm.errors import CalmError, refused
from calm.physics.line import Floats
from calm.records.current_terms import ZONES_OF_UTC, TimeChoiceError
from calm.records.instrument_text import reader_of
from calm.units import QuantityError, unit_factor, unit_line
from calm.whole_file import no_such_file

if TYPE_CHECKING:
    import xarray as xr

_TIME_NAMES = ("time", "TIME", "Time", "time_counter", "ocean_time", "MT")
_CALENDARS = ("standard", "gregorian", "proleptic_gregorian")
_FIRST, _LAST = "1678-01-01", "2262-01-01"
_ZONE = re.compile(r" since .*\d\s*([A-Za-z]{2,}(/[A-Za-z_]+)?)\s*$")
_ZONED = ("time_zone", "timezone", "tz", "time_reference")
_MOST_LISTED = 5
MOST_VALUES = 50_000_000
"""Maximum number of values read at once, enough for a reading every second for 18 months."""
_NORTH_NAMED = re.compile(
    r"(?i)[ _](true|t|magnetic)$|\s*\(?clockwise from ((true|magnetic) )?north\)?$"
)
_LABELS = ("instrument", "label", "instrument_label", "labels", "instruments")
_HEIGHTS = ("hab", "height_above_bottom", "height_above_seabed", "DIST_SEABED")
_DEPTHS = ("nominal_depth", "NOMINAL_DEPTH", "InstrDepth", "DEPTH", "depth", "instrument_depth")

_KINDS = {
    rb"\AMATLAB": "a .mat file of MATLAB; write its times, depths and currents with `ncwrite`",
    rb"\AGRIB": "a GRIB file; convert it to NetCDF (`cdo -f nc copy`)",
    rb"\A\x0e\x03\x13\x01": "an HDF 4 file; convert it to NetCDF",
    rb"\APK\x03\x04": "a packed file or a spreadsheet; unpack it, or save the sheet as CSV",
    rb"\A\xd0\xcf\x11\xe0": "a spreadsheet; save it as CSV",
    rb"\A\x1f\x8b": "a packed file; unpack it first (`gunzip`)",
    rb"\A\x7f\x7f": "a raw Teledyne ADCP file; convert it to NetCDF with its software or MHKiT",
    rb"\A\xa5": "a raw Nortek file; convert it to NetCDF with its software or MHKiT",
    rb"(?m)^\s*ODF_HEADER\b": "an ODF file of Fisheries and Oceans Canada; convert it to NetCDF "
    "(`ocean-data-parser` does)",
    rb"(?m)^\*IOS HEADER VERSION": "an IOS Shell file; convert it to NetCDF "
    "(`ocean-data-parser` does)",
}
"""Patterns that identify unsupported kinds of files by their first bytes.

Each pattern has the name of the kind, and the advice for the user.
"""
_HEAD = 400  # number of bytes searched

_ENGINES = {b"\x89HDF": "h5netcdf", **dict.fromkeys((b"CDF\x01", b"CDF\x02", b"CDF\x05"), "scipy")}
_ZARR = ("zarr.json", ".zgroup", ".zmetadata")


class UnreadableError(Exception):
    """Error raised if the contents of a file cannot be used; the message gives the reason."""


def holds_arrays(path: Path) -> bool:
    """Return whether a path is NetCDF, zarr or an instrument's text file, rather than CSV.

    Raise InputError for a folder that is not a zarr store, and for known but unsupported kinds of
    file.
    """
    if path.is_dir():
        if not is_zarr(path):
            raise refused(path, "is a folder but not a zarr store; join its files into one first")
        return True
    if not path.is_file():  # opening a pipe or a device could block
        raise refused(path, "is not a regular file" if path.exists() else no_such_file(path))
    with path.open("rb") as file:
        head = file.read(_HEAD)
    for kind in (kind for mark, kind in _KINDS.items() if re.search(mark, head)):
        raise refused(path, f"is {kind}; CALM reads NetCDF, zarr and CSV")
    return bool(engine_of(path) or reader_of(path))


def is_zarr(path: Path) -> bool:
    """Return whether a folder is a zarr store."""
    return any((path / name).is_file() for name in _ZARR)


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Context manager that raises InputError in place of any error caused by a faulty file."""
    try:
        yield
    except (CalmError, TimeChoiceError, ModuleNotFoundError):
        raise
    except UnreadableError as error:
        raise refused(path, str(error)) from None
    # The libraries raise many kinds of exception on damaged files.
    except Exception as error:
        kind = "zarr" if path.is_dir() else "NetCDF"
        reason = str(error).partition("\n")[0]
        raise refused(path, f"cannot be read as {kind}: {reason}") from None


@contextmanager
def opened(path: Path) -> Iterator[xr.Dataset]:
    """Context manager that opens a dataset, and raises InputError in place of any error.

    If the contents cannot be used, the message also lists the variables of the file.
    """
    if not path.exists():
        raise refused(path, no_such_file(path))
    if not holds_arrays(path):
        raise refused(path, "is not a NetCDF, RODB or .cnv file, nor a text table of RBR")
    with reading(path), open_current(path) as dataset, saying_what_it_holds(dataset):
        yield dataset


@contextmanager
def saying_what_it_holds(dataset: xr.Dataset) -> Iterator[None]:
    """Context manager that appends the list of the variables to the message of UnreadableError."""
    try:
        yield
    except UnreadableError as error:
        raise UnreadableError(f"{error}; it holds {holdings(dataset)}") from None


def open_current(path: Path) -> xr.Dataset:
    """Open a dataset of currents; values are read only when needed, and times are not decoded."""
    import cf_xarray  # noqa: F401  (gives datasets their `cf`)
    import xarray as xr

    engine = "zarr" if path.is_dir() else engine_of(path)
    if not engine and (read := reader_of(path)):
        return read(path)
    _refuse_large(path, engine)
    own: dict[str, Any] = {"consolidated": False} if engine == "zarr" else {}
    return xr.open_dataset(path, engine=engine, decode_times=False, cache=False, **own)


def _refuse_large(path: Path, engine: str) -> None:
    def check(name: str, array: Any) -> None:
        # one-dimensional variables are read whole, others chunk by chunk
        shape = getattr(array, "shape", None) or ()
        at_once = shape if len(shape) < 2 else getattr(array, "chunks", None) or ()
        _refuse_many(name, prod(at_once))

    # a classic NetCDF file needs no check, because its size limits the number of values
    if engine == "zarr":
        import zarr

        for name, array in zarr.open_group(path, mode="r").arrays():
            check(name, array)
    elif engine == "h5netcdf":
        import h5py

        with h5py.File(path, "r") as file:
            file.visititems(check)


def _refuse_many(name: object, count: int) -> None:
    if count > MOST_VALUES:
        raise UnreadableError(
            f"`{name}` has {count:,} values, more than the {MOST_VALUES:,} that can be read at "
            "once; extract a part of it (`ncks -d`)"
        )


def engine_of(path: Path) -> str:
    """Return the xarray engine for a NetCDF file, or "" for any other file.

    The first bytes of the file decide.
    """
    with path.open("rb") as file:
        return _ENGINES.get(file.read(4), "")


def holdings(dataset: xr.Dataset) -> str:
    """List the variables of a dataset with their dimensions, units and standard names."""
    listed = []
    # most dimensions first: probably the variable that the user wants
    for name, variable in sorted(dataset.variables.items(), key=lambda each: -each[1].ndim):
        sizes = ", ".join(f"{dim} {size}" for dim, size in variable.sizes.items())
        words = [f"{name} ({sizes})" if sizes else str(name)]
        if "units" in variable.attrs:
            words.append(f"[{variable.attrs['units']}]")
        if "standard_name" in variable.attrs:
            words.append(str(variable.attrs["standard_name"]))
        listed.append(" ".join(words)[:120])
    hidden = len(listed) - _MOST_LISTED
    more = [f"and {hidden} more"] if hidden > 0 else []
    if groups := groups_of(Path(dataset.encoding.get("source", ""))):
        more.append(
            f"and the groups {', '.join(groups)}, which are not read; extract one into a separate "
            f"file (`ncks -G : -g {groups[0]} in.nc out.nc`)"
        )
    return "; ".join([*listed[:_MOST_LISTED], *more]) or "nothing"


def groups_of(path: Path) -> list[str]:
    """Return the names of the groups of a NetCDF 4 file, or an empty list for any other file."""
    import h5netcdf

    if not path.is_file() or engine_of(path) != "h5netcdf":
        return []
    with h5netcdf.File(path, "r") as file:
        return list(file.groups)


def factor_of(variable: xr.DataArray, dimension: str) -> float:
    """Return the factor that converts the unit of a variable to SI, or to degrees for angles.

    Raise UnreadableError if the variable has no unit, or a unit of another dimension.
    """
    unit = str(variable.attrs.get("units", ""))
    plain = {"db": "dbar"}.get(unit.strip(), _NORTH_NAMED.sub("", unit.strip()))
    if not plain:
        raise UnreadableError(f"`{variable.name}` has no `units`")
    if (plain.istitle() or plain.isupper()) and len(plain) > 1:  # `Meter`, `METER/SEC`
        plain = plain.lower().replace("/sec", "/s")
    try:
        return unit_factor(plain, dimension)
    except QuantityError as error:
        message = f"`{variable.name}`: its unit, `{unit}`, {error.complaint}"
        raise UnreadableError(message) from None


def converted(variable: xr.DataArray, values: Floats, wanted: str) -> Floats:
    """Convert values from the unit of a variable to the unit `wanted`, given in pint notation.

    Raise UnreadableError if the variable has no unit, or a unit of another dimension.
    """
    unit = str(variable.attrs.get("units", "")).strip()
    if not unit:
        raise UnreadableError(f"`{variable.name}` has no unit; set one, such as {wanted}")
    try:
        factor, zero = unit_line(unit, wanted)
    except QuantityError as error:
        message = f"`{variable.name}`: its unit, `{unit}`, {error.complaint}"
        raise UnreadableError(message) from None
    return factor * values + zero


_PRACTICAL = ("", "1", "psu", "pss", "pss-78", "pss78", "1e-3", "0.001", "ppt", "psal")


def refuse_other_salinity(variable: xr.DataArray) -> None:
    """Raise UnreadableError if the unit of a salinity is not a unit of practical salinity."""
    unit = str(variable.attrs.get("units", "")).strip()
    if unit.lower() not in _PRACTICAL:
        reason = f"`{unit}`, is not a unit of practical salinity (1 or PSU)"
        raise UnreadableError(f"`{variable.name}`: its unit, {reason}")


def first_present(dataset: xr.Dataset, names: Iterable[str]) -> list[str]:
    """Return the names that are variables of the dataset, in order, without duplicates."""
    return [name for name in dict.fromkeys(names) if name in dataset.variables]


def known_values(variable: xr.DataArray) -> NDArray[np.float64]:
    """Return the values of a variable in the declared unit, with NaN outside the valid range.

    If the limits of the valid range have the integer type of the packed values, they are limits of
    the packed values (NetCDF User Guide).
    """
    _refuse_many(variable.name, variable.size)
    values = np.array(variable.values, np.float64)
    low, high = valid_range(variable)
    if low > -inf or high < inf:
        values[(values < low) | (values > high)] = np.nan
    return values


def valid_range(variable: xr.DataArray) -> tuple[float, float]:
    """Return the unpacked minimum and maximum valid values of a variable; ±inf without a limit."""
    low, high = (variable.attrs.get(name) for name in ("valid_min", "valid_max"))
    both = variable.attrs.get("valid_range")
    if both is not None and len(both) == 2:
        low, high = both
    ends = _unpacked(low, variable, -inf), _unpacked(high, variable, inf)
    return min(ends), max(ends)


def _unpacked(limit: Any, variable: xr.DataArray, absent: float) -> float:
    try:
        value = float(absent if limit is None else limit)
    except (TypeError, ValueError):  # ignore a limit that is not a number
        return absent
    packed = np.dtype(variable.encoding.get("dtype", np.float64))
    if limit is None or not (packed.kind in "iu" and np.asarray(limit).dtype.kind in "iu"):
        return value
    packing = variable.encoding
    return value * float(packing.get("scale_factor", 1.0)) + float(packing.get("add_offset", 0.0))


def texts_of(variable: xr.DataArray) -> list[str]:
    """Return the values of a variable as strings without surrounding blanks."""
    values = np.atleast_1d(variable.values).tolist()
    return [(one.decode() if isinstance(one, bytes) else str(one)).strip() for one in values]


def labels_along(dataset: xr.Dataset, dimension: str) -> tuple[str, ...] | None:
    """Return the text labels along a dimension; None if the dataset has no labels."""
    for name in first_present(dataset, (*_LABELS, dimension)):
        variable = dataset[name]
        if variable.dims == (dimension,) and variable.dtype.kind in "SUO":
            return tuple(texts_of(variable))
    return None


def places_along(dataset: xr.Dataset, dimension: str | None, seabed: float) -> Floats | None:
    """Return the nominal depths of instruments [m]; None if the dataset has none.

    `dimension` is None for a single instrument. `seabed` is the water depth [m], to convert heights
    above the seabed.
    """
    dims = () if dimension is None else (dimension,)
    for names, sign, start in ((_HEIGHTS, -1.0, seabed), (_DEPTHS, 1.0, 0.0)):
        for name in names:
            if name in dataset.variables and dataset[name].dims == dims:
                try:
                    factor = factor_of(dataset[name], "length")
                except UnreadableError:
                    if name != "InstrDepth" or "units" in dataset[name].attrs:
                        continue
                    factor = 1.0  # RODB and its imitators omit the unit, metres
                values = np.atleast_1d(known_values(dataset[name])) * factor
                return start + sign * values
    return None


def find_times(dataset: xr.Dataset, velocity: str) -> str | None:
    """Return the name of the time variable of a velocity; None if there is no such variable.

    All dimensions of the time variable are dimensions of the velocity.
    """
    axes, coordinates = dataset.cf.axes, dataset.cf.coordinates
    units = {name: str(one.attrs.get("units", "")) for name, one in dataset.variables.items()}
    since = [name for name, unit in units.items() if " since " in unit]
    names = [*axes.get("T", []), *coordinates.get("time", []), *_TIME_NAMES, *map(str, since)]
    dims = set(dataset[velocity].dims)
    fitting = [name for name in first_present(dataset, names) if set(dataset[name].dims) <= dims]
    # prefer a time dimension to a single date, such as the start of a forecast
    return min(fitting, key=lambda name: not dataset[name].dims, default=None)


def read_times(dataset: xr.Dataset, name: str) -> NDArray[np.datetime64]:
    """Return the times of a variable as (n,) datetime64[ns], in the order of the file.

    Raise UnreadableError if a value is missing or not a time, or if the calendar is not Gregorian.
    """
    times = dataset[name]
    calendar = str(times.attrs.get("calendar", "standard")).lower()
    if calendar not in _CALENDARS:
        raise UnreadableError(
            f"the times in `{name}` follow the calendar `{calendar}`, which CALM cannot convert to "
            f"real dates; the supported calendars are {', '.join(_CALENDARS)}"
        )
    if times.ndim > 1:
        raise UnreadableError(f"the times in `{name}` have {times.ndim} dimensions")
    read = np.empty(times.size, "datetime64[ns]")
    read[:] = _decoded(times)
    missing = int(np.isnat(read).sum())
    if missing:
        raise UnreadableError(f"{missing} of the {read.size} times in `{name}` have no value")
    return read


def zone_notices(dataset: xr.Dataset, name: str) -> list[str]:
    """Return a notice if an attribute of the times or the file names a time zone other than UTC."""
    for attributes in (dataset[name].attrs, dataset.attrs):
        for key in _ZONED:
            zone = str(attributes.get(key, "")).strip()
            if zone and zone.upper() not in ZONES_OF_UTC:
                return [f"`{key}` is `{zone[:80]}`, but CALM reads the times as UTC"]
    return []


def _decoded(times: xr.DataArray) -> NDArray[Any]:
    import warnings

    import xarray as xr

    if times.dtype.kind == "f" and not times.notnull().any():
        return np.array("NaT", "datetime64[ns]")  # xarray cannot decode an empty time
    unit = str(times.attrs.get("units", ""))
    zone = _ZONE.search(unit)
    if zone is not None and zone[1].upper() not in ZONES_OF_UTC:
        raise UnreadableError(
            f"the times in `{times.name}` are `{unit}`: the offset of `{zone[1]}` from UTC is "
            "ambiguous; write it in hours, such as `+01:00`, or use UTC"
        )
    refusal = UnreadableError(
        f"the times in `{times.name}` cannot be read: their unit, `{unit}`, is none of seconds, "
        "minutes, hours or days since a date"
    )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # about years without leading zeros, `1-1-1`
            whole = xr.decode_cf(times.to_dataset(name="times"))["times"]
            decoded: NDArray[Any] = whole.values.ravel()
    except (ValueError, OverflowError):
        raise refusal from None
    if decoded.dtype.kind != "M":
        raise _no_date_error(times) if decoded.dtype.kind == "O" else refusal
    known = decoded[~np.isnat(decoded)]
    first, last = np.datetime64(_FIRST), np.datetime64(_LAST)
    if known.size and not first <= known.min() <= known.max() < last:
        raise UnreadableError(f"the times in `{times.name}` are not all between {first} and {last}")
    return decoded


def _no_date_error(times: xr.DataArray) -> UnreadableError:
    values = times.values.ravel()
    worst = values[np.nanargmax(np.abs(values - np.nanmedian(values)))]
    return UnreadableError(
        f"`{times.name}` contains the value {worst:.10g} (units `{times.attrs['units']}`), which "
        f"is not a date between {_FIRST} and {_LAST}"
    )
