"""Integration (march) down a line from its free end, stage by stage, as functions to compile.

A march starts at a given position of the free end, without force from above, and returns position
and force at the other end.

Cables and chains are divided into straight segments. The march chooses segments that rotate by
about the angle step, are short against the water depth, and end at levels of the water profile.
Given segments keep their lengths, which makes the end of the line a smooth function of the start.
"""

from collections.abc import MutableSequence
from math import isfinite
from typing import NamedTuple

from calm.physics.cable import pass_part, segment_length, touchdown
from calm.physics.line import (
    ENDLESS,
    ENDS,
    GOES_ON,
    HALVES,
    NO_BALANCE,
    NO_ROOM,
    ROD_UNBALANCED,
    RUNS_OFF,
    SEGMENT,
    SEGMENT_UNBALANCED,
    SPLITS,
    Bed,
    Record,
    State,
    along_bed,
    off_bed,
    write_element,
    write_node,
)
from calm.physics.profile import LEAST_PART, Sea, interval_at
from calm.physics.rod import floating_depth, pass_clamp, pass_rod
from calm.physics.seabed import lay_line
from calm.physics.strumming import with_beat
from calm.physics.track import CABLE, ROD, Course

MOST_SEGMENTS = 50_000

Z, FX, FY, FZ, USED, NODES, LANDED, HANGING, GROUNDED, FAILURE = range(10)
"""Indices into the results of a march.

- Z: height of the end [m]
- FX, FY, FZ: force above the end [N]
- USED, NODES: number of segments used, and number of nodes passed
- LANDED: stage of the touchdown, or -1
- HANGING: number of nodes off the seabed
- GROUNDED: unstretched length on the seabed [m]
- FAILURE: reason why the march stopped, see `calm.physics.line`
"""
LEFT = 10

SHORT = 1e-6
"""Length of a very short segment, as a fraction of the longest allowed segment.

The load on a very short segment is not used as an estimate for the next segment.
"""
EXACT, ROUGH = 1e-12, 1e-3
"""Values of the parameter `share` of `counts_across`.

EXACT is used for marches at full precision, and ROUGH for all other marches.
"""
ROUNDING = 1e-12
"""Rounding error of the sum of the segment lengths, as a fraction of the cable length."""


class MarchSettings(NamedTuple):
    """Settings of a march.

    Attributes
    ----------
    angle_step : largest rotation of a segment [rad]
    reach : largest length of a segment [m]
    near : allowed error of the depth at which the water is sampled [m]; 0 for full precision
    stages : number of stages to march
    lands : whether a line may touch down. The touchdown is below the last buoyant piece, at the
        point without a force normal to the seabed
    bed : the seabed
    given : whether the segments are given, instead of chosen by the march
    exact : whether segments are split at every level of the water profile, even without appreciable
        effect
    halves : whether each part of a segment is integrated in two halves
    recording : whether every node and element is recorded
    """

    angle_step: float
    reach: float
    near: float
    stages: int
    lands: bool
    bed: Bed
    given: bool
    exact: bool
    halves: bool
    recording: bool


def pass_line(
    course: Course,
    sea: Sea,
    how: MarchSettings,
    depth: float,
    out: float,
    cuts: MutableSequence[float],
    counts: MutableSequence[int],
    record: Record,
    left: MutableSequence[float],
) -> None:
    """Integrate down a line from a free end at a given depth [m].

    Parameters
    ----------
    out : length of line above the surface [m]; if not 0, the depth is computed from `out`
    cuts, counts : unstretched lengths of the segments [m], and number of segments in each cable;
        input if the segments are given, otherwise output
    record : output of nodes and elements
    left : output of results, with the indices `Z` to `FAILURE`
    """
    if out > 0.0:
        depth = floating_depth(course.stages[0], course.loads, sea, out, how.near)
    level = interval_at(sea.levels, depth, 0)
    state: State = (0.0, 0.0, -depth, 0.0, 0.0, 0.0, -1.0, level)
    if how.recording:
        write_node(record, 0, state)
    used, nodes, failure = 0, 1, GOES_ON
    landed, hanging = -1, -1.0
    for i in range(how.stages):
        stage = course.stages[i]
        may_land = how.lands and i >= course.landing
        if stage.kind == CABLE:
            state, hanging, used, nodes, failure = pass_cable(
                course, stage.first, sea, how, state, may_land, cuts, counts, used, record, nodes
            )
        elif stage.kind == ROD:
            state, hanging, nodes = pass_rod(
                stage, course.loads, sea, state, may_land, how.bed, how.near, record,
                how.recording, nodes,
            )  # fmt: skip
            failure = ROD_UNBALANCED if state[6] == NO_BALANCE else GOES_ON
        else:
            state, hanging, nodes = pass_clamp(
                course.loads[stage.first], sea, state, may_land, how.bed, record, how.recording,
                nodes,
            )  # fmt: skip
        x, y, z, fx, fy, fz, _, _ = state
        if failure == GOES_ON and not isfinite(x + y + z + fx + fy + fz):
            failure = RUNS_OFF
        if failure != GOES_ON:
            break
        if hanging >= 0.0:
            landed = i
            break
    if landed >= 0 and not how.given:
        for i in range(landed + 1, how.stages):
            stage = course.stages[i]
            if stage.kind == CABLE:
                counts[stage.first] = 0
                used = cut_evenly(cuts, counts, stage.first, used, stage.length, how.reach)
    if used > len(cuts):
        failure = NO_ROOM
    left[HANGING], left[GROUNDED] = nodes, 0.0
    if landed >= 0 and failure == GOES_ON:
        state, nodes, left[GROUNDED] = lay_line(
            course, how.bed, state, landed, hanging, record, how.recording, nodes
        )
    _, _, z, fx, fy, fz, _, _ = state
    left[Z], left[FX], left[FY], left[FZ] = z, fx, fy, fz
    left[USED], left[NODES], left[LANDED], left[FAILURE] = used, nodes, landed, failure


def pass_cable(
    course: Course,
    place: int,
    sea: Sea,
    how: MarchSettings,
    state: State,
    lands: bool,
    cuts: MutableSequence[float],
    counts: MutableSequence[int],
    used: int,
    record: Record,
    nodes: int,
) -> tuple[State, float, int, int, int]:
    """Integrate along the cable with index `place` in the course.

    Returns
    -------
    - the state at the end of the cable;
    - the unstretched length above the touchdown [m], or -1 without touchdown;
    - the numbers of segments and of nodes so far;
    - the outcome.
    """
    cable, knots, vibration = course.cables[place], course.knots, course.vibration
    if vibration.beat != 0.0:
        vibration = with_beat(vibration, vibration.beat * cable.diameter)
    first, done, hanging = used, 0.0, -1.0
    near, halves, expected = how.near, how.halves, (0.0, 0.0, 0.0)
    share = EXACT if how.exact and near == 0.0 else ROUGH
    others = 3 * len(course.loads) + 2 * len(course.stages) + 1
    whole = (1.0 - ROUNDING) * cable.length
    while used - first < counts[place] if how.given else done < whole or used == first:
        if used == len(cuts):
            return state, hanging, used, nodes, NO_ROOM
        cut = cuts[used]
        if not how.given:
            left = cable.length - done
            cut = segment_length(
                cable, knots, vibration, sea, state, how.angle_step, how.reach, share
            )
            cut = min(left, cut)
            if left - cut < LEAST_PART * cut:
                cut = left
        used += 1
        left, long, uncut = cut, 0.0, True
        while hanging < 0.0:
            passed = pass_part(
                cable, knots, vibration, sea, state, left, halves, near, expected, share
            )
            part = passed[0]
            if lands and off_bed(how.bed, state[3], state[4], state[5]) > 0.0:
                passed = touchdown(
                    cable, knots, vibration, sea, state, part, halves, near, expected, how.bed
                )
            passed_length, middle, upper, below, strain = passed
            x, y, z, fx, fy, fz, tz, level_index = below
            if strain == NO_BALANCE:
                return below, hanging, used, nodes, SEGMENT_UNBALANCED
            if not isfinite(x + y + z + fx + fy + fz):
                return below, hanging, used, nodes, RUNS_OFF
            span = 0.5 * passed_length if halves else passed_length
            if span > SHORT * how.reach:
                _, _, _, ax, ay, az, _, _ = middle
                expected = (fx - ax) / span, (fy - ay) / span, (fz - az) / span
            if passed_length < part:
                fx, fy, fz = along_bed(how.bed, fx, fy, fz)
                below = x, y, z, fx, fy, fz, tz, level_index
                hanging = done + passed_length
            if how.recording and nodes + others >= len(record[0]):
                return state, hanging, used, nodes, NO_ROOM
            if halves and (uncut or near == 0.0):
                if how.recording:
                    write_element(record, nodes, cable.piece, -1, span, upper)
                    write_node(record, nodes, middle)
                    record[SEGMENT][nodes] = HALVES
                nodes, long = nodes + 1, long - span
            state, left, done, long = below, left - part, done + part, long + passed_length
            splits = left > 0.0 and hanging < 0.0
            if splits and not how.given and part > LEAST_PART * cut:
                cut, left, splits = cut - left, 0.0, False
            if not splits or near == 0.0:
                if how.recording:
                    write_element(record, nodes, cable.piece, -1, long, strain)
                    write_node(record, nodes, state)
                    record[SEGMENT][nodes] = SPLITS if splits else ENDS
                nodes, long = nodes + 1, 0.0
            uncut = False
            if left <= 0.0:
                break
        if not how.given:
            cuts[used - 1] = cut
        if hanging >= 0.0:
            done += left
            break
        if used - first > MOST_SEGMENTS:
            return state, hanging, used, nodes, ENDLESS
    if not how.given:
        counts[place] = used - first
        if hanging >= 0.0:
            used = cut_evenly(cuts, counts, place, used, cable.length - done, how.reach)
    return state, hanging, used, nodes, GOES_ON


def cut_evenly(
    cuts: MutableSequence[float],
    counts: MutableSequence[int],
    cable: int,
    used: int,
    length: float,
    reach: float,
) -> int:
    """Choose equal segments for a length of cable on the seabed, which is not integrated.

    Return the total number of segments, including those that no longer fit into `cuts`.
    """
    if length <= 0.0:
        return used
    count = max(int(length / reach + 0.5), 1)
    for i in range(used, min(used + count, len(cuts))):
        cuts[i] = length / count
    counts[cable] += count
    return used + count
