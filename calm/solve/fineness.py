"""Choice of the number of segments, from the difference between the coarse and the fine shape.

Segments are chosen at twice the angle step. The line or net is closed on these, and again with
every segment halved. The march is of second order, so a third of the change is the error of the
fine shape (`calm.solve.accuracy`). If the error is too large, both shapes are closed again at a
smaller angle step.
"""

from math import degrees, sqrt

from calm.solve.accuracy import Errors

DEPTH_TARGET = 4e-5
TENSION_TARGET = 1.6e-4
"""Largest error estimates at an angle step of 1°, relative to the span and to the tension. Larger
errors, which grow with the square of the angle step, reduce the step.
"""
MOST_ROUNDS = 6
"""Largest number of rounds, each with a coarse and a fine shape."""
MOST_SEGMENTS = 20_000


def finer(errors: Errors, span: float, requested: float, step: float, segments: int) -> float:
    """Return the angle step of the next round [rad], or 0 if the shape is fine enough.

    Parameters
    ----------
    span : length to which errors of depth are relative [m]
    requested, step : the angle step of the settings, and that of this round [rad]
    segments : number of segments in the fine shape
    """
    target = degrees(requested)
    target *= target
    place, tension = DEPTH_TARGET * target, TENSION_TARGET * target
    excess = max(errors.depth / (place * span), errors.relative / tension)
    if excess <= 1.0 or segments > MOST_SEGMENTS:
        return 0.0
    return step * max(0.8 / sqrt(excess), 0.2)
