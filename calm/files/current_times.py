"""The times of a dataset of currents, in the calendar of real dates."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from calm.files.current_variables import UnreadableError, first_present
from calm.files.times import ZONES_OF_UTC

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr
    from numpy.typing import NDArray

_NAMES = ("time", "TIME", "Time", "time_counter", "ocean_time", "MT")
_CALENDARS = ("standard", "gregorian", "proleptic_gregorian")
_FIRST, _LAST = "1678-01-01", "2262-01-01"
_AT_ONCE = 50_000
_ZONE = re.compile(r" since .*\d\s*([A-Za-z]{2,}(/[A-Za-z_]+)?)\s*$")
_ZONED = ("time_zone", "timezone", "tz")


def find_times(dataset: xr.Dataset, velocity: str) -> str | None:
    """The name of the variable with the times of a velocity; None where it has none.

    Its dimension, if it has one, is one of the velocity's.
    """
    axes, coordinates = dataset.cf.axes, dataset.cf.coordinates
    units = {name: str(one.attrs.get("units", "")) for name, one in dataset.variables.items()}
    since = [name for name, unit in units.items() if " since " in unit]
    names = [*axes.get("T", []), *coordinates.get("time", []), *_NAMES, *map(str, since)]
    dims = set(dataset[velocity].dims)
    fitting = [name for name in first_present(dataset, names) if set(dataset[name].dims) <= dims]
    # a dimension of times before a single date, such as that of a forecast
    return min(fitting, key=lambda name: not dataset[name].dims, default=None)


def read_times(dataset: xr.Dataset, name: str) -> NDArray[np.datetime64]:
    """Its times to the nanosecond, one-dimensional, in the order of the file.

    Raises
    ------
    UnreadableError
        They are no times, are missing, or follow a calendar that has other days than the real one.
    """
    import numpy as np

    times = dataset[name]
    calendar = str(times.attrs.get("calendar", "standard")).lower()
    if calendar not in _CALENDARS:
        raise UnreadableError(
            f"the times in `{name}` follow the calendar `{calendar}`, whose days are not those of "
            f"real dates; {', '.join(_CALENDARS)} can be read"
        )
    if times.ndim > 1:
        raise UnreadableError(f"the times in `{name}` have {times.ndim} dimensions")
    read = np.empty(times.size, "datetime64[ns]")
    for start in range(0, times.size, _AT_ONCE):
        piece = slice(start, start + _AT_ONCE)
        read[piece] = _decoded(times[piece] if times.ndim else times)
    missing = int(np.isnat(read).sum())
    if missing:
        raise UnreadableError(f"{missing} of the {read.size} times in `{name}` have no value")
    return read


def zone_notices(dataset: xr.Dataset, name: str) -> list[str]:
    """What is said where the attributes of the times name another zone than UTC."""
    attributes = dataset[name].attrs
    zones = [str(attributes.get(one, "")) for one in _ZONED]
    zone = next((one for one in zones if one and one.strip().upper() not in ZONES_OF_UTC), None)
    if zone is None and "local time" in str(attributes.get("long_name", "")).lower():
        zone = str(attributes["long_name"])
    return [f"`{name}` says `{zone}`; its times are taken as they stand"] if zone else []


def _decoded(times: xr.DataArray) -> NDArray[Any]:
    import warnings

    import numpy as np
    import xarray as xr

    if times.dtype.kind == "f" and not times.notnull().any():
        return np.array("NaT", "datetime64[ns]")  # to xarray, no numbers at all are no times
    unit = str(times.attrs.get("units", ""))
    zone = _ZONE.search(unit)
    if zone is not None and zone[1].upper() not in ZONES_OF_UTC:
        raise UnreadableError(
            f"the times in `{times.name}` are `{unit}`: what `{zone[1]}` is ahead of UTC is not "
            "known for sure; write the offset in hours, such as `+01:00`, or use UTC"
        )
    refusal = UnreadableError(
        f"the times in `{times.name}` cannot be read: their unit, `{unit}`, is none of seconds, "
        "minutes, hours or days since a date"
    )
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of years without their zeros, `1-1-1`
            whole = xr.decode_cf(times.to_dataset(name="times"))["times"]
            decoded: NDArray[Any] = whole.values.ravel()
    except (ValueError, OverflowError):
        raise refusal from None
    if decoded.dtype.kind != "M":
        raise _no_date(times) if decoded.dtype.kind == "O" else refusal
    known = decoded[~np.isnat(decoded)]
    first, last = np.datetime64(_FIRST), np.datetime64(_LAST)
    if known.size and not first <= known.min() <= known.max() < last:
        raise UnreadableError(f"the times in `{times.name}` are not all between {first} and {last}")
    return decoded


def _no_date(times: xr.DataArray) -> UnreadableError:
    """What is said where the unit of times is understood, but not all of their values."""
    import numpy as np

    values = times.values.ravel()
    worst = values[np.nanargmax(np.abs(values - np.nanmedian(values)))]
    return UnreadableError(
        f"`{times.name}` has {worst:.10g} among its times, in `{times.attrs['units']}`: no date "
        f"between {_FIRST} and {_LAST}"
    )
