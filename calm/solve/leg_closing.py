"""Closing of a net of legs on fixed segments by Newton's method, as functions to compile.

Broyden's rule updates the Jacobian (`slopes`) of the residual (`found`). A net with a single
unknown is closed by secants or bisection.
"""

from collections.abc import MutableSequence, Sequence
from math import inf, sqrt
from typing import Any, NamedTuple

from calm.physics.line import GOES_ON, NO_ROOM
from calm.physics.profile import Sea
from calm.physics.referee import RefereeShape, find_ends
from calm.solve.accuracy import Errors, Extent, extrapolate
from calm.solve.fineness import MOST_ROUNDS, finer
from calm.solve.leg_from_below import record_down
from calm.solve.leg_marches import write_residual
from calm.solve.leg_numbers import (
    ANCHORED,
    COARSE_COUNT,
    COARSE_GROUNDED,
    COARSE_STAGE,
    COARSE_SUSPENDED,
    COUNT,
    GROUNDED,
    HANGING_DOWN,
    STAGE,
    STANDING,
    SUSPENDED,
    Marching,
    NetProblem,
)
from calm.solve.problem import CHOSEN, COARSE, FINE, HALVED
from calm.solve.solution import FOUND, NO_SHAPE_NEAR

MOST_STEPS, HALVINGS = 60, 9
"""Limits of Newton's method for a net.

MOST_STEPS is the largest number of Newton steps. A Newton step that does not reduce the residual is
halved up to HALVINGS times.
"""
NEAR, CLOSED = 1e-4, 1e-10
"""Allowed residual of a net: NEAR while segments are still chosen, CLOSED for the final shape.

The residual of a length is a fraction of the longest leg, and of a force, a fraction of a typical
force.
"""
CLOSED_FOR_SEGMENTS = 1e-7
"""Allowed residual of the shape for which the final segments are chosen.

This limit is stricter than `NEAR`, so that the segments depend on the net alone, not on the path of
the search.
"""
MOST_LEFT = 10.0
"""Largest accepted residual, as a multiple of `enough`, if no step reduces the residual further."""
KEPT_SLOPES_REDUCTION = 0.25
"""Ratio of the squared residual after a Newton step to the squared residual before the step.

If the ratio is larger than this limit, the Jacobian is computed again.
"""
FLATTEST, MOST_HALVED = -1e-3, 100
"""Limits of the secant method for a net with a single unknown.

FLATTEST is the assumed slope of the scaled residual if the secant is flatter. MOST_HALVED is the
largest number of steps.
"""
SINGULAR = 1e-14
"""Smallest pivot of the scaled Jacobian. A Newton step does not change unknowns without a pivot."""
NEGLIGIBLE_PULL = 1e-5
"""Horizontal pull at a touchdown that is regarded as zero, as a fraction of the weight of a leg.

The limit exceeds the drag of the weak current that is added to still water.
"""
NEEDS_ROOM = -1
"""Outcome of a search if a leg needs more segments than the work arrays hold.

All other outcomes are `FOUND` and `NO_SHAPE_NEAR`.
"""

DEPTH_ERROR, TENSION_ERROR = range(2)


def newton_step(net: NetProblem, found: Sequence[float]) -> float:
    """Solve the linear equations of a Newton step, and return the size of the step.

    The step is written to `net.update`, divided by the scale of each unknown. The step is 0 for an
    unknown that the equations do not determine.
    """
    size, matrix, row = len(found), net.matrix, 0
    for r in range(size):
        for c in range(size):
            matrix[r][c] = net.slopes[r][c]
        matrix[r][size] = -found[r]
    for k in range(size):
        pivot = row
        for r in range(row, size):
            if abs(matrix[r][k]) > abs(matrix[pivot][k]):
                pivot = r
        net.order[k] = -1
        if row == size or abs(matrix[pivot][k]) < SINGULAR:
            continue
        for c in range(k, size + 1):
            matrix[row][c], matrix[pivot][c] = matrix[pivot][c], matrix[row][c]
        for r in range(size):
            share = 0.0 if r == row else matrix[r][k] / matrix[row][k]
            if share != 0.0:
                for c in range(k, size + 1):
                    matrix[r][c] -= share * matrix[row][c]
        net.order[k] = row
        row += 1
    for k in range(size):
        row = net.order[k]
        net.update[k] = 0.0 if row < 0 else matrix[row][size] / matrix[row][k]
    return sqrt(squares(net.update))


def squares(values: Sequence[float]) -> float:
    """Return the sum of the squares of the values."""
    total = 0.0
    for k in range(len(values)):
        total += values[k] * values[k]
    return total


def copy_values(values: Sequence[Any], kept: MutableSequence[Any]) -> None:
    """Copy values into an existing array `kept`."""
    for k in range(len(values)):
        kept[k] = values[k]


def close_one(net: NetProblem, x: MutableSequence[float], how: Marching, enough: float) -> int:
    """Close a net that has a single unknown, and return the outcome (see `close_net`).

    The residual must decrease as the unknown grows.
    """
    above, below, scale, slope = -inf, inf, net.scale[0], net.slopes[0][0]
    slope, halved = slope if slope < 0.0 else -1.0, True
    failure = write_residual(net, x, how, False)
    for _ in range(MOST_HALVED):
        value, left = x[0], net.found[0]
        if failure != GOES_ON or abs(left) <= enough:
            break
        if left > 0.0:
            above = value
        else:
            below = value
        x[0] = value - left / min(slope, FLATTEST) * scale
        if below - above < inf and not (halved and above < x[0] < below):
            x[0] = 0.5 * (above + below)
        if x[0] == value:
            break
        failure = write_residual(net, x, how, False)
        slope = (net.found[0] - left) / (x[0] - value) * scale
        halved = abs(net.found[0]) < 0.5 * abs(left)
    net.slopes[0][0] = slope
    if failure == NO_ROOM:
        return NEEDS_ROOM
    return FOUND if failure == GOES_ON and abs(net.found[0]) <= 100.0 * enough else NO_SHAPE_NEAR


def close_net(
    net: NetProblem, x: MutableSequence[float], how: Marching, enough: float, known: bool
) -> int:
    """Close a net by Newton's method; return `FOUND`, `NO_SHAPE_NEAR` or `NEEDS_ROOM`.

    The last march of each leg is for the final unknowns, if the net is closed.

    Parameters
    ----------
    x : approximate unknowns, overwritten with the solution
    enough : scaled residual at which the net counts as closed
    known : whether `net.slopes` holds the Jacobian
    """
    if len(x) == 1:
        return close_one(net, x, how, enough)
    failure = write_residual(net, x, how, not known)
    if failure != GOES_ON:
        return NEEDS_ROOM if failure == NO_ROOM else NO_SHAPE_NEAR
    return close_on(net, x, how, enough, known)


def close_on(
    net: NetProblem, x: MutableSequence[float], how: Marching, enough: float, known: bool
) -> int:
    """Close a net on the segments of its last march, starting from the residual of this march.

    The parameters are as in `close_net`.
    """
    if len(x) == 1:
        return close_one(net, x, how, enough)
    size, trial, fresh, plain, left = len(x), net.trial, not known, known, net.kept
    copy_values(net.found, left)
    for _ in range(MOST_STEPS):
        if squares(left) <= enough * enough:
            break
        before = squares(left)
        share = min(1.0, 0.5 / max(newton_step(net, left), 1e-300))
        now = inf
        for _ in range(HALVINGS if fresh else 1):
            for k in range(size):
                trial[k] = x[k] + share * net.update[k] * net.scale[k]
            failure = write_residual(net, trial, how, False)
            if failure == NO_ROOM:
                return NEEDS_ROOM
            now = squares(net.found) if failure == GOES_ON else inf
            if now < (1.0 - 1e-3 * share) * before:
                break
            share *= 0.5
            now = inf
        plain = now < inf
        if not plain and fresh:
            if squares(left) > MOST_LEFT * MOST_LEFT * enough * enough:
                return NO_SHAPE_NEAR
            break
        if plain:
            copy_values(trial, x)
            whole = share * share * squares(net.update)
            for k in range(size):
                off = (net.found[k] - (1.0 - share) * left[k]) * share / max(whole, 1e-300)
                for m in range(size):
                    net.slopes[k][m] += off * net.update[m]
            copy_values(net.found, left)
        fresh = not now < KEPT_SLOPES_REDUCTION * before
        if fresh and (not plain or squares(left) > enough * enough):
            failure = write_residual(net, x, how, True)
            if failure != GOES_ON:
                return NO_SHAPE_NEAR
            copy_values(net.found, left)
            plain = False
    if squares(left) > MOST_LEFT * MOST_LEFT * enough * enough:
        return NO_SHAPE_NEAR
    if not plain:
        write_residual(net, x, how, False)
    return FOUND


def drifts(net: NetProblem) -> bool:
    """Return whether a net is free to drift.

    A net drifts if no end is held and every anchored leg lies slack on the seabed.
    """
    anchored = False
    for i in range(len(net.legs)):
        leg, state = net.legs[i], net.state[i]
        begins_free = leg.kind == STANDING or leg.kind == HANGING_DOWN
        ends_free = leg.kind == STANDING or leg.kind == ANCHORED
        if (leg.start < 0 and not begins_free) or (leg.end < 0 and not ends_free):
            return False
        if leg.seabed == -inf:
            continue
        record, foot = net.lines.work.records[i][FINE], int(state[SUSPENDED]) - 1
        east, north, least = record[3][foot], record[4][foot], NEGLIGIBLE_PULL * leg.weight
        if state[STAGE] < 0.0 or east * east + north * north > least * least:
            return False
        anchored = True
    return anchored


def record_shapes(net: NetProblem, x: Sequence[float], how: Marching) -> None:
    """Reverse the records of legs that were marched upwards, so that all records run downwards."""
    for i in range(len(net.legs)):
        if net.legs[i].kind == ANCHORED:
            record_down(net, i, x, how)


def close_coarsely(
    net: NetProblem, sea: Sea, x: MutableSequence[float], step: float, enough: float
) -> int:
    """Choose segments for twice the given angle step, and close the net on these segments."""
    choosing = Marching(sea, 2.0 * step, CHOSEN, False, False, COARSE, 0.0)
    failure = write_residual(net, x, choosing, False)
    if failure != GOES_ON:
        return NEEDS_ROOM if failure == NO_ROOM else NO_SHAPE_NEAR
    coarse = Marching(sea, 2.0 * step, CHOSEN, True, True, COARSE, 0.0)
    return close_on(net, x, coarse, enough, True)


def settle(net: NetProblem, sea: Sea, x: MutableSequence[float], step: float, enough: float) -> int:
    """Close a net to full precision from approximate unknowns, on sufficiently short segments."""
    # segments depend on the unknowns for which they are chosen, so choose them again in the closed
    # shape, unless a single unknown is precise enough at once
    if len(x) > 1 and net.lines.limits.near == 0.0:
        ending = close_coarsely(net, sea, x, step, max(enough, CLOSED_FOR_SEGMENTS))
        if ending != FOUND:
            return ending
    requested = step
    for _ in range(MOST_ROUNDS):
        ending = close_both(net, sea, x, step, enough)
        if ending != FOUND:
            return ending
        step = finer(extrapolate_legs(net, x), net.span, requested, step, segments_of(net))
        if step == 0.0:
            break
    return FOUND


def close_both(
    net: NetProblem, sea: Sea, x: MutableSequence[float], step: float, enough: float
) -> int:
    """Close a net on segments for twice the given angle step, and then on the halved segments."""
    ending = close_coarsely(net, sea, x, step, enough)
    if ending != FOUND:
        return ending
    record_shapes(net, x, Marching(sea, 2.0 * step, CHOSEN, True, True, COARSE, 0.0))
    copy_values(x, net.coarse)
    for i in range(len(net.legs)):
        state = net.state[i]
        state[COARSE_COUNT], state[COARSE_SUSPENDED] = state[COUNT], state[SUSPENDED]
        state[COARSE_STAGE], state[COARSE_GROUNDED] = state[STAGE], state[GROUNDED]
    fine = Marching(sea, step, HALVED, True, True, FINE, 0.0)
    ending = close_net(net, x, fine, enough, True)
    if ending == FOUND:
        record_shapes(net, x, fine)
    return ending


def segments_of(net: NetProblem) -> int:
    """Return the total number of halved segments in all legs."""
    segments = 0
    for i in range(len(net.legs)):
        for k in range(net.legs[i].cables):
            segments += 2 * net.lines.work.counts[i][k]
    return segments


def extrapolate_legs(net: NetProblem, x: Sequence[float]) -> Errors:
    """Extrapolate all legs and nodes to zero segment length.

    Return the estimated errors.
    """
    records, near = net.lines.work.records, net.lines.limits.near
    deep = taut = moved = relative = 0.0
    for k in range(len(x)):
        net.better[k] = x[k] + (x[k] - net.coarse[k]) / 3.0
    for k in range(net.nodes_at, len(x), 3):
        east, north = net.better[k] - x[k], net.better[k + 1] - x[k + 1]
        moved = max(moved, sqrt(east * east + north * north), abs(net.better[k + 2] - x[k + 2]))
    for i in range(len(net.legs)):
        state, record = net.state[i], records[i][FINE]
        nodes, hanging = int(state[COUNT]), int(state[SUSPENDED]) - 1
        coarse_hanging = int(state[COARSE_SUSPENDED]) - 1
        coarse = Extent(int(state[COARSE_COUNT]), coarse_hanging, state[COARSE_STAGE] >= 0.0)
        fine = Extent(nodes, hanging, state[STAGE] >= 0.0)
        errors = extrapolate(records[i][COARSE], coarse, record, fine, near)
        deep, taut = max(deep, errors.depth), max(taut, errors.tension)
        relative = max(relative, errors.relative)
        pieces = net.legs[i].pieces
        first, last = net.first[i][:pieces], net.last[i][:pieces]
        find_ends(RefereeShape(record, nodes, nodes - 1, first, last))
        copy_values(first, net.first[i])
        copy_values(last, net.last[i])
    net.errors[DEPTH_ERROR], net.errors[TENSION_ERROR] = deep + moved, taut
    return Errors(deep + moved, taut, relative, taut, taut)


class NetTask(NamedTuple):
    """Arguments of `do_task`, the only entry point to the compiled code for a net.

    Attributes
    ----------
    task : `MARCH`, `SLOPES` (march and Jacobian), `CLOSE` (`close_net`), `SETTLE` (`settle`), or
        `DRIFTS` (`drifts` for the last settled net)
    x : the unknowns, which CLOSE and SETTLE overwrite with the solution
    enough, known : as in `close_net`
    """

    task: int
    net: NetProblem
    x: MutableSequence[float]
    how: Marching
    enough: float
    known: bool


MARCH, SLOPES, CLOSE, SETTLE, DRIFTS = range(5)


def do_task(job: NetTask) -> int:
    """Perform a task and return its outcome.

    The outcome of DRIFTS is 1 if the net drifts, otherwise 0.
    """
    net, x, how = job.net, job.x, job.how
    if job.task == DRIFTS:
        return 1 if drifts(net) else 0
    if job.task == SETTLE:
        return settle(net, how.sea, x, how.step, job.enough)
    if job.task == CLOSE:
        return close_net(net, x, how, job.enough, job.known)
    failure = write_residual(net, x, how, job.task == SLOPES)
    if job.task == MARCH and failure == GOES_ON:
        record_shapes(net, x, how)
    return failure
