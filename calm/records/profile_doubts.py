"""Tests for doubtful values in one profile of currents, from a record or a mooring file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import inf, pi

import numpy as np

from calm.physics.line import Floats
from calm.quantities import say

_TURN = 2.0 * pi
_HALF_RIGHT = pi / 4.0
_NEAR = 0.01
"""Rounding error of a multiple of 45 degrees in radians."""

_OPPOSITE = 150.0
_SAME_DIRECTION = 60.0
"""Minimum angle between opposite currents, and maximum angle between similar ones [degrees]."""

_LEAST_REVERSED = 0.05
"""Minimum speed of a current with a reliable direction [m/s]."""

_AT_THE_BED = 0.98
"""Fraction of the water depth; levels at or below this depth count as levels at the seabed."""

_SHELF, _DEEP = 200.0, 1000.0
_FASTEST = {_SHELF: 3.0, _DEEP: 1.5}
"""Maximum plausible current [m/s] in two cases: in water deeper than 200 m, and at depths below
1000 m.

The Florida Current and the Agulhas Current reach 2.5 m/s. Overflows reach 1.3 m/s at 600 to 1400 m.
Tidal races occur in shallower water only.
"""


def direction_doubts(directions: Sequence[float], name: str) -> Iterator[str]:
    """Report directions that appear to be in radians, or to be northward velocities.

    Parameters
    ----------
    directions : directions towards which currents flow [degrees]
    name : name of the column or key
    """
    if not directions or max(map(abs, directions)) > _TURN:
        return
    if all(one == round(one) for one in directions):
        return
    if len(directions) == 1:
        steps = directions[0] / _HALF_RIGHT
        if round(steps) == 0 or abs(steps - round(steps)) * _HALF_RIGHT > _NEAR:
            return
    least, most = min(directions), max(directions)
    span = f"{least:.3g}" if least == most else f"{least:.3g} to {most:.3g}"
    yield (
        f"`{name}` is {span} degrees throughout: are these values in radians, or are they "
        "northward velocities?"
    )


def profile_doubts(depth: Floats, u: Floats, v: Floats, water_depth: float) -> Iterator[str]:
    """Report doubtful levels of one profile, in sentences without a full stop.

    Depths (n,) [m] increase, and components u, v (n,) [m/s] have no gaps. An unknown water depth is
    inf.
    """
    speed, toward = np.hypot(u, v), np.degrees(np.arctan2(u, v))
    yield from _reversed_levels(depth, speed, toward)
    at_the_bed = _AT_THE_BED * water_depth <= depth[-1] < inf
    if len(depth) > 2 and at_the_bed and (np.diff(speed) > 0.0).all():
        yield (
            f"the current increases with depth, from {say('speed', float(speed[0]))} to "
            f"{say('speed', float(speed[-1]))} at the seabed: are the depths really heights above "
            "the seabed?"
        )
    yield from strength_doubts(depth, speed, water_depth)


def _reversed_levels(depth: Floats, speed: Floats, toward: Floats) -> Iterator[str]:
    for i in range(1, len(depth) - 1):
        three = speed[i - 1 : i + 2]
        # the speed must be between the other two; an undercurrent is usually slower or faster
        if three.min() < _LEAST_REVERSED or not three[0] >= three[1] >= three[2]:
            continue
        across = [_between(toward[i], toward[j]) for j in (i - 1, i + 1)]
        if min(across) > _OPPOSITE and _between(toward[i - 1], toward[i + 1]) < _SAME_DIRECTION:
            yield (
                f"the current at {say('depth', float(depth[i]))} is opposite to the currents "
                "above and below, although its speed lies between the speeds of these two: is "
                "the direction or a sign wrong?"
            )


def _between(one: float, other: float) -> float:
    return float(abs((one - other + 180.0) % 360.0 - 180.0))


def strength_doubts(depth: Floats, speed: Floats, water_depth: float) -> Iterator[str]:
    """Report currents that are stronger than any measured in deep water.

    Depths (n,) are in metres and maximum speeds (n,) at these depths in m/s. An unknown water depth
    is inf.
    """
    if not _SHELF < water_depth < inf:
        return
    deep = depth > _DEEP
    for there, limit, where in (
        (deep, _FASTEST[_DEEP], f"below {_DEEP:g} m"),
        (~deep, _FASTEST[_SHELF], f"in {say('depth', water_depth)} of water"),
    ):
        strongest = float(speed[there].max(initial=0.0))
        if strongest > limit:
            yield (
                f"the current reaches {say('speed', strongest)} {where}; currents measured there "
                f"are below {limit:g} m/s: were cm/s or knots written as m/s?"
            )
            return
