"""What holds the anchor in place."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Forces = NDArray[np.floating[Any]]


def required_weight(
    vertical: Forces | float, horizontal: Forces | float, factor: float, friction: float
) -> Forces:
    """Return the weight in water that keeps a dead-weight anchor where it is [N].

    It is never below 0: an anchor that the line presses down on the bed needs none.

    Parameters
    ----------
    vertical, horizontal : pull of the line on the anchor [N], + up; floats or columns of them
    factor : safety on both the lift and the slide [-], 1.5 in practice
    friction : of the anchor on the bed [-], 0.6 in practice

    W ≥ factor (V + H / friction): the rule of Dewey's Mooring Design & Dynamics and of WHOI.
    """
    needed: Forces = np.maximum(factor * (vertical + horizontal / friction), 0.0)
    return needed
