"""How well depths are computed: against sensors, and against interpolation between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats, Integers

CALM = 0.1
"""Share of the times that count as calm: those of the least knockdown."""
BAND = 1.96
"""Deviations on either side between which 95 % of a normal law lie."""


@dataclass(frozen=True)
class Agreement:
    """Tell how computed depths agree with measured ones.

    Attributes
    ----------
    count : times that have both
    bias : mean of computed less measured over them [m]
    rms : root of the mean square of that difference less its mean over the calm times [m]
    r : correlation of computed and measured
    slope : of computed on measured
    """

    count: int
    bias: float
    rms: float
    r: float
    slope: float


def calm_times(down: Floats, among: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return those of some times at which the knockdown [m] is least: a tenth of them, one at
    least.
    """
    known = among & np.isfinite(down)
    chosen = np.zeros_like(known)
    count = int(known.sum())
    if count:
        where = np.flatnonzero(known)
        rank = np.argsort(down[where], kind="stable")
        chosen[where[rank[: max(round(CALM * count), 1)]]] = True
    return chosen


def difference(
    computed: Floats, measured: Floats, calm: NDArray[np.bool_], among: NDArray[np.bool_]
) -> Floats:
    """Return (n,) computed less measured, less its mean over the calm times; NaN elsewhere [m].

    Parameters
    ----------
    computed, measured : (n,) depths [m]
    calm : (n,) times of the least knockdown
    among : (n,) times that count
    """
    off = np.where(among, computed - measured, np.nan)
    at_rest = off[calm & np.isfinite(off)]
    result: Floats = off - (at_rest.mean() if at_rest.size else np.nan)
    return result


def rms(off: Floats) -> float:
    """Return the root of the mean square of the values there are; NaN of none."""
    known = off[np.isfinite(off)]
    return float(np.sqrt((known**2).mean())) if known.size else float("nan")


def agreement(
    computed: Floats, measured: Floats, calm: NDArray[np.bool_], among: NDArray[np.bool_]
) -> Agreement:
    """Return how depths agree at some of the times.

    Parameters
    ----------
    computed, measured : (n,) depths [m]
    calm : (n,) times of the least knockdown
    among : (n,) times that count
    """
    both = among & np.isfinite(computed) & np.isfinite(measured)
    count = int(both.sum())
    if count < 2:
        nan = float("nan")
        return Agreement(count, nan, nan, nan, nan)
    x, y = measured[both], computed[both]
    spread_x, spread_y = x - x.mean(), y - y.mean()
    across, own, other = spread_x @ spread_y, spread_x @ spread_x, spread_y @ spread_y
    nan = float("nan")
    return Agreement(
        count,
        float((y - x).mean()),
        rms(difference(computed, measured, calm, both)),
        float(across / np.sqrt(own * other)) if own * other > 0.0 else nan,
        float(across / own) if own > 0.0 else nan,
    )


def coverage(off: Floats, deviation: Floats) -> float:
    """Return the share of the differences within the band of 95 %; NaN of none."""
    known = np.isfinite(off) & np.isfinite(deviation)
    inside = np.abs(off[known]) <= BAND * deviation[known]
    return float(inside.mean()) if inside.size else float("nan")


def linear(depth: Floats, point: Integers, still: Floats, wanted: int) -> Floats:
    """Return (n,) depths at a point, linear by height in still water between the nearest sensors
    [m].

    Parameters
    ----------
    depth : (n, s) of the sensors; NaN at a time leaves that time without
    point : (s,) where they are
    still : (p,) depths in still water
    wanted : the point

    Beyond the sensors the slope of the two nearest goes on; a single one moves everything alike.
    """
    order = np.argsort(still[point], kind="stable")
    place, values = still[point][order], depth[:, order]
    if len(place) == 1:
        alike: Floats = values[:, 0] + still[wanted] - place[0]
        return alike
    upper = int(np.clip(np.searchsorted(place, still[wanted]) - 1, 0, len(place) - 2))
    share = (still[wanted] - place[upper]) / (place[upper + 1] - place[upper])
    between: Floats = values[:, upper] * (1.0 - share) + values[:, upper + 1] * share
    return between
