"""What closes a line: the depth of its free end, or how much of a float's buoyancy is used."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

from calm.physics.hull import Floating, Riding
from calm.physics.reference import REFERENCE_DENSITY
from calm.physics.track import Load, Rod, Track, loads_of


@dataclass(frozen=True)
class Afloat:
    """A float at the surface: its piece, the share of its buoyancy in use, the slope there."""

    piece: int
    share: float
    slope: float


class Placed(NamedTuple):
    """Where a march begins.

    Attributes
    ----------
    depth : of the free end [m]
    out : length of the head above the surface, from which that depth follows [m]; 0 without
    afloat : the loads at the surface, by their place among those of the track
    """

    depth: float
    out: float
    afloat: dict[int, Load]


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

    def placed(self, x: float, gravity: float) -> Placed:
        """Where the free end is, and the loads at the surface, for the value x of the unknown."""
        if self.afloat is None:
            return Placed(x, 0.0, {})
        shares, riding = self.shares(x), self.riding(x)
        changed = {}
        head: Rod | None = None
        for place, load, part in self._rigid:
            loaded = load
            if load.clamp < 0 and load.piece in shares:
                loaded = _with_share(load, shares[load.piece])
            if riding is not None and self.afloat in part.pieces:
                head = part
                if load.piece < self.afloat:
                    loaded = _lifted_out(loaded, riding.above, gravity)
                elif load.clamp < 0 and load.piece == self.afloat:
                    loaded = _as_riding(loaded, riding)
            if loaded is not load:
                changed[place] = loaded
        out = 0.0
        if riding is not None and head is not None and head is self.track.stages[0]:
            *above, own = head.lengths[: head.pieces.index(self.afloat) + 1]
            out = riding.above * sum(above) + riding.standing * own
        return Placed(0.0, out, changed)

    @cached_property
    def _rigid(self) -> list[tuple[int, Load, Rod]]:
        """The loads of the rods down to the lowest float at the surface, and their places."""
        lowest = max(self.shares(0.0), default=-1)
        found, place = [], 0
        for part in self.track.stages:
            loads = loads_of(part)
            if isinstance(part, Rod) and part.pieces[0] <= lowest:
                found += [(place + i, load, part) for i, load in enumerate(part.loads)]
            place += sum(isinstance(load, Load) for load in loads)
        return found

    def down_to(self, piece: int) -> Unknown:
        """The question for the part of the line above a float: to bring its top to the surface."""
        stages = self.track.stages
        end = next(i for i, s in enumerate(stages) if isinstance(s, Rod) and piece in s.pieces)
        part = replace(self.track, stages=stages[:end])
        return replace(self, track=part, goal=0.0, lands=False, part=True)


def _with_share(load: Load, share: float) -> Load:
    return load._replace(buoyancy=share * load.buoyancy, volume=share * load.volume)


def _as_riding(load: Load, riding: Riding) -> Load:
    """A float with the wind on it and its drag at the surface."""
    return load._replace(
        normal_drag=riding.drag * load.normal_drag,
        tangential_drag=riding.drag * load.tangential_drag,
        push_east=riding.push[0],
        push_north=riding.push[1],
    )


def _lifted_out(load: Load, share: float, gravity: float) -> Load:
    """A load with a share of it out of the water: there it is not dragged, nor does it displace."""
    wet = 1.0 - share
    return load._replace(
        buoyancy=load.buoyancy - share * REFERENCE_DENSITY * gravity * load.volume,
        volume=wet * load.volume,
        normal_drag=wet * load.normal_drag,
        tangential_drag=wet * load.tangential_drag,
        lift=wet * load.lift,
    )
