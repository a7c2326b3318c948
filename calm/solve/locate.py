"""Where the root is: below the surface from the upright side, else at the surface float."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from calm.physics.line import Line
from calm.physics.march import Profile, Track, head_count
from calm.solve.closing import Closing, Unknown
from calm.solve.status import Status

SCAN = 16
"""Depths tried between the upright line and its deepest conceivable knockdown where the current
grows with depth: the resolution at which separate equilibria are told apart."""


def locate(closing: Closing) -> tuple[Unknown, float, float, float | None]:
    """Find the highest coarse root.

    Returns
    -------
    unknown, its value, the slope of the miss there, and the depth of the free end near another
    equilibrium that the scan came upon [m], None without one.

    Raises
    ------
    NoEquilibrium
        ``slack``, ``above-surface`` or ``grounded``.
    """
    line = closing.line
    unknown = Unknown(Track.of(line), line)
    miss = closing.coarse_miss(unknown)
    upright = max(closing.water.depth - line.anchor_height - float(line.length.sum()), 0.0)
    high = miss(upright)
    if high < 0.0 < upright:
        # stretch makes the standing line longer than it was cut
        at_surface = miss(0.0)
        if at_surface >= 0.0:
            return unknown, *closing.coarse_root(unknown, 0.0, at_surface, upright, high), None
        high = at_surface
    if high < 0.0:
        return *_afloat(closing, high), None
    low_end, other = _below_surface(closing, unknown, upright, high)
    return unknown, *closing.coarse_root(unknown, *low_end), other


Bracket = tuple[float, float, float, float]


def _below_surface(
    closing: Closing, unknown: Unknown, depth: float, high: float
) -> tuple[Bracket, float | None]:
    """Highest interval of depths that holds a root, from `depth` where the miss is `high` ≥ 0.

    Where the current does not grow with depth the miss falls by more than the shift, so the first
    shift brackets the only root. Where it grows enough to matter, depths are scanned.
    """
    miss, deepest = closing.coarse_miss(unknown), closing.water.depth
    growth = _growth(closing, depth)
    if growth > 0.0 and high > closing.allowed:
        fall = _largest_fall(closing, unknown, depth)
        if fall * growth > 0.25:
            return _scan(closing, unknown, depth, high, min(depth + 1.02 * fall, deepest))
    shift = max(high, closing.allowed)
    while depth < deepest:
        lower = min(depth + shift, deepest)
        low = miss(lower)
        if low <= 0.0:
            return (depth, high, lower, low), None
        depth, high, shift = lower, low, max(low, 2.0 * shift)
    raise Status.GROUNDED.because("The current drags the whole line down to the seabed.")


def _growth(closing: Closing, depth: float) -> float:
    """Largest growth of the speed with depth below `depth`, relative to the top speed [1/m]."""
    levels = closing.water.level
    current, _ = closing.water.at(levels)
    speed = np.linalg.norm(current, axis=1)
    rise = (np.diff(speed) / np.diff(levels))[levels[1:] > depth]
    return max(float(rise.max(initial=0.0)), 0.0) / max(float(speed.max()), 1e-300)


def _largest_fall(closing: Closing, unknown: Unknown, depth: float) -> float:
    """Knockdown if the greatest current ran at every level [m]."""
    water = closing.water
    current, _ = water.at(water.level)
    greatest = current[int(np.argmax(np.linalg.norm(current, axis=1)))]
    u, v, w = (np.full(len(water.level), component) for component in greatest)
    even = Profile(replace(water, u=u, v=v, w=w))
    end = closing.run(unknown, depth, closing.coarse_step, profile=even)
    return max(end.z - closing.goal, closing.allowed)


def _scan(
    closing: Closing, unknown: Unknown, depth: float, high: float, deepest: float
) -> tuple[Bracket, float | None]:
    miss = closing.coarse_miss(unknown)
    found: Bracket | None = None
    steps = np.linspace(depth, deepest, SCAN + 1)[1:].tolist()
    if deepest < closing.water.depth:
        steps.append(closing.water.depth)
    for lower in steps:
        low = miss(lower)
        if high > 0.0 >= low:
            if found is not None:
                return found, lower
            found = depth, high, lower, low
        if found is not None and lower >= deepest:
            return found, None
        depth, high = lower, low
    raise Status.GROUNDED.because("The current drags the whole line down to the seabed.")


def _afloat(closing: Closing, deep: float) -> tuple[Unknown, float, float]:
    """Share of a float's buoyancy in use, from the top float down.

    Where even an unloaded top float leaves the line too deep, it lies on the surface with what
    is above the next buoyant piece, and the buoyancy of that piece is shared out.
    """
    line = closing.line
    floats = [p for p in np.flatnonzero(~line.flexible & (line.buoyancy > 0)).tolist()]
    for piece in floats:
        lying = _lying_above(line, piece) if piece != floats[0] else line
        if lying is None:
            break
        unknown = Unknown(Track.of(lying, head_count(line)), lying, piece)
        miss = closing.coarse_miss(unknown)
        if piece != floats[0]:
            deep = miss(1.0)
            if deep >= 0.0:
                break
        if not closing.water.moving and _slack_at_rest(closing, unknown):
            continue
        unloaded = miss(0.0)
        if unloaded > 0.0:
            return unknown, *closing.coarse_root(unknown, 1.0, deep, 0.0, unloaded)
    if not closing.water.moving:
        raise Status.SLACK.because(
            f"The line stands {-deep:.1f} m longer than the water is deep and there is no "
            "current: it has no unique shape."
        )
    raise Status.ABOVE_SURFACE.because(
        f"Even with nothing left of its surface buoyancy the line is {-deep:.1f} m too long for "
        "the water: its buoyant part would rise above the surface."
    )


def _lying_above(line: Line, piece: int) -> Line | None:
    """The line with all above `piece` afloat and weightless; None where it could not float."""
    if float(line.total_buoyancy[:piece].sum()) < 0.0:
        return None
    keep = np.arange(len(line.length)) >= piece
    kept = line.clamp_piece >= piece
    return replace(
        line,
        buoyancy=line.buoyancy * keep,
        volume=line.volume * keep,
        clamp_buoyancy=line.clamp_buoyancy * kept,
        clamp_volume=line.clamp_volume * kept,
    )


def _slack_at_rest(closing: Closing, unknown: Unknown) -> bool:
    """In still water: whether the line stands too deep however little buoyancy is used."""
    piece = unknown.afloat
    assert piece is not None
    spare = float(np.cumsum(unknown.line.total_buoyancy)[piece:].min())
    least = 1.0 - spare / float(unknown.line.buoyancy[piece])
    return closing.coarse_miss(unknown)(min(max(least, 0.0) * (1.0 + 1e-9) + 1e-9, 1.0)) < 0.0
