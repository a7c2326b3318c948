"""A net of legs as laws: its legs marched, what is left at its ends and nodes, and its shape.

Unknown are the depths of free ends, the pulls on upper ends that are not free, and the places of
nodes. Newton's method closes them on segments that stay; its slopes are differences of marches,
and Broyden's while these lead on.
"""

from __future__ import annotations

from collections.abc import Callable, MutableSequence, Sequence
from math import degrees, inf, sqrt
from typing import Any, NamedTuple

from calm.physics.compiled import set_row
from calm.physics.hull import HullRow, SurfaceFloat
from calm.physics.line import GOES_ON, NO_ROOM
from calm.physics.passing import FAILURE, FX, FY, HANGING, LANDED, NODES, How, Z, pass_line
from calm.physics.profile import Sea
from calm.physics.referee import RefereeShape, find_ends
from calm.physics.seabed import lay_line
from calm.physics.stretch import Knot
from calm.physics.strumming import Vibration
from calm.physics.track import CableStretch, Course, Load, Stage
from calm.solve.closing import halve, place
from calm.solve.problem import (
    BELOW,
    CHOSEN,
    COARSE,
    FINE,
    HALVED,
    OTHER,
    BuoyantPiece,
    SearchArrays,
    Unknown,
)

STANDING, HANGING_DOWN, PULLED = range(3)
"""Legs marched from a free upper end, from a free lower end, and from an upper end that is held."""
MOST_STEPS, HALVINGS = 60, 9
"""Newton steps towards a shape, and how often one is halved that leads nowhere."""
NEAR, CLOSED = 1e-4, 1e-10
"""What is left of lengths and forces, as shares of the longest leg and of a typical force: before
segments are kept, and in a shape."""
WORTH = 5e-5
"""Errors, as shares of the water depth and of the greatest tension, above which segments are
halved once more, `MOST_HALVINGS` times."""
MOST_HALVINGS = 3
JUMP = 1e-6
"""Share by which an unknown is moved for the slopes."""
LEADS_ON = 0.04
"""What a step leaves of the sum of squares, at most, for slopes to be kept."""
SINGULAR = 1e-14
"""Share of the greatest pivot below which an unknown is left as it is."""
CAME_OUT, NOT_CLOSED, TO_AND_FRO, NEEDS_ROOM = range(4)
"""How a net ends: closed; not; a leg alternately lies and lifts off; more segments than there is
room for."""

LANDS, STAGE, GROUNDED, SHARE, MARCHES, COUNT, HUNG = range(7)
"""Of a leg as it was marched last: whether it may land, the stage where it did or -1, its length on
the seabed [m], its share of a float's buoyancy in use, how often it was marched; its nodes, and
those of them that hang."""
OF_LEG = 7
DEPTH_ERROR, TENSION_ERROR = range(2)


class LegRow(NamedTuple):
    """A leg in numbers.

    Attributes
    ----------
    kind, first, unknowns : how it is marched, and which of the unknowns are its own
    start, end : numbers of the nodes where its march begins and ends; -1 for none
    start_z, end_x, end_y, end_z : of ends that are held [m]; of the start x and y as well
    seabed : height of the seabed below its anchor; -inf where it has none [m]
    longest : segment at an angle step of 1° [m]
    stands : length of a float that shows how much of it is out of the water [m]
    highest : how high it may come [m]
    stages, landing, cables, surfacing, rows, pieces : how many there are of each, see `Course`
    rides, excess, friction : as in `Limits`
    """

    kind: int
    first: int
    unknowns: int
    start: int
    end: int
    start_x: float
    start_y: float
    start_z: float
    end_x: float
    end_y: float
    end_z: float
    seabed: float
    longest: float
    stands: float
    highest: float
    stages: int
    landing: int
    cables: int
    surfacing: int
    rows: int
    pieces: int
    rides: int
    excess: float
    friction: float


class NetProblem(NamedTuple):
    """A net to be closed. What is of its legs has a row for each of them, as long as the longest.

    Attributes
    ----------
    stages, loads, cables, knots : of each leg's course; `given` are the loads below the surface
    surfacing, afloat, hull, work : as in `LineProblem`
    state : numbers of each leg: `LANDS` and those after it
    passed : (·, 6) way east and north, height, and force, where each came out
    first, last, ends : node of each piece's ends; place and tension there
    found, kept, slopes, way : what is left, by shares of `rows`, now and before, its slopes by
        shares of `scale`, and the step that they ask for
    trial, paper, order : room to find it
    errors : of depths [m] and tensions [N]
    nodes_at : first unknown of the nodes
    depth, length, force : of the water, of the longest leg [m]; a typical one [N]
    """

    legs: Sequence[LegRow]
    stages: Sequence[Sequence[Stage]]
    loads: Sequence[MutableSequence[Load]]
    given: Sequence[Sequence[Load]]
    cables: Sequence[Sequence[CableStretch]]
    knots: Sequence[Sequence[Knot]]
    surfacing: Sequence[Sequence[BuoyantPiece]]
    afloat: Sequence[SurfaceFloat]
    hull: Sequence[Sequence[HullRow]]
    work: Any
    state: Sequence[MutableSequence[float]]
    passed: Sequence[MutableSequence[float]]
    first: Sequence[MutableSequence[int]]
    last: Sequence[MutableSequence[int]]
    ends: Sequence[Sequence[MutableSequence[float]]]
    found: MutableSequence[float]
    kept: MutableSequence[float]
    slopes: Sequence[MutableSequence[float]]
    way: MutableSequence[float]
    trial: MutableSequence[float]
    paper: Sequence[MutableSequence[float]]
    order: MutableSequence[int]
    scale: Sequence[float]
    rows: Sequence[float]
    errors: MutableSequence[float]
    vibration: Vibration
    nodes_at: int
    depth: float
    length: float
    force: float


class Marching(NamedTuple):
    """How all legs are marched: in which water, at which angle step, on which cuts, given or
    chosen now, and where they are recorded.
    """

    sea: Sea
    step: float
    cuts: int
    given: bool
    record: int


class LegProblem(NamedTuple):
    """What the march of a leg needs of a `LineProblem`."""

    course: Course
    sea: Sea
    loads: Sequence[Load]
    surfacing: Sequence[BuoyantPiece]
    afloat: SurfaceFloat
    hull: Sequence[HullRow]
    work: SearchArrays


def leg_of(net: NetProblem, sea: Sea, i: int) -> Any:
    """A leg as a line, as far as it is marched."""
    leg, work, own = net.legs[i], net.work, net.afloat[i]
    course = Course(
        net.stages[i][: leg.stages], net.loads[i], net.cables[i][: leg.cables], net.knots[i],
        net.vibration, leg.landing,
    )  # fmt: skip
    afloat = SurfaceFloat(
        own.form, own.height, own.area, own.weight, own.lift, own.surface_drag, own.wind_east,
        own.wind_north, own.wind_area, own.wind_cd,
    )  # fmt: skip
    arrays = SearchArrays(
        work.left[i], work.chosen[i], work.halved[i], work.counts[i], work.records[i],
        work.shares[i], work.samples[i], work.even[i], work.elements[i], work.found[i],
    )  # fmt: skip
    surfacing, hull = net.surfacing[i][: leg.surfacing], net.hull[i][: leg.rows]
    return LegProblem(course, sea, net.given[i], surfacing, afloat, hull, arrays)


def start_of_leg(net: NetProblem, i: int, x: Sequence[float]) -> tuple[float, float, float]:
    """Where the march of a leg begins that is pulled [m]."""
    leg = net.legs[i]
    if leg.start < 0:
        return leg.start_x, leg.start_y, leg.start_z
    k = net.nodes_at + 3 * leg.start
    return x[k], x[k + 1], x[k + 2]


def end_of_leg(net: NetProblem, i: int, x: Sequence[float]) -> tuple[float, float, float]:
    """Where a leg is to come out [m]; what lies on the seabed ends there."""
    leg = net.legs[i]
    if leg.end < 0:
        return leg.end_x, leg.end_y, leg.seabed if net.state[i][LANDS] > 0.0 else leg.end_z
    k = net.nodes_at + 3 * leg.end
    return x[k], x[k + 1], x[k + 2]


def begun(net: NetProblem, problem: Any, i: int, x: Sequence[float]) -> tuple[float, float]:
    """Load a leg with what is unknown of it.

    Returns
    -------
    Depth of its start, and length of its head above the surface, as of `place` [m].
    """
    leg, state = net.legs[i], net.state[i]
    state[SHARE] = 1.0
    if leg.kind == PULLED:
        east, north, up = x[leg.first], x[leg.first + 1], x[leg.first + 2]
        pull = Load(0, -1, 0.0, 0.5, 0.0, up, 0.0, 0.0, 0.0, 0, 0.0, east, north, 0.0, 0.0)
        set_row(problem.course.loads, 0, pull)
        _, _, z = start_of_leg(net, i, x)
        return -z, 0.0
    sought, value = BELOW, x[leg.first]
    if leg.kind == STANDING and value < 0.0 and leg.surfacing > 0:
        sought, value = 0, 1.0 + value / leg.stands
        state[SHARE] = value
    return place(problem, Unknown(0.0, sought, leg.rides > 0, False, 0), value)


def march_leg(net: NetProblem, i: int, x: Sequence[float], how: Marching) -> int:
    """March a leg from what is unknown of it; how that ended, see `calm.physics.line`."""
    leg, state, problem = net.legs[i], net.state[i], leg_of(net, how.sea, i)
    course, work = problem.course, problem.work
    depth, out = begun(net, problem, i, x)
    cuts = work.halved if how.cuts == HALVED else work.chosen
    record, left = work.records[how.record], work.left
    reach = degrees(how.step) * leg.longest
    lands = state[LANDS] > 0.0
    asked = How(how.step, reach, 0.0, leg.stages, lands, how.given, True)
    pass_line(course, how.sea, asked, depth, out, cuts, work.counts[how.cuts], record, left)
    state[MARCHES] += 1.0
    if left[FAILURE] != GOES_ON:
        return int(left[FAILURE])
    nodes, grounded = int(left[NODES]), 0.0
    state[STAGE], state[HUNG] = left[LANDED], nodes
    if left[LANDED] >= 0.0:
        nodes, grounded = lay_line(
            course, record, nodes, int(left[LANDED]), left[HANGING], left[FX], left[FY],
            leg.seabed, leg.excess, leg.friction,
        )  # fmt: skip
    state[COUNT], state[GROUNDED] = nodes, grounded
    passed, n = net.passed[i], nodes - 1
    passed[0], passed[1] = record[0][n] - record[0][0], record[1][n] - record[1][0]
    passed[2] = left[Z]
    passed[3], passed[4], passed[5] = record[3][n], record[4][n], record[5][n]
    return GOES_ON


def add_passed(net: NetProblem, i: int, out: Sequence[float], share: float, column: int) -> None:
    """Add a share of what a leg came out with to what is left, or to a column of its slopes."""
    leg = net.legs[i]
    for k in range(6):
        row = leg.first + k
        if k < 3:
            if leg.kind != PULLED:
                if k < 2:
                    continue
                row = leg.first
        elif leg.end < 0:
            break
        else:
            row = net.nodes_at + 3 * leg.end + k - 3
        change = share * out[k] / net.rows[row]
        if column < 0:
            net.found[row] += change
        else:
            net.slopes[row][column] += change


def left_over(net: NetProblem, x: MutableSequence[float], how: Marching, slopes: bool) -> int:
    """Write what is left to be closed and balanced to `found`, and its slopes where asked for.

    Returns how the marches ended.
    """
    size, nodes = len(net.found), net.nodes_at
    for k in range(size):
        net.found[k] = 0.0
        if slopes:
            for m in range(size):
                net.slopes[k][m] = 0.0
    for i in range(len(net.legs)):
        leg = net.legs[i]
        failure = march_leg(net, i, x, how)
        if failure != GOES_ON:
            return failure
        out, at = net.passed[i], leg.first
        add_passed(net, i, out, 1.0, -1)
        east, north, up = end_of_leg(net, i, x)
        if leg.kind == PULLED:
            x0, y0, _ = start_of_leg(net, i, x)
            net.found[at] += (x0 - east) / net.rows[at]
            net.found[at + 1] += (y0 - north) / net.rows[at + 1]
            net.found[at + 2] -= up / net.rows[at + 2]
            if leg.start >= 0:
                for k in range(3):
                    row = nodes + 3 * leg.start + k
                    net.found[row] -= x[at + k] / net.rows[row]
        else:
            net.found[at] -= up / net.rows[at]
        if slopes:
            failure = slopes_of_leg(net, i, x, how)
            if failure != GOES_ON:
                return failure
    return GOES_ON


def slopes_of_leg(net: NetProblem, i: int, x: MutableSequence[float], how: Marching) -> int:
    """Add what a leg has in the slopes of what is left."""
    leg, nodes, at = net.legs[i], net.nodes_at, net.legs[i].first
    free = leg.unknowns + (1 if leg.kind == PULLED and leg.start >= 0 else 0)
    moved = Marching(how.sea, how.step, how.cuts, True, OTHER)
    for m in range(free):
        k = at + m if m < leg.unknowns else nodes + 3 * leg.start + 2
        add_passed(net, i, net.passed[i], -1.0 / JUMP, k)
    for m in range(free):
        k = at + m if m < leg.unknowns else nodes + 3 * leg.start + 2
        before = x[k]
        x[k] = before + JUMP * net.scale[k]
        failure = march_leg(net, i, x, moved)
        x[k] = before
        if failure != GOES_ON:
            return failure
        add_passed(net, i, net.passed[i], 1.0 / JUMP, k)
    for k in range(3):
        if leg.kind == PULLED:
            row = at + k
            if leg.start >= 0:
                start = nodes + 3 * leg.start + k
                net.slopes[start][at + k] -= net.scale[at + k] / net.rows[start]
                if k < 2:
                    net.slopes[row][start] += net.scale[start] / net.rows[row]
        elif k < 2:
            continue
        else:
            row = at
        if leg.end >= 0:
            end = nodes + 3 * leg.end + k
            net.slopes[row][end] -= net.scale[end] / net.rows[row]
    return GOES_ON


def find_way(net: NetProblem, found: Sequence[float]) -> float:
    """Write the step that brings to nothing what is left, by its slopes; its greatest share.

    By elimination with the greatest pivot. Where the slopes do not say, unknowns stay.
    """
    size, paper, order = len(found), net.paper, net.order
    for r in range(size):
        for c in range(size):
            paper[r][c] = net.slopes[r][c]
        paper[r][size], order[r] = -found[r], r
    rank, greatest = size, 0.0
    for k in range(size):
        best, row, column = 0.0, k, k
        for r in range(k, size):
            for c in range(k, size):
                if abs(paper[r][c]) > best:
                    best, row, column = abs(paper[r][c]), r, c
        greatest = max(greatest, best)
        if best <= SINGULAR * greatest:
            rank = k
            break
        for c in range(size + 1):
            paper[k][c], paper[row][c] = paper[row][c], paper[k][c]
        order[k], order[column] = order[column], order[k]
        for r in range(size):
            paper[r][k], paper[r][column] = paper[r][column], paper[r][k]
        for r in range(k + 1, size):
            share = paper[r][k] / paper[k][k]
            if share != 0.0:
                for c in range(k, size + 1):
                    paper[r][c] -= share * paper[k][c]
    most = 0.0
    for k in range(size - 1, -1, -1):
        value = 0.0
        if k < rank:
            value = paper[k][size]
            for c in range(k + 1, rank):
                value -= paper[k][c] * net.way[order[c]]
            value /= paper[k][k]
        net.way[order[k]] = value
        most = max(most, abs(value))
    return most


def squares(values: Sequence[float]) -> float:
    """The sum of the squares."""
    total = 0.0
    for k in range(len(values)):
        total += values[k] * values[k]
    return total


def greatest_of(values: Sequence[float]) -> float:
    """The greatest of the absolute values."""
    most = 0.0
    for k in range(len(values)):
        most = max(most, abs(values[k]))
    return most


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
    size, trial, fresh = len(x), net.trial, not known
    failure = left_over(net, x, how, fresh)
    if failure != GOES_ON:
        return NEEDS_ROOM if failure == NO_ROOM else NOT_CLOSED
    plain = known
    left = net.kept
    keep(net.found, left)
    for _ in range(MOST_STEPS):
        if greatest_of(left) <= enough:
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
            if greatest_of(left) > 100.0 * enough:
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
        if fresh and (not plain or greatest_of(left) > enough):
            failure = left_over(net, x, how, True)
            if failure != GOES_ON:
                return NOT_CLOSED
            keep(net.found, left)
            plain = False
    if greatest_of(left) > 100.0 * enough:
        return NOT_CLOSED
    if not plain and left_over(net, x, how, False) != GOES_ON:
        return NOT_CLOSED
    return CAME_OUT


def lies_otherwise(net: NetProblem, sea: Sea, record: int) -> bool:
    """Whether a leg lies on the seabed but was taken to hang clear, or the other way round.

    It is taken to do so from then on.
    """
    changed = False
    for i in range(len(net.legs)):
        leg, state, height = net.legs[i], net.state[i], net.work.records[i][record][2]
        if leg.kind == HANGING_DOWN or leg.seabed == -inf:
            continue
        lies = state[STAGE] >= 0.0
        if state[LANDS] == 0.0:
            lowest = inf
            for n in range(int(state[HUNG])):
                lowest = min(lowest, height[n])
            lies = lowest < leg.seabed - 1e-6 * net.depth
        changed = changed or lies != (state[LANDS] > 0.0)
        state[LANDS] = 1.0 if lies else 0.0
    return changed


def moved_ends(net: NetProblem, x: Sequence[float], record: int) -> float:
    """Write where the ends of all pieces are, and how much these and their tensions have moved.

    Returns the greatest tension.
    """
    net.errors[DEPTH_ERROR] = net.errors[TENSION_ERROR] = greatest = 0.0
    for i in range(len(net.legs)):
        nodes, shape = int(net.state[i][COUNT]), net.work.records[i][record]
        pieces, end = net.legs[i].pieces, nodes - 1
        first, last = net.first[i][:pieces], net.last[i][:pieces]
        find_ends(RefereeShape(shape, nodes, end, first, last))
        keep(first, net.first[i])
        keep(last, net.last[i])
        east, north, _ = end_of_leg(net, i, x)
        for p in range(pieces + 1):
            n, row = 0 if p == 0 else int(net.last[i][p - 1]), net.ends[i][p]
            fx, fy, fz = shape[3][n], shape[4][n], shape[5][n]
            tension = sqrt(fx * fx + fy * fy + fz * fz)
            x0, y0 = shape[0][n] - shape[0][end] + east, shape[1][n] - shape[1][end] + north
            off = max(abs(x0 - row[0]), abs(y0 - row[1]), abs(shape[2][n] - row[2]))
            net.errors[DEPTH_ERROR] = max(net.errors[DEPTH_ERROR], 0.5 * off)
            net.errors[TENSION_ERROR] = max(net.errors[TENSION_ERROR], 0.5 * abs(tension - row[3]))
            row[0], row[1], row[2], row[3] = x0, y0, shape[2][n], tension
            greatest = max(greatest, tension)
    return greatest


def settle(net: NetProblem, sea: Sea, x: MutableSequence[float], step: float) -> int:
    """Close a net that about is to the last digits, on segments that are short enough."""
    coarse = Marching(sea, 2.0 * step, CHOSEN, True, COARSE)
    ending, lies = CAME_OUT, True
    for left in range(len(net.legs), -1, -1):
        failure = left_over(net, x, Marching(sea, 2.0 * step, CHOSEN, False, COARSE), False)
        if failure != GOES_ON:
            return NEEDS_ROOM if failure == NO_ROOM else NOT_CLOSED
        ending = close_net(net, x, coarse, CLOSED, True)
        if ending != CAME_OUT:
            return ending
        lies = lies_otherwise(net, sea, COARSE)
        if not lies:
            break
        roughly = Marching(sea, 4.0 * step, CHOSEN, False, COARSE)
        if left == 0 or close_net(net, x, roughly, NEAR, False) != CAME_OUT:
            return TO_AND_FRO
    moved_ends(net, x, COARSE)
    for turn in range(MOST_HALVINGS):
        for i in range(len(net.legs)):
            leg = leg_of(net, sea, i)
            if turn > 0 and not keep_halves(leg):
                return NEEDS_ROOM
            halve(leg)
        ending = close_net(net, x, Marching(sea, step, HALVED, True, FINE), CLOSED, True)
        if ending != CAME_OUT:
            return ending
        greatest = moved_ends(net, x, FINE)
        deep, taut = net.errors[DEPTH_ERROR], net.errors[TENSION_ERROR]
        if deep <= WORTH * net.depth and taut <= WORTH * greatest:
            break
    return CAME_OUT


def keep_halves(leg: Any) -> bool:
    """Take halved cuts for the chosen ones; whether there is room for that."""
    work, count = leg.work, 0
    for k in range(len(leg.course.cables)):
        work.counts[CHOSEN][k] = work.counts[HALVED][k]
        count += work.counts[HALVED][k]
    if count > len(work.chosen):
        return False
    for n in range(count):
        work.chosen[n] = work.halved[n]
    return True


class AskedNet(NamedTuple):
    """What `ask_net` is asked: to march a net, with the slopes or without, to close it or to settle
    it, from unknowns that it changes.

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


MARCH, SLOPES, CLOSE, SETTLE = range(4)


def ask_net(asked: AskedNet, _: float) -> float:
    """Do what is asked; how it ended."""
    net, x, how = asked.net, asked.x, asked.how
    if asked.task == SETTLE:
        return float(settle(net, how.sea, x, how.step))
    if asked.task == CLOSE:
        return float(close_net(net, x, how, asked.enough, asked.known))
    return float(left_over(net, x, how, asked.task == SLOPES))


def ask_now(ask: Callable[[AskedNet, float], float], asked: AskedNet) -> float:
    """Call `ask_net` by its address."""
    return ask(asked, 0.0)
