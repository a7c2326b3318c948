"""The referee's strumming: a towed cable that vibrates as Bourget & Marichal have it.

At an angle φ between cable and flow, φ in degrees,

    a/D = A₁ + B₁ φ + C₁ φ²,   λ = 2π a F/(|V| sin φ),   C* = min(C₀ f(λ), ceiling),
    f(λ) = (1/π) ∫₀^π (1 + λ² cos²θ)^{3/2} dθ.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import asin, degrees, hypot, pi

from scipy.special import ellipe, ellipk

from calm.physics.strumming import BourgetMarichal


@dataclass(frozen=True)
class Vibration:
    """A cable of one diameter [m] that vibrates at one frequency [Hz]."""

    model: BourgetMarichal
    diameter: float
    frequency: float

    def factor(self, speed: float, across: float) -> float:
        """C*/C₀ where the flow has a speed and a part of it across the cable [m/s]."""
        model = self.model
        highest = model.ceiling / model.rest
        if across <= 0.0:
            return highest if self.frequency > 0.0 else 1.0
        angle = degrees(asin(min(across / speed, 1.0)))
        amplitude = self.diameter * (model.a1 + model.b1 * angle + model.c1 * angle**2)
        ratio = 2.0 * pi * amplitude * self.frequency / across
        return min(power_factor(min(ratio, 1e6)), highest)


def power_factor(ratio: float) -> float:
    """f(λ), by complete elliptic integrals of the parameter λ²/(1 + λ²)."""
    square = ratio * ratio
    parameter = square / (1.0 + square)
    whole = 2.0 * (2.0 + square) * ellipe(parameter) - ellipk(parameter)
    return float(2.0 / (3.0 * pi) * hypot(1.0, ratio) * whole)
