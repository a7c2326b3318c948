"""Tests that report suspicious measured values as sentences.

The tests neither exclude nor reject values.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from math import inf

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats
from calm.quantities import say
from calm.records.current_terms import time_text
from calm.records.profile_doubts import strength_doubts
from calm.units import KNOT

Times = NDArray[np.datetime64]

UNCOVERED, FEW = 0.1, 25.0
"""Tolerance for the depths of levels, as a fraction of the water depth and as a length [m].

The larger of the two lengths applies. A profile may omit this length at its upper and lower end,
and a level may be this far below the seabed.
"""
WEAK = 0.03
"""Speed [m/s] that the strongest current of every record exceeds."""
MANY = 50
"""Least number of values for which a pattern in the values is not a coincidence."""
SECTOR = 40.0
"""Angle [degrees]: directions that all lie between north and this angle are probably in radians, or
in tens of degrees.
"""
UNCHANGED = 0.1
"""Fraction of a record. A constant value, or gaps, over a larger fraction are reported."""
_FEWEST = 6  # least number of equal readings for a doubt
_STRETCH = 24  # readings of a repeated stretch
_SLOWEST = np.timedelta64(3, "h")  # at longer steps, a tide looks like two interleaved series
_BEYOND, _VARIED, _RECURS = 1.5, 20, 4  # fill value: ratio to the others, distinct others, repeats
_DAY = np.timedelta64(1, "D")
_FIRST_YEAR = 1950
_UNITS = {"m/s": 1.0, "cm/s": 0.01, "mm/s": 0.001, "kn": KNOT}
_FEET = 0.3048


@dataclass(frozen=True)
class CurrentValues:
    """Currents of a record: n profiles with k levels.

    Attributes
    ----------
    depth : (k,) or (n, k) depths [m]; NaN if unknown
    u, v : (n, k) eastward and northward components [m/s]; NaN in gaps
    times : (n,) increasing times; None for a single profile
    water_depth : water depth [m]; inf if unknown
    unit, factor : declared unit of speed, and the factor to m/s
    good : (n, k) share of good pings, if known
    """

    depth: Floats
    u: Floats
    v: Floats
    times: Times | None
    water_depth: float = inf
    unit: str = "m/s"
    factor: float = 1.0
    good: Floats | None = None


def current_doubts(found: CurrentValues) -> Iterator[str]:
    """Yield a message for each doubt about the values of a current."""
    known = np.isfinite(found.u) & np.isfinite(found.v)
    yield from level_doubts(found.depth, known, found.water_depth)
    speed = np.where(known, np.hypot(found.u, found.v), 0.0)
    yield from speed_doubts(speed[known], found.unit, found.factor)
    levels = _levels(found.depth, known)
    there = np.isfinite(levels) & known.any(axis=0)
    yield from strength_doubts(levels[there], speed.max(axis=0)[there], found.water_depth)
    yield from sector_doubts(found.u[known], found.v[known])
    for values, side in ((found.u[known], "east"), (found.v[known], "north")):
        yield from _recurring_extremes(values, side)
    yield from _component_doubts(found.u, found.v)
    if found.good is not None:
        poor = known & (found.good < 0.5)
        if poor.any():
            yield (
                f"for {poor.sum()} of {known.sum()} currents, less than half of the pings are good"
            )
    if found.times is not None:
        order = np.argsort(levels[there], kind="stable")
        at = np.flatnonzero(there)[order]
        yield from _turned_levels(levels[at], found.u[:, at] + 1j * found.v[:, at])
        yield from _equal_levels(found.u[:, at], found.v[:, at])
        names = _level_names(found.depth)
        yield from series_doubts(np.stack([found.u, found.v], axis=2), found.times, names)


def level_doubts(depth: Floats, known: NDArray[np.bool_], water_depth: float) -> Iterator[str]:
    """Report levels below the seabed, levels without values, and depth ranges without levels.

    Depths [m] are (k,) or (n, k); `known` (n, k) masks the values that are present. An unknown
    water depth is inf.
    """
    there, levels = known.any(axis=0), _levels(depth, known)
    allowed = max(UNCOVERED * water_depth, FEW)
    deeper = there & (levels > water_depth + allowed)
    if deeper.any():
        deepest = float(levels[deeper].max())
        in_feet = _FEET * deepest <= water_depth
        feet = f" ({say('depth', _FEET * deepest)}, if these are feet)" if in_feet else ""
        yield (
            f"{deeper.sum()} of {there.sum()} levels with values are deeper than the water, "
            f"{say('depth', water_depth)}: the deepest is at {say('depth', deepest)}{feet}"
        )
    unplaced = int((known & ~np.isfinite(depth)).sum())
    if 0 < unplaced < known.sum():
        yield f"{unplaced} of {known.sum()} currents have no depth and are excluded"
    empty = ~there & (levels >= 0.0) & (levels < water_depth - allowed)
    if empty.any() and there.any() and len(known) > 1:
        yield (
            f"{empty.sum()} of {levels.size} levels above the seabed have no value at any time: "
            f"{levels[empty].min():g} to {levels[empty].max():g} m"
        )
    depth = np.broadcast_to(depth, known.shape)
    used = depth[known & np.isfinite(depth)]
    used = used[used >= 0.0]
    if used.size and (missing := left_out(used.min(), used.max(), water_depth)):
        yield missing


def _levels(depth: Floats, known: NDArray[np.bool_]) -> Floats:
    return np.array([*map(_median, np.broadcast_to(depth, known.shape).T)])


def _median(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else np.nan


def left_out(top: float, bottom: float, water_depth: float, what: str = "current") -> str:
    """Return a message if a profile does not cover the whole water column, else "".

    `top` and `bottom` are the depths of the first and the last level [m]. An unknown water depth is
    inf. `what` is the quantity.
    """
    allowed = max(UNCOVERED * water_depth, FEW)
    gaps = [f"above {say('depth', top)}"] if top > allowed else []
    if allowed < water_depth - bottom < inf:
        gaps.append(f"below {say('depth', bottom)}")
    if not gaps:
        return ""
    return (
        f"the {what} has no level {' or '.join(gaps)}, so the value of the nearest level is "
        f"used there; the water depth is {say('depth', water_depth)}"
    )


def speed_doubts(speed: Floats, unit: str = "m/s", factor: float = 1.0) -> Iterator[str]:
    """Report speeds that are all so small that the declared unit is probably wrong.

    Speeds (n,) are in m/s. `factor` is the factor from the declared unit to m/s.
    """
    strongest = float(speed.max(initial=0.0))
    if speed.size < _VARIED or not 0.0 < strongest < WEAK:
        return
    likely = [
        name for name, size in _UNITS.items()
        if 0.1 < strongest * size / factor < 3.0 and abs(size / factor - 1.0) > 0.1
    ]  # fmt: skip
    meant = f"; are they in {' or '.join(likely)}?" if likely else ""
    yield (
        f"the strongest of {speed.size} currents is {strongest:.2g} m/s in the declared unit, "
        f"{unit}{meant}"
    )


def sector_doubts(u: Floats, v: Floats) -> Iterator[str]:
    """Report currents whose directions are all in a narrow sector that begins at north.

    Parameters
    ----------
    u, v : (n,) eastward and northward components [m/s]
    """
    moving = (u != 0.0) | (v != 0.0)
    if moving.sum() < MANY:
        return
    towards = np.degrees(np.arctan2(u[moving], v[moving])) % 360.0
    if 1.0 < towards.max() <= SECTOR:
        yield (
            f"all {moving.sum()} currents flow towards {towards.min():.2g} to "
            f"{towards.max():.2g} degrees: is the direction in radians, or in tens of degrees?"
        )


def _recurring_extremes(values: Floats, side: str) -> Iterator[str]:
    largest = np.abs(values).max(initial=0.0)
    filled = np.abs(values) == largest
    others = values[~filled]
    beyond = largest > _BEYOND * np.abs(others).max(initial=0.0)
    if beyond and filled.sum() >= _RECURS and np.unique(others).size >= _VARIED:
        yield (
            f"{filled.sum()} of {values.size} {side}ward components of the current are "
            f"{values[filled][0]:.5g} m/s, far beyond all others: is this a fill value?"
        )


def _component_doubts(u: Floats, v: Floats) -> Iterator[str]:
    known = np.isfinite(u) & np.isfinite(v)
    one_alone = int((np.isfinite(u) != np.isfinite(v)).sum())
    if one_alone >= _FEWEST:
        yield f"{one_alone} of {u.size} currents have one component without the other"
    u, v = u[known], v[known]
    speed = np.hypot(u, v)
    moving = speed > 0.0
    if np.unique(u[moving]).size >= _VARIED and (u == v).all():
        yield f"all {u.size} currents have equal components to the east and to the north"
    zeros, smallest = int((~moving).sum()), speed[moving].min(initial=np.inf)
    # rounded currents have 20 nonzero values within 2.5 steps of zero, more common than zero
    if zeros > max(int((speed[moving] <= 2.5 * smallest).sum()), _VARIED):
        yield (
            f"{zeros} of {u.size} currents are exactly 0, and hardly any are nearly 0: is 0 a "
            "fill value, or did the rotor stall?"
        )


def _equal_levels(u: Floats, v: Floats) -> Iterator[str]:
    if len(u) < MANY or u.shape[1] < 2:
        return
    same = ((u[:, 1:] == u[:, :-1]) & (v[:, 1:] == v[:, :-1])).all(axis=0)
    if same.any():
        yield (
            f"{same.sum()} of {u.shape[1]} levels have the same currents at all times as the level "
            "above: are they averages over depth, or was a level repeated?"
        )


_ALIKE, _UNLIKE = 0.8, 0.5


def _turned_levels(depth: Floats, current: NDArray[np.complex128]) -> Iterator[str]:
    """Report levels whose currents match both neighbours only after a rotation or a reflection.

    Depths (k,) [m] increase. Currents (n, k) [m/s] are complex numbers: the real part is eastward,
    the imaginary part is northward.
    """
    turned = []
    for i in range(1, len(depth) - 1):
        three = current[:, i - 1 : i + 2]
        above, own, below = three[np.isfinite(three).all(axis=1)].T
        with np.errstate(over="ignore"):
            size = [float(np.linalg.norm(one)) for one in (above, own, below)]
        if (
            own.size < MANY
            or not min(size)
            or np.inf in size
            or not 0.8 * min(size[::2]) <= size[1] <= 1.25 * max(size[::2])
        ):
            continue
        if np.vdot(above, below).real < _ALIKE * size[0] * size[2]:
            continue
        mean = above / size[0] + below / size[2]
        scale = float(np.linalg.norm(mean)) * size[1]
        rotated = np.vdot(mean, own) / scale
        mirrored = abs(np.vdot(mean.conj(), own)) / scale
        if rotated.real < _UNLIKE and max(abs(rotated), mirrored) > _ALIKE:
            turned.append(depth[i])
    if turned:
        yield (
            f"currents at {', '.join(f'{one:g}' for one in turned)} m differ in direction from "
            "the currents above and below, which agree with each other: is a compass or a sign "
            "wrong, or are the components exchanged?"
        )


def series_doubts(values: Floats, times: Times, names: Sequence[str] = ("",)) -> Iterator[str]:
    """Report doubtful times, gaps, and constant or repeated values of time series.

    Parameters
    ----------
    values : (n, k, c) values of c components in k series; NaN in gaps
    times : (n,) increasing times
    names : (k,) text for each series in messages, such as " at 20 m"
    """
    yield from _years(times)
    again = int((times[1:] == times[:-1]).sum())
    if 2 * again >= len(times) > 1:
        yield (
            f"{again} of {len(times)} times are equal to the time before: does the file combine "
            "several "
            "instruments?"
        )
    elif len(times) > 2:
        yield from _gaps(times)
    yield from _unchanged(values, times, names)
    if len(times) > 2 and np.median(np.diff(times)) <= _SLOWEST:
        yield from _interleaved(values)
    yield from _repeated(values, times)


FAR_APART = np.timedelta64(12, "h")
"""Interval between profiles above which tides and their peaks are lost."""


def step_doubts(times: Times) -> Iterator[str]:
    """Report a time between profiles that is too long to resolve tides and peaks."""
    if len(times) > 1 and (step := np.median(np.diff(np.sort(times)))) >= FAR_APART:
        yield (
            f"the {len(times)} profiles are {step / np.timedelta64(1, 'h'):.4g} h apart, so tides "
            "and peaks between them are missing"
        )


@dataclass(frozen=True)
class WaterLimits:
    """Limits and unit of a sea-water quantity, and other common units of this quantity.

    `likely` gives, for each other unit, the factor and the offset that convert values to `unit`.
    """

    least: float
    greatest: float
    unit: str
    likely: Mapping[str, tuple[float, float]]


WATER = {
    "temperature": WaterLimits(-6.0, 40.0, "°C", {
        "K": (1.0, -273.15), "degF": (1.0 / 1.8, -32.0 / 1.8), "0.001 degC": (1e-3, 0.0),
    }),
    "salinity": WaterLimits(0.0, 42.0, "", {
        "kg/kg": (1e3, 0.0), "mS/cm, as a conductivity": (0.7, 0.0), "0.001": (1e-3, 0.0),
    }),
}  # fmt: skip
"""Limits of temperature and salinity: the range of validity of TEOS-10."""
_FRACTION = 0.05  # most salinities lie below this if they are mass fractions


def impossible_values(name: str, values: Floats) -> tuple[NDArray[np.bool_], str, bool]:
    """Find values that are impossible for sea water.

    Parameters
    ----------
    name : key of `WATER`
    values : values in the unit of the quantity; NaN in gaps

    Returns
    -------
    tuple
        Mask of the impossible values, a message, and whether most values are impossible.
    """
    limits, known = WATER[name], values[np.isfinite(values)]
    wrong = (values < limits.least) | (values > limits.greatest)
    fraction = name == "salinity" and known.size and 0.0 < np.median(known) < _FRACTION
    if not (wrong.any() or fraction):
        return wrong, "", False
    doubted = known if fraction else values[wrong]
    middle = float(np.median(doubted))
    likely = [
        unit for unit, (factor, zero) in limits.likely.items()
        if limits.least <= factor * middle + zero <= limits.greatest
    ]  # fmt: skip
    meant = f": is it in {likely[0]}?" if likely else ""
    if not fraction and 2 * wrong.sum() <= known.size and np.unique(doubted).size == 1:
        meant = ": is this a fill value?"
    count, span = int((known < _FRACTION).sum()), f"below {_FRACTION:g}"
    if not fraction:
        allowed = f"{limits.least:g} to {limits.greatest:g} {limits.unit}".rstrip()
        count, span = int(wrong.sum()), f"outside the range of {name} in sea water, {allowed}"
    sentence = f"{count} of {known.size} values are {span}, with a median of {middle:.4g}{meant}"
    return wrong, sentence, bool(2 * wrong.sum() > known.size)


def exchanged_pair(values: Floats) -> tuple[int, int] | None:
    """Find the only two levels whose exchange makes a profile monotonic.

    Return None if the profile is already monotonic, or if no pair or several pairs fit. At least
    four values are needed, and no NaN.
    """
    if len(values) < 4 or not np.isfinite(values).all():
        return None
    falls = np.corrcoef(np.arange(len(values)), values)[0, 1] < 0.0
    values = -values if falls else values.copy()
    if (np.diff(values) >= 0.0).all():
        return None
    found = []
    for i in range(len(values)):
        for j in range(i + 1, len(values)):
            other = values.copy()
            other[[i, j]] = other[[j, i]]
            if (np.diff(other) >= 0.0).all():
                found.append((i, j))
    return found[0] if len(found) == 1 else None


def _level_names(depth: Floats) -> list[str]:
    return [f" at {depth[k]:g} m" if depth.ndim == 1 and np.isfinite(depth[k]) else
            f" at level {k + 1}" for k in range(depth.shape[-1])]  # fmt: skip


def _years(times: Times) -> Iterator[str]:
    last = datetime.now(UTC).year + 1
    years = times.astype("datetime64[Y]").astype(np.int64) + 1970
    outside = (years < _FIRST_YEAR) | (years > last)
    if outside.any():
        yield (
            f"{outside.sum()} of {times.size} times are before {_FIRST_YEAR} or after {last}: the "
            f"first is {time_text(times[outside][0])}"
        )

    unset = int((times.astype("datetime64[M]") == np.datetime64("1970-01")).sum())
    if unset:
        yield f"{unset} of {times.size} times are in January 1970: was the clock not set?"


def gaps_of(times: Times) -> tuple[np.timedelta64, NDArray[np.intp]]:
    """Return the median step of times (n,), and the indices of the times that precede a gap.

    A gap is a step longer than 1.5 times the median step.
    """
    steps = np.diff(times)
    step = np.median(steps)
    return step, np.flatnonzero(steps > 1.5 * step)


def _gaps(times: Times) -> Iterator[str]:
    step, at = gaps_of(times)
    steps = np.diff(times)
    longest = steps.max()
    missing = (steps[at] - step).sum() if at.size else np.timedelta64(0, "ns")
    if longest > max(_DAY, 3 * step) or missing > UNCHANGED * (times[-1] - times[0]):
        k = int(steps.argmax())
        hours = np.timedelta64(1, "h")
        yield (
            f"{at.size} gap{'s' * (at.size != 1)} in time: the longest is {longest / hours:.4g} h, "
            f"from {time_text(times[k])} to {time_text(times[k + 1])}; the step is "
            f"{step / hours:.4g} h"
        )


def _unchanged(values: Floats, times: Times, names: Sequence[str]) -> Iterator[str]:
    same: NDArray[np.bool_] = np.all(values[1:] == values[:-1], axis=2)
    known: NDArray[np.bool_] = np.all(np.isfinite(values), axis=2)
    fewest = max(_FEWEST, UNCHANGED * len(times))
    stuck, longest = 0, (0, 0, 0)  # number of readings, first reading, series
    for k in range(same.shape[1]):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], same[:, k].astype(np.int8), [0]])))
        runs = edges[1::2] - edges[::2] + 1
        most = int(runs.max(initial=0))
        mostly = same[:, k].sum() > max(0.5 * (int(known[:, k].sum()) - 1), _FEWEST)
        if most >= fewest or mostly:
            stuck += 1
            if most > longest[0]:
                longest = most, int(edges[::2][runs.argmax()]), k
    if stuck:
        most, first, k = longest
        which = f"{stuck} of {same.shape[1]} levels do" if same.shape[1] > 1 else "the record does"
        yield (
            f"{which} not change for a tenth of the record, or between most readings: the longest "
            f"run of equal values{names[k]} has {most} readings, from {time_text(times[first])} "
            f"to {time_text(times[first + most - 1])}"
        )


def _interleaved(values: Floats) -> Iterator[str]:
    if len(values) < MANY:
        return
    next_one, second = (
        np.linalg.norm(values[apart:] - values[:-apart], axis=2) for apart in (1, 2)
    )
    with np.errstate(invalid="ignore"):
        one, two = (np.array([*map(_median, each.T)]) for each in (next_one, second))
    woven = (one > 0.0) & (two < 0.4 * one)
    if woven.any():
        k = int(np.argmax(one * woven))
        yield (
            f"{woven.sum()} of {woven.size} series appear to alternate between two instruments: "
            f"consecutive readings differ by {one[k]:.3g}, but every second reading only by "
            f"{two[k]:.3g}"
        )


def _repeated(values: Floats, times: Times) -> Iterator[str]:
    """Report the longest sequence of readings that occurs twice with exactly equal values."""
    count = len(values) - _STRETCH + 1
    if count <= _STRETCH:
        return
    rows = np.nan_to_num(values.reshape(len(values), -1), nan=-1e30) + 0.0
    bits = np.ascontiguousarray(rows).view(np.uint64)
    bits ^= bits >> np.uint64(29)
    drawn = np.random.default_rng(1).integers(1, 2**63, (2, max(bits.shape[1], _STRETCH)))
    weights = drawn.astype(np.uint64) | np.uint64(1)
    row = (bits * weights[0, : bits.shape[1]]).sum(axis=1, dtype=np.uint64)
    window = np.zeros(count, np.uint64)
    for j in range(_STRETCH):
        window += row[j : j + count] * weights[1, j]
    changes = np.concatenate([[0], np.cumsum(row[1:] != row[:-1])])
    varied = changes[_STRETCH - 1 :] - changes[:count] >= _STRETCH // 2
    _, first, which = np.unique(window, return_index=True, return_inverse=True)
    apart = np.arange(count) - first[which]
    again = varied & (apart >= _STRETCH)
    goes_on = again[:-1] & (apart[1:] == apart[:-1])
    begins = np.flatnonzero(again & ~np.concatenate([[False], goes_on]))
    if not begins.size:
        return
    ends = []
    for at in begins[:MANY].tolist():
        follows = (again & (apart == apart[at]))[at:]
        ends.append(int(np.argmin(np.append(follows, False))))
    k = int(np.argmax(ends))
    at, length = int(begins[k]), ends[k] + _STRETCH - 1
    yield (
        f"{length} readings from {time_text(times[at])} are the same as those from "
        f"{time_text(times[at - apart[at]])}: was a part of the record copied?"
    )
