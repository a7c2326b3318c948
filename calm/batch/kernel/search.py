"""What a lane does next: one step of the search for the root of one case.

Above and below are the ends of its bracket: above, the miss is not negative. `calm.solve.locate`
has the reasons of each step.
"""

from __future__ import annotations

from math import isfinite, nan
from typing import Any

from calm.batch.kernel.compiled import compiled
from calm.physics.hull import AWASH as GOING_UNDER
from calm.physics.line import Floats

(
    Y, ABOVE, ABOVE_MISS, BELOW, BELOW_MISS, LAST, LAST_MISS, OLDER_MISS, SLOPE, FALL, STEP, TURN,
    STUCK, FOUND, UPPER, UPPER_MISS, LOWER, LOWER_MISS, GROWTH, SPEED, LEAST_CARRIED, LYING,
    LOWEST_PLACE, CORNERS, PLACE_BEFORE, TENSION_BEFORE,
) = range(26)  # fmt: skip
COLUMNS = 26

# what a lane is about to learn from its next march
DONE, FIRST, UNLOADED, TOP, AWASH, SCAN, ROOT = range(7)

# how a search ends
SOLVED, AT_SURFACE, LOST, TURNS_BACK, UNCLOSED = 0, 4, 5, 6, 7

SCANNED = 16
MOST_CORRECTIONS = 12
SMALL, SMALL_SHARE = 5e-7, 3e-6
"""The miss of a closed line, as a share of the span; and how well a share in use is found."""

FLAT = -0.25
"""Slope of the miss; where the current is even, it is -1."""
STRAYED, STRAYED_SHARE = 2e-3, 0.02
"""How far a root may be from the coarse one, as a share of the span, and of the buoyancy: beyond,
it may be another one."""

THERE, AWAY, NOWHERE = range(3)
"""Where a correction finds itself."""


@compiled
def begin(seek: Floats, c: int, growth: float, speed: float, upright: float, falls: Floats) -> None:
    """Set out on a case: from the depth of the line standing in still water.

    `falls` are the knockdowns in even currents of growing speed, the last the speed's step.
    """
    for column in range(COLUMNS):
        seek[c, column] = nan
    seek[c, GROWTH], seek[c, SPEED] = growth, speed
    seek[c, Y], seek[c, SLOPE], seek[c, TURN], seek[c, STUCK] = upright, -1.0, 0.0, 0.0
    # where the miss may rise with depth, depths are scanned
    last = falls.size - 2
    at = min(speed / falls[last + 1], last - 1e-9)
    j = int(at)
    fall = falls[j] + (at - j) * (falls[j + 1] - falls[j])
    seek[c, FALL] = fall if fall * growth > 0.25 else 0.0


@compiled
def advance(
    seek: Floats, c: int, task: int, m: float, mooring: Any, shares: Floats
) -> tuple[int, int]:
    """The next task of a case whose unknown leads to the miss m, and how its search ended."""
    span, _, upright, floats, rides = mooring[0], mooring[1], mooring[2], mooring[3], mooring[4]
    y = seek[c, Y]
    if not isfinite(m):
        return DONE, UNCLOSED
    if task == FIRST:
        if m >= 0.0:
            seek[c, ABOVE], seek[c, ABOVE_MISS] = y, m
            if upright == 0.0 and rides:
                seek[c, Y] = shares[0] - 1.0
                return AWASH, SOLVED
            return go_down(seek, c, span), SOLVED
        seek[c, BELOW], seek[c, BELOW_MISS] = y, m
        if upright > 0.0:
            seek[c, Y] = 0.0
            return TOP, SOLVED
        seek[c, Y] = -1.0
        return (UNLOADED, SOLVED) if floats else (DONE, AT_SURFACE)
    if task in (TOP, UNLOADED):
        if m <= 0.0:
            return DONE, AT_SURFACE
        seek[c, ABOVE], seek[c, ABOVE_MISS] = y, m
        return bracket(seek, c), SOLVED
    if task == AWASH:
        if seek[c, LAST_MISS] > 0.0 and m <= 0.0:
            seek[c, ABOVE], seek[c, ABOVE_MISS] = seek[c, LAST], seek[c, LAST_MISS]
            seek[c, BELOW], seek[c, BELOW_MISS] = y, m
            return bracket(seek, c), SOLVED
        seek[c, TURN] += 1.0
        seek[c, LAST], seek[c, LAST_MISS] = y, m
        if seek[c, TURN] < shares.size:
            seek[c, Y] = shares[int(seek[c, TURN])] - 1.0
            return AWASH, SOLVED
        if m <= 0.0:
            return DONE, TURNS_BACK
        seek[c, Y] = 0.0
        return go_down(seek, c, span), SOLVED
    if task == SCAN:
        return scan(seek, c, m, span)
    return narrow(seek, c, m, span)


@compiled
def go_down(seek: Floats, c: int, span: float) -> int:
    """Begin the search below the surface, from above."""
    y, m = seek[c, ABOVE], seek[c, ABOVE_MISS]
    seek[c, LAST], seek[c, LAST_MISS], seek[c, OLDER_MISS] = y, m, nan
    if m > 1e-7 * span and seek[c, FALL] > 0.0:
        seek[c, STEP], seek[c, TURN] = (min(y + 1.02 * seek[c, FALL], span) - y) / SCANNED, 1.0
        seek[c, Y] = y + seek[c, STEP]
        return SCAN
    seek[c, Y] = min(y + max(m, 1e-7 * span), span)
    return ROOT


@compiled
def bracket(seek: Floats, c: int) -> int:
    """Go on between the ends of a bracket, where their chord crosses nothing."""
    a, fa, b, fb = seek[c, ABOVE], seek[c, ABOVE_MISS], seek[c, BELOW], seek[c, BELOW_MISS]
    seek[c, UPPER], seek[c, UPPER_MISS], seek[c, LOWER], seek[c, LOWER_MISS] = a, fa, b, fb
    seek[c, SLOPE] = (fb - fa) / (b - a)
    seek[c, LAST], seek[c, LAST_MISS] = (a, fa) if fa < -fb else (b, fb)
    seek[c, Y] = a - fa / seek[c, SLOPE]
    return ROOT


@compiled
def scan(seek: Floats, c: int, m: float, span: float) -> tuple[int, int]:
    """Go down until the miss is negative."""
    y, before = seek[c, Y], seek[c, LAST_MISS]
    if m < 0.0:
        seek[c, ABOVE], seek[c, ABOVE_MISS] = seek[c, LAST], before
        seek[c, BELOW], seek[c, BELOW_MISS] = y, m
        return bracket(seek, c), SOLVED
    if seek[c, OLDER_MISS] > before and m > before > 0.0:
        return DONE, TURNS_BACK
    if y >= span:
        return DONE, LOST
    seek[c, OLDER_MISS], seek[c, LAST_MISS], seek[c, LAST] = before, m, y
    seek[c, TURN] += 1.0
    seek[c, Y] = min(y + seek[c, STEP], span) if seek[c, TURN] <= SCANNED else span
    return SCAN, SOLVED


@compiled
def narrow(seek: Floats, c: int, m: float, span: float) -> tuple[int, int]:
    """One secant step, or one that halves the bracket."""
    y, last, before = seek[c, Y], seek[c, LAST], seek[c, LAST_MISS]
    if m >= 0.0:
        seek[c, ABOVE], seek[c, ABOVE_MISS] = y, m
    else:
        seek[c, BELOW], seek[c, BELOW_MISS] = y, m
    if y != last:
        seek[c, SLOPE] = (m - before) / (y - last)
    a, b, slope = seek[c, ABOVE], seek[c, BELOW], seek[c, SLOPE]
    following = y - m / slope if slope < 0.0 else nan
    if abs(m) <= 1e-5 * span or abs(b - a) <= 1e-9 * span:
        if slope < 0.0:
            seek[c, Y] = following
        else:
            seek[c, SLOPE] = -1.0
        seek[c, FOUND] = seek[c, Y]
        return DONE, TURNS_BACK if seek[c, FALL] > 0.0 and may_turn(seek, c) else SOLVED
    seek[c, STUCK] = seek[c, STUCK] + 1.0 if abs(m) > 0.5 * abs(before) else 0.0
    if isfinite(a) and isfinite(b):
        if not a < following < b or seek[c, STUCK] > 2.0:
            following = 0.5 * (a + b)
            seek[c, STUCK] = 0.0
    elif y >= span:
        return DONE, LOST
    else:
        furthest = y + 4.0 * max(m, y - last)
        following = min(following if following > y else furthest, furthest, span)
    seek[c, LAST], seek[c, LAST_MISS] = y, m
    seek[c, Y] = following
    return ROOT, SOLVED


@compiled
def may_turn(seek: Floats, c: int) -> bool:
    """Whether the miss is so flat by the root that finer cuts may find the highest one elsewhere.

    There, or on the way from the depths of the scan on either side.
    """
    y = seek[c, Y]
    above, below = y - seek[c, UPPER], seek[c, LOWER] - y
    return bool(
        y > 0.0
        and (
            seek[c, SLOPE] > FLAT
            or -seek[c, UPPER_MISS] > FLAT * above
            or seek[c, LOWER_MISS] > FLAT * below
        )
    )


@compiled
def is_another(found: float, y: float, mooring: Any) -> bool:
    """Whether a root may not be the one found on coarse cuts, or is about to go under."""
    under = mooring[4] and -GOING_UNDER < y < STRAYED * mooring[0]
    if (found < 0.0) != (y < 0.0) or (mooring[3] and mooring[2] == 0.0 and under):
        return True
    return abs(y - found) > (STRAYED_SHARE if y < 0.0 else STRAYED * mooring[0])


@compiled
def correct(seek: Floats, c: int, m: float, mooring: Any) -> int:
    """A secant step near the root: whether the miss m is small enough, or a next one is to come."""
    span, upright, floats = mooring[0], mooring[2], mooring[3]
    y = seek[c, Y]
    if not isfinite(m) or seek[c, TURN] == MOST_CORRECTIONS:
        return NOWHERE
    if seek[c, TURN] > 0.0 and y != seek[c, LAST]:
        slope = (m - seek[c, LAST_MISS]) / (y - seek[c, LAST])
        if slope < 0.0:
            seek[c, SLOPE] = slope
    small = SMALL * span
    if y < 0.0:
        small = min(small, -SMALL_SHARE * seek[c, SLOPE])
    following = y - m / seek[c, SLOPE]
    if is_another(seek[c, FOUND], following, mooring):
        return NOWHERE
    if abs(m) <= small:
        seek[c, Y] = following
        return THERE
    seek[c, TURN] += 1.0
    seek[c, LAST], seek[c, LAST_MISS] = y, m
    seek[c, Y] = min(max(following, -1.0 if floats and upright == 0.0 else 0.0), span)
    return AWAY
