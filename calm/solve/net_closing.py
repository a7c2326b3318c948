"""A net of legs closed, as laws: Newton's method on segments that stay.

Slopes are kept by Broyden's rule while they lead on.
"""

from collections.abc import Callable, MutableSequence, Sequence
from math import inf, sqrt
from typing import Any, NamedTuple

from calm.physics.line import GOES_ON, NO_ROOM
from calm.physics.profile import Sea
from calm.physics.referee import RefereeShape, find_ends
from calm.solve.closing import halve
from calm.solve.net_march import left_over
from calm.solve.net_problem import (
    ANCHORED,
    COUNT,
    HANGING_DOWN,
    HUNG,
    STAGE,
    STANDING,
    Marching,
    NetProblem,
    leg_of,
    place_of,
)
from calm.solve.net_touchdown import record_down
from calm.solve.problem import CHOSEN, COARSE, FINE, HALVED

MOST_STEPS, HALVINGS = 60, 9
"""Newton steps towards a shape, and how often one is halved that leads nowhere."""
NEAR, CLOSED = 1e-4, 1e-10
"""What is left of lengths and forces, as shares of the longest leg and of a typical force: before
segments are kept, and in a shape."""
WORTH, WORTH_OF_MANY = 5e-5, 2e-5
"""Errors, as shares of the water depth and of the greatest tension, above which segments are
halved once more, `MOST_HALVINGS` times; of one of many, whose segments are longer."""
MOST_HALVINGS = 3
BEFORE_CHOICE = 1e-7
"""As `CLOSED`, of a shape in which segments are chosen that are to depend on nothing but the net."""
MOST_LEFT = 10.0
"""How many times `enough` may be left where no step leads on."""
LEADS_ON = 0.25
"""What a step leaves of the sum of squares, at most, for slopes to be kept."""
SINGULAR = 1e-14
"""Slope, in shares, below which an unknown is left as it is."""
NO_HOLD = 1e-5
"""Pull at a touchdown, as a share of the weight of a leg, that holds nothing in place: more than the
drag in a breath of current."""
CAME_OUT, NOT_CLOSED, NEEDS_ROOM = range(3)
"""How a net ends: closed; not; more segments than there is room for."""

DEPTH_ERROR, TENSION_ERROR = range(2)


def find_way(net: NetProblem, found: Sequence[float]) -> float:
    """Write the step that brings to nothing what is left, by its slopes; its size, in shares.

    By elimination, column by column. Unknowns of which the slopes say nothing stay.
    """
    size, paper, row = len(found), net.paper, 0
    for r in range(size):
        for c in range(size):
            paper[r][c] = net.slopes[r][c]
        paper[r][size] = -found[r]
    for k in range(size):
        pivot = row
        for r in range(row, size):
            if abs(paper[r][k]) > abs(paper[pivot][k]):
                pivot = r
        net.order[k] = -1
        if row == size or abs(paper[pivot][k]) < SINGULAR:
            continue
        for c in range(k, size + 1):
            paper[row][c], paper[pivot][c] = paper[pivot][c], paper[row][c]
        for r in range(size):
            share = 0.0 if r == row else paper[r][k] / paper[row][k]
            if share != 0.0:
                for c in range(k, size + 1):
                    paper[r][c] -= share * paper[row][c]
        net.order[k] = row
        row += 1
    for k in range(size):
        row = net.order[k]
        net.way[k] = 0.0 if row < 0 else paper[row][size] / paper[row][k]
    return sqrt(squares(net.way))


def squares(values: Sequence[float]) -> float:
    """The sum of the squares."""
    total = 0.0
    for k in range(len(values)):
        total += values[k] * values[k]
    return total


def keep(values: Sequence[Any], kept: MutableSequence[Any]) -> None:
    """Copy values."""
    for k in range(len(values)):
        kept[k] = values[k]


def close_net(
    net: NetProblem, x: MutableSequence[float], how: Marching, enough: float, known: bool
) -> int:
    """Newton's method; the last march is that of the unknowns that it ends with.

    Parameters
    ----------
    x : the unknowns, where they about are; then those found
    enough : what may be left, in shares
    known : whether the slopes are about right already, and need not be found first
    """
    failure = left_over(net, x, how, not known)
    if failure != GOES_ON:
        return NEEDS_ROOM if failure == NO_ROOM else NOT_CLOSED
    return close_on(net, x, how, enough, known)


def close_on(
    net: NetProblem, x: MutableSequence[float], how: Marching, enough: float, known: bool
) -> int:
    """`close_net` from unknowns that were marched last, on these segments."""
    size, trial, fresh, plain, left = len(x), net.trial, not known, known, net.kept
    keep(net.found, left)
    for _ in range(MOST_STEPS):
        if squares(left) <= enough * enough:
            break
        before = squares(left)
        share = min(1.0, 0.5 / max(find_way(net, left), 1e-300))
        now = inf
        for _ in range(HALVINGS if fresh else 1):
            for k in range(size):
                trial[k] = x[k] + share * net.way[k] * net.scale[k]
            failure = left_over(net, trial, how, False)
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
                return NOT_CLOSED
            break
        if plain:
            keep(trial, x)
            whole = share * share * squares(net.way)
            for k in range(size):
                off = (net.found[k] - (1.0 - share) * left[k]) * share / max(whole, 1e-300)
                for m in range(size):
                    net.slopes[k][m] += off * net.way[m]
            keep(net.found, left)
        fresh = not now < LEADS_ON * before
        if fresh and (not plain or squares(left) > enough * enough):
            failure = left_over(net, x, how, True)
            if failure != GOES_ON:
                return NOT_CLOSED
            keep(net.found, left)
            plain = False
    if squares(left) > MOST_LEFT * MOST_LEFT * enough * enough:
        return NOT_CLOSED
    if not plain:
        left_over(net, x, how, False)
    return CAME_OUT


def drifts(net: NetProblem) -> bool:
    """Return whether no end is held and every leg to an anchor lies on the seabed unpulled.

    Where such a net is depends on nothing but where it was put.
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
        record, foot = net.lines.work.records[i][FINE], int(state[HUNG]) - 1
        east, north, least = record[3][foot], record[4][foot], NO_HOLD * leg.weight
        if state[STAGE] < 0.0 or east * east + north * north > least * least:
            return False
        anchored = True
    return anchored


def record_shapes(net: NetProblem, x: Sequence[float], how: Marching) -> None:
    """Turn the records of all legs that were marched up into those of legs marched down."""
    for i in range(len(net.legs)):
        if net.legs[i].kind == ANCHORED:
            record_down(net, i, x, how)


def moved_ends(net: NetProblem, x: Sequence[float], record: int) -> float:
    """Write where the ends of all pieces are, and how much these and their tensions have moved.

    Returns the greatest tension.
    """
    net.errors[DEPTH_ERROR] = net.errors[TENSION_ERROR] = greatest = 0.0
    for i in range(len(net.legs)):
        nodes, shape = int(net.state[i][COUNT]), net.lines.work.records[i][record]
        pieces, end = net.legs[i].pieces, nodes - 1
        first, last = net.first[i][:pieces], net.last[i][:pieces]
        find_ends(RefereeShape(shape, nodes, end, first, last))
        keep(first, net.first[i])
        keep(last, net.last[i])
        to_east, to_north, _ = place_of(net, i, x, 1)
        for p in range(pieces + 1):
            n, row = 0 if p == 0 else int(net.last[i][p - 1]), net.ends[i][p]
            fx, fy, fz = shape[3][n], shape[4][n], shape[5][n]
            tension = sqrt(fx * fx + fy * fy + fz * fz)
            x0 = shape[0][n] - shape[0][end] + to_east
            y0 = shape[1][n] - shape[1][end] + to_north
            east, north = x0 - row[0], y0 - row[1]
            off = max(sqrt(east * east + north * north), abs(shape[2][n] - row[2]))
            net.errors[DEPTH_ERROR] = max(net.errors[DEPTH_ERROR], 0.5 * off)
            net.errors[TENSION_ERROR] = max(net.errors[TENSION_ERROR], 0.5 * abs(tension - row[3]))
            row[0], row[1], row[2], row[3] = x0, y0, shape[2][n], tension
            greatest = max(greatest, tension)
    return greatest


def close_coarsely(
    net: NetProblem, sea: Sea, x: MutableSequence[float], step: float, enough: float
) -> int:
    """Choose segments of twice a step [rad] and close a net that about is on them."""
    choosing = Marching(sea, 2.0 * step, CHOSEN, False, COARSE, 0.0)
    failure = left_over(net, x, choosing, False)
    if failure != GOES_ON:
        return NEEDS_ROOM if failure == NO_ROOM else NOT_CLOSED
    coarse = Marching(sea, 2.0 * step, CHOSEN, True, COARSE, 0.0)
    return close_on(net, x, coarse, enough, True)


def settle(net: NetProblem, sea: Sea, x: MutableSequence[float], step: float, enough: float) -> int:
    """Close a net that about is to the last digits, on segments that are short enough."""
    many = net.lines.limits.near > 0.0
    worth = WORTH_OF_MANY if many else WORTH
    if not many:  # segments are chosen anew where these lead
        ending = close_coarsely(net, sea, x, step, max(enough, BEFORE_CHOICE))
        if ending != CAME_OUT:
            return ending
    for _ in range(MOST_HALVINGS):
        ending = close_coarsely(net, sea, x, step, enough)
        if ending != CAME_OUT:
            return ending
        record_shapes(net, x, Marching(sea, 2.0 * step, CHOSEN, True, COARSE, 0.0))
        moved_ends(net, x, COARSE)
        for i in range(len(net.legs)):
            halve(leg_of(net, sea, i))
        fine = Marching(sea, step, HALVED, True, FINE, 0.0)
        ending = close_net(net, x, fine, enough, True)
        if ending != CAME_OUT:
            return ending
        record_shapes(net, x, fine)
        tension = worth * moved_ends(net, x, FINE)
        if (
            net.errors[DEPTH_ERROR] <= worth * net.lines.limits.depth
            and net.errors[TENSION_ERROR] <= tension
        ):
            break
        step *= 0.5
    return CAME_OUT


class AskedNet(NamedTuple):
    """Hold what `ask_net` is asked: to march a net, with the slopes or without, to close it or to
    settle it, from unknowns that it changes; or whether the net as it was settled drifts.

    Attributes
    ----------
    enough, known : as of `close_net`
    """

    task: int
    net: NetProblem
    x: MutableSequence[float]
    how: Marching
    enough: float
    known: bool


MARCH, SLOPES, CLOSE, SETTLE, DRIFTS = range(5)


def ask_net(asked: AskedNet, _: float) -> float:
    """Do what is asked; how it ended."""
    net, x, how = asked.net, asked.x, asked.how
    if asked.task == DRIFTS:
        return 1.0 if drifts(net) else 0.0
    if asked.task == SETTLE:
        return float(settle(net, how.sea, x, how.step, asked.enough))
    if asked.task == CLOSE:
        return float(close_net(net, x, how, asked.enough, asked.known))
    failure = left_over(net, x, how, asked.task == SLOPES)
    if asked.task == MARCH and failure == GOES_ON:
        record_shapes(net, x, how)
    return float(failure)


def ask_now(ask: Callable[[AskedNet, float], float], asked: AskedNet) -> float:
    """Call `ask_net` by its address."""
    return ask(asked, 0.0)
