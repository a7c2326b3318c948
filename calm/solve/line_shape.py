"""Shapes of a moored line on coarse and on halved segments, as `calm.solve.fineness` requires."""

from math import inf, isnan
from typing import NamedTuple

from calm.physics.line import ENDS, SEGMENT, Record, off_bed
from calm.physics.passing import NODES
from calm.solve.accuracy import UNKNOWN_ERRORS, Errors, Extent, extrapolate
from calm.solve.closing import Closed, Root, miss_at, not_closed, planned, polish, segments_of
from calm.solve.fineness import MOST_ROUNDS, finer
from calm.solve.problem import (
    BELOW,
    CHOSEN,
    COARSE,
    FINE,
    HALVED,
    LAST,
    OTHER,
    About,
    LineProblem,
)
from calm.solve.solution import (
    BELOW_SEABED,
    FOUND,
    NO_SHAPE_NEAR,
    OtherEquilibrium,
)

MOST_BETWEEN = 6
"""Largest number of marches to find two shapes that are close enough for linear interpolation."""
LINEAR = 4e-7
"""Largest product of the height errors of two shapes, in squared spans.

If the product is larger, linear interpolation between the shapes is not accurate enough.
"""
FAR = 3e-4
"""Largest height error of a line on halved segments, as a fraction of the span.

If the error is larger, the shape is not corrected by linear interpolation.
"""
COARSE_REJECTION_DEPTH = 0.01
"""Depth below the seabed, as a fraction of the water depth, at which a line is rejected already on
coarse segments.
"""


class FoundShape(NamedTuple):
    """A shape of a line, or the reason why no shape was found.

    Attributes
    ----------
    closed : outcome, and number of nodes. The shape is in the record `FINE`; the columns from
        `BETTER` on hold the extrapolated shape
    share : extrapolated depth of the free end [m], or used fraction of a float's buoyancy
    grounded : extrapolated length on the seabed [m]
    closure, moment : relative force imbalance, and moment residual [rad], from the audit
    other : a second equilibrium of the line
    """

    closed: Closed
    errors: Errors
    share: float
    grounded: float
    closure: float
    moment: float
    other: OtherEquilibrium


NO_OTHER = OtherEquilibrium(-1.0, 0.0, 0.0, 0.0, 0.0)


def not_audited(closed: Closed, errors: Errors, share: float, grounded: float) -> FoundShape:
    """Return a `FoundShape` that has not been audited yet."""
    return FoundShape(closed, errors, share, grounded, 0.0, 0.0, NO_OTHER)


def refused(ending: int, value: float, piece: int, root: Root) -> FoundShape:
    """Return the `FoundShape` for a line without a shape; `ending` and `value` give the reason."""
    closed = Closed(ending, value, piece, root, 0, 0, False, 0.0, 0)
    return not_audited(closed, UNKNOWN_ERRORS, root.x, 0.0)


def settle_line(problem: LineProblem, root: Root, hangs: bool) -> FoundShape:
    """Close a line near an approximate equilibrium, on sufficiently short segments.

    The shape is written to the record `FINE`, without an audit.

    Parameters
    ----------
    hangs : whether the line must stay clear of the seabed
    """
    limits = problem.limits
    coarse = fine = not_closed(NO_SHAPE_NEAR, 0.0, root)
    errors, step, records = UNKNOWN_ERRORS, limits.angle_step, problem.work.records
    for _ in range(MOST_ROUNDS):
        coarse, fine = close_both(problem, fine.root, step, hangs)
        if fine.ending != FOUND:
            return not_audited(fine, UNKNOWN_ERRORS, fine.root.x, 0.0)
        errors = extrapolate(
            records[COARSE], extent_of(coarse), records[FINE], extent_of(fine), limits.near
        )
        step = finer(errors, limits.span, limits.angle_step, step, fine.segments)
        if step == 0.0:
            break
    share, grounded = fine.root.x, fine.grounded
    if coarse.root.unknown.sought == fine.root.unknown.sought:
        share += (share - coarse.root.x) / 3.0
    if coarse.landed and fine.landed:
        grounded += (grounded - coarse.grounded) / 3.0
    return not_audited(fine, errors, share, grounded)


def close_both(problem: LineProblem, root: Root, step: float, hangs: bool) -> tuple[Closed, Closed]:
    """Close a line on segments for twice the given angle step, and then on the halved segments.

    `hangs` is as in `settle_line`.
    """
    root = planned(problem, root, 2.0 * step)
    coarse, fine = closed_between(problem, root)
    if fine.ending == FOUND:
        return coarse, refused_far_below(problem, fine, FINE, hangs)
    coarse = polish_hanging(problem, root, CHOSEN, COARSE, hangs)
    if coarse.ending != FOUND:
        return coarse, coarse
    return coarse, polish_hanging(problem, coarse.root, HALVED, FINE, hangs)


def extent_of(closed: Closed) -> Extent:
    """Return the size of a closed shape."""
    return Extent(closed.nodes, closed.hanging, closed.landed)


def polish_hanging(problem: LineProblem, root: Root, cuts: int, record: int, hangs: bool) -> Closed:
    """Close a line by `polish`.

    If the line must stay clear of the seabed (`hangs`), a shape far below the seabed is rejected.
    """
    return refused_far_below(problem, polish(problem, root, cuts, record), record, hangs)


def refused_far_below(problem: LineProblem, closed: Closed, record: int, hangs: bool) -> Closed:
    """Return `closed`, or a rejection if the line is far below the seabed.

    Only a line that must stay clear of the seabed (`hangs`) is rejected.
    """
    if not hangs or closed.ending != FOUND:
        return closed
    lowest, above = lowest_node(problem, problem.work.records[record], closed.nodes)
    if above < -COARSE_REJECTION_DEPTH * problem.limits.depth:
        piece = int(problem.work.records[record][6][max(lowest, 1)])
        return Closed(BELOW_SEABED, -above, piece, closed.root, 0, 0, False, 0.0, 0)
    return closed


def lowest_node(problem: LineProblem, record: Record, nodes: int) -> tuple[int, float]:
    """Find the node with the smallest height above the seabed, and this height [m]."""
    lowest, least, end = 0, inf, nodes - 1
    for n in range(nodes):
        x, y = record[0][n] - record[0][end], record[1][n] - record[1][end]
        above = off_bed(problem.limits.bed, x, y, record[2][n] + problem.limits.depth)
        if above < least:
            lowest, least = n, above
    return lowest, least


def closed_between(problem: LineProblem, root: Root) -> tuple[Closed, Closed]:
    """Close a line of a batch by linear interpolation, on the chosen and on the halved segments.

    The outcome is not `FOUND` if the closed shapes are too far from the marched shapes, or if the
    line may lie on the seabed.
    """
    unknown = root.unknown
    limits, work = problem.limits, problem.work
    none = not_closed(NO_SHAPE_NEAR, 0.0, root)
    if limits.near == 0.0 or isnan(root.miss) or unknown.sought > 0 or unknown.lands:
        return none, none
    high, near, halved = limits.span, 0.5, 1.0
    if unknown.sought != BELOW:  # a slack line moves far for a small change of its buoyancy
        high, near, halved = 1.0, 0.05, 0.1
    # two shapes on the chosen segments show how every node moves as the unknown changes
    before, last, x = work.left[LAST], root.miss, root.x
    for _ in range(MOST_BETWEEN):
        if not 0.0 < x < high or x == before:
            return none, none
        about = About(problem, unknown, limits.angle_step, CHOSEN, True, COARSE)
        miss, nodes = miss_at(about, x), int(work.left[NODES])
        slope = (miss - last) / (x - before)
        if not slope < 0.0:
            return none, none
        if abs(miss) <= near * abs(last) and abs(miss * last) <= LINEAR * limits.span * limits.span:
            break
        for n in range(nodes):
            for column in range(6):
                work.records[OTHER][column][n] = work.records[COARSE][column][n]
        before, last, x = x, miss, x - miss / slope
    closing = -miss / slope
    off = miss_at(About(problem, unknown, limits.angle_step, HALVED, True, FINE), x)
    moved = abs(off) + abs(miss - last)
    if not abs(off) <= min(20.0 * abs(miss - last), FAR * limits.span):
        return none, none
    if abs(off) * moved > halved * LINEAR * limits.span * limits.span:
        return none, none
    change = x - before
    coarse_root = Root(True, unknown, x + closing, 0.0, slope)
    fine_root = Root(True, unknown, x - off / slope, 0.0, slope)
    halves = move_shapes(problem, nodes, closing / change, -off / slope / change)
    segments = segments_of(problem, CHOSEN)
    return (
        Closed(FOUND, 0.0, -1, coarse_root, nodes, nodes - 1, False, 0.0, segments),
        Closed(FOUND, 0.0, -1, fine_root, halves, halves - 1, False, 0.0, 2 * segments),
    )


def move_shapes(problem: LineProblem, nodes: int, closing: float, halved: float) -> int:
    """Correct the shapes `COARSE` and `FINE` by linear interpolation.

    The change from shape `OTHER` to shape `COARSE` is multiplied by a factor, and added to the
    nodes. Return the number of nodes of the fine shape.

    Parameters
    ----------
    closing : factor for `COARSE`
    halved : factor for `FINE`
    """
    records, same = problem.work.records, 0
    before, coarse, fine = records[OTHER], records[COARSE], records[FINE]
    for n in range(nodes):
        split = n > 0 and coarse[SEGMENT][n] == ENDS
        same += (2 if split else 1) if n > 0 else 0
        for column in range(6):
            change = coarse[column][n] - before[column][n]
            before[column][n] = change
            coarse[column][n] += closing * change
            fine[column][same] += halved * change
            if split:
                fine[column][same - 1] += 0.5 * halved * (change + before[column][n - 1])
    return same + 1
