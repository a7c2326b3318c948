"""What is known before the pressures are looked at: how far wrong currents, sensors and lines are.

Standard deviations, unless they are said to be something else. A factor is known by its natural
logarithm.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from calm.physics.line import Floats

CURRENT = 0.05
"""Of the factor on the whole current at one time."""
SHEAR = 0.05
"""Of the factor that grows from -1 at the lowest level to 1 at the highest."""
LEVEL: Mapping[int, float] = {0: 0.05, 1: 0.05, 2: 0.07, 3: 0.15, 4: 0.30, 8: 0.20}
"""Of the factor on a single level, by its quality flag."""
STEADY = 0.01
"""What a weak current is wrong by besides [m/s]."""
GAP = 0.25
"""Of the factor on a level whose current is taken from its neighbours, where the record does not
say how alike these are."""
LARGEST = 0.5
"""Of the factor on a single level, at most."""
FALSE: Mapping[int, float] = {0: 0.01, 1: 0.01, 2: 0.03, 3: 0.10, 4: 0.30, 8: 0.10}
"""Probability that a current is false in direction or size, by its quality flag."""
WORSE, ALL_WORSE = 3.0, 0.01
"""All currents of a time are so many times worse than this, and the probability that they are."""

FACTORS: Mapping[str, tuple[float, float]] = {
    "cable_drag": (0.0, 0.15),
    "rigid_drag": (0.0, 0.15),
    "buoyancy": (0.0, 0.02),
    "length": (0.0, 0.003),
}
"""Mean and deviation of the logarithms of the common factors."""
DATUM = 0.01
"""Of the depth of the water, as a share of it: what all depths may be wrong by alike."""
OFFSET = 1.0
"""Of the offset of a sensor [m]."""
ELSEWHERE, MISPLACED, SLIPPED = 20.0, 0.01, 0.01
"""How far from its place in the file a sensor is that is not there [m], and the probabilities that
it is so from the beginning, and that its clamp slips during the record."""
TIDE = 1.0
"""Of tide and air pressure [m]; where the sea level is given, `RESIDUAL_TIDE`."""
RESIDUAL_TIDE = 0.15
NOISE = 0.2
"""Of a depth by pressure at one time [m]."""
SPIKE, SPIKES = 30.0, 1e-5
"""Of a depth that is a spike [m], and the probability that one is."""
WORST = 0.07
"""Share of the knockdown that the line itself may be wrong by, after all else: shape, model."""


def by_flag(values: Mapping[int, float], flag: NDArray[np.int8]) -> Floats:
    """Return a figure for every flag; one that is not known counts as bad, 4."""
    table = np.full(256, values[4])
    for number, value in values.items():
        table[number] = value
    return table[flag.astype(np.uint8)]
