"""A bare cable under tow: what its measured angle says of its vibration."""

from __future__ import annotations

import math
from dataclasses import dataclass

from calm.physics.strumming import BourgetMarichal


@dataclass(frozen=True)
class BareCable:
    """A cable towed with nothing at its end.

    Attributes
    ----------
    angle : to the horizontal, measured [degrees], above 0 and below 90
    speed : of the ship through the water [m/s], > 0
    diameter : [m], > 0
    weight : of a metre in water [N/m], > 0
    density : of the water [kg/m³], > 0
    """

    angle: float
    speed: float
    diameter: float
    weight: float
    density: float

    @property
    def vibration(self) -> tuple[float, float]:
        """C* and a/D, by `BourgetMarichal.from_bare_cable`."""
        return BourgetMarichal().from_bare_cable(
            math.radians(self.angle), self.speed, self.diameter, self.weight, self.density
        )

    @property
    def frequency(self) -> float:
        """Frequency of the vibration [Hz]."""
        angle = math.radians(self.angle)
        return BourgetMarichal().frequency(self.speed, angle, self.diameter)
