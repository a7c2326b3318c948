"""March of an anchored leg of a net, upwards from its touchdown or anchor.

The unknowns are the components of the force on the leg's lower end. The vertical component is the
weight on the seabed, or minus the uplift on the anchor. A leg without horizontal pull is slack: its
part on the seabed is longer than the distance to the anchor.
"""

from collections.abc import Sequence
from math import degrees, inf, sqrt

from calm.physics.compiled import set_row, within
from calm.physics.line import (
    ENDS,
    GOES_ON,
    HALVES,
    NO_BALANCE,
    NO_ROOM,
    NO_SEGMENT,
    RUNS_OFF,
    SEGMENT,
    Record,
    State,
    along_bed,
    off_bed,
    write_element,
)
from calm.physics.passing import (
    FAILURE,
    FX,
    FY,
    FZ,
    NODES,
    USED,
    MarchSettings,
    Z,
    cut_evenly,
    pass_line,
)
from calm.physics.profile import Sea, interval_at
from calm.physics.rod_axis import rod_axis
from calm.physics.seabed import lay_line
from calm.physics.track import CABLE, ROD, CableStretch, Course, Load, Stage
from calm.solve.leg_numbers import (
    COUNT,
    EAST,
    GROUNDED,
    HANGS,
    LIES,
    MARCHES,
    NORTH,
    SLACK,
    STAGE,
    SUSPENDED,
    TO_EAST,
    TO_NORTH,
    TO_UP,
    Marching,
    NetProblem,
    bed_of,
    end_height,
    leg_of,
    place_of,
)
from calm.solve.problem import HALVED, SearchArrays

NO_PULL = 1e-9
"""Largest pull at a touchdown, as a fraction of the leg's force scale, that is treated as zero."""


def course_from_below(course: Course) -> Course:
    """Return the course of a leg in reverse order, for an upward march.

    The new course begins with a point load, which stands for the force on the lower end of the
    leg. There is no point load at the upper end. Pieces keep their numbers.
    """
    stages, loads = [course.stages[0]], [course.loads[0]]
    cables: list[CableStretch] = []
    for stage in reversed(course.stages[1:]):
        if stage.kind == CABLE:
            stages.append(stage._replace(first=len(cables)))
            cables.append(course.cables[stage.first])
            continue
        stages.append(stage._replace(first=len(loads)))
        (own, *others) = course.loads[stage.first : stage.first + stage.size]
        for load in (own, *reversed(others)):
            at, lever = stage.length - load.at, 1.0 - load.lever
            loads.append(load._replace(at=at, lever=lever))
    return Course(stages, loads, cables, course.knots, course.vibration, 0)


def weight_of(course: Course, stage: Stage, excess: float) -> float:
    """Return the weight in water at the seabed [N] of a stage (a cable or a rigid body).

    Parameters
    ----------
    excess : specific weight of the water at the seabed, above the reference value [N/m³]
    """
    if stage.kind == CABLE:
        cable = course.cables[stage.first]
        return -(cable.buoyancy + excess * cable.volume) * cable.length
    weight = 0.0
    for k in range(stage.first, stage.first + stage.size):
        weight -= course.loads[k].buoyancy + excess * course.loads[k].volume
    return weight


def pull_of(up: float, east: float, north: float) -> Load:
    """Return a load that exerts the given force [N] and has no drag."""
    return Load(0, -1, 0.0, 0.5, 0.0, up, 0.0, 0.0, 0.0, 0, 0.0, east, north, 0.0, 0.0)


def of_length(cable: CableStretch, length: float) -> CableStretch:
    """Return a copy of a cable with another unstretched length [m]."""
    return CableStretch(
        cable.piece, length, cable.buoyancy, cable.volume, cable.normal_drag,
        cable.tangential_drag, cable.compliance, cable.thinning, cable.friction,
        cable.first_knot, cable.end_knot, cable.diameter,
    )  # fmt: skip


def march_up(net: NetProblem, i: int, x: Sequence[float], how: Marching) -> int:
    """March an anchored leg up from its touchdown, or else from its anchor; return the outcome.

    The record of the shape begins at the lower end, unlike other records.
    """
    leg, state, problem, bed = net.legs[i], net.state[i], leg_of(net, how.sea, i), bed_of(net, i)
    stages, loads, cables = net.up.stages[i], net.up.loads[i], net.up.cables[i][: leg.cables]
    knots, vibration = net.up.knots[i], problem.course.vibration
    work, at = problem.work, leg.first
    east, north, borne = x[at], x[at + 1], x[at + 2]
    if east * east + north * north <= NO_PULL * NO_PULL * net.scale[at] * net.scale[at]:
        east = north = 0.0
    # the pull at a touchdown is parallel to the seabed
    along = -bed.east * east - bed.north * north
    # the highest stage that may lie on the seabed, counted from below
    lowest = leg.stages - max(leg.landing, 1)
    lies = borne > 0.0 and lowest > 0
    height = x[at + 3] if leg.own > 3 else end_height(leg, lies, -borne)
    level = interval_at(how.sea.levels, -height, 0)
    up, stage, first, hanging, whole = borne, 1, 1, 0.0, -1.0
    if lies:
        weight, left = 0.0, borne
        while True:
            if stage > lowest:
                return RUNS_OFF
            here = stages[stage]
            weight = weight_of(Course(stages, loads, cables, knots, vibration, 0), here, bed.excess)
            if left < weight:
                break
            left -= weight
            stage += 1
        first = stage
        if here.kind == CABLE:
            up, whole = 0.0, cables[here.first].length
            hanging = whole * (1.0 - left / weight)
            set_row(cables, here.first, of_length(cables[here.first], hanging))
        else:
            up, hanging = left, inf  # the seabed supports its lower end
            if here.kind == ROD:
                below: State = (0.0, 0.0, height, east, north, along + up, 1.0, level)
                tx, ty, tz = rod_axis(here, loads, how.sea, below, problem.limits.near)
                if tz == NO_BALANCE or off_bed(bed, tx, ty, tz) <= 0.0:  # it tips over
                    first, up, hanging = stage + 1, left - weight, 0.0
        up += along
    set_row(loads, 0, pull_of(up, east, north))
    kept = stages[first - 1]
    set_row(stages, first - 1, Stage(ROD, 0, 1, 0.0))
    course = Course(stages[first - 1 : leg.stages], loads, cables, knots, vibration, 0)
    failure = march_suspended(net, i, course, how, work, -height)
    set_row(stages, first - 1, kept)
    if whole >= 0.0:
        set_row(cables, stages[stage].first, of_length(cables[stages[stage].first], whole))
    if failure != GOES_ON:
        return failure
    record, left_by, passed = work.records[how.record], work.left, net.passed[i]
    nodes = int(left_by[NODES])
    state[EAST], state[NORTH] = record[0][nodes - 1], record[1][nodes - 1]
    state[STAGE], state[SUSPENDED], state[COUNT], state[GROUNDED], state[LIES] = (
        -1,
        nodes,
        nodes,
        0,
        0,
    )
    passed[2] = left_by[Z]
    passed[3], passed[4], passed[5] = left_by[FX], left_by[FY], left_by[FZ]
    if lies:
        east, north, up = along_bed(bed, east, north, up)
        state[STAGE], state[HANGS] = leg.stages - stage, hanging
    state[TO_EAST], state[TO_NORTH], state[TO_UP] = east, north, up
    if lies:
        end, state[COUNT], state[GROUNDED] = lay(net, i, how.sea, height, how.record, False)
        down = end[2] - height
        state[LIES] = sqrt(end[0] * end[0] + end[1] * end[1] + down * down)
    write_anchor_miss(net, i, x, how.loose)
    return GOES_ON


def lay(
    net: NetProblem, i: int, sea: Sea, height: float, record: int, recording: bool
) -> tuple[State, int, float]:
    """Lay the part of an anchored leg beyond its touchdown on the seabed (see `lay_line`).

    The leg's work arrays must still hold its last `march_up`.

    Parameters
    ----------
    height : height of the touchdown [m]
    """
    state, course = net.state[i], leg_of(net, sea, i).course
    east, north, up, level = state[TO_EAST], state[TO_NORTH], state[TO_UP], 0
    foot: State = (0.0, 0.0, height, -east, -north, -up, -1.0, level)
    return lay_line(
        course, bed_of(net, i), foot, int(state[STAGE]), state[HANGS],
        net.lines.work.records[i][record], recording, int(state[SUSPENDED]),
    )  # fmt: skip


def record_down(net: NetProblem, i: int, x: Sequence[float], how: Marching) -> None:
    """Reverse the record of an anchored leg, so that the record runs down to the anchor."""
    state, record, out = net.state[i], net.lines.work.records[i][how.record], net.passed[i]
    nodes, height = int(state[SUSPENDED]), net.lines.work.records[i][how.record][2][0]
    set_row(net.lines.course.loads[i], 0, pull_of(-out[5], -out[3], -out[4]))
    turn_round(record, nodes)
    if state[STAGE] < 0.0:
        return
    if state[HANGS] > 0.0:  # otherwise the seabed carries part of the load at this node
        record[3][nodes - 1], record[4][nodes - 1] = -state[TO_EAST], -state[TO_NORTH]
        record[5][nodes - 1] = -state[TO_UP]
    lay(net, i, how.sea, height, how.record, True)
    if state[SLACK] > 0.0:
        lay_loosely(net, i, x, record)


@within
def march_suspended(
    net: NetProblem, i: int, course: Course, how: Marching, work: SearchArrays, depth: float
) -> int:
    """March the suspended part of an anchored leg, and return the outcome.

    The segment list covers whole cables, counted from below.
    """
    leg, cuts = net.legs[i], net.cuts
    of_step, counts = work.chosen, work.counts
    reach, near = degrees(how.step) * leg.longest, net.lines.limits.near
    skipped = leg.cables
    for stage in range(len(course.stages) - 1, -1, -1):
        if course.stages[stage].kind == CABLE:
            skipped = course.stages[stage].first
    used = 0
    for k in range(skipped):
        if how.given:
            used += counts[k]
            continue
        counts[k] = 0
        used = cut_evenly(of_step, counts, k, used, course.cables[k].length, reach)
    if how.given:
        fill, read = 0, used
        for k in range(skipped, leg.cables):
            whole = 0.0
            for m in range(read, read + counts[k]):
                whole += of_step[m]
            length = course.cables[k].length
            # segments scaled to the suspended length make the march a smooth function of it
            longer = length / whole if whole > 0.0 else 0.0
            each = 0.0 if whole > 0.0 else length / max(counts[k], 1)
            for m in range(read, read + counts[k]):
                cuts[fill] = longer * of_step[m] + each
                fill += 1
            read += counts[k]
    settings = MarchSettings(
        how.step,
        reach,
        near,
        len(course.stages),
        False,
        bed_of(net, i),
        how.given,
        how.exact,
        how.cuts == HALVED,
        True,
    )
    record, left = work.records[how.record], work.left
    pass_line(course, how.sea, settings, depth, 0.0, cuts, counts, record, left)
    net.state[i][MARCHES] += 1.0
    if left[FAILURE] != GOES_ON:
        return int(left[FAILURE])
    if not how.given:
        chosen = int(left[USED])
        if used + chosen > len(of_step):
            return NO_ROOM
        for m in range(chosen):
            of_step[used + m] = cuts[m]
    return GOES_ON


def turn_round(record: Record, nodes: int) -> None:
    """Reverse the record of an upward march, so that the record begins at the upper end."""
    for k in range(6):
        a, b = 1, nodes - 1
        column = record[k]
        while a < b:
            column[a], column[b] = column[b], column[a]
            a, b = a + 1, b - 1
        if k >= 3:
            for n in range(1, nodes):
                column[n] = -column[n]
        column[0] = column[1] if k < 3 else 0.0
    for k in range(6, SEGMENT + 1):
        a, b = 2, nodes - 1
        column = record[k]
        while a < b:
            column[a], column[b] = column[b], column[a]
            a, b = a + 1, b - 1
    # a segment code belongs to the lower end of an element, which the reversal has changed
    ends = record[SEGMENT]
    for n in range(2, nodes):
        if ends[n] != NO_SEGMENT:
            ends[n] = ends[n + 1] if n + 1 < nodes and ends[n + 1] >= HALVES else ENDS
    write_element(record, 1, 0, -1, 0.0, 0.0)


@within
def write_anchor_miss(net: NetProblem, i: int, x: Sequence[float], loose: float) -> None:
    """Write the residuals of an anchored leg to `net.passed`.

    Results 0 and 1 are the horizontal position error at the anchor. Let d be the vector from
    touchdown to anchor, r the length on the seabed, h the horizontal pull, and ρ > 0 any factor.
    The error is zero if the projection of d + ρh on the disc of radius r is d (contact condition of
    Alart and Curnier). Such a leg is either taut (|d| = r, d parallel to h) or slack (|d| < r,
    h = 0).

    Result 6 is the height error of the lower end of the leg. `loose` is as in `Marching`.
    """
    leg, state, passed, bed = net.legs[i], net.state[i], net.passed[i], bed_of(net, i)
    at, reach = leg.first, state[LIES]
    to_east, to_north, _ = place_of(net, i, x, 1)
    from_east, from_north, _ = place_of(net, i, x, 0)
    east = to_east - from_east + state[EAST]
    north = to_north - from_north + state[NORTH]
    share, e, n = 0.0, east, north
    if reach > 0.0:
        distance, rise = sqrt(east * east + north * north), bed.east * east + bed.north * north
        if distance > 0.0:
            reach *= distance / sqrt(distance * distance + rise * rise)
        per_force = net.length / net.scale[at]
        trace = loose * net.scale[at] / reach
        e += per_force * (state[TO_EAST] - trace * east)
        n += per_force * (state[TO_NORTH] - trace * north)
        share = min(reach / max(sqrt(e * e + n * n), 1e-300), 1.0)
    passed[0], passed[1] = share * e - east, share * n - north
    state[SLACK] = reach - sqrt(east * east + north * north) if share == 1.0 else 0.0
    passed[6] = 0.0
    if leg.own > 3:
        lies = state[STAGE] >= 0.0
        passed[6] = x[at + 3] - end_height(leg, lies, -x[at + 2])
        if lies:
            passed[6] -= bed.east * east + bed.north * north


def lay_loosely(net: NetProblem, i: int, x: Sequence[float], record: Record) -> None:
    """Draw the seabed part of a slack leg as a straight line, shortened to end at the anchor."""
    state, suspended, count = net.state[i], int(net.state[i][SUSPENDED]), int(net.state[i][COUNT])
    foot, reach = suspended - 1, max(net.state[i][LIES], 1e-300)
    to_east, to_north, _ = place_of(net, i, x, 1)
    from_east, from_north, _ = place_of(net, i, x, 0)
    east, north = to_east - from_east + state[EAST], to_north - from_north + state[NORTH]
    down = net.legs[i].seabed - record[2][foot]
    for n in range(suspended, count):
        dx, dy = record[0][n] - record[0][foot], record[1][n] - record[1][foot]
        dz = record[2][n] - record[2][foot]
        share = sqrt(dx * dx + dy * dy + dz * dz) / reach
        record[0][n] = record[0][foot] + share * east
        record[1][n] = record[1][foot] + share * north
        record[2][n] = record[2][foot] + share * down
