"""The speed of sound: one, or a profile, and the path of a straight ray through it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from calm.physics.line import Floats

SLOWEST, FASTEST = 1380.0, 1680.0
"""Of sound in natural waters [m/s]: near-freezing fresh water, the deepest trench."""


@dataclass(frozen=True)
class Sound:
    """Speed of sound by depth: linear between the depths, constant beyond them.

    Attributes
    ----------
    depth : (k,) growing [m]
    speed : (k,) [m/s]
    """

    depth: Floats
    speed: Floats

    @classmethod
    def constant(cls, speed: float) -> Sound:
        """The same speed at all depths [m/s]."""
        return cls(np.zeros(1), np.array([speed]))

    def mean(self, above: float, below: float) -> float:
        """Harmonic mean between two depths [m/s].

        A straight ray spends its way evenly over the depths between its ends, at any slope, so its
        time is its length over this mean.
        """
        if len(self.speed) == 1 or below - above < 1e-6:
            return float(np.interp(0.5 * (above + below), self.depth, self.speed))
        inside = self.depth[(self.depth > above) & (self.depth < below)]
        levels = np.array([above, *inside, below])
        speeds = np.interp(levels, self.depth, self.speed)
        ratio = np.diff(speeds) / speeds[:-1]
        # ∫ dz/c of a linear c is Δz ln(1 + x)/(x c), x its relative growth
        small = np.abs(ratio) < 1e-6
        slowness = np.where(small, 1.0 - 0.5 * ratio, np.log1p(ratio) / np.where(small, 1.0, ratio))
        time = float((np.diff(levels) * slowness / speeds[:-1]).sum())
        return (below - above) / time
