"""What holds the anchor in place."""

from __future__ import annotations


def required_weight(vertical: float, horizontal: float, factor: float, friction: float) -> float:
    """Weight in water that keeps a dead-weight anchor where it is [N].

    Parameters
    ----------
    vertical, horizontal : pull of the line on the anchor [N], + up
    factor : safety on both the lift and the slide [-], 1.5 in practice
    friction : of the anchor on the bed [-], 0.6 in practice

    W ≥ factor (V + H / friction): the rule of Dewey's Mooring Design & Dynamics and of WHOI.
    """
    return factor * (vertical + horizontal / friction)
