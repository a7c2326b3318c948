"""What holds the anchor in place."""

from __future__ import annotations

import numpy as np

from calm.physics.line import Floats


def required_weight(
    vertical: Floats | float, horizontal: Floats | float, factor: float, friction: float
) -> Floats:
    """Return the weight in water that keeps a dead-weight anchor where it is [N].

    It is never below 0: an anchor that the line presses down on the bed needs none.

    Parameters
    ----------
    vertical, horizontal : pull of the line on the anchor [N], + up; floats or columns of them
    factor : safety on both the lift and the slide [-], 1.5 in practice
    friction : of the anchor on the bed [-], 0.6 in practice

    W ≥ factor (V + H / friction): the rule of Dewey's Mooring Design & Dynamics and of WHOI.
    """
    needed: Floats = np.maximum(factor * (vertical + horizontal / friction), 0.0)
    return needed
