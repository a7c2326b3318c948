"""Where the root is: below the surface from the upright side, else at the surface float."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np

from calm.physics.profile import Profile
from calm.solve.closing import Afloat, Closing, Root, Unknown
from calm.solve.standing import standing_lift
from calm.solve.status import Status

SCAN = 16
"""Depths tried between the upright line and its deepest conceivable knockdown where the current
grows with depth: the resolution at which separate equilibria are told apart."""


def locate(closing: Closing, lands: bool) -> tuple[Root, float | None]:
    """Find the highest coarse root, of a line that hangs clear of the seabed or one that lands.

    Returns
    -------
    The root, and the depth of the free end near another equilibrium that the scan came upon [m],
    None without one.

    Raises
    ------
    NoEquilibrium
        ``slack``, ``above-surface`` or ``grounded``.
    """
    unknown = closing.whole(lands)
    miss = closing.coarse_miss(unknown)
    upright = _upright(closing, unknown)
    high = miss(upright)
    if high < 0.0 < upright:
        # the current's pull stretches the line further
        at_surface = miss(0.0)
        if at_surface >= 0.0:
            return closing.coarse_root(unknown, 0.0, at_surface, upright, high), None
        high = at_surface
    if high < 0.0:
        return _at_surface(closing, unknown, high), None
    low_end, other = _below_surface(closing, unknown, upright, high)
    return closing.coarse_root(unknown, *low_end), other


def _upright(closing: Closing, unknown: Unknown) -> float:
    """Depth of the free end of the line standing in still water, with its stretch [m]."""
    still = Profile(closing.water.still())
    reach = closing.run(unknown, 0.0, closing.coarse_step, profile=still).z
    unstretched = -float(closing.line.length.sum())
    return max(min(reach, unstretched) - unknown.goal, 0.0)


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
    return max(end.z - unknown.goal, closing.allowed)


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


def _at_surface(closing: Closing, unknown: Unknown, deep: float) -> Root:
    """Share of buoyancy in use of the lowest float at the surface, and of those above it.

    The top float is tried first. Where it closes the line only with the next float out of the
    water, or not at all, that one lies at the surface too: the share of the upper float then
    follows from the part of the line between them, and the next float closes the line.
    `deep` < 0 is the miss with the free end at the surface and all buoyancy in use.
    """
    line = closing.line
    floats = np.flatnonzero(~line.flexible & (line.buoyancy > 0.0)).tolist()
    for piece, lower in zip(floats, [*floats[1:], None], strict=True):
        unknown = replace(unknown, afloat=piece)
        if closing.at_rest and (unknown.lands or _slack_at_rest(closing, unknown)):
            length = float(line.length.sum())
            radius = sqrt(max(length**2 - closing.water.depth**2, 0.0))
            raise Status.SLACK.because(
                f"There is no current and the line, {length:.1f} m uncut, is longer than the "
                "water is deep: it has no unique shape. Its watch circle has a radius of "
                f"{radius:.0f} m."
            )
        unloaded = closing.coarse_miss(unknown)(0.0)
        if unloaded > 0.0:
            root = closing.coarse_root(unknown, 1.0, deep, 0.0, unloaded)
            if lower is None or _height_at(closing, root, lower) <= closing.allowed:
                return root
        if lower is None:
            break
        surfaced = _surfaced(closing, unknown, piece, lower)
        if surfaced is None:
            break
        unknown = replace(unknown, above=(*unknown.above, surfaced), afloat=lower)
        deep = closing.coarse_miss(unknown)(1.0)
        if deep >= 0.0:
            break
    raise Status.ABOVE_SURFACE.because(
        "A buoyant part of the line would rise above the surface: "
        "more of it than the floats listed one below the other."
    )


def _height_at(closing: Closing, root: Root, piece: int) -> float:
    """Height of the top of a piece above the surface [m]."""
    return closing.run(root.unknown.down_to(piece), root.x, closing.coarse_step).z


def _surfaced(closing: Closing, unknown: Unknown, piece: int, lower: int) -> Afloat | None:
    """The float `piece` with the share that leaves the next one's top at the surface."""
    part = unknown.down_to(lower)
    miss = closing.coarse_miss(part)
    loaded, unloaded = miss(1.0), miss(0.0)
    if abs(unloaded) <= closing.allowed:
        return Afloat(piece, 0.0, loaded - unloaded)
    if loaded >= 0.0 or unloaded < 0.0:
        return None
    root = closing.coarse_root(part, 1.0, loaded, 0.0, unloaded)
    return Afloat(piece, root.x, root.slope)


def _slack_at_rest(closing: Closing, unknown: Unknown) -> bool:
    """In still water: whether the line stands too deep however little buoyancy is used."""
    piece = unknown.afloat
    assert piece is not None
    spare = float(np.cumsum(standing_lift(closing.line, closing.water))[piece:].min())
    least = 1.0 - spare / float(closing.line.buoyancy[piece])
    return closing.coarse_miss(unknown)(min(max(least, 0.0) * (1.0 + 1e-9) + 1e-9, 1.0)) < 0.0
