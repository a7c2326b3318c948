"""The part of a line that lies on the seabed: straight, held by friction, out of the current."""

from __future__ import annotations

from math import hypot

from calm.physics.line import REFERENCE_DENSITY
from calm.physics.march import End
from calm.physics.profile import Profile
from calm.physics.state import Trace
from calm.physics.track import Cable, Load, Rod, Stage, Track


def lie_down(
    track: Track, profile: Profile, end: End, trace: Trace, seabed: float, friction: float
) -> float:
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
    *_, density = profile.at(-seabed, 0)
    excess = (density - REFERENCE_DENSITY) * profile.gravity
    grounded = 0.0
    hanging = end.landing.hanging
    for stage in track.stages[end.landing.stage :]:
        for piece, clamp, length, weight in _lying(stage, hanging, excess):
            pulled, left = _held_back(tension, friction * weight)
            strain = _strain(stage, pulled, tension, left) if isinstance(stage, Cable) else 0.0
            tension = left
            x += length * (1.0 + strain) * east
            y += length * (1.0 + strain) * north
            grounded += length
            trace.element(piece, clamp, length, strain)
            trace.node(x, y, seabed, (-tension * east, -tension * north, 0.0))
        hanging = 0.0
    return grounded


Part = tuple[int, int, float, float]
"""Piece, clamp or -1, unstretched length [m] and weight in water [N] of something on the seabed."""


def _lying(stage: Stage, hanging: float, excess: float) -> list[Part]:
    """What of a stage lies on the seabed, below the length that hangs [m].

    `excess` is what a displaced cubic metre lifts more there than in reference water [N/m³].
    """
    if isinstance(stage, Cable):
        length = stage.length - hanging
        weight = _weight(stage, excess) * length
        return [(stage.piece, -1, length, weight)] if length > 0.0 else []
    if hanging > 0.0:
        return []
    if isinstance(stage, Load):
        return [(stage.piece, stage.clamp, 0.0, _weight(stage, excess))]
    return _lying_rod(stage, excess)


def _weight(load: Cable | Load, excess: float) -> float:
    return -(load.buoyancy + excess * load.volume)


def _lying_rod(rod: Rod, excess: float) -> list[Part]:
    parts: list[Part] = []
    start = 0.0
    for piece, length in zip(rod.pieces, rod.lengths, strict=True):
        here = [load for load in rod.loads if load.piece == piece]
        weight = next(_weight(load, excess) for load in here if load.clamp < 0)
        reached, end = start, start + length
        for load in [load for load in here if load.clamp >= 0]:
            share = (load.at - reached) / length if length > 0.0 else 0.0
            parts.append((piece, -1, load.at - reached, share * weight))
            parts.append((piece, load.clamp, 0.0, _weight(load, excess)))
            reached = load.at
        share = (end - reached) / length if length > 0.0 else 1.0
        parts.append((piece, -1, end - reached, share * weight))
        start = end
    return parts


def _held_back(tension: float, hold: float) -> tuple[float, float]:
    """Share of a part that the tension reaches into against friction, up to `hold`, and what is
    left of it at its end [N]."""
    if hold <= tension:
        return 1.0, tension - hold
    return tension / hold, 0.0


def _strain(cable: Cable, pulled: float, tension: float, left: float) -> float:
    """Mean strain of a part where the tension falls evenly over a share `pulled` of its length."""
    middle = 0.5 * (tension + left)
    if cable.elongation is None:
        return pulled * cable.compliance * middle
    strain = cable.elongation.mean_strain(middle, 0.5 * (tension - left))
    return pulled * strain + (1.0 - pulled) * cable.elongation.strain(0.0)
