"""Closing of a line: search for the equilibrium in which the line ends at its target.

The target is the top of the anchor, or the seabed for a line with a touchdown. A line has one
unknown: the depth of its free end, or the used fraction of a float's buoyancy. The *miss* is the
height error of a marched line, the height of its end above the target [m]. The height error falls
as the free end goes deeper, or as more buoyancy is used.
"""

from math import isnan, nan
from typing import NamedTuple

from calm.physics.compiled import set_row
from calm.physics.hull import Riding, riding_of
from calm.physics.line import GOES_ON
from calm.physics.passing import (
    FAILURE,
    GROUNDED,
    HANGING,
    LANDED,
    NODES,
    MarchSettings,
    Z,
    pass_line,
)
from calm.physics.seawater import REFERENCE_DENSITY
from calm.physics.track import Load
from calm.solve.least_change import bracketed_root, root_near
from calm.solve.problem import (
    BELOW,
    CHANGED,
    CHOSEN,
    HALVED,
    LAST,
    MARCHES,
    NOT_RECORDED,
    OTHER,
    About,
    LineProblem,
    Unknown,
    reach_of,
)
from calm.solve.solution import FOUND, MARCH_STOPPED, MISSES, NO_SHAPE_NEAR, SLACK_ON_DIGITS

OF_A_PART = 0.01
"""Allowed height error of the part of a line above a surface float.

The value is a fraction of the allowed height error of the whole line. Such a part is light and
slack.
"""
NEARLY_LINEAR = 5e-3
"""Height error, as a fraction of the span, at which a final secant step is precise enough.

Smaller height errors are nearly linear in the unknown of the line.
"""
ABOUT, WELL_KNOWN = 2e-3, 1e-6
"""Height error, as a fraction of the span, at which the choice of segments ends.

ABOUT applies in a batch, WELL_KNOWN to a single line. With a height error of a thousandth of the
span, a slack line would choose other segments.
"""
COARSEST_BRACKET = 1e-7
NARROWEST_BRACKET = 1e-15
"""Relative bracket width at which the search for an equilibrium ends.

COARSEST_BRACKET applies to marches that choose their segments, NARROWEST_BRACKET to marches on
fixed segments.
"""


class Root(NamedTuple):
    """An equilibrium of a line, exact or approximate.

    Attributes
    ----------
    found : whether there is an equilibrium
    x : value of the unknown: depth of the free end [m], or used fraction of a float's buoyancy
    miss : height error of the line's end at x [m]; NaN if a march failed
    slope : derivative of the height error with respect to x
    """

    found: bool
    unknown: Unknown
    x: float
    miss: float
    slope: float


class Closed(NamedTuple):
    """Outcome of closing a line.

    Attributes
    ----------
    ending : FOUND, or the code of the reason for failure (see `calm.solve.solution`)
    value, piece : number for the error message, and index of the piece concerned
    root : the equilibrium, with the remaining height error
    nodes, hanging : number of nodes, and number of suspended elements
    landed, grounded : whether there is a touchdown, and unstretched length on the seabed [m]
    """

    ending: int
    value: float
    piece: int
    root: Root
    nodes: int
    hanging: int
    landed: bool
    grounded: float
    segments: int


def whole_line(problem: LineProblem, lands: bool) -> Unknown:
    """Return the `Unknown` of a whole line: the depth of its free end.

    Parameters
    ----------
    lands : whether the line may lie on the seabed. The target is then the seabed, otherwise the top
        of the anchor
    """
    limits = problem.limits
    height = 0.0 if lands else limits.anchor_height
    return Unknown(height - limits.depth, BELOW, limits.rides, lands, len(problem.course.stages))


def down_to(problem: LineProblem, unknown: Unknown, lower: int) -> Unknown:
    """Return the `Unknown` of the part of a line above a given float.

    This part must end at the surface. `lower` is the index of the float in `problem.surfacing`.
    """
    stages = int(problem.surfacing[lower].stage)
    return Unknown(0.0, unknown.sought, unknown.rides, False, stages)


def with_sought(unknown: Unknown, sought: int, rides: bool) -> Unknown:
    """Return a copy of an `Unknown`, with other values of `sought` and `rides`."""
    return Unknown(unknown.goal, sought, rides, unknown.lands, unknown.stages)


def miss_at(about: About, x: float) -> float:
    """March a line, and return the height error of its end [m], or NaN if the march fails.

    `x` is the depth of the free end, or the used fraction of a float's buoyancy. The other results
    stay in the work arrays.
    """
    problem, unknown, work = about.problem, about.unknown, about.problem.work
    depth, out = place(problem, unknown, x)
    how = MarchSettings(
        about.step,
        reach_of(problem.limits, about.step),
        problem.limits.near,
        unknown.stages,
        unknown.lands,
        problem.limits.bed,
        about.given,
        about.given,
        about.cuts == HALVED,
        about.record != NOT_RECORDED,
    )
    cuts, counts, record = work.chosen, work.counts, work.records[max(about.record, 0)]
    pass_line(problem.course, problem.sea, how, depth, out, cuts, counts, record, work.left)
    work.left[LAST] = x
    if unknown.stages == len(problem.course.stages):
        work.left[MARCHES] += 1
    if work.left[FAILURE] != GOES_ON:
        return nan
    return work.left[Z] - unknown.goal


def place(problem: LineProblem, unknown: Unknown, x: float) -> tuple[float, float]:
    """Set the loads of the pieces at the surface, before a march.

    Parameters
    ----------
    x : depth of the free end [m], or used fraction of a float's buoyancy

    Returns
    -------
    Depth of the free end [m], and length of the line above the surface [m].
    """
    work, loads, given = problem.work, problem.course.loads, problem.loads
    if work.left[CHANGED] > 0.0:
        for i in range(int(work.left[CHANGED])):
            set_row(loads, i, given[i])
        work.left[CHANGED] = 0.0
    if unknown.sought == BELOW:
        return x, 0.0
    lowest = problem.course.stages[problem.surfacing[unknown.sought].stage]
    work.left[CHANGED] = lowest.first + lowest.size
    for k in range(unknown.sought + 1):
        share = x if k == unknown.sought else work.shares[0][k]
        place_of = problem.surfacing[k].load
        set_row(loads, place_of, with_share(given[place_of], share))
    if not unknown.rides:
        return 0.0, 0.0
    own = problem.surfacing[unknown.sought]
    riding = riding_of(problem.afloat, problem.hull, x)
    stage = problem.course.stages[own.stage]
    for i in range(stage.first, stage.first + stage.size):
        if given[i].piece < own.piece:
            set_row(loads, i, lifted_out(given[i], riding.above, problem.sea.gravity))
    set_row(loads, own.load, as_riding(with_share(given[own.load], x), riding))
    if own.stage > 0:
        return 0.0, 0.0
    return 0.0, riding.above * own.rigid_above + riding.standing * own.length


def with_share(load: Load, share: float) -> Load:
    """Return the load of a float that uses a given fraction of its buoyancy."""
    return changed(
        load, share * load.buoyancy, share * load.volume, 1.0, load.lift, load.push_east,
        load.push_north,
    )  # fmt: skip


def as_riding(load: Load, riding: Riding) -> Load:
    """Return the load of a float at the surface, with the wind force and the reduced drag there."""
    return changed(
        load, load.buoyancy, load.volume, riding.drag, load.lift, riding.push_east,
        riding.push_north,
    )  # fmt: skip


def lifted_out(load: Load, share: float, gravity: float) -> Load:
    """Return the load of a piece that is partly out of the water.

    The emerged fraction (`share`) has no drag and displaces no water.
    """
    wet = 1.0 - share
    buoyancy = load.buoyancy - share * REFERENCE_DENSITY * gravity * load.volume
    return changed(
        load, buoyancy, wet * load.volume, wet, wet * load.lift, load.push_east, load.push_north
    )


def changed(
    load: Load,
    buoyancy: float,
    volume: float,
    drag: float,
    lift: float,
    push_east: float,
    push_north: float,
) -> Load:
    """Return a copy of a load with new forces, and with the drag factors multiplied by `drag`."""
    return Load(
        load.piece, load.clamp, load.at, load.lever, load.length, buoyancy, volume,
        drag * load.normal_drag, drag * load.tangential_drag, load.directional, lift, push_east,
        push_north, load.diameter, load.lengthening,
    )  # fmt: skip


def coarse_about(problem: LineProblem, unknown: Unknown) -> About:
    """Return the settings for marches with the coarse angle step, to bracket an equilibrium."""
    step = problem.limits.coarse_step
    return About(problem, unknown, step, CHOSEN, False, NOT_RECORDED)


def coarse_miss(problem: LineProblem, unknown: Unknown, x: float) -> float:
    """Return the height error of the line's end in a march with the coarse angle step [m]."""
    return miss_at(coarse_about(problem, unknown), x)


def coarse_root(
    problem: LineProblem, unknown: Unknown, a: float, miss_a: float, b: float, miss_b: float
) -> Root:
    """Find an equilibrium by marches with the coarse angle step.

    The accuracy is about 1e-4 of the span.

    Parameters
    ----------
    a, b : limits of the depth of the free end, or of the used fraction of a float's buoyancy
    miss_a, miss_b : height errors of the line's end at a and b [m]
    """
    span = problem.limits.span
    small, linear = 1e-4 * span, unknown.sought == BELOW
    if linear:  # below the surface the miss is almost linear, so the last step needs no march
        small = max(small, 0.2 * max(abs(miss_a), abs(miss_b)))
    x, miss, slope = bracketed_root(
        miss_at, coarse_about(problem, unknown), a, miss_a, b, miss_b,
        min(small, NEARLY_LINEAR * span), COARSEST_BRACKET * abs(b - a),
    )  # fmt: skip
    if linear and slope != 0.0:
        x -= miss / slope
    return Root(True, unknown, x, miss, slope)


def planned(problem: LineProblem, root: Root, step: float) -> Root:
    """Choose the segments for an angle step, and estimate the equilibrium on these segments.

    `root` is an approximate equilibrium. The line is not marched at the new estimate.
    """
    limits = problem.limits
    small, record = (ABOUT, OTHER) if limits.near > 0.0 else (WELL_KNOWN, NOT_RECORDED)
    small *= limits.span
    found = near_root(problem, root, step, CHOSEN, False, record, small, COARSEST_BRACKET)
    if not found.found and not isnan(found.miss):
        return root
    # the miss is continuous only if the segments of the last march are kept
    x = found.x
    if found.slope < 0.0:
        x -= found.miss / found.slope
    return Root(True, found.unknown, x, found.miss, found.slope)


def segments_of(problem: LineProblem, cuts: int) -> int:
    """Return the number of segments in a segment list (HALVED has twice as many as CHOSEN)."""
    chosen = 0
    for k in range(len(problem.course.cables)):
        chosen += problem.work.counts[k]
    return 2 * chosen if cuts == HALVED else chosen


def polish(problem: LineProblem, root: Root, cuts: int, record: int) -> Closed:
    """Close a line on fixed segments, starting from an approximate equilibrium.

    If several floats are at the surface, `root` is for the lowest of them. The used buoyancies of
    the floats above are computed first.
    """
    unknown, shares = root.unknown, problem.work.shares
    if isnan(root.miss):
        return not_closed(MARCH_STOPPED, problem.work.left[FAILURE], root)
    for k in range(unknown.sought):
        part = down_to(problem, with_sought(unknown, k, False), k + 1)
        near = Root(True, part, shares[0][k], 0.0, shares[1][k])
        closed = close_near(problem, near, cuts, record)
        if closed.ending != FOUND:
            return closed
        shares[0][k], shares[1][k] = closed.root.x, closed.root.slope
    return close_near(problem, root, cuts, record)


def close_near(problem: LineProblem, root: Root, cuts: int, record: int) -> Closed:
    """Close a line, or a part of a line, on fixed segments near an approximate equilibrium."""
    limits = problem.limits
    small = 0.1 * limits.allowed
    if limits.near > 0.0:
        small = (4.0 if cuts == CHOSEN else 0.5) * limits.allowed
    if root.unknown.sought != BELOW:
        small = min(small, limits.share_allowed * abs(root.slope))
    if limits.near > 0.0 and root.unknown.stages < len(problem.course.stages):
        small *= OF_A_PART
    found = near_root(
        problem, root, limits.angle_step, cuts, True, record, small, NARROWEST_BRACKET
    )
    left = problem.work.left
    if isnan(found.miss):
        return not_closed(MARCH_STOPPED, left[FAILURE], found)
    if not found.found:
        return not_closed(NO_SHAPE_NEAR, 0.0, found)
    if abs(found.miss) > max(limits.allowed, small):
        ending = MISSES if found.unknown.sought == BELOW else SLACK_ON_DIGITS
        return not_closed(ending, abs(found.miss), found)
    nodes, hanging = int(left[NODES]), int(left[HANGING]) - 1
    segments = segments_of(problem, cuts)
    return Closed(
        FOUND, 0.0, -1, found, nodes, hanging, left[LANDED] >= 0.0, left[GROUNDED], segments
    )


def not_closed(ending: int, value: float, root: Root) -> Closed:
    """Return the `Closed` record for a line that cannot be closed."""
    return Closed(ending, value, -1, root, 0, 0, False, 0.0, 0)


def near_root(
    problem: LineProblem,
    root: Root,
    step: float,
    cuts: int,
    given: bool,
    record: int,
    small: float,
    narrow: float,
) -> Root:
    """Find the equilibrium of a line near an approximate equilibrium.

    The unknown is the depth of the free end, or the used fraction of a float's buoyancy. If the
    free end reaches the surface, the buoyancy of the top float becomes the unknown. If the whole
    buoyancy of the top float is used, the depth becomes the unknown. The last march is at the
    equilibrium.

    Parameters
    ----------
    step, cuts, given, record : as in `About`
    small : height error at which the search ends [m]
    narrow : bracket width at which the search ends, as a fraction of the unknown's range
    """
    unknown, x, slope = root.unknown, root.x, root.slope
    miss = 0.0
    for side in range(2):
        about = About(problem, unknown, step, cuts, given, record)
        high = problem.limits.span if unknown.sought == BELOW else 1.0
        found, x, miss, slope = root_near(miss_at, about, x, slope, 0.0, high, small, narrow * high)
        if found:
            if x != problem.work.left[LAST] and not isnan(miss):
                miss = miss_at(about, x)
            return Root(True, unknown, x, miss, slope)
        whole = unknown.stages == len(problem.course.stages)
        across = whole and unknown.sought <= 0 and len(problem.surfacing) > 0
        if side > 0 or not across:
            break
        if unknown.sought == BELOW:
            unknown, x = with_sought(unknown, 0, unknown.rides), 1.0
            slope = -0.01 * problem.limits.depth
        else:
            unknown, x, slope = with_sought(unknown, BELOW, unknown.rides), 0.0, -1.0
    return Root(False, unknown, x, miss, slope)
