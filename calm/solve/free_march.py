"""Marches of a freely rising line, in the flow relative to the moving line.

The line is marched from both ends to the node with the largest estimated tension. A march towards a
free end would be unstable.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from math import degrees

import numpy as np

from calm.physics.line import Floats, Line, Trace, Water
from calm.physics.march import Cuts, End, march
from calm.physics.profile import Profile
from calm.physics.track import Track, head_count
from calm.solve.problem import REACH


@dataclass(frozen=True)
class Meeting:
    """Mismatch where the marches from the two ends of a line meet.

    Attributes
    ----------
    force : (3,) sum of all forces [N]
    gap : distance by which the lower end must be lowered for the marches to meet [m]
    cuts : the segments used
    """

    force: Floats
    gap: float
    cuts: Cuts
    trace: Trace | None


@dataclass(frozen=True)
class Rising:
    """A line that rises steadily as a whole in a current.

    Attributes
    ----------
    line, water : see `calm.physics.line`; the current is relative to the ground
    compiled : as in `Settings`
    top : depth of the upper end [m]
    """

    line: Line
    water: Water
    compiled: bool
    top: float

    @property
    def lifts(self) -> Floats:
        """Net buoyancy (n,) of each piece in water of the reference density, positive up [N]."""
        return self.line.total_buoyancy

    @cached_property
    def weight(self) -> float:
        """Absolute net buoyancy of the line, used as a scale of forces [N].

        The scale is at least a thousandth of the pieces' summed absolute net buoyancies.
        """
        return max(abs(float(self.lifts.sum())), 1e-3 * float(np.abs(self.lifts).sum()), 1e-300)

    @property
    def plumb(self) -> bool:
        """Whether the horizontal current is uniform over depth, so that the line is vertical."""
        return not (np.ptp(self.water.u) or np.ptp(self.water.v))

    def flow(self, velocity: Floats) -> Water:
        """Return the water with the current relative to a line that moves over the ground.

        Parameters
        ----------
        velocity : (3,) velocity of the line: east, north, up [m/s]
        """
        east, north, up = velocity
        water = self.water
        return replace(water, u=water.u - east, v=water.v - north, w=water.w - up)

    def _run(
        self,
        track: Track,
        flow: Water,
        depth: float,
        angle_step: float,
        cuts: Cuts | None,
        record: bool,
    ) -> End:
        reach = REACH * degrees(angle_step) * self.water.depth
        return march(
            track,
            Profile(flow),
            depth,
            angle_step=angle_step,
            reach=reach,
            cuts=cuts,
            record=record,
            compiled=self.compiled,
        )

    @property
    def guessed_depth(self) -> float:
        """First estimate of the depth of the lower end, for a vertical unstretched line [m]."""
        return self.top + float(self.line.length.sum())

    @cached_property
    def _split(self) -> int:
        """Index of the first piece that is marched from the lower end.

        The estimated tension of the line is largest just above this piece.
        """
        # drag is scaled so that the line rises steadily
        drag = self.line.plumb_drag
        pace = float(self.lifts.sum()) / max(float(drag.sum()), 1e-300)
        carried = np.cumsum(self.lifts - pace * drag)
        first = max(head_count(self.line), 1)
        return first + int(np.argmax(carried[first - 1 :]))

    @cached_property
    def _tracks(self) -> tuple[Track, Track]:
        """Tracks of the two parts that are marched from the upper end and from the lower end."""
        below = replace(self.line.reversed(), towed=True)
        return (
            Track.of(self.line).first_pieces(self._split),
            Track.of(below).first_pieces(len(self.line.length) - self._split),
        )

    def meet(
        self,
        flow: Water,
        depth: float,
        angle_step: float,
        cuts: Cuts | None = None,
        record: bool = False,
    ) -> Meeting:
        """March the line from both ends, and return the mismatch where the marches meet.

        Parameters
        ----------
        flow : water with the current relative to the line
        depth : depth of the lower end [m]
        angle_step, cuts, record : as in `calm.physics.march`
        """
        above, below = self._tracks
        cables = len(above.cables)
        upper = None if cuts is None else cuts.first(cables)
        lower = None if cuts is None else cuts.after(cables)
        down = self._run(above, flow, self.top, angle_step, upper, record)
        up = self._run(below, flow, depth, angle_step, lower, record)
        trace = _joined(down.trace, up.trace, len(self.line.length)) if record else None
        force = np.add(down.force, up.force)
        return Meeting(force, up.z - down.z, down.cuts.and_then(up.cuts), trace)


def _joined(upper: Trace, lower: Trace, pieces: int) -> Trace:
    """Join the marches from the upper and from the lower end at their common node."""
    position = lower.position + (upper.position[-1] - lower.position[-1])
    return Trace(
        position=np.concatenate([upper.position, position[-2::-1]]),
        force=np.concatenate([upper.force, -lower.force[-2::-1]]),
        piece=np.concatenate([upper.piece, pieces - 1 - lower.piece[::-1]]),
        clamp=np.concatenate([upper.clamp, lower.clamp[::-1]]),
        cut=np.concatenate([upper.cut, lower.cut[::-1]]),
        strain=np.concatenate([upper.strain, lower.strain[::-1]]),
        better=np.concatenate([upper.better, lower.better[-2::-1]]),
    )
