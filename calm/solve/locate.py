"""Where the root is: below the surface from the upright side, else at the surface float."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise
from math import sqrt

import numpy as np

from calm.physics.hull import AWASH
from calm.physics.profile import Profile
from calm.solve.closing import Closing, Root
from calm.solve.standing import standing_length
from calm.solve.status import Status
from calm.solve.unknown import Afloat, Unknown

SCAN = 16
"""Depths tried between the upright line and its deepest conceivable knockdown where the current
grows or turns with depth: the resolution at which separate equilibria are told apart."""
NEAR = (0.02, 0.2)
"""Shares of the first of these steps at which the miss is looked at, too: a line whose top is in a
weak current may fall short there, and reach the anchor again where more current pulls it up."""
DIP = 8
"""Depths tried to see whether the miss changes sign between three of those."""
GOLDEN = 0.381966
ROUNDING = 1e-12
"""Share of a current that is no growth of it: what a weaker one of the same direction leaves."""
MOST_AFLOAT = 16
"""Floats at the surface one after the other: each is sought with all those above it."""
SHARES = (0.0, 0.4, 0.7, 0.85, 0.94, 1.0 - AWASH, 0.995)
"""Shares of its buoyancy in use at which a float that would be under water is tried afloat."""

Sample = tuple[float, float]
"""A value of the unknown and the miss there [m]."""


def locate(closing: Closing, lands: bool) -> tuple[Root, Root | None]:
    """Find coarse roots, of a line that hangs clear of the seabed or one that lands.

    Returns
    -------
    The highest root, and the deepest one that the scan came upon; None where that is the same.
    Where the miss grows with depth a line does not stay, so such roots do not count.

    Raises
    ------
    NoEquilibrium
        ``slack``, ``above-surface`` or ``grounded``.
    """
    unknown = closing.whole(lands)
    miss = closing.coarse_miss(unknown)
    upright = upright_depth(closing, unknown)
    samples = [(upright, miss(upright))]
    if samples[0][1] < 0.0 < upright:
        # the current's pull stretches the line further
        samples.insert(0, (0.0, miss(0.0)))
    depth, high = samples[0]
    roots = []
    if high < 0.0:
        roots.append(_at_surface(closing, unknown, high))
    elif depth == 0.0 and (awash := _awash(closing, unknown, high)) is not None:
        roots.append(awash)
    for upper, lower in _below_surface(closing, unknown, samples):
        roots.append(closing.coarse_root(unknown, *upper, *lower))
    if not roots:
        raise Status.GROUNDED.because("The current drags the whole line down to the seabed.")
    return roots[0], roots[-1] if len(roots) > 1 else None


def upright_depth(closing: Closing, unknown: Unknown) -> float:
    """Depth of the free end of the line standing in still water, with its stretch [m]."""
    return max(-standing_length(closing.line, closing.lift) - unknown.goal, 0.0)


def _below_surface(
    closing: Closing, unknown: Unknown, samples: list[Sample]
) -> list[tuple[Sample, Sample]]:
    """Intervals of depth that each hold a root, the highest first, from given samples on.

    Where the current neither grows nor turns with depth the miss falls by more than the shift, so
    that there is one root at most, which the first shift brackets. Where it does so enough to
    matter, depths are scanned.
    """
    miss, deepest = closing.coarse_miss(unknown), closing.water.depth
    (top, high), (depth, low) = samples[0], samples[-1]
    growth = _growth(closing, top)
    if growth > 0.0 and (high < 0.0 or high > closing.allowed):
        fall = _largest_fall(closing, unknown, top)
        if fall * growth > 0.25:
            last = min(depth + 1.02 * fall, deepest)
            steps = np.linspace(0.0, last - depth, SCAN + 1)[1:]
            near = [share * steps[0] for share in NEAR]
            samples += [(depth + step, miss(depth + step)) for step in (*near, *steps.tolist())]
            if last < deepest:
                samples.append((deepest, miss(deepest)))
            return _falls(miss, samples)
    shift = closing.allowed
    while high >= 0.0 and low >= 0.0 and depth < deepest:
        shift = max(low, shift)
        depth, shift = min(depth + shift, deepest), 2.0 * shift
        low = miss(depth)
        samples.append((depth, low))
    return _falls(miss, samples)


def _falls(miss: Callable[[float], float], samples: list[Sample]) -> list[tuple[Sample, Sample]]:
    """Neighbours among the samples between which the miss falls through zero.

    Where it comes near zero and turns back, it is looked for between the samples, too.
    """
    seen = samples[:1]
    for before, here, after in zip(samples, samples[1:], samples[2:], strict=False):
        seen += _dip(miss, before, here, after)
    seen += samples[-1:]
    return [(a, b) for a, b in pairwise(seen) if a[1] >= 0.0 > b[1]]


def _dip(
    miss: Callable[[float], float], before: Sample, here: Sample, after: Sample
) -> list[Sample]:
    """The middle sample, and beside it one of the other sign where the miss dips in between.

    By golden section.
    """
    sign = 1.0 if here[1] > 0.0 else -1.0
    if not 0.0 < sign * here[1] < min(sign * before[1], sign * after[1]):
        return [here]
    low, best, high = before, here, after
    for _ in range(DIP):
        left = best[0] - low[0] > high[0] - best[0]
        x = best[0] - GOLDEN * (best[0] - low[0] if left else best[0] - high[0])
        tried = x, miss(x)
        if sign * tried[1] <= 0.0:
            return sorted([here, tried])
        if sign * tried[1] < sign * best[1]:
            low, best, high = (low, tried, best) if left else (best, tried, high)
        elif left:
            low = tried
        else:
            high = tried
    return [here]


def _growth(closing: Closing, depth: float) -> float:
    """Largest growth of the current with depth below `depth`, relative to the top speed [1/m].

    A current that only weakens does not grow; one that turns does, by what is new in it.
    """
    water, levels = closing.water, closing.water.level
    current = np.stack([water.u, water.v, water.w], axis=1)
    upper, lower = current[:-1], current[1:]
    squares = (current * current).sum(axis=1)
    left = (upper * lower).sum(axis=1) / np.maximum(squares[:-1], 1e-300)
    new = lower - np.minimum(np.maximum(left, 0.0), 1.0)[:, None] * upper
    growth = np.sqrt((new * new).sum(axis=1))
    speeds = np.sqrt(squares)
    growth[growth <= ROUNDING * speeds[1:]] = 0.0
    rise = (growth / (levels[1:] - levels[:-1]))[levels[1:] > depth]
    speed = float(speeds.max())
    return float(rise.max(initial=0.0)) / max(speed, 1e-300)


def _largest_fall(closing: Closing, unknown: Unknown, depth: float) -> float:
    """Knockdown if the greatest current ran at every level [m]."""
    water = closing.water
    current = np.column_stack([water.u, water.v, water.w])
    greatest = current[int(np.argmax(np.linalg.norm(current, axis=1)))]
    u, v, w = (np.full(len(water.level), component) for component in greatest)
    even = Profile(replace(water, u=u, v=v, w=w))
    end = closing.run(unknown, depth, closing.coarse_step, profile=even)
    return max(end.z - unknown.goal, closing.allowed)


def _awash(closing: Closing, unknown: Unknown, immersed: float) -> Root | None:
    """The highest root with a float at the surface that could be under water as well.

    There its drag is less, or the wind pushes against the current. `immersed` ≥ 0 is the miss with
    all buoyancy in use.
    """
    if closing.line.floating is None:
        return None
    piece, *lower = closing.floats
    unknown = replace(unknown, afloat=piece)
    miss = closing.coarse_miss(unknown)
    samples = [*((share, miss(share)) for share in SHARES), (1.0, immersed)]
    for a, b in pairwise(samples):
        if a[1] > 0.0 >= b[1]:
            root = closing.coarse_root(unknown, *b, *a)
            in_water = not lower or _height_at(closing, root, lower[0]) <= closing.allowed
            return root if in_water else None
    return None


def _at_surface(closing: Closing, unknown: Unknown, deep: float) -> Root:
    """Share of buoyancy in use of the lowest float at the surface, and of those above it.

    The top float is tried first. Where it closes the line only with the next float out of the
    water, or not at all, that one lies at the surface too: the share of the upper float then
    follows from the part of the line between them, and the next float closes the line. One float
    rides at its draft; several are taken as just below the surface.
    `deep` < 0 is the miss with the free end at the surface and all buoyancy in use.
    """
    line = closing.line
    floats = closing.floats
    for piece, lower in zip(floats, [*floats[1:], None], strict=True):
        if len(unknown.above) == MOST_AFLOAT:
            raise Status.ABOVE_SURFACE.because(
                f"More than {MOST_AFLOAT} floats would lie at the surface, one after the other."
            )
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
        unknown = replace(unknown, floating=None)
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
    spare = float(np.cumsum(closing.lift)[piece:].min())
    least = 1.0 - spare / float(closing.line.buoyancy[piece])
    return closing.coarse_miss(unknown)(min(max(least, 0.0) * (1.0 + 1e-9) + 1e-9, 1.0)) < 0.0
