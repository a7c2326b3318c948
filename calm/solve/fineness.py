"""Choice of the number of segments, by comparing the shape on coarse and on halved segments.

The coarse segments are chosen for twice the angle step. If the errors from `calm.solve.accuracy`
are too large, both shapes are computed again for a smaller angle step.
"""

from math import degrees, sqrt

from calm.solve.accuracy import Errors

DEPTH_TARGET = 4e-5
TENSION_TARGET = 1.6e-4
"""Largest accepted error estimates if the angle step in the settings is 1°.

DEPTH_TARGET is a fraction of the span, TENSION_TARGET a fraction of the tension. Both are
proportional to the square of the angle step in the settings. Larger errors reduce the step of the
next round.
"""
MOST_ROUNDS = 6
"""Largest number of rounds, each with a coarse and a fine shape."""
MOST_SEGMENTS = 20_000


def finer(errors: Errors, span: float, requested: float, step: float, segments: int) -> float:
    """Return the angle step for the next round [rad], or 0 if the segments are short enough.

    Parameters
    ----------
    span : reference length for errors of depth [m]
    requested, step : angle step of the settings, and of this round [rad]
    segments : number of segments in the fine shape
    """
    target = degrees(requested)
    target *= target
    place, tension = DEPTH_TARGET * target, TENSION_TARGET * target
    excess = max(errors.depth / (place * span), errors.relative / tension)
    if excess <= 1.0 or segments > MOST_SEGMENTS:
        return 0.0
    return step * max(0.8 / sqrt(excess), 0.2)
