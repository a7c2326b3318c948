"""Options for reading currents, choice of a time, and limits of plausible values."""

import re
from dataclasses import dataclass
from datetime import UTC, datetime
from math import hypot, inf, isinf

import numpy as np
from numpy.typing import NDArray

Place = tuple[float, float]
"""Latitude and longitude [degrees north, degrees east]."""

DEEPEST = 11_000.0
"""Depth that no sea exceeds [m]."""

IMPOSSIBLE = (
    "the speed is infinite or negative, or the direction is outside -360 to 360°; is the number a "
    "fill value, or in another unit?"
)
"""Message of `too_fast` for an infinite speed."""


@dataclass(frozen=True)
class Terms:
    """Options for reading the currents of a file.

    Attributes
    ----------
    water_depth : water depth [m], to convert heights above the seabed; inf if unknown
    place : position of the mooring; of a gridded file, the nearest column is read
    declination : magnetic declination [degrees], positive to the east, for rotation to true north
    maximum_speed : speed [m/s] above which a current is a mistake
    on_the_line : whether the file holds instruments on a mooring line. If so, levels may have
        labels of parts of the line instead of depths, and bad currents keep their flags
    """

    water_depth: float = inf
    place: Place | None = None
    declination: float | None = None
    maximum_speed: float = inf
    on_the_line: bool = False


def too_fast(u: float, v: float, w: float, maximum_speed: float) -> str | None:
    """Return a message if the speed of a current exceeds the maximum plausible speed, else None.

    Parameters
    ----------
    u, v, w : components of the current [m/s]
    maximum_speed : maximum plausible speed [m/s]
    """
    speed = hypot(u, v, w)
    if isinf(speed):
        return IMPOSSIBLE
    if not speed > maximum_speed:
        return None
    return (
        f"{speed:.5g} m/s is faster than `maximum_speed`, {maximum_speed:g} m/s; is it a fill "
        "value, or in another unit? If it is correct, raise `maximum_speed` of the environment"
    )


def too_deep(depth: float) -> str | None:
    """Return a message if a depth [m] exceeds `DEEPEST`, else None."""
    if not depth > DEEPEST:
        return None
    return f"depth {depth:g} m exceeds the greatest depth of any sea, {DEEPEST:g} m"


ZONES_OF_UTC = ("UTC", "GMT", "Z", "ZULU", "UTC+0", "UTC+00:00", "+00:00", "ETC/UTC")
"""Names of time zones equivalent to UTC, in capitals."""


_PART_OF_HOUR = re.compile(r"[^\d.,:]\d\d(?::?\d\d)?[.,]")
"""Decimal point after hours or minutes, as in `06.30`, which `fromisoformat` reads as 0.3 s."""


YEARS = 1678, 2261
"""First and last year in which times can be counted in nanoseconds from 1970."""


class TimeChoiceError(ValueError):
    """Error raised if a requested time is invalid or outside the record, or is not given."""


def parse_time(text: str) -> np.datetime64:
    """Parse an ISO 8601 time to datetime64[us]; a time without a zone is UTC.

    Raise TimeChoiceError if the text is not a valid time, or not in the years of `YEARS`.
    """
    try:
        if _PART_OF_HOUR.search(text):
            raise ValueError
        time = datetime.fromisoformat(text.strip())
    except ValueError:
        raise TimeChoiceError(f"`{text[:40]}` is not a time; write 2026-03-01T06:00") from None
    if not YEARS[0] <= time.year <= YEARS[1]:
        raise TimeChoiceError(f"`{text[:40]}` is not in the years {YEARS[0]} to {YEARS[1]}")
    return np.datetime64(time if time.tzinfo is None else time.astimezone(UTC).replace(tzinfo=None))


def time_text(time: np.datetime64) -> str:
    """Format a time for display."""
    text: str = np.datetime_as_string(time.astype("datetime64[s]"))
    return text.removesuffix(":00")


def choose_time(times: NDArray[np.datetime64], wanted: str | None) -> tuple[int, str | None]:
    """Return the index of the time nearest to a requested time, and a notice if the times differ.

    Raise TimeChoiceError if the file has no times, if the requested time is outside the record, or
    if the nearest time occurs twice. Raise it also if no time is requested, but the file has
    several times.
    """
    if not len(times):
        raise TimeChoiceError("the file has no times")
    first, last = times.min(), times.max()
    span = f"{time_text(first)} to {time_text(last)}"
    if wanted is None:
        if len(times) == 1:
            return 0, None
        raise TimeChoiceError(
            f"the file has {len(times)} time steps, {span}; choose one with `time:`"
        )
    moment = parse_time(wanted)
    if not first.astype("datetime64[s]") <= moment <= last:
        raise TimeChoiceError(f"{time_text(moment)} is outside the record, {span}")
    index = int(np.abs(times - moment).argmin())
    if np.count_nonzero(times == times[index]) > 1:
        raise TimeChoiceError(
            f"two profiles in the file have the time {time_text(times[index])}; remove one of them"
        )
    if times[index] == moment:
        return index, None
    used = f"the current at {time_text(times[index])} is used"
    return index, f"the file has no current at {time_text(moment)}; {used}"
