"""Tensions measured at sea against computed ones: a band by the height of the sea.

The Southern Ocean Flux Station (SOFS, 47° S, 4600 m of water, disc buoys of 2.7 m on inverse
catenaries) had a load cell below its buoy. Five of its lines are described well enough to be
computed: SOFS-1 and SOFS-3 to SOFS-6. Standard deviations of the tension are compared by bins of
significant height, 1.5 to 9.5 m, with the peak periods that the station's load cases pair with
these heights, and nothing fitted (`tests/validation/test_sofs.py`). Figures of the station:
petejan/sots-cable-model.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

HIGHEST_LOW_SEA = 5.0
"""Significant height up to which a sea is low here [m]: between two bins."""

COMPARED = 1.0, 10.0
"""Significant heights between which tensions were compared [m]."""


@dataclass(frozen=True)
class MeasuredBand:
    """Measured over computed standard deviation of tension, from `low` to `high`.

    `from_height` and `to_height` are the significant heights of the seas compared [m].
    """

    low: float
    high: float
    from_height: float
    to_height: float


_BY_HEAVE = {
    "filtered": ((0.57, 1.0), (0.74, 1.1)),
    "panels": ((0.54, 0.9), (0.7, 1.05)),
    "follows": ((0.44, 0.7), (0.6, 0.9)),
}
"""Bands in low and in high seas by how the heave of the float is computed: computed over measured
were 1.04 to 1.72 and 0.93 to 1.34, by panels 1.13 to 1.84 and 0.96 to 1.42, of a float that follows
every wave 1.44 to 2.25 and 1.12 to 1.66."""


def measured_band(
    significant_height: float, heave: Literal["filtered", "panels", "follows"]
) -> MeasuredBand:
    """Return the band of a sea for the line below a float at the surface.

    For seas lower or higher than those compared it is the band of the nearest ones.

    Parameters
    ----------
    significant_height : [m]
    heave : how the heave of the float is computed
    """
    low, high = _BY_HEAVE[heave]
    if significant_height <= HIGHEST_LOW_SEA:
        return MeasuredBand(*low, COMPARED[0], HIGHEST_LOW_SEA)
    return MeasuredBand(*high, HIGHEST_LOW_SEA, COMPARED[1])
