"""Records of currents in NetCDF, zarr or CSV, with many profiles that are read lazily.

The module also makes a synthetic example record of thirty days.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from calm.errors import UsageError, refused
from calm.physics.line import Floats
from calm.positions import plain_degrees
from calm.records.card import ReadCard
from calm.records.current_terms import Place, TimeChoiceError, parse_time, time_text

Times = NDArray[np.datetime64]
Index = slice | NDArray[np.intp]

Period = tuple[np.datetime64 | None, np.datetime64 | None]
"""First and last time, both included; None for an open end."""

REACH = "1678-01-01", "2261-12-31T23:59:59.999999"
"""Earliest and latest time of a record."""

_PART_OF_A_DATE = re.compile(r"\d{4}(-\d\d(-\d\d)?)?")

Levels = tuple[Floats, Floats, Floats, Floats | None]
"""Depth, u, v and w of profiles, with the shapes that `Record.profiles` returns."""

RULES = (
    "levels without a current or a depth are excluded from their profile",
    "levels above the surface are excluded",
    "levels below the seabed that have a value are used to interpolate the current at the seabed",
    "the current is linear in depth between levels, and constant above the first and below the "
    "last",
)
"""Rules that apply to every record."""


class Record(ABC):
    """The selected profiles of a record, in order of time.

    A record must be used in one thread at a time, and closed.

    Attributes
    ----------
    time : (n,) increasing times
    notes : rules of reading, and doubts
    source : names of the file and of the variables, and the position
    cards : summary card of each file
    labels : parts of a line that carry the instruments, if the levels have no depths; else empty
    """

    time: NDArray[np.datetime64]
    notes: tuple[str, ...]
    source: dict[str, str]
    cards: tuple[ReadCard, ...] = ()
    labels: tuple[str, ...] = ()

    @property
    def count(self) -> int:
        """Number of profiles."""
        return len(self.time)

    @abstractmethod
    def profiles(self, start: int, stop: int) -> Levels:
        """Return the depths and velocities of the m profiles from `start` to `stop`.

        Depths [m], (k,) or (m, k), are positive down, in any order. u, v and w [m/s], each (m, k),
        are NaN in gaps. w is None without vertical velocity. Raise InputError if the file is
        damaged.
        """

    def flags(self, start: int, stop: int) -> NDArray[np.int8] | None:
        """Return quality flags (m, k) of profiles `start` to `stop`; None if there are no flags."""
        return None

    @abstractmethod
    def close(self) -> None:
        """Close the file."""

    def __enter__(self) -> Record:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


def parse_period(text: str) -> Period:
    """Parse a period ``A/B`` of ISO 8601 times.

    If B is a year, a month or a day, the period includes it completely. Either end may be open, as
    in ``2026-03/`` or ``../2026-03-31``. Raise UsageError if the period is invalid.
    """
    first, slash, last = text.partition("/")
    if not slash:
        raise UsageError(f"`{text[:40]}` is not a period; write 2026-03-01/2026-03-31T12:00")
    start, stop = _end_of_period(first, whole=False), _end_of_period(last, whole=True)
    if start is not None and stop is not None and stop < start:
        raise UsageError(f"the period `{text[:60]}` ends before it begins")
    return start, stop


def parse_place(text: str) -> Place:
    """Parse a position ``LAT,LON`` [degrees north, degrees east].

    Each coordinate may be in degrees and minutes, as in ``57 28.84 N, 19 10.2 W``. Raise UsageError
    if the text is not a position.
    """
    parts = text.split(",")
    try:
        first, second = parts
        latitude, longitude = plain_degrees(first, "latitude"), plain_degrees(second, "longitude")
    except ValueError:
        raise UsageError(f"`{text[:40]}` is not a position; write 48.3,-5.2") from None
    if not (-90 <= latitude <= 90 and -360 <= longitude <= 360):
        raise UsageError(f"`{text[:40]}` is not a position; latitude must be first, then longitude")
    return latitude, longitude


def choose_profiles(
    times: Times, period: Period | None, every: int, path: Path
) -> tuple[Index, tuple[str, ...]]:
    """Return the indices of the profiles to read, in order of time, and notices on the choice.

    `times` (n,) are in file order. `period` is None for all times. If `every` is n, every n-th
    profile is read.

    Raises
    ------
    InputError
        The record has no times, or repeats a time.
    UsageError
        No profile is in the period, or `every` is not positive.
    """
    if every < 1:
        raise UsageError(f"`every` is {every}; it must be at least 1")
    if not len(times):
        raise refused(path, "has no times")
    notes = []
    order: NDArray[np.intp] | None = None
    if np.any(times[1:] < times[:-1]):
        order = np.argsort(times, kind="stable")
        notes.append("the profiles were not in the order of time, and have been sorted")
        times = times[order]
    again = np.flatnonzero(times[1:] == times[:-1])
    if len(again):
        more = f", and at {len(again) - 1} more times" if len(again) > 1 else ""
        message = f"has two profiles at {time_text(times[again[0]])}{more}; remove the duplicates"
        raise refused(path, message)
    start, stop = period or (None, None)
    first = 0 if start is None else int(np.searchsorted(times, start, "left"))
    last = len(times) if stop is None else int(np.searchsorted(times, stop, "right"))
    if first >= last:
        span = f"{time_text(times[0])} to {time_text(times[-1])}"
        raise UsageError(f"{path} has no profile in this period: the profiles are from {span}")
    if last - first < len(times):
        notes.append(f"{last - first} of the {len(times)} profiles are in the requested period")
    chosen = slice(first, last, every)
    if every > 1:
        notes.append(f"one profile in {every} is used, beginning with the first")
    return (chosen if order is None else order[chosen]), tuple(notes)


def part(index: Index, start: int, stop: int) -> Index:
    """Return the file indices of the chosen profiles from number `start` to number `stop`.

    Parameters
    ----------
    index : file indices of all chosen profiles, from `choose_profiles`
    start, stop : numbers of chosen profiles, counted from 0; `stop` is excluded
    """
    if not isinstance(index, slice):
        return index[start:stop]
    return slice(index.start + start * index.step, index.start + stop * index.step, index.step)


def _end_of_period(text: str, *, whole: bool) -> np.datetime64 | None:
    text = text.strip()
    if text in ("", ".."):
        return None
    try:
        if _PART_OF_A_DATE.fullmatch(text):
            date: Any = np.datetime64(text) + int(whole)  # adds one year, month or day
            return _within_reach(date.astype("M8[us]")) - np.timedelta64(int(whole), "ns")
        return _within_reach(parse_time(text))
    except TimeChoiceError as error:
        raise UsageError(str(error)) from None
    except ValueError:
        raise UsageError(f"`{text}` is not a date") from None


def _within_reach(moment: np.datetime64) -> np.datetime64:
    first, last = (np.datetime64(end, "us") for end in REACH)
    near: Any = min(max(moment, first), last)
    return np.datetime64(near, "ns")


DAYS = 30
DEPTHS = (4.0, 12.0, 24.0, 40.0, 60.0, 90.0, 130.0, 180.0, 230.0, 290.0)
"""Depths of the levels [m], for a water depth of 300 m."""

START = "2026-03-01T00:00:00"
LATITUDE, LONGITUDE = 48.3, -5.2

RESOLUTION = 1e-3
"""Resolution of the currents [m/s].

The currents are rounded, because platforms compute slightly different sines.
"""

_SEABED = 300.0
# period [h], to the east and to the north [m/s], phase [degrees]; M2, S2, K1
_TIDE = ((12.4206, 0.17, 0.05, 40.0), (12.0, 0.06, 0.02, 75.0), (23.9345, 0.03, 0.02, 10.0))
_MEAN = (0.12, 0.05, 120.0)  # to the east and to the north at the surface [m/s], fading in [m]
_SURGE = (0.40, -0.15, 150.0)
_SURGE_DAY, _SURGE_LENGTH = 18.5, 0.8  # middle and width [days]
_MISSING = -32767


def made_record() -> bytes:
    """Return a synthetic record as a classic NetCDF file.

    The bytes are the same on all platforms.
    """
    import xarray as xr

    hours = np.arange(24 * DAYS)
    currents = [
        (
            ("time", "depth"),
            np.rint(values / RESOLUTION).astype(np.int16),
            {
                "standard_name": f"{side}ward_sea_water_velocity",
                "long_name": f"{side}ward velocity of the current",
                "units": "m s-1",
                "scale_factor": RESOLUTION,
                "_FillValue": np.int16(_MISSING),
                "coordinates": "latitude longitude",
            },
        )
        for side, values in zip(("east", "north"), _currents(hours), strict=True)
    ]
    dataset = xr.Dataset(
        {"u": currents[0], "v": currents[1]},
        {
            "time": ("time", hours.astype(np.int32), _named("time", f"hours since {START}", "T")),
            "depth": ("depth", np.array(DEPTHS), {**_named("depth", "m", "Z"), "positive": "down"}),
            "latitude": ((), LATITUDE, _named("latitude", "degrees_north")),
            "longitude": ((), LONGITUDE, _named("longitude", "degrees_east")),
        },
        {
            "Conventions": "CF-1.11",
            "title": "A synthetic record of currents: a tide, a mean flow and a storm surge",
            "comment": "Computed from a formula, not measured.",
        },
    )
    dataset["time"].attrs["calendar"] = "standard"
    for name in ("depth", "latitude", "longitude"):
        dataset[name].encoding["_FillValue"] = None
    return bytes(dataset.to_netcdf(engine="scipy"))


def _currents(hours: Any) -> tuple[Any, Any]:
    """Return the eastward and northward currents, each (times, levels) [m/s]."""
    hours = hours[:, np.newaxis].astype(np.float64)
    depth = np.array(DEPTHS)
    # slower near the seabed: 1/7 power law of the height
    friction = ((_SEABED - depth) / _SEABED) ** (1 / 7)
    east, north = (speed * np.exp(-depth / _MEAN[2]) for speed in _MEAN[:2])
    surge = np.exp(-(((hours / 24 - _SURGE_DAY) / _SURGE_LENGTH) ** 2) / 2 - depth / _SURGE[2])
    east, north = east + _SURGE[0] * surge, north + _SURGE[1] * surge
    for period, major, minor, phase in _TIDE:
        angle = 2 * np.pi * hours / period - np.radians(phase)
        east = east + major * friction * np.cos(angle)
        north = north + minor * friction * np.sin(angle)
    return east, north


def _named(standard_name: str, units: str, axis: str | None = None) -> dict[str, str]:
    named = {"standard_name": standard_name, "units": units}
    return named if axis is None else {**named, "axis": axis}
