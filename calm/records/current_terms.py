"""Terms on which a person wants currents taken, at which time, and what cannot be had."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from math import hypot, inf, isinf, pi

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats
from calm.quantities import say

Place = tuple[float, float]
"""Latitude and longitude [degrees north, degrees east]."""

DEEPEST = 11_000.0
"""Depth that no sea exceeds [m]."""

IMPOSSIBLE = (
    "an infinite or negative speed, or a direction outside -360 to 360°: a fill value, or "
    "another unit?"
)
"""What is said of a current whose speed is infinite in `too_fast`."""


@dataclass(frozen=True)
class Terms:
    """Describe how a person wants the currents of a file to be taken.

    Attributes
    ----------
    water_depth : places heights above the seabed [m]; inf where it is not known
    place : whose column is wanted, where a file holds several
    declination : of magnetic north from true north, positive to the east [degrees]; turns what
        the file says is magnetic
    maximum_speed : a faster current is a mistake of the file [m/s]
    on_the_line : whether levels may be parts of a line by their labels, and currents that the file
        flags as bad are kept with their flags; these are left out otherwise
    """

    water_depth: float = inf
    place: Place | None = None
    declination: float | None = None
    maximum_speed: float = inf
    on_the_line: bool = False


def too_fast(u: float, v: float, w: float, maximum_speed: float) -> str | None:
    """Return what is wrong with a current beyond the greatest plausible speed; None if nothing is.

    Parameters
    ----------
    u, v, w : [m/s]
    """
    speed = hypot(u, v, w)
    if isinf(speed):
        return IMPOSSIBLE
    if not speed > maximum_speed:
        return None
    return (
        f"{speed:.5g} m/s is faster than `maximum_speed`, {maximum_speed:g} m/s: a fill value, or "
        "another unit? (`maximum_speed` of the environment allows it if it is true)"
    )


def too_deep(depth: float) -> str | None:
    """Return what is wrong with a depth [m] below that of any sea; None if it is not."""
    if not depth > DEEPEST:
        return None
    return f"depth {depth:g} m is deeper than any sea, {DEEPEST:g} m"


ZONES_OF_UTC = ("UTC", "GMT", "Z", "ZULU", "UTC+0", "UTC+00:00", "+00:00", "ETC/UTC")
"""What a zone is called that is no other than UTC, in capitals."""


_PART_OF_HOUR = re.compile(r"[^\d.,:]\d\d(?::?\d\d)?[.,]")
"""A point after hours or minutes, as in `06.30`, of which `fromisoformat` makes 0.3 seconds."""


class TimeChoiceError(ValueError):
    """The time asked for is none, is not in the record, or is needed and not given."""


def parse_time(text: str) -> np.datetime64:
    """Return an ISO 8601 time in UTC [µs], in which it is taken where it names no zone.

    TimeChoiceError: the text is no such time.
    """
    try:
        if _PART_OF_HOUR.search(text):
            raise ValueError
        time = datetime.fromisoformat(text.strip())
    except ValueError:
        raise TimeChoiceError(f"`{text[:40]}` is not a time; write 2026-03-01T06:00") from None
    return np.datetime64(time if time.tzinfo is None else time.astimezone(UTC).replace(tzinfo=None))


def time_text(time: np.datetime64) -> str:
    """Return a time as a person reads it."""
    text: str = np.datetime_as_string(time.astype("datetime64[s]"))
    return text.removesuffix(":00")


def choose_time(times: NDArray[np.datetime64], wanted: str | None) -> tuple[int, str | None]:
    """Return the index of the time nearest to the one wanted, and a notice where it is another.

    TimeChoiceError: there is no time to choose from, several and none is wanted, or all lie to one
    side.
    """
    if not len(times):
        raise TimeChoiceError("the file has no times")
    first, last = times.min(), times.max()
    span = f"{time_text(first)} to {time_text(last)}"
    if wanted is None:
        if len(times) == 1:
            return 0, None
        raise TimeChoiceError(f"the file has {len(times)} times, {span}; give `time:`")
    moment = parse_time(wanted)
    if not first.astype("datetime64[s]") <= moment <= last:
        raise TimeChoiceError(f"{time_text(moment)} is outside the record, {span}")
    index = int(np.abs(times - moment).argmin())
    if times[index] == moment:
        return index, None
    nearest = f"{time_text(times[index])}, nearest to {time_text(moment)}"
    return index, f"the current is that of {nearest}"


FAR_APART = np.timedelta64(12, "h")
"""Between profiles so far apart the tide and its peaks are lost."""

_FEWEST = 4  # values of which it is no chance that they are alike
_MANY = 50  # currents of which one component is not 0 by chance
_MOST = 0.5  # share of profiles like the one before that is said
_ZEROS = 0.25  # share of zeros that is said
_TURN = 2.0 * pi  # in radians; no current stays within so many degrees of north
_ALIKE = 0.9  # share of values that are the same in both components
_BEYOND = 1.5  # times all other values: what recurs there is none
_VARIED = 20  # other values of which that is said
_WEAK = 0.01  # m/s that no sea stays below for many profiles
_UNCOVERED = 0.1  # share of the depth that a profile may leave out at either end
_FEW = 25.0  # m of that


def current_notices(
    levels: tuple[Floats, Floats, Floats], times: NDArray[np.datetime64] | None, water_depth: float
) -> Iterator[str]:
    """Yield what is odd about currents, in sentences.

    Parameters
    ----------
    levels : depth, of any shape [m], and u, v (n, k) to the east and to the north, gaps as NaN
        [m/s]
    times : (n,) in their order; None of one profile
    water_depth : [m]; inf where it is not known
    """
    depth, u, v = levels
    there = depth[np.isfinite(depth) & (depth >= 0.0)]
    if there.size and (missing := left_out(there.min(), there.max(), water_depth)):
        yield missing
    known = np.isfinite(u) & np.isfinite(v)
    count, still = int(known.sum()), known & (u == 0.0) & (v == 0.0)
    moving = known & ~still
    if count and still.sum() > _ZEROS * count:
        yield f"{still.sum()} of {count} currents are exactly 0: was nothing measured there?"
    if moving.sum() >= _FEWEST:
        alike = moving & (np.abs(u) == np.abs(v))
        if alike.sum() > _ALIKE * moving.sum():
            yield (
                f"the currents to the east and to the north are the same in {alike.sum()} of "
                f"{moving.sum()} values: is one a copy of the other?"
            )
    if times is None or not len(times):
        return
    if len(times) > 1:
        step = np.median(np.diff(np.sort(times)))
        if step >= FAR_APART:
            yield (
                f"its {len(times)} profiles are {step / np.timedelta64(1, 'h'):.4g} h apart, means "
                "or samples: tides and peaks between them are missing"
            )
    if len(times) >= _FEWEST and moving.any():
        same = ((u[1:] == u[:-1]) & (v[1:] == v[:-1]) | ~known[1:] & ~known[:-1]).all(axis=1)
        same &= moving[1:].any(axis=1)
        if same.sum() > _MOST * (len(times) - 1):
            yield f"{same.sum()} of {len(times)} profiles are the same as the one before"
        else:
            yield from _stuck_levels(u, v)
        towards = np.degrees(np.arctan2(u[moving], v[moving])) % 360.0
        if moving.sum() > _MANY and 1.0 < towards.max() <= _TURN:
            yield (
                f"all {moving.sum()} currents flow towards {towards.min():.2g} to "
                f"{towards.max():.2g} degrees: radians read as degrees?"
            )
        yield from _recurring(u[moving], "east")
        yield from _recurring(v[moving], "north")
        if moving.sum() > _MANY and not (u[moving].any() and v[moving].any()):
            yield f"all {moving.sum()} currents are along one axis, their other component 0"
        strongest = float(np.hypot(u[moving], v[moving]).max())
        if strongest < _WEAK:
            yield (
                f"the strongest of {count} currents is {strongest:.2g} m/s: cm/s or another unit "
                "read as m/s?"
            )


def _recurring(values: Floats, side: str) -> Iterator[str]:
    """Yield that one value recurs beyond all others, as what fills a gap does [m/s]."""
    largest = np.abs(values).max()
    filled = np.abs(values) == largest
    others = values[~filled]
    beyond = largest > _BEYOND * np.abs(others).max(initial=0.0)
    if beyond and filled.sum() >= _FEWEST and np.unique(others).size >= _VARIED:
        yield (
            f"{filled.sum()} of {values.size} currents to the {side} are "
            f"{values[filled][0]:.5g} m/s, far beyond all others: a fill value?"
        )


def _stuck_levels(u: Floats, v: Floats) -> Iterator[str]:
    """Yield how many levels, of several, have the same current at nearly all times."""
    known = np.isfinite(u[1:]) & np.isfinite(v[1:])
    same = (u[1:] == u[:-1]) & (v[1:] == v[:-1])
    count = known.sum(axis=0)
    stuck = (count >= _FEWEST) & (same.sum(axis=0) > _ALIKE * count)
    if 0 < stuck.sum() < stuck.size:
        yield (
            f"{stuck.sum()} of {stuck.size} levels have the same current throughout: level "
            f"{int(np.argmax(stuck)) + 1} from the first on"
        )


def left_out(top: float, bottom: float, water_depth: float, what: str = "current") -> str:
    """Return which part of the water a profile says nothing of; "" where it covers it.

    Parameters
    ----------
    top, bottom : its first and its last level [m]
    water_depth : [m]; inf where it is not known
    what : it is a profile of
    """
    allowed = max(_UNCOVERED * water_depth, _FEW)
    gaps = [f"above {say('depth', top)}"] if top > allowed else []
    if allowed < water_depth - bottom < inf:
        gaps.append(f"below {say('depth', bottom)}")
    if not gaps:
        return ""
    return (
        f"the {what} is not given {' and '.join(gaps)}: the value of the nearest level is "
        f"used there, in {say('depth', water_depth)} of water"
    )
