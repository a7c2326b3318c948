"""What a person should know of currents before trusting them, by their values, with counts."""

from __future__ import annotations

from collections.abc import Iterator
from math import inf

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats
from calm.quantities import say

FAR_APART = np.timedelta64(12, "h")
"""Between profiles so far apart the tide and its peaks are lost."""

_FEWEST = 4  # values of which it is no chance that they are alike
_MOST = 0.5  # share of zeros, and of profiles like the one before, that is said
_ALIKE = 0.9  # share of values that are the same in both components
_WEAK = 0.01  # m/s that no sea stays below for many profiles
_UNCOVERED = 0.1  # share of the depth that a profile may leave out at either end
_FEW = 25.0  # m of that


def current_notices(
    names: tuple[str, str],
    levels: tuple[Floats, Floats, Floats],
    times: NDArray[np.datetime64] | None,
    water_depth: float,
) -> list[str]:
    """Return what is odd about currents, in sentences.

    Parameters
    ----------
    names : of the components
    levels : depth, of any shape [m], and u, v (n, k) to the east and to the north, gaps as NaN
        [m/s]
    times : (n,) in their order; None of one profile
    water_depth : [m]; inf where it is not known
    """
    depth, u, v = levels
    said = [*_odd(names, u, v, times)]
    there = depth[np.isfinite(depth) & (depth >= 0.0)]
    if there.size and (missing := left_out(there.min(), there.max(), water_depth)):
        said.append(missing)
    return said


def _odd(
    names: tuple[str, str], u: Floats, v: Floats, times: NDArray[np.datetime64] | None
) -> Iterator[str]:
    known = np.isfinite(u) & np.isfinite(v)
    count, still = int(known.sum()), known & (u == 0.0) & (v == 0.0)
    moving = known & ~still
    first, second = names
    if count and still.sum() > _MOST * count:
        yield f"{still.sum()} of {count} currents are exactly 0: nothing was measured there?"
    if moving.sum() >= _FEWEST:
        alike = moving & (np.abs(u) == np.abs(v))
        if alike.sum() > _ALIKE * moving.sum():
            yield (
                f"`{first}` and `{second}` are the same in {alike.sum()} of {moving.sum()} "
                "currents: one of them is a copy of the other?"
            )
        for name, values, other in ((first, u, second), (second, v, first)):
            if not values[moving].any():
                yield f"`{name}` is 0 in all {moving.sum()} currents that `{other}` has"
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
        strongest = float(np.hypot(u[moving], v[moving]).max())
        if strongest < _WEAK:
            yield (
                f"the strongest of {count} currents is {strongest:.2g} m/s: cm/s or another unit, "
                "taken for m/s?"
            )


def left_out(top: float, bottom: float, water_depth: float) -> str:
    """Return which part of the water a current says nothing of; "" where it covers it.

    Parameters
    ----------
    top, bottom : its first and its last level [m]
    water_depth : [m]; inf where it is not known
    """
    allowed = max(_UNCOVERED * water_depth, _FEW)
    gaps = [f"above {say('depth', top)}"] if top > allowed else []
    if allowed < water_depth - bottom < inf:
        gaps.append(f"below {say('depth', bottom)}")
    if not gaps:
        return ""
    return (
        f"the current is not given {' and '.join(gaps)}: that of the nearest level is used there, "
        f"in {say('depth', water_depth)} of water"
    )
