"""The part of a line that lies on the seabed: straight, held back by friction, out of the current."""

from __future__ import annotations

from math import hypot

from calm.physics.march import End
from calm.physics.state import Trace
from calm.physics.track import Cable, Load, Rod, Track


def lie_down(track: Track, end: End, trace: Trace, seabed: float, friction: float) -> float:
    """Continue a trace from its touchdown to the anchor.

    The line lies along the horizontal force at touchdown. Its tension falls by friction times the
    weight of what lies, down to nothing; there is no drag. What the vertical force could not carry
    at the touchdown itself, a rigid piece or a clamp, rests there at a point.

    Parameters
    ----------
    end : of a march that landed
    trace : of that march; the nodes and elements on the seabed are appended
    seabed : height [m], + up from the surface
    friction : of the line on the seabed [-]

    Returns
    -------
    Unstretched length on the seabed [m].
    """
    assert end.landing is not None
    x, y = trace.x[-1], trace.y[-1]
    tension = hypot(end.force[0], end.force[1])
    east, north = (
        (-end.force[0] / tension, -end.force[1] / tension) if tension > 0.0 else (1.0, 0.0)
    )
    grounded = 0.0
    hanging = end.landing.hanging
    for stage in track.stages[end.landing.stage :]:
        for piece, clamp, length, weight in _lying(stage, hanging):
            compliance = stage.compliance if isinstance(stage, Cable) else 0.0
            mean, tension = _held_back(tension, friction * weight)
            strain = compliance * mean
            x += length * (1.0 + strain) * east
            y += length * (1.0 + strain) * north
            grounded += length
            trace.element(piece, clamp, length, strain)
            trace.node(x, y, seabed, (-tension * east, -tension * north, 0.0))
        hanging = 0.0
    return grounded


Part = tuple[int, int, float, float]
"""Piece, clamp or -1, unstretched length [m] and weight in water [N] of something on the seabed."""


def _lying(stage: Cable | Rod | Load, hanging: float) -> list[Part]:
    """What of a stage lies on the seabed, below the length that hangs [m]."""
    if isinstance(stage, Cable):
        length = stage.length - hanging
        return [(stage.piece, -1, length, -stage.buoyancy * length)] if length > 0.0 else []
    if hanging > 0.0:
        return []
    if isinstance(stage, Load):
        return [(stage.piece, stage.clamp, 0.0, -stage.buoyancy)]
    return _lying_rod(stage)


def _lying_rod(rod: Rod) -> list[Part]:
    parts: list[Part] = []
    start = 0.0
    for piece, length in zip(rod.pieces, rod.lengths, strict=True):
        here = [load for load in rod.loads if load.piece == piece]
        weight = -next(load.buoyancy for load in here if load.clamp < 0)
        reached, end = start, start + length
        for load in [load for load in here if load.clamp >= 0]:
            share = (load.at - reached) / length if length > 0.0 else 0.0
            parts.append((piece, -1, load.at - reached, share * weight))
            parts.append((piece, load.clamp, 0.0, -load.buoyancy))
            reached = load.at
        share = (end - reached) / length if length > 0.0 else 1.0
        parts.append((piece, -1, end - reached, share * weight))
        start = end
    return parts


def _held_back(tension: float, hold: float) -> tuple[float, float]:
    """Mean tension over a part that friction holds back by up to `hold`, and what is left [N]."""
    if hold <= tension:
        return tension - 0.5 * hold, tension - hold
    return 0.5 * tension * tension / hold, 0.0
