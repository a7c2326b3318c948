"""One march (integration) down a line, called from Python; see `calm.physics.passing`."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from calm.physics.compiled import outcome
from calm.physics.drag import Vector
from calm.physics.line import (
    COLUMNS,
    FAILURES,
    GOES_ON,
    NO_ROOM,
    Bed,
    Floats,
    Integers,
    MarchError,
    Record,
    Trace,
)
from calm.physics.passing import FAILURE, FX, FY, FZ, LEFT, NODES, USED, MarchSettings, Z, pass_line
from calm.physics.profile import Profile
from calm.physics.track import Track

ROOM = 1024
"""Initial number of segments in the work arrays; a march that needs more is repeated with larger
arrays.
"""


class Cuts(NamedTuple):
    """Unstretched lengths of all cable segments [m], and number of segments in each cable."""

    lengths: Floats
    counts: Integers

    def halved(self) -> Cuts:
        """Return twice as many segments, each half as long."""
        return Cuts(np.repeat(0.5 * self.lengths, 2), 2 * self.counts)

    def first(self, cables: int) -> Cuts:
        """Return the segments of the first `cables` cables only."""
        counts = self.counts[:cables]
        return Cuts(self.lengths[: counts.sum()], counts)

    def after(self, cables: int) -> Cuts:
        """Return the segments of all but the first `cables` cables."""
        return Cuts(self.lengths[self.counts[:cables].sum() :], self.counts[cables:])

    def and_then(self, others: Cuts) -> Cuts:
        """Return these segments followed by the segments of further cables."""
        lengths = np.concatenate([self.lengths, others.lengths])
        return Cuts(lengths, np.concatenate([self.counts, others.counts]))


NO_CUTS = Cuts(np.zeros(0), np.zeros(0, np.intp))


@dataclass(frozen=True)
class End:
    """Result at the end of a march.

    Attributes
    ----------
    z, force : height above the sea surface [m], and force just above the end [N]
    cuts : segments used
    record, nodes : record of the march, and number of recorded nodes
    """

    z: float
    force: Vector
    cuts: Cuts
    record: Record = field(repr=False)
    nodes: int

    @cached_property
    def trace(self) -> Trace:
        """Recorded shape of the line."""
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
    compiled: bool = False,
) -> End:
    """Integrate down a line from a free end at a given depth [m].

    Parameters
    ----------
    angle_step : largest rotation of a segment [rad]
    reach : largest length of a segment [m]
    cuts : segments to use; if None, the march chooses the segments
    record : whether to record every node and element
    compiled : whether to run compiled instead of interpreted code

    Raises
    ------
    MarchError
        Forces or moments on an element do not balance, the line extends without limit, or a cable
        needs more than 50 000 segments.
    """
    course, sea = (track.packed, profile.packed) if compiled else (track.course, profile.sea)
    stages, level, known = len(course.stages), Bed(0.0, 0.0, 0.0, 0.0), cuts is not None
    settings = MarchSettings(
        angle_step, reach, 0.0, stages, False, level, known, known, False, record
    )
    room = ROOM if cuts is None else len(cuts.lengths)
    while True:
        most = room + 3 * len(course.loads) + 2 * len(course.stages) + 1 if record else 1
        lengths, counts, columns, left = _work_arrays(course, cuts, room, most, compiled)
        given = (course, sea, settings, depth, 0.0, lengths, counts, columns, left)
        outcome(pass_line, compiled, *given)
        if left[FAILURE] != NO_ROOM:
            break
        room *= 8
    if left[FAILURE] != GOES_ON:
        raise MarchError(FAILURES[int(left[FAILURE])])
    if cuts is None:
        used = np.array(lengths[: int(left[USED])])
        cuts = Cuts(used, np.array(counts, np.intp))
    force = float(left[FX]), float(left[FY]), float(left[FZ])
    return End(float(left[Z]), force, cuts, columns, int(left[NODES]))


def _work_arrays(
    course: Any, cuts: Cuts | None, room: int, nodes: int, compiled: bool
) -> tuple[Any, ...]:
    cables = len(course.cables)
    if compiled:
        lengths, counts = cuts or (np.empty(room), np.zeros(cables, np.intp))
        return lengths.copy(), counts.copy(), np.empty((COLUMNS, nodes)), np.zeros(LEFT)
    if cuts is None:
        given: tuple[list[float], list[int]] = ([0.0] * room, [0] * cables)
    else:
        given = (cuts.lengths.tolist(), cuts.counts.tolist())
    return *given, [[0.0] * nodes for _ in range(COLUMNS)], [0.0] * LEFT
