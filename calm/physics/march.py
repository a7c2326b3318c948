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
from typing import Any, NamedTuple

import numpy as np

from calm.physics.element import Vector
from calm.physics.line import Floats, Integers
from calm.physics.pace import is_fast, paced
from calm.physics.passing import pass_line
from calm.physics.profile import Profile
from calm.physics.state import COLUMNS, Record, Trace
from calm.physics.track import Load, Track

ROOM = 1024
"""Segments that a march may choose at first; if it needs more, it is done again with more room."""


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
    fast = is_fast()
    course, sea = (track.packed, profile.packed) if fast else (track.course, profile.sea)
    if afloat:
        loads: Any = np.array(course.loads) if fast else list(course.loads)
        for place, load in afloat.items():
            loads[place] = load
        course = course._replace(loads=loads)
    given = cuts is not None
    lengths: Any
    counts: Any
    if cuts is not None:
        room = len(cuts.lengths)
    most = room + 3 * len(course.loads) + 2 * len(course.stages) + 1 if recording else 0
    if fast:
        lengths, counts = cuts or (np.empty(room), np.zeros(len(course.cables), np.int64))
        record: Record = np.empty((COLUMNS, most))
    else:
        lengths = [0.0] * room if cuts is None else cuts.lengths.tolist()
        counts = [0] * len(course.cables) if cuts is None else cuts.counts.tolist()
        record = [[0.0] * most for _ in range(COLUMNS)]
    end = paced(pass_line)(
        course, sea, depth, out, angle_step, reach, lands, given, lengths, counts, record, recording
    )
    if end.segments > len(lengths):
        return None
    if cuts is None:
        cuts = Cuts(np.array(lengths[: end.segments]), np.array(counts, np.int64))
    force = (end.fx, end.fy, end.fz)
    return End(end.z, force, cuts, end.stage, end.hanging, record, end.nodes)
