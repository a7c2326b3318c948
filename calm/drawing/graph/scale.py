"""Where a value stands between the edges of a graph, and the round values along an axis."""

from __future__ import annotations

from dataclasses import dataclass
from math import ceil, floor, log10
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from calm.physics.line import Floats

_MARGIN = 0.05  # of the range, on either side


@dataclass(frozen=True)
class Scale:
    """A range, linear or of decades.

    Attributes
    ----------
    low : value at the left or the lower edge; it may be the greater one
    high : value at the right or the upper edge
    logarithmic : whether decades are equally far apart; both edges are then above zero
    """

    low: float
    high: float
    logarithmic: bool = False

    def share(self, value: ArrayLike) -> Floats:
        """Way of values from `low` (0) to `high` (1); NaN of what a logarithm does not have."""
        given: Any = np.asarray(value, dtype=np.float64)
        if not self.logarithmic:
            return np.asarray((given - self.low) / (self.high - self.low))
        known = np.where(given > 0.0, given, np.nan)
        return np.asarray(np.log(known / self.low) / np.log(self.high / self.low))


def covering(*values: ArrayLike, margin: float = _MARGIN) -> Scale:
    """The linear range that holds all finite values, with a margin; 0 to 1 where there is none."""
    every = np.concatenate([np.ravel(np.asarray(each, dtype=np.float64)) for each in values])
    every = every[np.isfinite(every)]
    if not every.size:
        return Scale(0.0, 1.0)
    low, high = float(every.min()), float(every.max())
    spare = margin * (high - low) or margin * abs(low) or margin
    return Scale(low - spare, high + spare)


_STEPS = (1.0, 2.0, 5.0, 10.0)
# Steps of time: unit, how many of it, which signs of ISO 8601 tell it, about how many seconds.
_TIMES = (
    *(("m", count, (11, 16), 60.0 * count) for count in (1, 2, 5, 10, 30)),
    *(("h", count, (5, 16), 3600.0 * count) for count in (1, 3, 6, 12)),
    *(("D", count, (0, 10), 86400.0 * count) for count in (1, 2, 5, 10)),
    *(("M", count, (0, 7), 2629746.0 * count) for count in (1, 2, 3, 6)),
    *(("Y", count, (0, 4), 31556952.0 * count) for count in (1, 2, 5, 10, 20, 50, 100)),
)


class Tick(NamedTuple):
    """A value of an axis, and its text."""

    value: float
    text: str


def numbers(low: float, high: float, most: int) -> list[Tick]:
    """Round numbers between two values, in either order: about `most` of them."""
    low, high = min(low, high), max(low, high)
    values = round_numbers(low, high, most)
    return [Tick(value, number(value).replace("-", "\N{MINUS SIGN}")) for value in values]


def counts(first: int, last: int, most: int) -> list[Tick]:
    """Whole numbers from the first to the last: at most `most` steps of one round width."""
    wanted = max((last - first) / max(most, 1), 1.0)
    power = 10 ** floor(log10(wanted))
    step = next(int(each) * power for each in _STEPS if each * power >= wanted)
    return [
        Tick(float(value), str(value)) for value in range(-(-first // step) * step, last + 1, step)
    ]


def decades(low: float, high: float) -> list[Tick]:
    """Powers of ten between two values above zero."""
    powers = range(ceil(log10(low) - 1e-9), floor(log10(high) + 1e-9) + 1)
    return [Tick(10.0**power, f"{10.0**power:g}") for power in powers]


def moments(begin: np.datetime64, end: np.datetime64, most: int) -> list[Tick]:
    """Round times from `begin` to `end`, their values seconds since 1970: at most `most` or so."""
    edges = np.array([begin, end])
    first, last = seconds(edges)
    wanted = (last - first) / max(most, 1)
    unit, count, (start, stop), _ = next((each for each in _TIMES if each[3] >= wanted), _TIMES[-1])
    since, until = (
        int(each) for each in np.array([begin, end], f"datetime64[{unit}]").astype("i8")
    )
    if unit == "D" and count > 1:
        times = _days(edges.astype("datetime64[M]"), count)
    else:
        base = 1970 if unit == "Y" else 0  # years are counted from then
        whole = np.arange((since + base) // count * count, until + base + 1, count) - base
        times = whole.astype(f"datetime64[{unit}]")
    texts = np.datetime_as_string(times.astype("datetime64[s]"))
    return [
        Tick(float(second), str(text)[start:stop].replace("T", " "))
        for second, text in zip(seconds(times), texts, strict=True)
        if first <= second <= last
    ]


def seconds(times: Any) -> NDArray[np.float64]:
    """(n,) seconds since 1970 of times."""
    return np.asarray(times.astype("datetime64[ms]").astype("i8") / 1e3)


def _days(months: Any, step: int) -> Any:
    """Every so many-th day of each month from the first on, none near the next first."""
    each = np.arange(months[0], months[1] + 1).astype("datetime64[D]")
    return (each[:, None] + np.arange(0, 29 - step // 2, step)).ravel()


def round_numbers(low: float, high: float, most: int) -> list[float]:
    """Round numbers from `low` to `high`, about `most` of them, and more than one."""
    raw = (high - low) / max(most, 1)
    power = 10.0 ** floor(log10(raw))
    step = next(power * each for each in _STEPS if power * each >= raw * (1.0 - 1e-9))
    values = _multiples(step, low, high)
    return values if len(values) > 1 else _multiples(step / 2.0, low, high)


def _multiples(step: float, low: float, high: float) -> list[float]:
    first, last = ceil(low / step - 1e-9), floor(high / step + 1e-9)
    return [count * step for count in range(first, last + 1)]


def number(value: float) -> str:
    """As a scale shows it."""
    return f"{value:z.6g}" if abs(value) < 1e6 else f"{value:.0f}"
