"""What closes a line: the depth of its free end, or how much of a float's buoyancy is used."""

from __future__ import annotations

from collections.abc import Callable, Container
from dataclasses import dataclass, replace

from calm.physics.hull import Floating, Riding
from calm.physics.line import REFERENCE_DENSITY
from calm.physics.profile import Profile
from calm.physics.rod import rod_axis
from calm.physics.state import State
from calm.physics.track import Load, Rod, Stage, Track

_LEANINGS = 50


@dataclass(frozen=True)
class Afloat:
    """A float at the surface: its piece, the share of its buoyancy in use, the slope there."""

    piece: int
    share: float
    slope: float


@dataclass(frozen=True)
class Unknown:
    """What closes a line: the depth of its free end, or how much of a float's buoyancy is used.

    Attributes
    ----------
    track : the line laid out for the march, or its part down to a float at the surface
    goal : height at which the track must end [m], + up from the surface
    afloat : the piece at the surface whose share of buoyancy is sought; None below the surface
    above : the floats at the surface above that piece
    lands : whether the line may come down on the seabed before its end
    part : whether the track is but a part of the line
    floating : how the first float rides at the surface, while it is the only one there; None
        leaves it just below
    """

    track: Track
    goal: float
    afloat: int | None = None
    above: tuple[Afloat, ...] = ()
    lands: bool = False
    part: bool = False
    floating: Floating | None = None

    def shares(self, x: float) -> dict[int, float]:
        """Share of its buoyancy in use of every float at the surface, for the unknown's value x."""
        above = {afloat.piece: afloat.share for afloat in self.above}
        return above if self.afloat is None else {**above, self.afloat: x}

    def riding(self, x: float) -> Riding | None:
        """How the float at the surface rides, where that is known."""
        if self.floating is None or self.afloat is None:
            return None
        return self.floating.riding(x)

    def placed(self, x: float, profile: Profile) -> tuple[Track, float]:
        """Track and depth of the free end [m] for the value x of the unknown."""
        if self.afloat is None:
            return self.track, x
        track = _with_shares(self.track, self.shares(x))
        riding = self.riding(x)
        if riding is None:
            return track, 0.0
        track = _as_riding(track, self.afloat, riding, profile.gravity)
        return track, _depth_of_free_end(track.stages[0], self.afloat, riding, profile)

    def down_to(self, piece: int) -> Unknown:
        """The question for the part of the line above a float: to bring its top to the surface."""
        stages = self.track.stages
        end = next(i for i, s in enumerate(stages) if isinstance(s, Rod) and piece in s.pieces)
        return replace(self, track=Track(stages[:end]), goal=0.0, lands=False, part=True)


def _reloaded(track: Track, pieces: Container[int], change: Callable[[Load], Load]) -> Track:
    """The track with other loads on the rods that have any of the pieces."""
    return Track(
        tuple(
            replace(stage, loads=tuple(map(change, stage.loads)))
            if isinstance(stage, Rod) and any(piece in pieces for piece in stage.pieces)
            else stage
            for stage in track.stages
        )
    )


def _with_shares(track: Track, shares: dict[int, float]) -> Track:
    def loaded(load: Load) -> Load:
        if load.clamp >= 0 or load.piece not in shares:
            return load
        share = shares[load.piece]
        return replace(load, buoyancy=share * load.buoyancy, volume=share * load.volume)

    return _reloaded(track, shares, loaded)


def _as_riding(track: Track, piece: int, riding: Riding, gravity: float) -> Track:
    """The track with the wind on the float and its drag, and without water where there is none."""

    def loaded(load: Load) -> Load:
        if load.piece < piece:
            return _lifted_out(load, riding.above, gravity)
        if load.clamp >= 0 or load.piece != piece:
            return load
        return replace(
            load,
            normal_drag=riding.drag * load.normal_drag,
            tangential_drag=riding.drag * load.tangential_drag,
            push_east=riding.push[0],
            push_north=riding.push[1],
        )

    return _reloaded(track, (piece,), loaded)


def _lifted_out(load: Load, share: float, gravity: float) -> Load:
    """A load with a share of it out of the water: there it is not dragged, nor does it displace."""
    wet = 1.0 - share
    return replace(
        load,
        buoyancy=load.buoyancy - share * REFERENCE_DENSITY * gravity * load.volume,
        volume=wet * load.volume,
        normal_drag=wet * load.normal_drag,
        tangential_drag=wet * load.tangential_drag,
        lift=wet * load.lift,
    )


def _depth_of_free_end(head: Stage, piece: int, riding: Riding, profile: Profile) -> float:
    """Depth of the free end that brings the waterline of the float to the surface [m].

    The head of the line leans as its loads have it, and they depend a little on its depth.
    """
    if not isinstance(head, Rod) or piece not in head.pieces:
        return 0.0
    *above, own = head.lengths[: head.pieces.index(piece) + 1]
    out = riding.above * sum(above) + riding.standing * own
    depth = -out
    for _ in range(_LEANINGS):
        state = State(0.0, 0.0, -depth, level=profile.interval(depth, 0))
        following = min(out * rod_axis(head, profile, state)[2], 0.0)
        if abs(following - depth) <= 1e-14 * out:
            break
        depth = following
    return depth
