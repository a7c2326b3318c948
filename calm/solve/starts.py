"""Where one of many profiles is sought first: from where the line is found in even currents.

What it is sought from follows from the profile alone, so that neither the order of many nor their
company changes a digit.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan, nan, sqrt

from calm.physics.profile import Sea
from calm.solve.closing import Root, coarse_about, whole_line, with_sought
from calm.solve.endings import FOUND
from calm.solve.locate import growth_below, in_even_current, locate
from calm.solve.problem import BELOW, FASTEST, STARTS, About, Search

NOWHERE_NEAR = 0.97
"""Share of its buoyancy in use beyond which a float may as well be under water."""
GROWS = 0.25
"""Growth of the current along the greatest fall of a line beyond which depths are scanned."""


def fill_starts(search: Search) -> int:
    """Find a line in even currents; returns how many of them it is found in.

    The rows of `Problem.starts` are, clear of the seabed and lying on it: the unknown, the depth of
    the free end [m] or, below 0, the share in use less one; the slope of the miss; the fall [m].
    """
    problem, found = search.problem, 0
    limits, starts = problem.limits, problem.starts
    for way in range(2):
        lands = way == 1
        unknown = whole_line(problem, lands)
        upright = max(-limits.standing - unknown.goal, 0.0)
        for k in range(STARTS):
            speed = FASTEST * max(k, 1e-3) / (STARTS - 1)
            evenly = in_even_current(problem, speed, 0.0, 0.0)
            about = coarse_about(search, unknown)
            fall = search.miss(
                About(evenly, unknown, about.step, about.cuts, about.given, about.record), upright
            )
            starts[3 * way + 2][k] = limits.depth if isnan(fall) else max(fall, limits.allowed)
            starts[3 * way][k] = starts[3 * way + 1][k] = nan
            if limits.lift <= 0.0 and not lands:
                continue
            located = locate(Search(search.miss, evenly), lands)
            root = located.root
            if located.ending != FOUND or root.unknown.sought > 0:
                continue
            found += 1
            starts[3 * way][k] = root.x if root.unknown.sought == BELOW else root.x - 1.0
            starts[3 * way + 1][k] = root.slope
    return found


def start_of(search: Search, lands: bool) -> Root:
    """Return where a line is sought first; not `found` where the whole search is needed."""
    problem, limits = search.problem, search.problem.limits
    unknown = whole_line(problem, lands)
    nowhere = Root(False, unknown, nan, nan, nan)
    if len(problem.starts[0]) == 0 or limits.at_rest:
        return nowhere
    row = 3 if lands else 0
    upright = max(-limits.standing - unknown.goal, 0.0)
    fastest, speed = speeds_of(problem.sea, upright, limits.depth)
    x = at_speed(problem.starts[row], speed)
    slope = at_speed(problem.starts[row + 1], speed)
    if isnan(x) or not slope < 0.0:
        return nowhere
    if x >= 0.0:
        growth = growth_below(problem.sea, upright)
        if growth * at_speed(problem.starts[row + 2], fastest) > GROWS or upright == 0.0:
            return nowhere
        return Root(True, unknown, x, 0.0, slope)
    if x > NOWHERE_NEAR - 1.0:
        return nowhere
    return Root(True, with_sought(unknown, 0, unknown.rides), 1.0 + x, 0.0, slope)


def at_speed(row: Sequence[float], speed: float) -> float:
    """Return what is known of a line in an even current, linear between the speeds."""
    at = min(speed / FASTEST, 1.0) * (STARTS - 1)
    k = min(int(at), STARTS - 2)
    return row[k] + (at - k) * (row[k + 1] - row[k])


def speeds_of(sea: Sea, top: float, depth: float) -> tuple[float, float]:
    """The greatest speed of a current, and that of an even one that drags a line down alike [m/s].

    A taut cable leans by what drags it above, and is dragged down by the square of its lean.

    Parameters
    ----------
    top, depth : of the line, and of the water [m]
    """
    greatest = east = north = lean = 0.0
    for k in range(1, len(sea.intervals)):
        here = sea.intervals[k]
        greatest = max(greatest, here.u * here.u + here.v * here.v + here.w * here.w)
        upper = top if k == 1 else max(here.origin, top)
        lower = min(sea.levels[k + 1], depth)
        if lower <= upper:
            continue
        thick, middle = lower - upper, 0.5 * (lower + upper) - here.origin
        if k == 1 and middle < 0.0:
            middle = 0.0
        u, v = here.u + here.du * middle, here.v + here.dv * middle
        drag = 0.5 * thick * sqrt(u * u + v * v)
        east, north = east + drag * u, north + drag * v
        lean += thick * (east * east + north * north)
        east, north = east + drag * u, north + drag * v
    length = max(depth - top, 1e-3 * depth)
    even = sqrt(3.0 * lean / (length * length * length))
    return sqrt(greatest), sqrt(even)
