"""Currents without gaps: what is missing at a level comes from its neighbours."""

from __future__ import annotations

from itertools import product

import numpy as np
from numpy.typing import NDArray

from calm.motion import prior
from calm.physics.line import Floats, Integers

FEWEST = 20
"""Times from which the errors of what is taken from neighbours are known."""
NORMAL = 1.4826
"""Standard deviation of a normal law over the median of its size."""


def filled(depth: Floats, value: Floats, known: NDArray[np.bool_]) -> Floats:
    """Values (n, k) at levels (n, k), those that are not known linear in depth between the others.

    Beyond the first and the last known level they are constant; NaN where none is known.
    """
    result = np.where(known, value, np.nan)
    for i in np.flatnonzero(~known.all(axis=1)):
        there = known[i]
        if there.any():
            order = np.argsort(depth[i, there], kind="stable")
            result[i, ~there] = np.interp(
                depth[i, ~there], depth[i, there][order], value[i, there][order]
            )
    return result


def gap_errors(level: Floats, u: Floats, v: Floats, group: Integers) -> Floats:
    """(g, g) how far the speeds of a group of levels are from those that the others give.

    The median size of the logarithm of their ratio, as the deviation of a normal law, over the half
    of the times with the stronger current: of the group of a row, left out with that of a column.
    `calm.motion.prior.GAP` where too few times say.

    Parameters
    ----------
    level, u, v : (n, k) depths [m] and currents [m/s]
    group : (k,) of each level
    """
    count = int(group.max()) + 1 if len(group) else 0
    errors = np.full((count, count), prior.GAP)
    whole = np.isfinite(u) & np.isfinite(v) & np.isfinite(level)
    times = np.flatnonzero(whole.all(axis=1))
    if len(times) < FEWEST:
        return errors
    for one, other in product(range(count), repeat=2):
        mine, known = group == one, ~np.isin(group, (one, other))
        if known.any():
            known = np.broadcast_to(known, (len(times), len(group)))
            taken = [filled(level[times], each[times], known)[:, mine] for each in (u, v)]
            here, there = (
                np.hypot(east, north).mean(axis=1) + prior.STEADY
                for east, north in ((u[times][:, mine], v[times][:, mine]), taken)
            )
            off = np.abs(np.log(there / here))[here + there >= np.median(here + there)]
            errors[one, other] = NORMAL * np.median(off)
    least: Floats = np.maximum(errors, prior.LEVEL[1])
    return least
