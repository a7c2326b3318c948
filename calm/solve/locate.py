"""Search for approximate equilibria of a moored line.

Depths of the free end are tried from the upright line downwards. Floats at the surface are tried if
the upright line would leave the water.
"""

from math import isnan, nan, sqrt
from typing import NamedTuple

from calm.physics.compiled import set_row
from calm.physics.hull import AWASH
from calm.physics.passing import FAILURE, Z
from calm.physics.profile import Interval, Sea
from calm.solve.closing import (
    COARSEST_BRACKET,
    Root,
    coarse_miss,
    coarse_root,
    down_to,
    near_root,
    whole_line,
    with_sought,
)
from calm.solve.problem import (
    BELOW,
    CHOSEN,
    MOST_AFLOAT,
    NOT_RECORDED,
    LineProblem,
    Unknown,
)
from calm.solve.solution import (
    DRAGGED_DOWN,
    FOUND,
    MARCH_STOPPED,
    RISES,
    SLACK_AT_REST,
    TOO_MANY_AFLOAT,
)

SCAN = 16
"""Number of top depths tried between the upright line and its largest possible knockdown, if the
current grows or turns with depth. Separate equilibria closer than this spacing are not
distinguished.
"""
NEAR = (0.02, 0.2)
"""Additional depths tried near the upright line, as fractions of the first step of `SCAN`. A line
whose top is in a weak current may miss its anchor, but reach the anchor if its top is slightly
deeper, in a stronger current.
"""
DIP_SAMPLES = 8
"""Number of depths tried between three samples, to detect a change of sign of the height error."""
GOLDEN = 0.381966
ROUNDING = 1e-12
"""Relative rounding error of the current; a smaller growth of the current is ignored."""
SHARES = (0.0, 0.4, 0.7, 0.85, 0.94, 1.0 - AWASH, 0.995)
"""Used buoyancy fractions at which a line with its float at the surface is marched.

These marches search for an equilibrium at the surface, if the line also has an equilibrium with the
float immersed.
"""
SHARE_STEPS, CURRENT_STEPS = 8, 10
"""Numbers of steps in the search for several equilibria of a line at the surface.

SHARE_STEPS is the number of steps of the used buoyancy. The current is raised from zero in
CURRENT_STEPS steps, to select one of the equilibria.
"""
WEAK = 0.1
"""Speed, as a fraction of the maximum, below which a change of current direction is ignored."""

Sample = tuple[float, float]
"""A depth of the free end, and the height error of the line's end for this depth [m]."""


class CoarseRoots(NamedTuple):
    """Approximate equilibria of a line, either clear of the seabed or with a touchdown.

    Attributes
    ----------
    ending : FOUND, or the code of the reason for a failure
    value : number for the error message
    root : the highest equilibrium
    other : a second equilibrium, if `other.found` is true
    """

    ending: int
    value: float
    root: Root
    other: Root


def locate(problem: LineProblem, lands: bool, first: bool) -> CoarseRoots:
    """Find the approximate equilibria of a line, either clear of the seabed or with a touchdown.

    An equilibrium is unstable, and ignored, if the height error grows with the depth of the free
    end.

    Parameters
    ----------
    lands : whether the line has a touchdown
    first : whether to stop as soon as the highest equilibrium is found
    """
    unknown = whole_line(problem, lands)
    none = Root(False, unknown, nan, nan, nan)
    upright = max(-problem.limits.standing - unknown.goal, 0.0)
    samples = problem.work.samples
    count, samples[0][0] = 1, upright
    samples[1][0] = coarse_miss(problem, unknown, upright)
    if samples[1][0] < 0.0 < upright:
        # the drag of the current stretches the line further
        samples[0][1], samples[1][1] = upright, samples[1][0]
        samples[0][0], samples[1][0] = 0.0, coarse_miss(problem, unknown, 0.0)
        count = 2
    top, high = samples[0][0], samples[1][0]
    if isnan(high):
        return stopped(problem, none)
    highest = other = none
    if high < 0.0:
        at_surface = surface_root(problem, unknown, high)
        if at_surface.ending != FOUND:
            return at_surface
        highest, other = at_surface.root, at_surface.other
    elif top == 0.0:
        highest = awash(problem, unknown, high)
        if isnan(highest.miss) and highest.found:
            return stopped(problem, none)
    count = samples_below(problem, unknown, count)
    if count == 0:
        return stopped(problem, none)
    before: Sample = (nan, nan)
    for i in range(count):
        here = (samples[0][i], samples[1][i])
        between = here
        if 0 < i < count - 1:
            after = (samples[0][i + 1], samples[1][i + 1])
            earlier = (samples[0][i - 1], samples[1][i - 1])
            between = dip(problem, unknown, earlier, here, after)
            if isnan(between[1]):
                return stopped(problem, none)
        upper, second = (between, here) if between[0] < here[0] else (here, between)
        for step in range(2):
            lower = upper if step == 0 else second
            if before[1] >= 0.0 > lower[1]:
                root = coarse_root(problem, unknown, before[0], before[1], lower[0], lower[1])
                if isnan(root.miss):
                    return stopped(problem, none)
                if highest.found:
                    other = root
                else:
                    highest = root
                if first:
                    return CoarseRoots(FOUND, 0.0, highest, other)
            before = lower
    if not highest.found:
        return CoarseRoots(DRAGGED_DOWN, 0.0, none, none)
    return CoarseRoots(FOUND, 0.0, highest, other)


def stopped(problem: LineProblem, none: Root) -> CoarseRoots:
    """Return the outcome of the search if a march has failed."""
    return CoarseRoots(MARCH_STOPPED, problem.work.left[FAILURE], none, none)


def sample(problem: LineProblem, unknown: Unknown, count: int, depth: float) -> int:
    """March the line for a depth of the free end, and add the height error to the samples.

    Return the new number of samples.
    """
    miss = coarse_miss(problem, unknown, depth)
    samples = problem.work.samples
    samples[0][count], samples[1][count] = depth, miss
    return count + 1


def samples_below(problem: LineProblem, unknown: Unknown, count: int) -> int:
    """March the line for increasing depths of the free end, to separate the equilibria.

    The depths and the height errors of the line's end are added to the samples.
    Return the number of samples, or 0 if a march fails.
    """
    limits = problem.limits
    samples, deepest = problem.work.samples, limits.depth
    top, high = samples[0][0], samples[1][0]
    depth, low = samples[0][count - 1], samples[1][count - 1]
    growth = growth_below(problem.sea, top)
    if growth > 0.0 and (high < 0.0 or high > limits.allowed):
        fall = largest_fall(problem, unknown, top)
        if isnan(fall):
            return 0
        if fall * growth > 0.25:
            last = min(depth + 1.02 * fall, deepest)
            step = (last - depth) / SCAN
            for k in range(len(NEAR)):
                count = sample(problem, unknown, count, depth + NEAR[k] * step)
            for k in range(1, SCAN + 1):
                at = last if k == SCAN else depth + k * step
                count = sample(problem, unknown, count, at)
            if last < deepest:
                count = sample(problem, unknown, count, deepest)
            for k in range(count):
                if isnan(samples[1][k]):
                    return 0
            return count
    # the current hardly grows, so that the miss falls by more than the depth increases: one root
    shift = limits.allowed
    while high >= 0.0 and low >= 0.0 and depth < deepest:
        shift = max(low, shift)
        depth, shift = min(depth + shift, deepest), 2.0 * shift
        count = sample(problem, unknown, count, depth)
        low = samples[1][count - 1]
    return 0 if isnan(low) else count


def dip(
    problem: LineProblem, unknown: Unknown, before: Sample, here: Sample, after: Sample
) -> Sample:
    """Search for a change of sign of the height error near the middle one of three samples.

    The search runs only if the middle sample has the smallest absolute height error. Return a
    sample of the opposite sign, or the middle sample if there is none.
    """
    sign = 1.0 if here[1] > 0.0 else -1.0
    if not 0.0 < sign * here[1] < min(sign * before[1], sign * after[1]):
        return here
    low, best, high = before, here, after
    for _ in range(DIP_SAMPLES):
        left = best[0] - low[0] > high[0] - best[0]
        x = best[0] - GOLDEN * (best[0] - low[0] if left else best[0] - high[0])
        tried = (x, coarse_miss(problem, unknown, x))
        if isnan(tried[1]) or sign * tried[1] <= 0.0:
            return tried
        if sign * tried[1] < sign * best[1]:
            low, best, high = (low, tried, best) if left else (best, tried, high)
        elif left:
            low = tried
        else:
            high = tried
    return here


def growth_below(sea: Sea, depth: float) -> float:
    """Return the relative growth rate of the current below a given depth [1/m].

    The rate is the largest growth per metre, divided by the maximum speed. Two successive levels
    are compared. If the current turns, its component normal to the current at the upper level
    counts as growth.
    """
    greatest = rise = 0.0
    last = len(sea.intervals) - 1
    for k in range(1, last + 1):
        here = sea.intervals[k]
        square = here.u * here.u + here.v * here.v + here.w * here.w
        greatest = max(greatest, square)
        if k == last or not sea.levels[k + 1] > depth:
            continue
        below = sea.intervals[k + 1]
        product = here.u * below.u + here.v * below.v + here.w * below.w
        left = min(max(product / max(square, 1e-300), 0.0), 1.0)
        u, v, w = below.u - left * here.u, below.v - left * here.v, below.w - left * here.w
        new = sqrt(u * u + v * v + w * w)
        speed = sqrt(below.u * below.u + below.v * below.v + below.w * below.w)
        if new > ROUNDING * speed:
            rise = max(rise, new / (below.origin - here.origin))
    return rise / max(sqrt(greatest), 1e-300)


def largest_fall(problem: LineProblem, unknown: Unknown, depth: float) -> float:
    """Return an upper bound on the knockdown [m].

    The bound assumes that the strongest current acts at all depths.
    """
    sea = problem.sea
    greatest, fastest = 1, -1.0
    for k in range(1, len(sea.intervals)):
        here = sea.intervals[k]
        square = here.u * here.u + here.v * here.v + here.w * here.w
        if square > fastest:
            greatest, fastest = k, square
    most = sea.intervals[greatest]
    evenly = in_even_current(problem, most.u, most.v, most.w)
    miss = coarse_miss(evenly, unknown, depth)
    return nan if isnan(miss) else max(miss, problem.limits.allowed)


def in_even_current(problem: LineProblem, u: float, v: float, w: float) -> LineProblem:
    """Return a copy of the problem with a uniform current."""
    sea, even = problem.sea, problem.work.even
    for k in range(len(sea.intervals)):
        here = sea.intervals[k]
        row = Interval(here.origin, u, 0.0, v, 0.0, w, 0.0, here.density, here.ddensity)
        set_row(even, k, row)
    return in_sea(
        problem, Sea(sea.levels, even[: len(sea.intervals)], sea.bends, sea.gravity, sea.strata)
    )


def in_weaker_current(problem: LineProblem, share: float) -> LineProblem:
    """Return a copy of the problem with the current multiplied by the factor `share`."""
    sea, even = problem.sea, problem.work.even
    for k in range(len(sea.intervals)):
        here = sea.intervals[k]
        row = Interval(
            here.origin, share * here.u, share * here.du, share * here.v, share * here.dv,
            share * here.w, share * here.dw, here.density, here.ddensity,
        )  # fmt: skip
        set_row(even, k, row)
    return in_sea(
        problem, Sea(sea.levels, even[: len(sea.intervals)], sea.bends, sea.gravity, sea.strata)
    )


def in_sea(problem: LineProblem, sea: Sea) -> LineProblem:
    """Return a copy of the problem in other water."""
    return LineProblem(
        problem.course, sea, problem.loads, problem.flexible, problem.surfacing, problem.afloat,
        problem.hull, problem.limits, problem.starts, problem.work,
    )  # fmt: skip


def awash(problem: LineProblem, unknown: Unknown, immersed: float) -> Root:
    """Find the highest equilibrium with the top float at the surface.

    The line also has an equilibrium with this float immersed. If a march fails, `found` of the
    result is true, and `miss` is NaN.

    Parameters
    ----------
    immersed : height error with the free end at the surface and all buoyancy in use [m], at least 0
    """
    none = Root(False, unknown, nan, nan, nan)
    if not problem.limits.rides or len(problem.surfacing) == 0:
        return none
    unknown = with_sought(unknown, 0, True)
    share, high = SHARES[0], coarse_miss(problem, unknown, SHARES[0])
    for k in range(1, len(SHARES) + 1):
        following, low = 1.0, immersed
        if k < len(SHARES):
            following = SHARES[k]
            low = coarse_miss(problem, unknown, following)
        if isnan(low) or isnan(high):
            return Root(True, unknown, nan, nan, nan)
        if high > 0.0 >= low:
            root = coarse_root(problem, unknown, following, low, share, high)
            if isnan(root.miss) or len(problem.surfacing) == 1:
                return root
            height = height_at(problem, root, 1)
            if isnan(height):
                return Root(True, unknown, nan, nan, nan)
            return root if height <= problem.limits.allowed else none
        share, high = following, low
    return none


def surface_root(problem: LineProblem, unknown: Unknown, deep: float) -> CoarseRoots:
    """Find the equilibrium of a line with one or several floats at the surface.

    The unknown is the used fraction of the lowest surface float's buoyancy. A single float rides at
    its draft; several floats are assumed just below the surface.

    Parameters
    ----------
    deep : height error with the free end at the surface and all buoyancy in use [m], below 0
    """
    limits = problem.limits
    none = Root(False, unknown, nan, nan, nan)
    rides = unknown.rides
    count = len(problem.surfacing)
    for k in range(count):
        if k == MOST_AFLOAT:
            return CoarseRoots(TOO_MANY_AFLOAT, 0.0, none, none)
        unknown = with_sought(unknown, k, rides)
        if limits.at_rest and (unknown.lands or slack_at_rest(problem, unknown)):
            return CoarseRoots(SLACK_AT_REST, 0.0, none, none)
        unloaded = coarse_miss(problem, unknown, 0.0)
        if isnan(unloaded):
            return stopped(problem, none)
        if unloaded > 0.0:
            other, height = none, 0.0
            if k == 0 and turns_back(problem.sea):
                root, other = roots_afloat(problem, unknown)
            else:
                root = coarse_root(problem, unknown, 1.0, deep, 0.0, unloaded)
            if not isnan(root.miss) and k + 1 < count:
                height = height_at(problem, root, k + 1)
            if isnan(root.miss) or isnan(height):
                return stopped(problem, none)
            if k + 1 == count or height <= limits.allowed:
                return CoarseRoots(FOUND, 0.0, root, other)
        if k + 1 == count:
            break
        rides = False
        unknown = with_sought(unknown, k, rides)
        # the line between two floats at the surface determines the upper float's used buoyancy
        surfaced = surfaced_root(problem, unknown, k + 1)
        if isnan(surfaced.miss) and surfaced.found:
            return stopped(problem, none)
        if not surfaced.found:
            break
        problem.work.shares[0][k] = surfaced.x
        problem.work.shares[1][k] = surfaced.slope
        deep = coarse_miss(problem, with_sought(unknown, k + 1, rides), 1.0)
        if isnan(deep):
            return stopped(problem, none)
        if deep >= 0.0:
            break
    return CoarseRoots(RISES, 0.0, none, none)


def turns_back(sea: Sea) -> bool:
    """Return whether the current at two depths differs in direction by more than 90°.

    Weak currents are ignored.
    """
    last = len(sea.intervals)
    greatest = 0.0
    for k in range(1, last):
        here = sea.intervals[k]
        greatest = max(greatest, here.u * here.u + here.v * here.v)
    least = WEAK * WEAK * greatest
    for k in range(1, last):
        here = sea.intervals[k]
        if not here.u * here.u + here.v * here.v > least:
            continue
        for j in range(k + 1, last):
            below = sea.intervals[j]
            opposed = here.u * below.u + here.v * below.v < 0.0
            if opposed and below.u * below.u + below.v * below.v > least:
                return True
    return False


def roots_afloat(problem: LineProblem, unknown: Unknown) -> tuple[Root, Root]:
    """Find up to two stable equilibria of a line with its top float at the surface.

    The unknown is the used fraction of the float's buoyancy. The line reaches the first equilibrium
    as the current rises from zero. The second equilibrium may not be `found`.
    """
    lowest, highest = outer_roots(problem, unknown)
    if isnan(lowest.miss) or lowest.x == highest.x:
        return lowest, Root(False, unknown, nan, nan, nan)
    root = lowest
    small = 1e-4 * problem.limits.span
    for step in range(1, CURRENT_STEPS + 1):
        weaker = in_weaker_current(problem, step / CURRENT_STEPS)
        rising = weaker
        if step == 1:
            root, _ = outer_roots(rising, unknown)
        elif root.found:
            root = near_root(
                rising, root, problem.limits.coarse_step, CHOSEN, False, NOT_RECORDED, small,
                COARSEST_BRACKET,
            )  # fmt: skip
    at = root.x if root.found and root.unknown.sought == unknown.sought else 1.0
    if abs(lowest.x - at) < abs(highest.x - at):
        return lowest, highest
    return highest, lowest


def outer_roots(problem: LineProblem, unknown: Unknown) -> tuple[Root, Root]:
    """Find the stable equilibria with the smallest and the largest used buoyancy fraction.

    An equilibrium is stable if the height error falls as more buoyancy is used. Without a stable
    equilibrium, `found` of the results is false, and `miss` is NaN.
    """
    lowest = highest = Root(False, unknown, nan, nan, nan)
    share, high = 0.0, coarse_miss(problem, unknown, 0.0)
    for k in range(1, SHARE_STEPS + 1):
        following = k / SHARE_STEPS
        low = coarse_miss(problem, unknown, following)
        if high > 0.0 >= low:
            highest = coarse_root(problem, unknown, following, low, share, high)
            lowest = lowest if lowest.found else highest
        share, high = following, low
    return lowest, highest


def height_at(problem: LineProblem, root: Root, lower: int) -> float:
    """Return the height of the top of a given float above the surface, in an equilibrium [m].

    `lower` is the index of the float in `problem.surfacing`.
    """
    miss = coarse_miss(problem, down_to(problem, root.unknown, lower), root.x)
    return nan if isnan(miss) else problem.work.left[Z]


def surfaced_root(problem: LineProblem, unknown: Unknown, lower: int) -> Root:
    """Find the used buoyancy of a surface float for which the next float reaches the surface.

    `lower` is the index of the next float in `problem.surfacing`.
    """
    part = down_to(problem, unknown, lower)
    loaded, unloaded = coarse_miss(problem, part, 1.0), coarse_miss(problem, part, 0.0)
    if isnan(loaded) or isnan(unloaded):
        return Root(True, part, nan, nan, nan)
    if abs(unloaded) <= problem.limits.allowed:
        return Root(True, part, 0.0, unloaded, loaded - unloaded)
    if loaded >= 0.0 or unloaded < 0.0:
        return Root(False, part, nan, nan, nan)
    return coarse_root(problem, part, 1.0, loaded, 0.0, unloaded)


def slack_at_rest(problem: LineProblem, unknown: Unknown) -> bool:
    """Return whether a line with its float at the surface is slack in still water.

    The float is assumed to use only the buoyancy fraction `BuoyantPiece.least`.
    """
    assert unknown.sought != BELOW
    least = problem.surfacing[unknown.sought].least
    share = min(max(least, 0.0) * (1.0 + 1e-9) + 1e-9, 1.0)
    return coarse_miss(problem, unknown, share) < 0.0
