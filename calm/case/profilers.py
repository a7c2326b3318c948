"""Solutions for profilers at positions from the upper to the lower stop."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import isinf

import numpy as np

from calm.case.leg import Leg
from calm.case.measure import clamps_of
from calm.errors import NoEquilibrium
from calm.files import Clamp, MooringFile, Place, Profiler
from calm.files.pieces import clamps_in

PLACES = 11
"""Number of positions at which a profiler is solved, including its two stops."""


@dataclass(frozen=True)
class ProfilerPlace:
    """Depth [m], tension [N] and tilt [degrees] of the wire at a position of a profiler.

    `at` is the unstretched distance from the top of the wire [m].
    """

    at: float
    depth: float
    tension: float
    tilt: float


@dataclass(frozen=True)
class ProfilerTravel:
    """Results for a profiler at three positions: upper stop, lower stop, and largest wire tilt.

    Attributes
    ----------
    distance : unstretched distance between the stops [m]
    time : duration of a profile [s]; None if unknown
    profiles : number of profiles per battery set; None if unknown
    """

    label: str
    upper: ProfilerPlace
    lower: ProfilerPlace
    worst: ProfilerPlace
    distance: float
    time: float | None
    profiles: int | None


def profilers_of(leg: Leg) -> tuple[ProfilerTravel, ...]:
    """Solve a line with each profiler at `PLACES` positions between its two stops.

    While one profiler is moved, the other profilers stay at their upper stops.

    Raises NoEquilibrium if there is no equilibrium at one of the `PLACES` positions.
    """
    return tuple(_travel(leg, clamp) for clamp in profilers_in(leg))


def profilers_in(leg: Leg) -> list[Clamp]:
    """Find the profilers that travel on a line."""
    return [clamp for clamp in clamps_in(leg.file.pieces) if clamp.travel is not None]


def _travel(leg: Leg, clamp: Clamp) -> ProfilerTravel:
    assert clamp.travel is not None
    upper, lower = clamp.travel
    if isinf(lower):  # the profiler travels to the end of its wire
        on = next(piece.index for piece in leg.file.pieces if clamp in piece.clamps)
        lower = float(leg.line.length[on])
    places = [_found(leg, clamp, float(at)) for at in np.linspace(upper, lower, PLACES)]
    component, distance = clamp.component, lower - upper
    assert isinstance(component, Profiler)
    return ProfilerTravel(
        label=clamp.label,
        upper=places[0],
        lower=places[-1],
        worst=max(places, key=lambda place: place.tilt),
        distance=distance,
        time=None if component.speed is None else distance / component.speed,
        profiles=None if component.endurance is None else int(component.endurance // distance),
    )


def _found(leg: Leg, clamp: Clamp, at: float) -> ProfilerPlace:
    try:
        file = held(leg.cut(leg.file), clamp.place, at)
        other = Leg(file, leg.for_surface, leg.memory, given_water=leg.water)
        clamps = clamps_of(file.pieces[:-1], other.equilibrium())
    except NoEquilibrium as failure:
        message = f"When {clamp.label} is {at:.0f} m down its wire: {failure.message}"
        raise NoEquilibrium(failure.status, message, failure.advice) from None
    row = clamps.label.index(clamp.label)
    return ProfilerPlace(
        at, float(clamps.depth[row]), float(clamps.tension[row]), float(clamps.tilt[row])
    )


def held(file: MooringFile, place: Place | None = None, at: float = 0.0) -> MooringFile:
    """Return a copy of a file in which every profiler is a fixed instrument.

    If `place` is given, the profiler at this place in the file is fixed at the unstretched distance
    `at` from the top of its wire [m]. All other profilers stay at their upper stops.
    """

    def unmoved(clamp: Clamp) -> Clamp:
        return replace(clamp, at=at if clamp.place == place else clamp.at, travel=None)

    def moves(clamp: Clamp) -> bool:
        return clamp.travel is not None or clamp.place == place

    pieces = (
        piece.with_clamps(unmoved) if any(map(moves, piece.clamps)) else piece
        for piece in file.pieces
    )
    return replace(file, pieces=tuple(pieces))
