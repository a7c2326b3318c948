"""The line at each time of a block as its currents say, and how that changes with what is unknown.

Every time is estimated for itself. Unknown are the logarithm of a factor on the current of each
group of levels, the height of the sea, and what is common to the record, whose values and
covariance are given.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from calm.motion import prior
from calm.motion.filled import filled
from calm.motion.forward import Forward
from calm.motion.measured import FREE, Measured
from calm.motion.unknowns import Common
from calm.physics.line import Floats

STEP = 0.05
"""Of the logarithms by which the derivatives are found."""
APART = 1e-6
"""Between levels of instruments that hang in one place [m]."""


@dataclass(frozen=True)
class Way:
    """One way to read the currents of some times, and where it puts the line.

    Attributes
    ----------
    level : (n, k) depths of the levels [m]
    u, v : (n, k) [m/s]
    spread : (n, g, g) prior covariance of the logarithms
    """

    level: Floats
    u: Floats
    v: Floats
    spread: Floats


class Moments:
    """The times of a block, with a mooring to ask."""

    def __init__(
        self, measured: Measured, forward: Forward, shifted: Mapping[str, Forward]
    ) -> None:
        self.measured, self.forward, self.shifted = measured, forward, shifted
        self.group = measured.group
        self.groups = int(self.group.max()) + 1 if len(self.group) else 0

    # --- currents

    def levels(self, depths: Floats) -> Floats:
        """(n, k) depths of the levels, of those that hang by the depths of the points.

        A current whose sensor is used hangs where that was measured.
        """
        one = self.measured
        level = one.level_depth.copy()
        for k, (point, sensor) in enumerate(zip(one.level_point, one.level_sensor, strict=True)):
            if point == FREE:
                continue
            level[:, k] = depths[:, point]
            if sensor != FREE:
                known = np.isfinite(one.depth[:, sensor])
                level[known, k] = one.depth[known, sensor]
        apart: Floats = np.maximum(level, 0.0) + APART * np.arange(level.shape[1])
        return apart

    def read(
        self, level: Floats, without: tuple[int, ...] = ()
    ) -> tuple[Floats, Floats, NDArray[np.bool_]]:
        """(n, k) u and v [m/s] at these levels, and whether each was measured.

        Parameters
        ----------
        without : groups that are taken from the others, as is what was not measured
        """
        one = self.measured
        known = np.isfinite(one.u) & np.isfinite(one.v) & np.isfinite(level)
        known &= ~np.isin(self.group, without)
        return filled(level, one.u, known), filled(level, one.v, known), known

    def way(self, level: Floats, common: Common, without: tuple[int, ...] = ()) -> Way:
        """The currents at these levels with their errors; some groups taken from the others."""
        u, v, known = self.read(level, without)
        speed = np.maximum(np.hypot(u, v), 1e-3)
        own = np.hypot(prior.by_flag(prior.LEVEL, self.measured.flag), prior.STEADY / speed)
        gap = common.gap[:, [*without]].max(axis=1) if without else np.diag(common.gap)
        own = np.minimum(np.where(known, own, gap[self.group]), prior.LARGEST)
        spread = np.zeros((len(u), self.groups, self.groups))
        place = np.linspace(-1.0, 1.0, self.groups) if self.groups > 1 else np.zeros(1)
        spread += prior.CURRENT**2 + prior.SHEAR**2 * np.outer(place, place)
        for g in range(self.groups):
            mine = own[:, self.group == g]
            spread[:, g, g] += (mine**2).mean(axis=1)
        return Way(level, u, v, common.scale**2 * spread)

    def depths(self, way: Way, logs: Floats, forward: Forward | None = None) -> Floats:
        """(n, p) depths of the points with factors on the currents."""
        factor = np.exp(logs[:, self.group])
        return (forward or self.forward).depths(way.level, way.u * factor, way.v * factor)

    def slopes(self, way: Way, logs: Floats, there: Floats) -> Floats:
        """(n, p, g) change of the depths with the logarithm of each group's factor [m]."""
        columns = np.zeros((*there.shape, self.groups))
        for g in range(self.groups):
            ahead = logs.copy()
            ahead[:, g] += STEP
            columns[:, :, g] = (self.depths(way, ahead) - there) / STEP
        return np.nan_to_num(columns)

    def common_slopes(self, way: Way, there: Floats) -> Floats:
        """(n, p, f) change of the depths with the logarithm of each common factor [m]."""
        none = np.zeros((len(there), self.groups))
        columns = [
            (self.depths(way, none, forward) - there) / STEP for forward in self.shifted.values()
        ]
        return np.nan_to_num(np.stack(columns, -1)) if columns else np.zeros((*there.shape, 0))
