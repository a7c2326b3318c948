"""How finely a line or a net is cut, by what its shapes on coarse and on fine segments lead to.

Segments are chosen at twice the angle step; all is closed on these, and again with every segment
halved. The march is of second order, so a third of the change is the error of the finer shape, see
`calm.solve.accuracy`; if that is too much, all is done again with a smaller step.
"""

from math import degrees, sqrt

from calm.solve.accuracy import Errors

DEPTH_TARGET = 4e-5
TENSION_TARGET = 1.6e-4
"""Error estimates, relative to the span and to the tension, above which the step is taken
smaller, at an angle step of 1°; they follow its square."""
MOST_ROUNDS = 6
"""How often all is done, at most."""
MOST_SEGMENTS = 20_000


def finer(errors: Errors, span: float, asked: float, step: float, segments: int) -> float:
    """The angle step with which all is done again [rad]; 0 where it is fine enough.

    Parameters
    ----------
    span : what errors of depths are measured by [m]
    asked, step : the angle step asked for, and that with which it was done [rad]
    segments : how many there were
    """
    target = degrees(asked)
    target *= target
    place, tension = DEPTH_TARGET * target, TENSION_TARGET * target
    excess = max(errors.depth / (place * span), errors.relative / tension)
    if excess <= 1.0 or segments > MOST_SEGMENTS:
        return 0.0
    return step * max(0.8 / sqrt(excess), 0.2)
