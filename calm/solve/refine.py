"""From the neighbourhood of a root to a shape of known error.

The march chooses its cuts at twice the angle step; on these the line is closed, and again with
every segment halved. The march is of second order, so a third of the change is the error of the
finer shape; where that is too much, all is done again with a smaller step.

A load or stretch that changes abruptly inside a segment, where a law of drag switches or a table
bends, may count for the same on coarse and on halved segments. It shows as a bend between
neighbours, and that is added.
"""

from math import degrees, inf, isnan, sqrt
from typing import Any, NamedTuple

from calm.physics.drag import Vector
from calm.physics.line import Record, off_bed
from calm.physics.passing import FAILURE, NODES
from calm.physics.profile import interval_at
from calm.solve.closing import Closed, Root, halve, not_closed, planned, polish
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
    Search,
)
from calm.solve.solution import BELOW_SEABED, FOUND, MARCH_STOPPED, NO_SHAPE_NEAR

DEPTH_TARGET = 4e-5
TENSION_TARGET = 1.6e-4
"""Error estimates, relative to the span and to the tension, above which the step is taken
smaller, at an angle step of 1°; they follow its square."""
AS_FOUND = 0.25
"""Share of these that one of many may have where it is not extrapolated."""
MOST_ROUNDS = 6
MOST_SEGMENTS = 20_000
AT_A_LEVEL = 0.05
"""How near to a level, in segments, a node is as good as there: bends are at home at levels."""
LINEAR = 4e-7
"""Product of the misses of two shapes, in spans squared, between which a third is linear."""
FAR = 3e-4
"""Miss, as a share of the span, that halving the cuts may lead to at most there."""
FAR_BELOW = 0.01
"""How far below the seabed, in depths of the water, a line need not be cut finer to be refused."""


class Errors(NamedTuple):
    """Own estimates of the errors of a shape: of depths and offsets [m], of tensions [N] and
    relative, and of the upward and the horizontal force at its end [N]."""

    depth: float
    tension: float
    relative: float
    lift: float
    pull: float


class Refined(NamedTuple):
    """A line closed finely, how many segments it has, and its errors."""

    closed: Closed
    segments: int
    errors: Errors


UNKNOWN_ERRORS = Errors(0.0, 0.0, 0.0, 0.0, 0.0)


def refine(search: Search, root: Root, hangs: bool) -> Refined:
    """Close the line finely enough, from a coarse root; in the record `FINE`.

    Parameters
    ----------
    hangs : whether it is to hang clear of the seabed: then one that comes far below is refused
    """
    problem, step = search.problem, search.problem.limits.angle_step
    refined = Refined(not_closed(NO_SHAPE_NEAR, 0.0, root), 0, UNKNOWN_ERRORS)
    for _ in range(MOST_ROUNDS):
        root = planned(search, root, 2.0 * step)
        if isnan(root.miss):
            stopped = not_closed(MARCH_STOPPED, problem.work.left[FAILURE], root)
            return Refined(stopped, 0, UNKNOWN_ERRORS)
        segments = halve(problem)
        coarse, fine = closed_between(search, root)
        if fine.ending == FOUND:
            fine = refused_far_below(problem, fine, FINE, hangs)
        else:
            coarse = polish_hanging(search, root, CHOSEN, COARSE, hangs)
            if coarse.ending != FOUND:
                return Refined(coarse, 0, UNKNOWN_ERRORS)
            fine = polish_hanging(search, coarse.root, HALVED, FINE, hangs)
        if fine.ending != FOUND:
            return Refined(fine, 0, UNKNOWN_ERRORS)
        errors = errors_of(problem, coarse, fine)
        refined = Refined(fine, segments, errors)
        excess = excess_of(problem, errors, fine.landed)
        if excess <= 1.0 or segments > MOST_SEGMENTS:
            break
        root, step = fine.root, step * max(0.8 / sqrt(excess), 0.2)
    # of one of many the errors are not told
    return refined if problem.limits.near > 0.0 else with_bends(problem, refined)


def excess_of(problem: LineProblem, errors: Errors, landed: bool) -> float:
    """Return how many times the errors of a shape are what is aimed at.

    That is less for one of many that lands, which is not extrapolated.
    """
    target = degrees(problem.limits.angle_step)
    target *= target
    place, tension = DEPTH_TARGET * target, TENSION_TARGET * target
    if problem.limits.near > 0.0 and landed:
        place, tension = AS_FOUND * place, AS_FOUND * tension
    return max(errors.depth / (place * problem.limits.span), errors.relative / tension)


def with_bends(problem: LineProblem, refined: Refined) -> Refined:
    """Return the same with what abrupt changes inside its segments may cost."""
    errors = refined.errors
    strayed, lost = abrupt_change(problem, refined.closed)
    return Refined(
        refined.closed,
        refined.segments,
        Errors(
            errors.depth + strayed,
            errors.tension + lost,
            errors.relative,
            errors.lift + lost,
            errors.pull + lost,
        ),
    )


def polish_hanging(search: Search, root: Root, cuts: int, record: int, hangs: bool) -> Closed:
    """`polish`, sparing a line that hangs far below the seabed the finer cuts."""
    return refused_far_below(search.problem, polish(search, root, cuts, record), record, hangs)


def refused_far_below(problem: LineProblem, closed: Closed, record: int, hangs: bool) -> Closed:
    """Return a closed line, refused where it is to hang and comes far below the seabed."""
    if not hangs or closed.ending != FOUND:
        return closed
    lowest, above = lowest_node(problem, problem.work.records[record], closed.nodes)
    if above < -FAR_BELOW * problem.limits.depth:
        piece = int(problem.work.records[record][6][max(lowest, 1)])
        return Closed(BELOW_SEABED, -above, piece, closed.root, 0, 0, False, 0.0)
    return closed


def lowest_node(problem: LineProblem, record: Record, nodes: int) -> tuple[int, float]:
    """The node that is lowest above the seabed, and how far above it [m]."""
    lowest, least, end = 0, inf, nodes - 1
    for n in range(nodes):
        x, y = record[0][n] - record[0][end], record[1][n] - record[1][end]
        above = off_bed(problem.limits.bed, x, y, record[2][n] + problem.limits.depth)
        if above < least:
            lowest, least = n, above
    return lowest, least


def closed_between(search: Search, root: Root) -> tuple[Closed, Closed]:
    """Close one of many on its cuts and on these halved, as what is linear between two shapes.

    One march on either does, as what a change of the unknown leads to is known from the shape
    before, in the record `OTHER`. Not `FOUND` where that is too far, or lies on the seabed.
    """
    problem, unknown = search.problem, root.unknown
    limits, work = problem.limits, problem.work
    none = not_closed(NO_SHAPE_NEAR, 0.0, root)
    if limits.near == 0.0 or unknown.sought > 0 or unknown.lands:
        return none, none
    high, near, halved = limits.span, 0.5, 1.0
    if unknown.sought != BELOW:  # a slack line swings far by little of its buoyancy
        high, near, halved = 1.0, 0.05, 0.1
    before, last, x = work.left[LAST], root.miss, root.x
    for _ in range(MOST_ROUNDS):
        if not 0.0 < x < high or x == before:
            return none, none
        about = About(problem, unknown, limits.angle_step, CHOSEN, True, COARSE)
        miss, nodes = search.miss(about, x), int(work.left[NODES])
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
    off = search.miss(About(problem, unknown, limits.angle_step, HALVED, True, FINE), x)
    moved = abs(off) + abs(miss - last)
    if not abs(off) <= min(20.0 * abs(miss - last), FAR * limits.span):
        return none, none
    if abs(off) * moved > halved * LINEAR * limits.span * limits.span:
        return none, none
    change = x - before
    coarse_root = Root(True, unknown, x + closing, 0.0, slope)
    fine_root = Root(True, unknown, x - off / slope, 0.0, slope)
    halves = move_shapes(problem, nodes, closing / change, -off / slope / change)
    coarse = Closed(FOUND, 0.0, -1, coarse_root, nodes, nodes - 1, False, 0.0)
    return coarse, Closed(FOUND, 0.0, -1, fine_root, halves, halves - 1, False, 0.0)


def move_shapes(problem: LineProblem, nodes: int, closing: float, halved: float) -> int:
    """Move the shapes COARSE and FINE by shares of the way from `OTHER` to COARSE.

    Returns
    -------
    How many nodes the fine one has.
    """
    records, same = problem.work.records, 0
    before, coarse, fine = records[OTHER], records[COARSE], records[FINE]
    for n in range(nodes):
        split = n > 0 and is_segment(problem, coarse, n)
        same += (2 if split else 1) if n > 0 else 0
        for column in range(6):
            way = coarse[column][n] - before[column][n]
            before[column][n] = way
            coarse[column][n] += closing * way
            fine[column][same] += halved * way
            if split:
                fine[column][same - 1] += 0.5 * halved * (way + before[column][n - 1])
    return same + 1


def is_segment(problem: LineProblem, record: Record, node: int) -> bool:
    """Return whether the element that ends at a node is a part of a cable or chain."""
    return bool(problem.flexible[int(record[6][node])]) and record[7][node] < 0


def tension_at(record: Record, node: int) -> float:
    """Tension at a node [N]."""
    fx, fy, fz = record[3][node], record[4][node], record[5][node]
    return sqrt(fx * fx + fy * fy + fz * fz)


def errors_of(problem: LineProblem, coarse: Closed, fine: Closed) -> Errors:
    """Errors of the finer of two shapes, by the nodes that both have.

    That is all but those around the touchdown, where there is one.
    """
    before, after = problem.work.records[COARSE], problem.work.records[FINE]
    last, end = coarse.nodes - 1, fine.nodes - 1
    ahead, behind = (before[0][last], before[1][last]), (after[0][end], after[1][end])
    common = coarse.hanging if coarse.landed else coarse.hanging + 1
    lying = last - coarse.hanging
    if not coarse.landed or lying != end - fine.hanging:
        lying = 0
    place = greatest = 0.0
    same = 0
    for n in range(common):
        if n > 0:
            same += 2 if is_segment(problem, before, n) else 1
        if same > fine.hanging:
            common = n
            break
        x, y = before[0][n] - ahead[0], before[1][n] - ahead[1]
        place = max(place, abs(x - (after[0][same] - behind[0])))
        place = max(place, abs(y - (after[1][same] - behind[1])))
        place = max(place, abs(before[2][n] - after[2][same]))
        greatest = max(greatest, tension_at(after, same))
    for n in range(1, lying + 1):
        greatest = max(greatest, tension_at(after, fine.hanging + n))
    floor = max(1e-3 * greatest, 1e-300)
    worst = relative = 0.0
    same = 0
    for n in range(common + lying):
        here = n
        if n >= common:
            here = coarse.hanging + 1 + n - common
            same = fine.hanging + 1 + n - common
        elif n > 0:
            same += 2 if is_segment(problem, before, n) else 1
        tension = tension_at(after, same)
        change = abs(tension_at(before, here) - tension) / 3.0
        worst = max(worst, change)
        relative = max(relative, change / max(tension, floor))
    # a third of the change is the error at the end where the shape is smooth; a little more is
    # stated, as these are two figures and no worst of many
    east, north = before[3][last] - after[3][end], before[4][last] - after[4][end]
    return Errors(
        place / 3.0,
        worst,
        relative,
        abs(before[5][last] - after[5][end]) / 2.5,
        sqrt(east * east + north * north) / 2.5,
    )


def abrupt_change(problem: LineProblem, fine: Closed) -> tuple[float, float]:
    """Return what the worst abrupt change inside a segment may cost: in place [m], in tension [N].

    If the slope of what a segment adds per metre bends by Δ inside one of length h, its value at
    the middle is off by up to Δh²/8. Where the curve is smooth the segments two away bend alike:
    only what exceeds their bend is abrupt.
    """
    record, sizes = problem.work.records[FINE], problem.work.elements
    levels, hanging = problem.sea.levels, fine.hanging
    level, smooth_before = 0, False
    for k in range(hanging + 1):
        sizes[0][k] = sizes[1][k] = -1.0
    for k in range(1, hanging):  # the joint between elements k and k + 1, at node k
        smooth = (
            is_segment(problem, record, k)
            and is_segment(problem, record, k + 1)
            and record[6][k] == record[6][k + 1]
            and record[8][k] > 0.0
            and record[8][k + 1] > 0.0
        )
        if smooth:
            depth = -record[2][k]
            level = interval_at(levels, depth, level)
            off = min(depth - levels[level], levels[level + 1] - depth)
            smooth = off > AT_A_LEVEL * max(record[8][k], record[8][k + 1])
        if smooth and smooth_before:
            for part in range(2):
                x, y, z = bend_in(record, k, 3 * part)
                sizes[part][k] = sqrt(x * x + y * y + z * z)
        smooth_before = smooth
    strayed = lost = 0.0
    pull = tension_at(record, hanging)
    for k in range(2, hanging):
        for part in range(2):
            size = sizes[part][k]
            usual = max(sizes[part][k - 2], sizes[part][k + 2] if k + 2 < hanging else -1.0)
            if size < 0.0 or not (usual >= 0.0 and size > usual):
                continue
            share = (size - usual) / size
            if part == 0:
                strayed = max(strayed, share * size)
                continue
            x, y, z = bend_in(record, k, 3)
            # what a force adds to the tension there, and where the line hangs from in the end
            here = along(record, k, tension_at(record, k), x, y, z)
            there = along(record, hanging, pull, x, y, z)
            lost = max(lost, share * max(here, there))
    return strayed, lost


def bend_in(record: Any, k: int, column: int) -> Vector:
    """Return what a bend inside element k may cost of a place, or of a force, by its neighbours'
    slopes.

    `column` : the first of the three in the record
    """
    above, own, below = record[8][k - 1], record[8][k], record[8][k + 1]
    rise, fall = 0.5 * (above + own), 0.5 * (own + below)
    scale = own * own / 8.0
    return (
        bend_of(record[column], k, above, own, below, rise, fall) * scale,
        bend_of(record[column + 1], k, above, own, below, rise, fall) * scale,
        bend_of(record[column + 2], k, above, own, below, rise, fall) * scale,
    )


def bend_of(
    values: Any, k: int, above: float, own: float, below: float, rise: float, fall: float
) -> float:
    """By how much the slope of what is added per metre changes along element k."""
    first = (values[k - 1] - values[k - 2]) / above
    second = (values[k] - values[k - 1]) / own
    third = (values[k + 1] - values[k]) / below
    bend: float = (third - second) / fall - (second - first) / rise
    return bend


def along(record: Record, node: int, tension: float, x: float, y: float, z: float) -> float:
    """Return how much of a vector is along the force at a node."""
    if tension == 0.0:
        return 0.0
    pulled: float = abs(x * record[3][node] + y * record[4][node] + z * record[5][node])
    return pulled / tension
