"""A net of legs as laws: its legs marched, and what is left at its ends and nodes.

Unknown are the depths of free ends, the pulls on upper ends that are not free, and the places of
nodes; slopes are differences of marches on the same segments.
"""

from collections.abc import MutableSequence, Sequence
from math import degrees, inf, sqrt
from typing import Any, NamedTuple

from calm.physics.compiled import set_row
from calm.physics.hull import SurfaceFloat
from calm.physics.line import GOES_ON, Bed, Record, off_bed
from calm.physics.passing import FAILURE, HANGING, LANDED, NODES, How, Z, pass_line
from calm.physics.passing import GROUNDED as LIES
from calm.physics.profile import Sea
from calm.physics.strumming import with_beat
from calm.physics.track import Course, Load
from calm.solve.closing import place
from calm.solve.problem import BELOW, HALVED, OTHER, LineProblem, SearchArrays, Unknown

STANDING, HANGING_DOWN, PULLED = range(3)
"""Legs marched from a free upper end, from a free lower end, and from an upper end that is held."""
JUMP = 1e-6
"""Share by which an unknown is moved for the slopes."""
LANDS, STAGE, GROUNDED, SHARE, MARCHES, COUNT, HUNG, FREQUENCY, LACKING, YIELD = range(10)
"""Of a leg as it was marched last: whether it may land, the stage where it did or -1, its length on
the seabed [m], its share of a float's buoyancy in use, how often it was marched; its nodes, and
those of them that hang; the frequency of its cables, what that lacks of the one that is shed [Hz],
and how that changes with it."""
OF_LEG = 10
ROUGHLY_SETTLED, SETTLED, MOST_TURNS, GENTLEST = 1e-2, 1e-9, 50, -0.3
"""What a frequency may lack, as a share of it, where segments are chosen and where they are given;
how often a leg is marched for it, and the slope at which its secants are held."""


class LegRow(NamedTuple):
    """A leg in numbers.

    Attributes
    ----------
    kind, first : how it is marched, and the first of its own unknowns
    start, end : numbers of the nodes where its march begins and ends; -1 for none
    seabed : height of the seabed below its anchor; -inf where it has none [m]
    deeper_east, deeper_north : as of `Water`, below the leg
    longest : segment at an angle step of 1° [m]
    stands : length of a float that shows how much of it is out of the water [m]
    highest : how high it may come [m]
    rides : as in `Limits`
    sheds : Strouhal number over diameter at its end, where vortices set the frequency of a leg that
        strums [1/m]; 0 of one that does not
    past_east, past_north, past_up : current there [m/s]
    stages, landing, cables, surfacing, rows, pieces : how many there are of each, see `Course`
    """

    kind: int
    first: int
    start: int
    end: int
    seabed: float
    deeper_east: float
    deeper_north: float
    longest: float
    stands: float
    highest: float
    rides: int
    sheds: float
    past_east: float
    past_north: float
    past_up: float
    stages: int
    landing: int
    cables: int
    surfacing: int
    rows: int
    pieces: int


class NetProblem(NamedTuple):
    """A net to be closed.

    Attributes
    ----------
    lines : the legs in one: what is of them has a row for each, as long as the longest needs
    held : (·, 6) places of the ends of each leg that are held, where its march begins and ends [m]
    state : numbers of each leg: `LANDS` and those after it
    passed : (·, 6) way east and north, height, and force, where each came out
    first, last, ends : node of each piece's ends; place and tension there
    found, kept, slopes, way : what is left, by shares of `rows`, now and before, its slopes by
        shares of `scale`, and the step that they ask for
    trial, paper, order : room to find it
    errors : of depths [m] and tensions [N]
    nodes_at : first unknown of the nodes
    length, force : of the longest leg [m]; a typical one [N]
    span : what errors of depths are measured by [m]
    """

    legs: Sequence[LegRow]
    lines: Any
    held: Sequence[Sequence[float]]
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
    nodes_at: int
    length: float
    force: float
    span: float


class Marching(NamedTuple):
    """Tell how all legs are marched: in which water, at which angle step, on which cuts, given or
    chosen now, and where they are recorded.
    """

    sea: Sea
    step: float
    cuts: int
    given: bool
    record: int


def leg_of(net: NetProblem, sea: Sea, i: int) -> LineProblem:
    """A leg as a line."""
    leg, lines, own = net.legs[i], net.lines, net.lines.afloat[i]
    course, work = lines.course, lines.work
    course = Course(
        course.stages[i][: leg.stages], course.loads[i], course.cables[i][: leg.cables],
        course.knots[i], with_beat(course.vibration, net.state[i][FREQUENCY]), leg.landing,
    )  # fmt: skip
    afloat = SurfaceFloat(
        own.form, own.height, own.area, own.weight, own.lift, own.surface_drag, own.wind_east,
        own.wind_north, own.wind_area, own.wind_cd,
    )  # fmt: skip
    work = SearchArrays(
        work.left[i], work.chosen[i], work.halved[i], work.counts[i], work.records[i],
        work.shares[i], work.samples[i], work.even[i], work.elements[i], work.found[i],
    )  # fmt: skip
    return LineProblem(
        course, sea, lines.loads[i], net.first[i], lines.surfacing[i][: leg.surfacing], afloat,
        lines.hull[i][: leg.rows], lines.limits, lines.starts[i], work,
    )  # fmt: skip


def bed_of(net: NetProblem, i: int) -> Bed:
    """The seabed below a leg."""
    leg, bed = net.legs[i], net.lines.limits.bed
    return Bed(leg.deeper_east, leg.deeper_north, bed.friction, bed.excess)


def above_bed(net: NetProblem, i: int, x: Sequence[float], record: Record, n: int) -> float:
    """Height of a node of a leg above the plane of the seabed through its anchor [m]; of one
    without, through the origin."""
    end, level = int(net.state[i][COUNT]) - 1, net.legs[i].seabed
    east, north = record[0][n] - record[0][end], record[1][n] - record[1][end]
    if level == -inf:
        level, place = -net.lines.limits.depth, place_of(net, i, x, 1)
        east, north = east + place[0], north + place[1]
    return off_bed(bed_of(net, i), east, north, record[2][n] - level)


def place_of(net: NetProblem, i: int, x: Sequence[float], end: int) -> tuple[float, float, float]:
    """Return where the march of a leg is to begin (0) or to end (1) [m]."""
    leg, held = net.legs[i], net.held[i]
    node = leg.end if end else leg.start
    if node >= 0:
        k = net.nodes_at + 3 * node
        return x[k], x[k + 1], x[k + 2]
    lies = end == 1 and net.state[i][LANDS] > 0.0
    return held[3 * end], held[3 * end + 1], leg.seabed if lies else held[3 * end + 2]


def begun(net: NetProblem, problem: LineProblem, i: int, x: Sequence[float]) -> tuple[float, float]:
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
        _, _, z = place_of(net, i, x, 0)
        return -z, 0.0
    sought, value = BELOW, x[leg.first]
    if leg.kind == STANDING and value < 0.0 and leg.surfacing > 0:
        sought, value = 0, 1.0 + value / leg.stands
        state[SHARE] = value
    return place(problem, Unknown(0.0, sought, leg.rides > 0, False, 0), value)


def march_leg(net: NetProblem, i: int, x: Sequence[float], how: Marching) -> int:
    """March a leg from what is unknown of it; how that ended, see `calm.physics.line`.

    One that strums until it does at the frequency of the vortices at its end. That falls as the
    frequency assumed rises, since more drag lifts the line: it is found by secants, and by halving
    a bracket where these do not lead on.
    """
    leg, state = net.legs[i], net.state[i]
    failure = march_once(net, i, x, how)
    low, high, before, lacked = -inf, inf, 0.0, inf
    settled = SETTLED if how.given else ROUGHLY_SETTLED
    for _ in range(MOST_TURNS if leg.sheds > 0.0 else 0):
        frequency = state[FREQUENCY]
        lacking = shed_by(leg, net.passed[i]) - frequency
        state[LACKING] = lacking
        if failure != GOES_ON or abs(lacking) <= settled * frequency:
            break
        if lacked < inf and frequency != before:
            state[YIELD] = (lacking - lacked) / (frequency - before)
        if lacking > 0.0:
            low = frequency
        else:
            high = frequency
        following = frequency - lacking / min(state[YIELD], GENTLEST)
        if high - low < inf and not (
            abs(lacking) < 0.5 * abs(lacked) and low < following < high
        ):
            following = 0.5 * (low + high)
        before, lacked, state[FREQUENCY] = frequency, lacking, following
        failure = march_once(net, i, x, how)
    return failure


def march_once(net: NetProblem, i: int, x: Sequence[float], how: Marching) -> int:
    """March a leg, at the frequency at which it was marched last where it strums."""
    leg, state, problem = net.legs[i], net.state[i], leg_of(net, how.sea, i)
    course, work = problem.course, problem.work
    depth, out = begun(net, problem, i, x)
    cuts = work.halved if how.cuts == HALVED else work.chosen
    record, left = work.records[how.record], work.left
    reach = degrees(how.step) * leg.longest
    lands = state[LANDS] > 0.0
    near, bed = problem.limits.near, bed_of(net, i)
    asked = How(how.step, reach, near, leg.stages, lands, bed, how.given, True)
    pass_line(course, how.sea, asked, depth, out, cuts, work.counts[how.cuts], record, left)
    state[MARCHES] += 1.0
    if left[FAILURE] != GOES_ON:
        return int(left[FAILURE])
    state[STAGE], state[HUNG] = left[LANDED], left[HANGING]
    state[COUNT], state[GROUNDED] = left[NODES], left[LIES]
    passed, n = net.passed[i], int(left[NODES]) - 1
    passed[0], passed[1] = record[0][n] - record[0][0], record[1][n] - record[1][0]
    passed[2] = left[Z]
    passed[3], passed[4], passed[5] = record[3][n], record[4][n], record[5][n]
    return GOES_ON


def shed_by(leg: LegRow, passed: Sequence[float]) -> float:
    """The frequency F = St |V| sin φ/D of the vortices at the end of a leg [Hz].

    φ is the angle between the current and the force there, see `calm.physics.strumming`.
    """
    _, _, _, fx, fy, fz = passed
    u, v, w = leg.past_east, leg.past_north, leg.past_up
    cx, cy, cz = v * fz - w * fy, w * fx - u * fz, u * fy - v * fx
    tension = sqrt(fx * fx + fy * fy + fz * fz)
    if tension == 0.0:
        return 0.0
    return leg.sheds * sqrt(cx * cx + cy * cy + cz * cz) / tension


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
        east, north, up = place_of(net, i, x, 1)
        if leg.kind == PULLED:
            x0, y0, _ = place_of(net, i, x, 0)
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
    own = 3 if leg.kind == PULLED else 1
    free = own + (1 if leg.kind == PULLED and leg.start >= 0 else 0)
    moved = Marching(how.sea, how.step, how.cuts, True, OTHER)
    for m in range(free):
        k = at + m if m < own else nodes + 3 * leg.start + 2
        add_passed(net, i, net.passed[i], -1.0 / JUMP, k)
    for m in range(free):
        k = at + m if m < own else nodes + 3 * leg.start + 2
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
