"""Recovery: rise speed of the line without its anchor, surfacing times and surfacing order.

The release and everything above it rise together at terminal speed, until the first buoyant piece
reaches the surface. It stays there with everything rigidly connected. If the line below is buoyant,
it continues to rise as a separate line in still water; the line already suspended is included,
which makes the computed rise too slow. Buoyant pieces surface one after
another, each after rising by the length of line between it and the previous one, and everything
else is suspended below them.

The model neglects acceleration, the possibility that a piece is carried past one above it in the
line, and that surfaced floats are only half immersed. If the line tangles during ascent
(`Recovery.tangles`), the order may differ.

Back-up buoyancy recovers the release when the line breaks above it.
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
    """Rise of a line without its anchor, from its equilibrium.

    Attributes
    ----------
    released : index of the lowest piece that rises: the lowest release, whose lower hook opens, or
        the piece above the anchor if there is no release
    rise_speed : terminal speed of the rising line [m/s], + up; 0 if it does not rise
    net_buoyancy : net buoyancy of the rising line, in equilibrium [N]
    time_to_surface : time until the first buoyant piece surfaces [s]; None if none does
    tension_top, tension_bottom : (n,) tensions of the pieces above the anchor during the rise [N];
        NaN for pieces that do not rise
    arrival : (n,) time at which each piece surfaces [s]; NaN if it stays below
    order : pieces that are buoyant enough to surface alone, in order of surfacing
    tangles : pieces that overtake, entirely or in part, pieces above them in the line
    in_still_water : whether the rise was computed in still water, because the line doubles back
        and has no steady motion in the current
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
        """(n,) depths of the upper ends of the pieces after all pieces have surfaced [m]."""
        return np.array([self.depth_at(piece, 0.0) for piece in range(len(self.arrival))])

    def depth_at(self, piece: int, share: float) -> float:
        """Return the depth of a point on a piece after all pieces have surfaced [m]; NaN if
        unknown.

        The point is at a share of the length of piece number `piece`, from its upper end. It is
        suspended by the shorter length of line from a surfaced piece, above or below.
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
        """Return the pieces above the anchor as dictionaries; NaN becomes None."""
        columns = (self.tension_top, self.tension_bottom, self.arrival, self.hangs_at)
        names = ("tension_top", "tension_bottom", "arrival", "depth")
        rows = zip(*(column.tolist() for column in columns), strict=True)
        return [
            {"index": index} | {n: None if isnan(v) else v for n, v in zip(names, row, strict=True)}
            for index, row in enumerate(rows)
        ]


def recovery_of(leg: Leg, result: LegResult) -> Recovery:
    """Compute the recovery of a mooring from its equilibrium.

    Parameters
    ----------
    result : result of the mooring, for the equilibrium and stretched lengths

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
    """Return the net forces (n,) of the pieces with their clamps at their depths in equilibrium,
    positive up [N].
    """
    rows = slice(len(line.length))
    depth = 0.5 * (result.components.depth_top[rows] + result.components.depth_bottom[rows])
    density = water.density_at(np.maximum(depth, 0.0))
    return line.net_force((density - REFERENCE_DENSITY) * water.gravity)


def _rise(line: Line, water: Water, top: float, settings: Settings) -> tuple[FreeMotion, bool]:
    """Solve the rise of the whole line; the flag is true if the solution is for still water."""
    try:
        return solve_rise(line, water, top, settings), False
    except NoEquilibrium:
        return solve_rise(line, water.still(), top, settings), True


def _risers(
    line: Line, water: Water, length: Floats, lifts: Floats, top: float, speed: float
) -> Iterator[tuple[int, float]]:
    """Yield the pieces that are buoyant enough to surface on their own, and their times [s].

    `length` [m] is stretched and `lifts` [N] are net forces, both (n,). The upper end of the line
    is at depth `top` [m] and rises with `speed` [m/s] at first. The line below a surfaced float
    rises vertically, as in still water.
    """
    time, up, count = 0.0, 0, len(length)
    for piece in np.flatnonzero(lifts > 0.0).tolist():
        # a rope counts as surfaced once its lower end is up, a rigid piece once its upper end is
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


SHORT_LEAD = 50.0
"""Maximum length of line between the lowest floats and the release that is exempt from break checks
[m]; a default of CALM.

Those floats are the back-up of everything above them. If all floats are so close to the release, as
on a bottom lander or a short line below one float, they alone recover the mooring.
"""


@dataclass(frozen=True)
class Break:
    """A break of the line below one of its pieces.

    Attributes
    ----------
    break_after, label : the piece above the break
    margin : net buoyancy of the pieces from below the break down to the release [N]
    weight_lifted : weight in water of the non-buoyant ones of these pieces [N]
    required : required margin [N]
    judged : whether a better design could avoid the loss of the release
    loose : net buoyancy of the section that breaks away at once and drifts, + up [N]
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
    """Loss of one buoyant element, such as a flooded ball, while the line stays intact.

    Attributes
    ----------
    index, label : index of the piece (that carries the clamp), label of the lost element
    margin : net buoyancy of the release and the remaining pieces above it [N]
    weight_lifted : weight in water of the non-buoyant pieces [N]
    required : required margin [N]
    place : place of the lost element, in the line as read
    """

    index: int
    label: str
    margin: float
    weight_lifted: float
    required: float
    place: Place


def _down_to_the_release(leg: Leg) -> tuple[Floats, Floats]:
    """Return net forces (n,) [N] of the pieces down to the lowest release, in the upright line, and
    their drags during ascent [N/(m/s)²].

    Both are empty for a line without a release, or if no length fits.
    """
    release = leg.file.release
    if release is not None:
        with suppress(NoEquilibrium):
            lift = standing_lift(leg.line, leg.water)[: release + 1]
            return lift, drags_of(leg.line, leg.file.pieces)[: release + 1]
    return np.zeros(0), np.zeros(0)


def drags_of(line: Line, pieces: Sequence[Piece]) -> Floats:
    """Return the (n,) ascent drag of each piece of a line with its clamps [N/(m/s)²].

    Parameters
    ----------
    pieces : pieces of the line, with or without the anchor
    """
    return with_axial_clamps(line, pieces[: len(line.length)]).plumb_drag


def losses_of(leg: Leg) -> tuple[Loss, ...]:
    """List the loss of each buoyant piece or clamp above the lowest release, from the top.

    A lost element provides no buoyancy. If its mass and the density of its material are known, it
    is assumed flooded and its weight in water is added; otherwise it is assumed gone. Cables are
    never lost. The other pieces keep the net forces of the upright line.
    """
    lift, drag = _down_to_the_release(leg)
    return losses_among(leg, leg.file.pieces[: lift.size], lift, float(drag.sum()))


def losses_among(leg: Leg, pieces: Sequence[Piece], lift: Floats, drag: float) -> tuple[Loss, ...]:
    """List the losses among pieces that surface together, given their net forces [N] and their
    total drag [N/(m/s)²].
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
    """Return the weight in water of a flooded float's shell [N]; 0 if unknown."""
    named = (material.density for material in materials_in(component.material))
    density = next((value for value in named if value and value > CATALOGUE_DENSITY), None)
    if density is None or component.mass is None:
        return 0.0
    return component.mass * gravity * (1.0 - CATALOGUE_DENSITY / density)


def required_margin(leg: Leg, weight: float, drag: float) -> float:
    """Return the net buoyancy required after a break [N], for a remaining weight in water [N] and
    drag [N/(m/s)²]: a fraction of the weight, and at least enough to rise at `minimum_rise_speed`.
    """
    checks = leg.file.checks
    return max(checks.backup_margin * weight, drag * checks.minimum_rise_speed**2)


def breaks_of(leg: Leg) -> tuple[Break, ...]:
    """List the breaks at all connections above the lowest release, from the top.

    The net force of a piece includes its clamps, at its depth in the upright line. For a break
    inside a cable, the remaining net buoyancy lies between those of the breaks at its two ends. A
    line without a release, or without a length that fits, has no breaks.

    Successive floats with only connectors and chain between them form a cluster. A break inside the
    lowest cluster, or in a lead of at most `SHORT_LEAD` from it to the release, strands the release
    in any design and is not judged. If that is the whole line, chain separates clusters, too; a
    line that is still a single cluster is judged by its losses alone.
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
    """Return the range of breaks that strand the release in any design: inside the lowest cluster
    of floats, and in a short lead below it.

    `lift` [N] and `length` [m] are those of the pieces above the release; `between` lists kinds and
    roles of pieces allowed between the floats of a cluster.
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
