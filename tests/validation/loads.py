"""What the referee knows of the water, and of the forces on one piece, clamp or metre of cable."""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Water

Vector = NDArray[np.float64]
Flow = tuple[float, float, float, float]
"""Current u, v, w [m/s] and density [kg/m³] at a point."""

DOWN = np.array([0.0, 0.0, -1.0])


@dataclass(frozen=True)
class Load:
    """The net force of one rigid piece, one clamp or one metre of cable."""

    buoyancy: float
    volume: float
    normal_drag: float
    tangential_drag: float
    directional: bool
    gravity: float

    def force(self, flow: Flow, axis: Vector, swelling: float = 1.0) -> Vector:
        """Buoyancy and drag [N] with the axis along the unit vector `axis`."""
        u, v, w, density = flow
        x, y, z = axis
        tangential = 0.0
        if self.directional:
            along = u * x + v * y + w * z
            u, v, w = u - along * x, v - along * y, w - along * z
            tangential = self.tangential_drag * abs(along) * along
        normal = self.normal_drag * sqrt(u * u + v * v + w * w)
        scale = density / 1025.0 * swelling
        lift = self.buoyancy + (density - 1025.0) * self.gravity * self.volume
        return np.array(
            (
                scale * (normal * u + tangential * x),
                scale * (normal * v + tangential * y),
                scale * (normal * w + tangential * z) + lift,
            )
        )


class Profile:
    """The water, linear in depth band by band; band k lies between levels k - 1 and k."""

    def __init__(self, water: Water) -> None:
        self.levels = [float(level) for level in water.level]
        table = np.column_stack([water.u, water.v, water.w, water.density])
        slopes = np.diff(table, axis=0) / np.diff(water.level)[:, None]
        still = np.zeros((1, 4))
        self.origins = [self.levels[0], *self.levels]
        self.values = np.vstack([table[:1], table]).tolist()
        self.slopes = np.vstack([still, slopes, still]).tolist()

    def band(self, depth: float, rising: bool = False) -> int:
        """The band of a depth; on a level, the one a rising or sinking line is about to enter."""
        return (bisect_left if rising else bisect_right)(self.levels, depth)

    def flow(self, depth: float, band: int) -> Flow:
        """Water at a depth by the straight line of `band`, prolonged beyond it if need be."""
        (u, v, w, density), (du, dv, dw, ddensity) = self.values[band], self.slopes[band]
        h = depth - self.origins[band]
        return u + du * h, v + dv * h, w + dw * h, density + ddensity * h

    def at(self, depth: float) -> Flow:
        """Water at a depth."""
        return self.flow(depth, self.band(depth))

    def limits(self, band: int) -> tuple[float, float]:
        """The least and greatest depth of a band."""
        bounds = [-np.inf, *self.levels, np.inf]
        return bounds[band], bounds[band + 1]
