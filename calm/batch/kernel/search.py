"""What a lane does next: one step of the search for the root of one case.

`calm.solve.locate` has the reasons of each step.
"""

from __future__ import annotations

from math import isfinite, nan
from typing import Any, NamedTuple

from calm.batch.kernel.endings import (
    AT_SURFACE,
    LOST,
    SOLVED,
    TURNS_BACK,
    UNCLOSED,
)
from calm.batch.kernel.layout import Aim, Way
from calm.physics.hull import AWASH as GOING_UNDER

Searches = Any
"""Of every case a record of `Search`."""


class Search(NamedTuple):
    """What is known of a case.

    Attributes
    ----------
    unknown : depth of the free end [m] where not negative, else the share in use less one
    above, below : ends of the bracket; above, the miss is not negative
    last : where the last march was, older_miss the miss before that
    slope : of the miss
    fall, reach, turn : the largest knockdown, 0 where there is no scan; how far down from its
        beginning is scanned; which step, or correction, it is
    stuck : how many steps have not halved the smallest miss, `best`
    found : the coarse root
    upper, lower : where the scan has seen the miss change its sign
    growth, speed : of the current with depth [1/m], and its greatest [m/s]
    least_carried : vertical force where the line carries least of what may land [N]
    lying : length on the seabed [m]; below 0 where none is
    lowest : lowest place of the shape [m]
    corners : turn times length of its worst corner [m]
    place_before, tension_before : what the last halving but one changed
    refusal : why its shape is not to be had, `SOLVED` where it is
    tried : 1 on the seabed, 2 clear of it again
    sought : which of several floats at the surface is sought, the uppermost 0
    aloft, aloft_slope, aloft_found : the search clear of the seabed, while it is sought there
    """

    unknown: float
    above: float
    above_miss: float
    below: float
    below_miss: float
    last: float
    last_miss: float
    older_miss: float
    slope: float
    fall: float
    reach: float
    turn: int
    stuck: int
    best: float
    found: float
    upper: float
    upper_miss: float
    lower: float
    lower_miss: float
    growth: float
    speed: float
    least_carried: float
    lying: float
    lowest: float
    corners: float
    place_before: float
    tension_before: float
    refusal: int
    tried: int
    sought: int
    aloft: float
    aloft_slope: float
    aloft_found: float


DONE, FIRST, UNLOADED, TOP, AWASH, SCAN, ROOT = range(7)
"""What a lane is about to learn from its next march."""

MOST_CORRECTIONS = 12
SMALL, SMALL_SHARE = 5e-7, 3e-6
"""The miss of a closed line, as a share of the span; and how well a share in use is found."""

ALL_BUT_UNLOADED = 1e-9
"""Share in use of a float that carries nothing: with none at all its axis may be anywhere."""
FLAT = -0.25
"""Slope of the miss; where the current is even, it is -1."""
STRAYED, STRAYED_SHARE = 2e-3, 0.02
"""How far a root may be from the coarse one, as a share of the span, and of the buoyancy: beyond,
it may be another one."""

THERE, AWAY, NOWHERE = range(3)
"""Where a correction finds itself."""


def begin(seek: Searches, c: int, growth: float, speed: float, way: Way) -> None:
    """Set out on a case: from the depth of the line standing in still water."""
    case, falls = seek[c], way.falls
    case.above = case.above_miss = case.below = case.below_miss = nan
    case.last = case.last_miss = case.older_miss = case.reach = case.found = nan
    case.upper = case.upper_miss = case.lower = case.lower_miss = nan
    case.growth, case.speed = growth, speed
    case.unknown, case.slope, case.turn, case.stuck = way.aim.upright, -1.0, 0, 0
    # where the miss may rise with depth, depths are scanned
    last = falls.size - 1
    at = min(speed / way.fall_step, last - 1e-9)
    j = int(at)
    fall = falls[j] + (at - j) * (falls[j + 1] - falls[j])
    case.fall = fall if fall * growth > 0.25 else 0.0


def advance(seek: Searches, c: int, task: int, m: float, way: Way) -> tuple[int, int]:
    """The next task of a case whose unknown leads to the miss m, and how its search ended."""
    aim, shares, y = way.aim, way.shares, seek[c].unknown
    if not isfinite(m):
        return DONE, UNCLOSED
    if task == FIRST:
        if m >= 0.0 and way.joints.size:
            return DONE, AT_SURFACE
        if m >= 0.0:
            seek[c].above, seek[c].above_miss = y, m
            if aim.upright == 0.0 and aim.rides:
                seek[c].unknown = shares[0] - 1.0
                return AWASH, SOLVED
            return go_down(seek, c, way), SOLVED
        seek[c].below, seek[c].below_miss = y, m
        if aim.upright > 0.0:
            seek[c].unknown = 0.0
            return TOP, SOLVED
        seek[c].unknown = ALL_BUT_UNLOADED - 1.0
        return (UNLOADED, SOLVED) if aim.floats else (DONE, AT_SURFACE)
    if task in (TOP, UNLOADED):
        if m <= 0.0:
            return DONE, AT_SURFACE
        seek[c].above, seek[c].above_miss = y, m
        return bracket(seek, c), SOLVED
    if task == AWASH:
        if seek[c].last_miss > 0.0 and m <= 0.0:
            seek[c].above, seek[c].above_miss = seek[c].last, seek[c].last_miss
            seek[c].below, seek[c].below_miss = y, m
            return bracket(seek, c), SOLVED
        seek[c].turn += 1
        seek[c].last, seek[c].last_miss = y, m
        if seek[c].turn < shares.size:
            seek[c].unknown = shares[seek[c].turn] - 1.0
            return AWASH, SOLVED
        if m <= 0.0:
            return DONE, TURNS_BACK
        seek[c].unknown = 0.0
        return go_down(seek, c, way), SOLVED
    if task == SCAN:
        return scan(seek, c, m, way)
    return narrow(seek, c, m, aim.span)


def go_down(seek: Searches, c: int, way: Way) -> int:
    """Begin the search below the surface, from above."""
    span, y, m = way.aim.span, seek[c].above, seek[c].above_miss
    seek[c].last, seek[c].last_miss, seek[c].older_miss = y, m, nan
    if m > 1e-7 * span and seek[c].fall > 0.0:
        seek[c].reach, seek[c].turn = min(1.02 * seek[c].fall, span - y), 0
        seek[c].unknown = y + way.scanned[0] * seek[c].reach
        return SCAN
    seek[c].best = abs(m)
    seek[c].unknown = min(y + max(m, 1e-7 * span), span)
    return ROOT


def bracket(seek: Searches, c: int) -> int:
    """Go on between the ends of a bracket, where their chord crosses nothing."""
    a, fa, b, fb = seek[c].above, seek[c].above_miss, seek[c].below, seek[c].below_miss
    seek[c].upper, seek[c].upper_miss, seek[c].lower, seek[c].lower_miss = a, fa, b, fb
    seek[c].slope = (fb - fa) / (b - a)
    seek[c].last, seek[c].last_miss = (a, fa) if fa < -fb else (b, fb)
    seek[c].best = abs(seek[c].last_miss)
    seek[c].unknown = a - fa / seek[c].slope
    return ROOT


def scan(seek: Searches, c: int, m: float, way: Way) -> tuple[int, int]:
    """Go down until the miss is negative."""
    span, y, before = way.aim.span, seek[c].unknown, seek[c].last_miss
    if m < 0.0:
        seek[c].above, seek[c].above_miss = seek[c].last, before
        seek[c].below, seek[c].below_miss = y, m
        return bracket(seek, c), SOLVED
    if seek[c].older_miss > before and m > before > 0.0:
        return DONE, TURNS_BACK
    if y >= span:
        return DONE, LOST
    seek[c].older_miss, seek[c].last_miss, seek[c].last = before, m, y
    seek[c].turn += 1
    following = span
    if seek[c].turn < way.scanned.size:
        following = min(seek[c].above + way.scanned[seek[c].turn] * seek[c].reach, span)
    seek[c].unknown = following
    return SCAN, SOLVED


def narrow(seek: Searches, c: int, m: float, span: float) -> tuple[int, int]:
    """One secant step, or one that halves the bracket."""
    y, last, before = seek[c].unknown, seek[c].last, seek[c].last_miss
    if m >= 0.0:
        seek[c].above, seek[c].above_miss = y, m
    else:
        seek[c].below, seek[c].below_miss = y, m
    if y != last:
        seek[c].slope = (m - before) / (y - last)
    a, b, slope = seek[c].above, seek[c].below, seek[c].slope
    following = y - m / slope if slope < 0.0 else nan
    if abs(m) <= 1e-5 * span or abs(b - a) <= 1e-9 * span:
        if slope < 0.0:
            seek[c].unknown = following
        else:
            seek[c].slope = -1.0
        seek[c].found = seek[c].unknown
        return DONE, TURNS_BACK if seek[c].fall > 0.0 and may_turn(seek, c) else SOLVED
    seek[c].stuck = seek[c].stuck + 1 if abs(m) > 0.5 * seek[c].best else 0
    seek[c].best = min(seek[c].best, abs(m))
    if isfinite(a) and isfinite(b):
        if not a < following < b or seek[c].stuck > 2:
            following = 0.5 * (a + b)
            seek[c].stuck = 0
    elif y >= span:
        return DONE, LOST
    else:
        furthest = y + 4.0 * max(m, y - last)
        following = min(following if following > y else furthest, furthest, span)
    seek[c].last, seek[c].last_miss = y, m
    seek[c].unknown = following
    return ROOT, SOLVED


def may_turn(seek: Searches, c: int) -> bool:
    """Whether the miss is so flat by the root that finer cuts may find the highest one elsewhere.

    There, or on the way from the depths of the scan on either side.
    """
    y = seek[c].unknown
    above, below = y - seek[c].upper, seek[c].lower - y
    return bool(
        y > 0.0
        and (
            seek[c].slope > FLAT
            or -seek[c].upper_miss > FLAT * above
            or seek[c].lower_miss > FLAT * below
        )
    )


def is_another(found: float, y: float, aim: Aim) -> bool:
    """Whether a root may not be the one found on coarse cuts, or is about to go under."""
    under = aim.rides and -GOING_UNDER < y < STRAYED * aim.span
    if (found < 0.0) != (y < 0.0) or (aim.floats and aim.upright == 0.0 and under):
        return True
    return abs(y - found) > (STRAYED_SHARE if y < 0.0 else STRAYED * aim.span)


def correct(seek: Searches, c: int, m: float, aim: Aim) -> int:
    """A secant step near the root: whether the miss m is small enough, or a next one is to come."""
    y = seek[c].unknown
    if not isfinite(m) or seek[c].turn == MOST_CORRECTIONS:
        return NOWHERE
    if seek[c].turn > 0 and y != seek[c].last:
        slope = (m - seek[c].last_miss) / (y - seek[c].last)
        if slope < 0.0:
            seek[c].slope = slope
    small = SMALL * aim.span
    if y < 0.0:
        small = min(small, -SMALL_SHARE * seek[c].slope)
    following = y - m / seek[c].slope
    if is_another(seek[c].found, following, aim):
        return NOWHERE
    if abs(m) <= small:
        seek[c].unknown = following
        return THERE
    seek[c].turn += 1
    seek[c].last, seek[c].last_miss = y, m
    least = -1.0 if aim.floats and aim.upright == 0.0 else 0.0
    seek[c].unknown = min(max(following, least), aim.span)
    return AWAY
