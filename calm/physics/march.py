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

from dataclasses import dataclass

from calm.physics.cable import march_cable
from calm.physics.element import Vector
from calm.physics.profile import Profile
from calm.physics.rod import load_force, pass_rod
from calm.physics.state import State, Trace
from calm.physics.track import Cable, Rod, Track

Cuts = list[list[float]]
"""For every cable of a `Track`, the unstretched lengths of its segments [m]."""


@dataclass(frozen=True)
class End:
    """Where and how a march ended: height [m], force above [N], and the segments it used."""

    z: float
    force: Vector
    cuts: Cuts

    @property
    def segments(self) -> int:
        """How many segments the cables were cut into."""
        return sum(map(len, self.cuts))


def march(
    track: Track,
    profile: Profile,
    depth: float,
    *,
    angle_step: float,
    reach: float,
    cuts: Cuts | None = None,
    trace: Trace | None = None,
) -> End:
    """March down the line from a free end at `depth`.

    Parameters
    ----------
    depth : of the free end [m]
    angle_step : how much a segment may turn [rad]
    reach : the longest a segment may be [m]
    cuts : the segments to use; None lets the march choose them
    trace : filled with every node and element when given

    Raises
    ------
    MarchError
        An element finds no balance or a cable would need more than 50 000 segments.
    """
    state = State(0.0, 0.0, -depth, level=profile.interval(depth, 0))
    used: Cuts = []
    if trace is not None:
        trace.node(state.x, state.y, state.z, (0.0, 0.0, 0.0))
    for stage in track.stages:
        if isinstance(stage, Cable):
            given = None if cuts is None else cuts[len(used)]
            used.append(march_cable(stage, profile, state, angle_step, reach, given, trace))
        elif isinstance(stage, Rod):
            pass_rod(stage, profile, state, trace)
        else:
            plumb = (0.0, 0.0, -1.0)
            state.add(load_force(stage, profile, -state.z, plumb, state.level))
            if trace is not None:
                trace.element(stage.piece, stage.clamp, 0.0, 0.0)
                trace.node(state.x, state.y, state.z, (state.fx, state.fy, state.fz))
    return End(state.z, (state.fx, state.fy, state.fz), used)
