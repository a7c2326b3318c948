"""Where a line is cut at first: the same for all its profiles."""

from __future__ import annotations

import numpy as np

from calm.physics.line import Floats
from calm.physics.track import Cable, Load, Track

CUTS = 50
"""Of a line, about, for the first look; they are halved twice and more."""
LANDING_CUTS, LEAST_CUTS = 32, 8
"""At least, of what may come down on the seabed, and of each part of it between clamps."""
SOFTENING = 0.3
"""Cuts grow with the depth at which they stand upright, plus this share of the water depth."""


def cuts_of(track: Track, depth: float, lands: bool) -> list[Floats]:
    """For every cable, the lengths of its cuts [m], shorter towards the surface.

    Currents shear where they are strong, and they are strong towards the surface. But where a line
    `lands` it may bend within a short length.
    """
    height = sum(stage.length for stage in track.stages if not isinstance(stage, Load))
    landing = sum(s.length for s in track.stages[track.landing :] if isinstance(s, Cable))
    ends = []
    for n, stage in enumerate(track.stages):
        if isinstance(stage, Load):
            continue
        upper = max(depth - height, 0.0) + SOFTENING * depth
        height -= stage.length
        if isinstance(stage, Cable):
            few = 1.0
            if lands and n >= track.landing:
                few = max(LANDING_CUTS * stage.length / landing, LEAST_CUTS)
            ends.append((upper, upper + stage.length, few))
    total = sum(np.log(lower / upper) for upper, lower, _ in ends)
    cuts = []
    for upper, lower, few in ends:
        count = max(round(CUTS * np.log(lower / upper) / total), round(few), 1)
        joints = np.geomspace(upper, lower, count + 1)
        cuts.append(np.diff(joints))
    return cuts
