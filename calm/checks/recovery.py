"""Recovery: rise speed of the line without its anchor, surfacing times and surfacing order.

At first, the released line rises as a whole at its terminal speed. After each buoyant piece
surfaces, the line below rises in still water at its own terminal speed. Pieces that cannot surface
are suspended below the surfaced pieces.

The model neglects acceleration, and treats surfaced floats as fully immersed. The computed rise is
too slow, because line suspended from the surface counts as part of the rising line. The order of
surfacing may differ if the line tangles (`Recovery.tangles`).
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import isnan, nan
from typing import Any

import numpy as np

from calm.assemble import with_axial_clamps
from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.errors import NoEquilibrium
from calm.physics.line import Floats, Line, Water
from calm.physics.seawater import REFERENCE_DENSITY
from calm.physics.track import head_count
from calm.solve import FreeMotion, Settings, part_of, plumb_speed, solve_rise


@dataclass(frozen=True)
class Recovery:
    """Rise of a line without its anchor, starting from the equilibrium of the mooring.

    Tensions are NaN for pieces that do not rise, and arrival times for pieces that stay below.

    Attributes
    ----------
    released : index of the lowest piece that rises: the lowest release, or the piece above the
        anchor
    rise_speed : terminal speed, positive up [m/s]; 0 if the line does not rise
    net_buoyancy : net buoyancy of the rising line at the equilibrium depths [N]
    time_to_surface : time until the first buoyant piece surfaces [s]; None if no piece surfaces
    tension_top, tension_bottom : (n,) tensions of the pieces above the anchor [N]
    arrival : (n,) time at which each piece surfaces [s]
    order : indices of pieces that are buoyant enough to surface alone, in order of surfacing
    tangles : indices of pieces that overtake pieces above them
    in_still_water : whether the rise was computed in still water, without a solution in the current
    length : (m,) stretched lengths of the rising pieces [m]; empty if the line does not rise
    seabed : water depth [m]; NaN if the line does not rise
    """

    released: int
    rise_speed: float
    net_buoyancy: float
    time_to_surface: float | None
    tension_top: Floats
    tension_bottom: Floats
    arrival: Floats
    order: tuple[int, ...]
    tangles: tuple[int, ...]
    in_still_water: bool = False
    length: Floats = field(default_factory=lambda: np.zeros(0))
    seabed: float = nan

    @property
    def hangs_at(self) -> Floats:
        """(n,) depths of the upper ends of the pieces at the end of the rise [m]."""
        return np.array([self.depth_at(piece, 0.0) for piece in range(len(self.arrival))])

    def depth_at(self, piece: int, share: float) -> float:
        """Return the depth of a point on a piece at the end of the rise [m]; NaN if unknown.

        `share` is the distance of the point from the upper end, as a fraction of the length of the
        piece.
        """
        up = np.isfinite(self.arrival[: len(self.length)])
        if piece >= len(up):
            return self.seabed
        if up[piece]:
            return 0.0
        ends = np.concatenate([[0.0], np.cumsum(self.length)])
        at = ends[piece] + share * self.length[piece]
        above = at - ends[1 : piece + 1][up[:piece]]
        below = ends[piece + 1 : -1][up[piece + 1 :]] - at
        return float(np.concatenate([above, below, [self.seabed]]).min())

    def components(self) -> list[dict[str, Any]]:
        """Return one dictionary of results per piece above the anchor; None stands for NaN."""
        columns = (self.tension_top, self.tension_bottom, self.arrival, self.hangs_at)
        names = ("tension_top", "tension_bottom", "arrival", "depth")
        rows = zip(*(column.tolist() for column in columns), strict=True)
        return [
            {"index": index} | {n: None if isnan(v) else v for n, v in zip(names, row, strict=True)}
            for index, row in enumerate(rows)
        ]


def recovery_of(leg: Leg, result: LegResult) -> Recovery:
    """Compute the rise of a mooring after its release, starting from its equilibrium.

    `result` supplies the depths and stretched lengths in equilibrium.

    Raises
    ------
    NoEquilibrium
        The rise has no solution, neither in the current nor in still water.
    """
    count, water = len(leg.line.length), leg.water
    release = leg.file.release
    released = count - 1 if release is None else release
    whole = with_axial_clamps(leg.line, leg.file.pieces[:-1])
    line = part_of(whole, 0, released + 1)
    lifts = lifts_of(line, water, result)
    none = np.full(count, nan)
    at_rest = Recovery(released, 0.0, float(lifts.sum()), None, none, none, none, (), ())
    if not lifts.sum() > 0.0:
        return at_rest
    top = max(result.top.depth, 0.0)
    motion, still = _rise(line, water, top, leg.settings)
    speed = float(motion.velocity[2])
    if not speed > 0.0:
        return at_rest
    length = result.components.length[: released + 1]
    risers = dict(_risers(line, water, length, lifts, top, speed))
    arrival = none.copy()
    head = head_count(line)
    for piece, time in risers.items():
        arrival[0 if piece < head else piece : piece + 1] = time
    tension_top, tension_bottom = none.copy(), none.copy()
    first, last = motion.solution.piece_nodes.T
    tension_top[: released + 1] = motion.solution.tension[first]
    tension_bottom[: released + 1] = motion.solution.tension[last]
    return Recovery(
        released=released,
        rise_speed=speed,
        net_buoyancy=at_rest.net_buoyancy,
        time_to_surface=min(risers.values()),
        tension_top=tension_top,
        tension_bottom=tension_bottom,
        arrival=arrival,
        order=tuple(risers),
        tangles=motion.tangles,
        in_still_water=still,
        length=length,
        seabed=water.depth,
    )


def lifts_of(line: Line, water: Water, result: LegResult) -> Floats:
    """Return the net forces (n,) of the pieces with their clamps, positive up [N].

    The water densities are those at the equilibrium depths.
    """
    rows = slice(len(line.length))
    depth = 0.5 * (result.components.depth_top[rows] + result.components.depth_bottom[rows])
    density = water.density_at(np.maximum(depth, 0.0))
    return line.net_force((density - REFERENCE_DENSITY) * water.gravity)


def _rise(line: Line, water: Water, top: float, settings: Settings) -> tuple[FreeMotion, bool]:
    try:
        return solve_rise(line, water, top, settings), False
    except NoEquilibrium:
        return solve_rise(line, water.still(), top, settings), True


def _risers(
    line: Line, water: Water, length: Floats, lifts: Floats, top: float, speed: float
) -> Iterator[tuple[int, float]]:
    """Yield each piece that is buoyant enough to surface alone, and its surfacing time [s].

    Parameters
    ----------
    length, lifts : (n,) stretched lengths [m] and net forces [N] of the pieces
    top : depth of the upper end of the line [m]
    speed : initial rise speed [m/s]
    """
    time, up, count = 0.0, 0, len(length)
    for piece in np.flatnonzero(lifts > 0.0).tolist():
        # a rope has surfaced when its lower end is up, a rigid piece when its upper end is up
        distance = float(length[up : piece + bool(line.flexible[piece])].sum())
        if up == 0:
            distance = top if piece < head_count(line) else top + distance
        elif not lifts[up:].sum() > 0.0:
            return
        elif distance > 0.0:
            speed = plumb_speed(part_of(line, up, count), water, 0.0)
            if not speed > 0.0:
                return
        time += distance / speed
        yield piece, time
        up = piece + 1
