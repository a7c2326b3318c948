"""Residual and Jacobian of a net of legs, as functions that can be compiled.

The unknowns are depths of free ends, pulls on other ends, and positions of nodes. The residual
(`found`) holds the errors of the legs' end positions, and the sum of the pulls at each node. The
Jacobian (`slopes`) comes from finite differences.
"""

from collections.abc import MutableSequence, Sequence
from math import degrees, inf, sqrt

from calm.physics.compiled import set_row
from calm.physics.line import GOES_ON
from calm.physics.passing import FAILURE, HANGING, LANDED, NODES, MarchSettings, Z, pass_line
from calm.physics.passing import GROUNDED as LIES
from calm.solve.closing import place
from calm.solve.leg_from_below import march_up, pull_of, write_anchor_miss
from calm.solve.leg_numbers import (
    ANCHORED,
    COUNT,
    FREQUENCY,
    GROUNDED,
    LACKING,
    MARCHES,
    OUT,
    PULLED,
    SHARE,
    STAGE,
    STANDING,
    SUSPENDED,
    YIELD,
    LegRow,
    Marching,
    NetProblem,
    bed_of,
    end_height,
    leg_of,
    place_of,
)
from calm.solve.problem import BELOW, HALVED, OTHER, LineProblem, Unknown

SLOPE_STEP = 1e-6
"""Relative change of an unknown for the finite differences of the slopes."""
LEAST_PULL = 1e-3
"""Smallest scale of the unknown forces of a leg, as a fraction of the weight of the leg."""
ROUGHLY_SETTLED, SETTLED, MOST_TURNS, GENTLEST = 1e-2, 1e-9, 50, -0.3
"""Parameters of the search for the strumming frequency of a leg.

- ROUGHLY_SETTLED: allowed relative error of the frequency while segments are chosen
- SETTLED: allowed relative error of the frequency on fixed segments
- MOST_TURNS: largest number of iterations
- GENTLEST: flattest slope of the secants
"""


def load_leg(
    net: NetProblem, problem: LineProblem, i: int, x: Sequence[float]
) -> tuple[float, float]:
    """Set the loads of a leg for given unknowns.

    Returns
    -------
    Depth at which the march of the leg starts [m], and length of the part above the surface [m].
    """
    leg, state = net.legs[i], net.state[i]
    if leg.kind == PULLED:
        east, north, up = x[leg.first], x[leg.first + 1], x[leg.first + 2]
        set_row(problem.course.loads, 0, pull_of(up, east, north))
        _, _, z = place_of(net, i, x, 0)
        return -z, 0.0
    sought, value = BELOW, x[leg.first]
    if leg.kind == STANDING and value < 0.0 and leg.surfacing > 0:
        sought, value = 0, 1.0 + value / leg.surface_range
        state[SHARE] = value
    return place(problem, Unknown(0.0, sought, leg.rides > 0, False, 0), value)


def march_leg(net: NetProblem, i: int, x: Sequence[float], how: Marching) -> int:
    """March a leg for given unknowns, and return an outcome defined in `calm.physics.line`.

    For a strumming leg, the march is repeated with other strumming frequencies, until the frequency
    equals the vortex shedding frequency at the end of the march.
    """
    leg, state = net.legs[i], net.state[i]
    failure = march_once(net, i, x, how)
    low, high, before, lacked = -inf, inf, 0.0, inf
    settled = SETTLED if how.given else ROUGHLY_SETTLED
    # the shedding frequency falls as the assumed frequency rises, since more drag raises the line
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
        if high - low < inf and not (abs(lacking) < 0.5 * abs(lacked) and low < following < high):
            following = 0.5 * (low + high)
        before, lacked, state[FREQUENCY] = frequency, lacking, following
        failure = march_once(net, i, x, how)
    return failure


def march_once(net: NetProblem, i: int, x: Sequence[float], how: Marching) -> int:
    """March a leg once, at the present strumming frequency."""
    net.state[i][SHARE] = 1.0
    if net.legs[i].kind == ANCHORED:
        return march_up(net, i, x, how)
    return march_down(net, i, x, how)


def march_down(net: NetProblem, i: int, x: Sequence[float], how: Marching) -> int:
    """March a leg from its upper end, or from its lower end if this end is free."""
    leg, state, problem = net.legs[i], net.state[i], leg_of(net, how.sea, i)
    course, work = problem.course, problem.work
    depth, out = load_leg(net, problem, i, x)
    cuts, counts = work.chosen, work.counts
    record, left = work.records[how.record], work.left
    reach = degrees(how.step) * leg.longest
    lands = leg.kind == STANDING and leg.seabed > -inf
    near, bed = problem.limits.near, bed_of(net, i)
    halves = how.cuts == HALVED
    settings = MarchSettings(
        how.step, reach, near, leg.stages, lands, bed, how.given, how.exact, halves, True
    )
    pass_line(course, how.sea, settings, depth, out, cuts, counts, record, left)
    state[MARCHES] += 1.0
    if left[FAILURE] != GOES_ON:
        return int(left[FAILURE])
    state[STAGE], state[SUSPENDED] = left[LANDED], left[HANGING]
    state[COUNT], state[GROUNDED] = left[NODES], left[LIES]
    passed, n = net.passed[i], int(left[NODES]) - 1
    passed[0], passed[1] = record[0][n] - record[0][0], record[1][n] - record[1][0]
    passed[2], passed[6] = left[Z], 0.0
    passed[3], passed[4], passed[5] = record[3][n], record[4][n], record[5][n]
    if lands:  # the height of the end contributes to the miss
        passed[2] -= end_height(leg, left[LANDED] >= 0.0, passed[5])
    return GOES_ON


def shed_by(leg: LegRow, passed: Sequence[float]) -> float:
    """Return the vortex shedding frequency F = St |V| sin φ/D at the end of a leg [Hz].

    φ is the angle between the current and the force at this end, see `calm.physics.strumming`.
    """
    fx, fy, fz = passed[3], passed[4], passed[5]
    u, v, w = leg.past_east, leg.past_north, leg.past_up
    cx, cy, cz = v * fz - w * fy, w * fx - u * fz, u * fy - v * fx
    tension = sqrt(fx * fx + fy * fy + fz * fz)
    if tension == 0.0:
        return 0.0
    return leg.sheds * sqrt(cx * cx + cy * cy + cz * cz) / tension


def row_of(net: NetProblem, i: int, k: int) -> int:
    """Return the row of the residual that contains result k of the march of leg i, or -1.

    The results are listed at `calm.solve.leg_numbers.OUT`. The value -1 means that no row contains
    the result.
    """
    leg = net.legs[i]
    pulled = leg.own > 1
    if k < 2:
        return leg.first + k if pulled else -1
    if k == 2:
        return leg.first + 2 if pulled else leg.first
    if k == 6:
        return leg.first + 3 if leg.own > 3 else -1
    node = leg.start if leg.kind == ANCHORED else leg.end
    return net.nodes_at + 3 * node + k - 3 if node >= 0 else -1


def add_passed(net: NetProblem, i: int, out: Sequence[float], share: float, column: int) -> None:
    """Add a multiple of the results of a leg's march to the residual or the Jacobian.

    Parameters
    ----------
    share : factor of the results
    column : column of the Jacobian; negative for the residual
    """
    for k in range(OUT):
        row = row_of(net, i, k)
        if row < 0:
            continue
        change = share * out[k] / net.rows[row]
        if column < 0:
            net.found[row] += change
        else:
            net.slopes[row][column] += change


def write_residual(net: NetProblem, x: MutableSequence[float], how: Marching, slopes: bool) -> int:
    """March all legs, write the residual to `net.found`, and return the outcome of the marches.

    If `slopes` is true, also compute the Jacobian and update the force scales.
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
        if slopes:
            take_scale(net, i, x, how.loose)
        out, at = net.passed[i], leg.first
        add_passed(net, i, out, 1.0, -1)
        start, end = place_of(net, i, x, 0), place_of(net, i, x, 1)
        if leg.kind == ANCHORED:
            net.found[at + 2] -= start[2] / net.rows[at + 2]
        elif leg.kind == PULLED:
            net.found[at] += (start[0] - end[0]) / net.rows[at]
            net.found[at + 1] += (start[1] - end[1]) / net.rows[at + 1]
            net.found[at + 2] -= end[2] / net.rows[at + 2]
            if leg.start >= 0:
                for k in range(3):
                    row = nodes + 3 * leg.start + k
                    net.found[row] -= x[at + k] / net.rows[row]
        elif leg.seabed == -inf:
            net.found[at] -= end[2] / net.rows[at]
        if slopes:
            failure = slopes_of_leg(net, i, x, how)
            if failure != GOES_ON:
                return failure
    return GOES_ON


def slopes_of_leg(net: NetProblem, i: int, x: MutableSequence[float], how: Marching) -> int:
    """Add the derivatives of the residual with respect to a leg's unknowns to the Jacobian.

    Return the outcome of the marches.
    """
    leg, nodes, at, passed = net.legs[i], net.nodes_at, net.legs[i].first, net.passed[i]
    start, end = nodes + 3 * leg.start, nodes + 3 * leg.end
    if leg.kind == ANCHORED and leg.start >= 0:
        net.slopes[at + 2][start + 2] -= net.scale[start + 2] / net.rows[at + 2]
        for k in range(2):  # the position of its upper end changes the miss, but not the march
            before = x[start + k]
            add_passed(net, i, passed, -1.0 / SLOPE_STEP, start + k)
            x[start + k] = before + SLOPE_STEP * net.scale[start + k]
            write_anchor_miss(net, i, x, how.loose)
            add_passed(net, i, passed, 1.0 / SLOPE_STEP, start + k)
            x[start + k] = before
            write_anchor_miss(net, i, x, how.loose)
    moved = Marching(how.sea, how.step, how.cuts, True, how.exact, OTHER, how.loose)
    free = leg.own + (1 if leg.kind == PULLED and leg.start >= 0 else 0)
    for m in range(free):
        k = at + m if m < leg.own else start + 2
        add_passed(net, i, passed, -1.0 / SLOPE_STEP, k)
    for m in range(free):
        k = at + m if m < leg.own else start + 2
        before = x[k]
        x[k] = before + SLOPE_STEP * net.scale[k]
        failure = march_leg(net, i, x, moved)
        x[k] = before
        if failure != GOES_ON:
            return failure
        add_passed(net, i, passed, 1.0 / SLOPE_STEP, k)
    if leg.kind == PULLED and leg.start >= 0:
        for k in range(3):
            net.slopes[start + k][at + k] -= net.scale[at + k] / net.rows[start + k]
            if k < 2:
                net.slopes[at + k][start + k] += net.scale[start + k] / net.rows[at + k]
    if leg.kind != ANCHORED and leg.end >= 0:
        for k in range(0 if leg.kind == PULLED else 2, 3):
            row = at + k if leg.kind == PULLED else at
            net.slopes[row][end + k] -= net.scale[end + k] / net.rows[row]
    return GOES_ON


def take_scale(net: NetProblem, i: int, x: Sequence[float], loose: float) -> None:
    """Scale the unknown forces of a leg by the pull in its last march.

    No scale exceeds the weight of the heaviest leg.
    """
    # Steps of the finite differences that suit large pulls would be too large for a slack leg.
    # A scale above the heaviest weight would let legs that are too short to meet be stretched.
    leg, out = net.legs[i], net.passed[i]
    if leg.own == 1:
        return
    pull = sqrt(out[3] * out[3] + out[4] * out[4] + out[5] * out[5])
    if leg.kind == PULLED:
        east, north, up = x[leg.first], x[leg.first + 1], x[leg.first + 2]
        pull = max(pull, sqrt(east * east + north * north + up * up))
    for k in range(3):
        net.scale[leg.first + k] = min(max(pull, LEAST_PULL * leg.weight), net.force)
    if leg.kind == ANCHORED:
        write_anchor_miss(net, i, x, loose)
