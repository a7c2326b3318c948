"""The referee's smooth spheres and cylinders: their drag against the Reynolds number.

Long cylinder: NACA report 121 (Wieselsberger) up to 1.61e5, DNV-RP-C205 figure 6-6 from 2.1e5.
Finite cylinder: κ(L/D), DNV-RP-C205 table 6-2 and, below L/D = 2 and the crisis, NACA report 121;
from its column below Re = 2e5 to that above over 1.8e5 to 2.2e5. Sphere: F. A. Morrison (2016).
All straight over logarithms, and held outside.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import log

import numpy as np

VISCOSITY = 1.36e-6
"""Of the water, everywhere [m²/s]."""

CYLINDER = np.array([
    (3.18, 4.87), (8.01, 2.94), (17.7, 2.12), (31.7, 1.73), (63.6, 1.48), (196, 1.27),
    (356, 1.15), (892, 0.964), (2.27e3, 0.886), (5.15e3, 0.944), (9.18e3, 1.06), (1.5e4, 1.14),
    (3.03e4, 1.16), (6.55e4, 1.17), (1.07e5, 1.17), (1.61e5, 1.18),
    (2.1e5, 1.21), (2.31e5, 1.20), (2.72e5, 1.17), (2.97e5, 1.11), (3.25e5, 1.01),
    (3.62e5, 0.894), (4.10e5, 0.709), (4.75e5, 0.532), (5.25e5, 0.408), (5.79e5, 0.327),
    (6.38e5, 0.284), (7.44e5, 0.297), (1.07e6, 0.389), (1.39e6, 0.470), (1.83e6, 0.539),
    (2.26e6, 0.584), (2.90e6, 0.629), (3.66e6, 0.648), (4.94e6, 0.678),
])  # fmt: skip
KAPPA = np.array([
    (1, 0.52, 0.80), (2, 0.58, 0.80), (5, 0.62, 0.80), (10, 0.68, 0.82), (20, 0.74, 0.90),
    (40, 0.82, 0.98), (50, 0.87, 0.99), (100, 0.98, 1.00),
])  # fmt: skip
ENDS = 0.1, 1e6
"""Between these the sphere's formula is taken as it is."""
LONG, SLENDER, CRISIS = np.log(CYLINDER[:, 0]), np.log(KAPPA[:, 0]), np.log([1.8e5, 2.2e5])


@dataclass(frozen=True)
class Smooth:
    """A sphere of a diameter [m], or a cylinder of a length over diameter."""

    diameter: float
    slenderness: float | None

    def factor(self, speed: float) -> float:
        """Drag at a speed [m/s] over that of the usual coefficient, 0.5 or 1.2 κ."""
        reynolds = max(speed * self.diameter / VISCOSITY, 1e-9)
        if self.slenderness is None:
            return sphere(min(max(reynolds, ENDS[0]), ENDS[1])) / 0.5
        ratio = log(max(self.slenderness, 1e-9))
        below, above = (np.interp(ratio, SLENDER, KAPPA[:, i]) for i in (1, 2))
        kappa = np.interp(log(reynolds), CRISIS, [below, above])
        long = np.interp(log(reynolds), LONG, CYLINDER[:, 1])
        return float(long * kappa / (1.2 * below))


def sphere(re: float) -> float:
    """Cx of a sphere."""
    return (
        24 / re
        + 2.6 * (re / 5) / (1 + (re / 5) ** 1.52)
        + 0.411 * (re / 2.63e5) ** -7.94 / (1 + (re / 2.63e5) ** -8.0)
        + 0.25 * (re / 1e6) / (1 + re / 1e6)
    )
