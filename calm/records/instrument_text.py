"""Text files of one instrument, as the lines of the table that they are.

RODB files, `.use`, `.microcat` and `.rcm` of RAPID and OSNAP, have lines ``Name = value`` above
columns in known units. Sea-Bird's `.cnv` files name each column, with its unit, in their head.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from calm.errors import InputError, Problem
from calm.physics.line import Floats
from calm.positions import plain_degrees
from calm.whole_file import read_content

LARGEST = 500_000_000
"""Largest file that is read [bytes]."""

_HEAD = 100_000  # bytes in which a head ends
_RODB = {
    "T": "temperature[degC]", "C": "conductivity[mS/cm]", "P": "pressure[dbar]",
    "U": "u[cm/s]", "V": "v[cm/s]", "W": "w[cm/s]", "Z": "depth[m]",
}  # fmt: skip
_DATE = ("YY", "MM", "DD", "HH")
_PAIR = re.compile(r"\s*(\w+)\s*=\s*(.*?)\s*$")
_CNV_NAME = re.compile(r"# name (\d+) = (\S+?):\s*(.*?)\s*$")
_CNV_UNIT = re.compile(r"\[(?:.*,\s*)?([^\[\],]+)\]\s*$")
_CNV = (
    (r"pr\w*", "pressure", {"db": "dbar", "dbar": "dbar", "psi": "psi", "psia": "psi"}),
    (r"dep[SF]\w*", "depth", {"m": "m", "ft": "ft"}),
    (r"(t|tv)\d*(68|90)\w*", "temperature", {"deg C": "degC"}),
    (r"sal\w*", "salinity", {"PSU": "PSU"}),
)  # fmt: skip
_CNV_TIMES = {
    "timeJ": 86_400.0, "timeJV2": 86_400.0, "timeK": 1.0, "timeY": 1.0,
    "timeS": 1.0, "timeM": 60.0, "timeH": 3600.0,
}  # fmt: skip
_CNV_EPOCHS = {"timeK": "2000-01-01", "timeY": "1970-01-01"}
_MISSING = (-9999.0, -999.0, -99.999, -9.99e-29, 1e35)


@dataclass(frozen=True)
class InstrumentText:
    """Hold the columns of a file of one instrument.

    Attributes
    ----------
    path : of the file
    time : (n,) to the microsecond
    columns : (n,) by their headings, ``pressure[dbar]``, as they stand; NaN where missing
    line : (n,) number of the line of each row
    nominal : depth where it was meant to hang [m]; NaN where the file does not say
    latitude : [degrees]; NaN where the file does not say
    serial : number of the instrument; empty where the file does not say
    """

    path: Path
    time: NDArray[np.datetime64]
    columns: dict[str, Floats]
    line: NDArray[np.intp]
    nominal: float
    latitude: float
    serial: str

    def lines(self, names: Sequence[str]) -> Iterator[tuple[int, str]]:
        """Yield the numbered lines of a table of the time and some of the columns, by their name.

        A depth that has no column of its own is that of the pressure, by TEOS-10, or the nominal
        one. InputError: the file has none of them.
        """
        known = {heading.partition("[")[0]: heading for heading in self.columns}
        chosen = {known[name]: self.columns[known[name]] for name in names if name in known}
        if "depth" in names and "depth" not in known:
            chosen = {"depth[m]": self._depths(known), **chosen}
        if not set(names) & known.keys():
            has = ", ".join(known) or "nothing that is known"
            raise _refused(self.path, 0, f"holds no {' or '.join(names)}; it has {has}")
        yield 1, ",".join(["time", *chosen])
        moments = np.datetime_as_string(self.time)
        for number, moment, row in zip(
            self.line.tolist(), moments.tolist(), np.column_stack([*chosen.values()]), strict=True
        ):
            yield number, ",".join([moment, *(f"{value:.10g}" for value in row.tolist())])

    def _depths(self, known: dict[str, str]) -> Floats:
        """Return depths [m] of the pressures, and the nominal one where there is none."""
        import gsw

        nominal = np.full(len(self.time), self.nominal)
        if known.get("pressure") != "pressure[dbar]":
            return nominal
        latitude = 45.0 if np.isnan(self.latitude) else self.latitude
        depth = -gsw.z_from_p(self.columns["pressure[dbar]"], latitude)
        return np.maximum(np.where(np.isnan(depth), nominal, depth), 0.0)


def read_instrument_text(path: Path) -> InstrumentText | None:
    """Return what a text file of an instrument holds; None where it is none of a known format.

    InputError: it cannot be read, has no times, or a row that is none.
    """
    with path.open("rb") as file:
        head = file.read(_HEAD).decode("latin-1")
    if head.startswith("* Sea-Bird") or re.search(r"(?m)^# nquan\s*=", head):
        return _cnv(path)
    if re.search(r"(?mi)^\s*columns\s*=\s*\w+(:\w+)+\s*$", head):
        return _rodb(path)
    return None


def _lines(path: Path) -> list[str]:
    return read_content(path, largest=LARGEST).decode("latin-1").splitlines()


def _rodb(path: Path) -> InstrumentText:
    lines = _lines(path)
    said: dict[str, str] = {}
    first = 0
    while first < len(lines) and (not lines[first].strip() or "=" in lines[first]):
        if found := _PAIR.match(lines[first]):
            said[found[1].lower()] = found[2]
        first += 1
    names = said["columns"].upper().split(":")
    if not set(_DATE[:3]) <= set(names):
        raise _refused(path, first, "its `Columns` have no YY, MM and DD")
    line, values = _numbers(path, lines, first, len(names))
    of = dict(zip(names, values.T, strict=True))
    year, month, day = (of[name].astype(np.int64) for name in _DATE[:3])
    months = (year - 1970).astype("M8[Y]").astype("M8[M]") + (month - 1)
    seconds = np.rint(of.get("HH", np.zeros(len(line))) * 3600.0)  # it has five digits
    time = months.astype("M8[us]") + (day - 1) * np.timedelta64(1, "D")
    columns = {_RODB[name]: of[name] for name in names if name in _RODB}
    latitude = said.get("latitude", "nan")
    try:
        return InstrumentText(
            path, time + seconds.astype("m8[s]"), columns, line,
            float(said.get("instrdepth", "nan")), plain_degrees(latitude, "latitude"),
            said.get("serialnumber", ""),
        )  # fmt: skip
    except ValueError:
        raise _refused(path, 0, "its `InstrDepth` or `Latitude` is no number") from None


def _cnv(path: Path) -> InstrumentText:
    lines = _lines(path)
    first = next((i for i, line in enumerate(lines) if line.startswith("*END*")), -1) + 1
    head = "\n".join(lines[:first])
    names = {int(one[1]): (one[2], one[3]) for one in map(_CNV_NAME.match, lines[:first]) if one}
    if not names:
        raise _refused(path, 0, "its head names no columns")
    line, values = _numbers(path, lines, first, len(names))
    columns: dict[str, Floats] = {}
    for j, (name, told) in names.items():
        unit = _CNV_UNIT.search(told)
        for pattern, what, units in _CNV:
            if re.fullmatch(pattern, name) and unit is not None and unit[1] in units:
                columns.setdefault(f"{what}[{units[unit[1]]}]", values[:, j])
    bad = next((values[:, j] for j, (name, _) in names.items() if name == "flag"), None)
    if bad is not None:
        columns = {name: np.where(bad == 0.0, one, np.nan) for name, one in columns.items()}
    clock = next(((j, name) for j, (name, _) in names.items() if name in _CNV_TIMES), None)
    start = re.search(r"(?m)^# start_time = (\w{3} \d+ \d{4}(?: [\d:]+)?)", head)
    if clock is None or (start is None and clock[1] not in _CNV_EPOCHS):
        raise _refused(path, 0, f"has no times: none of {', '.join(_CNV_TIMES)}, or no start_time")
    latitude = re.search(r"(?mi)^\** *latitude\s*[:=]\s*(.+?)\s*$", head)
    try:
        degrees = plain_degrees(latitude[1], "latitude") if latitude else float("nan")
    except ValueError:
        degrees = float("nan")
    seconds = values[:, clock[0]] * _CNV_TIMES[clock[1]]
    if clock[1] in _CNV_EPOCHS:
        epoch = np.datetime64(_CNV_EPOCHS[clock[1]], "us")
    else:
        from datetime import datetime

        assert start is not None
        text = start[1] if ":" in start[1] else f"{start[1]} 00:00:00"
        epoch = np.datetime64(datetime.strptime(text, "%b %d %Y %H:%M:%S"), "us")
        if clock[1].startswith("timeJ"):  # days of the year, its first being 1
            epoch, seconds = epoch.astype("M8[Y]").astype("M8[us]"), seconds - 86_400.0
    time = epoch + np.rint(seconds * 1e3).astype("m8[ms]")
    serial = re.search(r"(?m)^\* (?:Temperature|Conductivity) SN = (\S+)", head)
    return InstrumentText(
        path, time, columns, line, float("nan"), degrees, serial[1] if serial else ""
    )


def _numbers(
    path: Path, lines: Sequence[str], first: int, count: int
) -> tuple[NDArray[np.intp], Floats]:
    """Return the numbers of the lines that have any, and their `count` columns."""
    there = [i for i in range(first, len(lines)) if lines[i].strip()]
    rows, problems = [], []
    for i in there:
        try:
            rows.append([float(word) for word in lines[i].replace(",", " ").split()])
        except ValueError:
            rows.append([])
        if len(rows[-1]) != count:
            problems.append(Problem(str(path), i + 1, 1, f"is no row of {count} numbers"))
    if problems or not rows:
        raise InputError(problems[:20] or [Problem(str(path), first, 1, "has no rows")])
    values = np.array(rows, np.float64)
    values[np.isin(values, _MISSING)] = np.nan
    return np.array(there, np.intp) + 1, values


def _refused(path: Path, line: int, message: str) -> InputError:
    return InputError([Problem(str(path), line, 1 if line else 0, message)])
