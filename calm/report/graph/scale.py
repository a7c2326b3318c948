"""Where a value stands between the edges of a graph."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from calm.physics.line import Floats

_MARGIN = 0.05  # of the range, on either side


@dataclass(frozen=True)
class Scale:
    """A range, linear or of decades.

    Attributes
    ----------
    low : value at the left or the lower edge; it may be the greater one
    high : value at the right or the upper edge
    logarithmic : whether decades are equally far apart; both edges are then above zero
    """

    low: float
    high: float
    logarithmic: bool = False

    def share(self, value: ArrayLike) -> Floats:
        """Way of values from `low` (0) to `high` (1); NaN of what a logarithm does not have."""
        given: Any = np.asarray(value, dtype=np.float64)
        if not self.logarithmic:
            return np.asarray((given - self.low) / (self.high - self.low))
        known = np.where(given > 0.0, given, np.nan)
        return np.asarray(np.log(known / self.low) / np.log(self.high / self.low))


def covering(*values: ArrayLike, margin: float = _MARGIN) -> Scale:
    """The linear range that holds all finite values, with a margin; 0 to 1 where there is none."""
    every = np.concatenate([np.ravel(np.asarray(each, dtype=np.float64)) for each in values])
    every = every[np.isfinite(every)]
    if not every.size:
        return Scale(0.0, 1.0)
    low, high = float(every.min()), float(every.max())
    spare = margin * (high - low) or margin * abs(low) or margin
    return Scale(low - spare, high + spare)
