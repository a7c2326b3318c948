"""Text files of single instruments, converted to datasets as found in archives.

RODB files (`.use`, `.microcat`, `.rcm`) have lines ``Name = value`` above columns with fixed units.
Sea-Bird `.cnv` files, RBR RSKtools tables and plain tables have units in the header.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem, refused, unknown
from calm.physics.line import Floats
from calm.positions import plain_degrees
from calm.records.headings import read_time_columns
from calm.whole_file import read_content

if TYPE_CHECKING:
    import xarray as xr

LARGEST = 500_000_000
"""Maximum file size [bytes]."""

AIR = 10.1325
"""Pressure of the air [dbar]."""
_HEAD = 100_000  # bytes searched for a header
_WHAT = {
    "temperature": ("TEMP", "sea_water_temperature"),
    "conductivity": ("CNDC", "sea_water_electrical_conductivity"),
    "salinity": ("PSAL", "sea_water_practical_salinity"),
    "pressure": ("PRES", "sea_water_pressure_due_to_sea_water"),
    "depth": ("DEPTH", "depth"),
    "u": ("UCUR", "eastward_sea_water_velocity"),
    "v": ("VCUR", "northward_sea_water_velocity"),
    "w": ("WCUR", "upward_sea_water_velocity"),
}
_RODB = {
    "T": ("temperature", "degC"), "C": ("conductivity", "mS/cm"), "P": ("pressure", "dbar"),
    "U": ("u", "cm/s"), "V": ("v", "cm/s"), "W": ("w", "cm/s"), "Z": ("depth", "m"),
}  # fmt: skip
_DATE = ("YY", "MM", "DD", "HH")
_PAIR = re.compile(r"\s*(\w+)\s*=\s*(.*?)\s*$")
_CNV_NAME = re.compile(r"# name (\d+) = (\S+?):\s*(.*?)\s*$")
_CNV_UNIT = re.compile(r"\[(?:.*,\s*)?([^\[\],]+)\]\s*$")
_CNV = (
    (r"pr\w*", "pressure", {"db": "dbar", "dbar": "dbar", "psi": "psi", "psia": "psi"}),
    (r"dep[SF]\w*", "depth", {"m": "m", "ft": "ft"}),
    (r"(t|tv)\d*(68|90)\w*", "temperature", {"deg C": "degC"}),
    (r"sal\w*", "salinity", {"PSU": "1"}),
    (r"(c|cond)\d\w*/c?m", "conductivity", {"S/m": "S/m", "mS/cm": "mS/cm", "uS/cm": "uS/cm"}),
)  # fmt: skip
_CNV_TIMES = {
    "timeJ": 86_400.0, "timeJV2": 86_400.0, "timeK": 1.0, "timeY": 1.0,
    "timeS": 1.0, "timeM": 60.0, "timeH": 3600.0,
}  # fmt: skip
_CNV_EPOCHS = {"timeK": "2000-01-01", "timeY": "1970-01-01"}
_SECONDS = "seconds since 1970-01-01 00:00:00"
_MISSING = (-9999.0, -999.0, -99.999, -9.99e-29, 1e35)


def reader_of(path: Path) -> Callable[[Path], xr.Dataset] | None:
    """Return the function that reads an instrument's text file, or None for any other file.

    The function returns a dataset with OceanSITES names, times in seconds since 1970, and NaN for
    missing values. The function raises InputError if the file is unreadable, has no times, or has
    an invalid row.
    """
    with path.open("rb") as file:
        head = file.read(_HEAD).decode("latin-1")
    if head.startswith("* Sea-Bird") or re.search(r"(?m)^# nquan\s*=", head):
        return _cnv
    if head.startswith("// Creator: RBR"):
        return _rbr
    return _rodb if re.search(r"(?mi)^\s*columns\s*=\s*\w+(:\w+)+\s*$", head) else None


def _dataset(
    path: Path,
    time: NDArray[np.datetime64],
    columns: dict[tuple[str, str], Floats],
    nominal: float = math.nan,
    latitude: float = math.nan,
    serial: str = "",
) -> xr.Dataset:
    """Build a dataset from columns; the key of a column is (quantity, unit)."""
    import cf_xarray  # noqa: F401  (gives datasets their `cf`)
    import xarray as xr

    seconds = (time - np.datetime64(0, "us")) / np.timedelta64(1, "s")
    dataset = xr.Dataset(attrs={"Conventions": "CF-1.11", "source": path.name})
    dataset["TIME"] = "TIME", seconds, {
        "standard_name": "time", "long_name": "time", "units": _SECONDS, "axis": "T",
        "calendar": "standard", "units_metadata": "leap_seconds: none",
    }  # fmt: skip
    for (what, unit), values in columns.items():
        name, standard = _WHAT[what]
        dataset[name] = "TIME", values, {
            "standard_name": standard, "long_name": standard.replace("_", " "), "units": unit,
        }  # fmt: skip
        if what == "temperature":
            dataset[name].attrs["units_metadata"] = "temperature: on_scale"
    down = {"standard_name": "depth", "units": "m", "positive": "down"}
    if "DEPTH" in dataset:
        dataset["DEPTH"].attrs.update(down)
    elif "UCUR" in dataset:
        dataset["INSTRUMENT_DEPTH"] = (
            "TIME",
            _instrument_depths(columns, len(time), nominal, latitude),
            down,
        )
    if math.isfinite(nominal):
        dataset["NOMINAL_DEPTH"] = (), nominal, {**down, "long_name": "nominal depth"}
    if serial:
        dataset.attrs["serial_number"] = serial
    return dataset


def _instrument_depths(
    columns: dict[tuple[str, str], Floats], count: int, nominal: float, latitude: float
) -> Floats:
    import gsw

    pressure = columns.get(("pressure", "dbar"), np.full(count, np.nan))
    depth = -gsw.z_from_p(pressure, 45.0 if math.isnan(latitude) else latitude)
    return np.maximum(np.where(np.isnan(depth), nominal, depth), 0.0)


def _lines(path: Path) -> list[str]:
    return read_content(path, largest=LARGEST).decode("latin-1").splitlines()


def _rodb(path: Path) -> xr.Dataset:
    lines = _lines(path)
    header: dict[str, str] = {}
    first = 0
    while first < len(lines) and (not lines[first].strip() or "=" in lines[first]):
        if found := _PAIR.match(lines[first]):
            header[found[1].lower()] = found[2]
        first += 1
    names = header["columns"].upper().split(":")
    if not set(_DATE[:3]) <= set(names):
        raise refused(path, "`Columns` must contain YY, MM and DD", line=first)
    values = _number_rows(path, lines, first, len(names))
    of = dict(zip(names, values.T, strict=True))
    year, month, day = (of[name].astype(np.int64) for name in _DATE[:3])
    months = (year - 1970).astype("M8[Y]").astype("M8[M]") + (month - 1)
    seconds = np.rint(of.get("HH", np.zeros(len(values))) * 3600.0)  # hours have five digits
    time = months.astype("M8[us]") + (day - 1) * np.timedelta64(1, "D")
    columns = {_RODB[name]: of[name] for name in names if name in _RODB}
    latitude = header.get("latitude", "nan")
    try:
        nominal, degrees = (
            float(header.get("instrdepth", "nan")),
            plain_degrees(latitude, "latitude"),
        )
    except ValueError:
        raise refused(path, "`InstrDepth` or `Latitude` is not a number") from None
    if nominal in _MISSING or nominal < 0.0:
        nominal = math.nan
    serial = header.get("serialnumber", "")
    return _dataset(path, time + seconds.astype("m8[s]"), columns, nominal, degrees, serial)


def _cnv(path: Path) -> xr.Dataset:
    lines = _lines(path)
    first = next((i for i, line in enumerate(lines) if line.startswith("*END*")), -1) + 1
    head = "\n".join(lines[:first])
    names = {int(one[1]): (one[2], one[3]) for one in map(_CNV_NAME.match, lines[:first]) if one}
    if not names:
        raise refused(path, "the header names no columns")
    values = _number_rows(path, lines, first, len(names))
    columns: dict[tuple[str, str], Floats] = {}
    for j, (name, title) in names.items():
        unit = _CNV_UNIT.search(title)
        for pattern, what, units in _CNV:
            if re.fullmatch(pattern, name) and unit is not None and unit[1] in units:
                columns.setdefault((what, units[unit[1]]), values[:, j])
    bad = next((values[:, j] for j, (name, _) in names.items() if name == "flag"), None)
    if bad is not None:
        columns = {name: np.where(bad == 0.0, one, np.nan) for name, one in columns.items()}
    clock = next(((j, name) for j, (name, _) in names.items() if name in _CNV_TIMES), None)
    start = re.search(r"(?m)^# start_time = (\w{3} \d+ \d{4}(?: [\d:]+)?)", head)
    if clock is None or (start is None and clock[1] not in _CNV_EPOCHS):
        raise refused(
            path, f"has no times: one of {', '.join(_CNV_TIMES)} and a start_time are needed"
        )
    seconds = values[:, clock[0]] * _CNV_TIMES[clock[1]]
    if clock[1] in _CNV_EPOCHS:
        epoch = np.datetime64(_CNV_EPOCHS[clock[1]], "us")
    else:
        from datetime import datetime

        assert start is not None
        text = start[1] if ":" in start[1] else f"{start[1]} 00:00:00"
        epoch = np.datetime64(datetime.strptime(text, "%b %d %Y %H:%M:%S"), "us")
        if clock[1].startswith("timeJ"):  # day of the year, from 1
            epoch, seconds = epoch.astype("M8[Y]").astype("M8[us]"), seconds - 86_400.0
    time = epoch + np.rint(seconds * 1e3).astype("m8[ms]")
    serial = re.search(r"(?m)^\* (?:Temperature|Conductivity) SN = (\S+)", head)
    return _dataset(path, time, columns, serial=serial[1] if serial else "")


def _rbr(path: Path) -> xr.Dataset:
    lines = _lines(path)
    first = sum(1 for line in lines if line.startswith("//") or not line.strip())
    head = next((line for line in lines[:first][::-1] if line.startswith("// timestamp")), "")
    titles = [re.fullmatch(r"\s*(\w+?)\((.*)\)\s*", name) for name in head.split(",")[1:]]
    moments = [line.partition(",")[0].strip() for line in lines[first:]]
    values = _number_rows(path, [line.partition(",")[2] for line in lines], first, len(titles))
    try:
        time = np.array(moments, "M8[us]")
    except ValueError:
        raise refused(path, "has a row without a time", line=first + 1) from None
    of = {one[1]: (one[2], values[:, j]) for j, one in enumerate(titles) if one}
    if "sea_pressure" in of or "pressure" in of:
        # `pressure` of RSKtools includes the pressure of the air
        of["pressure"] = of.get("sea_pressure") or ("dbar", of["pressure"][1] - AIR)
    columns = {
        (name, {"PSU": "1"}.get(unit, "degC" if unit.endswith("°C") else unit)): one
        for name, (unit, one) in of.items()
        if name in ("temperature", "conductivity", "salinity", "pressure")
    }
    serial = re.search(r"(?m)serialID: .* (\d+)$", "\n".join(lines[:first]))
    return _dataset(path, time, columns, serial=serial[1] if serial else "")


_IN_TABLES = {
    "temperature": "degC",
    "salinity": "1",
    "pressure": "Pa",
    "length": "m",
    "speed": "m/s",
}


def read_plain_table(path: Path) -> xr.Dataset:
    """Read a table over time of one instrument, with columns such as ``temperature[degC]``.

    Raise InputError if the table has mistakes, or a column for an unknown quantity.
    """
    table = read_time_columns(path, tuple(_IN_TABLES), "temperature[degC]")
    names = {archive: what for what, (archive, _) in _WHAT.items()}
    columns = {}
    for label, dimension, values in zip(table.names, table.dimensions, table.values.T, strict=True):
        what = names.get(label, label)
        if what not in _WHAT:
            raise refused(path, unknown(f"no column is called `{label}`", label, _WHAT), line=1)
        columns[what, _IN_TABLES[dimension]] = values
    return _dataset(path, table.time.astype("M8[us]"), columns)


def _number_rows(path: Path, lines: Sequence[str], first: int, count: int) -> Floats:
    there = [i for i in range(first, len(lines)) if lines[i].strip()]
    rows, problems = [], []
    for i in there:
        named = f"the header names {count} columns"
        try:
            rows.append([float(word) for word in lines[i].replace(",", " ").split()])
            wrong = f"the row has {len(rows[-1])} numbers; {named}"
        except ValueError:
            rows.append([])
            wrong = f"is not a row of numbers; {named}"
        if len(rows[-1]) != count:
            problems.append(Problem(str(path), i + 1, 1, wrong))
    widths = {len(row) for row in rows}
    if len(problems) == len(rows) > 1 and len(widths) == 1 and widths != {0}:
        wrong = f"the header names {count} columns, but every row has {widths.pop()} numbers"
        raise refused(path, wrong, line=there[0] + 1)
    if problems or not rows:
        raise InputError(problems[:20] or [Problem(str(path), first, 1, "has no rows")])
    values = np.array(rows, np.float64)
    values[np.isin(values, _MISSING)] = np.nan
    return values
