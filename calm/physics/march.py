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
from math import inf

from calm.physics.cable import evenly, march_cable
from calm.physics.element import Vector
from calm.physics.profile import Profile
from calm.physics.rod import load_force, pass_rod
from calm.physics.state import State, Trace
from calm.physics.track import Cable, Load, Rod, Track

Cuts = list[list[float]]
"""For every cable of a `Track`, the unstretched lengths of its segments [m]."""


@dataclass(frozen=True)
class Landing:
    """Where a line comes down on the seabed: the stage, and how much of it hangs above [m].

    A rod or clamp hangs wholly (inf: it stands on the seabed) or not at all (0: it lies there).
    """

    stage: int
    hanging: float


@dataclass(frozen=True)
class End:
    """Where and how a march ended: height [m], force above [N], and the segments it used.

    `landing` tells where it stopped short of the line's end, having no more weight to give.
    """

    z: float
    force: Vector
    cuts: Cuts
    landing: Landing | None = None

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
    lands: bool = False,
) -> End:
    """March down the line from a free end at `depth`.

    Parameters
    ----------
    depth : of the free end [m]
    angle_step : how much a segment may turn [rad]
    reach : the longest a segment may be [m]
    cuts : the segments to use; None lets the march choose them
    trace : filled with every node and element when given
    lands : stop at the touchdown: below the last buoyant piece, where the vertical force vanishes

    Raises
    ------
    MarchError
        An element finds no balance or a cable would need more than 50 000 segments.
    """
    state = State(0.0, 0.0, -depth, level=profile.interval(depth, 0))
    used: Cuts = []
    if trace is not None:
        trace.node(state.x, state.y, state.z, (0.0, 0.0, 0.0))
    first_to_land = track.landing if lands else len(track.stages)
    for i, stage in enumerate(track.stages):
        hanging: float | None = None
        may_land = i >= first_to_land
        if isinstance(stage, Cable):
            given = None if cuts is None else cuts[len(used)]
            taken, hanging = march_cable(
                stage, profile, state, angle_step, reach, given, trace, may_land
            )
            used.append(taken)
        elif isinstance(stage, Rod):
            hanging = pass_rod(stage, profile, state, trace, may_land)
        else:
            hanging = _pass_clamp(stage, profile, state, trace, may_land)
        if hanging is not None:
            used += _remaining(track, i + 1, reach) if cuts is None else cuts[len(used) :]
            force = (state.fx, state.fy, state.fz)
            return End(state.z, force, used, Landing(i, hanging))
    return End(state.z, (state.fx, state.fy, state.fz), used)


def _pass_clamp(
    clamp: Load, profile: Profile, state: State, trace: Trace | None, lands: bool
) -> float | None:
    carried = state.fz
    plumb = (0.0, 0.0, -1.0)
    state.add(load_force(clamp, profile, -state.z, plumb, state.level))
    landed = lands and carried > 0.0 >= state.fz
    if landed:
        state.fz = 0.0
    if trace is not None:
        trace.element(clamp.piece, clamp.clamp, 0.0, 0.0)
        trace.node(state.x, state.y, state.z, (state.fx, state.fy, state.fz))
    return inf if landed else None


def _remaining(track: Track, first: int, reach: float) -> Cuts:
    """Segments for the cables that a march did not come to."""
    return [evenly(s.length, reach) for s in track.stages[first:] if isinstance(s, Cable)]
