"""A line passed from its free end down, stage by stage: laws alone.

What is asked of them and handed back is the business of `calm.physics.march`.
"""

from __future__ import annotations

from typing import NamedTuple

from calm.physics.cable import pass_segment, segment_length, touchdown
from calm.physics.profile import Sea, interval_at
from calm.physics.rod import floating_depth, pass_clamp, pass_rod
from calm.physics.state import MarchError, Record, State, write_element, write_node
from calm.physics.track import CABLE, ROD, Course

MOST_SEGMENTS = 50_000


class Marched(NamedTuple):
    """How a march ended.

    Attributes
    ----------
    z, fx, fy, fz : height [m] and force above [N]
    segments, nodes : how many of them were used, more than there was room for where that was too
        little, and passed
    stage : where the line came down on the seabed; -1 where it did not
    hanging : unstretched length of that stage above the seabed [m]; of a rod or clamp inf, it
        stands there, or 0, it lies there
    """

    z: float
    fx: float
    fy: float
    fz: float
    segments: int
    nodes: int
    stage: int
    hanging: float


def pass_line(
    course: Course,
    sea: Sea,
    depth: float,
    out: float,
    angle_step: float,
    reach: float,
    lands: bool,
    given: bool,
    cuts: list[float],
    counts: list[int],
    record: Record,
    recording: bool,
) -> Marched:
    """March down a line: see `calm.physics.march`.

    Parameters
    ----------
    out : length of the head that is to be above the surface [m], which sets the depth; 0 without
    cuts, counts : the segments and how many each cable has, read where they are `given`, else
        written
    record : where nodes and elements are written if `recording`
    """
    if out > 0.0:
        depth = floating_depth(course.stages[0], course.loads, sea, out)
    level = interval_at(sea.levels, depth, 0)
    state: State = (0.0, 0.0, -depth, 0.0, 0.0, 0.0, -1.0, level)
    if recording:
        write_node(record, 0, state)
    used, nodes = 0, 1
    landed, hanging = -1, -1.0
    for i in range(len(course.stages)):
        stage = course.stages[i]
        may_land = lands and i >= course.landing
        if stage.kind == CABLE:
            state, hanging, used, nodes = pass_cable(
                course, stage.first, sea, state, angle_step, reach, may_land,
                given, cuts, counts, used, record, recording, nodes,
            )  # fmt: skip
            if used > len(cuts):
                break
        elif stage.kind == ROD:
            state, hanging, nodes = pass_rod(
                stage, course.loads, sea, state, may_land, record, recording, nodes
            )
        else:
            state, hanging, nodes = pass_clamp(
                course.loads[stage.first], sea, state, may_land, record, recording, nodes
            )
        if hanging >= 0.0:
            landed = i
            break
    if landed >= 0 and not given:
        for i in range(landed + 1, len(course.stages)):
            stage = course.stages[i]
            if stage.kind == CABLE:
                counts[stage.first] = 0
                used = cut_evenly(cuts, counts, stage.first, used, stage.length, reach)
    _, _, z, fx, fy, fz, _, _ = state
    return Marched(z, fx, fy, fz, used, nodes, landed, hanging)


def pass_cable(
    course: Course,
    place: int,
    sea: Sea,
    state: State,
    angle_step: float,
    reach: float,
    lands: bool,
    given: bool,
    cuts: list[float],
    counts: list[int],
    used: int,
    record: Record,
    recording: bool,
    nodes: int,
) -> tuple[State, float, int, int]:
    """Take the state down a stretch of cable, `place` among the cables.

    Returns
    -------
    The state; the unstretched length above its touchdown [m], -1 where it has none; how many
    segments have been used and nodes passed so far. Where there is no room for another segment
    more are used than there is room for.
    """
    cable, knots, vibration = course.cables[place], course.knots, course.vibration
    first, done, hanging = used, 0.0, -1.0
    while used - first < counts[place] if given else done < cable.length or used == first:
        if used == len(cuts):
            return state, hanging, used + 1, nodes
        cut = cuts[used]
        if not given:
            left = cable.length - done
            cut = segment_length(cable, knots, vibration, sea, state, angle_step, reach)
            cut = min(left, cut)
            if left - cut < 0.01 * cut:
                cut = left
            cuts[used] = cut
        used += 1
        hung = cut
        if lands and state[5] > 0.0:
            hung = touchdown(cable, knots, vibration, sea, state, cut)
        state, strain = pass_segment(cable, knots, vibration, sea, state, hung)
        if hung < cut:
            x, y, z, fx, fy, _, tz, level = state
            state = x, y, z, fx, fy, 0.0, tz, level
            hanging = done + hung
        if recording:
            write_element(record, nodes, cable.piece, -1, hung, strain)
            write_node(record, nodes, state)
        nodes += 1
        done += cut
        if hanging >= 0.0:
            break
        if used - first > MOST_SEGMENTS:
            raise MarchError("the line would need more than 50000 segments")
    if not given:
        counts[place] = used - first
        if hanging >= 0.0:
            used = cut_evenly(cuts, counts, place, used, cable.length - done, reach)
    return state, hanging, used, nodes


def cut_evenly(
    cuts: list[float], counts: list[int], cable: int, used: int, length: float, reach: float
) -> int:
    """Segments of one length for a cable that is not marched; returns how many are used in all.

    As far as there is room for them.
    """
    if length <= 0.0:
        return used
    count = max(int(length / reach + 0.5), 1)
    for i in range(used, min(used + count, len(cuts))):
        cuts[i] = length / count
    counts[cable] += count
    return used + count
