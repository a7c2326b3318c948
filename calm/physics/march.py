"""The top-down march: from the free end to the anchor, one element after another.

The march knows where the free end is and that nothing pulls it from above; it returns where the
other end comes out and with what force. What is unknown, and how the end is brought to the
anchor, is the business of `calm.solve`.

A cable or chain is marched in straight segments. Where no cuts are given the march chooses them:
each turns by about the angle step and is short against the water depth, and none straddles a
level of the profile. Given cuts are taken as they are, which makes the end of the line a smooth
function of its start.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import inf
from typing import NamedTuple

import numpy as np

from calm.physics.cable import pass_segment, segment_length, touchdown
from calm.physics.element import Vector
from calm.physics.line import Floats, Integers
from calm.physics.profile import Profile, Sea, interval_at
from calm.physics.rod import floating_depth, pass_clamp, pass_rod
from calm.physics.state import (
    COLUMNS,
    MarchError,
    Record,
    State,
    Trace,
    write_element,
    write_node,
)
from calm.physics.track import CABLE, ROD, Course, Load, Track

MOST_SEGMENTS = 50_000
ROOM = 1024
"""Segments that a march may choose at first; if it needs more, it is done again with more room."""


class Marched(NamedTuple):
    """How a march ended.

    Attributes
    ----------
    z, fx, fy, fz : height [m] and force above [N]
    segments, nodes : how many of them were used and recorded
    stage : where the line came down on the seabed; -1 where it did not
    hanging : unstretched length of that stage above the seabed [m]; of a rod or clamp inf, it
        stands there, or 0, it lies there
    complete : False where there was no room for the segments
    """

    z: float
    fx: float
    fy: float
    fz: float
    segments: int
    nodes: int
    stage: int
    hanging: float
    complete: bool


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
    """March down a line: see `march`.

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
    state = State(0.0, 0.0, -depth, 0.0, 0.0, 0.0, -1.0, level)
    if recording:
        write_node(record, 0, 0.0, 0.0, -depth, 0.0, 0.0, 0.0)
    used, nodes = 0, 1
    landed, hanging = -1, -1.0
    for i in range(len(course.stages)):
        stage = course.stages[i]
        may_land = lands and i >= course.landing
        if stage.kind == CABLE:
            cable = course.cables[stage.first]
            done, first = 0.0, used
            mine = counts[stage.first]
            while used - first < mine if given else done < stage.length or used == first:
                left = stage.length - done
                if given:
                    cut = cuts[used]
                else:
                    cut = segment_length(
                        cable, course.knots, course.vibration, sea, state, angle_step, reach
                    )
                    cut = min(left, cut)
                    if left - cut < 0.01 * cut:
                        cut = left
                    if used == len(cuts):
                        return Marched(0.0, 0.0, 0.0, 0.0, used, nodes, -1, 0.0, False)
                    cuts[used] = cut
                used += 1
                hangs = cut
                if may_land and state.fz > 0.0:
                    hangs = touchdown(cable, course.knots, course.vibration, sea, state, cut)
                state, strain = pass_segment(
                    cable, course.knots, course.vibration, sea, state, hangs
                )
                if hangs < cut:
                    x, y, z, fx, fy, _, tz, level = state
                    state = State(x, y, z, fx, fy, 0.0, tz, level)
                    landed, hanging = i, done + hangs
                if recording:
                    x, y, z, fx, fy, fz, _, _ = state
                    write_element(record, nodes, cable.piece, -1, hangs, strain)
                    write_node(record, nodes, x, y, z, fx, fy, fz)
                nodes += 1
                done += cut
                if landed >= 0:
                    break
                if used - first > MOST_SEGMENTS:
                    raise MarchError("the line would need more than 50000 segments")
            if not given:
                counts[stage.first] = used - first
                if landed >= 0:
                    used = cut_evenly(cuts, counts, stage.first, used, stage.length - done, reach)
        elif stage.kind == ROD:
            state, hanging, nodes = pass_rod(
                stage, course.loads, sea, state, may_land, record, recording, nodes
            )
            if hanging >= 0.0:
                landed = i
        else:
            load = course.loads[stage.first]
            carried = state.fz
            state = pass_clamp(load, sea, state)
            x, y, z, fx, fy, fz, tz, level = state
            if may_land and carried > 0.0 >= fz:
                landed, hanging, fz = i, inf, 0.0
                state = State(x, y, z, fx, fy, fz, tz, level)
            if recording:
                write_element(record, nodes, load.piece, load.clamp, 0.0, 0.0)
                write_node(record, nodes, x, y, z, fx, fy, fz)
            nodes += 1
        if landed >= 0:
            break
    if landed >= 0 and not given:
        for i in range(landed + 1, len(course.stages)):
            stage = course.stages[i]
            if stage.kind == CABLE:
                counts[stage.first] = 0
                used = cut_evenly(cuts, counts, stage.first, used, stage.length, reach)
    return Marched(
        state.z, state.fx, state.fy, state.fz, used, nodes, landed, hanging, used <= len(cuts)
    )


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


class Cuts(NamedTuple):
    """The unstretched lengths of the segments of all cables [m], and how many each cable has."""

    lengths: Floats
    counts: Integers

    def halved(self) -> Cuts:
        """Every segment cut in two."""
        return Cuts(np.repeat(0.5 * self.lengths, 2), 2 * self.counts)

    def first(self, cables: int) -> Cuts:
        """Those of the first cables."""
        counts = self.counts[:cables]
        return Cuts(self.lengths[: counts.sum()], counts)

    def after(self, cables: int) -> Cuts:
        """Those of the other cables."""
        return Cuts(self.lengths[self.counts[:cables].sum() :], self.counts[cables:])

    def and_then(self, others: Cuts) -> Cuts:
        """Those of more cables, too."""
        lengths = np.concatenate([self.lengths, others.lengths])
        return Cuts(lengths, np.concatenate([self.counts, others.counts]))


NO_CUTS = Cuts(np.zeros(0), np.zeros(0, np.int64))


@dataclass(frozen=True)
class End:
    """Where and how a march ended.

    Attributes
    ----------
    z, force : height [m], force above [N]
    cuts : the segments used
    stage, hanging : as in `Marched`
    record, nodes : what was recorded, and how many nodes of it
    """

    z: float
    force: Vector
    cuts: Cuts
    stage: int
    hanging: float
    record: Record = field(repr=False)
    nodes: int

    @property
    def landed(self) -> bool:
        """Whether it stopped short of the line's end, having no more weight to give."""
        return self.stage >= 0

    @cached_property
    def trace(self) -> Trace:
        """The shape; of a march that was recorded."""
        return Trace.of(self.record, self.nodes)


def march(
    track: Track,
    profile: Profile,
    depth: float,
    *,
    angle_step: float,
    reach: float,
    cuts: Cuts | None = None,
    record: bool = False,
    lands: bool = False,
    out: float = 0.0,
    afloat: Mapping[int, Load] | None = None,
) -> End:
    """March down the line from a free end at `depth`.

    Parameters
    ----------
    depth : of the free end [m]
    angle_step : how much a segment may turn [rad]
    reach : the longest a segment may be [m]
    cuts : the segments to use; None lets the march choose them
    record : whether to keep every node and element
    lands : stop at the touchdown: below the last buoyant piece, where the vertical force vanishes
    out : length of the head above the surface [m], from which its depth follows; 0 where it is
        `depth`
    afloat : loads that are not as in the track, by their place among its loads

    Raises
    ------
    MarchError
        An element finds no balance or a cable would need more than 50 000 segments.
    """
    if record and cuts is None:
        chosen = march(
            track, profile, depth, angle_step=angle_step, reach=reach, lands=lands, out=out,
            afloat=afloat,
        )  # fmt: skip
        cuts = chosen.cuts
    room = ROOM
    while True:
        end = _marched(
            track, profile, depth, out, angle_step, reach, lands, cuts, room, record, afloat or {}
        )
        if end is not None:
            return end
        room *= 8


def _marched(
    track: Track,
    profile: Profile,
    depth: float,
    out: float,
    angle_step: float,
    reach: float,
    lands: bool,
    cuts: Cuts | None,
    room: int,
    recording: bool,
    afloat: Mapping[int, Load],
) -> End | None:
    """`march` with room for so many segments; None where it needs more."""
    course = track.course
    if afloat:
        loads = list(course.loads)
        for place, load in afloat.items():
            loads[place] = load
        course = course._replace(loads=loads)
    given = cuts is not None
    lengths = [0.0] * room if cuts is None else cuts.lengths.tolist()
    counts = [0] * len(course.cables) if cuts is None else cuts.counts.tolist()
    most = len(lengths) + 3 * len(course.loads) + 2 * len(course.stages) + 1 if recording else 0
    record = [[0.0] * most for _ in range(COLUMNS)]
    end = pass_line(
        course, profile.sea, depth, out, angle_step, reach, lands, given, lengths, counts,
        record, recording,
    )  # fmt: skip
    if not end.complete:
        return None
    if cuts is None:
        cuts = Cuts(np.array(lengths[: end.segments]), np.array(counts, np.int64))
    force = (end.fx, end.fy, end.fz)
    return End(end.z, force, cuts, end.stage, end.hanging, record, end.nodes)
