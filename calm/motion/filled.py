"""Currents without gaps: what is missing at a level comes from its neighbours."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats


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
