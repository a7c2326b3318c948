"""What was measured, on common times: currents at levels, depths of sensors."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats, Integers

MOST_GROUPS = 8
"""So many levels have errors of their own; of more, neighbours share theirs."""

FREE = -1
"""In place of a point or a sensor, where a level has none."""


@dataclass(frozen=True)
class Measured:
    """n times, s sensors, k levels.

    Attributes
    ----------
    time : (n,) to the nanosecond, rising
    label : (s,) of the used sensors
    point : (s,) where they are, see `calm.motion.forward`
    depth : (n, s) below the surface by their pressures [m]; NaN where not measured, or flagged
    level_depth : (n, k) [m]; NaN for levels that hang on the line
    level_point, level_sensor : (k,) the point that a level hangs at, and the used sensor there;
        `FREE` without
    u, v : (n, k) current [m/s], NaN where not measured
    flag : (n, k) quality flags of the current; 0 where it has none
    tide : (n,) height of the sea surface above its mean [m]; None where not known
    false : (n,) whether a current that cannot be was left out; None where none was
    """

    time: NDArray[np.datetime64]
    label: tuple[str, ...]
    point: Integers
    depth: Floats
    level_depth: Floats
    level_point: Integers
    level_sensor: Integers
    u: Floats
    v: Floats
    flag: NDArray[np.int8]
    tide: Floats | None = None
    false: NDArray[np.bool_] | None = None

    @property
    def group(self) -> Integers:
        """(k,) which levels share their error: each has its own where they are few."""
        count = len(self.level_point)
        return np.arange(count) * min(count, MOST_GROUPS) // max(count, 1)

    def at(self, times: slice | Integers) -> Measured:
        """What was measured at some of the times."""
        return replace(
            self,
            time=self.time[times],
            depth=self.depth[times],
            level_depth=self.level_depth[times],
            u=self.u[times],
            v=self.v[times],
            flag=self.flag[times],
            tide=None if self.tide is None else self.tide[times],
            false=None if self.false is None else self.false[times],
        )


def level_names(measured: Measured, labels: Sequence[str]) -> tuple[str, ...]:
    """What each level of the currents is called: its part of the line, or its mean depth."""
    names = []
    for k, point in enumerate(measured.level_point.tolist()):
        depth = measured.level_depth[:, k]
        known = depth[np.isfinite(depth)]
        at = f"{known.mean():.1f} m" if known.size else f"level {k + 1}"
        names.append(at if point == FREE else labels[point])
    return tuple(names)
