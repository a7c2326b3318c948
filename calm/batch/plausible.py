"""Profiles whose current cannot be true: an instrument's fill value, another unit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from calm.files.current_terms import DEEPEST, IMPOSSIBLE
from calm.physics.line import Floats

if TYPE_CHECKING:
    from calm.batch.records.record import Record

_AT_ONCE = 8192


def implausible(
    depth: Floats, u: Floats, v: Floats, w: Floats | None, maximum_speed: float
) -> NDArray[np.bool_]:
    """Which levels (n, k) are faster than `maximum_speed` [m/s], or deeper than any sea.

    An infinite speed is faster. Levels above the surface and those without a value drop out
    first, and are none of them.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        squared = u * u + v * v + (0.0 if w is None else w * w)
        fast = (squared > maximum_speed * maximum_speed) & (depth >= 0.0)
        found: NDArray[np.bool_] = fast | ((depth > DEEPEST) & np.isfinite(squared))
    return found


def first_implausible(record: Record, maximum_speed: float) -> str:
    """The first time, level and value of a record that is implausible, in words.

    Raises
    ------
    InputError
        The file is damaged.
    """
    for start in range(0, record.count, _AT_ONCE):
        depth, u, v, w = record.profiles(start, min(start + _AT_ONCE, record.count))
        found = implausible(depth, u, v, w, maximum_speed)
        if found.any():
            at, level = (int(index[0]) for index in np.nonzero(found))
            deep = float(depth[at if depth.ndim == 2 else ..., level])
            up = 0.0 if w is None else float(w[at, level])
            speed = float(np.sqrt(u[at, level] ** 2 + v[at, level] ** 2 + up * up))
            time = np.datetime_as_string(record.time[start + at], unit="m")
            value = f"{speed:.5g} m/s" if np.isfinite(speed) else IMPOSSIBLE
            return f"the first at {time}, {deep:g} m: {value}"
    return ""
