"""Ratio of tensions measured at sea to computed tensions, for low and for high seas.

The tensions were measured below the disc buoys of the Southern Ocean Flux Station (SOFS, 47° S,
4600 m of water), on the lines SOFS-1 and SOFS-3 to SOFS-6. Standard deviations are compared in
bins of significant height; no parameter was fitted. The comparison is in
`tests/validation/test_sofs.py`. The measurements are from petejan/sots-cable-model.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

HIGHEST_LOW_SEA = 5.0
"""Significant height up to which a sea state counts as low in this comparison [m], at the limit of
two bins.
"""

COMPARED = 1.0, 10.0
"""Range of significant heights in which tensions were compared [m]."""


@dataclass(frozen=True)
class MeasuredBand:
    """Range, from `low` to `high`, of the ratio of measured to computed tension.

    The ratio compares standard deviations. `from_height` and `to_height` are the limits of
    significant wave height in the comparison [m].
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
"""Range of the ratio of measured to computed tension, for each method of computing heave: in low
seas, then in high seas. The ranges enclose all observations. The inverse ratio, computed to
measured tension, was observed as follows. Heave `filtered`: 1.04 to 1.71 in low seas, 0.93 to 1.34
in high seas. Heave `panels`: 1.13 to 1.81 in low seas, 0.96 to 1.40 in high seas. Heave `follows`:
1.44 to 2.24 in low seas, 1.12 to 1.66 in high seas.
"""


def measured_band(
    significant_height: float, heave: Literal["filtered", "panels", "follows"]
) -> MeasuredBand:
    """Return the range of measured to computed tension below a float at the surface.

    Beyond the compared wave heights, the band for the nearest wave height is returned.

    Parameters
    ----------
    significant_height : significant wave height [m]
    heave : method by which the heave of the float is computed
    """
    low, high = _BY_HEAVE[heave]
    if significant_height <= HIGHEST_LOW_SEA:
        return MeasuredBand(*low, COMPARED[0], HIGHEST_LOW_SEA)
    return MeasuredBand(*high, HIGHEST_LOW_SEA, COMPARED[1])
