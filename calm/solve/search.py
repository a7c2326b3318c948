"""The complete search for a moored line's shape, with all checks and the audit."""

from collections.abc import MutableSequence, Sequence
from math import isnan, nan, sqrt
from typing import NamedTuple

from calm.physics.compiled import set_row
from calm.physics.line import BETTER
from calm.physics.passing import FAILURE
from calm.physics.passing import LANDED as CAME_DOWN
from calm.physics.referee import (
    Moored,
    RefereeBody,
    RefereeShape,
    element_loads,
    find_ends,
    worst_moment,
)
from calm.physics.seabed import closure
from calm.physics.track import Load
from calm.solve.accuracy import Errors, tension_at
from calm.solve.closing import Closed, Root, coarse_miss, place, planned, whole_line
from calm.solve.line_shape import NO_OTHER, FoundShape, lowest_node, refused, settle_line
from calm.solve.locate import locate
from calm.solve.problem import (
    BELOW,
    CHANGED,
    FINE,
    KEPT,
    OTHER,
    Limits,
    LineProblem,
    Unknown,
)
from calm.solve.solution import (
    ABOVE_SURFACE,
    BELOW_SEABED,
    FOUND,
    MARCH_STOPPED,
    MISSES,
    NO_SHAPE_NEAR,
    NOT_CLOSED,
    NOT_LYING,
    OUT_OF_BALANCE,
    SLACK_AT_REST,
    SLACK_ON_DIGITS,
    UNSUPPORTED,
    OtherEquilibrium,
)
from calm.solve.starts import is_highest, start_of

LARGEST_CLOSURE = 1e-6
LARGEST_MOMENT = 1e-8
UNSEEN = 1e-9
"""Error that a comparison of coarse and halved segments cannot reveal.

The error is a fraction of the span or of the largest force. It allows for rounding, for the
tolerance of the used buoyancy, and for nodes slightly above or below their level of the water
profile.
"""
SHORT_LANDED_LENGTH = 4.0
"""Length on the seabed, in anchor heights, up to which a shape without touchdown is preferred.

If more of the line lies on the seabed, the shape without touchdown is used only if its free end is
higher.
"""
LEAST_SHARE_DIFFERENCE = 1e-3
"""Smallest difference in used buoyancy between two distinct equilibria of a surface float."""
CHECKED_LANDED_LENGTH = 20.0
"""Longest part on the seabed, in anchor heights, for which a second equilibrium is sought.

The second equilibrium is without touchdown, and is also reported.
"""


class Referee(NamedTuple):
    """Inputs and work arrays for the audit of a line.

    Attributes
    ----------
    moored : the line with the loads of the solution, and its water
    bodies : the bodies of the line, with full loads even for floats at the surface
    """

    moored: Moored
    bodies: Sequence[RefereeBody]
    first: MutableSequence[int]
    last: MutableSequence[int]


def find_shape(problem: LineProblem, referee: Referee) -> FoundShape:
    """Find the shape of a line, either clear of the seabed or with a touchdown.

    If the line is longer than the water depth, a shape with a touchdown is tried first.
    """
    limits = problem.limits
    may_land = problem.course.landing < len(problem.course.stages)
    lands_first = may_land and limits.length > limits.depth
    if lands_first and limits.near > 0.0:
        at_once = rising(problem, referee)
        if at_once.closed.ending == FOUND:
            return at_once
    first = highest(problem, referee, lands_first)
    if first.closed.ending == FOUND or first.closed.ending == MARCH_STOPPED or not may_land:
        return first
    second = highest(problem, referee, not lands_first)
    if second.closed.ending == FOUND or second.closed.ending == MARCH_STOPPED:
        return second
    if is_slack(first):
        return first
    if is_slack(second):
        return second
    return second if lands_first else first


def rising(problem: LineProblem, referee: Referee) -> FoundShape:
    """Find the shape of a line that may touch the seabed but clearly rises from its anchor.

    The line belongs to a batch. If its last element does not rise from the anchor, the line could
    also lie on the seabed, and is rejected.
    """
    lying, start = start_of(problem, True), start_of(problem, False)
    found = refused(NO_SHAPE_NEAR, 0.0, -1, start)
    if not lying.found or not start.found:
        return found
    miss = coarse_miss(problem, lying.unknown, lying.x)
    if isnan(miss) or problem.work.left[CAME_DOWN] >= 0.0:
        return found
    found = shape_near(problem, referee, start, False)
    if found.closed.ending != FOUND or not is_highest(problem, found.closed.root):
        return refused(NO_SHAPE_NEAR, 0.0, -1, start)
    last, heights = found.closed.nodes - 1, problem.work.records[FINE][2]
    if heights[last - 1] <= heights[last]:
        return refused(NO_SHAPE_NEAR, 0.0, -1, start)
    return found


def is_slack(found: FoundShape) -> bool:
    """Return whether a line was rejected as slack."""
    return found.closed.ending == SLACK_AT_REST or found.closed.ending == SLACK_ON_DIGITS


def with_other(found: FoundShape, other: OtherEquilibrium) -> FoundShape:
    """Return a copy of a shape that also reports another equilibrium."""
    return FoundShape(
        found.closed, found.errors, found.share, found.grounded, found.closure, found.moment, other
    )


def other_of(problem: LineProblem, found: FoundShape) -> OtherEquilibrium:
    """Describe the shape in the record `FINE` as another equilibrium."""
    record, closed = problem.work.records[FINE], found.closed
    end = closed.nodes - 1
    x, y, z = record[BETTER + 3][end], record[BETTER + 4][end], record[BETTER + 5][end]
    share = found.share if closed.root.unknown.sought != BELOW else 1.0
    depth = 0.0 - record[BETTER + 2][0]
    return OtherEquilibrium(depth, found.grounded, share, z, sqrt(x * x + y * y))


def highest(problem: LineProblem, referee: Referee, lands: bool) -> FoundShape:
    """Find the highest shape of a line, and attach a second equilibrium if there is one.

    Parameters
    ----------
    lands : whether to search for shapes with a touchdown, instead of shapes clear of the seabed
    """
    if not lands and problem.limits.lift <= 0.0:
        nowhere = Root(False, whole_line(problem, lands), nan, nan, nan)
        return refused(UNSUPPORTED, 0.0, -1, nowhere)
    start = start_of(problem, lands)
    if start.found and lands:
        start = planned(problem, start, problem.limits.coarse_step)
    if start.found and not isnan(start.miss):
        found = shape_near(problem, referee, start, lands)
        if found.closed.ending == FOUND and is_highest(problem, found.closed.root):
            return found
    located = locate(problem, lands, problem.limits.near > 0.0)
    if located.ending != FOUND:
        return refused(located.ending, located.value, -1, located.root)
    found = shape_near(problem, referee, located.root, lands)
    if found.closed.ending == MISSES:  # the miss jumps there because a float tips over
        located = locate(problem, lands, False)
        return shape_near(problem, referee, located.other, lands) if located.other.found else found
    if found.closed.ending != FOUND or not located.other.found:
        return found
    if problem.limits.near > 0.0:  # a batch reports only the approximate share
        afloat = located.other.unknown.sought != BELOW
        share = OtherEquilibrium(0.0, 0.0, located.other.x, nan, nan)
        return with_other(found, share) if afloat else found
    keep(problem, OTHER, FINE, found)
    second = shape_near(problem, referee, located.other, lands)
    other = other_of(problem, second) if second.closed.ending == FOUND else NO_OTHER
    keep(problem, FINE, OTHER, found)
    load_again(problem, found)
    first = other_of(problem, found)
    apart = 2.0 * (found.errors.depth + second.errors.depth)
    same = (
        other.depth - first.depth <= apart
        and abs(other.used_buoyancy - first.used_buoyancy) < LEAST_SHARE_DIFFERENCE
    )
    return found if second.closed.ending != FOUND or same else with_other(found, other)


def keep(problem: LineProblem, to: int, of: int, found: FoundShape) -> None:
    """Copy a shape and the used buoyancy of its surface floats from record `of` to record `to`."""
    source, kept = problem.work.records[of], problem.work.records[to]
    shares = problem.work.shares
    for k in range(found.closed.root.unknown.sought):
        if of == FINE:
            shares[to][k] = shares[0][k]
        else:
            shares[0][k] = shares[of][k]
    for column in range(len(source)):
        for n in range(found.closed.nodes):
            kept[column][n] = source[column][n]


def load_again(problem: LineProblem, found: FoundShape) -> None:
    """Set the loads of the pieces at the surface to their values in a given shape."""
    root = found.closed.root
    place(problem, root.unknown, root.x)


def shape_near(problem: LineProblem, referee: Referee, root: Root, lands: bool) -> FoundShape:
    """Return the audited shape near an approximate equilibrium.

    If little of the line lies on the seabed, a shape clear of the seabed is also sought.

    Parameters
    ----------
    lands : whether the approximate equilibrium has a touchdown
    """
    limits = problem.limits
    if not lands:
        return audited(problem, referee, settle_line(problem, root, True))
    clear = hanging_clear(problem, root)
    if isnan(coarse_miss(problem, root.unknown, root.x)):
        return refused(MARCH_STOPPED, problem.work.left[FAILURE], -1, root)
    if problem.work.left[CAME_DOWN] < 0.0:
        return audited(problem, referee, settle_line(problem, clear, False))
    landed = audited(problem, referee, settle_line(problem, root, False))
    if landed.closed.ending != FOUND:
        return landed
    closed = landed.closed
    if not closed.landed:
        return refused(NOT_LYING, 0.0, -1, root)
    if closed.grounded > CHECKED_LANDED_LENGTH * limits.anchor_height:
        return landed
    keep(problem, KEPT, FINE, landed)
    lying = other_of(problem, landed)
    hanging = audited(problem, referee, settle_line(problem, clear, True))
    if hanging.closed.ending == MARCH_STOPPED:
        return hanging
    clear_of_it = other_of(problem, hanging) if hanging.closed.ending == FOUND else NO_OTHER
    if hanging.closed.ending == FOUND:
        barely = closed.grounded <= SHORT_LANDED_LENGTH * limits.anchor_height
        higher = lying.depth - hanging.errors.depth - landed.errors.depth
        if barely or clear_of_it.depth < higher:
            return with_other(hanging, lying)
    keep(problem, FINE, KEPT, landed)
    load_again(problem, landed)
    if hanging.closed.ending != FOUND:
        return landed
    return with_other(landed, clear_of_it)


def hanging_clear(problem: LineProblem, root: Root) -> Root:
    """Return a copy of an approximate equilibrium, for the same line without touchdown."""
    goal = problem.limits.anchor_height - problem.limits.depth
    given = root.unknown
    unknown = Unknown(goal, given.sought, given.rides, False, given.stages)
    return Root(root.found, unknown, root.x, root.miss, root.slope)


def audited(problem: LineProblem, referee: Referee, found: FoundShape) -> FoundShape:
    """Complete the error estimates of a shape, check the shape, and reject it if a check fails."""
    closed, off, moment = found.closed, 0.0, 0.0
    if closed.ending != FOUND:
        return found
    errors = stated_errors(problem, found)
    piece, height = misplaced(problem, closed, errors.depth)
    if piece >= 0:
        ending = ABOVE_SURFACE if height > 0.0 else BELOW_SEABED
        return refused(ending, abs(height), piece, closed.root)
    if problem.limits.near == 0.0:
        off, moment = audit_shape(problem, referee, closed)
        ending, value = ending_of_audit(off, moment)
        if ending != FOUND:
            return refused(ending, value, -1, closed.root)
    return FoundShape(closed, errors, found.share, found.grounded, off, moment, NO_OTHER)


def audit_shape(problem: LineProblem, referee: Referee, closed: Closed) -> tuple[float, float]:
    """Return the relative force imbalance and the moment residual of the shape in record `FINE`."""
    record, elements = problem.work.records[FINE], problem.work.elements
    shape = RefereeShape(record, closed.nodes, closed.hanging, referee.first, referee.last)
    take_loads(problem, referee)
    return residuals(referee.moored, shape, elements, closed.landed, problem.limits)


def residuals(
    moored: Moored,
    shape: RefereeShape,
    elements: Sequence[MutableSequence[float]],
    landed: bool,
    limits: Limits,
) -> tuple[float, float]:
    """Recompute the relative force imbalance and the moment residual from the nodes of a shape.

    Parameters
    ----------
    elements : (3, n) work array for the loads of every element
    landed : whether the shape ends on the seabed
    """
    find_ends(shape)
    element_loads(moored, shape, elements)
    off = closure(moored, shape, elements, landed, limits.bed)
    return off, worst_moment(moored, shape, elements)


def ending_of_audit(off: float, moment: float) -> tuple[int, float]:
    """Return the outcome of the audit, and the residual that is too large (0 if none is)."""
    if not off <= LARGEST_CLOSURE:
        return NOT_CLOSED, off
    if not moment <= LARGEST_MOMENT:
        return OUT_OF_BALANCE, moment
    return FOUND, 0.0


def stated_errors(problem: LineProblem, found: FoundShape) -> Errors:
    """Return the error estimates of a shape, increased by errors that they do not include.

    The added errors are the height error of the line's end, and `UNSEEN`.
    """
    closed, span, errors = found.closed, problem.limits.span, found.errors
    unclosed = abs(closed.root.miss) / span + UNSEEN
    record, greatest = problem.work.records[FINE], 0.0
    for n in range(closed.nodes):
        greatest = max(greatest, tension_at(record, n))
    for k in range(closed.root.unknown.sought + 1):
        greatest = max(greatest, problem.loads[problem.surfacing[k].load].buoyancy)
    unseen = greatest * unclosed
    return Errors(
        errors.depth + span * unclosed,
        errors.tension + unseen,
        errors.relative,
        errors.lift + unseen,
        errors.pull + unseen,
    )


def misplaced(problem: LineProblem, closed: Closed, depth_error: float) -> tuple[int, float]:
    """Find a piece of a line that is out of the water or below the seabed.

    A float at the surface may stick out by its length.

    Returns
    -------
    Index of the piece, or -1, and its height [m]: above the surface if positive, else below the
    seabed.
    """
    record = problem.work.records[FINE]
    margin = max(depth_error, 1e-6 * problem.limits.depth)
    standing, unknown = 0.0, closed.root.unknown
    for k in range(unknown.sought + 1):
        standing += problem.surfacing[k].length
    if unknown.sought != BELOW and unknown.rides:
        standing = problem.surfacing[unknown.sought].upto
    topmost = 0
    for n in range(1, closed.nodes):
        if record[2][n] > record[2][topmost]:
            topmost = n
    lowest, above = lowest_node(problem, record, closed.nodes)
    if above < -margin:
        return int(record[6][max(lowest, 1)]), above
    if record[2][topmost] > margin + standing:
        return int(record[6][max(topmost, 1)]), record[2][topmost]
    return -1, 0.0


def take_loads(problem: LineProblem, referee: Referee) -> None:
    """Set the loads of the audit bodies to the loads in the solution.

    Loads of floats at the surface are reduced.
    """
    bodies, pieces = referee.moored.bodies, referee.moored.pieces
    for k in range(len(referee.bodies)):
        set_row(bodies, k, referee.bodies[k])
    for i in range(int(problem.work.left[CHANGED])):
        load = problem.course.loads[i]
        k = load.piece if load.clamp < 0 else pieces + load.clamp
        set_row(bodies, k, loaded(referee.bodies[k], load))


def loaded(body: RefereeBody, load: Load) -> RefereeBody:
    """Return a copy of an audit body with the forces and drag factors of a load."""
    return RefereeBody(
        body.flexible, body.length, load.buoyancy, load.volume, load.normal_drag,
        load.tangential_drag, body.directional, body.compliance, body.thinning, load.lift,
        load.push_east, load.push_north, body.diameter, body.smooth, body.lengthening,
        body.first_knot, body.end_knot,
    )  # fmt: skip
