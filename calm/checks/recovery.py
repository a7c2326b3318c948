"""The recovery: whether a line comes up without its anchor, how fast, and in what order.

What is above the release and the release itself rise, all of it alike at terminal speed, until the
first buoyant piece is at the surface. It stays there with what is rigid with it. What is below goes
on, as a line of its own and in still water, as long as it is buoyant by itself; the line that still
hangs between counts with it, which makes it slower than it is. So one buoyant piece after another
comes up, each by the length of line between it and the one before, and the rest hangs below them.

The model leaves out how a line gathers way, that a piece may be carried up beside one that is above
it in the line, and that floats which have come up are half out of the water. In a rise that tangles
(`Recovery.tangles`) the order may be another.

Back-up buoyancy is what brings up the release when the line breaks above it.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from math import isnan, nan
from typing import Any

import numpy as np

from calm.assemble import net_buoyancy, with_axial_clamps
from calm.case.leg import Leg
from calm.case.leg_result import LegResult
from calm.errors import NoEquilibrium
from calm.files import Component, Flexible, Piece, Place
from calm.files.definition import CATALOGUE_DENSITY
from calm.physics.line import Floats, Line, Water
from calm.physics.materials import materials_in
from calm.physics.seawater import REFERENCE_DENSITY
from calm.physics.track import head_count
from calm.solve import FreeMotion, Settings, part_of, plumb_speed, solve_rise
from calm.solve.solution import standing_lift


@dataclass(frozen=True)
class Recovery:
    """The rise of a line without its anchor, from where it stands.

    Attributes
    ----------
    released : index of the lowest piece that rises: the lowest release, whose lower hook opens, or
        the piece above the anchor where there is none
    rise_speed : terminal, of all that rises [m/s], + up; 0 where it does not rise
    net_buoyancy : of all that rises, where it stands [N]
    time_to_surface : until the first buoyant piece is there [s]; None where none comes up
    tension_top, tension_bottom : (n,) of every piece above the anchor, in the rise [N]; nan of one
        that does not rise
    arrival : (n,) when each piece is at the surface [s]; nan of one that hangs below, or stays
    order : the pieces that come up by themselves, in their order
    tangles : the pieces that have, or part of which has, overtaken what was above in the rise
    in_still_water : whether the rise is that in still water, because a line that doubles back
        finds no steady motion in this current
    length : (m,) stretched lengths of the pieces that rise [m]; none where the line does not
    seabed : depth of the water [m]; nan of a line that does not rise
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
        """Return (n,) depths of the upper ends of the pieces when all is up [m]."""
        return np.array([self.depth_at(piece, 0.0) for piece in range(len(self.arrival))])

    def depth_at(self, piece: int, share: float) -> float:
        """Return the depth of a place on a piece when all is up [m]; nan where it is not known.

        The place is a share of the length from the upper end of the piece of an index. It hangs by
        the shorter way along the line to a piece that is up, above it or below.
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
        """The pieces above the anchor, by name of figure; None where there is none."""
        columns = (self.tension_top, self.tension_bottom, self.arrival, self.hangs_at)
        names = ("tension_top", "tension_bottom", "arrival", "depth")
        rows = zip(*(column.tolist() for column in columns), strict=True)
        return [
            {"index": index} | {n: None if isnan(v) else v for n, v in zip(names, row, strict=True)}
            for index, row in enumerate(rows)
        ]


def recovery_of(leg: Leg, result: LegResult) -> Recovery:
    """The recovery of a mooring from where it stands.

    Parameters
    ----------
    result : of the mooring; tells where it stands and how long its pieces are

    Raises
    ------
    NoEquilibrium
        As `solve_rise`, in still water too.
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
    """(n,) net forces of the pieces with their clamps where they stand, + up [N]."""
    rows = slice(len(line.length))
    depth = 0.5 * (result.components.depth_top[rows] + result.components.depth_bottom[rows])
    density = water.density_at(np.maximum(depth, 0.0))
    return line.net_force((density - REFERENCE_DENSITY) * water.gravity)


def _rise(line: Line, water: Water, top: float, settings: Settings) -> tuple[FreeMotion, bool]:
    """The rise of the whole line, and whether it is that in still water."""
    try:
        return solve_rise(line, water, top, settings), False
    except NoEquilibrium:
        return solve_rise(line, water.still(), top, settings), True


def _risers(
    line: Line, water: Water, length: Floats, lifts: Floats, top: float, speed: float
) -> Iterator[tuple[int, float]]:
    """The pieces that come up by themselves, and when [s].

    They have stretched lengths [m] and net forces [N], (n,); the line's upper end stands at `top`
    [m] and has a speed at first [m/s]. What is below a float that is up rises plumb, as in still
    water.
    """
    time, up, count = 0.0, 0, len(length)
    for piece in np.flatnonzero(lifts > 0.0).tolist():
        # a rope is up when its lower end is, a rigid piece when its upper end is
        way = float(length[up : piece + bool(line.flexible[piece])].sum())
        if up == 0:
            way = top if piece < head_count(line) else top + way
        elif not lifts[up:].sum() > 0.0:
            return
        elif way > 0.0:
            speed = plumb_speed(part_of(line, up, count), water, 0.0)
            if not speed > 0.0:
                return
        time += way / speed
        yield piece, time
        up = piece + 1


SHORT_LEAD = 50.0
"""Length of what may lead from the lowest floats to the release without being judged [m].

The floats there are the back-up of what is above them. A line whose only floats stand so near to
its release, as a bottom lander or a short line below one float, is brought up by them alone.
"""


@dataclass(frozen=True)
class Break:
    """A break of the line below one of its pieces.

    Attributes
    ----------
    break_after, label : the piece above the break
    margin : net buoyancy of the pieces from below the break down to the release [N]
    weight_lifted : weight in water of those of them that are heavy [N]
    required : what the margin should be [N]
    judged : whether the design can change it
    loose : net buoyancy of what comes off at once, and drifts, + up [N]
    """

    break_after: int
    label: str
    margin: float
    weight_lifted: float
    required: float
    judged: bool
    loose: float = 0.0


@dataclass(frozen=True)
class Loss:
    """The loss of one buoyant element, such as a ball that is flooded; the line holds.

    Attributes
    ----------
    index, label : the piece, or the piece that the clamp is on, and what is lost
    margin : net buoyancy of what is left above the release, and of the release [N]
    weight_lifted : weight in water of what of it is heavy [N]
    required : what the margin should be [N]
    place : of what is lost, in the line as read
    """

    index: int
    label: str
    margin: float
    weight_lifted: float
    required: float
    place: Place


def _down_to_the_release(leg: Leg) -> tuple[Floats, Floats]:
    """(n,) net force [N] of each piece down to the lowest release, where the line stands upright,
    and its drag in a rise [N/(m/s)²].

    None of a line without a release, or one that no length fits.
    """
    release = leg.file.release
    if release is not None:
        with suppress(NoEquilibrium):
            lift = standing_lift(leg.line, leg.water)[: release + 1]
            return lift, drags_of(leg.line, leg.file.pieces)[: release + 1]
    return np.zeros(0), np.zeros(0)


def drags_of(line: Line, pieces: Sequence[Piece]) -> Floats:
    """(n,) drag of each piece of a line with its clamps in a rise [N/(m/s)²].

    Parameters
    ----------
    pieces : those of the line, with or without its anchor
    """
    return with_axial_clamps(line, pieces[: len(line.length)]).plumb_drag


def losses_of(leg: Leg) -> tuple[Loss, ...]:
    """The loss of each buoyant piece or clamp above the lowest release, from the top.

    What is lost lifts no more. One that fills with water, and gives its mass and a material whose
    density is known, weighs what that does in water; another is taken to be gone, and a cable is
    not lost. The others lift what they do where the line stands upright.
    """
    lift, drag = _down_to_the_release(leg)
    return losses_among(leg, leg.file.pieces[: lift.size], lift, float(drag.sum()))


def losses_among(leg: Leg, pieces: Sequence[Piece], lift: Floats, drag: float) -> tuple[Loss, ...]:
    """The same of the pieces of a mooring that come up together, with their net forces [N] and the
    drag of all of them [N/(m/s)²].
    """
    gravity = leg.water.gravity
    weight = float(-lift[lift < 0.0].sum())
    losses = []
    for piece in pieces:
        own = () if isinstance(piece.component, Flexible) else (piece,)
        for part in (*own, *piece.clamps):
            lifted = net_buoyancy(part.component, gravity)
            if lifted <= 0.0:
                continue
            sunk = _weight_when_flooded(part.component, gravity)
            losses.append(
                Loss(
                    index=piece.index,
                    label=part.label,
                    margin=float(lift.sum()) - lifted - sunk,
                    weight_lifted=weight + sunk,
                    required=required_margin(leg, weight + sunk, drag),
                    place=part.place,
                )
            )
    return tuple(losses)


def _weight_when_flooded(component: Component, gravity: float) -> float:
    """In water, of the shell of a float that is full of water [N]; 0 where that is not known."""
    named = (material.density for material in materials_in(component.material))
    density = next((value for value in named if value and value > CATALOGUE_DENSITY), None)
    if density is None or component.mass is None:
        return 0.0
    return component.mass * gravity * (1.0 - CATALOGUE_DENSITY / density)


def required_margin(leg: Leg, weight: float, drag: float) -> float:
    """Net buoyancy required after a break that leaves a weight in water [N] to lift, with a drag
    [N/(m/s)²]: a share of the weight, and at least what lets it rise at `minimum_rise_speed` [N].
    """
    checks = leg.file.checks
    return max(checks.backup_margin * weight, drag * checks.minimum_rise_speed**2)


def breaks_of(leg: Leg) -> tuple[Break, ...]:
    """The breaks at every connection above the lowest release, from the top.

    The net force of a piece is that with its clamps, in the water where it stands upright. After a
    break inside a cable what is left lies between the figures of the breaks at its two ends.
    There are none of a line without a release, or one that no length fits.

    Floats that follow one another, with at most connectors and chain between them, are a cluster.
    What breaks inside the lowest one, or in what leads from it to the release over `SHORT_LEAD` at
    most, leaves the release on the seabed in any design, and is not judged. Where that is the
    whole line, chain parts clusters too; one that is compact even so is judged by its losses alone.
    """
    lift, drag = _down_to_the_release(leg)
    if not lift.size:
        return ()
    release = lift.size - 1
    above = leg.file.pieces[:release]
    lengths = leg.line.length[:release]
    beyond_help = _beyond_help(above, lift[:release], lengths, "connector", "chain")
    if len(beyond_help) == release:
        beyond_help = _beyond_help(above, lift[:release], lengths, "connector")
    judged = set(range(release)) - set(beyond_help)
    breaks = []
    for piece in leg.file.pieces[:release]:
        left = lift[piece.index + 1 :]
        weight = float(-left[left < 0.0].sum())
        breaks.append(
            Break(
                break_after=piece.index,
                label=piece.label,
                margin=float(left.sum()),
                weight_lifted=weight,
                required=required_margin(leg, weight, float(drag[piece.index + 1 :].sum())),
                judged=piece.index in judged,
                loose=float(lift[: piece.index + 1].sum()),
            )
        )
    return tuple(breaks)


def _beyond_help(above: Sequence[Piece], lift: Floats, length: Floats, *between: str) -> range:
    """The breaks inside the lowest cluster of floats, and of a short lead below it.

    The pieces are those above the release, with their net forces [N] and lengths [m]; kinds and
    roles of what may stand `between` the floats of a cluster count.
    """
    floats = [
        force > 0.0 and not _is(piece, "cable") for piece, force in zip(above, lift, strict=True)
    ]
    end = len(above)
    while end and not floats[end - 1]:
        end -= 1
    first = end
    while first and (floats[first - 1] or _is(above[first - 1], *between)):
        first -= 1
    short = float(length[end:].sum()) <= SHORT_LEAD
    return range(first, len(above) if short else end - 1)


def _is(piece: Piece, *what: str) -> bool:
    return piece.component.kind in what or piece.component.role in what
